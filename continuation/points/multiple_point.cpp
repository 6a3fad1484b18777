#include "arcslip/continuation/points/multiple_point.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>

#include "arcslip/continuation/linear/borders.hpp"
#include "arcslip/continuation/problem/linearization.hpp"
#include "arcslip/continuation/problem/second_derivative.hpp"
#include "arcslip/dense.hpp"
#include "arcslip/zero_between.hpp"

namespace arcslip::continuation {
namespace {

/// The null space of [dF/du dF/dp_a] where it has three dimensions, in the problem's scale:
///
///   [dF/du dF/dp_a B] [W]   [0]
///   [C^T           0] [G] = [1],   G = 0,   psi^T [dF/du dF/dp_a] = 0,   psi^T B = 1.
class DoublePoint {
 public:
  DoublePoint(const Problem& problem, Index active, Guess at)
      : problem_(problem),
        active_(active),
        at_(std::move(at)),
        n_(problem.size()),
        linear_(problem),
        second_(problem),
        solver_(make_bordered_solver(n_, 3, problem.sparse())),
        scale_(n_ + 1) {}

  const Guess& at() const { return at_; }
  const Matrix& null_space() const { return right_; }
  /// How far from here, in the scale, the conditions may hold: by the largest of them over how fast they
  /// change, after `set_forms`; and the same of the matrix with its borders being singular.
  double away() const { return conditions_.cwiseAbs().maxCoeff() / largest_slope(); }
  double away_from_more() const;
  double residual() const { return linear_.residual().lpNorm<Eigen::Infinity>(); }

  /// Chooses borders here. False where the matrix is singular with them to the last digit.
  [[nodiscard]] bool settle();

  /// Moves by one Newton correction of F = 0 and, by least squares, of G = 0, after `set_forms`.
  void correct();

  void move_to(const Guess& at) {
    at_ = at;
    static_cast<void>(settle());
  }
  /// The largest entry of the difference, in the scale.
  double away_from(const Guess& other) const {
    Vector way(n_ + 1);
    way << at_.unknowns - other.unknowns, at_.parameters(active_) - other.parameters(active_);
    return way.cwiseQuotient(scale_).lpNorm<Eigen::Infinity>();
  }

  /// psi_i^T F_zz w_j w_k, by i.
  [[nodiscard]] bool set_forms();
  Eigen::Vector2d quadratic(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
    return {a.dot(forms_[0] * b), a.dot(forms_[1] * b)};
  }

  /// psi^T (F_zzz d d d + 3 F_zz d h)/6 with F_z h = -F_zz d d, d = W y; nan where F has no value.
  Eigen::Vector2d cubic(const Eigen::Vector3d& y);

  /// d in the problem's units, and back from there.
  Vector direction(const Eigen::Vector3d& y) const { return scale_.cwiseProduct(right_ * y); }
  Eigen::Vector3d coordinates(const Vector& d) const {
    return shortest(right_, Vector(d.cwiseQuotient(scale_)));
  }

 private:
  double largest_slope() const {
    return std::max(forms_[0].cwiseAbs().maxCoeff(), forms_[1].cwiseAbs().maxCoeff());
  }
  Vector parameters(double value) const { return value * Vector::Unit(at_.parameters.size(), active_); }
  [[nodiscard]] bool solve_borders();
  /// psi^T F_zz d at d h from here, n + 1 by 2 in the scale.
  [[nodiscard]] bool rows(const Vector& d, double h, Matrix& out);

