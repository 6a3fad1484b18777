#include "arcslip/continuation/points/codimension_two.hpp"

#include <algorithm>
#include <cmath>

#include "arcslip/continuation/linear/borders.hpp"
#include "arcslip/continuation/points/centre_manifold.hpp"
#include "arcslip/continuation/points/fold_problem.hpp"
#include "arcslip/continuation/points/hopf_problem.hpp"
#include "arcslip/continuation/problem/second_derivative.hpp"

namespace arcslip::continuation {
namespace {

using Names = std::vector<std::string>;

/// Of what `read` takes from the centre manifold.
template <class Read>
std::optional<NormalForm> form_on(const Problem& base, const Guess& at, bool has_zero,
                                  const std::vector<double>& omegas, int order, const Names& names,
                                  const Read& read) {
  auto manifold = CentreManifold::at(base, at, has_zero, omegas);
  if (!manifold) return std::nullopt;
  Vector numbers;
  const Estimated found = with_best_reach(base, numbers, [&](Expansion& expansion, Vector& out) {
    if (!manifold->reduce(expansion, order)) return false;
    out = read(*manifold);
    return true;
  });
  if (!found.exists) return std::nullopt;
  NormalForm form;
  for (std::size_t i = 0; i < names.size(); ++i)
    form.coefficients.push_back({names[i], numbers(static_cast<Index>(i))});
  form.error = found.error;
  return form;
}

/// A with null vectors, at a fold.
class AtFold {
 public:
  AtFold(const Problem& base, Index active, const Guess& at)
      : point_{at.unknowns, at.parameters, at.regime, {}}, fold_(base, active), at_(base), second_(base) {
    if (!fold_.settle(point_) || !at_.evaluate(at.unknowns, at.parameters, at.regime)) return;
    right_ = fold_.right_null().normalized();
    left_ = fold_.left_null().normalized();
    size_ = column_size(at_, Vector::Ones(base.size()));
    solver_ = at_.make_solver(1);
    at_.fill(*solver_, Vector::Ones(base.size()));
    solver_->columns().col(0) = size_ * left_;
    solver_->rows().row(0) = right_.transpose();
    solver_->corner().setZero();
    exists_ = solver_->factor() != 0;
  }

  bool exists() const { return exists_; }
  const Vector& right() const { return right_; }
  const Vector& left() const { return left_; }
  double size() const { return size_; }
  const Linearization& at() const { return at_; }

  /// A x = b but for what of b is not in the range of A, x orthogonal to the null vector; and A^T x = b.
  Vector solve(const Vector& b) { return solve(b, false); }
  Vector solve_transposed(const Vector& b) { return solve(b, true); }

  /// w^T of the second derivative along v, by all unknowns and parameters.
  [[nodiscard]] bool contract(const Vector& w, const Vector& v, Vector& row) {
    const Vector none = Vector::Zero(point_.parameters.size());
    return second_.contract(point_.unknowns, point_.parameters, point_.regime, w, v, none, row);
  }

 private:
  Vector solve(const Vector& b, bool transposed) {
    Vector x = padded(b, b.size() + 1);
    if (transposed) {
      solver_->solve_transposed(x);
    } else {
      solver_->solve(x);
    }
    return x.head(b.size());
  }

