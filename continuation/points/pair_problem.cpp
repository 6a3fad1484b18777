#include "arcslip/continuation/points/pair_problem.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "arcslip/continuation/linear/borders.hpp"
#include "arcslip/dense.hpp"

namespace arcslip::continuation {
namespace {

Vector place(const BasePoint& point) {
  Vector all(point.unknowns.size() + point.parameters.size());
  all << point.unknowns, point.parameters;
  return all;
}

}  // namespace

PairProblem::PairProblem(const Problem& base, Index active)
    : ExtendedProblem(base, active, 2),
      count_(base.size()),
      solver_(make_bordered_solver(2 * count_, 4, base.sparse())),
      frame_(Matrix::Zero(count_, 2)),
      start_(Pair::Zero()),
      second_(base),
      pair_(Pair::Zero()) {}

Vector PairProblem::scales() const {
  Vector both(2 * count_);
  both << scale_, scale_;
  return both;
}

/// By L = [0 1; -b a], with which two borders suffice unless there are two null vectors.
bool PairProblem::begin(double kappa) {
  const double a = sum(kappa).value;
  const double b = product(kappa).value;
  const Index n = count_;
  const double size = column_size(at_, scale_);
  const auto solver = make_bordered_solver(2 * n, 2, base().sparse());
  Pair companion;
  companion << 0, 1, -b, a;
  fill(*solver, companion, scales());
  Vector column = size * spread(2 * n, 1);
  Vector row = spread(2 * n, 2);
  Vector right(2 * n + 2);
  Vector left(2 * n + 2);
  for (int i = 0; i < 3; ++i) {  // inverse iteration, with the conjugates of both null vectors
    const auto first = column.head(n);
    const auto second = column.tail(n);
    solver->columns() << first, -b * second, second, first + a * second;
    const auto of_first = row.head(n).transpose();
    const auto of_second = row.tail(n).transpose();
    solver->rows() << of_first, -b * of_second, of_second, of_first + a * of_second;
    if (solver->factor() == 0) return false;
    right.setUnit(2 * n);
    solver->solve(right);
    left.setUnit(2 * n + 1);
    solver->solve_transposed(left);
    if (!right.allFinite() || !left.allFinite()) return false;
    column << left.segment(n, n), -left.head(n);
    column *= size / column.norm();
    row << right.head(n) + a * right.segment(n, n), -right.segment(n, n);
    row.normalize();
  }
  space_ = right.head(2 * n).reshaped(n, 2);
  pair_ = companion;
  return true;
}

/// L(V') + J_1 V L' = 0 and C^T V' = 1 with the change L' of L, until that is short.
bool PairProblem::solve_space() const {
  constexpr int most = 12;
  constexpr double short_enough = 1e-8;  // the next one is its square
  const Vector both = scales();
  const Index n = count_;
  space_ = frame_;
  pair_ = start_;
  solver_->corner().setZero();
  Vector solution(2 * n + 4);
  double last = std::numeric_limits<double>::infinity();
  for (corrections_ = 1; corrections_ <= most; ++corrections_) {
    fill(*solver_, pair_, both);
    solver_->columns().setZero();
    solver_->rows().setZero();
    for (const Index i : {0, 1}) {
      const Vector moved = turned(space_.col(i).cwiseProduct(scale_));
      for (const Index j : {0, 1}) {
        solver_->columns().col(2 * j + i).segment(j * n, n) = moved;
        solver_->rows().row(2 * j + i).segment(j * n, n) = frame_.col(i).transpose();
      }
    }
    if (solver_->factor() == 0) return false;
    solution.setZero();
    solution(2 * n) = solution(2 * n + 3) = 1;
    solver_->solve(solution);
    if (!solution.allFinite()) return false;
    const Pair change = solution.tail(4).reshaped(2, 2);
    space_ = solution.head(2 * n).reshaped(n, 2);
    pair_ += change;
    const double length = change.norm();
    if (length <= short_enough * pair_.norm()) return true;
    if (length >= last && length <= short_enough * size_) return true;  // rounding of a pair next to 0
    last = length;
  }
  return false;
}

bool PairProblem::find_space(const BasePoint& point) const {
  found_at_.resize(0);
  if (!solve_space()) return false;
  found_at_ = place(point);
  return true;
}

double PairProblem::meeting_test(const BasePoint& point, double apart) const {
  const Vector here = place(point);
  const bool is_found = found_at_.size() == here.size() && found_at_ == here;
  const bool is_known =
      is_found || (at_.evaluate(point.unknowns, point.parameters, point.regime) && find_space(point));
  if (!is_known) return std::nan("");
  const Pair deviation = pair_ - 0.5 * pair_.trace() * Pair::Identity();
  constexpr double rounding = 1e-10;  // where the pair has two eigenvectors
  if (deviation.norm() < rounding * size_) return std::nan("");
  return apart / (deviation.squaredNorm() + std::abs(apart));
}

/// Whether the pair that was found is the one that belongs to kappa.
bool PairProblem::has_pair_of(double kappa) const {
  constexpr double near = 1e-4;
  const double size = pair_.norm();
  return std::abs(pair_.trace() - sum(kappa).value) <= near * size &&
         std::abs(pair_.determinant() - product(kappa).value) <= near * size * size;
}

bool PairProblem::adapt(const BasePoint& point) {
  if (!ExtendedProblem::adapt(point)) return false;
  Vector sums(count_);
  at_.multiply_absolute(scale_, sums);
  size_ = sums.cwiseQuotient(scale_).maxCoeff();
  if (!(size_ > 0)) size_ = 1;
  const double kappa = point.extras(0);
  const bool goes_on = !frame_.isZero(0) && solve_space() && has_pair_of(kappa);
  if (!goes_on && !begin(kappa)) return false;
  Matrix upper;
  orthogonalise(space_, frame_, upper);
  const Pair triangle = upper;
  start_ = triangle * pair_ * triangle.inverse();
  if (!frame_.allFinite() || !start_.allFinite()) return false;
  slope_ = 1;
  slope_ = steepness(point);
  return true;
}

void PairProblem::each_border(const std::function<void(double*, Index)>& use) {
  ExtendedProblem::each_border(use);
  use(frame_.data(), frame_.size());
  use(start_.data(), start_.size());
  use(&size_, 1);
  use(&slope_, 1);
  use(&second_.memory(), 1);
}

/// Where another pair is near corrections come to this one from its close neighbourhood alone, well before
/// the frame is far from it.
double PairProblem::strain() const {
  constexpr int many = 5;
  if (corrections_ > many) return std::numeric_limits<double>::infinity();
  const double turned_by = (pair_ - start_).norm() / start_.norm();
  return space_.norm() / frame_.norm() * (1 + turned_by);
}

bool PairProblem::conditions(const BasePoint& point, Vector& values, Matrix* gradients) const {
  if (!find_space(point)) return false;
  const ByKappa a = sum(point.extras(0));
  const ByKappa b = product(point.extras(0));
  constexpr double least = 1e-6;  // of the matrices: a pair that is none of rounding
  const double rate = std::max(start_.norm(), least * size_);
  const Eigen::Vector2d units{1 / (size_ * slope_), 1 / (size_ * rate * slope_)};
  values << pair_.trace() - a.value, pair_.determinant() - b.value;
  values.array() *= units.array();
  if (gradients == nullptr) return true;
  const Index n = count_;
  Matrix left(2 * n + 4, 2);  // what moves both by a change of J
  left.setZero();
  left.bottomRows(4) << 1, pair_(1, 1), 0, -pair_(0, 1), 0, -pair_(1, 0), 1, pair_(0, 0);
  for (const Index k : {0, 1}) {
    Vector side = left.col(k);
    solver_->solve_transposed(side);
    if (!side.allFinite()) return false;
    left.col(k) = units(k) * side;
  }
  const Vector none = Vector::Zero(point.parameters.size());
  gradients->setZero();
  Matrix columns;
  for (const Index part : {0, 1}) {
    const Matrix weights = left.middleRows(part * n, n);
    const Vector v = space_.col(part).cwiseProduct(scale_);
    if (!second_.contract(point.unknowns, point.parameters, point.regime, weights, v, none, columns))
      return false;
    gradients->leftCols(columns.rows()) -= columns.transpose();
  }
  gradients->col(gradients->cols() - 1) << -units(0) * a.slope, -units(1) * b.slope;
  return true;
}

}  // namespace arcslip::continuation
