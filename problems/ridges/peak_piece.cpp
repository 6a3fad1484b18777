#include "arcslip/problems/ridges/peak_piece.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "arcslip/problems/ridges/peak_ridge.hpp"
#include "arcslip/problems/ridges/response_slopes.hpp"
#include "arcslip/zero_between.hpp"

namespace arcslip::problems {
namespace {

/// The cubic with these values and slopes at the ends of an interval of length h, at x in [0, 1].
double hermite(double x, double h, double from, double slope_from, double to, double slope_to) {
  const double y = 1 - x;
  return from * y * y * (1 + 2 * x) + to * x * x * (1 + 2 * y) + h * x * y * (y * slope_from - x * slope_to);
}

double hermite_slope(double x, double h, double from, double slope_from, double to, double slope_to) {
  const double y = 1 - x;
  return 6 * x * y * (to - from) / h + slope_from * y * (1 - 3 * x) + slope_to * x * (1 - 3 * y);
}

}  // namespace

PeakPiece::PeakPiece(const ForcedResponse& problem, PeakSite site, std::vector<PeakNode> nodes)
    : problem_(&problem), site_(site), nodes_(std::move(nodes)) {
  for (PeakNode& node : nodes_) {
    const Peak found = peak(node.eta, node.preload, node.log_R, node.w);
    node.log_Y = std::log(found.Y);
    node.slope = found.sensitivity.preload;
  }
}

std::size_t PeakPiece::interval(double preload) const {
  const auto beyond = std::upper_bound(nodes_.begin() + 1, nodes_.end() - 1, preload,
                                       [](double P, const PeakNode& node) { return P < node.preload; });
  return static_cast<std::size_t>(beyond - nodes_.begin()) - 1;
}

Peak PeakPiece::peak(double eta, double preload, double log_R, double w) const {
  const double log_ratio =
      site_ == PeakSite::slip ? w * w : log_R - problem_->system().log_threshold(eta, preload).value;
  const bool slips = site_ == PeakSite::slip || (site_ == PeakSite::edge && log_ratio > 0);
  const ResponseSlopes response(problem_->system(), eta, preload, log_R, slips);
  Peak found;
  found.site = site_;
  found.preload = preload;
  found.eta = eta;
  found.Y = std::exp(response.log_Y());
  found.R_over_S = site_ == PeakSite::corner ? 1 : std::exp(log_ratio);
  found.dissipated = slips ? dissipated_energy(log_ratio) : 0;
  found.sensitivity = site_ == PeakSite::corner ? response.corner_sensitivity() : response.sensitivity();
  return found;
}

ValueAndSlope PeakPiece::estimate(double preload) const {
  const std::size_t i = interval(preload);
  const PeakNode& a = nodes_[i];
  const PeakNode& b = nodes_[i + 1];
  const double h = std::log(b.preload / a.preload);
  if (!(h > 0)) return {a.log_Y, a.slope};
  const double x = std::log(preload / a.preload) / h;
  return {hermite(x, h, a.log_Y, a.slope, b.log_Y, b.slope),
          hermite_slope(x, h, a.log_Y, a.slope, b.log_Y, b.slope)};
}

Peak PeakPiece::at(double preload) const {
  const PeakNode& node = nodes_[interval(preload)];
  const FrictionSystem& system = problem_->system();
  double eta = node.eta;
  double log_R = node.log_R;
  double w = node.w;
  if (site_ == PeakSite::slip) {
    eta = slip_eta(preload, w);
    log_R = system.log_threshold(eta, preload).value + w * w;
  } else if (site_ == PeakSite::corner) {
    eta = corner_eta(preload);
    log_R = system.log_threshold(eta, preload).value;
  } else if (site_ == PeakSite::edge) {
    log_R = problem_->guess(eta, preload).unknowns(0);
  }
  return peak(eta, preload, log_R, w);
}

double PeakPiece::corner_eta(double preload) const {
  const std::size_t i = interval(preload);
  const auto away = [&](double eta) {
    return std::log(ResponseSlopes::on_border(problem_->system(), eta).preload() / preload);
  };
  const double a = nodes_[i].eta;
  const double b = nodes_[i + 1].eta;
  return zero_between(away, a, b, away(a), away(b), 52);
}

/// Starts from the cubic through the neighbouring nodes, in the arclength of the curve.
double PeakPiece::slip_eta(double preload, double& w) const {
  const std::size_t i = interval(preload);
  const PeakNode& a = nodes_[i];
  const PeakNode& b = nodes_[i + 1];
  const auto take = [&w](const PeakNode& node) {
    w = node.w;
    return node.eta;
  };
  if (preload == a.preload || preload == b.preload) return take(preload == a.preload ? a : b);
  const double h = b.arclength - a.arclength;  // negative where the curve was traced towards small P
  const auto away = [&](double x) {
    return hermite(x, h, a.preload, a.d_preload, b.preload, b.d_preload) - preload;
  };
  const double x = zero_between(away, 0, 1, a.preload - preload, b.preload - preload, 52);
  w = hermite(x, h, a.w, a.d_w, b.w, b.d_w);
  double eta = hermite(x, h, a.eta, a.d_eta, b.eta, b.d_eta);
  // Where eta turns between the nodes their distance says nothing.
  const double course = std::abs(h) * (std::abs(a.d_eta) + std::abs(b.d_eta));
  const double reach = 2 * std::abs(b.eta - a.eta) + course + 1e-9 * eta;
  const double estimate = eta;
  if (!solve_ridge(problem_->system(), preload, w, eta) || std::abs(eta - estimate) > reach) {
    // Next to a turn in P rounding decides whether there is a solution at all.
    for (const PeakNode* node : {&a, &b}) {
      if (std::abs(preload / node->preload - 1) <= same_preload) return take(*node);
    }
    throw std::runtime_error(
        fmt::format("the peak near eta = {:.10g} was lost at P = {:.10g}", estimate, preload));
  }
  return eta;
}

}  // namespace arcslip::problems
