#include "arcslip/continuation/cycles/torus_problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "arcslip/continuation/cycles/doubling_problem.hpp"
#include "arcslip/continuation/cycles/floquet.hpp"
#include "arcslip/continuation/cycles/multiplier_form.hpp"

namespace arcslip::continuation {

TorusProblem::TorusProblem(const Problem& base, Index active)
    : PairProblem(base, active), orbits_(dynamic_cast<const PeriodicOrbit*>(&base)) {}

void TorusProblem::fill(BorderedSolver& solver, const Pair& pair, const Vector& scales) const {
  if (orbits_ == nullptr) {  // J_0 = df/du, J_1 = -1
    Matrix doubled = Matrix::Zero(2 * count_, 2 * count_);
    for (const Index i : {0, 1}) {
      doubled.block(i * count_, i * count_, count_, count_) =
          at_.jacobian() + Matrix::Identity(count_, count_);
      for (const Index j : {0, 1})
        doubled.block(i * count_, j * count_, count_, count_).diagonal().array() -= pair(j, i);
    }
    solver.set_jacobian(doubled, scales);
    return;
  }
  const SparseMatrix& whole = at_.sparse_jacobian();
  const Index first = orbits_->field().size();  // columns, of which some entries join rounds
  SparseMatrix doubled(2 * count_, 2 * count_);
  doubled.reserve(2 * (whole.nonZeros() + whole.leftCols(first).nonZeros()));
  for (Index place = 0; place < 2 * count_; ++place) {
    const Index j = place / count_;
    const Index column = place % count_;
    doubled.startVec(place);
    for (const Index i : {0, 1}) {
      if (i != j && column >= first) continue;
      for (SparseMatrix::InnerIterator entry(whole, column); entry; ++entry) {
        const bool joins = column < first && orbits_->joins_rounds(entry.row(), column);
        if (joins || i == j)
          doubled.insertBack(i * count_ + entry.row(), place) = (joins ? pair(j, i) : 1) * entry.value();
      }
    }
  }
  doubled.finalize();
  solver.set_jacobian(doubled, scales);
}

Vector TorusProblem::turned(const Vector& x) const {
  if (orbits_ == nullptr) return -x;
  Vector result = Vector::Zero(count_);
  for (Index column = 0; column < orbits_->field().size(); ++column) {
    for (SparseMatrix::InnerIterator entry(at_.sparse_jacobian(), column); entry; ++entry) {
      if (orbits_->joins_rounds(entry.row(), column)) result(entry.row()) += entry.value() * x(column);
    }
  }
  return result;
}

namespace {

/// ln z.
Complex log_of_pair(double kappa) {
  const double size = std::abs(kappa) < 1 ? 0 : std::acosh(std::abs(kappa));
  return {size, std::acos(std::clamp(kappa, -1.0, 1.0))};
}

}  // namespace

/// ln mu of the multipliers but for the pair; none where they are not known.
std::optional<ComplexVector> TorusProblem::other_logs(const BasePoint& point) const {
  ComplexVector logs = log_multipliers_anew(base(), at_, point);
  if (logs.size() < 2) return std::nullopt;
  const Complex own = log_of_pair(point.extras(0));
  remove_multiplier(logs, own);
  remove_multiplier(logs, -own);
  return logs;
}

bool TorusProblem::eigenvalues(const Vector& u, const Vector& p, const Regime& regime,
                               ComplexVector& values) const {
  const BasePoint point = split(u, p, regime);
  const std::optional<ComplexVector> others = other_logs(point);
  if (!others) return false;
  values = rates_of(base(), *others, point);
  return values.allFinite();
}

void TorusProblem::test(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const {
  const BasePoint point = split(u, p, regime);
  const double kappa = point.extras(0);
  values.setConstant(std::ssize(test_types()), std::nan(""));
  values.head(4) << meeting_test(point, 1 - kappa), meeting_test(point, 1 + kappa), kappa + 0.5, kappa;
  constexpr double surely = 1e-6;  // so near to where the pair meets its vectors are rounding
  if (!(std::abs(kappa) < 1 - surely)) return;
  const auto form = multiplier_form(base(), PointType::neimark_sacker,
                                    {point.unknowns, point.parameters, regime, {}}, std::acos(kappa));
  if (form) values(4) = form->relative();  // jumps where terms have poles
  const std::optional<ComplexVector> others = other_logs(point);
  if (!others || others->size() == 0) return;
  values(5) = fold_test(*others);
  values(6) = doubling_test(*others);
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

std::unique_ptr<ExtendedProblem> special_of_multipliers(const Problem& problem, PointType type, Index active,
                                                        const ComplexVector& log_multipliers,
                                                        Vector& extras) {
  if (type == PointType::period_doubling) return std::make_unique<DoublingProblem>(problem, active);
  if (type != PointType::neimark_sacker) return nullptr;
  double nearest = std::numeric_limits<double>::infinity();  // of all pairs to the unit circle
  for (const Complex& log : log_multipliers) {
    const bool is_pair = log.imag() > 0 && log.imag() < pi;
    if (!is_pair || std::abs(log.real()) >= nearest) continue;
    nearest = std::abs(log.real());
    extras = Vector::Constant(1, std::cos(log.imag()));
  }
  if (!std::isfinite(nearest)) return nullptr;
  return std::make_unique<TorusProblem>(problem, active);
}

}  // namespace arcslip::continuation
