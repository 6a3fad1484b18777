#include "arcslip/problems/ridges/peak_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "arcslip/problems/ridges/border_scan.hpp"
#include "arcslip/problems/ridges/peak_ridge.hpp"
#include "arcslip/problems/ridges/response_slopes.hpp"
#include "arcslip/problems/ridges/slope_scan.hpp"
#include "arcslip/zero_between.hpp"

namespace arcslip::problems {
namespace {

using continuation::Branch;
using continuation::BranchPoint;
using continuation::PointType;

/// P_border at eta.
PeakNode border_node(const FrictionSystem& system, double eta) {
  const ResponseSlopes at = ResponseSlopes::on_border(system, eta);
  return {at.preload(), eta, at.log_R()};
}

/// Whether Y has a maximum on the border at eta: the slopes on its two sides, in the order in which they are
/// passed, are positive and negative.
bool is_corner_peak(const FrictionSystem& system, double eta) {
  const ResponseSlopes border = ResponseSlopes::on_border(system, eta);
  const AmplitudeSlopes stuck = border.by_eta();
  const AmplitudeSlopes slipping = border.slipping().by_eta();
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

/// Beside each place where one of the structures or both together may resonate, at half the width that the
/// damping of either gives a resonance: at the place itself the slope may tell nothing.
std::vector<double> resonance_flanks(const ForcedResponse& problem, double low, double high) {
  const FrictionSystem& system = problem.system();
  std::vector<double> places;
  for (const double eta : problem.landmarks(ContactProblem::eta, low, high)) {
    for (const Loss& loss : {system.base.loss(), system.damper.loss()}) {
      const double half = 0.5 * loss.part(eta, eta) / eta;
      places.insert(places.end(), {eta - half, eta + half});
    }
  }
  return places;
}

}  // namespace

PeakSearch::PeakSearch(const ForcedResponse& problem, const PreloadRange& range,
                       const continuation::TraceOptions& options)
    : problem_(problem),
      range_(range),
      options_(options),
      flanks_(resonance_flanks(problem, range.eta_low, range.eta_high)),
      ends_({range.from, range.to}) {
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

/// Where pieces end together they do so at the same preload, to the last bit.
double PeakSearch::shared(double preload) {
  const auto known = std::find_if(ends_.begin(), ends_.end(),
                                  [&](double end) { return std::abs(end / preload - 1) <= same_preload; });
  if (known != ends_.end()) return *known;
  ends_.push_back(preload);
  return preload;
}

void PeakSearch::add(PeakSite site, std::vector<PeakNode> nodes) {
  if (nodes.front().preload > nodes.back().preload) std::reverse(nodes.begin(), nodes.end());
  nodes.front().preload = shared(nodes.front().preload);
  nodes.back().preload = shared(nodes.back().preload);
  std::erase_if(nodes, [front = nodes.front().preload, back = nodes.back().preload](const PeakNode& node) {
    return node.preload < front || node.preload > back;
  });
  const auto falls = [](const PeakNode& a, const PeakNode& b) { return !(b.preload > a.preload); };
  nodes.erase(std::unique(nodes.begin(), nodes.end(), falls), nodes.end());
  if (nodes.size() >= 2) add(PeakPiece(problem_, site, std::move(nodes)));
}

/// A curve may have been reached from two of its places, and run along an end of the window but for rounding.
void PeakSearch::add(PeakPiece piece) {
  const auto is_in = [](const PeakPiece& whole, const PeakPiece& part, double tolerance) {
    const PeakNode& middle = part.nodes()[part.nodes().size() / 2];
    return whole.covers(middle.preload) &&
           std::abs(whole.at(middle.preload).eta / middle.eta - 1) <= tolerance;
  };
  if (piece.site() == PeakSite::slip) {
    std::erase_if(pieces_, [&](const PeakPiece& other) {
      return other.site() == PeakSite::edge && is_in(piece, other, on_edge);
    });
    if (std::any_of(pieces_.begin(), pieces_.end(), [&](const PeakPiece& other) {
          return other.site() == PeakSite::slip && is_in(other, piece, 1e-6);
        }))
      return;
  }
  pieces_.push_back(std::move(piece));
}

void PeakSearch::search_border() {
  const double low = range_.eta_low * (1 - beyond_window);
  const double high = range_.eta_high * (1 + beyond_window);
  const std::vector<double> etas = between(flanks_, low, high);
  std::vector<PeakNode> stretch;
  for (const BorderPlace& place : scan_border(problem_.system(), etas, {range_.eta_low, range_.eta_high})) {
    if (!in_window(place.eta, sharp)) continue;
    const PeakNode node = border_node(problem_.system(), place.eta);
    if (in_window(place.eta, 0)) border_.push_back(node);
    stretch.push_back(node);
    if (!place.is_mark) continue;
    add_corner_piece(stretch);
    stretch = {node};
    if (place.is_peak && in_window(place.eta, -sharp)) add_stick_piece(node);
    if (place.is_meeting && node.preload > range_.from && node.preload < range_.to)
      meetings_.push_back({node, 0});
  }
}

void PeakSearch::add_stick_piece(const PeakNode& node) {
  if (!(node.preload < range_.to)) return;
  PeakNode first = node;
  PeakNode last = node;
  first.preload = std::max(node.preload, range_.from);
  last.preload = range_.to;
  add(PeakSite::stick, {first, last});
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

/// Whether Y falls from the end of the window into it: just inside, so that a peak on that very place counts.
bool PeakSearch::falls_inwards(double edge, double preload) const {
  const double eta = edge * (1 + inwards(edge) * sharp);
  const continuation::Guess at = problem_.guess(eta, preload);
  const bool slips = at.regime == ContactProblem::slip;
  const ResponseSlopes slopes(problem_.system(), eta, preload, at.unknowns(0), slips);
  return inwards(edge) * slopes.by_eta().log_Y < 0;
}

/// The end of the window is a local peak of it while Y falls from there into it.
void PeakSearch::search_edge(double eta) {
  const auto slope = [&](const Vector& u, const Vector& p, const continuation::Regime& regime) {
    return ResponseSlopes(problem_.system(), eta, p(ContactProblem::preload), u(0),
                          regime == ContactProblem::slip)
        .by_eta()
        .log_Y;
  };
  continuation::TraceOptions options = over("P");
  options.extrema_of.clear();
  options.events = {{"turn", slope}};
  const Branch branch = continuation::trace(problem_, problem_.guess(eta, range_.from), options);
  if (!branch.complete())
    return fail(fmt::format("the response at eta = {} could not be traced: {}", eta, branch.explanation));
  std::vector<PeakNode> stretch;
  for (const BranchPoint& point : branch.points) {
    stretch.push_back({point.parameters(ContactProblem::preload), eta, point.unknowns(0)});
    if (point.type == PointType::regime_switch) stretch.back() = border_node(problem_.system(), eta);
    if (point.type == PointType::regular || point.type == PointType::start) continue;
    if (stretch.size() >= 2 &&
        falls_inwards(eta, std::sqrt(stretch.front().preload * stretch.back().preload)))
      add(PeakSite::edge, stretch);
    if (point.type == PointType::event && point.regime == ContactProblem::slip) {
      PeakNode node = stretch.back();
      node.w = std::sqrt(std::max(0.0, log_ratio(node)));
      meetings_.push_back({node, inwards(eta)});
    }
    stretch = {stretch.back()};
  }
}

/// On the border what is slip, stick or the corner between them is decided by rounding, and on an end of the
/// window whether the peak is that end.
bool PeakSearch::is_known(const PeakNode& peak) const {
  const bool any_site = !in_window(peak.eta, -sharp) || std::abs(log_ratio(peak)) <= on_border;
  return std::any_of(pieces_.begin(), pieces_.end(), [&](const PeakPiece& piece) {
    const double covered = std::clamp(peak.preload, piece.from(), piece.to());
    return piece.holds(PeakSite::slip, peak.eta, peak.preload) ||
           (any_site && std::abs(covered / peak.preload - 1) <= on_border &&
            piece.holds(piece.site(), peak.eta, covered));
  });
}

/// P_border(eta) is monotonic from each place of the border to the next.
std::vector<std::pair<double, double>> PeakSearch::slipping_at(double preload) const {
  std::vector<std::pair<double, double>> ranges;
  bool slips = false;
  for (std::size_t i = 0; i < border_.size(); ++i) {
    if ((border_[i].preload > preload) == slips) continue;
    const double eta =
        i == 0 ? border_[i].eta : cut(problem_.system(), border_[i - 1], border_[i], preload).eta;
    if (!slips) ranges.emplace_back(eta, border_.back().eta);
    if (slips) ranges.back().second = eta;
    slips = !slips;
  }
  return ranges;
}

bool PeakSearch::look_at(double preload) {
  bool found = false;
  struct Place {
    double eta;
    double log_ratio;
    double slope;
  } last{};  // where the response was looked at last
  const auto response_at = [&](double eta) {
    const double course = std::clamp(last.slope * (eta - last.eta), -1.0, 1.0);
    const double near = std::max(0.0, last.log_ratio + course);
    return ResponseSlopes::in_slip(problem_.system(), eta, preload, near);
  };
  const auto logs_at = [&](double eta) {
    const ResponseSlopes at = response_at(eta);
    const AmplitudeSlopes slopes = at.by_eta();
    last = {eta, at.log_ratio(), slopes.log_ratio};
    return std::array<ValueAndSlope, 2>{{{at.log_Y(), slopes.log_Y}, {at.log_ratio(), slopes.log_ratio}}};
  };
  for (const auto& [low, high] : slipping_at(preload)) {
    const SlopeScan<2, decltype(logs_at)> scan(between(flanks_, low, high), logs_at);
    for (std::size_t i = 0; i < scan.samples().size(); ++i) {
      const auto zero = scan.zero_behind(i, 0);
      if (!zero || !zero->falls) continue;
      const ResponseSlopes at = response_at(zero->eta);
      PeakNode node{preload, zero->eta, at.log_R()};
      node.w = std::sqrt(std::max(0.0, at.log_ratio()));
      found = (!is_known(node) && follow(node)) || found;
    }
  }
  return found;
}

double PeakSearch::log_ratio(const PeakNode& node) const {
  return node.log_R - problem_.system().log_threshold(node.eta, node.preload).value;
}

}  // namespace arcslip::problems
