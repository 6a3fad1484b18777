#include "arcslip/continuation/derivative_check.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <stdexcept>

namespace arcslip::continuation {
namespace {

using Function = std::function<Vector(const Vector& u, const Vector& p)>;

class Checker {
 public:
  Checker(const Problem& problem, const Vector& u, const Vector& p, int regime)
      : problem_(problem), u_(u), p_(p), regime_(regime), scale_u_(u.size()), scale_p_(p.size()) {
    problem.scale(u, p, scale_u_, scale_p_);
  }

  DerivativeReport run() {
    Matrix jacobian(u_.size(), u_.size());
    Matrix parameter_jacobian(u_.size(), p_.size());
    if (!problem_.evaluate(u_, p_, regime_, {nullptr, &jacobian, &parameter_jacobian})) {
      throw std::invalid_argument("check_derivatives: the problem cannot be evaluated here");
    }
    const Function residual = [this](const Vector& u, const Vector& p) {
      Vector values(u.size());
      problem_.evaluate(u, p, regime_, {&values});
      return values;
    };
    compare("F", residual, jacobian, parameter_jacobian);
    for (int b = 0; b < problem_.border_count(regime_); ++b) {
      compare_scalar(fmt::format(" border {}", b), [this, b](const Vector& u, const Vector& p, Gradient& g) {
        return problem_.border(u, p, regime_, b, &g);
      });
    }
    const std::vector<Observable> observables = problem_.observables();
    for (std::size_t i = 0; i < observables.size(); ++i) {
      if (!observables[i].has_gradient) continue;
      compare_scalar(" " + observables[i].name, [this, i](const Vector& u, const Vector& p, Gradient& g) {
        return problem_.observe(u, p, regime_, static_cast<Index>(i), g);
      });
    }
    return report_;
  }

 private:
  template <class Scalar>
  void compare_scalar(const std::string& name, Scalar scalar) {
    Gradient gradient{Vector(u_.size()), Vector(p_.size())};
    scalar(u_, p_, gradient);
    const Function value = [&](const Vector& u, const Vector& p) {
      Gradient unused{Vector(u.size()), Vector(p.size())};
      return Vector::Constant(1, scalar(u, p, unused)).eval();
    };
    compare(name, value, gradient.unknowns.transpose(), gradient.parameters.transpose());
  }

  void compare(const std::string& name, const Function& function, const Matrix& by_u, const Matrix& by_p) {
    const std::vector<std::string> parameters = problem_.parameter_names();
    for (Index i = 0; i < u_.size(); ++i) {
      const auto along = [&](double h) {
        Vector u = u_;
        u(i) += h * scale_u_(i);
        return function(u, p_);
      };
      note(name, fmt::format("u{}", i), along, by_u.col(i) * scale_u_(i));
    }
    for (Index i = 0; i < p_.size(); ++i) {
      const auto along = [&](double h) {
        Vector p = p_;
        p(i) += h * scale_p_(i);
        return function(u_, p);
      };
      note(name, parameters[static_cast<std::size_t>(i)], along, by_p.col(i) * scale_p_(i));
    }
  }

  template <class Along>
  void note(const std::string& name, const std::string& by, const Along& along, const Vector& exact) {
    const auto central = [&](double h) -> Vector { return (along(h) - along(-h)) / (2 * h); };
    constexpr double h = 5e-5;
    const Vector difference = (4 * central(h) - central(2 * h)) / 3;
    for (Index i = 0; i < exact.size(); ++i) {
      const double error = std::abs(exact(i) - difference(i)) / (1 + std::abs(exact(i)));
      if (error <= report_.worst) continue;  // a nan goes on and is reported
      report_ = {error, fmt::format("d{}{}/d{}", name, name == "F" ? fmt::format("{}", i) : "", by)};
    }
  }

  const Problem& problem_;
  const Vector& u_;
  const Vector& p_;
  int regime_;
  Vector scale_u_;
  Vector scale_p_;
  DerivativeReport report_;
};

}  // namespace

DerivativeReport check_derivatives(const Problem& problem, const Vector& u, const Vector& p, int regime) {
  return Checker(problem, u, p, regime).run();
}

}  // namespace arcslip::continuation
