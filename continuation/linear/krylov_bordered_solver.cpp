#include "arcslip/continuation/linear/krylov_bordered_solver.hpp"

#include <Eigen/Jacobi>
#include <algorithm>
#include <cmath>
#include <limits>

#include "arcslip/continuation/linear/borders.hpp"
#include "arcslip/dense.hpp"

namespace arcslip::continuation {
namespace {

constexpr Index most_steps = 200;        // of a cycle
constexpr int most_cycles = 4;           // of a solution
constexpr double solved = 1e-13;         // of the right-hand side, or as near as rounding lets it come
constexpr double nearly_solved = 1e-10;  // where it comes no nearer

}  // namespace

KrylovBorderedSolver::KrylovBorderedSolver(Index size, Index borders)
    : BorderedSolver(size, borders),
      between_(borders, 0),
      basis_(size + borders, most_steps + 1),
      hessenberg_(most_steps + 1, most_steps) {}

void KrylovBorderedSolver::set_jacobian(const CondensedJacobian& jacobian, const Vector& /*column_scale*/) {
  jacobian_ = &jacobian;
}

/// Real eigenvalues of M^{-1} A below zero turn the sign.
double KrylovBorderedSolver::factor() {
  sign_ = std::numeric_limits<double>::quiet_NaN();
  near_ = jacobian_->precondition();
  if (near_ == nullptr || near_->sign() == 0) return sign_;
  borders_ = columns();
  borders_transposed_ = rows().transpose();
  Vector column;
  for (Index k = 0; k < borders(); ++k) {
    near_->solve(column = borders_.col(k));
    borders_.col(k) = column;
    near_->solve_transposed(column = borders_transposed_.col(k));
    borders_transposed_.col(k) = column;
  }
  between_.set_jacobian(Matrix(corner() - rows() * borders_), Vector::Ones(borders()));
  const double sign = near_->sign() * between_.factor();
  if (sign == 0) return sign_;
  Vector any = spread(size() + borders(), 0);
  precondition(any, false);
  const double enough = nearly_solved * any.norm();
  if (!(cycle(any, enough, false) <= enough)) return sign_;
  values_ = eigenvalues(hessenberg_.topLeftCorner(steps_, steps_));
  const auto turns = [](const Complex& value) { return value.imag() == 0 && value.real() < 0; };
  return sign_ = std::count_if(values_.begin(), values_.end(), turns) % 2 == 0 ? sign : -sign;
}

void KrylovBorderedSolver::multiply_determinant(LogProduct& product) const {
  near_->multiply_determinant(product);
  between_.multiply_determinant(product);
  for (const Complex& value : values_) product *= std::abs(value);
}

void KrylovBorderedSolver::solve(Vector& right_hand_side) { iterate(right_hand_side, false); }

void KrylovBorderedSolver::solve_transposed(Vector& right_hand_side) { iterate(right_hand_side, true); }

void KrylovBorderedSolver::multiply(const Vector& x, bool transposed, Vector& out) {
  const auto& active = jacobian_->active();
  spread_.setZero(jacobian_->weight().size());
  spread_(active) = x.head(size());
  out.resize(x.size());
  if (transposed) {
    jacobian_->couple_transposed(spread_, coupled_);
    out.head(size()) = x.head(size()) + coupled_(active) + rows().transpose() * x.tail(borders());
    out.tail(borders()) = columns().transpose() * x.head(size()) + corner().transpose() * x.tail(borders());
  } else {
    jacobian_->couple(spread_, coupled_);
    out.head(size()) = x.head(size()) + coupled_(active) + columns() * x.tail(borders());
    out.tail(borders()) = rows() * x.head(size()) + corner() * x.tail(borders());
  }
}

void KrylovBorderedSolver::precondition(Vector& x, bool transposed) {
  Vector own = x.head(size());
  Vector rest = x.tail(borders());
  if (transposed) {
    near_->solve_transposed(own);
    rest -= columns().transpose() * own;
    between_.solve_transposed(rest);
    x.tail(borders()) = rest;
    x.head(size()) = own - borders_transposed_ * rest;
  } else {
    near_->solve(own);
    rest -= rows() * own;
    between_.solve(rest);
    x.tail(borders()) = rest;
    x.head(size()) = own - borders_ * rest;
  }
}

/// Replaces the right-hand side by the solution, in cycles for what the last ones left.
void KrylovBorderedSolver::iterate(Vector& x, bool transposed) {
  const Vector right = x;
  Vector left = right;
  Vector product;
  double whole = 0;
  double last = std::numeric_limits<double>::infinity();
  x.setZero();
  for (int i = 0; i < most_cycles; ++i) {
    precondition(left, transposed);
    const double length = left.norm();
    if (i == 0) whole = length;
    const bool stands = !(length < 0.1 * last);
    if (length <= solved * whole || (stands && length <= nearly_solved * whole)) return;
    if (stands) break;
    last = length;
    cycle(left, solved * whole, transposed);
    x += left;
    multiply(x, transposed, product);
    left = right - product;
  }
  x.setConstant(std::numeric_limits<double>::quiet_NaN());
}

/// One run of GMRES for M^{-1} r, which it replaces by the correction, until so much of it is left, which it
/// returns.
double KrylovBorderedSolver::cycle(Vector& x, double enough, bool transposed) {
  Matrix triangle(most_steps + 1, most_steps);
  std::vector<Eigen::JacobiRotation<double>> rotations;
  Vector left = Vector::Zero(most_steps + 1);
  left(0) = x.norm();
  basis_.col(0) = x / left(0);
  Vector next;
  Vector part;
  for (steps_ = 0; steps_ < most_steps && std::abs(left(steps_)) > enough;) {
    const Index k = steps_++;
    const auto known = basis_.leftCols(k + 1);
    multiply(basis_.col(k), transposed, next);
    precondition(next, transposed);
    auto column = hessenberg_.col(k);
    column.setZero();
    for (int twice = 0; twice < 2; ++twice) {
      part.noalias() = known.transpose() * next;
      next.noalias() -= known * part;
      column.head(k + 1) += part;
    }
    column(k + 1) = next.norm();
    triangle.col(k) = column;
    for (Index i = 0; i < k; ++i)
      triangle.col(k).applyOnTheLeft(i, i + 1, rotations[static_cast<std::size_t>(i)].adjoint());
    double length = 0;
    Eigen::JacobiRotation<double>& rotation = rotations.emplace_back();
    rotation.makeGivens(triangle(k, k), triangle(k + 1, k), &length);
    triangle(k, k) = length;
    left.applyOnTheLeft(k, k + 1, rotation.adjoint());
    if (!(column(k + 1) > 0)) break;
    basis_.col(k + 1) = next / column(k + 1);
  }
  const Vector along =
      triangle.topLeftCorner(steps_, steps_).triangularView<Eigen::Upper>().solve(left.head(steps_));
  x.noalias() = basis_.leftCols(steps_) * along;
  return std::abs(left(steps_));
}

}  // namespace arcslip::continuation
