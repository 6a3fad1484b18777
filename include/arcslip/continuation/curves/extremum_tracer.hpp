#pragma once

// The state of a curve of extrema that is followed across borders, one way; see extremum_curve.hpp. Its
// pieces are traced within a regime or along a border; between them stand the places where they meet.

#include <limits>
#include <string>
#include <vector>

#include "arcslip/continuation/curves/corner_slopes.hpp"
#include "arcslip/continuation/curves/half_curve.hpp"
#include "arcslip/continuation/curves/response_extremum.hpp"
#include "arcslip/continuation/points/border_problem.hpp"

namespace arcslip::continuation {

/// A place on a border to which a curve comes.
struct ExtremumPlace {
  BasePoint at;                     ///< in the regime from which it comes
  std::optional<Regime> vanishing;  ///< the regime in which the slope vanishes there
  Vector arrival;                   ///< of the curve, as BranchPoint::tangent; empty where it starts there
  std::optional<bool> peak;         ///< whether it comes along a border, and as a peak
};

/// A piece of the curve that leaves a place along a border as a corner.
struct ExtremumLedge {
  BasePoint from;    ///< in the regime of which `border` is one
  int border;        ///< along which it runs
  Vector direction;  ///< as BranchPoint::tangent
  BasePoint beside;  ///< a little way on
  bool peak;         ///< or a trough
};

/// Of one half of a curve.
class ExtremumTracer {
 public:
  /// `problem` is one of extrema; it, `options` and `observer` must outlive this. Throws
  /// std::invalid_argument where the problem has no parameter of the name in the options.
  ExtremumTracer(ExtendedProblem& problem, const TraceOptions& options, const CurveWindow& window,
                 const Observer& observer)
      : problem_(problem),
        base_(problem.base()),
        options_(within_window(options, window, base_.size())),
        window_(window),
        observer_(observer),
        parameter_(index_of(problem.parameter_names(), options.parameter)),
        slopes_(base_, problem.active(), *problem.extremum_of()) {}

  /// From a start that was located, a corner on a border if it is one.
  Branch half(const BasePoint& start, bool corner, bool towards_to);

 private:
  using Side = CornerSlopes::Side;
  using Place = ExtremumPlace;
  using Ledge = ExtremumLedge;
  static constexpr double near = 1e-6;    // a border, in the scale: here a curve of smooth extrema is left
  static constexpr double narrow = 1e-5;  // the same: what turns within this is not traced
  static constexpr double within_reach =
      1e-2;  // the same: nearer than this one that cannot go on may come to one
  static constexpr double shortest_way = 1e-9;  // in the scale, from a place along a border or into a regime,
  static constexpr double longest_way =
      1e-3;  // and as far as this one goes for a slope that is surely not rounding
  inline static const std::string before_vanishes = "the slope before it vanishes";
  inline static const std::string behind_vanishes = "the slope behind it vanishes";

  enum class Mode { smooth, ledge };

  bool walk_from(const BasePoint& start, bool towards_to);
  bool go_on();
  bool leave(const Place& place);
  std::optional<Side> smooth_side(const Place& place);
  bool enter(Side side);
  std::optional<BasePoint> first_inside(const BasePoint& corner, Side side, double inside, double least);
  bool ends_at_border();
  bool pass(const BasePoint& corner, Side side);
  std::optional<BasePoint> straight_on(const BasePoint& corner, Side side);
  std::optional<BasePoint> fold_beside(const BasePoint& corner, int border, Side side);
  bool past_turn();
  void add_turn(BranchPoint fold);
  bool add_fold(const BasePoint& corner, int border, Side side);
  BasePoint settled(const BasePoint& point, int border) const;
  static BasePoint settled(BorderProblem& edge, const BasePoint& point);
  BasePoint at_value(const BasePoint& next, int border, double value) const;
  BasePoint refined(const BasePoint& point, int border, Side side);
  double distance(const BasePoint& point) const;
  double rounding_of(double left) const;
  double observable_rate(const BranchPoint& at, const Vector& direction) const;
  std::optional<Place> meeting();
  std::optional<Place> meeting_beside(const BranchPoint& last, const NearestBorder& nearest);
  bool turns_between(const BasePoint& point, const NearestBorder& nearest, const BasePoint& beside,
                     const BasePoint& place);
  std::vector<Ledge> ledges(const Place& place);
  void add_ledges(const BasePoint& at, int border, const Place& place, std::vector<Ledge>& all);
  std::vector<BranchPoint> step_off(BorderProblem& edge, const BasePoint& from, bool up, double way) const;
  std::vector<BranchPoint> surely_off(BorderProblem& edge, const BasePoint& from, bool up,
                                      const std::optional<Regime>& vanishing);
  struct Inside {
    double slope;
    double way;
  };
  Inside next_inside(const BasePoint& corner, Side side);
  bool fill(int border, const BasePoint& corner, double from, double to, Side side);

