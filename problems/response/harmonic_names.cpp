// What regimes and quantities of a harmonic problem are called.

#include <fmt/format.h>

#include "arcslip/problems/response/harmonic_problem.hpp"

namespace arcslip::problems {

/// What the contacts do, then what each further element does that is beyond its border, of several by number.
std::string HarmonicProblem::describe(const continuation::Regime& regime) const {
  std::string name = slip_name(regime, contacts());
  for (Index i = contacts(); i < switch_count(); ++i) {
    if (regime[i] == 0) continue;
    name += " " + coordinates_.element(i).beyond();
    if (switch_count() > contacts() + 1) name += fmt::format(" {}", i - contacts() + 1);
  }
  return name;
}

void HarmonicProblem::add_further_contacts() {
  for (Index i = 1; i < contacts(); ++i) {
    const auto name = [i](const char* quantity) { return fmt::format("{}_contact_{}", quantity, i + 1); };
    quantities_.push_back({name("R"), Measure::amplitude, Body::contact, i});
    quantities_.push_back({name("R_over_S"), Measure::ratio, Body::contact, i});
    quantities_.push_back({name("Y"), Measure::amplitude, Body::base, i});
    quantities_.push_back({name("U"), Measure::amplitude, Body::damper, i});
    quantities_.push_back({name("dissipated"), Measure::dissipated, Body::contact, i});
  }
}

void HarmonicProblem::add_higher_harmonics() {
  for (Index a = 1; a < harmonics(); ++a) {
    const auto name = [&](const char* quantity) {
      return fmt::format("{}_h{}", quantity, system_.orders[at(a)]);
    };
    quantities_.push_back({name("R"), Measure::amplitude, Body::contact, 0, a});
    quantities_.push_back({name("Y"), Measure::amplitude, Body::base, 0, a});
    quantities_.push_back({name("U"), Measure::amplitude, Body::damper, 0, a});
  }
}

}  // namespace arcslip::problems
