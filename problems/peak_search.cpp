#include "arcslip/problems/peak_search.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "arcslip/problems/peak_ridge.hpp"
#include "arcslip/problems/response_slopes.hpp"
#include "arcslip/zero_between.hpp"

namespace arcslip::problems {
namespace {

using continuation::Branch;
using continuation::BranchPoint;
using continuation::PointType;

constexpr double out_of_reach = 1e200;  // a preload at which everything sticks

/// P_border at eta.
PeakNode border_node(const FrictionSystem& system, double eta) {
  const ResponseSlopes at = ResponseSlopes::on_border(system, eta, false);
  return {at.preload(), eta, at.log_R()};
}

/// Whether Y has a maximum on the border at eta: the slopes on its two sides, in the order in which they are
/// passed, are positive and negative.
bool is_corner_peak(const FrictionSystem& system, double eta) {
  const AmplitudeSlopes stuck = ResponseSlopes::on_border(system, eta, false).by_eta();
  const AmplitudeSlopes slipping = ResponseSlopes::on_border(system, eta, true).by_eta();
  const bool enters_slip = stuck.log_ratio > 0;
  const double before = enters_slip ? stuck.log_Y : slipping.log_Y;
  const double after = enters_slip ? slipping.log_Y : stuck.log_Y;
  return before > 0 && after < 0;
}

/// Cuts a stretch of the border at P = limit: the node there.
PeakNode cut(const FrictionSystem& system, const PeakNode& inside, const PeakNode& outside, double limit) {
  const auto away = [&](double eta) { return border_node(system, eta).preload - limit; };
  PeakNode node = border_node(
      system, zero_between(away, inside.eta, outside.eta, away(inside.eta), away(outside.eta), 52));
  node.preload = limit;
  return node;
}

PeakNode ridge_node(const BranchPoint& point) {
  PeakNode node{point.parameters(0), point.unknowns(PeakRidge::eta), 0};
  node.w = point.unknowns(PeakRidge::root_of_log_ratio);
  return node;
}

/// Whether a ridge has all but turned in P, so that no digit of P is left between a peak and a trough.
bool turns(const BranchPoint& point) {
  return std::abs(point.tangent(2)) <= 1e-4 * point.parameters(0) * point.tangent.norm();
}

}  // namespace

PeakSearch::PeakSearch(const ForcedResponse& problem, const PreloadRange& range,
                       const continuation::TraceOptions& options)
    : problem_(problem), range_(range), options_(options) {
  search_border();
  search_edge(range.eta_low);
  search_edge(range.eta_high);
}

void PeakSearch::fail(const std::string& why) {
  if (failure_.empty()) failure_ = why;
}

continuation::TraceOptions PeakSearch::over(const std::string& parameter) const {
  continuation::TraceOptions options = options_;
  options.parameter = parameter;
  options.from = parameter == "P" ? range_.from : range_.eta_low;
  options.to = parameter == "P" ? range_.to : range_.eta_high;
  options.stop_at.clear();
  options.extrema_of = {"Y"};
  return options;
}

void PeakSearch::add(PeakSite site, std::vector<PeakNode> nodes) {
  if (nodes.front().preload > nodes.back().preload) std::reverse(nodes.begin(), nodes.end());
  const auto falls = [](const PeakNode& a, const PeakNode& b) { return !(b.preload > a.preload); };
  nodes.erase(std::unique(nodes.begin(), nodes.end(), falls), nodes.end());
  if (nodes.size() >= 2) pieces_.emplace_back(problem_, site, std::move(nodes));
}

void PeakSearch::search_border() {
  const FrictionSystem& system = problem_.system();
  continuation::TraceOptions options = over("eta");
  const auto slope = [&system](double AmplitudeSlopes::*which, bool slip) {
    return [&system, which, slip](const Vector&, const Vector& p, int) {
      return ResponseSlopes::on_border(system, p(ContactProblem::eta), slip).by_eta().*which;
    };
  };
  options.events = {{"meeting", slope(&AmplitudeSlopes::log_Y, true)},
                    {"turn", slope(&AmplitudeSlopes::log_ratio, false)}};
  const Branch stuck = continuation::trace(problem_, problem_.guess(range_.eta_low, out_of_reach), options);
  if (!stuck.complete()) return fail("the stuck response could not be traced: " + stuck.explanation);

  std::vector<PeakNode> stretch;
  for (const BranchPoint& point : stuck.points) {
    const PeakNode node = border_node(system, point.parameters(ContactProblem::eta));
    stretch.push_back(node);
    if (point.type == PointType::regular || point.type == PointType::start) continue;
    add_corner_piece(stretch);
    stretch = {node};
    const bool inside = node.preload > range_.from && node.preload < range_.to;
    if (point.type == PointType::peak && node.preload < range_.to) {
      PeakNode first = node;
      PeakNode last = node;
      first.preload = std::max(node.preload, range_.from);
      last.preload = range_.to;
      add(PeakSite::stick, {first, last});
    }
    if (inside && point.label == "meeting") meetings_.push_back({node, 0});
  }
}

void PeakSearch::add_corner_piece(const std::vector<PeakNode>& nodes) {
  const std::size_t middle = nodes.size() / 2;
  const double eta = nodes.size() > 2 ? nodes[middle].eta : 0.5 * (nodes.front().eta + nodes.back().eta);
  if (!is_corner_peak(problem_.system(), eta)) return;
  std::vector<PeakNode> kept;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (const double limit : {range_.from, range_.to}) {
      if (i == 0 || !((nodes[i - 1].preload - limit) * (nodes[i].preload - limit) < 0)) continue;
      kept.push_back(cut(problem_.system(), nodes[i - 1], nodes[i], limit));
    }
    if (nodes[i].preload >= range_.from && nodes[i].preload <= range_.to) kept.push_back(nodes[i]);
  }
  if (kept.size() >= 2) add(PeakSite::corner, std::move(kept));
}

