#pragma once

// Where branches cross, a step may begin on one of them and end on the other. Past a pitchfork that a branch
// arrives at sideways, as sqrt(p_c - p), it has no points at p > p_c, and what the corrector finds there is
// the branch that it leaves from. The determinant has one sign at both ends, and where little of z takes part
// the tangent hardly turns. But the determinant was to vanish, and the step bends as no curve does.

#include <array>

#include "arcslip/continuation/path/prober.hpp"

namespace arcslip::continuation {

/// Keeps references to all that it is made of. Allocates nothing after construction.
class OneCurve {
 public:
  /// Of the step, whatever it becomes.
  OneCurve(Corrector& corrector, Prober& prober, Step& step);

  /// Whether one curve joins the ends of a step without a corner. Looks in between only where the determinant
  /// falls and the step ends elsewhere than its slopes tell or, where the determinant was to vanish, than at
  /// `foretold`: (z - z_here)/scale, n + 1.
  [[nodiscard]] bool joins(const Vector& foretold);

 private:
  static constexpr std::size_t most_halvings = 3;

  /// Of the branch within the step.
  struct Place {
    double s;
    Vector way;          ///< (z - z_here)/scale
    Vector slope;        ///< dz/ds
    double determinant;  ///< that the tangent closes, of that at `here`
  };
  bool joins(const Place& from, const Place& to, double rate, std::size_t halvings);
  double determinant(double sign, double log) const;
  double bend(const Place& from, const Place& to) const;
  bool is_uneven(const Place& from, const Place& to) const;
  bool is_foretold(const Place& from, const Place& middle, const Place& to) const;

  Corrector& corrector_;
  Prober& prober_;
  Step& step_;
  Place begin_, end_;
  std::array<Place, most_halvings> middle_;
};

}  // namespace arcslip::continuation