  const Problem& problem_;
  Index active_;
  Guess at_;
  Index n_;
  Linearization linear_;
  SecondDerivative second_;
  std::unique_ptr<BorderedSolver> solver_;
  Vector scale_;
  double size_ = 1;    // of dF/du
  Matrix columns_;     // B
  Matrix border_;      // C, n + 1 by 3
  Matrix left_;        // psi, n by 2
  Matrix right_;       // W, n + 1 by 3
  Matrix conditions_;  // G, 2 by 3
  std::array<Eigen::Matrix3d, 2> forms_;
};

bool DoublePoint::solve_borders() {
  linear_.fill(*solver_, scale_.head(n_));
  solver_->columns() << linear_.parameter_jacobian().col(active_) * scale_(n_), columns_;
  solver_->rows() = border_.topRows(n_).transpose();
  solver_->corner().setZero();
  solver_->corner().col(0) = border_.row(n_).transpose();
  if (solver_->factor() == 0) return false;
  left_.resize(n_, 2);
  right_.resize(n_ + 1, 3);
  conditions_.resize(2, 3);
  Vector side;
  for (Index j = 0; j < 3; ++j) {
    side = Vector::Unit(n_ + 3, n_ + j);
    solver_->solve(side);
    right_.col(j) = side.head(n_ + 1);
    conditions_.col(j) = side.tail(2);
    if (j == 0) continue;
    side = Vector::Unit(n_ + 3, n_ + j);
    solver_->solve_transposed(side);
    left_.col(j - 1) = side.head(n_);
  }
  return left_.allFinite() && right_.allFinite();
}

bool DoublePoint::settle() {
  if (!linear_.evaluate(at_.unknowns, at_.parameters, at_.regime)) return false;
  Vector unknowns(n_);
  Vector all(at_.parameters.size());
  problem_.scale(at_.unknowns, at_.parameters, unknowns, all);
  scale_ << unknowns, all(active_);
  size_ = column_size(linear_, unknowns);
  left_.resize(n_, 2);
  right_.resize(n_ + 1, 3);
  for (int j = 0; j < 2; ++j) left_.col(j) = spread(n_, 1 + 2 * j);
  for (int j = 0; j < 3; ++j) right_.col(j) = spread(n_ + 1, 2 + 2 * j);
  for (int i = 0; i < 4; ++i) {  // inverse iteration
    columns_ = size_ * orthonormal(left_);
    border_ = orthonormal(right_);
    if (!solve_borders()) return false;
  }
  return true;
}

/// A solution with a right-hand side without preference is as long as the inverse is large.
double DoublePoint::away_from_more() const {
  Vector side = spread(n_ + 3, 1);
  side.head(n_) *= size_;
  solver_->solve(side);
  return 1 / (side.norm() * largest_slope());
}

bool DoublePoint::rows(const Vector& d, double h, Matrix& out) {
  const Vector dp = parameters(d(n_));
  Matrix all;
  if (!second_.contract(at_.unknowns + h * d.head(n_), at_.parameters + h * dp, at_.regime, left_, d.head(n_),
                        dp, all))
    return false;
  out.resize(n_ + 1, 2);
  out << all.topRows(n_), all.row(n_ + active_);
  out = scale_.asDiagonal() * out;
  return out.allFinite();
}

bool DoublePoint::set_forms() {
  for (Index j = 0; j < 3; ++j) {
    Matrix row;
    if (!rows(scale_.cwiseProduct(right_.col(j)), 0, row)) return false;
    for (std::size_t i = 0; i < 2; ++i)
      forms_[i].row(j) = row.col(static_cast<Index>(i)).transpose() * right_;
  }
  for (Eigen::Matrix3d& form : forms_) form = 0.5 * (form + form.transpose().eval());
  return true;
}

void DoublePoint::correct() {
  Matrix gradients(6, 3);
  gradients << forms_[0], forms_[1];
  Vector values(6);
  values << conditions_.row(0).transpose(), conditions_.row(1).transpose();
  Vector correction = Vector::Zero(n_ + 3);
  correction.head(n_) = -linear_.residual();
  solver_->solve(correction);
  const Vector along = shortest(gradients, values);
  const Vector all = scale_.cwiseProduct(correction.head(n_ + 1) + right_ * along);
  at_.unknowns += all.head(n_);
  at_.parameters(active_) += all(n_);
}

Eigen::Vector2d DoublePoint::cubic(const Eigen::Vector3d& y) {
  const Eigen::Vector2d none = Eigen::Vector2d::Constant(std::nan(""));
  const Vector d = direction(y);
  const Vector dp = parameters(d(n_));
  const double step = 0.02 / second_.length(at_.unknowns, at_.parameters, d.head(n_), dp);
  Vector bend;
  const auto first_at = [&](double h, Vector& out) {
    if (!linear_.evaluate(at_.unknowns + h * d.head(n_), at_.parameters + h * dp, at_.regime)) return false;
    out.resize(n_);
    linear_.multiply(d.head(n_), out);
    out += linear_.parameter_jacobian().col(active_) * d(n_);
    return true;
  };
  Matrix row;
  Vector third;
  const auto second_at = [&](double h, Vector& out) {
    if (!rows(d, h, row)) return false;
    out = row.transpose() * d.cwiseQuotient(scale_);
    return true;
  };
  if (!std::isfinite(differentiate(first_at, step, bend).error) ||
      !std::isfinite(differentiate(second_at, step, third).error) || !rows(d, 0, row))
    return none;
  Vector response = Vector::Zero(n_ + 3);
  response.head(n_) = -bend;
  solver_->solve(response);
  return (third + 3 * row.transpose() * response.head(n_ + 1)) / 6;
}

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a(0) * b(1) - a(1) * b(0); }

Eigen::Vector2d on_circle(double angle) { return {std::cos(angle), std::sin(angle)}; }

/// Where a form of low degree in two variables changes its sign, as angles on half a circle.
std::vector<double> zeros_on_half_circle(const std::function<double(double angle)>& form) {
  constexpr int places = 180;
  constexpr double begin = 0.1;  // no place of a symmetric form's zeros
  std::vector<double> zeros;
  double from = begin;
  double at_from = form(from);
  for (int i = 1; i <= places; ++i) {
    const double to = begin + pi * i / places;
    const double at_to = form(to);
    if (at_from * at_to < 0) zeros.push_back(zero_between(form, from, to, at_from, at_to));
    from = to;
    at_from = at_to;
  }
  return zeros;
}

/// Whether it comes to zero and keeps its sign.
bool touches_zero(const std::function<double(double angle)>& form) {
  constexpr int places = 180;
  constexpr double nothing = 1e-6;  // of the largest
  std::array<double, places + 2> values;
  double largest = 0;
  for (int i = 0; i < places + 2; ++i) {
    double& value = values[static_cast<std::size_t>(i)];
    value = form(pi * i / places);
    largest = std::max(largest, std::abs(value));
  }
  for (std::size_t i = 1; i + 1 < values.size(); ++i) {
    const double sign = values[i] < 0 ? -1 : 1;
    const double before = sign * values[i - 1];
    const double here = sign * values[i];
    const double behind = sign * values[i + 1];
    if (!(before > here && behind >= here)) continue;
    const double least = here - (behind - before) * (behind - before) / (8 * (before - 2 * here + behind));
    if (least < nothing * largest) return true;
  }
  return false;
}

/// The other branches through a double point: y = E x + y_0 t, in the coordinates of its null space.
class OtherBranches {
 public:
  OtherBranches(DoublePoint& point, const Eigen::Vector3d& own, double negligible)
      : point_(point), own_(own.normalized()), negligible_(negligible) {
    across_ = perpendicular(own_);
    for (Index j = 0; j < 2; ++j) b_.col(j) = 2 * point.quadratic(own_, across_.col(j));
  }

