#include "arcslip/continuation/events/crossing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace arcslip::continuation {
namespace {

constexpr double too_near = 1e-3;    // of the larger determinant at the ends: for other points to lean on
constexpr double off_course = 0.05;  // of the way to its neighbours: a point is expected within
constexpr double widest = 0.05;      // of the step: from how far a branch point is looked at
constexpr int most_narrowings = 10;
constexpr Index most_multiple = 6;  // of a zero: as many places show it
constexpr double rounding = 1e-12;  // of the determinant's slope at a branch point: what is left on the next
constexpr double a_little_way = 1e-3;  // of the largest step: on it the determinant changes from that of a
constexpr double much_less = 1e-5;     // branch point by much

/// Whether the determinant has another sign at two places although its slope at none of them leads to zero.
bool leaps(const Node& p, const Node& q) {
  const auto keeps = [&](const Node& end) {
    return 2 * std::abs(end.slope) * (q.s - p.s) < std::abs(end.value);
  };
  return p.value * q.value < 0 && keeps(p) && keeps(q);
}

}  // namespace

CrossingSearch::CrossingSearch(Corrector& corrector, Prober& prober, Step& step, const Tolerances& tolerances)
    : corrector_(corrector),
      prober_(prober),
      step_(step),
      tolerances_(tolerances),
      expected_(Vector::Zero(corrector.size() + 1)),
      work_(expected_) {}

bool CrossingSearch::starts_singular(double max_step) {
  const double there = corrector_.log_determinant();
  step_.slope_from = step_.normal;
  if (prober_.linearise_beside(step_.here, step_.slope_from, a_little_way * max_step) ==
      Correction::cannot_evaluate)
    return false;
  return there < corrector_.log_determinant() + std::log(much_less);
}

void CrossingSearch::rescale(double max_step) {
  step_.normal = step_.here.tangent;
  if (std::isinf(step_.here.log_determinant)) {
    step_.past.clear();
    if (step_.here.orientation != 0 &&
        prober_.linearise_beside(step_.here, step_.here.tangent, a_little_way * max_step) ==
            Correction::converged)
      step_.here.orientation = corrector_.orientation();
    return;
  }
  if (corrector_.linearise(step_.here, step_.normal) != Correction::converged) return;
  const double sign = corrector_.orientation() * step_.here.orientation;
  const double change = corrector_.log_determinant() - step_.here.log_determinant;
  step_.here.orientation *= sign;
  step_.here.log_determinant = corrector_.log_determinant();
  for (PastPoint& past : step_.past) {
    past.sign *= sign;
    past.log += change;
  }
}

bool CrossingSearch::may_find(bool pairs) const {
  if (step_.there.orientation * step_.here.orientation <= 0) return true;
  if (!pairs) return false;
  std::array<double, 2 + most_past> places{step_.chord.norm(), 0};
  std::array<double, 2 + most_past> logs{step_.there.log_determinant - step_.here.log_determinant, 0};
  std::array<double, 2 + most_past> values{std::exp(logs[0]), 1};
  std::size_t count = 2;
  bool has_one_sign = true;
  for (const PastPoint& past : step_.past) {
    const double sign = past.sign * step_.here.orientation;
    has_one_sign = has_one_sign && sign > 0;
    places[count] = -past.behind;
    logs[count] = past.log - step_.here.log_determinant;
    values[count] = sign * std::exp(logs[count]);
    ++count;
  }
  const std::span<const double> at(places.data(), count);
  return may_vanish_twice(at, {values.data(), count}) &&
         (!has_one_sign || logarithm_may_fall(at, {logs.data(), count}));
}

