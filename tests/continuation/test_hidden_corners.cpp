// Corners that no border tells of, at any angle and wherever steps come to lie.

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "arcslip/continuation/path/trace.hpp"
#include "branches.hpp"
#include "catch.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;

namespace {

/// F = A z + c max(0, g . z) + d max(0, h . z - h . z_1) of z = (u_1, u_2, p - p_0): a line that has corners
/// at z = 0 and, a distance behind it, at z_1.
class BrokenLine : public Problem {
 public:
  BrokenLine(std::mt19937& random, double distance) : distance_(distance) {
    std::normal_distribution<double> normal;
    const auto draw = [&] { return normal(random); };
    jacobian_ = Matrix::NullaryExpr(2, 3, draw);
    for (Corner& corner : corners_) {
      corner.kink = Vector::NullaryExpr(2, draw);
      corner.gradient = Vector::NullaryExpr(3, draw);
    }
    place_ = 1 + std::abs(draw());
    if (corners_[1].gradient.dot(behind(1)) < 0) corners_[1].gradient *= -1;
    corners_[1].level = distance * corners_[1].gradient.dot(behind(1));
  }

  /// Where it leads from a corner, backwards from the first one, forwards from either.
  Vector before() const { return -direction(jacobian_, corners_[0]); }
  Vector behind(std::size_t corner) const {
    Matrix jacobian = jacobian_;
    for (std::size_t i = 0; i < corner; ++i) jacobian += corners_[i].kink * corners_[i].gradient.transpose();
    return direction(jacobian, corners_[corner - 1]);
  }
  double place() const { return place_; }

  /// Whether no end comes over the other corner's border again.
  bool is_simple() const {
    return corners_[1].gradient.dot(before()) < 0 && corners_[0].gradient.dot(behind(2)) > 0;
  }
  /// Where p is back at its value a unit before the first corner, or as far beyond it.
  Vector end() const {
    const Vector first = distance_ * behind(1);
    const double to = std::copysign(before()(2), behind(2)(2));
    return first + (to - first(2)) / behind(2)(2) * behind(2);
  }

  Index size() const override { return 2; }
  std::vector<std::string> parameter_names() const override { return {"p"}; }
  bool evaluate(const Vector& u, const Vector& p, const Regime& /*regime*/,
                const Evaluation& out) const override {
    const Vector z = Vector3(u(0), u(1), p(0) - place_);
    Vector residual = jacobian_ * z;
    Matrix jacobian = jacobian_;
    for (const Corner& corner : corners_) {
      const double passed = corner.gradient.dot(z) - corner.level;
      if (!(passed > 0)) continue;
      residual += corner.kink * passed;
      jacobian += corner.kink * corner.gradient.transpose();
    }
    if (out.residual != nullptr) *out.residual = residual;
    if (out.jacobian != nullptr) *out.jacobian = jacobian.leftCols(2);
    if (out.parameter_jacobian != nullptr) *out.parameter_jacobian = jacobian.rightCols(1);
    return true;
  }

 private:
  using Vector3 = Eigen::Vector3d;
  struct Corner {
    Vector kink, gradient;
    double level = 0;
  };

  static Vector direction(const Matrix& jacobian, const Corner& over) {
    const Vector3 along = Vector3(jacobian.row(0)).cross(Vector3(jacobian.row(1))).normalized();
    return over.gradient.dot(along) > 0 ? along : Vector3(-along);
  }

  double distance_;
  Matrix jacobian_;
  std::array<Corner, 2> corners_;
  double place_;
};

/// How many of some random lines turn back over p.
int check_broken_lines(int count, double nearest, double farthest) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> of_step(-3, -0.5);
  std::uniform_real_distribution<double> of_distance(std::log10(nearest), std::log10(farthest));
  int turned = 0;
  for (int i = 0; i < count; ++i) {
    const double distance = std::pow(10, of_distance(random));
    const BrokenLine line(random, distance);
    constexpr double steep = 0.05;  // a branch over p is to have one
    const double rate = line.before()(2);
    const double between = line.behind(1)(2);
    const double last = line.behind(2)(2);
    if (!line.is_simple() || std::abs(rate) < steep || std::abs(between) < steep || std::abs(last) < steep)
      continue;
    TraceOptions options;
    options.parameter = "p";
    options.from = line.place() + rate;
    options.to = line.place() - rate;
    options.max_step = std::pow(10, of_step(random));
    options.max_points = 20000;
    const Guess start{line.before().head(2), Vector::Constant(1, options.from), 0, {}};
    const Branch branch = trace(line, start, options);
    CAPTURE(i, options.max_step, branch.explanation);
    const bool returns = rate * last > 0;
    turned += static_cast<int>(returns);
    REQUIRE(branch.stop == (returns ? Stop::left_range : Stop::reached_end));
    const Vector end = line.end();
    REQUIRE((branch.points.back().unknowns - end.head(2)).norm() < 1e-8 * (1 + end.norm()));
    REQUIRE(of_type(branch, PointType::branch_point).empty());
    const std::size_t folds =
        of_type(branch, PointType::fold).size() + of_type(branch, PointType::corner_fold).size();
    const std::size_t turns =
        static_cast<std::size_t>(rate * between > 0) + static_cast<std::size_t>(between * last < 0);
    if (options.max_step < 0.5 * distance)
      REQUIRE(folds == turns);  // a longer one may pass a fold and one back
  }
  return turned;
}

}  // namespace

TEST_CASE("A branch goes on behind corners of any angle, wherever its steps end") {
  CHECK(check_broken_lines(3000, 0.01, 0.1) > 150);
}

TEST_CASE("A branch goes on behind two corners of any angle within a step, however near they are") {
  CHECK(check_broken_lines(3000, 1e-9, 0.01) > 150);
}
