#include "elements/circle/slip_panel.hpp"

#include <algorithm>
#include <cmath>

#include "arcslip/dense.hpp"
#include "motion/isolated_zeros.hpp"

namespace arcslip {
namespace {

using PanelMatrix = Eigen::Matrix<double, panel_nodes, panel_nodes>;
using PanelTransform = Eigen::Matrix<double, panel_nodes + 1, panel_nodes + 1>;

/// P_m(x) and P_(m-1)(x).
std::pair<double, double> legendre(double x) {
  double before = 1;
  double here = x;
  for (Index k = 1; k < panel_nodes; ++k) {
    const auto n = static_cast<double>(k);
    const double next = ((2 * n + 1) * x * here - n * before) / (n + 1);
    before = here;
    here = next;
  }
  return {here, before};
}

/// Radau's points and weights on [0, 1], with the derivative and the Chebyshev coefficients of the polynomial
/// through 0 and them.
struct RadauScheme {
  RadauScheme() {
    // All zeros of P_(m-1) - P_m but the last point lie apart by more than a cell.
    constexpr int cells = 4000;
    const auto difference = [](double angle) {
      const auto [here, before] = legendre(-std::cos(angle));
      return before - here;
    };
    Index found = 0;
    for (int i = 0; i + 1 < cells && found + 1 < panel_nodes; ++i) {
      double low = pi * i / cells;
      double high = pi * (i + 1) / cells;
      if (difference(low) * difference(high) > 0) continue;
      for (int k = 0; k < 60; ++k) {
        const double middle = 0.5 * (low + high);
        (difference(low) * difference(middle) > 0 ? low : high) = middle;
      }
      place(found++) = -std::cos(0.5 * (low + high));
    }
    place(panel_nodes - 1) = 1;
    for (Index j = 0; j < panel_nodes; ++j) {
      const double before = legendre(place(j)).second;
      weight(j) = 0.5 * (1 + place(j)) / (static_cast<double>(panel_nodes * panel_nodes) * before * before);
    }
    PanelCourse points;
    points << -1, place;
    PanelTransform values;
    for (Index j = 0; j <= panel_nodes; ++j) {
      for (Index k = 0; k <= panel_nodes; ++k)
        values(j, k) = std::cos(static_cast<double>(k) * std::acos(std::clamp(points(j), -1.0, 1.0)));
    }
    coefficients = inverse_of(values).value();
    differentiate(points);
    place = 0.5 * (place.array() + 1);
  }

  void differentiate(const PanelCourse& points) {
    PanelCourse bary;
    for (Index j = 0; j <= panel_nodes; ++j) {
      bary(j) = 1;
      for (Index k = 0; k <= panel_nodes; ++k) bary(j) *= k == j ? 1 : 1 / (2 * (points(j) - points(k)));
    }
    for (Index j = 1; j <= panel_nodes; ++j) {
      double sum = 0;
      for (Index k = 0; k <= panel_nodes; ++k) {
        if (k == j) continue;
        const double entry = 2 * bary(k) / bary(j) / (points(j) - points(k));
        sum += entry;
        (k == 0 ? by_start(j - 1) : by_nodes(j - 1, k - 1)) = entry;
      }
      by_nodes(j - 1, j - 1) = -sum;
    }
  }