  /// Whether all of them are told: none leave along a direction in which others do as well.
  bool is_whole() const { return is_whole_; }

  std::vector<Eigen::Vector3d> all() {
    if (!(std::abs(b_.determinant()) > negligible_ * b_.squaredNorm())) return {};
    const auto second = [this](double angle) {
      const Eigen::Vector3d x = across_ * on_circle(angle);
      return point_.quadratic(x, x);
    };
    if (tells(second, b_.norm())) return zeros(second);
    Eigen::Matrix4d powers;
    Eigen::Matrix<double, 4, 2> values;
    for (Index i = 0; i < 4; ++i) {
      const double angle = places[static_cast<std::size_t>(i)];
      powers.row(i) = cubes(angle).transpose();
      values.row(i) = point_.cubic(at(angle)).transpose();
    }
    const Eigen::Matrix<double, 2, 4> terms = (powers.inverse() * values).transpose();
    const auto third = [&](double angle) -> Eigen::Vector2d { return terms * cubes(angle); };
    return tells(third, terms.norm()) ? zeros(third) : std::vector<Eigen::Vector3d>();
  }

 private:
  static constexpr std::array<double, 4> places{0.1, 0.9, 1.7, 2.5};  // on the half circle, of any form

  static Eigen::Vector4d cubes(double angle) {
    const Eigen::Vector2d x = on_circle(angle);
    return {x(0) * x(0) * x(0), x(0) * x(0) * x(1), x(0) * x(1) * x(1), x(1) * x(1) * x(1)};
  }

