#pragma once

// Motion of a ring in time, event by event. While no contact changes between stick and slip the ring is
// linear with constant coefficients and harmonic load, and its Taylor series in time
//
//   (m+1)(m+2) p_{m+2} = L_m - W p_m - (m+1) D p_{m+1} - B^T g_m
//
// is summed to rounding, over steps of a few units of the fastest rate of the ring, or shorter ones where
// further elements add products of series to it. So every displacement is a polynomial in a step, of which
// the first crossing is found without sampling: |r - x| = S ends stick, r' = 0 ends slip, and a further
// element changes its law where its displacement says so. It needs no decomposition for each pattern of
// sticking contacts, of which a transient has hundreds, and has no exception where the damped modes are
// defective.

#include <set>
#include <vector>

#include "arcslip/time/ring.hpp"

namespace arcslip {

/// All that the future depends on.
struct RingState {
  double time = 0;        ///< t, of which a period is 1/eta
  Vector position;        ///< D
  Vector velocity;        ///< D
  Vector slider;          ///< N: x, which is r -+ S in slip
  std::vector<int> slip;  ///< N: 0 in stick, else the sign of the slip
};

/// One step: coefficients in powers of (t - start)/scale, valid for start <= t <= start + length.
struct RingSegment {
  double start = 0;                     ///< t
  double scale = 1;                     ///< of time, in the powers
  double length = 0;                    ///< of the step, in time
  Matrix position;                      ///< D x (order + 1)
  Matrix relative;                      ///< N x (order + 1): r
  std::vector<Matrix> other;            ///< N x (order + 1) of each further element: x
  std::vector<std::vector<int>> zones;  ///< N of each: the piece of its law, negative where x is

  /// Values of the rows of `series`, and their derivatives in time, at start + ratio * scale.
  static Vector value(const Matrix& series, double ratio);
  Vector rate(const Matrix& series, double ratio) const;
};

/// What follows a motion.
class RingObserver {
 public:
  virtual ~RingObserver() = default;

  /// A step, with the contact states of `state`, the state at its start.
  virtual void follow(const RingSegment& segment, const RingState& state) = 0;

  /// A contact of `state` has just changed, at state.time.
  virtual void change(Index /*contact*/, const RingState& /*state*/) {}
};

/// What a motion has cost.
struct RingCount {
  long steps = 0;                        ///< Taylor series summed
  long events = 0;                       ///< changes between stick and slip, each contact counted
  std::set<std::vector<bool>> patterns;  ///< of sticking contacts, the least of each one's rotations
};

/// One harmonic of the relative displacement of node 1, and of forces there, phasors.
struct ContactHarmonic {
  int order;           ///< h
  Complex relative;    ///< r_h
  Complex friction;    ///< on the base, k phi r for one harmonic; that on the damper is the opposite
  Complex base = 0;    ///< force of further elements on the base
  Complex damper = 0;  ///< and on the damper
};

/// Equation of motion of `ring` at one eta and preload.
class RingMotion {
 public:
  /// Throws std::invalid_argument unless eta > 0 and the contact is loaded.
  RingMotion(const Ring& ring, double eta, double preload);

  /// Everything at zero, at t = 0, in stick.
  RingState at_rest() const;

  /// The state at t = 0 of the travelling wave in which node 1 has these harmonics.
  RingState travelling(const std::vector<ContactHarmonic>& harmonics) const;

  /// Takes the state on by `duration`. Throws std::runtime_error where contacts switch without end.
  void advance(RingState& state, double duration, RingObserver* observer = nullptr);

  /// Elastic energy, also of the contacts, and kinetic energy.
  double energy(const RingState& state) const;

  /// What moves, and at what frequency and threshold.
  const Ring& ring() const { return ring_; }
  double frequency() const { return frequency_; }  ///< w* = 2 pi eta
  double period() const { return period_; }
  double slip_threshold() const { return threshold_; }  ///< S
  /// Of all that was advanced so far.
  const RingCount& count() const { return count_; }

 private:
  struct Crossing {
    Index contact;  ///< beyond the last: the law of a further element changes
    double ratio;   ///< of the segment's scale
  };

  bool expands(const RingState& state, double length);
  void find_zones(const RingState& state);
  void add_law_crossings(std::vector<Crossing>& found) const;
  std::vector<Crossing> first_crossings(const RingState& state) const;
  void change(Index contact, RingState& state) const;
  void note(const RingState& state);

  Ring ring_;
  double frequency_;
  double period_;
  double threshold_;
  double rate_;
  double longest_step_;
  RingSegment segment_;
  RingCount count_;
};

/// Terms that the Taylor series of e^z needs for |z| = `reach` to leave out less than rounding.
Index series_order(double reach);

/// Rows of B of the contacts that stick.
Matrix sticking_rows(const Ring& ring, const std::vector<int>& slip);

}  // namespace arcslip
