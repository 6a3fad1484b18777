// Corners that no border tells of, at any angle and wherever steps come to lie.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

#include "arcslip/continuation/path/trace.hpp"
#include "branches.hpp"
#include "catch.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;
using Catch::Matchers::WithinAbs;

namespace {

/// F = A z + c max(0, g . z) of z = (u_1, u_2, p - p_0): two half-lines that meet where g . z = 0.
class TwoHalfLines : public Problem {
 public:
  explicit TwoHalfLines(std::mt19937& random) {
    std::normal_distribution<double> normal;
    const auto draw = [&] { return normal(random); };
    jacobian_ = Matrix::NullaryExpr(2, 3, draw);
    kink_ = Vector::NullaryExpr(2, draw);
    gradient_ = Vector::NullaryExpr(3, draw);
    place_ = 1 + std::abs(draw());
  }

  /// Where the branch leads from the corner in front of the kink, and behind it.
  Vector before() const { return -direction(jacobian_); }
  Vector behind() const { return direction(jacobian_ + kink_ * gradient_.transpose()); }
  double place() const { return place_; }

  Index size() const override { return 2; }
  std::vector<std::string> parameter_names() const override { return {"p"}; }
  bool evaluate(const Vector& u, const Vector& p, const Regime& /*regime*/,
                const Evaluation& out) const override {
    const Vector z = Vector3(u(0), u(1), p(0) - place_);
    const double passed = gradient_.dot(z);
    Matrix jacobian = jacobian_;
    if (passed > 0) jacobian += kink_ * gradient_.transpose();
    if (out.residual != nullptr) *out.residual = jacobian * z;
    if (out.jacobian != nullptr) *out.jacobian = jacobian.leftCols(2);
    if (out.parameter_jacobian != nullptr) *out.parameter_jacobian = jacobian.rightCols(1);
    return true;
  }

 private:
  using Vector3 = Eigen::Vector3d;

  Vector direction(const Matrix& jacobian) const {
    const Vector3 along = Vector3(jacobian.row(0)).cross(Vector3(jacobian.row(1))).normalized();
    return gradient_.dot(along) > 0 ? along : Vector3(-along);
  }

  Matrix jacobian_;
  Vector kink_, gradient_;
  double place_;
};

}  // namespace

TEST_CASE("A branch goes on behind a corner of any angle, wherever its steps end") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> exponent(-3, -0.5);
  int turned = 0;
  for (int i = 0; i < 1500; ++i) {
    const TwoHalfLines problem(random);
    const Vector before = problem.before();
    const Vector behind = problem.behind();
    const double steep = 0.05;  // a branch over p is to have one
    if (std::abs(before(2)) < steep || std::abs(behind(2)) < steep) continue;
    TraceOptions options;
    options.parameter = "p";
    options.from = problem.place() + before(2);
    options.to = problem.place() - before(2);
    options.max_step = std::pow(10, exponent(random));
    options.max_points = 20000;
    const Guess start{before.head(2), Vector::Constant(1, options.from), 0, {}};
    const Branch branch = trace(problem, start, options);
    CAPTURE(i, before.transpose(), behind.transpose(), options.max_step, branch.explanation);
    const bool returns = before(2) * behind(2) > 0;
    turned += static_cast<int>(returns);
    REQUIRE(branch.stop == (returns ? Stop::left_range : Stop::reached_end));
    const Vector end = behind * std::abs(before(2) / behind(2));
    REQUIRE_THAT((branch.points.back().unknowns - end.head(2)).norm(), WithinAbs(0, 1e-8 * end.norm()));
    const auto is_fold = [](const BranchPoint& point) {
      return is_turn(point.type) || point.type == PointType::corner_fold;
    };
    REQUIRE(std::count_if(branch.points.begin(), branch.points.end(), is_fold) == (returns ? 1 : 0));
    REQUIRE(std::none_of(branch.points.begin(), branch.points.end(),
                         [](const BranchPoint& point) { return point.type == PointType::branch_point; }));
  }
  CHECK(turned > 300);
}
