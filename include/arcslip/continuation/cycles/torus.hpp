#pragma once

// Tori: motions u(theta_1, theta_2) of u' = f(t, u, p) that come back in each of two angles, which turn at
// rates of their own:
//
//   omega_1 du/dtheta_1 + omega_2 du/dtheta_2 = f(theta_1/omega_1, u, p)
//
// Trigonometric polynomials of degrees H_1 and H_2 in the two meet it at (2 H_1 + 1) x (2 H_2 + 1) places at
// equal distances, where their values are the unknowns [F. Schilder, W. Vogt, S. Schreiber, H. M. Osinga,
// Int. J. Numer. Meth. Engng 67 (2006) 629]. Both rates are unknowns, each with a condition that keeps the
// torus from sliding along itself,
//
//   sum (u - u_0) . du_0/dtheta_k = 0
//
// with the u_0 that it began with; omega_1 of a field with a period is given by this. Where the rates are in
// a ratio of small integers motions on a torus may lock onto cycles, and there is none of this kind: its tail
// grows.

#include <memory>
#include <string>
#include <vector>

#include "arcslip/continuation/cycles/field.hpp"
#include "arcslip/continuation/cycles/orbit_mesh.hpp"

namespace arcslip::continuation {

/// Values of a torus on its grid, n x (m_1 m_2), theta_1 first, and what they belong to.
struct TorusGrid {
  int waves_1 = 0;  ///< H_1
  int waves_2 = 0;  ///< H_2
  int periods = 1;  ///< of a field with a period: how many of these theta_1 takes for a turn
  Vector winding;   ///< n: what an angle gains as theta_1 turns
  Matrix values;
};

/// Unknowns: the values on the grid, then omega_1 where it is one, then omega_2. Observables: `omega_1`,
/// `omega_2`, their ratio `rotation`; the largest and the smallest value of each unknown, `x_max` and
/// `x_min`; `norm`, the root of the mean of |u|^2.
class Torus : public Problem {
 public:
  /// The grid holds u_0, which has to change with both angles; rates there.
  Torus(std::shared_ptr<const Field> field, TorusGrid grid, double omega_1, const Vector& p);

  const Field& field() const { return *field_; }
  std::shared_ptr<const Field> shared_field() const { return field_; }
  Index count(int angle) const { return rule(angle).degree(); }  ///< m_1 or m_2: places of an angle, 0 or 1
  int waves(int angle) const { return rule(angle).waves(); }     ///< H_1 or H_2
  const TorusGrid& reference() const { return grid_; }           ///< u_0

  /// The values on the grid, n x (m_1 m_2).
  auto values(const Vector& u) const {
    return Eigen::Map<const Matrix>(u.data(), field_->size(), count(0) * count(1));
  }
  /// Angle number `place` of one of the two, from 0 on.
  double angle(int which, Index place) const { return two_pi * rule(which).points()(place); }
  double omega_1(const Vector& u, const Vector& p, Vector* by_parameters = nullptr) const;
  double omega_2(const Vector& u) const { return u(u.size() - 1); }

  /// Sum of the last amplitudes in one of both angles, relative to how far unknowns go: the largest.
  double tail(const Vector& u, int angle) const;
  /// How much of what turns with theta_2 alone is left, over that of u_0: 0 where a cycle is.
  double apart(const Vector& u) const { return apart_.dot(u.head(apart_.size())); }
  /// How nearly the conditions on phases are those of the torus itself: 1 for u_0, the smaller of both.
  double phase_grip(const Vector& u) const;

  Index size() const override { return field_->size() * count(0) * count(1) + (has_first_rate() ? 2 : 1); }
  std::vector<std::string> parameter_names() const override { return field_->parameter_names(); }
  [[nodiscard]] bool evaluate(const Vector& u, const Vector& p, const Regime& regime,
                              const Evaluation& out) const override;
  void scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const override;
  /// None: what tells the stability of a torus is not found.
  [[nodiscard]] bool eigenvalues(const Vector& /*u*/, const Vector& /*p*/, const Regime& /*regime*/,
                                 ComplexVector& /*values*/) const override {
    return false;
  }
  std::vector<Observable> observables() const override;
  void observe(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const override;

 private:
  struct Slopes;
  const CollocationRule& rule(int angle) const { return angle == 0 ? first_ : second_; }
  bool has_first_rate() const { return !field_->is_periodic(); }
  double duration(const Vector& p, Vector* by_parameters) const;
  Slopes slopes(const Matrix& values) const;
  Matrix closed(const Matrix& values, Index unknown) const;
  double highest(const Matrix& values, double sign) const;
  void fill_conditions(const Vector& u, const Evaluation& out) const;
  void fill_slopes(double first, double second, Matrix& jacobian) const;

  std::shared_ptr<const Field> field_;
  TorusGrid grid_;
  CollocationRule first_;
  CollocationRule second_;
  Matrix by_first_;   // m_1 x m_1: derivatives
  Matrix by_second_;  // m_2 x m_2
  Vector scale_;      // n
  double rate_;       // in which equations are measured
  Matrix phases_;     // n m_1 m_2 x 2: weights of both conditions
  Vector apart_;      // n m_1 m_2
};

}  // namespace arcslip::continuation
