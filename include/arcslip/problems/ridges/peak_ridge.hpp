#pragma once

// Peaks and troughs of Y over eta in slip, as a curve in (eta, P):
//
//   g(t, eta, P) = 0                                  the response equation, with ln R = ln S + t
//   h(t, eta, P) = d ln Y/d eta along it = 0          at fixed P
//
// Unknowns: w = sqrt(ln(R/S)) and eta; parameter: P. In w both are analytic up to R = S and across, where in
// t they have a square root: phi begins with t^(3/2). The curve ends on the border w = 0. It is what
// continuation::ExtremumProblem traces for any problem, with second derivatives in closed form.

#include "arcslip/assembly/system.hpp"
#include "arcslip/continuation/problem/problem.hpp"

namespace arcslip::problems {

/// A point of the curve, both residuals with all their derivatives.
struct RidgePoint {
  double log_R;                ///< ln R
  double log_Y;                ///< ln Y
  Eigen::Vector2d values;      ///< g, h
  Eigen::Matrix2d by_place;    ///< d(g, h)/d(w, eta)
  Eigen::Vector2d by_preload;  ///< d(g, h)/dP

  /// Of a point of the curve, negative where it is a maximum of Y over eta: d h/d eta along the response, in
  /// [-1, 1] and next to 0 where maxima and minima meet.
  double bend() const {
    const double rows = by_place.row(0).norm() * by_place.row(1).norm();
    return (by_place(0, 0) * by_place(1, 1) - by_place(0, 1) * by_place(1, 0)) / rows;
  }
};

/// Anywhere in slip, w > 0; of a point that is not on the curve the values tell by how much.
RidgePoint ridge_point(const FrictionSystem& system, double w, double eta, double preload);

/// `adapt` sets the problem's only state, the unit of h: one instance serves one thread.
class PeakRidge : public continuation::Problem {
 public:
  /// Positions of w and eta.
  enum Unknown : Index { root_of_log_ratio, eta };

  /// The system is kept by reference.
  explicit PeakRidge(const FrictionSystem& system) : system_(system) {}

  Index size() const override { return 2; }
  std::vector<std::string> parameter_names() const override { return {"P"}; }
  [[nodiscard]] bool evaluate(const Vector& u, const Vector& p, const continuation::Regime& regime,
                              const continuation::Evaluation& out) const override;
  void scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const override;

  std::string describe(const continuation::Regime& /*regime*/) const override { return "slip"; }
  int border_count(const continuation::Regime& /*regime*/) const override { return 1; }
  double border(const Vector& u, const Vector& p, const continuation::Regime& regime, int border,
                continuation::Gradient* gradient) const override;
  std::optional<continuation::Regime> regime_beyond(const continuation::Regime& /*regime*/,
                                                    int /*border*/) const override {
    return {};
  }

  /// Makes h a relative distance in the unknowns around this point.
  void adapt(const Vector& u, const Vector& p);

 private:
  const FrictionSystem& system_;
  double steepness_ = 1;
};

/// Newton's method for the point of the curve at a preload, from an estimate. False where it does not
/// converge.
[[nodiscard]] bool solve_ridge(const FrictionSystem& system, double preload, double& w, double& eta);

}  // namespace arcslip::problems
