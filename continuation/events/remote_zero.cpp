#include "arcslip/continuation/events/remote_zero.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "arcslip/zero_between.hpp"

namespace arcslip::continuation {
namespace {

constexpr std::size_t count = RemoteZero::count;
constexpr std::array<double, count> spread{-1, -0.6, -0.3, 0.3, 0.6, 1};  // of the radius
constexpr double beside = 0.1;                                            // the same
constexpr double agreement = 1e-9;  // of the range, with a polynomial whose error is by orders larger

/// Of the values at `places`, from the first to the last of them, in the polynomial at x or in its
/// derivative.
std::array<double, count> weights(const std::array<double, count>& places, double x, bool derivative,
                                  std::size_t first = 0, std::size_t last = count) {
  std::array<double, count> result{};
  for (std::size_t i = first; i < last; ++i) {
    double value = 1;
    double slope = 0;
    for (std::size_t j = first; j < last; ++j) {
      if (j == i) continue;
      const double width = places[i] - places[j];
      slope = (slope * (x - places[j]) + value) / width;
      value *= (x - places[j]) / width;
    }
    result[i] = derivative ? slope : value;
  }
  return result;
}

/// Places around a point within the range, none of them too near to it.
std::array<double, count> places_around(const ZeroRange& range, double radius) {
  const double middle = std::clamp(range.guess, range.begin + radius, range.end - radius);
  std::array<double, count> places{};
  for (std::size_t i = 0; i < count; ++i) {
    places[i] = middle + spread[i] * radius;
    if (std::abs(places[i] - range.guess) < beside * radius)
      places[i] = range.guess + std::copysign(beside * radius, places[i] - range.guess);
  }
  return places;
}

/// Of a function with a multiple zero the root that passes it straight.
double straightened(double value, double way, int multiplicity) {
  if (multiplicity == 1) return value;
  return std::copysign(std::pow(std::abs(value), 1.0 / multiplicity), multiplicity % 2 == 0 ? way : value);
}

/// Whether the values are as large as they are far from the zero: of a lower multiplicity those nearest to it
/// are larger by a fifth or more, and were they given a sign at the guess they have a zero there in any case.
bool is_straight(const std::array<double, count>& places, const std::array<double, count>& values, double s) {
  constexpr double alike = 1.2;
  double least = std::numeric_limits<double>::infinity();
  double most = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double slope = std::abs(values[i] / (places[i] - s));
    least = std::min(least, slope);
    most = std::max(most, slope);
  }
  return most < alike * least;
}

}  // namespace

std::optional<RemoteZero> remote_zero(const std::function<std::optional<double>(double s)>& f,
                                      const ZeroRange& range, double radius) {
  RemoteZero zero;
  zero.places = places_around(range, radius);
  std::array<double, count> values{};
  for (std::size_t i = 0; i < count; ++i) {
    const std::optional<double> value = f(zero.places[i]);
    if (!value) return std::nullopt;
    values[i] = straightened(*value, zero.places[i] - range.guess, range.multiplicity);
  }
  const double low = std::max(range.low, zero.places.front());
  const double high = std::min(range.high, zero.places.back());
  const auto zero_of = [&](std::size_t first, std::size_t last) -> std::optional<double> {
    const auto polynomial = [&](double x) {
      const auto w = weights(zero.places, x, false, first, last);
      return std::inner_product(w.begin(), w.end(), values.begin(), 0.0);
    };
    const double at_low = polynomial(low);
    const double at_high = polynomial(high);
    if (!(at_low * at_high < 0)) return std::nullopt;
    return zero_between(polynomial, low, high, at_low, at_high);
  };
  const std::optional<double> best = zero_of(0, count);
  const std::optional<double> other = zero_of(1, count - 1);
  if (!best) return std::nullopt;
  zero.s = *best;
  zero.agrees = other && std::abs(*best - *other) <= agreement * (range.end - range.begin) &&
                (range.multiplicity == 1 || is_straight(zero.places, values, zero.s));
  zero.weights = weights(zero.places, zero.s, false);
  zero.slopes = weights(zero.places, zero.s, true);
  zero.other_slopes = weights(zero.places, zero.s, true, 1, count - 1);
  return zero;
}

}  // namespace arcslip::continuation
