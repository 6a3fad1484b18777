#pragma once

// What a slider does along the lines theta_2 = p + (s/w) theta_1 of a motion with two frequencies.

#include <vector>

#include "elements/line_turns.hpp"

namespace arcslip {

/// Of theta_1: an arc of stick, f = k (x - z) with z = x(anchor) - direction S, or 0 where nothing has set
/// it; or, without `sticks`, of slip.
struct SliderArc {
  double begin, end;
  bool sticks;
  int direction;
  double anchor;
};

/// Over evenly spread p, with the motion's rates sampled on all of these lines at once.
class SliderPaths {
 public:
  SliderPaths(const std::vector<Line>& lines, const ComplexVector& x, double ratio, Index places);

  double phase(Index place) const {
    return two_pi * static_cast<double>(place) / static_cast<double>(places_);
  }

  /// From theta_1 = -pi to pi along one of them, settled over as many periods before as it takes.
  std::vector<SliderArc> arcs(Index place, double threshold);

 private:
  struct Local {
    double value, first, second;
  };
  Local at(double theta);
  struct Turn {
    double theta, value;
  };
  int beat() const;
  Vector earlier_rates(double begin, Index count);
  int add_turns(double begin, double end, const Eigen::Ref<const Vector>& rates, double threshold,
                std::vector<Turn>& turns);
  double onset(const Turn& from, const Turn& to, double level, int direction);

  Index places_;
  double ratio_;
  std::vector<Line> lines_;  // that move
  ComplexVector x_;
  Vector q_;
  LineTurns turns_;
  ComplexVector e_;
  Matrix rates_;  // samples x places
  double phase_ = 0;
};

}  // namespace arcslip