  /// By the terms of second order: t b x + q(x) has no part along b x.
  Eigen::Vector3d at(double angle) const {
    const Eigen::Vector2d bx = b_ * on_circle(angle);
    const Eigen::Vector3d x = across_ * on_circle(angle);
    return x - bx.dot(point_.quadratic(x, x)) / bx.squaredNorm() * own_;
  }

  /// Whether what is beside b x is more than rounding of terms of such a size.
  template <class Terms>
  bool tells(const Terms& terms, double size) const {
    return std::any_of(places.begin(), places.end(), [&](double angle) {
      return std::abs(cross(b_ * on_circle(angle), terms(angle))) > negligible_ * b_.norm() * size;
    });
  }

  template <class Terms>
  std::vector<Eigen::Vector3d> zeros(const Terms& terms) {
    const auto beside = [&](double angle) { return cross(b_ * on_circle(angle), terms(angle)); };
    std::vector<Eigen::Vector3d> found;
    for (const double angle : zeros_on_half_circle(beside)) found.push_back(at(angle));
    is_whole_ = !touches_zero(beside);
    return found;
  }

  DoublePoint& point_;
  Eigen::Vector3d own_;
  double negligible_;
  bool is_whole_ = true;
  Eigen::Matrix<double, 3, 2> across_;  // E
  Eigen::Matrix2d b_;
};

/// As its own conditions have it, or where they do not find it there as it was.
void locate(DoublePoint& point, double near) {
  const Guess begun = point.at();
  const double residual = point.residual();
  bool is_settled = true;
  for (int i = 0; i < 2 && is_settled; ++i) {
    is_settled = point.set_forms();
    if (is_settled) point.correct();
    is_settled = is_settled && point.settle();
  }
  if (is_settled && point.away_from(begun) < near && point.residual() <= residual) return;
  point.move_to(begun);
}

}  // namespace

std::optional<MultiplePoint> multiple_point(const Problem& problem, Index active, const Guess& branch,
                                            const Tolerances& tolerances) {
  if (problem.size() < 2) return std::nullopt;
  DoublePoint point(problem, active, branch);
  const MultiplePoint untold{branch, false, {}};
  if (!point.settle()) return untold;
  if (!point.set_forms() || !(point.away() < tolerances.same_point)) return std::nullopt;
  if (!(point.away_from_more() > tolerances.same_point)) return untold;
  locate(point, tolerances.same_point);
  MultiplePoint found{point.at(), true, {}};
  if (!point.set_forms()) return found;
  OtherBranches others(point, point.coordinates(branch.direction), tolerances.turns);
  for (const Eigen::Vector3d& way : others.all()) found.directions.push_back(point.direction(way));
  found.is_whole = others.is_whole();
  return found;
}

}  // namespace arcslip::continuation
