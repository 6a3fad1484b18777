// Points where dF/du vanishes as a whole, and branches that start on such points.

#include <cmath>

#include "arcslip/continuation/points/normal_form.hpp"
#include "catch.hpp"
#include "engine_problems.hpp"
#include "library_cases.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using arcslip::testing::Instance;
using arcslip::testing::of_type;
using arcslip::testing::over;

namespace {

/// (w^2 + p^2 - r^2) w = 0, w = u - sin p: an oval and the line u = sin p, which cross at p = -r and r. In w
/// nothing would be rounded.
class OvalAndLine : public Problem {
 public:
  static constexpr double r = 0.7;
  Index size() const override { return 1; }
  std::vector<std::string> parameter_names() const override { return {"p"}; }
  bool evaluate(const Vector& u, const Vector& p, const Regime& /*regime*/,
                const Evaluation& out) const override {
    const double w = u(0) - std::sin(p(0));
    const double oval = w * w + p(0) * p(0) - r * r;
    const double by_w = oval + 2 * w * w;
    if (out.residual != nullptr) (*out.residual)(0) = oval * w;
    if (out.jacobian != nullptr) (*out.jacobian)(0, 0) = by_w;
    if (out.parameter_jacobian != nullptr)
      (*out.parameter_jacobian)(0, 0) = 2 * p(0) * w - by_w * std::cos(p(0));
    return true;
  }
};

Vector one(double value) { return Vector::Constant(1, value); }

}  // namespace

TEST_CASE("A loop that starts on its branch point closes there and has no fold at its start") {
  const double start = GENERATE(-OvalAndLine::r, OvalAndLine::r);
  const double way = GENERATE(-1.0, 1.0);
  const OvalAndLine problem;
  Guess guess{one(std::sin(start)), one(start), 0, {}};
  const auto form = branch_point_form(problem, 0, guess);
  REQUIRE(form);
  CHECK(form->kind == BranchPointKind::pitchfork);
  guess.direction = way * form->directions[1];
  TraceOptions options = over("p", -2, 2);
  options.max_points = 1000;
  const Branch loop = trace(problem, guess, options);
  CHECK(loop.stop == Stop::closed_loop);
  CHECK(of_type(loop, PointType::fold).empty());
  const auto crossings = of_type(loop, PointType::branch_point);
  REQUIRE(crossings.size() == 1);
  CHECK_THAT(crossings[0].parameters(0), WithinRel(-start, 1e-10));
  CHECK_THAT(loop.points.back().unknowns(0), WithinAbs(std::sin(start), 1e-7));  // where two branches are one
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
