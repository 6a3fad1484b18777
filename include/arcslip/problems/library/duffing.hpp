#pragma once

// Duffing's oscillator by harmonic balance in odd harmonics [example 1 of NLvib: Krack & Gross, Harmonic
// Balance for Nonlinear Vibration Problems, Springer 2019]:
//
//   q'' + delta q' + q + k3 q^3 = force cos(W t),   q = sum a_k cos(k W t) + b_k sin(k W t),  k = 1, 3 .. H
//
//   (1 - k^2 W^2) a_k + delta k W b_k + k3 <q^3, cos k> = force (k = 1)
//   (1 - k^2 W^2) b_k - delta k W a_k + k3 <q^3, sin k> = 0
//
// Unknowns: a_1, b_1, a_3, b_3, ... Parameters: W, force, delta, k3. q^3 is projected exactly by 2 H + 1
// samples of half a period. One harmonic has [(1 - W^2 + 3/4 k3 a^2)^2 + (delta W)^2] a^2 = force^2. At delta
// = 0.05, k3 = 0.1, force = 0.18: folds W = 1.267536959513, 1.115585927182 (H =
// 1), 1.269601955546, 1.115700251771 (H >= 9; AUTO-07p by collocation 1.2696019548, 1.1157002516).

#include "arcslip/problems/library/library.hpp"

namespace arcslip::problems {

/// The equations above, with the stability of the motion.
class DuffingOscillator : public continuation::Problem {
 public:
  /// Positions of W, force, delta and k3.
  enum Parameter : Index { frequency, force, damping, cubic };

  /// `harmonics` H >= 1; an even number counts as the odd one below.
  explicit DuffingOscillator(Index harmonics);

  Index size() const override { return basis_.cols(); }
  std::vector<std::string> parameter_names() const override { return {"W", "force", "delta", "k3"}; }
  [[nodiscard]] bool evaluate(const Vector& u, const Vector& p, const continuation::Regime& regime,
                              const continuation::Evaluation& out) const override;

  /// The harmonics' amplitudes a1, a3, ..., whose gradients count as zero where they are zero, and the root
  /// mean square of q, rms.
  std::vector<continuation::Observable> observables() const override;
  void observe(const Vector& u, const Vector& p, const continuation::Regime& regime,
               Vector& values) const override;
  double observe(const Vector& u, const Vector& p, const continuation::Regime& regime, Index which,
                 continuation::Gradient& gradient) const override;

  /// The rates (hill.hpp) of y'' + delta y' + (1 + 3 k3 q^2) y = 0 over half a period of q, in the same odd
  /// harmonics and in the even ones that go with them, so that one vanishes exactly at a fold. Where another
  /// multiplier passes 1 the motion loses its symmetry.
  [[nodiscard]] bool eigenvalues(const Vector& u, const Vector& p, const continuation::Regime& regime,
                                 ComplexVector& values) const override;
  continuation::PointType pair_crossing() const override { return continuation::PointType::neimark_sacker; }

  /// Zero where it does.
  std::vector<continuation::PointType> test_types() const override {
    return {continuation::PointType::symmetry_breaking};
  }
  void test(const Vector& u, const Vector& p, const continuation::Regime& regime,
            Vector& values) const override;

 private:
  Index count() const { return basis_.cols() / 2; }  // of harmonics
  Matrix linear_part(const Vector& p) const;
  std::vector<ComplexMatrix> variation(const Vector& u, const Vector& p) const;

  Matrix basis_;  // samples x n: cos k t, sin k t at t in [0, pi)
};

/// `duffing`
LibraryModel duffing_model();

}  // namespace arcslip::problems
