#pragma once

// The problems that the engine traces: F(u, p) = 0 with n unknowns u and named parameters p, smooth within
// each of its regimes. A regime ends where one of its border functions, negative inside, reaches zero.

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "arcslip/continuation/linear/condensed_jacobian.hpp"
#include "arcslip/continuation/linear/factored_jacobian.hpp"
#include "arcslip/continuation/points/point_type.hpp"
#include "arcslip/continuation/problem/regime.hpp"
#include "arcslip/continuation/problem/symmetry.hpp"
#include "arcslip/types.hpp"

namespace arcslip::continuation {

/// What `Problem::evaluate` is asked for; a null is not wanted. Every target comes with its size.
struct Evaluation {
  Vector* residual = nullptr;               ///< F, n, scaled by the problem so that 1 is large
  Matrix* jacobian = nullptr;               ///< dF/du, n x n, of a problem that is not sparse
  Matrix* parameter_jacobian = nullptr;     ///< dF/dp, n x (number of parameters)
  SparseMatrix* sparse_jacobian = nullptr;  ///< dF/du of a sparse problem, compressed, always of one pattern
  CondensedJacobian* condensed_jacobian = nullptr;  ///< what the problem has made, in place of `jacobian`
};

/// What determinants of a problem's Jacobian are told in, so that they change little beside what vanishes: of
/// many unknowns each factor counts as often as there are these.
enum class Determinants {
  in_scale,      ///< the unknowns in their scale at each point: of rows that grow with these
  in_own_units,  ///< the unknowns as they are: of rows that do not
  over_rows      ///< over the lengths of rows: where a parameter multiplies many equations at once
};

/// A scalar function of (u, p) with its exact gradient.
struct Gradient {
  Vector unknowns;    ///< n
  Vector parameters;  ///< number of parameters
  Index piece = 0;    ///< of the greatest of several functions, which: it has corners between these
};

/// How fast the function changes as u and one parameter do (n + 1 entries).
inline double rate(const Gradient& gradient, Index parameter, const Vector& change) {
  const Index n = change.size() - 1;
  return gradient.unknowns.dot(change.head(n)) + gradient.parameters(parameter) * change(n);
}

/// The same of a direction in units of a scale.
inline double rate(const Gradient& gradient, Index parameter, const Vector& scale, const Vector& direction) {
  const Index n = direction.size() - 1;
  return gradient.unknowns.dot(scale.head(n).cwiseProduct(direction.head(n))) +
         gradient.parameters(parameter) * scale(n) * direction(n);
}

/// An observable of which the tracer may find the extrema.
struct Observable {
  std::string name;           ///< as TraceOptions::extrema_of and tables have it
  bool has_gradient = false;  ///< without it its extrema are not looked for
  double scale = 0;           ///< changes are measured in its value, or in this where that is smaller
  double period = 0;          ///< values that differ by it are the same, as of an angle; 0 if none do

  /// A value, or the one that is the same and nearest to another.
  double near(double value, double other) const {
    return period > 0 ? other + std::remainder(value - other, period) : value;
  }
};

class ExtendedProblem;
struct Guess;

/// Only the first three have to be written. All are called from several threads and must not change the
/// problem.
class Problem {
 public:
  virtual ~Problem() = default;

  /// n, the number of unknowns and of equations.
  virtual Index size() const = 0;

  /// One for each parameter, in the order in which `p` holds them.
  virtual std::vector<std::string> parameter_names() const = 0;

  /// Fills what is asked for, with exact derivatives. False where the problem has no value, which shortens
  /// the step.
  [[nodiscard]] virtual bool evaluate(const Vector& u, const Vector& p, const Regime& regime,
                                      const Evaluation& out) const = 0;

