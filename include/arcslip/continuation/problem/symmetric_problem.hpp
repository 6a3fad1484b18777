#pragma once

// A problem among the unknowns that have some of its symmetries: with P the mean over these,
//
//   P F(P u, p) + (u - P u)/d = 0,
//
// d a typical magnitude. Its solutions are those of F = 0 with P u = u, which no step leaves. Where a
// solution would lose one of these symmetries the Jacobian of F is singular, and this one is not: there the
// determinant of dF/du on a space that it maps to itself vanishes, a function along the branch that is
// regular, see symmetry_group.hpp. The zeros of these tests are `branch_point` points; behind those of the
// problem itself.

#include <memory>

#include "arcslip/continuation/problem/problem.hpp"
#include "arcslip/continuation/problem/symmetry_group.hpp"

namespace arcslip::continuation {

/// Unknowns, parameters, regimes and observables are the problem's own.
class SymmetricProblem final : public Problem {
 public:
  /// The problem, which is not sparse, is kept by reference; `kept` are the symmetries that solutions have,
  /// `size` is d. A solution has a symmetry if it is that good to `tolerance` of each unknown's scale. Throws
  /// std::invalid_argument for a sparse problem.
  SymmetricProblem(const Problem& whole, std::shared_ptr<const SymmetryGroup> group, Subgroup kept,
                   double size, double tolerance);

  const Subgroup& kept() const { return kept_; }
  const SymmetryGroup& group() const { return *group_; }
  /// In which ways its solutions may lose symmetries: one for each test.
  const std::vector<Breaking>& breakings() const { return breakings_; }

  /// P u.
  Vector symmetric(const Vector& u) const { return mean_ * u; }

  /// Which of the breakings happen at a solution: those in which dF/du is singular to `tolerance`. None where
  /// it has more symmetries, and where there is no value.
  std::vector<std::size_t> broken(const Vector& u, const Vector& p, const Regime& regime,
                                  double tolerance) const;

  Index size() const override { return whole_.size(); }
  std::vector<std::string> parameter_names() const override { return whole_.parameter_names(); }
  [[nodiscard]] bool evaluate(const Vector& u, const Vector& p, const Regime& regime,
                              const Evaluation& out) const override;
  [[nodiscard]] bool second(const Vector& u, const Vector& p, const Regime& regime, const Vector& w,
                            const Vector& du, const Vector& dp, Vector& out) const override;
  long revision() const override { return whole_.revision(); }
  bool is_equilibrium() const override { return whole_.is_equilibrium(); }
  [[nodiscard]] bool eigenvalues(const Vector& u, const Vector& p, const Regime& regime,
                                 ComplexVector& values) const override {
    return whole_.eigenvalues(u, p, regime, values);
  }
  PointType pair_crossing() const override { return whole_.pair_crossing(); }
  PointType real_crossing() const override { return whole_.real_crossing(); }
  std::vector<PointType> test_types() const override;
  void test(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const override;
  void scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const override {
    whole_.scale(u, p, unknowns, parameters);
  }
  Index switch_count() const override { return whole_.switch_count(); }
  std::string describe(const Regime& regime) const override { return whole_.describe(regime); }
  int border_count(const Regime& regime) const override { return whole_.border_count(regime); }
  double border(const Vector& u, const Vector& p, const Regime& regime, int border,
                Gradient* gradient) const override {
    return whole_.border(u, p, regime, border, gradient);
  }
  [[nodiscard]] std::optional<Regime> regime_beyond(const Regime& regime, int border) const override {
    return whole_.regime_beyond(regime, border);
  }
  std::string reason_of_end() const override { return whole_.reason_of_end(); }
  std::vector<Observable> observables() const override { return whole_.observables(); }
  void observe(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const override {
    whole_.observe(u, p, regime, values);
  }
  void observe_quickly(const Vector& u, const Vector& p, const Regime& regime,
                       Vector& values) const override {
    whole_.observe_quickly(u, p, regime, values);
  }
  double observe(const Vector& u, const Vector& p, const Regime& regime, Index which,
                 Gradient& gradient) const override {
    return whole_.observe(u, p, regime, which, gradient);
  }
  [[nodiscard]] std::optional<std::string> wrong_derivative(
      const Vector& u, const Vector& p, const Regime& regime, Index parameter,
      const std::vector<Index>& tracked) const override {
    return whole_.wrong_derivative(u, p, regime, parameter, tracked);
  }
  std::vector<Symmetry> symmetries() const override { return whole_.symmetries(); }
  std::vector<double> landmarks(Index parameter, double from, double to) const override {
    return whole_.landmarks(parameter, from, to);
  }

 private:
  bool has_more(const Vector& u, const Vector& p) const;

  const Problem& whole_;
  std::shared_ptr<const SymmetryGroup> group_;
  Subgroup kept_;
  double size_;
  double tolerance_;
  SparseMatrix mean_;  // P
  Matrix complement_;  // (1 - P)/d
  std::vector<Breaking> breakings_;
};

}  // namespace arcslip::continuation
