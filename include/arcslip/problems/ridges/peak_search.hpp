#pragma once

// All local peaks of Y over a window of eta while P varies, found on complete frequency responses and
// followed in P.
//
// The stuck response does not depend on P: its peaks are those in stick, and P_border(eta), where R = S on
// it, is the border on which peaks may sit. The response slips where P_border(eta) > P. Peaks in slip are
// curves dY/deta = 0, traced by the engine from peaks of the response at a few preloads and from the points
// where they meet the border.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arcslip/continuation/path/branch.hpp"
#include "arcslip/problems/ridges/peak_piece.hpp"

namespace arcslip::problems {

/// A preload at which everything sticks.
inline constexpr double out_of_reach = 1e200;

/// To be used from one thread.
class PeakSearch {
 public:
  /// Finds the peaks in stick, on the border and on the window's ends. Keeps references.
  PeakSearch(const ForcedResponse& problem, const PreloadRange& range,
             const continuation::TraceOptions& options);

  /// Scans the response at this preload where it slips, and follows those of its peaks that are not known
  /// yet: whether there were any.
  bool look_at(double preload);

  /// Follows the peaks in slip that meet the border or an end of the window and were not found otherwise.
  /// What is left to be found by `look_at` are ridges that are born and die in slip.
  void follow_from_meetings();

  /// All that were followed so far, in no order.
  const std::vector<PeakPiece>& pieces() const { return pieces_; }

  /// What could not be traced, or empty.
  const std::string& failure() const { return failure_; }

 private:
  /// How far, of eta, a ridge is followed beyond the window: where it ends on the border at the window's end,
  /// it may come to it along that end.
  static constexpr double beyond_window = 1e-6;
  /// So near to an end of the window a peak is that end's, and two places are one.
  static constexpr double sharp = 1e-11;
  static constexpr double on_edge = 1e-9;    ///< the same of points that are known to the tolerance
  static constexpr double on_border = 1e-9;  ///< of ln(R/S), see meeting_at

  /// Where a ridge in slip meets the border or an end of the window.
  struct Meeting {
    PeakNode node;
    double inwards;    ///< 0 on the border; at an end of the window the sign of eta's change on the way in
    bool met = false;  ///< whether a curve that was followed ends here
  };

  continuation::TraceOptions over(const std::string& parameter) const;
  void search_border();
  void add_stick_piece(const PeakNode& node);
  void add_corner_piece(const std::vector<PeakNode>& nodes);
  void search_edge(double eta);
  bool falls_inwards(double edge, double preload) const;
  double inwards(double edge) const { return edge == range_.eta_low ? 1 : -1; }
  /// Whether eta lies in the window, or beyond it by no more than `tolerance` of eta.
  bool in_window(double eta, double tolerance) const {
    return eta >= range_.eta_low * (1 - tolerance) && eta <= range_.eta_high * (1 + tolerance);
  }
  bool is_known(const PeakNode& peak) const;  ///< of one in slip
  /// Ranges of eta in the window in which the response slips.
  std::vector<std::pair<double, double>> slipping_at(double preload) const;
  bool follow(const PeakNode& start);
  void add_sections(const continuation::Branch& curve);
  void add_section(std::vector<PeakNode> nodes);
  std::vector<PeakNode> inside_window(const std::vector<PeakNode>& nodes);
  PeakNode leaving(const PeakNode& inside, const PeakNode& outside);
  std::optional<PeakNode> inside(const Meeting& meeting) const;
  /// Where the curve that ends here has met something, or null. A stiff interface bends a ridge back within
  /// R/S - 1 = 1e-9 of the border, where Y is that of the border to as many digits: the two count as met.
  Meeting* meeting_at(const PeakNode& end);
  void snap(PeakNode& end);
  double log_ratio(const PeakNode& node) const;
  void add(PeakSite site, std::vector<PeakNode> nodes);
  void add(PeakPiece piece);
  double shared(double preload);
  void fail(const std::string& why);

  const ForcedResponse& problem_;
  const PreloadRange& range_;
  const continuation::TraceOptions& options_;
  std::vector<double> flanks_;  // of resonances, where scans begin
  std::vector<PeakPiece> pieces_;
  std::vector<Meeting> meetings_;
  std::vector<PeakNode> border_;  // along it over the window, eta rising
  std::vector<double> ends_;      // preloads at which pieces end
  std::string failure_;
};

}  // namespace arcslip::problems
