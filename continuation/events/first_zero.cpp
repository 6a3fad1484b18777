#include "arcslip/continuation/events/first_zero.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "arcslip/zero_between.hpp"

namespace arcslip::continuation {
namespace {

constexpr double margin = 0.5;       // of the end values, that the cubic has to keep from zero
constexpr double foretold = 0.03;    // of a value: what the cubic may err by where it is relied upon
constexpr int most_places = 40;      // of one search
constexpr int deep = 7;              // times that the way is halved: a function that there still jumps has a
                                     // corner or a jump and else no feature
constexpr double safety = 2.5;       // on what a polynomial through earlier values leaves a function to do
constexpr double bent = 0.05;        // of a logarithm: less than two zeros in a step leave of it
constexpr double rounded = 3e-14;    // of the larger end value: nothing, where two zeros are one
constexpr double negligible = 1e-7;  // the same between places that are not told apart

/// a + b x + c x^2 + d x^3 for 0 <= x <= 1.
struct Cubic {
  double a, b, c, d;
  double operator()(double x) const { return a + x * (b + x * (c + x * d)); }
};

/// With the values at both places and the slopes that are known.
Cubic cubic_between(const Node& p, const Node& q) {
  const double w = q.s - p.s;
  const double change = q.value - p.value;
  const double from = p.slope * w;
  const double to = q.slope * w;
  if (std::isnan(from) && std::isnan(to)) return {p.value, change, 0, 0};
  if (std::isnan(from)) return {p.value, 2 * change - to, to - change, 0};
  if (std::isnan(to)) return {p.value, from, change - from, 0};
  return {p.value, from, 3 * change - 2 * from - to, from + to - 2 * change};
}

/// Whether it is so straight that no function like it vanishes twice.
bool is_straight(const Cubic& f, const Node& p, const Node& q) {
  const double leeway = 0.25 * (std::abs(f.c) + 2 * std::abs(f.d));
  return p.value * q.value > 0 && safety * leeway < std::min(std::abs(p.value), std::abs(q.value));
}

/// Where the cubic has its extrema within (0, 1), in their order.
struct Extrema {
  int count = 0;
  std::array<double, 2> x{};
};

Extrema extrema_of(const Cubic& f) {
  Extrema found;
  const double a = 3 * f.d;  // slope b + 2 c x + a x^2
  const double square = f.c * f.c - a * f.b;
  if (!(square >= 0)) return found;
  const double q = -(f.c + std::copysign(std::sqrt(square), f.c));
  double first = a != 0 ? q / a : -1;
  double second = q != 0 ? f.b / q : -1;
  if (first > second) std::swap(first, second);
  for (const double x : {first, second}) {
    if (x > 0 && x < 1) found.x[static_cast<std::size_t>(found.count++)] = x;
  }
  return found;
}

/// Whether it has one sign at both places and neither tangent comes near to zero in between.
bool tangents_keep_away(const Node& p, const Node& q) {
  const auto keeps = [&](const Node& end) {
    return std::abs(end.slope) * (q.s - p.s) < margin * std::abs(end.value);
  };
  return p.value * q.value > 0 && keeps(p) && keeps(q);
}

/// Whether values of one sign, and the middle's slope, are what a cubic through the logarithms of the end
/// values foretells: of a function that fades by orders of magnitude.
bool fades(const Node& p, const Node& middle, const Node& q) {
  if (!(p.value * q.value > 0 && p.value * middle.value > 0)) return false;
  const auto logarithm = [](const Node& node) {
    return Node{node.s, std::log(std::abs(node.value)), node.slope / node.value};
  };
  const Node from = logarithm(p);
  const Node to = logarithm(q);
  const double w = q.s - p.s;
  const Cubic f = cubic_between(from, to);
  const double x = (middle.s - p.s) / w;
  const double slope = f.b + x * (2 * f.c + 3 * x * f.d);
  return std::abs(f(x) - logarithm(middle).value) <= foretold &&
         std::abs(slope - w * logarithm(middle).slope) <= foretold * (4 + std::abs(slope));
}

/// The least of the end values that have the sign of `value`.
double least_alike(double value, const Node& p, const Node& q) {
  double least = std::numeric_limits<double>::infinity();
  for (const double end : {p.value, q.value}) {
    if (end * value > 0) least = std::min(least, std::abs(end));
  }
  return least;
}

/// Where the tangents of the two places meet in between, if they do: at the corner of a function that has
/// one. Else the first place.
Node tangents_meet(const Node& p, const Node& q) {
  if (!(p.slope * q.slope < 0)) return p;
  const double s = (p.value - q.value + q.slope * q.s - p.slope * p.s) / (q.slope - p.slope);
  return s > p.s && s < q.s ? Node{s, p.value + p.slope * (s - p.s), 0} : p;
}

}  // namespace

Zeros zeros_between(const Node& p, const Node& q) {
  const Cubic f = cubic_between(p, q);
  if (!(std::abs(f.d) <= std::max(std::abs(p.value), std::abs(q.value)))) return Zeros::unclear;
  const Extrema extrema = extrema_of(f);
  double last = p.value;
  int changes = 0;
  for (int i = 0; i < extrema.count; ++i) {
    const double value = f(extrema.x[static_cast<std::size_t>(i)]);
    if (!(std::abs(value) >= margin * least_alike(value, p, q))) return Zeros::unclear;
    changes += static_cast<int>(value * last < 0);
    last = value;
  }
  changes += static_cast<int>(q.value * last < 0);
  if (changes == 0 && !(tangents_meet(p, q).value * p.value > 0)) return Zeros::unclear;
  return changes == 0 ? Zeros::none : changes == 1 ? Zeros::one : Zeros::unclear;
}

double zero_of_cubic(const Node& p, const Node& q) {
  const Cubic f = cubic_between(p, q);
  return p.s + (q.s - p.s) * zero_between(f, 0, 1, p.value, q.value);
}

namespace {

class Subdivision {
 public:
  Subdivision(const Node& a, const Node& b, const std::function<std::optional<Node>(double)>& at,
              double least)
      : at_(at), least_(least), size_(std::max(std::abs(a.value), std::abs(b.value))) {}

