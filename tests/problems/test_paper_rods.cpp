// The rods against the closed forms of the paper, see printed_rods.hpp.

#include "catch.hpp"
#include "paper_cases.hpp"
#include "printed_rods.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using problems::ForcedResponse;

namespace {

double program_Y(SystemParameters parameters, Index elements, double eta) {
  parameters.elements = elements;
  const ForcedResponse problem(build_system(parameters));
  const continuation::Guess guess = problem.guess(eta, parameters.preload);
  Vector values;
  problem.observe(guess.unknowns, guess.parameters, guess.regime, values);
  return values(ForcedResponse::Y);
}

}  // namespace

TEST_CASE("Rods of very fine mesh have the response of (27), (28) and (31), (32) as printed") {
  const double preload = GENERATE(0.1, 1.0, 10.0);
  const SystemParameters parameters = rods(preload);
  int slipping = 0;
  for (const double eta : {0.7, 2.5, 3.3, 3.48, 3.7, 4.2, 5.6, 5.97, 6.1, 9.0}) {
    const PrintedRods printed(parameters, eta);
    slipping += static_cast<int>(printed.slips());
    CHECK_THAT(program_Y(parameters, 1000000, eta),
               WithinRel(printed.Y(), 1e-8));  // mesh: (pi/N)^2 near a resonance
  }
  CHECK(slipping >= 1);
}

TEST_CASE("Rods converge to (31) as (n/N)^2") {
  const SystemParameters parameters = rods(1);
  for (const double eta : {3.3, 5.6}) {
    const PrintedRods printed(parameters, eta);
    REQUIRE(printed.slips());
    const double exact = printed.Y();
    const double coarse = std::abs(program_Y(parameters, 200, eta) - exact);
    const double fine = std::abs(program_Y(parameters, 400, eta) - exact);
    CHECK_THAT(coarse / fine, WithinRel(4.0, 0.01));
  }
}