  /// F of a smooth problem and where they are not null its derivatives at several places, the columns of u,
  /// side by side: n x places, n x (n places) and n x (number of parameters times places). False where it has
  /// no value at one of them, or no faster way than `evaluate`.
  [[nodiscard]] virtual bool evaluate_columns(const Matrix& /*u*/, const Vector& /*p*/, Matrix* /*values*/,
                                              Matrix* /*by_unknowns*/, Matrix* /*by_parameters*/) const {
    return false;
  }

  /// Second derivatives of F along one direction, contracted from the left,
  ///
  ///   w^T d/dh [dF/du  dF/dp](u + h du, p + h dp)  at h = 0,
  ///
  /// n entries for the unknowns, then one for each parameter. False where the problem does not give them:
  /// then differences of `evaluate` take their place, at the price of six evaluations or more.
  [[nodiscard]] virtual bool second(const Vector& u, const Vector& p, const Regime& regime, const Vector& w,
                                    const Vector& du, const Vector& dp, Vector& out) const;

  /// F along a curve u(h) at fixed parameters, as the coefficients of series in h: those of u in the columns
  /// of `u`, n x (highest order + 1), those of F in as many of `out`. False where the problem does not give
  /// them, or none of this order: then differences of `evaluate` take their place.
  [[nodiscard]] virtual bool series(const Matrix& /*u*/, const Vector& /*p*/, const Regime& /*regime*/,
                                    Matrix& /*out*/) const {
    return false;
  }

  /// Whether `evaluate` fills `sparse_jacobian` in place of `jacobian`.
  virtual bool sparse() const { return false; }

  /// What `evaluate` fills where it is asked to, in place of `jacobian`: of large problems that are linear
  /// but for few unknowns; else null.
  virtual std::unique_ptr<CondensedJacobian> condensed_jacobian() const { return nullptr; }

  /// Counts how often F was scaled anew, which changes its values and leaves its zeros.
  virtual long revision() const { return 0; }

  /// Whether F is the right-hand side of u' = F(u, p), so that eigenvalues of dF/du tell stability and pairs
  /// of them that cross the imaginary axis are Hopf points.
  virtual bool is_equilibrium() const { return false; }

  /// By what determinants are compared along a branch.
  virtual Determinants determinants() const {
    return sparse() && is_equilibrium() ? Determinants::over_rows : Determinants::in_scale;
  }

  /// Whether F(u, p) + u is a map of which the solutions are fixed points. One that is not sparse has by this
  /// alone its stability, its special points and their curves.
  virtual bool is_map() const { return false; }

  /// Whether multipliers of one round tell stability: of maps, and of cycles on a mesh.
  virtual bool has_multipliers() const { return is_map(); }

  /// The eigenvalues that tell stability at (u, p), in any order; false where there are none. The default
  /// takes those of an equilibrium's Jacobian, of a sparse one beyond 200 unknowns the 20 nearest to 0, and
  /// of a map ln mu or, where mu < 0 is real, ln -mu, for each multiplier mu: zero at mu = 1 and at mu = -1.
  /// A periodic solution has the rates of hill.hpp.
  [[nodiscard]] virtual bool eigenvalues(const Vector& u, const Vector& p, const Regime& regime,
                                         ComplexVector& values) const;

  /// What a pair of these that crosses the imaginary axis is called.
  virtual PointType pair_crossing() const { return is_map() ? PointType::neimark_sacker : PointType::hopf; }

  /// What a real one that crosses zero is called; regular where it has no name of its own, as at folds and
  /// branch points, which are found without eigenvalues.
  virtual PointType real_crossing() const { return PointType::regular; }

  /// What a point is called at which the parameter turns smoothly.
  virtual PointType turn(const Vector& /*u*/, const Vector& /*p*/, const Regime& /*regime*/) const {
    return PointType::fold;
  }

