#include "arcslip/continuation/second_derivative.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
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

double differentiate(const std::function<bool(double h, Vector& out)>& f, double step, Vector& derivative) {
  std::array<Vector, order> row;
  std::array<Vector, order> previous;
  std::vector<Estimate> estimates;
  Vector forward;
  Vector backward;
  std::size_t begun = 0;
  for (int level = 0; level < levels; ++level, step *= 0.25) {
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
      return estimates.back().error;
    }
  }
  if (estimates.empty()) return std::numeric_limits<double>::infinity();
  Estimate& best = best_of(estimates);
  derivative = std::move(best.derivative);
  return best.error;
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
