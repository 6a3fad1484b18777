#pragma once

// What small disturbances dx of a periodic motion meet in an element over a turn, a whole period or, of odd
// responses, half of one: linear laws, one after the other,
//
//   df = K dx + C d(dx)/dtau + sum_j h_j m_j + k(theta) dx + h(theta) m_r,   theta = eta tau,
//
// with memories m_j = a_j dx + sum_l b_jl m_l that are set at one phase and kept for a while, and m_r, which
// may move on meanwhile, dm_r/dtheta = a(theta) dx + b(theta) m_r. Where a piece ends with the motion, its
// force is continuous or turns back there, so that the end's own change adds nothing.

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "arcslip/elements/varying_stiffness.hpp"

namespace arcslip {

/// k, h, a and b within one piece.
struct VaryingLaw {
  /// Which of them: the row of a coordinate's force or, behind these, of dm_r/dtheta; by the column of a
  /// coordinate or, behind these, of m_r. The latter two count where there is such a memory.
  struct Place {
    Index row;
    Index column;
  };
  std::vector<Place> places;
  /// Column i: t_m, m = 0, 1, ..., of what is at places[i] for theta + width s, sum_m t_m s^m.
  std::function<Matrix(double theta, double width)> terms;
  double bound;  ///< what |k| does not exceed
  double rate;   ///< of e^{j rate theta}, as which it varies at most
  double pace;   ///< what |b| does not exceed; of a memory that rests 0
};

/// The laws over a turn.
struct DisturbedLaw {
  /// A number that is kept.
  struct Memory {
    double begin;                                   ///< theta at which it is set
    double width;                                   ///< theta for which it is kept, at most a turn
    Vector set;                                     ///< a, of the coordinates
    std::vector<std::pair<Index, double>> of = {};  ///< memories with their b, which are kept there
    /// What it is at theta, of the coordinates, after motions that stay, where that is not seen from `set`
    /// and `of`.
    std::function<Vector(double theta)> rest = {};
  };
  /// An arc.
  struct Piece {
    double begin;                                     ///< theta
    double width;                                     ///< the same
    Matrix stiffness;                                 ///< K
    std::vector<std::pair<Index, Vector>> held = {};  ///< memories, with the force of each
    std::shared_ptr<const VaryingLaw> varying = {};   ///< what varies with theta
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

/// A force k (dx - m_r) of one coordinate with a slope that is told at each theta, interpolated: exact to
/// 1e-12 where it varies as `rate` says.
VaryingLaw interpolated_slope(std::function<double(double theta)> at, double bound, double rate);

/// What is told at each theta, a number for each of the places, interpolated between 12 points of a step.
std::function<Matrix(double theta, double width)> interpolated(std::function<Vector(double theta)> at);

/// Whether that is exact to 1e-8 of its greatest value.
bool is_resolved(const std::function<Vector(double theta)>& at, double theta, double width);

}  // namespace arcslip
