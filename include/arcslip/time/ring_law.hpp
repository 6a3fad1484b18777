#pragma once

// What an element does in time, phase by phase. Within a phase its forces against its sliding coordinate x
// and, if it has one, its closing coordinate g are
//
//   f = sum_k c_k (x - o)^k + c_g g + f_0,   N = k_n g + N_0
//
// beside a force that follows from the velocity in all phases, until a function a x + b g - level, or a x' +
// b g' - level, rises through zero. It then goes on in another phase, perhaps with a new value in its memory,
// a few numbers such as the place of a slider. Forces are continuous at such events, so that memory alone
// carries what the past has been.
//
// A law whose force is no such polynomial within a phase, as that of a friction circle that slips, needs a
// state which is integrated beside the motion: RingBranch is where it would be told, RingMotion where it
// would be followed.

#include <memory>
#include <span>
#include <vector>

#include "arcslip/elements/element.hpp"

namespace arcslip {

/// Force within a phase.
struct RingBranch {
  std::vector<double> powers = {};     ///< c_k, k >= 1
  double origin = 0;                   ///< o
  Index origin_memory = -1;            ///< the number of the memory that o moves with, or none
  double offset = 0;                   ///< f_0
  std::vector<double> by_memory = {};  ///< df_0 by the memory, or empty
  double by_closing = 0;               ///< c_g
  double closing_stiffness = 0;        ///< k_n
  double closing_offset = 0;           ///< N_0
};

/// What ends a phase: this, negative within it, rises through zero.
struct RingEvent {
  double sliding;        ///< a
  double closing;        ///< b
  double level;          ///< to be taken off
  bool of_rate = false;  ///< of the velocities
};

/// Displacements and velocities of an element.
struct RingPlace {
  double x;
  double x_rate;
  double g = 0;
  double g_rate = 0;
};

/// How an event has changed the memory: one number, which the displacements at the event move.
struct RingMemoryChange {
  Index number = -1;      ///< of the memory, or none
  double by_sliding = 0;  ///< its derivative by x at the event, whose moment moves as well
  double by_closing = 0;  ///< the same by g
};

/// Under one load. Immutable.
class RingLaw {
 public:
  virtual ~RingLaw() = default;

  /// How many numbers it remembers, and whether what it does stays the same where they all move with x.
  virtual Index memories() const { return 0; }
  virtual bool forgets_place() const { return false; }
  /// The same of its closing coordinate.
  virtual bool forgets_closing() const { return false; }

  /// Bounds on its stiffness whatever the phase, of polynomials of the first degree.
  virtual double steepest() const = 0;
  /// The force against x over dx/dt.
  virtual double viscous() const { return 0; }

  /// Phase of one at rest, where all memory is 0.
  virtual int phase_at_rest() const { return 0; }

  /// What holds in a phase. `events` are replaced.
  virtual RingBranch branch(int phase, std::span<const double> memory) const = 0;
  virtual void events(int phase, std::span<const double> memory, std::vector<RingEvent>& events) const = 0;

  /// What goes on behind event `which`, in the order that `events` has, at this place.
  virtual RingMemoryChange change(std::size_t which, const RingPlace& at, int& phase,
                                  std::span<double> memory) const = 0;

  /// Whether the phase needs this number, and, where it does not, the value that it is given by the place,
  /// with its derivatives.
  virtual bool needs(int /*phase*/, Index /*number*/) const { return true; }
  virtual RingMemoryChange idle(int /*phase*/, const RingPlace& /*at*/, Index number,
                                std::span<double> /*memory*/) const {
    return {number, 0, 0};
  }

  /// Phase and memory after a motion over a period whose last sample is now, of a force known now. A guess.
  virtual void begin(const Vector& x, const RingPlace& now, double force, int& phase,
                     std::span<double> memory) const = 0;
};

/// How an element acts in time under a load; null where it does not act at all. Throws std::invalid_argument
/// of those that have no motion in time.
std::unique_ptr<const RingLaw> ring_law(const Element& element, double load);

}  // namespace arcslip