  Branch piece(ExtendedProblem& problem, const Guess& from, bool towards_to, const TraceOptions& options,
               const Observer& sees);
  void smooth(const Guess& guess, bool towards_to, std::size_t skipped);
  void along(const Ledge& ledge, const std::optional<Regime>& vanishing);
  void append(Branch piece, std::size_t skipped);
  void add(BranchPoint point);
  void turn(Vector tangent, const Regime& regime);
  void stop(Stop reason, std::string explanation);
  /// How an extremum is followed from response to response.
  struct Walk {
    BasePoint here;
    bool peak = false;
    double sense = 1;  // in which the parameter changes
    double step = 0;   // of it, in its scale
    Vector rate;       // of the unknowns over it
    bool predicts = false;
    int walked = 0;
    int flips = 0;                                             // since the last row
    bool widens = false;                                       // the steps that it tries from a turn
    double turned = std::numeric_limits<double>::quiet_NaN();  // the parameter where it last went back
  };
  bool walk();
  bool is_smooth(const Walk& walk, double scale);
  void stride(Walk& walk, const ResponseExtremum::Found& next, double to);
  double reach_at(const Walk& walk, double to, double scale) const;
  bool fold_back(Walk& walk, ResponseExtremum& extrema);
  std::optional<bool> is_peak(const BranchPoint& row, ResponseExtremum& extrema) const;
  std::optional<bool> were_peaks(ResponseExtremum& extrema) const;
  std::optional<BasePoint> begin_walk(ResponseExtremum& extrema, bool& peak);
  bool smoothly_on(const Walk& walk, ResponseExtremum& extrema);
  bool has_turned_here() const;
  void tell_turns_once();
  double way_so_far(double scale) const;
  double next_value(double from, double to) const;
  bool is_asked_for(double value) const;
  bool finish(double value);
  bool came_back();
  bool stalls();
  bool is_satisfied();

  TraceOptions rest() const;
  TraceOptions freely(double way) const;
  Guess guess_at(const BasePoint& point, const Vector& direction = {}) const;
  BasePoint split(const BranchPoint& point) const {
    return problem_.split(point.unknowns, point.parameters, point.regime);
  }
  BranchPoint row(const BasePoint& at, PointType type);
  Vector steps(const Vector& difference, const BranchPoint& at) const;
  Vector way(const BranchPoint& from, const BranchPoint& to) const;
  Vector direction_to(const BranchPoint& point) const;
  double parameter_scale(const BranchPoint& at) const;
  std::string place() const;
  double value(const BasePoint& point) const { return guess_at(point).parameters(parameter_); }

  ExtendedProblem& problem_;
  const Problem& base_;
  TraceOptions options_;
  CurveWindow window_;
  const Observer& observer_;
  Index parameter_;
  CornerSlopes slopes_;
  TimeBudget time_{options_};
  Branch curve_;
  Mode mode_ = Mode::smooth;
  int border_ = 0;        // of a ledge
  bool peak_ = false;     // the same: whether it is one of peaks
  std::size_t seen_ = 0;  // rows in which the start was looked for
  bool near_ = false;     // whether the last piece was left before a border
  bool passes_ = false;   // whether it is so near to a border that it does not meet
  bool turns_ = false;    // whether the last row is where the last piece turned again and again
  int patience_ = 3;      // steps from response to response before a smooth piece is tried again
  bool told_to_end_ = false;
  std::optional<BranchPoint> stood_;  // the last row when a piece was to be added before
  int stalled_ = 0;                   // how often in a row there was none since
};

}  // namespace arcslip::continuation
