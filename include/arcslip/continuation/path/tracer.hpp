#pragma once

// The loop that traces a branch: steps, events, targets, limits.

#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "arcslip/continuation/events/events.hpp"
#include "arcslip/continuation/path/targets.hpp"
#include "arcslip/continuation/path/trace.hpp"

namespace arcslip::continuation {

/// Half a sentence that says why a correction ended.
std::string_view reason(Correction correction);

/// Traces one way; serves one branch. Keeps references to its arguments.
class Tracer {
 public:
  /// Throws std::invalid_argument for options that do not fit the problem.
  Tracer(const Problem& problem, const TraceOptions& options, const Observer& observer);

  /// `forward` is the wanted sign of the parameter's change.
  Branch run(const Guess& guess, double forward);

  /// Throws std::invalid_argument that names what differs from the branch that is to be gone on with.
  void require_same(const BranchIdentity& then) const;

  /// Goes on from where another tracer was, of the same problem with the same options.
  Branch run(const Progress& progress);

  /// The whole of a branch that was interrupted.
  Branch go_on_with(Branch begun);

 private:
  template <class Begin>
  Branch finished(const Begin& begin);
  void go_on();
  void start(const Guess& guess, double forward);
  Vector raw_tangent() const;
  void look_at_derivatives(const Vector& u, const Vector& p, const Regime& regime);
  bool is_time_to_look(PointType type);
  BranchIdentity identity() const;
  void require_same(const Progress& progress) const;
  Correction start_singular(const Guess& guess, double forward, bool is_found);
  bool start_from_afar(const Guess& guess, double forward);
  void set_signs_of_zeros(bool is_ahead, bool is_only);
  void count_unstable_before(const CurvePoint& ahead, bool tells);
  bool out_of_time() const;
  void watch_clock() const;
  void halt(Stop reason);
  void forget_tries();
  void check_limits();
  void step();
  bool try_step();
  double longest_step() const;
  void take_where_it_starts(bool is_special);
  bool try_landing();
  const Target* next_target(double reach, double direction) const;
  bool only_approaches(const Target& target) const;
  bool comes_by_halves(const Target& target) const;
  void halve_way_to(const Target& target);
  void rest_before(const Target& target);
  double to_even_value(double distance, double rate) const;
  bool find_events();
  bool is_told_before(double s) const;
  bool leaves_range() const;
  void take();
  void take_events(const Signs& before);
  void stop_in_place();
  void stop_stepping();
  void take_targets_around(bool turns);
  void take_target(const Target& target);
  void store_turn();
  void cross(int border, bool several);
  bool meets(const CurvePoint& point) const;
  bool pass_corner();
  bool on_several_borders() const;
  Correction leave(int border, bool several);
  void corner_events(const Signs& before, const std::vector<double>& sizes);
  void user_events_on_corner(const Signs& before, const std::vector<double>& sizes);
  bool passes_target(const CurvePoint& point, double tolerance) const;
  double value() const { return stepper_.here().parameters(parameter_); }
  double parameter_scale() const { return stepper_.here().scale(stepper_.here().scale.size() - 1); }
  double start_scale() const { return state_.start.scale(state_.start.scale.size() - 1); }
  /// Of a step where a corner may have made the last one shorter.
  double careful() const { return 1e-6 * options_.max_step / stepper_.slope_length(state_.hold); }
  double length() const { return state_.distance * stepper_.slope_length(state_.hold); }
  void use(Hold hold);
  void store(PointType type, const std::string& label = {}, const Vector& arrival = {});
  void stop(Stop reason, std::string explanation);
  std::string place() const;

  const Problem& problem_;
  const TraceOptions& options_;
  const Observer& observer_;
  Index parameter_;
  Corrector corrector_;
  Stepper stepper_;
  Watch watch_;
  Targets targets_;
  OwnImage image_;
  Progress state_;  // what changes along the branch, except for the point itself
  const Target* landing_ = nullptr;
  bool landing_failed_ = false;      // from here
  Hold first_hold_ = Hold::tangent;  // how the step under way was first tried
  double first_distance_ = 0;
  std::vector<double> first_taken_;
  std::optional<double> closing_;
  std::vector<Event> events_;
  long looks_to_end_ = 0;                 // of the watch, when it had looked at the end of the step
  Signs signs_before_;                    // the step last taken
  std::map<Regime, int> seen_in_regime_;  // regular points so far
  bool singular_seen_ = false;
  bool stopped_ = false;
  bool interrupted_ = false;
  bool satisfied_ = false;
  bool storing_ = false;  // when the state is not one to go on from
  std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
  long spectra_before_ = 0;  // of an interrupted branch
  Branch branch_;
};

}  // namespace arcslip::continuation
