#pragma once

// Where a step is expected to end: by the cubic of the last step, and by the change of the cubics of the last
// two.

#include "arcslip/continuation/path/step.hpp"

namespace arcslip::continuation {

/// Allocates nothing after construction.
class Predictor {
 public:
  /// For n + 1 unknowns of the curve; by its curvature alone, or `further`.
  Predictor(Index size, bool further);

  /// Of the curve where a step begins, in its scale; zero where nothing is known.
  const Bends& bends() const { return bends_; }
  void set_bends(const Bends& bends) { bends_ = bends; }
  void forget() { straighten(bends_); }

  /// (z - z_here)/scale where the step is expected to end, of which the tangent, the condition and the
  /// distance are known.
  void predict(const Step& step, Vector& displacement);

  /// The same by the mean curvature of the last step alone, by which steps are judged.
  const Vector& parabola() const { return parabola_; }

  /// What the step, which was predicted, tells for the next one, with its end's scale: by its end and slopes,
  /// unless it `is_corner`. The tolerance is that on its ends.
  void learn(const Step& step, double tolerance, bool is_corner);

  /// Begins the next step where the one that was learnt from ends.
  void advance() { bends_ = next_bends_; }

 private:
  static void straighten(Bends& bends);

  bool further_;
  Bends bends_;
  Bends next_bends_;
  Vector parabola_;
  Vector twist_;  // d^3 z/ds^3 of the last step in the coordinate of this one
};

}  // namespace arcslip::continuation
