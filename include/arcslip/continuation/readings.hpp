#pragma once

// All that a step is watched by, at places of it: the rate of the parameter, the slopes of the tracked
// observables, the functions, and the real parts of the eigenvalues, each a function along the branch.

#include <deque>
#include <optional>
#include <vector>

#include "arcslip/continuation/first_zero.hpp"
#include "arcslip/continuation/watch.hpp"

namespace arcslip::continuation {

class Readings {
 public:
  Readings(Stepper& stepper, Watch& watch) : stepper_(stepper), watch_(watch) {}

  /// Which of the values is which.
  static constexpr std::size_t rate = 0;
  std::size_t slope(Index observable) const { return 1 + static_cast<std::size_t>(observable); }
  std::size_t function(Index i) const {
    return slope(stepper_.tracked_count()) + static_cast<std::size_t>(i);
  }
  std::size_t real_part(Index i) const { return function(functions_) + static_cast<std::size_t>(i); }

  /// The value of one at s, or nothing if there is no branch or no value there.
  std::optional<double> value(std::size_t which, double s);

  /// The same with its slope.
  std::optional<Node> node(std::size_t which, double s);

 private:
  struct Place {
    double s;
    std::vector<double> values;
    std::vector<double> beside;  // values at s + offset, once they were asked for
    double offset = 0;
  };

  Place* at(double s);
  void read(const CurvePoint& point, double parameter_rate, const std::vector<Monitor>& monitors,
            std::vector<double>& values);

  Stepper& stepper_;
  Watch& watch_;
  Index functions_ = static_cast<Index>(watch_.functions().size());
  std::deque<Place> places_;
};

}  // namespace arcslip::continuation
