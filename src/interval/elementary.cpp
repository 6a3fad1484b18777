#include "arcslip/interval/elementary.hpp"

#include <algorithm>
#include <cmath>

namespace arcslip {
namespace {

const Interval half_pi(0x1.921fb54442d18p+0, 0x1.921fb54442d19p+0);

/// From what they are at both ends, of a function that rises.
Interval rising(Interval (*at)(double), const Interval& x) {
  return {at(x.lower()).lower(), at(x.upper()).upper()};
}

/// sin r and cos r of |r| <= 0.8, by Taylor's series to r^19 and what is left out.
Interval sine_series(const Interval& r) {
  const Interval square = r * r;
  Interval sum = 1;
  for (int k = 18; k >= 2; k -= 2) sum = Interval(1) - square * sum / Interval(k * (k + 1.0));
  return r * sum + Interval(-1e-19, 1e-19);
}

Interval cosine_series(const Interval& r) {
  const Interval square = r * r;
  Interval sum = 1;
  for (int k = 17; k >= 1; k -= 2) sum = Interval(1) - square * sum / Interval(k * (k + 1.0));
  return sum + Interval(-5e-19, 5e-19);
}

/// sin(x + quarters pi/2).
Interval sine_at(double x, int quarters) {
  if (!(std::abs(x) < 1e9)) return {-1, 1};
  const double turns = std::nearbyint(x / half_pi.lower());
  const Interval rest = Interval(x) - Interval(turns) * half_pi;
  const auto quarter = (static_cast<long>(turns) + quarters) & 3;
  const Interval value = quarter % 2 == 0 ? sine_series(rest) : cosine_series(rest);
  return quarter < 2 ? value : -value;
}

/// Whether some x has x = place + 2 pi k, or nearly.
bool may_hold(const Interval& x, double place) {
  constexpr double turn = 6.283185307179586;
  const double slack = 1e-9 + 1e-15 * (std::abs(x.lower()) + std::abs(x.upper()));
  return std::floor((x.upper() - place) / turn + slack) >= std::ceil((x.lower() - place) / turn - slack);
}

Interval sine_of(const Interval& x, int quarters) {
  const Interval ends = joined(sine_at(x.lower(), quarters), sine_at(x.upper(), quarters));
  const double top = half_pi.lower() * (1 - quarters);
  const double low = may_hold(x, top + 2 * half_pi.lower()) ? -1 : std::max(ends.lower(), -1.0);
  const double high = may_hold(x, top) ? 1 : std::min(ends.upper(), 1.0);
  return {std::min(low, high), std::max(low, high)};
}

Interval hyperbolic_sine(double x) {
  return (exponential(Interval(x)) - exponential(Interval(-x))) / Interval(2);
}
Interval hyperbolic_tangent(double x) {
  if (std::abs(x) > 300) return x > 0 ? Interval(1 - 1e-15, 1) : Interval(-1, -1 + 1e-15);
  return Interval(1) - Interval(2) / (exponential(Interval(2 * x)) + Interval(1));
}

/// By half the angle three times, tan(a/2) = tan a/(1 + sqrt(1 + tan^2 a)), and the series of |t| <= 0.2.
Interval arc_tangent(double x) {
  if (std::abs(x) > 1e100) return x > 0 ? Interval(1.5707963267948, 1.5707963267949) : -arc_tangent(-x);
  Interval t = x;
  for (int i = 0; i < 3; ++i) t = t / (Interval(1) + sqrt(Interval(1) + square(t)));
  const Interval minus_square = -square(t);
  Interval sum = Interval(-1, 1) / Interval(31);
  for (int k = 29; k >= 1; k -= 2) sum = Interval(1) / Interval(k) + minus_square * sum;
  return Interval(8) * t * sum;
}

Interval sinh_of(const Interval& x) { return rising(hyperbolic_sine, x); }
Interval cosh_of(const Interval& x) { return sqrt(Interval(1) + square(sinh_of(x))); }
Interval tanh_of(const Interval& x) { return rising(hyperbolic_tangent, x); }
Interval tan_of(const Interval& x) {
  // A pole may be between the ends, and quotients know nothing of how sin and cos hang together.
  if (may_hold(x, half_pi.lower()) || may_hold(x, -half_pi.lower())) throw NoEnclosure("a pole of tan");
  return rising([](double at) { return sine(Interval(at)) * inverse(cosine(Interval(at))); }, x);
}
Interval root_of(const Interval& x) {
  if (x.upper() < 0) throw NoValue("the root of what is negative");
  if (!(x.lower() >= 0)) throw NoEnclosure("the root of what may be negative");
  return sqrt(x);
}
/// asin' = 1/sqrt(1 - x^2).
Interval arc_slope(const Interval& x) { return inverse(root_of((Interval(1) - x) * (Interval(1) + x))); }
Interval asin_of(const Interval& x) {
  return rising(
      [](double at) {
        const Interval slope = arc_slope(Interval(at));
        return rising(arc_tangent, Interval(at) * slope);
      },
      x);
}
/// Below what exponential() takes as well, where it is all but 0.
Interval exponential_of(const Interval& x) {
  constexpr double least = -700;
  if (x.upper() < least) return {0, 1e-300};
  if (x.lower() >= least) return exponential(x);
  return {0, exponential(Interval(x.upper())).upper()};
}
Interval sign_of(const Interval& x) {
  return x.lower() > 0 ? Interval(1) : x.upper() < 0 ? Interval(-1) : Interval(-1, 1);
}
Interval zero_or_jump(const Interval& x) {
  if (x.lower() <= 0 && x.upper() >= 0) throw NoEnclosure("a jump of sign");
  return 0;
}

const std::vector<EnclosedFunction>& enclosed_functions() {
  using I = Interval;
  static const std::vector<EnclosedFunction> all{
      {"sin", sine, cosine},
      {"cos", cosine, [](const I& x) { return -sine(x); }},
      {"tan", tan_of, [](const I& x) { return I(1) + square(tan_of(x)); }},
      {"asin", asin_of, arc_slope},
      {"acos", [](const I& x) { return half_pi - asin_of(x); }, [](const I& x) { return -arc_slope(x); }},
      {"atan", [](const I& x) { return rising(arc_tangent, x); },
       [](const I& x) { return inverse(I(1) + square(x)); }},
      {"sinh", sinh_of, cosh_of},
      {"cosh", cosh_of, sinh_of},
      {"tanh", tanh_of, [](const I& x) { return inverse(square(cosh_of(x))); }},
      {"exp", exponential_of, exponential_of},
      {"log", logarithm, [](const I& x) { return inverse(x); }},
      {"log10", [](const I& x) { return logarithm(x) / logarithm(I(10)); },
       [](const I& x) { return inverse(x * logarithm(I(10))); }},
      {"sqrt", root_of, [](const I& x) { return inverse(I(2) * root_of(x)); }},
      {"abs", [](const I& x) { return abs(x); }, sign_of},
      {"sign",
       [](const I& x) {
         zero_or_jump(x);
         return sign_of(x);
       },
       zero_or_jump}};
  return all;
}

}  // namespace

const EnclosedFunction* find_enclosed(const std::string& name) {
  const auto& all = enclosed_functions();
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.name == name; });
  return found == all.end() ? nullptr : &*found;
}

Interval sine(const Interval& x) { return sine_of(x, 0); }
Interval cosine(const Interval& x) { return sine_of(x, 1); }

Interval power(const Interval& a, int n) {
  if (n < 0) return inverse(power(a, -n));
  return n == 2 ? square(a) : pow(a, n);
}

Interval power(const Interval& a, const Interval& b) { return exponential(b * logarithm(a)); }

}  // namespace arcslip
