#pragma once

// The kinds of points that a branch may hold.

#include <optional>
#include <string_view>

namespace arcslip::continuation {

/// All but the first three are special points, which the engine locates.
enum class PointType {
  regular,                      ///< a step's end
  start,                        ///< the first point
  end,                          ///< the point on the last value
  regime_switch,                ///< on a border, where the branch goes on in another regime
  fold,                         ///< the parameter turns back smoothly
  corner_fold,                  ///< it turns back at a corner, by a jump of the tangent
  branch_point,                 ///< another branch crosses
  hopf,                         ///< a pair of eigenvalues crosses the imaginary axis
  peak,                         ///< of a tracked observable
  trough,                       ///< of a tracked observable
  user,                         ///< a listed value of the parameter
  event,                        ///< a zero of a function of the user's
  cusp,                         ///< of a curve of folds: its quadratic coefficient vanishes
  bogdanov_takens,              ///< a double zero eigenvalue
  zero_hopf,                    ///< a zero eigenvalue beside an imaginary pair
  hopf_hopf,                    ///< two imaginary pairs
  neimark_sacker,               ///< a pair of multipliers of a periodic solution crosses the unit circle
  period_doubling,              ///< one of its multipliers passes -1
  symmetry_breaking,            ///< a real eigenvalue vanishes along which the solution would lose a symmetry
  generalized_hopf,             ///< of a curve of Hopf points: the first Lyapunov coefficient vanishes
  resonance_1_1,                ///< two multipliers are 1: on curves of folds and Neimark-Sacker points
  resonance_1_2,                ///< two are -1, on curves of period doublings, too
  resonance_1_3,                ///< the torus turns by a third in each round
  resonance_1_4,                ///< and by a quarter
  chenciner,                    ///< the coefficient that tells sub- from supercritical vanishes
  generalized_period_doubling,  ///< the same on a curve of period doublings
  fold_flip,                    ///< multipliers 1 and -1
  fold_neimark_sacker,          ///< multipliers 1 and a pair of modulus 1
  flip_neimark_sacker,          ///< multipliers -1 and a pair of modulus 1
  double_neimark_sacker,        ///< two pairs of modulus 1
  isola_centre,                 ///< of a curve of folds that turns: a closed branch shrinks to a point
  simple_bifurcation            ///< the same where two branches meet and exchange ends
};

/// Whether a parameter turns smoothly there.
constexpr bool is_turn(PointType type) {
  return type == PointType::fold || type == PointType::isola_centre || type == PointType::simple_bifurcation;
}

/// As written to files: its name; `switch` for regime_switch.
std::string_view to_string(PointType type);

/// The type of this name, or none.
std::optional<PointType> point_type(std::string_view name);

}  // namespace arcslip::continuation