  BasePoint point_;
  FoldProblem fold_;
  Linearization at_;
  SecondDerivative second_;
  Vector right_;
  Vector left_;
  double size_ = 0;
  std::unique_ptr<BorderedSolver> solver_;
  bool exists_ = false;
};

/// Whether F and its slope along the null vector, as projected on the left one, vary with both parameters as
/// they do at a cusp.
bool is_unfolded(AtFold& fold, const Problem& base, const Guess& at, Index active, Index other) {
  constexpr double rounding = 1e-6;  // of second derivatives and of how well the point is located
  Vector scale(base.size());
  Vector parameter_scale(at.parameters.size());
  base.scale(at.unknowns, at.parameters, scale, parameter_scale);
  Vector row;
  if (!fold.contract(fold.left(), fold.right(), row)) return true;
  const double stretch = scale.cwiseAbs().maxCoeff();
  Matrix changes(2, 2);
  Index column = 0;
  for (const Index parameter : {active, other}) {
    const Vector by = fold.at().parameter_jacobian().col(parameter);
    const Vector response = -fold.solve(by);
    changes.col(column++) =
        parameter_scale(parameter) / fold.size() *
        Eigen::Vector2d(fold.left().dot(by) / stretch,
                        row.head(base.size()).dot(response) + row(base.size() + parameter));
  }
  return std::abs(changes.determinant()) > rounding;
}

std::optional<NormalForm> cusp_form(const Problem& base, const Guess& at, Index active, Index other) {
  if (!base.is_equilibrium() && !base.is_map()) return std::nullopt;
  auto form = form_on(base, at, true, {}, 3, {"c"}, [](const CentreManifold& manifold) {
    return Vector::Constant(1, manifold.coefficient(0, {3}).real());
  });
  AtFold fold(base, active, at);
  if (form && fold.exists()) form->is_regular = is_unfolded(fold, base, at, active, other);
  return form;
}

std::optional<NormalForm> bogdanov_takens_form(const Problem& base, const Guess& at, Index active) {
  AtFold fold(base, active, at);
  if (!fold.exists()) return std::nullopt;
  const Index n = base.size();
  const Vector& q0 = fold.right();
  const Vector q1 = fold.solve(q0);
  const Vector p1 = fold.left() / fold.left().dot(q1);
  Vector p0 = fold.solve_transposed(p1);
  p0 -= p0.dot(q1) * p1;
  Vector by_p1;
  Vector by_p0;
  if (!fold.contract(p1, q0, by_p1) || !fold.contract(p0, q0, by_p0)) return std::nullopt;
  const double a = 0.5 * by_p1.head(n).dot(q0);
  const double b = by_p0.head(n).dot(q0) + by_p1.head(n).dot(q1);
  if (!std::isfinite(a) || !std::isfinite(b)) return std::nullopt;
  return NormalForm{{{"a", std::abs(a)}, {"b", std::copysign(1, a) * b}}};
}

std::optional<NormalForm> generalized_hopf_form(const Problem& base, const Guess& at, double omega) {
  return form_on(base, at, false, {omega}, 5, {"omega", "l2"}, [&](const CentreManifold& manifold) {
    return Eigen::Vector2d(omega, manifold.coefficient(0, {3, 2}).real() / omega);
  });
}

/// Cubic terms but for e are taken away by w -> w + x v w, v -> v + y v^2 and the speed of time; see the
/// header.
std::optional<NormalForm> zero_hopf_form(const Problem& base, const Guess& at, double omega) {
  const Names names{"omega", "b", "c", "d", "e", "s", "theta"};
  return form_on(base, at, true, {omega}, 3, names, [&](const CentreManifold& manifold) {
    const auto of = [&](std::size_t variable, const Exponents& a) {
      return manifold.coefficient(variable, a).real();
    };
    const double b = of(0, {2});
    const double c = of(0, {0, 1, 1});
    const double d = of(1, {1, 1});
    const double e = of(1, {2, 1}) - b / c * of(1, {0, 2, 1}) +
                     d * (of(1, {0, 2, 1}) / c + 0.5 * of(0, {1, 1, 1}) / c - 1.5 * of(0, {3}) / b);
    const double way = std::copysign(1, b);  // of the null vector, which is not told which way to go
    Vector found(7);
    found << omega, way * b, way * c, way * d, e, b * c > 0 ? 1 : -1, d / b;
    return found;
  });
}

std::optional<NormalForm> double_hopf_form(const Problem& base, const Guess& at, double first,
                                           double second) {
  const Names names{"omega_1", "omega_2", "p11", "p12", "p21", "p22", "theta", "delta"};
  return form_on(base, at, false, {first, second}, 3, names, [&](const CentreManifold& manifold) {
    const double p11 = manifold.coefficient(0, {2, 1}).real();
    const double p12 = manifold.coefficient(0, {1, 0, 1, 1}).real();
    const double p21 = manifold.coefficient(2, {1, 1, 1}).real();
    const double p22 = manifold.coefficient(2, {0, 0, 2, 1}).real();
    Vector found(8);
    found << first, second, p11, p12, p21, p22, p12 / p22, p21 / p11;
    return found;
  });
}

/// The imaginary parts of the pairs nearest to the imaginary axis.
std::vector<double> nearest_pairs(const Problem& base, const Guess& at) {
  ComplexVector values;
  if (!base.eigenvalues(at.unknowns, at.parameters, at.regime, values)) return {};
  std::sort(values.begin(), values.end(),
            [](const Complex& a, const Complex& b) { return std::abs(a.real()) < std::abs(b.real()); });
  std::vector<double> omegas;
  for (const Complex& value : values) {
    if (value.imag() > 0) omegas.push_back(value.imag());
  }
  return omegas;
}

}  // namespace

std::optional<NormalForm> codimension_two_form(const ExtendedProblem& curve, Index parameter,
                                               const BranchPoint& point) {
  const bool is_of_folds = dynamic_cast<const FoldProblem*>(&curve) != nullptr;
  const bool is_of_hopf = dynamic_cast<const HopfProblem*>(&curve) != nullptr;
  if (!is_of_folds && !is_of_hopf) return std::nullopt;
  const Problem& base = curve.base();
  const BasePoint of_base = curve.split(point.unknowns, point.parameters, point.regime);
  const Guess at{of_base.unknowns, of_base.parameters, of_base.regime, {}};
  if (point.type == PointType::cusp) return cusp_form(base, at, curve.active(), parameter);
  if (point.type == PointType::bogdanov_takens) return bogdanov_takens_form(base, at, curve.active());
  const bool has_pairs = point.type == PointType::generalized_hopf || point.type == PointType::zero_hopf ||
                         point.type == PointType::hopf_hopf;
  if (!has_pairs) return std::nullopt;
  std::vector<double> omegas = nearest_pairs(base, at);
  if (is_of_hopf) {  // its own is known better
    const double own = std::sqrt(std::max(0.0, of_base.extras(0)));
    const auto nearest = std::min_element(omegas.begin(), omegas.end(), [&](double a, double b) {
      return std::abs(a - own) < std::abs(b - own);
    });
    if (nearest == omegas.end()) return std::nullopt;
    omegas.erase(nearest);
    omegas.insert(omegas.begin(), own);
  }
  if (omegas.empty() || !(omegas[0] > 0)) return std::nullopt;
  if (point.type == PointType::generalized_hopf) return generalized_hopf_form(base, at, omegas[0]);
  if (point.type == PointType::zero_hopf) return zero_hopf_form(base, at, omegas[0]);
  if (omegas.size() < 2) return std::nullopt;
  return double_hopf_form(base, at, std::max(omegas[0], omegas[1]), std::min(omegas[0], omegas[1]));
}

}  // namespace arcslip::continuation
