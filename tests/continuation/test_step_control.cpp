#include "arcslip/continuation/path/step_control.hpp"
#include "catch.hpp"

using namespace arcslip::continuation;

TEST_CASE("A step with quiet signals is kept and the next one doubles") {
  CHECK(acceptable({}, {}, 0.1));
  CHECK(step_factor({}, {}, 0.1) == 2);
}

TEST_CASE("Each of the signals alone rejects a step and shortens the next one") {
  const StepLimits limits;
  const double max_step = 0.1;
  const StepSignals signals[] = {
      {0.61, 0, 0, 0}, {0, 0.61, 0, 0}, {0, 0, 0.26 * max_step, 0}, {0, 0, 0, 0.11 * max_step}};
  for (const StepSignals& one : signals) {
    CHECK_FALSE(acceptable(one, limits, max_step));
    CHECK(step_factor(one, limits, max_step) <= 0.5);
    CHECK(step_factor(one, limits, max_step) >= limits.shrink);
  }
}

TEST_CASE("A step at the aim keeps its length") {
  CHECK_THAT(step_factor({0.2, 0, 0, 0}, {}, 0.1), WithinRel(1.0, 1e-12));
  CHECK_THAT(step_factor({0, 0.25, 0, 0}, {}, 0.1), WithinRel(1.0, 1e-12));
  CHECK_THAT(step_factor({0, 0, 0.005, 0}, {}, 0.1), WithinRel(1.0, 1e-12));
}
