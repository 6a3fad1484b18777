#include "arcslip/continuation/atlas/fold_curves.hpp"

#include <cmath>

#include "arcslip/continuation/points/normal_form.hpp"
#include "arcslip/continuation/problem/second_derivative.hpp"
#include "arcslip/dense.hpp"

namespace arcslip::continuation {
namespace {

/// The shadow of the tangent plane, with two kinds of tests: w^T F_uu v v, 0 at cusps, and w^T dF/dp_a and
/// w^T dF/dp_b, 0 where the curve turns in p_b or in p_a, with dF/du v = 0 and w^T dF/du = 0.
class Shadow : public SurfaceFunction {
 public:
  Shadow(const Problem& problem, Surface& surface) : surface_(surface), second_(problem) {}

  double value(const Vector& /*at*/, const Matrix& plane) override { return Surface::shadow(plane); }
  bool vanishes_at_crossings() const override { return true; }

  bool look(const Matrix& /*plane*/, ZeroPoint& point) override {
    const Index n = surface_.size() - 2;
    const SingularAxes<Matrix> axes = singular_axes(Matrix(surface_.derivative().leftCols(n)));
    Vector left = axes.directions.col(n - 1);
    point.sense = (surface_.derivative().rightCols<2>().transpose() * left).normalized();
    left = left.cwiseQuotient(surface_.row_lengths());
    const Guess at = surface_.solution(point.at);
    const Vector right = axes.from.col(n - 1).cwiseProduct(surface_.scale());
    Vector along;
    if (!second_.contract(at.unknowns, at.parameters, at.regime, left, right,
                          Vector::Zero(at.parameters.size()), along))
      return false;
    point.tests = Eigen::Vector3d(along.head(n).dot(right), point.sense(0), point.sense(1));
    return true;
  }

 private:
  Surface& surface_;
  SecondDerivative second_;
};

/// A point as it is told. At a cusp, where both parameters turn, and at a pitchfork the tests of turning
/// points vanish too.
AtlasFold told(const Problem& problem, const Surface& surface, const ZeroPoint& point, int curve) {
  const Guess at = surface.solution(point.at);
  AtlasFold fold{{PointType::fold, curve, at.unknowns, at.parameters}};
  if (point.is_crossing) {
    fold.type = PointType::branch_point;
  } else if (point.zero == 0) {
    fold.type = PointType::cusp;
  } else if (point.zero > 0) {
    const int over = point.zero - 1;
    fold.type = turn_of_folds(problem, surface.sides()[static_cast<std::size_t>(over)].parameter, at);
    if (fold.type != PointType::fold) fold.turns = 1 - over;
  }
  return fold;
}

}  // namespace

std::vector<AtlasFold> fold_curves(const Problem& problem, Surface& surface, const std::vector<Disc>& discs,
                                   ZeroCurves& zeros) {
  std::vector<double> shadows;
  for (const Disc& disc : discs) shadows.push_back(Surface::shadow(disc.plane));
  const std::vector<bool> is_positive = zeros.signs(shadows);
  const auto is_fold = [&](const ZeroCurves::Edge& edge) { return ZeroCurves::differs(is_positive, edge); };
  Shadow shadow(problem, surface);
  std::vector<AtlasFold> folds;
  int number = 0;
  const auto add = [&](const std::vector<ZeroCurves::Curve>& curves) {
    for (const ZeroCurves::Curve& curve : curves) {
      for (const ZeroPoint& point : curve) folds.push_back(told(problem, surface, point, number));
      ++number;
    }
  };
  add(zeros.find(shadow, is_fold));
  add(zeros.find(shadow, [&](const auto& edge) { return zeros.turns_over(edge) && !is_fold(edge); }));
  return folds;
}

}  // namespace arcslip::continuation
