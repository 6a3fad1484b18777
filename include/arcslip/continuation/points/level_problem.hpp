#pragma once

// Points at which an observable has a given value, as an extended problem.

#include "arcslip/continuation/points/extended_problem.hpp"

namespace arcslip::continuation {

/// F(u, p) = 0 and g(u, p) = value, of an observable g with a gradient. Where F and g are continuous so is
/// the curve, which goes on from regime to regime.
class LevelProblem : public ExtendedProblem {
 public:
  /// `active` becomes an unknown. Throws std::invalid_argument where the observable has no gradient.
  LevelProblem(const Problem& base, Index active, Index observable, double value);

  [[nodiscard]] bool adapt(const BasePoint& point) override;
  std::optional<Regime> regime_beyond(const Regime& regime, int border) const override {
    return base().regime_beyond(regime, border);
  }

 protected:
  bool conditions(const BasePoint& point, Vector& values, Matrix* gradients) const override;
  void each_border(const std::function<void(double*, Index)>& use) override;

 private:
  double slope(const BasePoint& point);

  Index observable_;
  Observable what_;
  double value_;
  double size_ = 1;  // of the observable, times the slope over it
  mutable Gradient slope_;
};

}  // namespace arcslip::continuation