bool CrossingSearch::search(bool may_leap) {
  log_here_ = step_.here.log_determinant + std::log(step_.normal.dot(step_.here.tangent));
  log_there_ = corrector_.log_determinant();
  unit_ = std::max(log_here_, log_there_);
  step_.anchors.clear();
  from_zero_ = std::isinf(log_here_) ? multiplicity_at_start() : 0;
  const auto at = [this](double s) { return determinant_at(s); };
  const std::optional<Node> from = at(0);
  const std::optional<Node> to = at(step_.distance);
  if (!from || !to) return false;
  if (from_zero_ > 0 && std::abs(to->value) < rounding * std::abs(from->value))
    return false;  // on another one
  const FirstZero found = first_zero(*from, *to, at, tolerances_.one_branch_point * step_.distance);
  if (found.kind == FirstZero::Kind::none) return true;
  if (may_leap && found.kind == FirstZero::Kind::change && leaps(found.before, found.behind)) return false;
  if (passes_pole(found.before, found.behind)) return false;
  if (found.kind != FirstZero::Kind::unknown && locate(found.before, found.behind)) return true;
  // So near to where several eigenvalues vanish at once that no point is found, or signs are rounding.
  const bool is_near = found.behind.s - found.before.s <= widest * step_.distance;
  return is_near && locate(found.before, found.before);
}

/// Whether the determinant has its other sign behind a pole and not a zero, as conditions on special points
/// have it where their borders no longer fit: on a shorter step these are renewed before.
bool CrossingSearch::passes_pole(Node p, Node q) {
  constexpr double large = 10;  // beside 1, as the determinant is at one of the step's ends
  constexpr int enough = 8;     // halvings
  const auto grow = [&] { return std::min(std::abs(p.value), std::abs(q.value)) > large; };
  const auto may_grow = [&] { return p.value * p.slope > 0 || q.value * q.slope < 0; };
  if (p.value * q.value > 0) return false;
  for (int i = 0; i < enough && !grow() && may_grow(); ++i) {
    const std::optional<Node> middle = determinant_at(0.5 * (p.s + q.s));
    if (!middle) return false;
    (middle->value * p.value > 0 ? p : q) = *middle;
  }
  return grow();
}

bool CrossingSearch::jumps() {
  const std::optional<Node> from = from_zero_ > 0 ? std::nullopt : determinant_at(0);
  const std::optional<Node> to = from ? determinant_at(step_.distance) : std::nullopt;
  if (!to || !leaps(*from, *to)) return false;
  double low = 0;
  Step::Crossing corner{step_.distance, step_.there, step_.slope_to, step_.parameter_rate_to()};
  while (corner.s - low > tolerances_.located * step_.distance) {
    const double middle = 0.5 * (low + corner.s);
    if (!prober_.probe(middle)) return false;
    if (corrector_.orientation() == step_.here.orientation) {
      low = middle;
      continue;
    }
    corner = {middle, prober_.probed().point, prober_.probed().slope, prober_.probed().parameter_rate()};
    corrector_.set_tangent(corner.point, step_.here);
  }
  step_.crossing = std::move(corner);
  return true;
}

/// How far from the start the determinant is as it begins and yet no rounding, as the parameter's change.
double CrossingSearch::way_from_start() const {
  constexpr double least = 1e-7;  // of the step
  constexpr double most = 0.01;
  constexpr double told = 1e-13;  // of the parameter's scale: 10^3 of its roundings
  const double rate = std::abs(step_.parameter_rate_from());
  const double bend = std::abs(step_.parameter_rate_to() - step_.parameter_rate_from()) / step_.distance;
  const double way = 2 * told / (rate + std::sqrt(rate * rate + 2 * bend * told));
  return std::clamp(way, least * step_.distance, most * step_.distance);
}

/// Factors the problem a little way from the start on the curve through the step: where several eigenvalues
/// vanish at once, how the branch bends tells the determinant.
bool CrossingSearch::linearise_behind_start(double way) {
  step_.interpolate(way, work_);
  work_ /= way;
  return prober_.linearise_beside(step_.here, work_, way) != Correction::cannot_evaluate;
}