  PanelVector place;
  PanelVector weight;
  PanelVector by_start;  // d/ds of what is 1 at s = 0
  PanelMatrix by_nodes;
  PanelTransform coefficients;
};

const RadauScheme& scheme() {
  static const RadauScheme known;
  return known;
}

PanelCourse with_start(double start, const PanelVector& rest) {
  PanelCourse all;
  all << start, rest;
  return all;
}

/// By Clenshaw, x from -1 to 1, with the derivative.
std::pair<double, double> value_of(const PanelCourse& course, double x) {
  double one = 0, two = 0, rate = 0, rate_two = 0;
  for (Index k = panel_nodes; k >= 1; --k) {
    const double next_rate = 2 * one + 2 * x * rate - rate_two;
    rate_two = std::exchange(rate, next_rate);
    const double next = course(k) + 2 * x * one - two;
    two = std::exchange(one, next);
  }
  return {course(0) + x * one - two, one + x * rate - rate_two};
}

/// b D + Re(w' e^{-i phi}), with D in theta.
PanelMatrix equation(const SlipPanel& panel) {
  PanelMatrix a = panel.radius.cwiseQuotient(panel.pace).asDiagonal() * scheme().by_nodes;
  a.diagonal() += panel.along;
  return a;
}

/// Newton's method with a matrix that is made anew while steps are long; false where it leaves.
bool converge(const std::array<CircleMotion::Local, panel_nodes>& local, SlipPanel& panel) {
  constexpr double farthest = 2;  // of phi from its start
  constexpr double far = 0.03;    // to keep the matrix
  constexpr double rounding = 1e-15;
  Eigen::PartialPivLU<PanelMatrix> matrix;
  double since = far;  // it was made
  for (int i = 0; i < 16; ++i) {
    PanelVector across;
    for (Index j = 0; j < panel_nodes; ++j) {
      const CircleMotion::Local& here = local[static_cast<std::size_t>(j)];
      const Complex turned = here.rate * std::polar(1.0, -panel.phase(j));
      panel.along(j) = turned.real();
      across(j) = turned.imag();
    }
    panel.turn();
    const PanelVector rest = panel.radius.cwiseProduct(panel.turning) - across;
    if (since >= far) {
      matrix.compute(equation(panel));
      since = 0;
    }
    const PanelVector step = matrix.solve(rest);
    if (!step.allFinite()) return false;
    panel.phase -= step;
    if ((panel.phase.array() - panel.start).abs().maxCoeff() > farthest) return false;
    const double way = step.lpNorm<Eigen::Infinity>();
    since += way;
    if (way * since < rounding) return true;
  }
  return false;
}

}  // namespace

double SlipPanel::widest(int highest) { return std::min(1.5, 0.5 * panel_nodes / highest); }

SlipPanel::Reach SlipPanel::Reach::up_to(double part) const {
  if (!apart) return {begin, part * width, apart};
  const double rest = *apart - begin;
  return {begin, -rest * std::expm1(part * std::log1p(-width / rest)), apart};
}

std::optional<SlipPanel> SlipPanel::solved(const CircleMotion& motion, const Reach& reach, double start,
                                           double& wider) {
  constexpr double rounding = 1e-13;  // of the force
  constexpr double least = 0.25;
  constexpr double most = 2.5;
  constexpr double decay = 14;  // of the last coefficients, as powers of the width
  bool converges = false;
  const SlipPanel panel = of(motion, reach, start, converges);
  const double error = std::max(std::abs(panel.bends(panel_nodes)), std::abs(panel.bends(panel_nodes - 1))) *
                       panel.radius.lpNorm<Eigen::Infinity>() / (rounding * motion.size());
  wider = converges ? std::clamp(0.9 * std::pow(error, -1 / decay), least, most) : least;
  const bool is_resolved = converges && error <= 1;
  return is_resolved || reach.width <= smallest ? std::optional(panel) : std::nullopt;
}

SlipPanel SlipPanel::resolved(const CircleMotion& motion, const Reach& reach, double start) {
  bool converges = false;
  return of(motion, reach, start, converges);
}

/// What Newton's method gives or, where it leaves, what keeps the direction.
SlipPanel SlipPanel::of(const CircleMotion& motion, const Reach& reach, double start, bool& converges) {
  SlipPanel panel;
  panel.reach = reach;
  panel.start = start;
  panel.place();
  std::array<CircleMotion::Local, panel_nodes> local;
  for (Index j = 0; j < panel_nodes; ++j) {
    local[static_cast<std::size_t>(j)] = motion.at(panel.angle(j));
    panel.radius(j) = local[static_cast<std::size_t>(j)].radius;
  }
  const CircleMotion::Local first = motion.at(reach.begin);
  const Complex turned = first.rate * std::polar(1.0, -start);
  panel.start_slip = turned.real() - first.radius_rate;
  const double turns = turned.imag() / first.radius;
  const double bends =
      (std::imag(first.bend * std::polar(1.0, -start)) - turns * (turned.real() + first.radius_rate)) /
      first.radius;
  const bool is_slow = std::abs(turns) * reach.width < 1;
  const bool is_smooth = is_slow && std::abs(bends) * reach.width * reach.width < 1;
  panel.phase = start + (panel.angle.array() - reach.begin) *
                            ((is_slow ? turns : 0) +
                             (is_smooth ? 0.5 * bends : 0) * (panel.angle.array() - reach.begin));
  converges = converge(local, panel);
  if (!converges) panel.phase.setConstant(start);
  panel.bends = scheme().coefficients * with_start(0, panel.phase.array() - start);
  panel.turn();
  for (Index j = 0; j < panel_nodes; ++j) {
    const CircleMotion::Local& here = local[static_cast<std::size_t>(j)];
    panel.along(j) = std::real(here.rate * std::polar(1.0, -panel.phase(j)));
    panel.slip(j) = panel.along(j) - here.radius_rate;
  }
  return panel;
}

void SlipPanel::place() {
  const RadauScheme& known = scheme();
  if (reach.apart) {
    const double rest = *reach.apart - reach.begin;
    const double power = std::log1p(-reach.width / rest);
    angle = *reach.apart - rest * (power * known.place.array()).exp();
    pace = -power * (*reach.apart - angle.array());
  } else {
    angle = reach.begin + reach.width * known.place.array();
    pace.setConstant(reach.width);
  }
  weight = pace.cwiseProduct(known.weight);
}

double SlipPanel::phase_at(double theta) const {
  double s = (theta - reach.begin) / reach.width;
  if (reach.apart) {
    const double rest = *reach.apart - reach.begin;
    s = std::log(std::max(*reach.apart - theta, 1e-300) / rest) / std::log1p(-reach.width / rest);
  }
  return start + value_of(bends, 2 * std::clamp(s, 0.0, 1.0) - 1).first;
}

void SlipPanel::turn() {
  turning = (scheme().by_nodes * (phase.array() - start).matrix()).cwiseQuotient(pace);
}

std::optional<double> SlipPanel::stop() const {
  if (start_slip <= 0 && slip(0) <= 0) return 0;
  const PanelCourse course = scheme().coefficients * with_start(start_slip, slip);
  double least = course(0);
  double bend = 0;  // bound of the second derivative
  for (Index k = 1; k <= panel_nodes; ++k) {
    const auto square = static_cast<double>(k * k);
    least -= std::abs(course(k));
    bend += std::abs(course(k)) * square * (square - 1) / 3;
  }
  if (least > 0) return std::nullopt;
  const auto at = [&](double x) { return value_of(course, x); };
  std::optional<double> first;
  isolate_zeros(at, std::max(bend, 1e-300), -1, 2, 4, [&](double x) {
    if (!first && at(x).second < 0) first = 0.5 * (x + 1);  // in s
  });
  if (!first && slip(panel_nodes - 1) < 0) first = 1;
  return first;
}

double SlipPanel::after_stop() const {
  const Index last = panel_nodes - 1;
  const double slope =
      (scheme().by_nodes.row(last).dot(slip) + scheme().by_start(last) * start_slip) / pace(last);
  return slope < 0 ? slip(last) / slope : 0;
}

SlipPanel::Changes::Changes(const SlipPanel& panel)
    : solver_(equation(panel)),
      by_start_(panel.radius.cwiseProduct(scheme().by_start).cwiseQuotient(panel.pace)) {}

void SlipPanel::Changes::solve(const Eigen::Ref<const Eigen::RowVectorXd>& start,
                               Eigen::Ref<Matrix> rows) const {
  rows.noalias() -= by_start_ * start;
  rows = solver_.solve(rows).eval();
}

}  // namespace arcslip