  FirstZero run(const Node& a, const Node& b) {
    const FirstZero first = between(a, b, false, 0);
    const bool touches = lowest_ && std::abs(lowest_->value) <= rounded * size_;
    const bool is_first = first.kind != FirstZero::Kind::change || (lowest_ && lowest_->s < first.before.s);
    return touches && is_first ? FirstZero{FirstZero::Kind::touch, *lowest_, *lowest_} : first;
  }

 private:
  FirstZero between(const Node& p, const Node& q, bool trusted, int depth) {
    const Zeros zeros = zeros_between(p, q);
    trusted = trusted || is_straight(cubic_between(p, q), p, q);
    const bool changes = p.value * q.value < 0;
    if (trusted && zeros != Zeros::unclear) return found(zeros == Zeros::one, p, q);
    if (depth >= deep && tangents_keep_away(p, q)) return found(false, p, q);
    if (q.s - p.s <= least_) return at_bottom(changes, p, q);
    const double x = place(p, q, depth);
    std::optional<Node> middle = node_near(p, q, x);
    if (!middle) return {places_ > most_places ? FirstZero::Kind::unclear : FirstZero::Kind::unknown, p, q};
    if (middle->value == 0 && changes)  // it is to have a sign
      middle->value = std::copysign(std::numeric_limits<double>::min(), q.value);
    if (!lowest_ || std::abs(middle->value) < std::abs(lowest_->value)) lowest_ = middle;
    const double size = changes ? std::max(std::abs(p.value), std::abs(q.value)) : std::abs(middle->value);
    const double error = std::abs(middle->value - cubic_between(p, q)((middle->s - p.s) / (q.s - p.s)));
    if (fades(p, *middle, q)) return found(false, p, q);
    trusted = trusted || (zeros != Zeros::unclear && error <= foretold * size);
    const FirstZero first = between(p, *middle, trusted, depth + 1);
    return first.kind == FirstZero::Kind::none ? between(*middle, q, trusted, depth + 1) : first;
  }

  /// Beside x, too, where the function may just there have no value.
  std::optional<Node> node_near(const Node& p, const Node& q, double x) {
    for (const double place : {x, 0.8 * x, 0.8 * x + 0.2}) {
      if (++places_ > most_places) break;
      const std::optional<Node> node = at_(p.s + place * (q.s - p.s));
      if (node && std::isfinite(node->value)) return node;
    }
    return std::nullopt;
  }

  static FirstZero found(bool one, const Node& p, const Node& q) {
    return {one ? FirstZero::Kind::change : FirstZero::Kind::none, p, q};
  }

  FirstZero at_bottom(bool changes, const Node& p, const Node& q) const {
    const bool touches = std::max(std::abs(p.value), std::abs(q.value)) <= negligible * size_;
    return {changes   ? FirstZero::Kind::change
            : touches ? FirstZero::Kind::touch
                      : FirstZero::Kind::none,
            p, q};
  }

  /// Where to divide: where the cubic comes nearest to zero, or, since a function may have a corner there,
  /// where the tangents meet, in turn with the middle.
  static double place(const Node& p, const Node& q, int depth) {
    double x = 0.5;
    if (depth % 3 == 1 && p.value * q.value > 0) {
      const Cubic f = cubic_between(p, q);
      const Extrema extrema = extrema_of(f);
      for (int i = 0; i < extrema.count; ++i) {
        const double at = extrema.x[static_cast<std::size_t>(i)];
        if (f(at) * p.value < f(x) * p.value) x = at;
      }
    } else if (depth % 3 == 2) {
      x = (tangents_meet(p, q).s - p.s) / (q.s - p.s);
    }
    return x > 0.01 && x < 0.99 ? x : 0.5;
  }

  const std::function<std::optional<Node>(double)>& at_;
  double least_;
  double size_;
  int places_ = 0;
  std::optional<Node> lowest_;  // of those in between
};

}  // namespace

FirstZero first_zero(const Node& a, const Node& b, const std::function<std::optional<Node>(double s)>& at,
                     double least) {
  return Subdivision(a, b, at, least).run(a, b);
}

namespace {

/// By how much a polynomial through the values leaves a straight line within the step, at most.
double leeway(std::span<const double> places, std::span<const double> values) {
  std::array<double, 5> differences{};
  const std::size_t count = std::min(places.size(), differences.size());
  std::copy_n(values.begin(), count, differences.begin());
  const double step = places[0] - places[1];
  double leeway = 0;
  double reach = 0.25 * step * step;
  for (std::size_t order = 1; order < count; ++order) {
    for (std::size_t i = 0; i + order < count; ++i)
      differences[i] = (differences[i] - differences[i + 1]) / (places[i] - places[i + order]);
    if (order == 1) continue;
    leeway += std::abs(differences[0]) * reach;
    reach *= places[0] - places[order];
  }
  return leeway;
}

}  // namespace

bool may_vanish_twice(std::span<const double> places, std::span<const double> values) {
  if (places.size() < 4) return true;
  const double least = std::min(std::abs(values[0]), std::abs(values[1]));
  return !(safety * leeway(places, values) < least);
}

bool logarithm_may_fall(std::span<const double> places, std::span<const double> logarithms) {
  return places.size() < 4 || !(leeway(places, logarithms) < bent);
}

}  // namespace arcslip::continuation
