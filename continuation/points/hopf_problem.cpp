#include "arcslip/continuation/points/hopf_problem.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "arcslip/continuation/linear/borders.hpp"
#include "arcslip/continuation/points/hopf_form.hpp"

namespace arcslip::continuation {

HopfProblem::HopfProblem(const Problem& base, Index active) : PairProblem(base, active) {}

void HopfProblem::fill(BorderedSolver& solver, const Pair& pair, const Vector& scales) const {
  if (at_.sparse()) {
    fill_sparse(solver, pair, scales);
    return;
  }
  doubled_.setZero(2 * count_, 2 * count_);
  for (const Index i : {0, 1}) {
    doubled_.block(i * count_, i * count_, count_, count_) = at_.jacobian();
    for (const Index j : {0, 1})
      doubled_.block(i * count_, j * count_, count_, count_).diagonal().array() -= pair(j, i);
  }
  solver.set_jacobian(doubled_, scales);
}

void HopfProblem::fill_sparse(BorderedSolver& solver, const Pair& pair, const Vector& scales) const {
  const SparseMatrix& jacobian = at_.sparse_jacobian();
  const auto n = static_cast<int>(count_);
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(static_cast<std::size_t>(2 * jacobian.nonZeros() + 4 * count_));
  for (int column = 0; column < n; ++column) {
    for (SparseMatrix::InnerIterator entry(jacobian, column); entry; ++entry) {
      const auto row = static_cast<int>(entry.row());
      entries.emplace_back(row, column, entry.value());
      entries.emplace_back(n + row, n + column, entry.value());
    }
    for (const int i : {0, 1})
      for (const int j : {0, 1}) entries.emplace_back(i * n + column, j * n + column, -pair(j, i));
  }
  SparseMatrix doubled(2 * count_, 2 * count_);
  doubled.setFromTriplets(entries.begin(), entries.end());
  solver.set_jacobian(doubled, scales);
}

std::vector<Observable> HopfProblem::observables() const {
  std::vector<Observable> result = ExtendedProblem::observables();
  result.push_back({"omega"});
  return result;
}

void HopfProblem::observe(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const {
  Vector of_base;
  ExtendedProblem::observe(u, p, regime, of_base);
  values.resize(of_base.size() + 1);
  values << of_base, std::sqrt(std::max(0.0, u(u.size() - 1)));
}

bool HopfProblem::eigenvalues(const Vector& u, const Vector& p, const Regime& regime,
                              ComplexVector& values) const {
  const BasePoint point = split(u, p, regime);
  if (!base().eigenvalues(point.unknowns, point.parameters, regime, values)) return false;
  const Complex own = std::sqrt(Complex(-point.extras(0)));
  remove_nearest(values, own);
  remove_nearest(values, -own);
  return true;
}

void HopfProblem::test(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const {
  const BasePoint point = split(u, p, regime);
  const double kappa = point.extras(0);
  values.resize(2);
  values << meeting_test(point, kappa), std::nan("");
  ComplexVector all;
  if (!base().eigenvalues(point.unknowns, point.parameters, regime, all)) return;
  constexpr double rounding = 1e-14;  // of kappa
  constexpr double surely = 1e-3;     // so near to where the pair meets at 0 its vectors are rounding
  if (!(kappa > rounding * all.cwiseAbs2().maxCoeff())) return;
  const auto form = hopf_form(base(), {point.unknowns, point.parameters, regime}, std::sqrt(kappa));
  if (!form || form->apart < surely) return;
  Vector scale(count_);
  Vector parameter_scale(point.parameters.size());
  base().scale(point.unknowns, point.parameters, scale, parameter_scale);
  const double usual = 1 / (scale.maxCoeff() * scale.maxCoeff());  // where its terms vanish all at once
  values(1) = (form->poles_passed ? -1 : 1) * form->lyapunov / (form->terms + usual);
}

}  // namespace arcslip::continuation