/// By how the determinant begins.
int CrossingSearch::multiplicity_at_start() {
  const double way = way_from_start();
  std::array<double, 2> logs{};
  for (std::size_t i = 0; i < 2; ++i) {
    if (!linearise_behind_start(way * static_cast<double>(i + 1))) return 1;
    logs[i] = corrector_.log_determinant();
    if (i == 0) behind_start_ = {way, corrector_.orientation() * std::exp(logs[0] - unit_), std::nan("")};
  }
  const double order = (logs[1] - logs[0]) / std::log(2.0);
  return std::isfinite(order) ? std::max(1, static_cast<int>(std::lround(order))) : 1;
}

/// The determinant in its unit; in a step that starts on a branch point it is divided by s to its power.
std::optional<Node> CrossingSearch::determinant_at(double s) {
  const auto sized = [this](double sign, double log) { return sign * std::exp(log - unit_); };
  if (s == 0 && from_zero_ > 1)
    return Node{0, behind_start_.value / std::pow(behind_start_.s, from_zero_), std::nan("")};
  const bool inside = s > 0 && s < step_.distance;
  if (inside && !probe_between(s)) return std::nullopt;
  const CurvePoint& point = inside ? prober_.probed().point : s > 0 ? step_.there : step_.here;
  const Vector& slope = inside ? prober_.probed().slope : s > 0 ? step_.slope_to : step_.slope_from;
  Node node{s, sized(corrector_.orientation(), corrector_.log_determinant()), std::nan("")};
  if (inside && std::abs(node.value) > too_near) prober_.anchor();
  if (!inside) node.value = sized(point.orientation, s > 0 ? log_there_ : log_here_);

  const double offset = prober_.offset_beside(s);
  if (prober_.linearise_beside(point, slope, offset) != Correction::cannot_evaluate)
    node.slope = (sized(corrector_.orientation(), corrector_.log_determinant()) - node.value) / offset;
  if (from_zero_ == 0) return node;
  if (s == 0) return Node{0, node.slope / std::pow(offset, from_zero_ - 1), std::nan("")};
  const double power = std::pow(s, from_zero_);
  return Node{s, node.value / power, (node.slope - from_zero_ * node.value / s) / power};
}

/// A point that lies where its neighbours let expect it.
bool CrossingSearch::probe_between(double s) {
  double width = std::min(s, step_.distance - s);
  for (const Step::Anchor& anchor : step_.anchors) width = std::min(width, std::abs(anchor.s - s));
  step_.interpolate(s, expected_);
  if (!prober_.probe(s)) return false;
  corrector_.difference(prober_.probed().point, step_.here, work_);
  const double error = (work_ - expected_).norm() / step_.chord.norm();
  return error <= off_course * width / step_.distance + tolerances_.off_by_rounding;
}

/// Locates a branch point by polynomials from both sides, where the branch is still regular.
bool CrossingSearch::locate(Node before, Node behind) {
  const bool changes = before.value * behind.value < 0;
  const double sign_behind = changes ? behind.value : step_.there.orientation;
  double s = changes ? zero_of_cubic(before, behind) : 0.5 * (before.s + behind.s);
  for (double radius = widest * step_.distance; radius > tolerances_.nearest_look * step_.distance;
       radius *= 0.25) {
    if (changes && !narrow(before, behind, s, radius)) return false;
    ZeroRange range{changes ? before.s : 0, changes ? behind.s : step_.distance, s, changes ? 1 : 2, 0,
                    step_.distance};
    Values known;
    std::optional<RemoteZero> zero = remote_zero(values(known), range, radius);
    if (zero && zero->agrees && take(*zero, sign_behind)) return true;
    if (take_multiple(range, radius, known)) return true;
    if (zero) s = zero->s;
  }
  return false;
}

/// The determinant, where it is not known yet.
std::function<std::optional<double>(double s)> CrossingSearch::values(Values& known) {
  return [this, &known](double place) {
    const auto [entry, is_new] = known.try_emplace(place);
    if (!is_new) return entry->second;
    const std::optional<Node> node = determinant_at(place);
    if (node) entry->second = node->value;
    return entry->second;
  };
}

