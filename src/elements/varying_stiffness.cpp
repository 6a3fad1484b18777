#include "arcslip/elements/varying_stiffness.hpp"

#include <cmath>
#include <cstdlib>

namespace arcslip {

double VaryingStiffness::at(double theta) const {
  double sum = 0;
  for (std::size_t m = 0; m < harmonics.size(); ++m)
    sum += std::real(harmonics[m] * std::polar(1.0, 2 * static_cast<double>(m) * theta));
  return sum;
}

double VaryingStiffness::term(double theta, double width, Index m) const {
  if (m == 0) return at(theta);
  double sum = 0;
  for (std::size_t n = 1; n < harmonics.size(); ++n) {
    const double rate = 2 * static_cast<double>(n);
    const double size = std::exp(static_cast<double>(m) * std::log(rate * std::abs(width)) -
                                 std::lgamma(static_cast<double>(m) + 1));
    const double turned = rate * theta + static_cast<double>(m) * std::copysign(pi / 2, width);  // j^m
    sum += size * std::real(harmonics[n] * std::polar(1.0, turned));
  }
  return sum;
}

Complex VaryingStiffness::coefficient(int n) const {
  const auto m = static_cast<std::size_t>(std::abs(n) / 2);
  if (n % 2 != 0 || m >= harmonics.size()) return 0;
  if (m == 0) return harmonics.front();
  return 0.5 * (n > 0 ? harmonics[m] : std::conj(harmonics[m]));
}

}  // namespace arcslip
