#pragma once

// A few unknowns that have names: what such problems share. The unknowns are their observables.

#include <string>
#include <vector>

#include "arcslip/continuation/problem/problem.hpp"

namespace arcslip::problems {

/// Derive from it and write `evaluate`.
class NamedUnknowns : public continuation::Problem {
 public:
  Index size() const override { return static_cast<Index>(unknowns_.size()); }
  std::vector<std::string> parameter_names() const override { return parameters_; }

  std::vector<continuation::Observable> observables() const override;
  void observe(const Vector& u, const Vector& p, const continuation::Regime& regime,
               Vector& values) const override;
  double observe(const Vector& u, const Vector& p, const continuation::Regime& regime, Index which,
                 continuation::Gradient& gradient) const override;

 protected:
  /// The names, in the order of u and p.
  NamedUnknowns(std::vector<std::string> unknowns, std::vector<std::string> parameters)
      : unknowns_(std::move(unknowns)), parameters_(std::move(parameters)) {}

 private:
  std::vector<std::string> unknowns_;
  std::vector<std::string> parameters_;
};

}  // namespace arcslip::problems
