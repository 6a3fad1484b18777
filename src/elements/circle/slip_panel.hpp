#pragma once

// A piece of an arc of slip, on which the direction phi of the friction force b e^{i phi} is a polynomial:
//
//   b phi' = Im(w' e^{-i phi})
//
// at the points of Radau's quadrature, of which the last one is the piece's end. Where the parts come apart,
// b = 0, phi' has no bound and this is Im(w' e^{-i phi}) = 0, which phi tends to as a power of the way that
// is left; there phi is a polynomial of that way's logarithm. The scheme damps all that decays faster than it
// follows, and without division by b it holds up to there.

#include <Eigen/LU>
#include <array>
#include <optional>

#include "elements/circle/circle_motion.hpp"

namespace arcslip {

/// How many points a piece has.
inline constexpr Index panel_nodes = 16;
/// One value at each of them.
using PanelVector = Eigen::Matrix<double, panel_nodes, 1>;
/// Chebyshev coefficients over the panel.
using PanelCourse = Eigen::Matrix<double, panel_nodes + 1, 1>;

/// Such a piece.
struct SlipPanel {
  /// From where to where.
  struct Reach {
    double begin;                      ///< theta
    double width;                      ///< of theta
    std::optional<double> apart = {};  ///< theta to whose logarithmic distance the points keep
    Reach up_to(double part) const;    ///< a part of its points' way
  };

  Reach reach;          ///< as it was asked for
  double start;         ///< phi at the begin
  double start_slip;    ///< v there
  PanelVector pace;     ///< d theta/ds, s from 0 to 1
  PanelVector angle;    ///< theta of the points
  PanelVector phase;    ///< phi
  PanelCourse bends;    ///< of phi - start
  PanelVector turning;  ///< phi'
  PanelVector radius;   ///< b
  PanelVector slip;     ///< v = Re(w' e^{-i phi}) - b', the rate at which it slips
  PanelVector weight;   ///< of theta: integrals are sums with these
  PanelVector along;    ///< Re(w' e^{-i phi})

  /// With phi(begin) = start; none where it is not resolved to rounding, unless the width is `smallest`.
  /// `wider` becomes how many times wider it would be resolved just so.
  static std::optional<SlipPanel> solved(const CircleMotion& motion, const Reach& reach, double start,
                                         double& wider);
  static constexpr double smallest = 1e-12;  ///< of theta

  /// The same of a width at which it is resolved.
  static SlipPanel resolved(const CircleMotion& motion, const Reach& reach, double start);

  /// The greatest width whose integrals with e^{j 2H theta} are exact to rounding.
  static double widest(int highest);

  /// phi at a theta of the panel.
  double phase_at(double theta) const;

  /// Fills phi' from phi.
  void turn();

  /// Where v first falls to 0, in s; none where it does not.
  std::optional<double> stop() const;

  /// By how much of theta the end is behind where v is 0, as its slope there tells.
  double after_stop() const;

  /// What makes the changes of phi at the points of those of its start and of the equation's right-hand side.
  class Changes {
   public:
    explicit Changes(const SlipPanel& panel);  ///< of this one

    /// In place: from right-hand sides, a row for each point, and the row of the start.
    void solve(const Eigen::Ref<const Eigen::RowVectorXd>& start, Eigen::Ref<Matrix> rows) const;

   private:
    Eigen::PartialPivLU<Eigen::Matrix<double, panel_nodes, panel_nodes>> solver_;
    PanelVector by_start_;
  };

 private:
  void place();
  static SlipPanel of(const CircleMotion& motion, const Reach& reach, double start, bool& converges);
};

}  // namespace arcslip
