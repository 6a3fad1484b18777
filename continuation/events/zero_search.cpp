#include "arcslip/continuation/events/zero_search.hpp"

#include <algorithm>
#include <cmath>

#include "arcslip/zero_between.hpp"

namespace arcslip::continuation {
namespace {

constexpr double just_behind = 1e-6;  // of the step: where a function is read that has no value before
constexpr double flat = 1e-6;         // of a change: a slope over the way that is none
constexpr double noise = 1e-11;       // of a change: a value that may be no more
constexpr double clear = 1e-4;  // of the way: from a zero that is divided out, and leaves rounding beside it

/// Zeros that are known, to be divided out of a function.
struct Divisor {
  std::optional<double> low;
  std::optional<double> high;

  bool is_near(double s, double way) const {
    return (low && std::abs(s - *low) < way) || (high && std::abs(s - *high) < way);
  }

  Node divide(Node node) const {
    for (const std::optional<double>& zero : {low, high}) {
      if (!zero) continue;
      if (node.s == *zero) {
        node = {node.s, node.slope, std::nan("")};
      } else {
        const double value = node.value / (node.s - *zero);
        node = {node.s, value, (node.slope - value) / (node.s - *zero)};
      }
    }
    return node;
  }
};

}  // namespace

/// The first zero of one of the readings in (from, upper], of which `sign` is that before the zero, 0 if
/// unknown.
Zero ZeroSearch::first(std::size_t which, int sign, double from, double to, double tolerance) {
  // A derivative may have no value at a point, as that of an amplitude where this vanishes.
  const double begin = readings_.value(which, from) ? from : from + just_behind * (to - from);
  const std::optional<Node> a = readings_.node(which, begin);
  const std::optional<Node> b = readings_.node(which, to);
  if (!a || !b) return {Zero::State::failed};
  return first_between(*a, *b, sign, tolerance, which);
}

/// At both ends a function that all but vanishes has a zero, which is divided out.
Zero ZeroSearch::first_between(const Node& a, const Node& b, int sign, double tolerance, std::size_t which) {
  const double width = b.s - a.s;
  const double change = std::max({std::abs(a.value), std::abs(b.value), std::abs(a.slope) * width});
  Divisor divisor;
  const bool is_beyond = sign != 0 && sign_of(a.value) == -sign;
  const bool is_small = is_beyond || std::abs(a.value) <= stepper_.tolerances().just_passed * change;
  const bool vanishes_here = is_small && (options_.jumps_count || is_left_over(a, b, which));
  if (is_beyond && !vanishes_here) sign = -sign;  // it has jumped there
  if (vanishes_here) {
    // Of a double zero that the way begins on the slope is rounding.
    const bool is_flat = options_.least_touched == 0 && std::abs(a.slope) * width < flat * change;
    if (sign != 0 && sign_of(a.slope) == -sign && !is_flat)
      return {Zero::State::found, just_ahead(a, width, std::abs(a.value) > noise * change ? sign : 0, which)};
    divisor.low = a.s;
  }
  if (std::abs(b.value) <= tolerance * change) divisor.high = b.s;
  const auto at = [&](double s) -> std::optional<Node> {
    const std::optional<Node> node = readings_.node(which, s);
    return node ? std::optional(divisor.divide(*node)) : std::nullopt;
  };
  const auto value_at = [&](double s) -> std::optional<double> {
    const std::optional<double> value = readings_.value(which, s);
    return value ? std::optional(divisor.divide({s, *value, 0}).value) : std::nullopt;
  };
  const Node from = divisor.divide(a);
  const Node to = divisor.divide(b);
  const FirstZero found = first_zero(from, to, at, stepper_.tolerances().one_zero * stepper_.step().distance);
  switch (found.kind) {
    case FirstZero::Kind::unknown: return {Zero::State::failed};
    case FirstZero::Kind::unclear:
      return a.value * b.value < 0 || stepper_.step().is_tiny(stepper_.step().distance)
                 ? by_sign(a, b, sign, which)
                 : Zero{Zero::State::failed};
    case FirstZero::Kind::touch:
      if (divisor.is_near(found.before.s, clear * width)) return {Zero::State::absent};
      if (change >= options_.least_touched) return {Zero::State::found, found.before.s, true};
      return divisor.low || divisor.high ? Zero{Zero::State::absent} : by_sign(a, b, sign, which);
    case FirstZero::Kind::change:
      return locate(found.before, found.behind, std::max(std::abs(from.value), std::abs(to.value)), value_at);
    case FirstZero::Kind::none: break;
  }
  const bool ends_there = divisor.high && b.slope * (divisor.low ? a.slope : a.value) < 0;
  return {ends_there ? Zero::State::found : Zero::State::absent, b.s};
}

/// A zero close to where the way begins, as the slope there has it; where the `sign` of the value there is
/// known, from between that and the other sign.
double ZeroSearch::just_ahead(const Node& a, double width, int sign, std::size_t which) {
  const double way = std::clamp(-a.value / a.slope, 0.0, width);
  if (sign == 0 || sign_of(a.value) != sign) return a.s + way;
  for (double reach = 2 * way; reach < width && reach <= 16 * way; reach *= 2) {
    const std::optional<double> there = readings_.value(which, a.s + reach);
    if (there && sign_of(*there) == -sign)
      return zero_between([&](double s) { return readings_.value(which, s).value_or(0); }, a.s, a.s + reach,
                          a.value, *there);
  }
  return a.s + way;
}

/// Whether the first value is what rounding leaves of a zero.
bool ZeroSearch::is_left_over(const Node& a, const Node& b, std::size_t which) {
  const double middle = readings_.value(which, 0.5 * (a.s + b.s)).value_or(0);
  return std::abs(a.value) <= options_.left_over * std::max(std::abs(b.value), std::abs(middle));
}

Zero ZeroSearch::by_sign(const Node& a, const Node& b, int sign, std::size_t which) {
  const int before = sign != 0 ? sign : sign_of(a.value);
  if (before * sign_of(b.value) >= 0) return {Zero::State::absent};
  if (before * sign_of(a.value) <= 0) return {Zero::State::found, a.s};
  return locate(a, b, std::max(std::abs(a.value), std::abs(b.value)),
                [&](double s) { return readings_.value(which, s); });
}

Zero ZeroSearch::first_of_pieces(const PiecewiseFunction& of, int sign, bool two, double from, double to) {
  const std::optional<double> a = readings_.value(of.value, from);
  const std::optional<double> b = readings_.value(of.value, to);
  const std::optional<double> piece = readings_.value(of.piece, from);
  if (!a || !b || !piece) return {Zero::State::failed};
  const bool has_jumped = sign_of(*a) == -sign && std::abs(*a) > options_.left_over * std::abs(*b);
  const int before = sign == 0 || has_jumped ? sign_of(*a) : sign;
  const bool changes = before * sign_of(*b) < 0;
  const bool may_jump = readings_.value(of.piece, to) != piece;
  if ((two || may_jump) && to - from > finest_ * stepper_.step().distance) {
    const double middle = 0.5 * (from + to);
    const Zero first = first_of_pieces(of, before, false, from, middle);
    return first.state == Zero::State::absent ? first_of_pieces(of, 0, false, middle, to) : first;
  }
  if (!changes) return {Zero::State::absent};
  if (to - from < 2 * no_way) return {Zero::State::found, to};  // whether it jumps there cannot be told
  const Zero zero = by_sign({from, *a, 0}, {to, *b, 0}, before, of.value);
  return zero.state == Zero::State::found ? just_behind_corner(zero.s, to, before, of.value) : zero;
}

/// What lies ahead of a corner has to be begun with the derivatives there. As far as nothing shows that it is
/// passed, it is where the function is known to have its other sign.
Zero ZeroSearch::just_behind_corner(double s, double to, int before, std::size_t which) {
  constexpr double least_way = 1e-11;  // relative to the step: growth rates go with the root of it
  constexpr double rounding = 2e-15;   // of what is read, some bits of a place
  for (double way = std::max(least_way * to, rounding); s + way < to; way *= 4) {
    const std::optional<double> value = readings_.value(which, s + way);
    if (value && sign_of(*value) == -before) return {Zero::State::found, s + way};
  }
  return {Zero::State::found, to};
}

Zero ZeroSearch::locate(const Node& a, const Node& b, double size, const ValueAt& at) const {
  bool solved = true;
  const auto value = [&](double s) {
    const std::optional<double> there = solved ? at(s) : std::nullopt;
    solved = there.has_value();
    return there.value_or(0);
  };
  constexpr int coarsely = 20;  // bits, enough to tell a jump
  constexpr double plainly_left = 0.01;
  if (!options_.jumps_count) {
    const double near = zero_between(value, a.s, b.s, a.value, b.value, coarsely);
    if (!solved) return {Zero::State::failed};
    if (std::abs(value(near)) > plainly_left * size) return {Zero::State::absent, near};
  }
  const double s = zero_between(value, a.s, b.s, a.value, b.value);
  const bool jumps = std::abs(value(s)) > options_.left_over * size;
  if (!solved) return {Zero::State::failed};
  return {jumps && !options_.jumps_count ? Zero::State::absent : Zero::State::found, s};
}

}  // namespace arcslip::continuation
