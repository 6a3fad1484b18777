// The corrector allocates nothing: counted where all memory comes from, that of Eigen, too.

#include "allocations.hpp"
#include "arcslip/continuation/path/stepper.hpp"
#include "arcslip/problems/response/harmonic_response.hpp"
#include "catch.hpp"
#include "paper_cases.hpp"

using namespace arcslip;

namespace {

/// Allocations of 20 steps, probes included, after `warm` steps.
long allocated(const continuation::Problem& problem, const continuation::Guess& guess, double step,
               int warm) {
  continuation::Corrector corrector(problem, problems::ForcedResponse::eta, {});
  continuation::Stepper stepper(problem, corrector, {problems::ForcedResponse::Y}, 0.1);
  REQUIRE(stepper.start(guess.unknowns, guess.parameters, guess.regime, 1) ==
          continuation::Correction::converged);
  long before = 0;
  int kept = 0;
  for (int i = -warm; i < 20; ++i) {
    if (i == 0) before = allocations;
    kept += static_cast<int>(stepper.attempt(continuation::Hold::tangent, step));
    kept += static_cast<int>(stepper.prober().probe(0.5 * step));
    stepper.advance();
  }
  const long during = allocations - before;
  CHECK(kept == 2 * (20 + warm));
  CHECK(corrector.work().iterations >= 5);
  return during;
}

}  // namespace

TEST_CASE("Steps and corrections allocate nothing") {
  const problems::ForcedResponse problem(build_system(testing::figure_8(1)));
  CHECK(allocated(problem, problem.guess(0.5, 1), 0.05, 0) == 0);
}

TEST_CASE("Nor do those in many harmonics, once their matrices have their sizes") {
  SystemParameters parameters = testing::figure_8(1);
  parameters.harmonics = odd_up_to(GENERATE(1, 9, 31));
  const problems::HarmonicResponse problem(build_harmonic_system(parameters));
  CHECK(allocated(problem, problem.guess(3.7, 1), 2e-3, 2) == 0);
}

TEST_CASE("The count of allocations counts") {
  const long before = allocations;
  Vector some(GENERATE(1, 1000));
  some.setZero();
  CHECK(allocations > before);
}
