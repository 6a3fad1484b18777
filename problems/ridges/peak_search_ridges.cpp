#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "arcslip/dense.hpp"
#include "arcslip/problems/ridges/peak_ridge.hpp"
#include "arcslip/problems/ridges/peak_search.hpp"

// Ridges in slip: followed, cut where they turn in P and where they leave the window, and brought together
// with what they meet.

namespace arcslip::problems {

using continuation::Branch;
using continuation::BranchPoint;
using continuation::PointType;

namespace {

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

bool PeakSearch::follow(const PeakNode& start) {
  PeakRidge ridge(problem_.system());
  continuation::TraceOptions options = over("P");
  options.extrema_of.clear();
  for (const double edge : {range_.eta_low, range_.eta_high}) {
    options.events.push_back({"edge", [end = edge * (1 - inwards(edge) * beyond_window)](
                                          const Vector& u, const Vector&, const continuation::Regime&) {
                                return u(PeakRidge::eta) - end;
                              }});
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
  // So near to the border a peak of a response may be one of its last digits.
  if (curve.points.empty() && start.w * start.w <= on_border) return false;
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
    PeakNode solved = node;  // beyond the tolerance, but where the curve turns
    if (solve_ridge(problem_.system(), node.preload, solved.w, solved.eta) &&
        std::abs(solved.w - node.w) + std::abs(solved.eta / node.eta - 1) < on_edge)
      node = solved;
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
  double bend = 0;  // where it is largest it is no rounding
  for (const PeakNode& node : nodes) {
    const double here = ridge_point(problem_.system(), node.w, node.eta, node.preload).bend();
    if (std::abs(here) > std::abs(bend)) bend = here;
  }
  snap(nodes.front());
  snap(nodes.back());
  nodes = inside_window(nodes);
  if (!(bend < 0) || nodes.size() < 2) return;
  const std::pair<double, double> range = std::minmax(nodes.front().preload, nodes.back().preload);
  const auto is_beyond = [&](const PeakNode& node) {
    return !(node.preload > range.first && node.preload < range.second);
  };
  nodes.erase(std::remove_if(nodes.begin() + 1, nodes.end() - 1, is_beyond), nodes.end() - 1);
  add(PeakSite::slip, std::move(nodes));
}

/// A section crosses an end of the window at one of its own ends, if at all, for it was followed no farther.
/// Of what lies along the window's end nothing is in it.
std::vector<PeakNode> PeakSearch::inside_window(const std::vector<PeakNode>& nodes) {
  const auto outside = [&](const PeakNode& node) { return !in_window(node.eta, sharp); };
  const auto first = std::find_if_not(nodes.begin(), nodes.end(), outside);
  const auto last = std::find_if_not(nodes.rbegin(), nodes.rend(), outside).base();
  std::vector<PeakNode> kept(first, std::max(first, last));
  const auto on_the_edge = [&](const PeakNode& node) { return !in_window(node.eta, -sharp); };
  if (std::all_of(kept.begin(), kept.end(), on_the_edge)) return {};
  if (first != nodes.begin()) {
    kept.erase(kept.begin(), std::find_if_not(kept.begin(), kept.end(), on_the_edge));
    kept.insert(kept.begin(), leaving(kept.front(), *(first - 1)));
  }
  if (last != nodes.end()) {
    kept.erase(std::find_if_not(kept.rbegin(), kept.rend(), on_the_edge).base(), kept.end());
    kept.push_back(leaving(kept.back(), *last));
  }
  return kept;
}

/// The ridge at the end of the window between two nodes: where the response at that end has told it, else by
/// Newton's method.
PeakNode PeakSearch::leaving(const PeakNode& inside, const PeakNode& outside) {
  const double edge = outside.eta < range_.eta_low ? range_.eta_low : range_.eta_high;
  PeakNode node = outside;
  node.eta = edge;
  const double share = (edge - inside.eta) / (outside.eta - inside.eta);
  node.preload = inside.preload + share * (outside.preload - inside.preload);
  node.w = inside.w + share * (outside.w - inside.w);
  for (int i = 0; i < 20; ++i) {
    const RidgePoint at = ridge_point(problem_.system(), node.w, edge, node.preload);
    Eigen::Matrix2d by_place;
    by_place << at.by_place.col(0), at.by_preload;
    const Eigen::Vector2d step = solution_of(by_place, at.values);
    node.w -= step(0);
    node.preload -= step(1);
  }
  node.log_R = problem_.system().log_threshold(edge, node.preload).value + node.w * node.w;
  for (Meeting& meeting : meetings_) {
    if (meeting.inwards != 0 && meeting.node.eta == edge &&
        std::abs(meeting.node.preload / node.preload - 1) <= 1e-6) {
      meeting.met = true;
      node.preload = meeting.node.preload;
      node.w = meeting.node.w;
      node.log_R = meeting.node.log_R;
    }
  }
  return node;
}

PeakSearch::Meeting* PeakSearch::meeting_at(const PeakNode& end) {
  Meeting* nearest = nullptr;
  double least = 1e-2;
  for (Meeting& meeting : meetings_) {
    const double apart = std::abs(meeting.node.eta - end.eta) / end.eta;
    const double preload_apart = std::abs(meeting.node.preload - end.preload) / end.preload;
    if (meeting.inwards != 0 || end.w * end.w > on_border || apart > 1e-6 || preload_apart > least) continue;
    least = preload_apart;
    nearest = &meeting;
  }
  return nearest;
}

/// The end of a curve at the border is the place where it was found there itself.
void PeakSearch::snap(PeakNode& end) {
  if (end.preload == range_.from || end.preload == range_.to) return;
  Meeting* meeting = meeting_at(end);
  if (meeting == nullptr) return;
  meeting->met = true;
  end.eta = meeting->node.eta;
  end.preload = meeting->node.preload;
  end.log_R = meeting->node.log_R;
  end.w = meeting->node.w;
}

/// A little way along the ridge from where it meets the border or an end of the window, within the range.
std::optional<PeakNode> PeakSearch::inside(const Meeting& meeting) const {
  const FrictionSystem& system = problem_.system();
  const PeakNode& from = meeting.node;
  const RidgePoint at = ridge_point(system, from.w, from.eta, from.preload);
  const Eigen::Vector3d unit(1, from.eta, from.preload);
  Eigen::Matrix<double, 2, 3> slopes;  // of both residuals over (w, eta, P), in units
  slopes << at.by_place, at.by_preload;
  slopes = slopes * unit.asDiagonal();
  Eigen::Vector3d along = slopes.row(0).cross(slopes.row(1)).transpose().normalized();
  const double inwards = meeting.inwards == 0 ? along(0) : meeting.inwards * along(1);
  if (inwards < 0) along = -along;
  for (double way = 1e-5; way > 1e-6; way *= 0.5) {
    const Eigen::Vector3d step = way * along.cwiseProduct(unit);
    PeakNode node = from;
    node.w += step(0);
    node.eta += step(1);
    node.preload += step(2);
    if (!solve_ridge(system, node.preload, node.w, node.eta)) continue;
    if (node.preload >= range_.from && node.preload <= range_.to) return node;
  }
  return std::nullopt;
}

void PeakSearch::follow_from_meetings() {
  for (std::size_t i = 0; i < meetings_.size(); ++i) {
    const std::optional<PeakNode> start = meetings_[i].met ? std::nullopt : inside(meetings_[i]);
    if (start) follow(*start);
  }
}

}  // namespace arcslip::problems
