#include "arcslip/continuation/second_derivative.hpp"

#include <array>
#include <cmath>
#include <limits>

namespace arcslip::continuation {
namespace {

constexpr double first_step = 0.02;  // of the problem's scale
constexpr int levels = 9;            // down to 3e-7 of the scale, where the sharpest features are met
constexpr int order = 3;             // columns of the extrapolation

}  // namespace

double differentiate(const std::function<bool(double h, Vector& out)>& f, double step, Vector& derivative) {
  std::array<Vector, order> row;
  std::array<Vector, order> previous;
  Vector forward;
  Vector backward;
  double best = std::numeric_limits<double>::infinity();
  int begun = 0;
  for (int level = 0; level < levels; ++level, step *= 0.25) {
    if (!f(step, forward) || !f(-step, backward)) {
      begun = 0;
      continue;
    }
    std::swap(row, previous);
    row[0] = (forward - backward) / (2 * step);
    double factor = 16;
    for (std::size_t k = 1; k < order && static_cast<int>(k) <= begun; ++k, factor *= 16) {
      row[k] = (factor * row[k - 1] - previous[k - 1]) / (factor - 1);
    }
    const auto last = static_cast<std::size_t>(std::min(begun, order - 1));
    ++begun;
    if (last == 0) continue;
    const double error = (row[last] - row[last - 1]).lpNorm<Eigen::Infinity>();
    if (!(error < best)) {
      if (last == order - 1 && error > 4 * best) break;  // rounding has taken over
      continue;
    }
    best = error;
    derivative = row[last];
    if (best <= 1e-12 * derivative.lpNorm<Eigen::Infinity>()) break;
  }
  return best;
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

bool SecondDerivative::contract(const Vector& u, const Vector& p, int regime, const Vector& w,
                                const Vector& du, const Vector& dp, Vector& out) {
  const Index n = u.size();
  const double size = length(u, p, du, dp);
  if (!(size > 0) || !std::isfinite(size)) {
    out.setZero(n + p.size());
    return size == 0;
  }
  const auto f = [&](double h, Vector& value) {
    if (!at_.evaluate(u + h * du, p + h * dp, regime)) return false;
    value.resize(n + p.size());
    at_.multiply_transposed(w, row_);
    value.head(n) = row_;
    value.tail(p.size()).noalias() = at_.parameter_jacobian().transpose() * w;
    return value.allFinite();
  };
  return std::isfinite(differentiate(f, first_step / size, out));
}

}  // namespace arcslip::continuation