/// The end of the window is a local peak of it while Y falls from there into it.
void PeakSearch::search_edge(double eta) {
  const FrictionSystem& system = problem_.system();
  const double inwards = eta == range_.eta_low ? 1 : -1;
  const auto slope_in = [&](const Vector& u, const Vector& p, int regime) {
    return inwards *
           ResponseSlopes(system, eta, p(ContactProblem::preload), u(0), regime == ContactProblem::slip)
               .by_eta()
               .log_Y;
  };
  continuation::TraceOptions options = over("P");
  options.extrema_of.clear();
  options.events = {{"turn", slope_in}};
  const Branch branch = continuation::trace(problem_, problem_.guess(eta, range_.from), options);
  if (!branch.complete())
    return fail(fmt::format("the response at eta = {} could not be traced: {}", eta, branch.explanation));
  std::vector<PeakNode> stretch;
  double sum = 0;  // of the slopes within the stretch
  for (const BranchPoint& point : branch.points) {
    stretch.push_back({point.parameters(ContactProblem::preload), eta, point.unknowns(0)});
    if (point.type == PointType::regular || point.type == PointType::start) {
      sum += slope_in(point.unknowns, point.parameters, point.regime);
      continue;
    }
    if (stretch.size() == 2 || sum == 0) {
      const double middle = std::sqrt(stretch.front().preload * stretch.back().preload);
      const continuation::Guess at = problem_.guess(eta, middle);
      sum += slope_in(at.unknowns, at.parameters, at.regime);
    }
    if (sum < 0 && stretch.size() >= 2) add(PeakSite::edge, stretch);
    if (point.type == PointType::event && point.regime == ContactProblem::slip) {
      PeakNode node = stretch.back();
      node.w = std::sqrt(std::max(0.0, log_ratio(node)));
      meetings_.push_back({node, inwards});
    }
    stretch = {stretch.back()};
    sum = 0;
  }
}

bool PeakSearch::is_known(double eta, double preload, PeakSite site) const {
  constexpr double same = 1e-6;
  return std::any_of(pieces_.begin(), pieces_.end(), [&](const PeakPiece& piece) {
    return piece.site() == site && piece.covers(preload) &&
           std::abs(piece.at(preload).eta - eta) <= same * eta;
  });
}

bool PeakSearch::look_at(double preload) {
  const Branch branch = continuation::trace(problem_, problem_.guess(range_.eta_low, preload), over("eta"));
  if (!branch.complete()) {
    fail(fmt::format("the response at P = {} could not be traced: {}", preload, branch.explanation));
    return false;
  }
  bool found = false;
  for (std::size_t i = 1; i < branch.points.size(); ++i) {
    const BranchPoint& point = branch.points[i];
    if (point.type != PointType::peak) continue;
    const double eta = point.parameters(ContactProblem::eta);
    const BranchPoint& before = branch.points[i - 1];
    const bool corner = before.type == PointType::regime_switch && before.parameters == point.parameters;
    const PeakSite site = corner                                 ? PeakSite::corner
                          : point.regime == ContactProblem::slip ? PeakSite::slip
                                                                 : PeakSite::stick;
    if (is_known(eta, preload, site)) continue;
    if (site == PeakSite::slip) {
      PeakNode start{preload, eta, point.unknowns(0)};
      start.w = std::sqrt(std::max(0.0, log_ratio(start)));
      found = follow(start) || found;
    } else {
      fail(fmt::format("the stuck response lacks the peak at eta = {:.10g}, P = {:.10g}", eta, preload));
    }
  }
  return found;
}

