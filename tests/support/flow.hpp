#pragma once

// Systems u' = f(u, p) for tests, written once: derivatives come by automatic differentiation.

#include <memory>
#include <stdexcept>
#include <string>
#include <unsupported/Eigen/AutoDiff>
#include <utility>
#include <vector>

#include "arcslip/continuation/problem/problem.hpp"

namespace arcslip::testing {

/// A number with its derivatives by at most 8 others, which take no allocation.
constexpr Index most_derivatives = 8;
using Differentiated =
    Eigen::AutoDiffScalar<Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_derivatives, 1>>;

/// `f(u, p, out)` for vectors of any number type.
template <class F>
class Flow : public continuation::Problem {
 public:
  Flow(Index size, std::vector<std::string> parameters, F f)
      : size_(size), parameters_(std::move(parameters)), f_(std::move(f)) {
    if (size_ + std::ssize(parameters_) > most_derivatives) throw std::logic_error("Flow: too many numbers");
  }

  Index size() const override { return size_; }
  std::vector<std::string> parameter_names() const override { return parameters_; }
  bool is_equilibrium() const override { return true; }

  [[nodiscard]] bool evaluate(const Vector& u, const Vector& p, const continuation::Regime& /*regime*/,
                              const continuation::Evaluation& out) const override {
    using Number = Differentiated;
    const Index count = u.size() + p.size();
    std::vector<Number> unknowns;
    std::vector<Number> parameters;
    for (Index i = 0; i < u.size(); ++i) unknowns.emplace_back(u(i), count, i);
    for (Index i = 0; i < p.size(); ++i) parameters.emplace_back(p(i), count, u.size() + i);
    std::vector<Number> values(static_cast<std::size_t>(size_), Number(0.0, Number::DerType::Zero(count)));
    f_(unknowns, parameters, values);
    for (Index i = 0; i < size_; ++i) {
      const Number& value = values[static_cast<std::size_t>(i)];
      if (out.residual != nullptr) (*out.residual)(i) = value.value();
      if (out.jacobian != nullptr) out.jacobian->row(i) = value.derivatives().head(u.size()).transpose();
      if (out.parameter_jacobian != nullptr)
        out.parameter_jacobian->row(i) = value.derivatives().tail(p.size()).transpose();
    }
    return true;
  }

 private:
  Index size_;
  std::vector<std::string> parameters_;
  F f_;
};

template <class F>
std::shared_ptr<const continuation::Problem> make_flow(Index size, std::vector<std::string> parameters, F f) {
  return std::make_shared<Flow<F>>(size, std::move(parameters), std::move(f));
}

}  // namespace arcslip::testing
