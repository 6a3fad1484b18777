#pragma once

// Motion of a ring in time, event by event. While no element changes its phase (ring_law.hpp) the forces are
// polynomials of displacements, and the Taylor series in time
//
//   (m+1)(m+2) p_{m+2} = L_m - W p_m - (m+1) D p_{m+1} - X^T f_m
//
// is summed to rounding, over steps of a few units of the fastest rate of the ring, or shorter ones where
// forces are no linear ones, which a friction circle that slips brings along by a series of its own
// (slip_series.hpp). So every displacement is a polynomial in a step, of which the first event is
// found without sampling. It needs no decomposition for each pattern of phases, of which a transient has
// hundreds, and has no exception where the damped modes are defective.

#include <memory>
#include <vector>

#include "arcslip/time/ring.hpp"
#include "arcslip/time/ring_law.hpp"
#include "arcslip/time/slip_series.hpp"

namespace arcslip {

/// All that the future depends on. Of each kind of element in turn, node by node: its phases and each number
/// of its memory, of a contact the place of its slider.
struct RingState {
  double time = 0;         ///< t, of which a period is p/eta
  Vector position;         ///< D
  Vector velocity;         ///< D
  Vector memory;           ///< M
  std::vector<int> phase;  ///< of each element, as ring_law.hpp has it; of contacts 0 in stick, else the
                           ///< sign of the slip
};

/// One step: coefficients in powers of (t - start)/scale, valid for start <= t <= start + length.
struct RingSegment {
  double start = 0;   ///< t
  double scale = 1;   ///< of time, in the powers
  double length = 0;  ///< of the step, in time
  Matrix position;    ///< D x (order + 1)
  Matrix motion;      ///< coordinates of all elements x (order + 1): x
  Matrix slip;        ///< forces of friction circles that slip, x and y in turn, x (order + 1)

  /// Values of the rows of `series`, and their derivatives in time, at start + ratio * scale.
  static Vector value(const Matrix& series, double ratio);
  Vector rate(const Matrix& series, double ratio) const;
};

/// What follows a motion.
class RingObserver {
 public:
  virtual ~RingObserver() = default;

  /// A step, with the phases of `state`, the state at its start.
  virtual void follow(const RingSegment& segment, const RingState& state) = 0;

  /// Element `which` of `state` has just changed its phase, at state.time.
  virtual void change(Index /*which*/, const RingMemoryChanges& /*memory*/, const RingState& /*state*/) {}
};

/// What a motion has cost.
struct RingCount {
  long steps = 0;   ///< Taylor series summed
  long events = 0;  ///< changes of phase, each element counted
};

/// One harmonic of the motion of node 1 in the coordinates of its elements, and of their forces, phasors.
struct RingHarmonic {
  int order;             ///< h
  ComplexVector motion;  ///< x_h
  ComplexVector force;   ///< f_h, against x
};

/// Forces of the elements that vary within their phases: of some coordinates.
struct VaryingForces {
  /// A friction circle that slips.
  struct Circle {
    Index element;  ///< which
    Index x;        ///< place here of its coordinates
    Index y;        ///< the same
    Index g;        ///< the same, or -1
  };
  std::vector<Index> rows;   ///< which coordinates they are
  Matrix motion;             ///< their rows of X
  Vector linear;             ///< stiffness against the own displacement
  Vector origin;             ///< from which that counts
  std::vector<Index> other;  ///< the place here of another coordinate that moves the force, or -1
  Vector cross;              ///< by how much it does
  std::vector<std::pair<Index, std::vector<double>>> curved;  ///< place and powers of those not linear
  std::vector<Circle> circles;

  /// Stiffnesses of linear ones between their coordinates.
  Matrix gain() const;

  /// Whether all forces are linear.
  bool are_linear() const { return curved.empty() && circles.empty(); }
};

class LawSeries;

/// Equation of motion of `ring` at one eta and preload.
class RingMotion {
 public:
  /// Throws std::invalid_argument unless eta > 0 and the preload is positive.
  RingMotion(const Ring& ring, double eta, double preload);

  /// Everything at zero, at t = 0, as it is at rest.
  RingState at_rest() const;

  /// The state at t = 0 of the travelling wave in which node 1 has these harmonics, in the coordinates of
  /// all elements.
  RingState travelling(const std::vector<RingHarmonic>& harmonics) const;

  /// Takes the state on by `duration`. Throws std::runtime_error where elements change without end.
  void advance(RingState& state, double duration, RingObserver* observer = nullptr);

  /// Elastic and kinetic energy of base and damper.
  double energy(const RingState& state) const;

