#pragma once

// Curves of special points in two parameters, as problems that the same engine traces. A problem F(u, p) = 0
// with active parameter p_a is extended by m conditions and m - 1 further unknowns e:
//
//   F(u, p) + e_0 b = 0      (the second term only where there is such a column)
//   g(u, p, e)      = 0      m conditions
//
// in the unknowns (u, p_a, e). All other parameters stay parameters: with one of them free the solutions
// are a curve, with none the special point itself is located by Newton's method.

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "arcslip/continuation/linear/bordered_solver.hpp"
#include "arcslip/continuation/problem/linearization.hpp"
#include "arcslip/continuation/problem/problem.hpp"

namespace arcslip::continuation {

/// A point of the problem that is extended.
struct BasePoint {
  Vector unknowns;    ///< n
  Vector parameters;  ///< all of the base problem's
  Regime regime;      ///< of the base
  Vector extras;      ///< m - 1
};

/// Conditions on the Jacobian are taken in bordered form [Griewank & Reddien 1984, Govaerts 2000]: the
/// borders are chosen by `adapt` and are the problem's only state, so that one instance serves one thread.
class ExtendedProblem : public Problem {
 public:
  /// `active` is the base's parameter that becomes an unknown. The base is kept by reference.
  ExtendedProblem(const Problem& base, Index active, Index conditions);

  /// The problem that is extended, and the position of the parameter that became an unknown.
  const Problem& base() const { return base_; }
  Index active() const { return active_; }

  /// A point of the extended problem as one of the base.
  BasePoint split(const Vector& unknowns, const Vector& parameters, const Regime& regime) const;
  /// The inverse: unknowns and parameters of the extended problem.
  void join(const BasePoint& point, Vector& unknowns, Vector& parameters) const;

  /// Chooses borders for points around this one; once before the first evaluation, and again as a curve is
  /// followed. The solutions do not depend on it. False where the problem has no value.
  [[nodiscard]] virtual bool adapt(const BasePoint& point);

  /// Chooses them at this point and evaluates there, so that null vectors are at hand.
  [[nodiscard]] bool settle(const BasePoint& point);

  /// Does so where the borders that there are have come to fit badly, at a point of a curve next to the last
  /// evaluation.
  [[nodiscard]] bool follow(const BasePoint& point);

  /// The observable of the base whose extrema the solutions are, if they are extrema.
  virtual std::optional<Index> extremum_of() const { return std::nullopt; }

  /// The types of points at which a curve of these ends.
  virtual std::vector<PointType> last_of_curve() const { return {}; }

  /// Of the base so far, with its derivatives.
  long evaluations() const { return at_.evaluations() + own_evaluations(); }

  /// What `adapt` has chosen, as numbers that a checkpoint holds, and the same put back; the latter throws
  /// std::invalid_argument if these are of another problem.
  std::vector<double> borders();
  void set_borders(const std::vector<double>& numbers);

  Index size() const override { return base_.size() + conditions_; }
  std::vector<std::string> parameter_names() const override;
  bool sparse() const override { return base_.sparse(); }
  Determinants determinants() const override {
    const bool own = base_.determinants() == Determinants::in_own_units;
    return own ? Determinants::in_own_units : Determinants::in_scale;
  }
  long revision() const override { return revision_; }
  [[nodiscard]] bool evaluate(const Vector& u, const Vector& p, const Regime& regime,
                              const Evaluation& out) const override;
  void scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const override;

  Index switch_count() const override { return base_.switch_count(); }
  std::string describe(const Regime& regime) const override { return base_.describe(regime); }
  int border_count(const Regime& regime) const override { return base_.border_count(regime); }
  double border(const Vector& u, const Vector& p, const Regime& regime, int border,
                Gradient* gradient) const override;
  std::optional<Regime> regime_beyond(const Regime& /*regime*/, int /*border*/) const override { return {}; }

  /// Of the base: the others are made of these.
  [[nodiscard]] std::optional<std::string> wrong_derivative(const Vector& u, const Vector& p,
                                                            const Regime& regime, Index parameter,
                                                            const std::vector<Index>& tracked) const override;

  /// The active parameter, then the base's observables, each with its gradient if it has one there.
  std::vector<Observable> observables() const override;
  void observe(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const override;
  double observe(const Vector& u, const Vector& p, const Regime& regime, Index which,
                 Gradient& gradient) const override;

 protected:
  /// Values of the conditions at a point where F has just been evaluated into `at_`, and where `gradients` is
  /// not null their gradients, m x (n + number of base parameters + extras).
  [[nodiscard]] virtual bool conditions(const BasePoint& point, Vector& values, Matrix* gradients) const = 0;

  /// Calls `use` with each list of numbers that `adapt` chooses: where it begins, and how many they are.
  virtual void each_border(const std::function<void(double*, Index)>& use);

  /// By how much the null vectors last found are longer than with the best borders, times 1 or more.
  virtual double strain() const { return 1; }

  /// Of the base by the conditions themselves.
  virtual long own_evaluations() const { return 0; }

  /// The steepest condition's slope over (u, p_a) in the base's scale, at least 1: divided by it a condition
  /// is as good as a distance from the special point, be the base as sharply bent as it may.
  double steepness(const BasePoint& point);
  double last_steepness(const BasePoint& point) const;

  mutable Linearization at_;  ///< of the base, at the point last evaluated
  Vector scale_;              ///< n, of the base's unknowns where the borders were chosen
  Vector unfolding_;          ///< the column b of e_0, or empty

 private:
  void fill_dense(const Matrix& gradients, Matrix& out) const;
  void fill_sparse(const Matrix& gradients, SparseMatrix& out) const;
  void fill_parameters(const Matrix& gradients, Matrix& out) const;
  void take_gradient(Gradient& out) const;  // from of_base_

  const Problem& base_;
  Index active_;
  Index conditions_;
  mutable Vector values_;
  mutable Matrix gradients_;
  mutable Gradient of_base_;
  long revision_ = 0;                   // of the borders
  double active_observable_scale_ = 0;  // of the active parameter where it vanishes
};

}  // namespace arcslip::continuation
