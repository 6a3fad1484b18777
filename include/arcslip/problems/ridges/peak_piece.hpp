#pragma once

// One local peak of Y over eta, followed in P for as long as it stays at one kind of site. It is known at
// nodes, and solved for at any preload between them:
//
//   slip    dY/deta = 0, with R from the response equation
//   stick   Y, R and eta do not depend on P
//   corner  R = S at eta with P_border(eta) = P
//   edge    R from the response equation at the window's end

#include <cmath>
#include <vector>

#include "arcslip/problems/response/forced_response.hpp"
#include "arcslip/problems/ridges/preload_study.hpp"

namespace arcslip::problems {

/// A point that a peak was followed through.
struct PeakNode {
  double preload;    ///< P
  double eta;        ///< of the peak
  double log_R;      ///< ln R
  double log_Y = 0;  ///< ln Y
  double slope = 0;  ///< d ln Y/d ln P along the peak

  /// Of a peak in slip: w of the ridge, where it lies on the curve it was traced as, and d/d arclength.
  double w = 0;
  double arclength = 0;
  double d_eta = 0;
  double d_preload = 0;
  double d_w = 0;
};

/// Of P: ends of curves that are as near to each other are one, for R/S and eta are known to 1e-10 each.
inline constexpr double same_preload = 1e-9;

/// One peak from its birth, or a change of its site, to the next such event.
class PeakPiece {
 public:
  /// Nodes with P rising, two at least; log_Y and slope are filled in. The problem is kept by reference.
  PeakPiece(const ForcedResponse& problem, PeakSite site, std::vector<PeakNode> nodes);

  /// Where it sits, the preloads between which it does so, and what it was followed through.
  PeakSite site() const { return site_; }
  double from() const { return nodes_.front().preload; }
  double to() const { return nodes_.back().preload; }
  bool covers(double preload) const { return preload >= from() && preload <= to(); }
  const std::vector<PeakNode>& nodes() const { return nodes_; }

  /// The peak at a preload that is covered, solved for. Throws std::runtime_error where that fails.
  Peak at(double preload) const;

  /// Whether this is the peak at that place.
  bool holds(PeakSite site, double eta, double preload) const {
    return site == site_ && covers(preload) && std::abs(at(preload).eta - eta) <= 1e-6 * eta;
  }

  /// ln Y there by interpolation between the nodes, and d ln Y/d ln P.
  ValueAndSlope estimate(double preload) const;

 private:
  std::size_t interval(double preload) const;
  double slip_eta(double preload, double& w) const;
  double corner_eta(double preload) const;
  Peak peak(double eta, double preload, double log_R, double w) const;

  const ForcedResponse* problem_;
  PeakSite site_;
  std::vector<PeakNode> nodes_;
};

}  // namespace arcslip::problems