/// Where several eigenvalues vanish at once: the least multiplicity of which the polynomials agree. Next to
/// such a point signs are rounding, and nothing but the guess tells where it is.
bool CrossingSearch::take_multiple(ZeroRange range, double radius, Values& known) {
  const Index most = std::min<Index>(most_multiple, corrector_.size());
  range.low = 0;
  range.high = step_.distance;
  for (range.multiplicity = 2; range.multiplicity <= most; ++range.multiplicity) {
    const std::optional<RemoteZero> zero = remote_zero(values(known), range, radius);
    if (!zero || !zero->agrees) continue;
    for (const double place : zero->places) {  // the determinant is too small there to tell that they serve
      if (probe_between(place)) prober_.anchor();
    }
    const double last = zero->places.back();
    const bool turns = last < zero->s && range.multiplicity % 2 == 1;
    if (take(*zero, (turns ? -1 : 1) * known[last].value_or(0))) return true;
  }
  return false;
}

/// Brings the zero between two places, at about s, within a radius of s.
bool CrossingSearch::narrow(Node& before, Node& behind, double& s, double radius) {
  for (int i = 0; i < most_narrowings; ++i) {
    const double low = s - radius;
    const double high = s + radius;
    if (low > before.s) {
      const std::optional<Node> node = determinant_at(low);
      if (!node) return false;
      (node->value * before.value > 0 ? before : behind) = *node;
    }
    if (high < behind.s) {
      const std::optional<Node> node = determinant_at(high);
      if (!node) return false;
      (node->value * before.value > 0 ? before : behind) = *node;
    }
    if (low <= before.s && behind.s <= high) return true;
    s = zero_of_cubic(before, behind);
  }
  return false;
}

/// The point itself, interpolated on the branch; false if it is none.
bool CrossingSearch::take(const RemoteZero& zero, double sign_behind) {
  const Index n = corrector_.size();
  Step::Crossing crossing{zero.s, step_.here, Vector::Zero(n + 1)};
  expected_.setZero();
  std::array<double, RemoteZero::count> parameters{};
  double other_rate = 0;
  for (std::size_t i = 0; i < RemoteZero::count; ++i) {
    step_.interpolate(zero.places[i], work_);  // all of them are points of the branch
    parameters[i] = work_(n);
    other_rate += zero.other_slopes[i] * work_(n);
    expected_ += zero.weights[i] * work_;
    crossing.slope += zero.slopes[i] * work_;
  }
  CurvePoint& point = crossing.point;
  corrector_.displace(step_.here, expected_, point);
  const bool has_value = corrector_.linearise(point, step_.normal) != Correction::cannot_evaluate;
  if (!has_value || !(point.residual <= corrector_.tolerance())) return false;
  // A parameter that turns at the branch point runs the other way on its other side.
  double& rate = crossing.slope(n);
  const auto behind = std::find_if(step_.anchors.begin(), step_.anchors.end(),
                                   [&](const Step::Anchor& a) { return a.s > zero.s; });
  double around = 0;
  for (std::size_t i = 0; i < RemoteZero::count; ++i)
    around = std::max(around, std::abs((parameters[i] - expected_(n)) / (zero.places[i] - zero.s)));
  // What rounding or a mesh adds to the equations moves the parameter by k/x a way x off: the rates of both
  // polynomials differ by k over the square of their radius. Up to about x^3 = k/bend rates are such errors.
  const double lost = 0.5 * std::cbrt(around * around * std::abs(rate - other_rate));
  if (std::abs(rate) <= std::max(tolerances_.turns * around, lost)) rate = 0;
  crossing.rate_behind = rate != 0                       ? rate
                         : behind != step_.anchors.end() ? behind->slope(n)
                                                         : step_.slope_to(n);
  corrector_.set_scale(point);
  point.tangent =
      (crossing.slope.array() * step_.here.scale.array() / point.scale.array()).matrix().normalized();
  point.iterations = 0;
  point.orientation = std::copysign(1.0, sign_behind);
  point.log_determinant = -std::numeric_limits<double>::infinity();
  step_.crossing = std::move(crossing);
  return true;
}

}  // namespace arcslip::continuation
