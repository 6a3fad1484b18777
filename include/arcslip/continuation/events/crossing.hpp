#pragma once

// Branch points within a step: zeros of det [J F_p; normal^T], a smooth function of the way along the branch.

#include <functional>
#include <map>
#include <optional>

#include "arcslip/continuation/events/first_zero.hpp"
#include "arcslip/continuation/events/remote_zero.hpp"
#include "arcslip/continuation/path/prober.hpp"
#include "arcslip/continuation/path/tolerances.hpp"

namespace arcslip::continuation {

/// Keeps references to all but the tolerances.
class CrossingSearch {
 public:
  /// Of one step.
  CrossingSearch(Corrector& corrector, Prober& prober, Step& step, const Tolerances& tolerances);

  /// Whether what is known of the determinant leaves room for branch points in the step; of two at once only
  /// with `pairs`.
  bool may_find(bool pairs) const;

  /// Looks for the first branch point in the step, whose end has been linearised last. False where none
  /// explains a change of sign, or where it cannot be told: then the step has to be shorter, as well as where
  /// the determinant `may_leap` and does so.
  [[nodiscard]] bool search(bool may_leap);

  /// The same of a step on which only a corner is unlike a curve: whether the determinant jumps there to its
  /// other sign, as it does where branches of other symmetry leave a corner that this one passes.
  [[nodiscard]] bool jumps();

  /// Whether a start, along the step's normal and linearised last, is a branch point: a little way off the
  /// determinant is much larger. `max_step` is the largest step.
  bool starts_singular(double max_step);

  /// The problem has scaled its equations anew, and the determinant with them: that of `here` is found again,
  /// of a branch point its sign behind it.
  void rescale(double max_step);

 private:
  using Values = std::map<double, std::optional<double>>;  // by places

  std::optional<Node> determinant_at(double s);
  bool passes_pole(Node p, Node q);
  [[nodiscard]] bool probe_between(double s);
  [[nodiscard]] bool narrow(Node& before, Node& behind, double& s, double radius);
  [[nodiscard]] bool locate(Node before, Node behind);
  std::function<std::optional<double>(double s)> values(Values& known);
  [[nodiscard]] bool take_multiple(ZeroRange range, double radius, Values& known);
  double way_from_start() const;
  bool linearise_behind_start(double way);
  int multiplicity_at_start();
  [[nodiscard]] bool take(const RemoteZero& zero, double sign_behind);

  Corrector& corrector_;
  Prober& prober_;
  Step& step_;
  Tolerances tolerances_;
  // Logarithms of det [J F_p; normal^T] at both ends, and what it is measured in.
  double log_here_ = 0;
  double log_there_ = 0;
  double unit_ = 0;
  int from_zero_ = 0;  // of the branch point on which the step starts its multiplicity, else 0
  Node behind_start_;  // the determinant in its unit where it begins
  Vector expected_;
  Vector work_;
};

}  // namespace arcslip::continuation
