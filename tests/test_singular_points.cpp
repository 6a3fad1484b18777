// Points where dF/du vanishes as a whole, and branches that start on such points.

#include <cmath>

#include "arcslip/continuation/normal_form.hpp"
#include "catch.hpp"
#include "engine_problems.hpp"
#include "library_cases.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using arcslip::testing::Instance;
using arcslip::testing::of_type;
using arcslip::testing::over;

namespace {

/// (u^2 + p^2 - 1) u = 0: a circle and the line u = 0, which cross at p = -1 and 1.
class CircleAndLine : public Problem {
 public:
  Index size() const override { return 1; }
  std::vector<std::string> parameter_names() const override { return {"p"}; }
  bool evaluate(const Vector& u, const Vector& p, int /*regime*/, const Evaluation& out) const override {
    const double circle = u(0) * u(0) + p(0) * p(0) - 1;
    if (out.residual != nullptr) (*out.residual)(0) = circle * u(0);
    if (out.jacobian != nullptr) (*out.jacobian)(0, 0) = circle + 2 * u(0) * u(0);
    if (out.parameter_jacobian != nullptr) (*out.parameter_jacobian)(0, 0) = 2 * p(0) * u(0);
    return true;
  }
};

Vector one(double value) { return Vector::Constant(1, value); }

}  // namespace

TEST_CASE("A loop that starts on its branch point closes there and has no fold at its start") {
  const double start = GENERATE(-1.0, 1.0);
  const CircleAndLine problem;
  Guess guess{one(0), one(start), 0, {}};
  const auto form = branch_point_form(problem, 0, guess);
  REQUIRE(form);
  CHECK(form->kind == BranchPointKind::pitchfork);
  guess.direction = form->directions[1];
  TraceOptions options = over("p", -2, 2);
  options.max_points = 1000;
  const Branch loop = trace_both(problem, guess, options);
  CHECK(loop.stop == Stop::closed_loop);
  CHECK(of_type(loop, PointType::fold).empty());
  const auto crossings = of_type(loop, PointType::branch_point);
  REQUIRE(crossings.size() == 1);
  CHECK_THAT(crossings[0].parameters(0), WithinRel(-start, 1e-10));
  CHECK_THAT(loop.points.back().unknowns(0), WithinAbs(0, 1e-7));
}

TEST_CASE("The fold of a single unknown, where its Jacobian is zero, is a regular zero of what defines it") {
  const double x = 1 / std::sqrt(3.0);
  const double off = GENERATE(0.0, 1e-12, 1e-3);
  const arcslip::testing::Cusp problem;
  FoldProblem fold(problem, 0);
  const auto located = locate(fold, {one(x + off), one(-2 * x / 3), 0, {}});
  REQUIRE(located);
  CHECK(located->residual <= 1e-10);
  CHECK_THAT(located->point.unknowns(0), WithinRel(x, 1e-10));
}

TEST_CASE("The fold of an equilibrium, whose eigenvalue is zero to the last bit, is no Hopf point as well") {
  const Branch branch = Instance("cusp", {{"lambda", 3}}).trace(over("mu", -2.5, 2.5));
  REQUIRE(branch.complete());
  CHECK(of_type(branch, PointType::fold).size() == 2);
  CHECK(of_type(branch, PointType::hopf).empty());
}
