// Branch points within a step: zeros of det [J F_p; normal^T], a smooth function of the way along the branch.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "arcslip/continuation/events/first_zero.hpp"
#include "arcslip/continuation/path/stepper.hpp"

namespace arcslip::continuation {
namespace {

constexpr double too_near = 1e-3;    // of the larger determinant at the ends: for other points to lean on
constexpr double off_course = 0.05;  // of the way to its neighbours: a point is expected within
constexpr double widest = 0.05;      // of the step: from how far a branch point is looked at
constexpr int most_narrowings = 10;
constexpr double a_little_way = 1e-3;  // of the largest step: on it the determinant changes from that of a
constexpr double much_less = 1e-5;     // branch point by much

}  // namespace

/// Whether a start is a branch point: a little way off the determinant is much larger.
bool Stepper::starts_singular() {
  const double there = corrector_.log_determinant();
  slope_from_ = normal_;
  if (linearise_beside(here_, slope_from_, a_little_way * max_step_) == Correction::cannot_evaluate)
    return false;
  return there < corrector_.log_determinant() + std::log(much_less);
}

/// The problem has scaled its equations anew, and the determinant with them: that of `here` is found again,
/// of a branch point its sign behind it.
void Stepper::rescale_determinant() {
  revision_ = problem_.revision();
  normal_ = here_.tangent;
  if (std::isinf(here_.log_determinant)) {
    past_.clear();
    if (here_.orientation != 0 &&
        linearise_beside(here_, here_.tangent, a_little_way * max_step_) == Correction::converged)
      here_.orientation = corrector_.orientation();
    return;
  }
  if (corrector_.linearise(here_, normal_) != Correction::converged) return;
  const double sign = corrector_.orientation() * here_.orientation;
  const double change = corrector_.log_determinant() - here_.log_determinant;
  here_.orientation *= sign;
  here_.log_determinant += change;
  for (PastPoint& past : past_) {
    past.sign *= sign;
    past.log += change;
  }
}

/// Whether what is known of the determinant leaves room for branch points in the step.
bool Stepper::may_cross() const {
  if (there_.orientation * here_.orientation <= 0) return true;
  if (!pairs_) return false;
  std::array<double, 2 + most_past> places{step_.norm(), 0};
  std::array<double, 2 + most_past> values{std::exp(there_.log_determinant - here_.log_determinant), 1};
  std::size_t count = 2;
  for (const PastPoint& past : past_) {
    places[count] = -past.behind;
    values[count++] = past.sign * here_.orientation * std::exp(past.log - here_.log_determinant);
  }
  return may_vanish_twice({places.data(), count}, {values.data(), count});
}

/// Looks for the first branch point in the step. False where none explains a change of sign, or where it
/// cannot be told: then the step has to be shorter.
bool Stepper::search_crossing() {
  determinant_.here = here_.log_determinant + std::log(normal_.dot(here_.tangent));
  determinant_.there = corrector_.log_determinant();
  determinant_.unit = std::max(determinant_.here, determinant_.there);
  determinant_.from_zero = std::isinf(determinant_.here);
  anchors_.clear();
  const auto at = [this](double s) { return determinant_at(s); };
  const std::optional<Node> from = at(0);
  const std::optional<Node> to = at(distance_);
  if (!from || !to) return false;
  const FirstZero found = first_zero(*from, *to, at, tolerances_.one_branch_point * distance_);
  if (found.kind == FirstZero::Kind::none) return true;
  return found.kind != FirstZero::Kind::unknown && locate_crossing(found.before, found.behind);
}

/// The determinant in its unit; in a step that starts on a branch point it is divided by s.
std::optional<Node> Stepper::determinant_at(double s) {
  const auto sized = [this](double sign, double log) { return sign * std::exp(log - determinant_.unit); };
  const bool inside = s > 0 && s < distance_;
  if (inside && !probe_between(s)) return std::nullopt;
  const CurvePoint& point = inside ? probe_ : s > 0 ? there_ : here_;
  const Vector& slope = inside ? probe_slope_ : s > 0 ? slope_to_ : slope_from_;
  Node node{s, sized(corrector_.orientation(), corrector_.log_determinant()), std::nan("")};
  if (inside && std::abs(node.value) > too_near) anchor(s);
  if (!inside) node.value = sized(point.orientation, s > 0 ? determinant_.there : determinant_.here);

  const double offset = beside(s);
  if (linearise_beside(point, slope, offset) != Correction::cannot_evaluate)
    node.slope = (sized(corrector_.orientation(), corrector_.log_determinant()) - node.value) / offset;
  if (!determinant_.from_zero) return node;
  if (s == 0) return Node{0, node.slope, std::nan("")};
  return Node{s, node.value / s, (node.slope - node.value / s) / s};
}

/// A point that lies where its neighbours let expect it.
bool Stepper::probe_between(double s) {
  double width = std::min(s, distance_ - s);
  for (const Anchor& anchor : anchors_) width = std::min(width, std::abs(anchor.s - s));
  interpolate(s, expected_);
  if (!probe(s)) return false;
  corrector_.difference(probe_, here_, work_);
  const double error = (work_ - expected_).norm() / step_.norm();
  return error <= off_course * width / distance_ + tolerances_.off_by_rounding;
}

/// Keeps the point last probed, from which others are found.
void Stepper::anchor(double s) {
  const auto next = std::find_if(anchors_.begin(), anchors_.end(), [s](const Anchor& a) { return a.s >= s; });
  if (next != anchors_.end() && next->s == s) return;
  corrector_.difference(probe_, here_, work_);
  anchors_.insert(next, {s, work_, probe_slope_});
}

/// Locates a branch point by polynomials from both sides, where the branch is still regular.
bool Stepper::locate_crossing(Node before, Node behind) {
  const bool changes = before.value * behind.value < 0;
  const auto value_at = [this](double place) -> std::optional<double> {
    const std::optional<Node> node = determinant_at(place);
    return node ? std::optional(node->value) : std::nullopt;
  };
  const double sign_behind = changes ? behind.value : there_.orientation;
  double s = changes ? zero_of_cubic(before, behind) : 0.5 * (before.s + behind.s);
  for (double radius = widest * distance_; radius > tolerances_.nearest_look * distance_; radius *= 0.25) {
    if (changes && !narrow(before, behind, s, radius)) return false;
    const ZeroRange range{changes ? before.s : 0, changes ? behind.s : distance_, s, !changes, 0, distance_};
    const std::optional<RemoteZero> zero = remote_zero(value_at, range, radius);
    if (zero && zero->agrees && take_crossing(*zero, sign_behind)) return true;
    if (zero) s = zero->s;
  }
  return false;
}

/// Brings the zero between two places, at about s, within a radius of s.
bool Stepper::narrow(Node& before, Node& behind, double& s, double radius) {
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
bool Stepper::take_crossing(const RemoteZero& zero, double sign_behind) {
  const Index n = corrector_.size();
  Crossing crossing{zero.s, here_, Vector::Zero(n + 1)};
  expected_.setZero();
  std::array<double, RemoteZero::count> parameters{};
  for (std::size_t i = 0; i < RemoteZero::count; ++i) {
    interpolate(zero.places[i], work_);  // all of them are points of the branch
    parameters[i] = work_(n);
    expected_ += zero.weights[i] * work_;
    crossing.slope += zero.slopes[i] * work_;
  }
  CurvePoint& point = crossing.point;
  corrector_.displace(here_, expected_, point);
  const bool has_value = corrector_.linearise(point, normal_) != Correction::cannot_evaluate;
  if (!has_value || !(point.residual <= 10 * corrector_.tolerance())) return false;
  // A parameter that turns at the branch point runs the other way on its other side.
  double& rate = crossing.slope(n);
  const auto behind =
      std::find_if(anchors_.begin(), anchors_.end(), [&](const Anchor& a) { return a.s > zero.s; });
  double around = 0;
  for (std::size_t i = 0; i < RemoteZero::count; ++i)
    around = std::max(around, std::abs((parameters[i] - expected_(n)) / (zero.places[i] - zero.s)));
  if (std::abs(rate) <= tolerances_.turns * around) rate = 0;
  crossing.rate_behind = rate != 0 ? rate : behind != anchors_.end() ? behind->slope(n) : slope_to_(n);
  corrector_.set_scale(point);
  point.tangent = (crossing.slope.array() * here_.scale.array() / point.scale.array()).matrix().normalized();
  point.iterations = 0;
  point.orientation = std::copysign(1.0, sign_behind);
  point.log_determinant = -std::numeric_limits<double>::infinity();
  crossing_ = std::move(crossing);
  return true;
}

std::optional<double> Stepper::passes(const CurvePoint& past) {
  if (past.regime != here_.regime) return std::nullopt;
  if (crossing_) {  // no probe finds a start that is the branch point itself
    corrector_.difference(past, crossing_->point, predicted_);
    if (predicted_.norm() < tolerances_.same_point && crossing_->point.tangent.dot(past.tangent) > 0)
      return crossing_->s;
  }
  const double length = step_.norm();
  const Index parameter = corrector_.parameter();
  const double aside = past.parameters(parameter) - here_.parameters(parameter);
  if (!(std::abs(aside) < 2 * length * here_.scale(corrector_.size()))) return std::nullopt;  // most often
  corrector_.difference(past, here_, predicted_);
  const double s = normal_.dot(predicted_);
  if (!(predicted_.norm() < 2 * length) || !(s > 0) || !(s <= distance_)) return std::nullopt;
  interpolate(s, work_);
  if (!((work_ - predicted_).norm() < 0.05 * length) || !probe(s)) return std::nullopt;
  corrector_.difference(past, probe_, predicted_);
  work_ = probe_slope_.cwiseProduct(here_.scale).cwiseQuotient(past.scale);
  const bool same_way = work_.dot(past.tangent) > 0;
  if (!(predicted_.norm() < tolerances_.same_point) || !same_way) return std::nullopt;
  return s;
}

}  // namespace arcslip::continuation
