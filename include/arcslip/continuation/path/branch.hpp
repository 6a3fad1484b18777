#pragma once

// A traced branch: plain data.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "arcslip/continuation/path/checkpoint.hpp"
#include "arcslip/continuation/path/stop.hpp"
#include "arcslip/continuation/points/point_type.hpp"
#include "arcslip/continuation/problem/regime.hpp"

namespace arcslip::continuation {

/// A solution with what is known of the branch there.
struct BranchPoint {
  PointType type = PointType::regular;  ///< what is special about it
  Regime regime;                        ///< at a switch, the regime that the branch enters
  Vector unknowns;                      ///< n
  Vector parameters;                    ///< all of the problem's
  double arclength = 0;                 ///< from the start, in the problem's scale
  int iterations = 0;                   ///< Newton corrections spent on the point
  double residual = 0;                  ///< largest entry of F
  Vector tangent;                       ///< n + 1: d(u, p_a)/d arclength, of the piece that leaves
  Vector arrival;                       ///< the same of the piece that arrives, at a corner; else empty
  ComplexVector eigenvalues;            ///< of an equilibrium; else empty
  int unstable = -1;  ///< how many of them have a positive real part; -1 where there are none
  std::string label;  ///< the name of a user's event

  /// The tangent of the piece that arrives.
  const Vector& arriving() const { return arrival.size() > 0 ? arrival : tangent; }

  /// What it is called: an event by its own name, others by their type.
  std::string_view type_name() const { return label.empty() ? to_string(type) : std::string_view(label); }
};

/// What a trace returns, whether it came to its end or not.
struct [[nodiscard]] Branch {
  std::vector<BranchPoint> points;  ///< in the order traced
  Stop stop = Stop::no_start;       ///< why it ended
  std::string explanation;  ///< the reason of the stop, a sentence; the warning follows, if there is one
  /// What makes special points doubtful although all points solve the problem: a derivative that is not that
  /// of F, of an observable or of a border. Of the last of several branches, also that there are more than
  /// were asked for. Empty if there is nothing.
  std::string warning;
  /// Why the part before the start ended, of a branch traced in both directions.
  std::optional<Stop> first_stop;
  std::string first_explanation;  ///< the reason of it
  Work work;
  /// From where `resume` goes on; empty if there is nothing further.
  std::optional<Checkpoint> checkpoint;

  void warn(const std::string& text) {
    warning += (warning.empty() ? "" : "; ") + text;
    explanation += "; " + text;
  }

  /// Whether the branch was traced to its end: out of the range at either side, back to its start as a closed
  /// loop, or as far as `stop_after` asked.
  bool complete() const { return is_end(stop) && stop != Stop::left_regime && stop != Stop::infinite_period; }
};

}  // namespace arcslip::continuation
