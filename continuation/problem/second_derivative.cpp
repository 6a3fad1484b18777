#include "arcslip/continuation/problem/second_derivative.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace arcslip::continuation {
namespace {

constexpr double first_step = 0.02;  // of the problem's scale
constexpr int levels = 13;           // down to 1e-9 of the scale: no feature is sharper
constexpr std::size_t order = 3;     // columns of the extrapolation
constexpr double agreement = 1e-11;  // relative, of two columns: as good as rounding lets it be

/// An extrapolated difference and how far it is from the one before it.
struct Estimate {
  Vector derivative;
  double error;
};

/// Coarse estimates may agree by chance, being blind to a feature between their points, and the finest are
/// spoilt by rounding. From the finest on the errors fall until the feature is no longer resolved.
Estimate& best_of(std::vector<Estimate>& estimates) {
  std::size_t best = estimates.size() - 1;
  int rising = 0;
  for (std::size_t k = estimates.size(); k-- > 0 && rising < 2;) {
    rising = estimates[k].error > 16 * estimates[best].error ? rising + 1 : 0;
    if (estimates[k].error < estimates[best].error) best = k;
  }
  return estimates[best];
}

}  // namespace

Difference differentiate(const std::function<bool(double h, Vector& out)>& f, double step, Vector& derivative,
                         int level, int most) {
  std::array<Vector, order> row;
  std::array<Vector, order> previous;
  std::vector<Estimate> estimates;
  Vector forward;
  Vector backward;
  std::size_t begun = 0;
  for (step *= std::pow(0.25, level); level < std::min(most, levels); ++level, step *= 0.25) {
    if (!f(step, forward) || !f(-step, backward)) {
      begun = 0;
      continue;
    }
    std::swap(row, previous);
    row[0] = (forward - backward) / (2 * step);
    const std::size_t last = std::min(begun++, order - 1);
    double factor = 16;
    for (std::size_t k = 1; k <= last; ++k, factor *= 16)
      row[k] = (factor * row[k - 1] - previous[k - 1]) / (factor - 1);
    if (last == 0) continue;
    estimates.push_back({row[last], (row[last] - row[last - 1]).lpNorm<Eigen::Infinity>()});
    if (last == order - 1 && estimates.back().error <= agreement * row[last].lpNorm<Eigen::Infinity>()) {
      derivative = row[last];
      return {estimates.back().error, true, level};
    }
  }
  if (estimates.empty()) return {std::numeric_limits<double>::infinity(), false, level};
  Estimate& best = best_of(estimates);
  derivative = std::move(best.derivative);
  return {best.error, false, level};
}

SecondDerivative::SecondDerivative(const Problem& problem)
    : problem_(problem),
      at_(problem),
      unknown_scale_(problem.size()),
      parameter_scale_(static_cast<Index>(problem.parameter_names().size())),
      row_(problem.size()) {}

double SecondDerivative::length(const Vector& u, const Vector& p, const Vector& du, const Vector& dp) {
  problem_.scale(u, p, unknown_scale_, parameter_scale_);
  return std::max(du.cwiseQuotient(unknown_scale_).lpNorm<Eigen::Infinity>(),
                  dp.size() == 0 ? 0 : dp.cwiseQuotient(parameter_scale_).lpNorm<Eigen::Infinity>());
}

bool SecondDerivative::contract(const Vector& u, const Vector& p, const Regime& regime, const Vector& w,
                                const Vector& du, const Vector& dp, Vector& out) {
  Matrix column;
  if (!contract(u, p, regime, Matrix(w), du, dp, column)) return false;
  out = column.col(0);
  return true;
}

bool SecondDerivative::contract(const Vector& u, const Vector& p, const Regime& regime, const Matrix& weights,
                                const Vector& du, const Vector& dp, Matrix& out) {
  out.setZero(u.size() + p.size(), weights.cols());
  const double size = length(u, p, du, dp);
  if (!(size > 0) || !std::isfinite(size)) return size == 0;
  if (ask(u, p, regime, weights, du, dp, out)) return out.allFinite();
  return difference(u, p, regime, weights, du, dp, out);
}

bool SecondDerivative::ask(const Vector& u, const Vector& p, const Regime& regime, const Matrix& weights,
                           const Vector& du, const Vector& dp, Matrix& out) {
  for (Index k = 0; k < weights.cols(); ++k) {
    weight_ = weights.col(k);
    own_row_.setConstant(out.rows(), std::nan(""));
    if (!problem_.second(u, p, regime, weight_, du, dp, own_row_)) return false;
    ++own_;
    if (own_row_.size() != out.rows())
      throw std::logic_error(
          fmt::format("Problem::second: out has {} entries; expected {}", own_row_.size(), out.rows()));
    out.col(k) = own_row_;
  }
  return true;
}

bool SecondDerivative::difference(const Vector& u, const Vector& p, const Regime& regime,
                                  const Matrix& weights, const Vector& du, const Vector& dp, Matrix& out) {
  const Index n = u.size();
  const auto f = [&](double h, Vector& value) {
    if (!at_.evaluate(u + h * du, p + h * dp, regime)) return false;
    value.resize(out.size());
    for (Index k = 0; k < weights.cols(); ++k) {
      weight_ = weights.col(k);
      at_.multiply_transposed(weight_, row_);
      value.segment(k * out.rows(), n) = row_;
      value.segment(k * out.rows() + n, p.size()).noalias() = at_.parameter_jacobian().transpose() * weight_;
    }
    return value.allFinite();
  };
  Vector derivative;
  const double step = first_step / length(u, p, du, dp);
  // Where the last differences agreed these will, too, as a rule: that saves the coarser ones.
  const int begin = std::max(0, static_cast<int>(level_) - static_cast<int>(order) + 1);
  Difference difference = differentiate(f, step, derivative, begin);
  if (!difference.agrees && begin > 0) difference = differentiate(f, step, derivative);
  level_ = difference.agrees ? difference.level : 0;
  if (!std::isfinite(difference.error)) return false;
  out = derivative.reshaped(out.rows(), out.cols());
  return true;
}

}  // namespace arcslip::continuation
