#pragma once

// What small disturbances dx of a periodic motion meet in an element over a turn, a whole period or, of odd
// responses, half of one: linear laws, one after the other,
//
//   df = K dx + C d(dx)/dtau + sum_j h_j m_j + k(theta) (dx - m_r),   theta = eta tau,
//
// with memories m_j = a_j dx + sum_l b_jl m_l that are set at one phase and kept for a while. Where a piece
// ends with the motion, its force is continuous or turns back there, so that the end's own change adds
// nothing.

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "arcslip/elements/varying_stiffness.hpp"

namespace arcslip {

/// k(theta) within one piece.
struct VaryingSlope {
  /// t_m, m = 0, 1, ..., of k(theta + width s) = sum_m t_m s^m.
  std::function<Vector(double theta, double width)> terms;
  double bound;  ///< what |k| does not exceed
  double rate;   ///< of e^{j rate theta}, as which it varies at most
};

/// The laws over a turn.
struct DisturbedLaw {
  /// A number that is kept.
  struct Memory {
    double begin;                                   ///< theta at which it is set
    double width;                                   ///< theta for which it is kept, at most a turn
    Vector set;                                     ///< a, of the coordinates
    std::vector<std::pair<Index, double>> of = {};  ///< other memories with their b, which are kept there
  };
  /// An arc.
  struct Piece {
    double begin;                                     ///< theta
    double width;                                     ///< the same
    Matrix stiffness;                                 ///< K
    std::vector<std::pair<Index, Vector>> held = {};  ///< memories, with the force of each
    std::shared_ptr<const VaryingSlope> slope = {};   ///< k, of an element of one coordinate
    Index from = -1;                                  ///< the memory m_r, if there is one
  };

  Index coordinates = 1;           ///< how many
  std::vector<Piece> pieces = {};  ///< one after the other; a single one may hold all the time
  std::vector<Memory> memories = {};
  double viscous = 0;  ///< C, at all times, of an element of one coordinate

  /// df = K dx at all times.
  static DisturbedLaw constant(const Matrix& stiffness);

  /// Adds an arc on which the slope is Re sum_n k_n e^{jn theta}.
  void add_slope(double begin, double width, const std::vector<Complex>& harmonics);

  /// By a factor on the force.
  void scale(double factor);
};

/// That of a smooth element of an odd response, over half a period.
DisturbedLaw law_of(const VaryingStiffness& stiffness);

/// A slope that is told at each theta, interpolated: exact to 1e-12 where it varies as `rate` says.
VaryingSlope interpolated_slope(std::function<double(double theta)> at, double bound, double rate);

}  // namespace arcslip