bool PeakSearch::follow(const PeakNode& start) {
  PeakRidge ridge(problem_.system());
  continuation::TraceOptions options = over("P");
  options.extrema_of.clear();
  for (const double edge : {range_.eta_low, range_.eta_high}) {
    options.events.push_back(
        {"edge", [edge](const Vector& u, const Vector&, int) { return u(PeakRidge::eta) - edge; }});
  }
  options.stop_after = {{PointType::event, 1, "edge"}};
  continuation::Guess guess{Vector(2), Vector::Constant(1, start.preload), 0};
  guess.unknowns << start.w, start.eta;
  ridge.adapt(guess.unknowns, guess.parameters);
  const auto follow_with_unit = [&](const BranchPoint& point) {
    ridge.adapt(point.unknowns, point.parameters);
    return true;
  };
  const Branch curve = continuation::trace_both(ridge, guess, options, follow_with_unit);
  const auto is_lost = [&](continuation::Stop stop, const BranchPoint& end) {
    return !is_end(stop) && !turns(end) && meeting_at(ridge_node(end)) == nullptr;
  };
  if (curve.points.empty() || is_lost(curve.stop, curve.points.back()) ||
      (curve.first_stop && is_lost(*curve.first_stop, curve.points.front()))) {
    fail(fmt::format("the peak at eta = {:.10g}, P = {:.10g} could not be followed: {}", start.eta,
                     start.preload,
                     is_end(curve.stop) ? std::string(to_string(*curve.first_stop)) : curve.explanation));
  }
  if (curve.points.size() < 2) return false;
  add_sections(curve);
  return true;
}

/// Splits a curve where it turns in P: peaks and troughs take turns.
void PeakSearch::add_sections(const Branch& curve) {
  std::vector<PeakNode> nodes;
  for (const BranchPoint& point : curve.points) {
    PeakNode node = ridge_node(point);
    node.log_R = problem_.system().log_threshold(node.eta, node.preload).value + node.w * node.w;
    node.arclength = point.arclength;
    node.d_w = point.tangent(PeakRidge::root_of_log_ratio);
    node.d_eta = point.tangent(PeakRidge::eta);
    node.d_preload = point.tangent(2);
    nodes.push_back(node);
    if (point.type != PointType::fold) continue;
    add_section(std::move(nodes));
    nodes = {node};
  }
  add_section(std::move(nodes));
}

void PeakSearch::add_section(std::vector<PeakNode> nodes) {
  if (nodes.size() < 2) return;
  const PeakNode& middle = nodes[nodes.size() / 2];
  const bool peak = ridge_point(problem_.system(), middle.w, middle.eta, middle.preload).is_peak();
  snap(nodes.front());
  snap(nodes.back());
  if (!peak) return;
  const std::pair<double, double> range = std::minmax(nodes.front().preload, nodes.back().preload);
  const auto is_beyond = [&](const PeakNode& node) {
    return !(node.preload > range.first && node.preload < range.second);
  };
  nodes.erase(std::remove_if(nodes.begin() + 1, nodes.end() - 1, is_beyond), nodes.end() - 1);
  add(PeakSite::slip, std::move(nodes));
}

PeakSearch::Meeting* PeakSearch::meeting_at(const PeakNode& end) {
  const auto met = std::find_if(meetings_.begin(), meetings_.end(), [&](const Meeting& meeting) {
    const double apart = std::abs(meeting.node.eta - end.eta) / end.eta;
    const double preload_apart = std::abs(meeting.node.preload - end.preload) / end.preload;
    return meeting.inwards == 0 ? end.w * end.w <= 1e-9 && apart <= 1e-6 && preload_apart <= 1e-2
                                : apart <= 1e-9 && preload_apart <= 1e-6;
  });
  return met == meetings_.end() ? nullptr : &*met;
}

/// The end of a curve at the border or at an end of the window is the place where it was found there itself.
void PeakSearch::snap(PeakNode& end) {
  Meeting* meeting = meeting_at(end);
  if (meeting == nullptr) return;
  meeting->met = true;
  end.eta = meeting->node.eta;
  end.preload = meeting->node.preload;
  end.log_R = meeting->node.log_R;
  end.w = meeting->node.w;
}

double PeakSearch::log_ratio(const PeakNode& node) const {
  return node.log_R - problem_.system().log_threshold(node.eta, node.preload).value;
}

/// A little way along the ridge from where it meets the border or an end of the window.
PeakNode PeakSearch::inside(const Meeting& meeting) const {
  constexpr double way = 1e-5;
  PeakNode node = meeting.node;
  const FrictionSystem& system = problem_.system();
  const RidgePoint at = ridge_point(system, node.w, node.eta, node.preload);
  const Eigen::Vector3d unit(1, node.eta, node.preload);
  Eigen::Matrix<double, 2, 3> slopes;  // of both residuals over (w, eta, P), in units
  slopes << at.by_place, at.by_preload;
  slopes = slopes * unit.asDiagonal();
  Eigen::Vector3d along = slopes.row(0).cross(slopes.row(1)).transpose().normalized();
  const double inwards = meeting.inwards == 0 ? along(0) : meeting.inwards * along(1);
  if (inwards < 0) along = -along;
  along = way * along.cwiseProduct(unit);
  node.w += along(0);
  node.eta += along(1);
  node.preload += along(2);
  solve_ridge(system, node.preload, node.w, node.eta);
  return node;
}

void PeakSearch::follow_from_meetings() {
  for (const Meeting& meeting : meetings_) {
    if (!meeting.met) follow(inside(meeting));
  }
}

}  // namespace arcslip::problems
