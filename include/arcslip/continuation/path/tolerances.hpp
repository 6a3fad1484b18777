#pragma once

// What the engine takes for the same, for zero, or for rounding. What comes of it does not hang on any of
// these: ten times more or less gives the same points of the same types (test_tolerances.cpp). Lengths and
// ratios that an algorithm sets out from stay with it, and so does rounding in a single formula.

namespace arcslip::continuation {

/// Each is bounded from below by rounding, or by how well things are located; from above by what has to be
/// told apart.
struct Tolerances {
  // Values of the parameter, in its scale.
  double same_value = 1e-10;  ///< are one: special points are located as well
  double on_target = 1e-13;   ///< is on it: a few bits
  double start_moves = 1e-8;  ///< that of a fold where a branch starts is the one asked for: root of rounding

  // Border functions, which problems scale so that 1 is large.
  double on_border = 1e-13;  ///< is on it: rounding of a few terms of order 1
  double outside = 1e-12;    ///< a start lies beyond it: corrected to rounding, times ten
  double together = 1e-8;    ///< of several borders: between the corrector's 1e-10 and what steps resolve
  double leaves = 1e-12;     ///< the rate at which a piece leaves it: more than its rounding
  double tangential = 1e-3;  ///< of a step: whether its gradient tells which way the branch crosses it
  double settled = 1e-8;  ///< what a point moves by, at most, when it is put onto it: what `together` allows
  double last_bits = 1e-12;  ///< the same of its parameter, which was solved for
  double both_sides = 1e-9;  ///< solutions on it belong to both: corrected to 1e-10

  // Places in a step, of its length.
  double one_place = 1e-12;        ///< events closer together fall on one point: rounding of places
  double located = 1e-10;          ///< a function vanishes at another event: as well as both are located
  double just_passed = 1e-7;       ///< of its change, what one is just behind a zero: the root of rounding
  double one_zero = 1e-9;          ///< zeros of one function closer together are one: its values are rounding
  double one_branch_point = 1e-9;  ///< and branch points: so close their determinant is rounding
  double off_by_rounding = 1e-7;   ///< what rounding moves a point by, next to a branch point: its root
  double nearest_look = 1e-6;      ///< from where a branch point is looked at, at the least: more than that
  double as_cusp = 1e-6;           ///< how far second derivatives may mislay a cusp
  double tiny_step = 1e-7;  ///< of the largest step: what is unlike a curve on it is rounding or a corner

  // Rates.
  double turns =
      1e-6;  ///< of a parameter at a branch point, relative: error of interpolation and differences
  double no_rate =
      1e-9;  ///< of a parameter or an observable where a branch starts or bends: rounding of tangents

  // Eigenvalues, of the largest.
  double on_axis = 1e-12;     ///< a real part that is rounding all along
  double rough = 1e-10;       ///< a real part in which rounding may show
  double significant = 1e-6;  ///< more than that by which they differ from those of the flow
  double surely_imaginary =
      1e-4;                       ///< more than rounding parts two real ones that meet by: far above its root
  double zero_eigenvalue = 1e-7;  ///< at a fold or a branch point as it is located: the root of rounding
  double coincides = 1e-8;        ///< of the way of a real part: another one is on the axis with it

  // Points and directions, in the problem's scale.
  double same_point = 1e-7;     ///< where a branch comes back to, and where others meet it: located to 1e-10
  double same_solution = 1e-6;  ///< by entries: far above what Newton's method leaves
  double same_direction =
      1e-4;  ///< between unit vectors: branches that meet at smaller angles are not told apart

  // Curves of extrema: slopes d ln|Y|/ds with s in the scale, and places on the response in the scale.
  double no_slope = 1e-10;        ///< vanishes but for rounding
  double plain_slope = 1e-8;      ///< does not, at points known to rounding, also where the response is sharp
  double same_slope = 1e-7;       ///< on both sides of a border, where one vanishes
  double touches = 1e-5;          ///< a border's rate along a branch that touches it: the root of where
  double on_extremum = 1e-10;     ///< a row lies on its extremum: points are located as well
  double beside_extremum = 1e-8;  ///< a row lies next to its own: so near there is no other
};

}  // namespace arcslip::continuation
