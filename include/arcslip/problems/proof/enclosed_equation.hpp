#pragma once

// The equation of ForcedResponse with interval arithmetic, in the plane of one parameter q, eta or P, and
// rho = ln R:
//
//   g(q, rho) = rho + ln|1 + k phi c| - ln|y_0| = 0
//
// Along a piece of a branch from p_0 to p_1 both coordinates are linear, p = p_0 + a (p_1 - p_0) + b e, where
// e is the unit vector of rho or that of q: a tilted box for a in [0, 1], |b| <= w. There
//
//   g(a, b) in g(1/2, 0) + g_a [-1/2, 1/2] + g_b b
//
// with the ranges of the derivatives over the box. On the border R = S g is continuous and its derivatives
// are bounded; the ranges hold those of both sides, and the mean value theorem holds as it stands.

#include <optional>

#include "arcslip/interval/interval_response.hpp"
#include "arcslip/problems/response/forced_response.hpp"

namespace arcslip::problems {

/// A point of the plane.
struct PlanePoint {
  double parameter;  ///< q
  double rho;        ///< ln R
};

/// The coordinate that is proven to be a function of the other one.
enum class Axis { rho, parameter };

/// A box in which for every a there is one b with g = 0, and no other.
struct TiltedBox {
  PlanePoint from;    ///< p_0
  PlanePoint to;      ///< p_1
  Axis axis;          ///< the direction e
  double half_width;  ///< w
  double slope;       ///< |g_b| is at least this, > 0
};

/// Derivatives of g by q and rho.
struct EnclosedGradient {
  Interval parameter;  ///< by q
  Interval rho;        ///< by rho
};

/// Encloses g and its derivatives in the plane of one parameter.
class EnclosedEquation {
 public:
  /// `fixed` is the value of the parameter that stands still. The system must outlive the equation.
  EnclosedEquation(const FrictionSystem& system, ContactProblem::Parameter parameter, double fixed)
      : system_(system), parameter_(parameter), fixed_(fixed) {}

  /// g at a point. This and all below throw NoEnclosure where there is none.
  Interval residual(const PlanePoint& point) const;

  /// Ranges over the rectangle of the two.
  EnclosedGradient gradient(const Interval& q, const Interval& rho) const;

  /// The box about a piece, wide enough for the proof: g_b has one sign in it, and the interval Newton
  /// operator stays inside, |g(a, 0)/g_b| < w. None if that cannot be shown.
  std::optional<TiltedBox> certified_box(const PlanePoint& from, const PlanePoint& to, Axis axis) const;

  /// Whether Im c < 0 for all q of an interval.
  bool is_passive(const Interval& q) const;

 private:
  /// What g consists of, over a box.
  struct Terms {
    ComplexInterval compliance;    ///< c
    ComplexInterval compliance_q;  ///< dc/dq
    ComplexInterval free;          ///< y_0
    Interval log_free_q;           ///< d ln|y_0|/dq
    Interval log_threshold_q;      ///< d ln S/dq
    EnclosedCoefficient law;
  };
  /// A piece with its middle, half of its box's width and the direction of it.
  struct Piece;
  struct Derivatives {
    Interval along;   ///< g_a
    Interval across;  ///< g_b
  };

  Interval eta(const Interval& q) const { return parameter_ == ContactProblem::eta ? q : Interval(fixed_); }
  ComplexInterval compliance(const Interval& q) const;
  Terms terms(const Interval& q, const Interval& rho) const;
  Interval value(const Terms& terms, const Interval& rho) const;
  Derivatives derivatives(const Piece& piece, double half_width) const;

  const FrictionSystem& system_;
  ContactProblem::Parameter parameter_;
  double fixed_;
};

}  // namespace arcslip::problems
