#pragma once

// One equation f(u, p) = 0 in one unknown and any parameters, given as functions.

#include <functional>
#include <string>
#include <vector>

#include "branches.hpp"

namespace arcslip::testing {

class ScalarProblem : public continuation::Problem {
 public:
  using Function = std::function<double(double u, const Vector& p)>;

  ScalarProblem(std::vector<std::string> parameters, Function f, Function by_unknown,
                std::vector<Function> by_parameters)
      : names_(std::move(parameters)),
        f_(std::move(f)),
        by_unknown_(std::move(by_unknown)),
        by_parameters_(std::move(by_parameters)) {}

  Index size() const override { return 1; }
  std::vector<std::string> parameter_names() const override { return names_; }
  bool evaluate(const Vector& u, const Vector& p, const continuation::Regime& /*regime*/,
                const continuation::Evaluation& out) const override {
    if (out.residual != nullptr) (*out.residual)(0) = f_(u(0), p);
    if (out.jacobian != nullptr) (*out.jacobian)(0, 0) = by_unknown_(u(0), p);
    for (std::size_t k = 0; out.parameter_jacobian != nullptr && k < names_.size(); ++k)
      (*out.parameter_jacobian)(0, static_cast<Index>(k)) = by_parameters_[k](u(0), p);
    return true;
  }
  std::vector<continuation::Observable> observables() const override { return {{"u", true}}; }
  void observe(const Vector& u, const Vector& /*p*/, const continuation::Regime& /*regime*/,
               Vector& values) const override {
    values = u;
  }
  double observe(const Vector& u, const Vector& /*p*/, const continuation::Regime& /*regime*/,
                 Index /*which*/, continuation::Gradient& gradient) const override {
    gradient.unknowns(0) = 1;
    gradient.parameters.setZero();
    return u(0);
  }

 private:
  std::vector<std::string> names_;
  Function f_;
  Function by_unknown_;
  std::vector<Function> by_parameters_;
};

/// slope x = p, under the given name of p.
inline ScalarProblem line(const std::string& parameter, double slope) {
  return {{parameter},
          [=](double x, const Vector& p) { return slope * x - p(0); },
          [=](double, const Vector&) { return slope; },
          {[](double, const Vector&) { return -1.0; }}};
}

inline Vector vector_of(std::initializer_list<double> values) {
  Vector v(static_cast<Index>(values.size()));
  std::copy(values.begin(), values.end(), v.begin());
  return v;
}

}  // namespace arcslip::testing
