#pragma once

// A problem whose pieces join with one derivative, F and dF/du being the same on both sides of every border,
// taken as a single piece: the regime of a point follows from its unknowns, and a branch passes borders as
// it finds them, without a point on each. Where dozens of switches change state one after the other, this
// takes a fraction of the steps; what is lost is where they do.

#include <memory>

#include "arcslip/continuation/problem/problem.hpp"

namespace arcslip::continuation {

/// The regime in which a point crosses no border, looked for from `start` on. Where none is found within as
/// many rounds as there are switches, the last one that was tried.
Regime regime_at(const Problem& problem, const Vector& u, const Vector& p, Regime start = {});

/// Its unknowns, parameters and observables are those of the problem that it is made of. The regimes
/// that it is given are where the search for a point's own one begins.
class OnePiece final : public Problem {
 public:
  /// Throws std::invalid_argument without a problem.
  explicit OnePiece(std::shared_ptr<const Problem> pieces);

  Index size() const override { return pieces_->size(); }
  std::vector<std::string> parameter_names() const override { return pieces_->parameter_names(); }
  [[nodiscard]] bool evaluate(const Vector& u, const Vector& p, const Regime& regime,
                              const Evaluation& out) const override {
    return pieces_->evaluate(u, p, regime_at(*pieces_, u, p, regime), out);
  }
  [[nodiscard]] bool second(const Vector& u, const Vector& p, const Regime& regime, const Vector& w,
                            const Vector& du, const Vector& dp, Vector& out) const override {
    return pieces_->second(u, p, regime_at(*pieces_, u, p, regime), w, du, dp, out);
  }
  bool sparse() const override { return pieces_->sparse(); }
  std::unique_ptr<CondensedJacobian> condensed_jacobian() const override {
    return pieces_->condensed_jacobian();
  }
  long revision() const override { return pieces_->revision(); }
  void scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const override {
    pieces_->scale(u, p, unknowns, parameters);
  }
  std::string reason_of_end() const override { return pieces_->reason_of_end(); }
  std::vector<Observable> observables() const override { return pieces_->observables(); }
  void observe(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const override {
    pieces_->observe(u, p, regime_at(*pieces_, u, p, regime), values);
  }
  double observe(const Vector& u, const Vector& p, const Regime& regime, Index which,
                 Gradient& gradient) const override {
    return pieces_->observe(u, p, regime_at(*pieces_, u, p, regime), which, gradient);
  }
  std::vector<Symmetry> symmetries() const override { return pieces_->symmetries(); }
  std::vector<double> landmarks(Index parameter, double from, double to) const override {
    return pieces_->landmarks(parameter, from, to);
  }

 private:
  std::shared_ptr<const Problem> pieces_;
};

}  // namespace arcslip::continuation
