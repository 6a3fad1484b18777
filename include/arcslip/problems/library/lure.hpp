#pragma once

// The cycle of a Lur'e system [test `lure` of BifurcationKit.jl] by harmonic balance, with its frequency
// unknown:
//
//   x' = y,  y' = z,  z' = -a z - b y - x + x^2;   x = c_0 + sum c_k cos k w t + s_k sin k w t,  k = 1 .. H
//
//   (1 - a v^2) c_k + (b v - v^3) s_k - <x^2, cos k> = 0,   v = k w
//   (1 - a v^2) s_k - (b v - v^3) c_k - <x^2, sin k> = 0,   s_1 = 0
//
// Unknowns: c_0, c_1, s_1, ..., c_H, s_H, w. Parameters: a, b. x^2 is projected exactly by 3 H + 1 samples.
// The cycle is born at the Hopf point a = 1/b with T = 2 pi/sqrt(b). At b = 1 its amplitude then is sqrt((1 -
// a)/0.9), and its period doubles at a = 0.6303020062, T = 6.3640713394 (AUTO-07p).

#include "arcslip/problems/library/library.hpp"

namespace arcslip::problems {

/// The equations above, with the stability of the cycle.
class LureCycle : public continuation::Problem {
 public:
  /// Positions of the parameters.
  enum Parameter : Index { a, b };

  /// `harmonics` H >= 1.
  explicit LureCycle(Index harmonics);

  Index size() const override { return basis_.cols() + 1; }
  std::vector<std::string> parameter_names() const override { return {"a", "b"}; }
  [[nodiscard]] bool evaluate(const Vector& u, const Vector& p, const continuation::Regime& regime,
                              const continuation::Evaluation& out) const override;

  /// The first harmonic's amplitude A1, whose gradient counts as zero where it is zero, and the period T.
  std::vector<continuation::Observable> observables() const override { return {{"A1", true}, {"T", true}}; }
  void observe(const Vector& u, const Vector& p, const continuation::Regime& regime,
               Vector& values) const override;
  double observe(const Vector& u, const Vector& p, const continuation::Regime& regime, Index which,
                 continuation::Gradient& gradient) const override;

  /// The rates (hill.hpp) of disturbances but for the shift in time, whose multiplier is 1.
  [[nodiscard]] bool eigenvalues(const Vector& u, const Vector& p, const continuation::Regime& regime,
                                 ComplexVector& values) const override;
  continuation::PointType pair_crossing() const override { return continuation::PointType::neimark_sacker; }

  /// Zero where a multiplier is -1.
  std::vector<continuation::PointType> test_types() const override {
    return {continuation::PointType::period_doubling};
  }
  void test(const Vector& u, const Vector& p, const continuation::Regime& regime,
            Vector& values) const override;

  /// The cycle at (a, b), followed from the Hopf point.
  continuation::Guess guess(const Vector& p) const;

 private:
  Index harmonics() const { return (basis_.cols() - 1) / 2; }

  Matrix basis_;  // samples x (2 H + 1): 1, cos k t, sin k t
};

/// `lure`
LibraryModel lure_model();

}  // namespace arcslip::problems
