#include "arcslip/continuation/path/step_control.hpp"

#include <algorithm>
#include <cmath>

#include "arcslip/continuation/path/stepper.hpp"
#include "catch.hpp"
#include "scalar_problem.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;

namespace {

/// How far steps along a sine from p = 0.2 end from where they were predicted, but for the first four, at
/// most: of `count` steps of length `h` and, in turn, `uneven` times that.
double prediction_error(double h, int count, double uneven, Hold hold) {
  const ScalarProblem sine{{"p"},
                           [](double u, const Vector& p) { return u - std::sin(p(0)); },
                           [](double, const Vector&) { return 1.0; },
                           {[](double, const Vector& p) { return -std::cos(p(0)); }}};
  constexpr double tolerance = 1e-13;
  Corrector corrector(sine, 0, {.tolerance = tolerance});
  Stepper stepper(sine, corrector, {}, 0.2);
  REQUIRE(stepper.start(Vector::Constant(1, 0.2), Vector::Constant(1, 0.2), {}, 1) == Correction::converged);
  Predictor predictor(2, true);
  Vector predicted(2);
  double most = 0;
  for (int i = 0; i < count; ++i) {
    REQUIRE(stepper.attempt(hold, i % 2 == 0 ? h : uneven * h));
    predictor.predict(stepper.step(), predicted);
    if (i >= 4) most = std::max(most, (stepper.step().chord - predicted).norm());
    predictor.learn(stepper.step(), tolerance, false);
    stepper.advance();
    predictor.advance();
  }
  return most;
}

}  // namespace

TEST_CASE("Steps end where they are predicted, but for the fifth power of their length") {
  for (const Hold hold : {Hold::tangent, Hold::parameter}) {
    for (const double uneven : {1.0, 0.6, 1.7}) {
      INFO("uneven " << uneven << " hold " << static_cast<int>(hold));
      const double coarse = prediction_error(0.004, 16, uneven, hold);
      const double fine = prediction_error(0.002, 32, uneven, hold);
      CHECK_THAT(std::log2(coarse / fine), WithinAbs(5, 0.4));
    }
  }
}

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
