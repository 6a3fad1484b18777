#include "time/first_crossing.hpp"

#include <boost/math/tools/toms748_solve.hpp>
#include <limits>

namespace arcslip {
namespace {

constexpr double narrowest = std::numeric_limits<double>::epsilon();

double value_at(const Vector& c, double x) {
  double sum = 0;
  for (Index m = c.size() - 1; m >= 0; --m) sum = sum * x + c(m);
  return sum;
}

/// b_j = sum_{i <= j} C(j, i)/C(n, i) c_i: no factor above 1, so nothing is lost.
Vector bernstein(const Vector& c) {
  const Index n = c.size() - 1;
  Vector b = c;
  for (Index i = 1; i <= n; ++i) {  // c_i/C(n, i)
    for (Index k = i; k <= n; ++k) b(k) *= static_cast<double>(i) / static_cast<double>(n - i + 1);
  }
  for (Index round = 1; round <= n; ++round) {
    for (Index k = n; k >= round; --k) b(k) += b(k - 1);
  }
  return b;
}

int sign_changes(const Vector& b) {
  int changes = 0;
  double last = b(0);
  for (const double value : b) {
    if (value == 0) continue;
    if (last * value < 0) ++changes;
    last = value;
  }
  return changes;
}

double root_between(const Vector& c, double low, double high) {
  const double at_low = value_at(c, low);
  const double at_high = value_at(c, high);
  if (at_low >= 0) return low;  // to rounding
  if (at_high <= 0) return high;
  std::uintmax_t iterations = 100;
  const auto bracket =
      boost::math::tools::toms748_solve([&](double x) { return value_at(c, x); }, low, high, at_low, at_high,
                                        boost::math::tools::eps_tolerance<double>(53), iterations);
  return bracket.second;
}

/// In [low, high], where the coefficients are b and f(low) <= 0.
std::optional<double> search(const Vector& c, const Vector& b, double low, double high) {
  const Index n = b.size() - 1;
  if (b.maxCoeff() <= 0) return std::nullopt;
  if (b(n) > 0 && (sign_changes(b) == 1 || high - low < narrowest)) return root_between(c, low, high);
  if (high - low < narrowest) return std::nullopt;

  Vector left(n + 1);
  Vector right = b;
  for (Index i = 0; i <= n; ++i) {  // de Casteljau
    left(i) = right(0);
    for (Index k = 0; k < n - i; ++k) right(k) = 0.5 * (right(k) + right(k + 1));
  }
  const double middle = 0.5 * (low + high);
  const auto found = search(c, left, low, middle);
  return found ? found : search(c, right, middle, high);
}

}  // namespace

std::optional<double> first_crossing(const Vector& coefficients) {
  if (coefficients(0) > 0) return 0;
  const Index n = coefficients.size() - 1;
  if (coefficients(0) + coefficients.tail(n).cwiseAbs().sum() <= 0) return std::nullopt;
  return search(coefficients, bernstein(coefficients), 0, 1);
}

}  // namespace arcslip
