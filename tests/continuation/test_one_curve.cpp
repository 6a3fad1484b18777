// Where branches cross, a step stays on the one that it began on.

#include <cmath>
#include <random>

#include "catch.hpp"
#include "scalar_problem.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;

namespace {

/// x ((x/a)^2 + b x/a + p - p_c) = 0 beside z = k p + p^2, of which x/a is turned into both unknowns: a
/// parabola over x that meets x = 0 at p_c, upright for b = 0, and goes on below it.
class Sideways : public Problem {
 public:
  double a, b, place, k, turn;

  Index size() const override { return 2; }
  std::vector<std::string> parameter_names() const override { return {"p"}; }
  bool evaluate(const Vector& u, const Vector& p, const Regime& /*regime*/,
                const Evaluation& out) const override {
    const double x = own(u);
    const double z = -std::sin(turn) * u(0) + std::cos(turn) * u(1);
    const double square = (x / a + b) * x / a + p(0) - place;
    const double slope = square + x * (2 * x / a + b) / a;
    if (out.residual != nullptr) *out.residual << x * square, z - (k + p(0)) * p(0);
    if (out.jacobian != nullptr)
      *out.jacobian << slope * std::cos(turn), slope * std::sin(turn), -std::sin(turn), std::cos(turn);
    if (out.parameter_jacobian != nullptr) *out.parameter_jacobian << x, -k - 2 * p(0);
    return true;
  }

  double own(const Vector& u) const { return std::cos(turn) * u(0) + std::sin(turn) * u(1); }

  /// On the upper half of the parabola.
  Guess start(double p) const {
    const double x = a * (std::sqrt(0.25 * b * b + place - p) - 0.5 * b);
    const double z = (k + p) * p;
    return {vector_of({std::cos(turn) * x - std::sin(turn) * z, std::sin(turn) * x + std::cos(turn) * z}),
            vector_of({p})};
  }
};

}  // namespace

TEST_CASE("A branch that arrives sideways at another one is not left for it") {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> part(0, 1);
  const bool turned = GENERATE(false, true);
  const double max_step = GENERATE(0.03, 0.1, 0.3);
  CAPTURE(turned, max_step);
  for (int i = 0; i < 100; ++i) {
    Sideways problem;
    problem.a = std::pow(10, -part(random));
    problem.b = i % 3 == 0 ? part(random) : 0;
    problem.place = 1.6 * part(random) - 0.8;
    problem.k = std::pow(10, 1.3 * part(random) - 0.5);
    problem.turn = turned ? two_pi * part(random) : 0;
    CAPTURE(i, problem.a, problem.b, problem.place, problem.k, problem.turn);
    TraceOptions options = over("p", -1, 1);
    options.max_step = max_step;
    const Branch branch = trace(problem, problem.start(-1), options);
    CHECK(of_type(branch, PointType::branch_point).size() == 1);
    CHECK(problem.own(branch.points.back().unknowns) < 0);
    CHECK(branch.points.back().parameters(0) < -0.9);
  }
}
