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
// A friction circle has two sliding coordinates, r = x + iy. While it slips its force has the direction phi,
// which slip_series.hpp integrates, and its memory, the slider's place, moves.

#include <boost/container/static_vector.hpp>
#include <memory>
#include <span>
#include <vector>

#include "arcslip/elements/element.hpp"

namespace arcslip {

/// k |r - z| <= mu N, N = k_n g + N_0.
struct RingCircle {
  double stiffness;         ///< k
  double friction;          ///< mu
  double normal_stiffness;  ///< k_n
  double normal_force;      ///< N_0
};

/// Force within a phase.
struct RingBranch {
  std::vector<double> powers = {};     ///< c_k, k >= 1
  double origin = 0;                   ///< o
  Index origin_memory = -1;            ///< the number of the memory that o moves with, or none
  double across = 0;                   ///< stiffness along the second sliding coordinate, y
  double across_origin = 0;            ///< from which that counts; the memory behind that of o moves it
  bool slips_round = false;            ///< beside all this the force mu N e^{i phi} of its circle
  double offset = 0;                   ///< f_0
  std::vector<double> by_memory = {};  ///< df_0 by the memory, or empty
  double by_closing = 0;               ///< c_g
  double closing_stiffness = 0;        ///< k_n
  double closing_offset = 0;           ///< N_0
};

/// What ends a phase: this, negative within it, rises through zero.
struct RingEvent {
  /// What it is a function of: displacements, velocities, displacements a little later as velocities tell
  /// them or earlier; of a circle |k (r - z)|^2 - (mu N)^2 or, as it slips, the slip's rate, negative.
  enum class Of { place, rate, place_ahead, place_behind, excess, slip } of = Of::place;
  double sliding = 0;  ///< a
  double closing = 0;  ///< b
  double level = 0;    ///< to be taken off
};

/// Displacements and velocities of an element.
struct RingPlace {
  double x;
  double x_rate;
  double g = 0;
  double g_rate = 0;
  double y = 0;
  double y_rate = 0;
};

/// How an event has changed a number of the memory, which the displacements at the event move.
struct RingMemoryChange {
  Index number;           ///< of the memory
  double by_sliding = 0;  ///< its derivative by x at the event, whose moment moves as well
  double by_closing = 0;  ///< the same by g
  double by_across = 0;   ///< the same by y
};
using RingMemoryChanges = boost::container::static_vector<RingMemoryChange, 2>;  ///< of one event

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
  /// Of one with two sliding coordinates, whose memory is z; else null.
  virtual const RingCircle* circle() const { return nullptr; }

  /// Phase of one at rest, where all memory is 0.
  virtual int phase_at_rest() const { return 0; }

  /// What holds in a phase. `events` are replaced.
  virtual RingBranch branch(int phase, std::span<const double> memory) const = 0;
  virtual void events(int phase, std::span<const double> memory, std::vector<RingEvent>& events) const = 0;

  /// What goes on behind event `which`, in the order that `events` has, at this place.
  virtual RingMemoryChanges change(std::size_t which, const RingPlace& at, int& phase,
                                   std::span<double> memory) const = 0;

  /// Whether the phase needs this number, and, where it does not, the value that it is given by the place,
  /// with its derivatives.
  virtual bool needs(int /*phase*/, Index /*number*/) const { return true; }
  virtual RingMemoryChange idle(int /*phase*/, const RingPlace& /*at*/, Index number,
                                std::span<double> /*memory*/) const {
    return {number, 0, 0};
  }

  /// Whether memory moves within the phase.
  virtual bool flows(int /*phase*/) const { return false; }

  /// Phase and memory after a motion over a period whose last sample is now, of a force known now, against x
  /// and, as imaginary part, y. A guess.
  virtual void begin(const Vector& x, const RingPlace& now, const Complex& force, int& phase,
                     std::span<double> memory) const = 0;
};

/// How an element acts in time under a load; null where it does not act at all. Throws std::invalid_argument
/// of those that have no motion in time.
std::unique_ptr<const RingLaw> ring_law(const Element& element, double load);

}  // namespace arcslip
