#include "arcslip/continuation/cycles/torus_problem.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace arcslip::continuation {

TorusProblem::TorusProblem(const CycleProblem& base, Index active)
    : PairProblem(base, active, base.size() - (base.has_duration() ? 1 : 0)),
      unknowns_(base.field().size()) {}

bool TorusProblem::is_turned(Index row, Index column) const {
  return column < unknowns_ && row >= count_ - unknowns_;
}

void TorusProblem::fill(BorderedSolver& solver, double a, double b, const Vector& scales) const {
  const SparseMatrix& whole = at_.sparse_jacobian();
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(static_cast<std::size_t>(2 * whole.nonZeros()));
  for (Index column = 0; column < count_; ++column) {
    for (SparseMatrix::InnerIterator entry(whole, column); entry && entry.row() < count_; ++entry) {
      const auto add = [&](Index row_part, Index column_part, double factor) {
        entries.emplace_back(static_cast<int>(row_part * count_ + entry.row()),
                             static_cast<int>(column_part * count_ + column), factor * entry.value());
      };
      if (is_turned(entry.row(), column)) {
        add(0, 1, -b);
        add(1, 0, 1);
        add(1, 1, a);
      } else {
        add(0, 0, 1);
        add(1, 1, 1);
      }
    }
  }
  SparseMatrix doubled(2 * count_, 2 * count_);
  doubled.setFromTriplets(entries.begin(), entries.end());
  solver.set_jacobian(doubled, scales);
}

Vector TorusProblem::turned(const Vector& x) const {
  Vector result = Vector::Zero(count_);
  for (Index column = 0; column < unknowns_; ++column) {
    for (SparseMatrix::InnerIterator entry(at_.sparse_jacobian(), column); entry && entry.row() < count_;
         ++entry) {
      if (is_turned(entry.row(), column)) result(entry.row()) += entry.value() * x(column);
    }
  }
  return result;
}

void TorusProblem::test(const Vector& u, const Vector& /*p*/, const Regime& /*regime*/,
                        Vector& values) const {
  values.resize(2);
  values << u(u.size() - 1) - 1, u(u.size() - 1) + 1;
}

std::vector<Observable> TorusProblem::observables() const {
  std::vector<Observable> result = ExtendedProblem::observables();
  result.push_back({"angle"});
  return result;
}

void TorusProblem::observe(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const {
  Vector of_base;
  ExtendedProblem::observe(u, p, regime, of_base);
  values.resize(of_base.size() + 1);
  values << of_base, std::acos(std::clamp(u(u.size() - 1), -1.0, 1.0));
}

}  // namespace arcslip::continuation
