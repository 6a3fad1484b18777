#include "arcslip/continuation/atlas/ridges.hpp"

#include <algorithm>
#include <cmath>

#include "arcslip/continuation/points/extremum_problem.hpp"
#include "arcslip/continuation/points/normal_form.hpp"

namespace arcslip::continuation {
namespace {

/// t in a tangent plane, as long as p_b is steep in it.
Eigen::Vector2d along_branch(const Matrix& plane) {
  const Eigen::Vector2d rise = plane.bottomRows<1>().transpose();
  return {-rise(1), rise(0)};
}

/// dY . t, with the test d^2 Y along t.
class Slope : public SurfaceFunction {
 public:
  Slope(const Problem& problem, const Surface& surface, const std::vector<Disc>& discs, Index observable)
      : problem_(problem),
        surface_(surface),
        observable_(observable),
        extrema_(problem, surface.sides()[0].parameter, observable) {
    slope_.unknowns.setZero(problem.size());
    slope_.parameters.setZero(std::ssize(problem.parameter_names()));
    double largest = 0;
    for (const Disc& disc : discs) largest = std::max(largest, slope(disc.at, disc.plane).norm());
    if (largest > 0) size_ = largest;
  }

  double value(const Vector& at, const Matrix& plane) override {
    return slope(at, plane).dot(along_branch(plane)) / size_;
  }

  bool look(const Matrix& plane, ZeroPoint& point) override {
    const Guess at = surface_.solution(point.at);
    const BasePoint base{at.unknowns, at.parameters, at.regime, {}};
    point.tests = Vector::Zero(1);
    if (!extrema_.settle(base)) return stands_still(plane);
    point.tests(0) = plane.bottomRows<1>().squaredNorm() * extrema_.bend(base) / size_;
    return std::isfinite(point.tests(0));
  }

  /// Whether p_b does so on the surface.
  static bool stands_still(const Matrix& plane) {
    constexpr double rounding = 1e-6;  // where points are located to its square
    return plane.bottomRows<1>().norm() < rounding;
  }

 private:
  Eigen::Vector2d slope(const Vector& x, const Matrix& plane) {
    const Guess at = surface_.solution(x);
    problem_.observe(at.unknowns, at.parameters, at.regime, observable_, slope_);
    Vector by_x(x.size());
    by_x.head(x.size() - 2) = slope_.unknowns.cwiseProduct(surface_.scale());
    for (Index k = 0; k < 2; ++k) {
      const AtlasSide& side = surface_.sides()[static_cast<std::size_t>(k)];
      by_x(x.size() - 2 + k) = (side.high - side.low) * slope_.parameters(side.parameter);
    }
    return plane.transpose() * by_x;
  }

  const Problem& problem_;
  const Surface& surface_;
  Index observable_;
  ExtremumProblem extrema_;
  Gradient slope_;
  double size_ = 1;
};

PointType type_of(const Problem& problem, Surface& surface, const ZeroPoint& point) {
  if (point.is_crossing) return PointType::branch_point;
  if (point.zero < 0) return point.tests(0) < 0 ? PointType::peak : PointType::trough;
  Matrix plane;
  if (!surface.tangent(point.at, point.disc->plane, plane) || !Slope::stands_still(plane))
    return PointType::fold;
  return turn_of_folds(problem, surface.sides()[0].parameter, surface.solution(point.at));
}

}  // namespace

std::vector<AtlasRidge> ridges(const Problem& problem, Surface& surface, const std::vector<Disc>& discs,
                               ZeroCurves& zeros, const std::vector<std::string>& observables) {
  std::vector<AtlasRidge> all;
  int number = 0;
  for (const std::string& observable : observables) {
    Slope slope(problem, surface, discs, index_of(observable_names(problem), observable));
    std::vector<double> values;
    for (const Disc& disc : discs) values.push_back(slope.value(disc.at, disc.plane));
    const std::vector<bool> is_positive = zeros.signs(values);
    const auto has_zero = [&](const auto& edge) { return ZeroCurves::differs(is_positive, edge); };
    for (const ZeroCurves::Curve& curve : zeros.find(slope, has_zero)) {
      for (const ZeroPoint& point : curve) {
        const Guess at = surface.solution(point.at);
        all.push_back({{type_of(problem, surface, point), number, at.unknowns, at.parameters}, observable});
      }
      ++number;
    }
  }
  return all;
}

}  // namespace arcslip::continuation
