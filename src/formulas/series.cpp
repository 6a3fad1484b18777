#include "arcslip/formulas/series.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace arcslip::taylor {
namespace {

constexpr std::size_t ends = order + 1;

Series constant(double value) {
  Series result{};
  result[0] = value;
  return result;
}

Series scaled(Series a, double factor) {
  for (double& one : a) one *= factor;
  return a;
}

/// One of y' = slope a', begun with y_0; `slope` gives its coefficient k once those of y up to k are known.
template <class Slope>
Series grown(double first, const Series& a, Series& y, const Slope& slope) {
  y = constant(first);
  Series slopes{};
  for (std::size_t k = 1; k < ends; ++k) {
    slopes[k - 1] = slope(k - 1);
    for (std::size_t j = 1; j <= k; ++j) y[k] += static_cast<double>(j) * a[j] * slopes[k - j];
    y[k] /= static_cast<double>(k);
  }
  return y;
}

Series grown(double first, const Series& a, const Series& slope) {
  Series y;
  return grown(first, a, y, [&](std::size_t k) { return slope[k]; });
}

/// y' = z a', z' = turn y a'.
std::pair<Series, Series> grown_together(double first, double second, double turn, const Series& a) {
  Series y = constant(first);
  Series z = constant(second);
  for (std::size_t k = 1; k < ends; ++k) {
    for (std::size_t j = 1; j <= k; ++j) {
      const double weight = static_cast<double>(j) / static_cast<double>(k) * a[j];
      y[k] += weight * z[k - j];
      z[k] += turn * weight * y[k - j];
    }
  }
  return {y, z};
}

/// y' = s a', s' = 2 sign y s a': tan and tanh.
Series steepening(double first, double slope, double sign, const Series& a) {
  Series y = constant(first);
  Series s = constant(slope);
  for (std::size_t k = 1; k < ends; ++k) {
    const Series both = times(y, s);
    for (std::size_t j = 1; j <= k; ++j) {
      const double weight = static_cast<double>(j) / static_cast<double>(k) * a[j];
      y[k] += weight * s[k - j];
      s[k] += 2 * sign * weight * both[k - j];
    }
  }
  return y;
}

/// 1 - a^2, without cancellation where a is nearly 1.
Series rest_of_square(const Series& a) {
  Series square = scaled(times(a, a), -1);
  square[0] = (1 - a[0]) * (1 + a[0]);
  return square;
}

Series one_more_than(Series a) {
  a[0] += 1;
  return a;
}

}  // namespace

Series times(const Series& a, const Series& b) {
  Series result{};
  for (std::size_t k = 0; k < ends; ++k) {
    for (std::size_t j = 0; j <= k; ++j) result[k] += a[j] * b[k - j];
  }
  return result;
}

Series over(const Series& a, const Series& b) {
  Series result = a;
  for (std::size_t k = 0; k < ends; ++k) {
    for (std::size_t j = 1; j <= k; ++j) result[k] -= b[j] * result[k - j];
    result[k] /= b[0];
  }
  return result;
}

Series to_power(const Series& a, double c) {
  Series result = constant(std::pow(a[0], c));
  for (std::size_t k = 1; k < ends; ++k) {
    for (std::size_t j = 1; j <= k; ++j) {
      const auto weight = static_cast<double>(j);
      result[k] += (c * weight - static_cast<double>(k - j)) * a[j] * result[k - j];
    }
    result[k] /= static_cast<double>(k) * a[0];
  }
  return result;
}

Series to_integer(const Series& a, int n) {
  Series power = n < 0 ? over(constant(1), a) : a;
  Series result = constant(1);
  for (unsigned rest = n < 0 ? 0U - static_cast<unsigned>(n) : static_cast<unsigned>(n); rest > 0;
       rest /= 2) {
    if (rest % 2 == 1) result = times(result, power);
    if (rest > 1) power = times(power, power);
  }
  return result;
}

Series exp(const Series& a) {
  Series y;
  return grown(std::exp(a[0]), a, y, [&](std::size_t k) { return y[k]; });
}

Series log(const Series& a) { return grown(std::log(a[0]), a, over(constant(1), a)); }
Series log10(const Series& a) { return grown(std::log10(a[0]), a, over(constant(std::numbers::log10e), a)); }
Series sqrt(const Series& a) { return to_power(a, 0.5); }

Series sin(const Series& a) { return grown_together(std::sin(a[0]), std::cos(a[0]), -1, a).first; }
Series cos(const Series& a) { return grown_together(std::sin(a[0]), std::cos(a[0]), -1, a).second; }
Series sinh(const Series& a) { return grown_together(std::sinh(a[0]), std::cosh(a[0]), 1, a).first; }
Series cosh(const Series& a) { return grown_together(std::sinh(a[0]), std::cosh(a[0]), 1, a).second; }

Series tan(const Series& a) {
  const double y = std::tan(a[0]);
  return steepening(y, 1 + y * y, 1, a);
}

Series tanh(const Series& a) {
  const double slope = 1 / std::cosh(a[0]);
  return steepening(std::tanh(a[0]), slope * slope, -1, a);
}

Series asin(const Series& a) { return grown(std::asin(a[0]), a, to_power(rest_of_square(a), -0.5)); }
Series acos(const Series& a) {
  return grown(std::acos(a[0]), a, scaled(to_power(rest_of_square(a), -0.5), -1));
}
Series atan(const Series& a) {
  return grown(std::atan(a[0]), a, over(constant(1), one_more_than(times(a, a))));
}

Series sign(const Series& a) {
  if (a[0] == 0) return constant(std::numeric_limits<double>::quiet_NaN());
  return constant(a[0] > 0 ? 1 : -1);
}
Series abs(const Series& a) { return scaled(a, sign(a)[0]); }

/// Its slope is that of atan of a/b, or of -b/a.
Series atan2(const Series& a, const Series& b) {
  Series y = std::abs(a[0]) < std::abs(b[0]) ? atan(over(a, b)) : atan(over(scaled(b, -1), a));
  y[0] = std::atan2(a[0], b[0]);
  return y;
}

}  // namespace arcslip::taylor