  /// Functions along a branch whose zeros are special points: the types of these points. The default has, of
  /// maps, period doublings, where det(2 + dF/du) vanishes.
  virtual std::vector<PointType> test_types() const;
  /// Fills the values of these functions, one for each type.
  virtual void test(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const;

  /// Told before `test` and `eigenvalues` are asked for at (u, p), where dF/du of a sparse problem is at hand
  /// there: what they take from it can be found now.
  virtual void take_jacobian(const Vector& /*u*/, const Vector& /*p*/, const Regime& /*regime*/,
                             const FactoredJacobian& /*jacobian*/) const {}

  /// Typical magnitudes at (u, p), all positive, in which steps and errors are measured: a parameter that
  /// spans decades gives its own value. The default is the value itself, or 1 where that is larger.
  virtual void scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const;

  /// Whether dF/du is regular wherever F = 0 in this regime: a branch has no folds and no branch points
  /// there, and none are looked for.
  virtual bool is_regular(const Regime& /*regime*/) const { return false; }

  /// Whether F is linear in u besides: the steps of a branch are then as long as what is watched on it lets
  /// them be, however steep its unknowns are.
  virtual bool is_linear(const Regime& /*regime*/) const { return false; }

  /// How many switches a regime has, each with a state: the pieces are the patterns of these states, which
  /// nobody lists. A switch that is not there is in state 0.
  virtual Index switch_count() const { return 0; }

  /// What a regime is called.
  virtual std::string describe(const Regime& regime) const;

  /// How many borders a regime has; the others are numbered from 0 to one less.
  virtual int border_count(const Regime& regime) const;

  /// Value of a border function, negative inside `regime`, and its gradient where that is not null.
  virtual double border(const Vector& u, const Vector& p, const Regime& regime, int border,
                        Gradient* gradient) const;

  /// The regime that a branch enters across this border; none where the branch ends on it.
  [[nodiscard]] virtual std::optional<Regime> regime_beyond(const Regime& regime, int border) const;

  /// Why a branch may end on a border or where there is no value, as a clause; empty where nothing is known.
  virtual std::string reason_of_end() const { return {}; }

  /// What is written beside each point, besides u and p.
  virtual std::vector<Observable> observables() const { return {}; }

  /// All of them, in the order of `observables()`.
  virtual void observe(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const;

  /// The same for pictures, with NaN for what takes long.
  virtual void observe_quickly(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const {
    observe(u, p, regime, values);
  }

  /// The value of one with has_gradient, and its gradient on the branch.
  virtual double observe(const Vector& u, const Vector& p, const Regime& regime, Index which,
                         Gradient& gradient) const;

  /// What derivative a branch over this parameter relies on that is not that of its function, in words; none
  /// if none was found at this point. `tracked` are the observables whose extrema are looked for.
  [[nodiscard]] virtual std::optional<std::string> wrong_derivative(const Vector& u, const Vector& p,
                                                                    const Regime& regime, Index parameter,
                                                                    const std::vector<Index>& tracked) const;

  /// The conditions on special points of a type that this problem has of its own, with `active` as an
  /// unknown, for a point like `at`: sets the extras that they begin with. Null where there are none. The
  /// default has, of maps, those on period doublings and Neimark-Sacker points.
  virtual std::unique_ptr<ExtendedProblem> special(PointType type, Index active, const Guess& at,
                                                   Vector& extras) const;

  /// Its symmetries but for the identity, at all parameters: a group.
  virtual std::vector<Symmetry> symmetries() const { return {}; }

  /// Values of a parameter between `from` and `to` where the branch may have a feature narrower than any
  /// step. The tracer puts a point on each and refines towards it.
  virtual std::vector<double> landmarks(Index parameter, double from, double to) const;
};

/// The names of a problem's observables, in their order.
std::vector<std::string> observable_names(const Problem& problem);

/// The first border of its regime that a point lies beyond by more than `tolerance`; -1 if there is none.
[[nodiscard]] int crossed_border(const Problem& problem, const Vector& u, const Vector& p,
                                 const Regime& regime, double tolerance);

/// Position of a name in `names`; throws std::invalid_argument that lists what there is.
Index index_of(const std::vector<std::string>& names, const std::string& name);

}  // namespace arcslip::continuation