  /// What moves, and at what frequency and load P + P_2 eta^2.
  const Ring& ring() const { return ring_; }
  double frequency() const { return frequency_; }  ///< w* = 2 pi eta/p
  double period() const { return period_; }
  double load() const { return load_; }
  double fastest_rate() const { return rate_; }  ///< a bound on the moduli of eigenvalues, in any phases
  /// Of all that was advanced so far.
  const RingCount& count() const { return count_; }

  /// Elements of one kind under this load.
  struct Family {
    std::shared_ptr<const RingLaw> law;
    Index sliding;  ///< first row of X
    Index across;   ///< the same, or -1
    Index closing;  ///< the same, or -1
    Index memory;   ///< first number in the state's memory
    double factor;  ///< on forces
  };
  const std::vector<Family>& families() const { return families_; }
  Index memories() const { return memories_; }  ///< M
  /// The kind of an element and its node.
  const Family& family(Index which) const {
    return families_[static_cast<std::size_t>(which / ring_.nodes())];
  }
  Index node(Index which) const { return which % ring_.nodes(); }
  Index elements() const { return std::ssize(families_) * ring_.nodes(); }
  /// Where a number of an element's memory stands in the state's.
  Index memory_place(Index which, Index number) const {
    return family(which).memory + number * ring_.nodes() + node(which);
  }
  std::vector<double> memory_of(Index which, const RingState& state) const;
  RingPlace place_of(Index which, const Vector& position, const Vector& velocity) const;
  /// First row of X of the coordinate that moves the place which this number of the memory is.
  static Index row_of(const Family& family, Index number) {
    return family.across >= 0 && number == 1 ? family.across : family.sliding;
  }

  /// What holds since the last event of what was advanced.
  const VaryingForces& varying() const { return varying_; }
  /// The same of the forces that follow from velocities in all phases: their rows of X, times the roots of
  /// their coefficients over dx/dt.
  const Matrix& dragged() const { return dragged_; }
  /// D x D: what rotation at its speed adds to the stiffness and to the damping; empty where it does not.
  const Matrix& turned_stiffness() const { return turned_stiffness_; }
  const Matrix& turned_damping() const { return turned_damping_; }
  const RingBranch& branch(Index which) const { return branches_[static_cast<std::size_t>(which)]; }
  /// Forces of all coordinates at start + ratio * scale of the segment, where their displacements and rates
  /// are these.
  Vector forces(const RingSegment& segment, double ratio, const Vector& x, const Vector& rate) const;
  /// The slip of each circle of `varying` over the last step, in units of the segment's scale.
  const std::vector<SlipSeries>& slips() const { return slips_; }

 private:
  struct Crossing {
    Index which;
    std::size_t event;
    double ratio;  ///< of the segment's scale
  };

  void refresh(Index which, const RingState& state);
  void refresh_all(const RingState& state);
  void gather();
  Index add_row(Index row);
  void vary(Index m, const Vector& x, LawSeries& laws, Vector& local);
  void begin_slips(const RingState& state, Index order);
  void take_slips(Index m, const Vector& x, Vector& local);
  bool slips_end() const;
  void move_sliders(double ratio, RingState& state) const;
  Vector event_function(Index which, const RingEvent& event, const RingState& state) const;
  Vector excess(Index which, const RingState& state) const;
  Vector opposite_slip(Index which) const;
  bool expands(const RingState& state, double length);
  const std::vector<Crossing>& first_crossings(const RingState& state);
  void take_events(RingState& state, RingObserver* observer);
  void leave_idle(RingState& state) const;
  void add_harmonic(int order, const ComplexVector& load, RingState& state) const;
  void move_rigidly(const ComplexVector& mean, const ComplexVector& loads, RingState& state) const;
  void begin_elements(const std::vector<RingHarmonic>& harmonics, RingState& state) const;

  Ring ring_;
  double frequency_;
  double period_;
  double load_;
  double rate_ = 0;
  double longest_step_ = 0;
  double fastest_load_;
  std::vector<Family> families_;
  Index memories_ = 0;
  Matrix sizes_;  ///< |X|
  Matrix turned_stiffness_;
  Matrix turned_damping_;

  std::vector<RingBranch> branches_;
  std::vector<std::vector<RingEvent>> events_;
  VaryingForces varying_;
  Matrix dragged_;
  std::vector<Index> places_;  ///< of the coordinates among the varying ones, or -1
  Vector offset_;              ///< of all coordinates, forces that do not vary
  RingSegment segment_;
  std::vector<Complex> phases_;
  std::vector<Crossing> crossings_;
  Vector loose_;       ///< what displacements may be wrong by
  Vector loose_rate_;  ///< the same of velocities, over the segment's scale
  std::vector<SlipSeries> slips_;
  RingCount count_;
};

/// Terms that the Taylor series of e^z needs for |z| = `reach` to leave out less than rounding.
Index series_order(double reach);

}  // namespace arcslip
