#include "arcslip/elements/varying_stiffness.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "arcslip/motion/arc_integrals.hpp"

namespace arcslip {
namespace {

/// t_m of Re sum_n k_n e^{jn rate theta}.
double series_term(const std::vector<Complex>& harmonics, double rate, double theta, double width, Index m) {
  double sum = 0;
  if (m == 0) {
    for (std::size_t n = 0; n < harmonics.size(); ++n)
      sum += std::real(harmonics[n] * std::polar(1.0, rate * static_cast<double>(n) * theta));
    return sum;
  }
  for (std::size_t n = 1; n < harmonics.size(); ++n) {
    const double turns = rate * static_cast<double>(n);
    const double size = std::exp(static_cast<double>(m) * std::log(turns * std::abs(width)) -
                                 std::lgamma(static_cast<double>(m) + 1));
    const double turned = turns * theta + static_cast<double>(m) * std::copysign(pi / 2, width);  // j^m
    sum += size * std::real(harmonics[n] * std::polar(1.0, turned));
  }
  return sum;
}

double sum_of_moduli(const std::vector<Complex>& harmonics) {
  return std::accumulate(harmonics.begin(), harmonics.end(), 0.0,
                         [](double sum, const Complex& one) { return sum + std::abs(one); });
}

}  // namespace

double VaryingStiffness::term(double theta, double width, Index m) const {
  if (arcs.empty()) return series_term(harmonics, 2, theta, width, m);
  const double first = arcs.front().begin;
  const double middle = theta + 0.5 * width - first;
  const double turned = pi * std::floor(middle / pi);  // to the half period of the arcs
  const auto behind = std::find_if(arcs.begin(), arcs.end() - 1, [&](const Arc& arc) {
    return middle - turned < arc.begin - first + arc.width;
  });
  return series_term(behind->harmonics, 1, theta - turned, width, m);
}

Complex VaryingStiffness::coefficient(int n) const {
  if (n % 2 != 0) return 0;
  Complex sum = 0;
  const auto half_turns = static_cast<std::size_t>(std::abs(n) / 2);
  if (half_turns < harmonics.size()) {
    const Complex k = harmonics[half_turns];
    sum += n == 0 ? k : 0.5 * (n > 0 ? k : std::conj(k));
  }
  for (const Arc& arc : arcs) {
    const int highest = static_cast<int>(arc.harmonics.size()) - 1;
    for (int m = 0; m <= highest; ++m) {
      const Complex k = arc.harmonics[static_cast<std::size_t>(m)] / (m == 0 ? pi : two_pi);
      sum += k * arc_integral(arc.begin, arc.width, m - n);
      if (m > 0) sum += std::conj(k) * arc_integral(arc.begin, arc.width, -m - n);
    }
  }
  return sum;
}

double VaryingStiffness::bound() const {
  double most = sum_of_moduli(harmonics);
  for (const Arc& arc : arcs) most = std::max(most, sum_of_moduli(arc.harmonics));
  return most;
}

}  // namespace arcslip
