#pragma once

// The derivative of the flow of a ring by its initial state. Between events it obeys the linear ring of the
// elements' stiffness at the moment. Forces are continuous at events, so displacements and velocities have no
// jump in their derivatives either; a number of the memory that an event sets moves as the displacements do
// there, the moment of the event included.

#include "arcslip/time/node_waves.hpp"
#include "arcslip/time/ring_motion.hpp"

namespace arcslip {

/// Records the motion that it follows, and tells the derivative.
class RingTangent : public RingObserver {
 public:
  explicit RingTangent(const RingMotion& motion) : motion_(motion), waves_(motion.ring()) {}
  void follow(const RingSegment& segment, const RingState& state) override;
  void change(Index which, const RingMemoryChanges& memory, const RingState& state) override;

  /// The derivative of position, velocity and memory of `state`, at the end, by those at the start: (2D + M)
  /// x (2D + M). Columns of memory that the phases at the start do not need are zero: it is no free state.
  Matrix at(const RingState& state) const;

  /// Whether an element of each kind has changed its phase, or begins in one that does not need its memory.
  std::vector<bool> moved() const;

 private:
  /// A number of the memory that moves a force.
  struct Remembered {
    Index place;         ///< of the coordinate among the varying ones
    Index number;        ///< in the state's memory
    double coefficient;  ///< stiffness against it
    Index curved;        ///< among those not linear if it is their origin, which the slope acts on, or -1
  };
  struct Stretch {
    double length;
    Index order;
    VaryingForces forces;
    NodeWaves::Rows rows;  ///< those of the forces
    std::vector<Remembered> memory;
    Matrix slopes;                         ///< curved x (order + 1)
    std::vector<SlipTangent::Step> slips;  ///< of the circles
  };
  struct Change {
    std::size_t after;  ///< how many stretches
    Index element;      ///< which
    RingMemoryChange memory;
  };
  struct Columns {
    Matrix position;
    Matrix velocity;
    Matrix memory;
  };

  void note_memory(Stretch& stretch) const;
  void note_slopes(const RingSegment& segment, Stretch& stretch) const;
  void take(const Stretch& stretch, Columns& columns) const;
  static void take_curved(const Stretch& stretch, const Matrix& x, std::vector<Matrix>& motions,
                          Matrix& local);
  void take_slips(const Stretch& stretch, const Matrix& x, std::vector<SlipTangent>& slips,
                  Matrix& local) const;
  std::vector<SlipTangent> slips_of(const Stretch& stretch, const Columns& columns) const;
  void finish_slips(const Stretch& stretch, const std::vector<SlipTangent>& slips, Columns& columns) const;
  Eigen::RowVectorXd memory_row(Index element, const RingMemoryChange& change, const Matrix& position) const;
  void take_whole(const Stretch& stretch, Columns& columns) const;
  void take_all(Columns& columns) const;
  bool is_uniform() const;
  Matrix wave_by_wave() const;
  void add_idle(const RingState& state, Matrix& all) const;

  const RingMotion& motion_;
  NodeWaves waves_;
  std::vector<Stretch> stretches_;
  std::vector<Change> changes_;
  std::vector<int> phase_;  ///< at the start
  std::vector<bool> changed_;
  bool goes_on_ = false;  ///< whether a step that follows belongs to the last stretch
};

}  // namespace arcslip
