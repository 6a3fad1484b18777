#include "arcslip/problems/response/harmonic_problem.hpp"

#include <fmt/format.h>

namespace arcslip::problems {

HarmonicProblem::HarmonicProblem(HarmonicSystem system) : system_(std::move(system)), coordinates_(system_) {
  check(system_);
}

void HarmonicProblem::add_further_contacts(std::vector<continuation::Observable>& all) const {
  for (Index i = 1; i < contacts(); ++i) {
    for (const char* name : {"R", "R_over_S", "Y", "U", "dissipated"})
      all.push_back({fmt::format("{}_contact_{}", name, i + 1)});
  }
}

void HarmonicProblem::add_higher_harmonics(std::vector<continuation::Observable>& all) const {
  for (Index a = 1; a < harmonics(); ++a) {
    for (const char* name : {"R", "Y", "U"})
      all.push_back({fmt::format("{}_h{}", name, system_.orders[at(a)])});
  }
}

}  // namespace arcslip::problems
