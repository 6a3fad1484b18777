#pragma once

// All that a step is watched by, at places of it: the rate of the parameter, the slopes of the tracked
// observables, the functions, and the real parts of the eigenvalues, each a function along the branch.

#include <optional>
#include <vector>

#include "arcslip/continuation/events/first_zero.hpp"
#include "arcslip/continuation/path/watch.hpp"

namespace arcslip::continuation {

/// Reads each place once. Keeps references to all that it is made of.
class Readings {
 public:
  /// `functions` and `eigenvalues` are those at the end of the step.
  Readings(Stepper& stepper, Watch& watch, const std::vector<double>& functions,
           const ComplexVector& eigenvalues)
      : stepper_(stepper), watch_(watch), functions_at_end_(functions), eigenvalues_at_end_(eigenvalues) {}

  /// Which of the values is which.
  static constexpr std::size_t rate = 0;
  std::size_t slope(Index observable) const { return 1 + static_cast<std::size_t>(observable); }
  std::size_t piece(Index observable) const {
    return slope(stepper_.monitors().tracked_count() + observable);
  }
  std::size_t function(Index i) const {
    return piece(stepper_.monitors().tracked_count()) + static_cast<std::size_t>(i);
  }
  std::size_t real_part(Index i) const { return function(functions_) + static_cast<std::size_t>(i); }

  /// The value of one at s, or nothing if there is no branch or no value there.
  std::optional<double> value(std::size_t which, double s);

  /// The same with its slope.
  std::optional<Node> node(std::size_t which, double s);

 private:
  /// Some of numbers_.
  struct Values {
    std::size_t begin = 0;
    std::size_t count = 0;
  };
  struct Place {
    double s;
    Values values;
    Values beside;  // values at s + offset, once they were asked for
    double offset = 0;
  };

  Place* at(double s);
  bool look_beside(Place& place, double least);
  bool is_rounding(const Place& place, std::size_t which) const;
  Values since(std::size_t begin) const { return {begin, numbers_.size() - begin}; }
  Values read_start();
  Values read_end();
  Values read(const Probe& probe);

  Stepper& stepper_;
  Watch& watch_;
  const std::vector<double>& functions_at_end_;
  const ComplexVector& eigenvalues_at_end_;
  Index functions_ = static_cast<Index>(functions_at_end_.size());
  std::vector<Place> places_;
  std::vector<double> numbers_;  // together, since most steps read one place or none
};

}  // namespace arcslip::continuation
