#pragma once

// Periodic motion of base, damper and their elements without excitation, in the coordinates x of
// coordinates.hpp:
//
//   x_h + C_h(eta, zeta) f_h(x) = 0,
//
// solved relative to |x| and to sqrt(1 + |C_B K|^2 + |C_D K|^2), the terms that cancel in C_h. Its phase is
// free: Im x_1 = 0 in the first coordinate, the first contact. Where elements are not odd there are even
// harmonics as well and the mean, h = 0. Where rigid motions S move it, it is where S^H f_0 = 0: with P onto
// what S moves and a flexibility c,
//
//   (1 - P) (x_0 + C_0 f_0) + c P f_0 = 0.
//
// What friction alone would hold drifts where it slips, as in HarmonicResponse, but not where masses are
// damped. Regimes and borders are those of HarmonicResponse.

#include <array>

#include "arcslip/problems/response/harmonic_problem.hpp"

namespace arcslip::problems {

/// What cycles and modes share.
class FreeVibration : public HarmonicProblem {
 public:
  [[nodiscard]] bool evaluate(const Vector& u, const Vector& p, const continuation::Regime& regime,
                              const continuation::Evaluation& out) const override;

 protected:
  /// Throws std::invalid_argument as HarmonicProblem does.
  FreeVibration(HarmonicSystem system, Layout layout);

  /// Re x_1 of the first coordinate.
  double amplitude(const Vector& u, const Vector& p) const { return value(layout_.real, u, p); }

  /// |x|.
  double length(const Vector& u, const Vector& p) const;

 private:
  bool is_odd_;          ///< whether all harmonics are
  ContactMatrix still_;  ///< 1 - P; of size 0 where nothing is free to move
  ContactMatrix held_;   ///< c P
  bool damps_masses_ = false;
  bool is_moved(Index order) const { return still_.size() > 0 && order == rigid_.order(); }
  struct Order;
  Complex own(const Order& order, Index coordinate, const Vector& u, const Vector& p) const;
  std::array<Complex, 2> own_rates(const Order& order, Index coordinate, Index by) const;
  Order order(Index which, const Vector& u, const Vector& p, const continuation::Regime& regime) const;
  Complex by_varied(const Order& order, Index coordinate, const std::vector<ElementForce>& elements,
                    Complex residual, const Vector& u, const Vector& p) const;
  void fill_row(const Order& order, Index coordinate, const std::vector<ElementForce>& elements,
                const Vector& u, const Vector& p, const continuation::Evaluation& out) const;
};

}  // namespace arcslip::problems
