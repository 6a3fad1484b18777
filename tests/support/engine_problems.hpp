#pragma once

// Problems without physics for tests of the engine, each with its answer in closed form.

#include <cmath>

#include "arcslip/continuation/problem/problem.hpp"

namespace arcslip::testing {

using continuation::Evaluation;
using continuation::Gradient;
using continuation::Observable;
using continuation::Problem;
using continuation::Regime;

/// x' = mu + x - x^3: folds at mu = -+2/(3 sqrt 3), x = +-1/sqrt 3.
class Cusp : public Problem {
 public:
  Index size() const override { return 1; }
  std::vector<std::string> parameter_names() const override { return {"mu"}; }
  bool evaluate(const Vector& u, const Vector& p, const Regime& /*regime*/,
                const Evaluation& out) const override {
    if (out.residual != nullptr) (*out.residual)(0) = p(0) + u(0) - u(0) * u(0) * u(0);
    if (out.jacobian != nullptr) (*out.jacobian)(0, 0) = 1 - 3 * u(0) * u(0);
    if (out.parameter_jacobian != nullptr) (*out.parameter_jacobian)(0, 0) = 1;
    return true;
  }
};

/// Freudenstein & Roth, as in Rheinboldt & Burkardt, ACM TOMS 9 (1983) 236; x3 is the parameter.
class FreudensteinRoth : public Problem {
 public:
  Index size() const override { return 2; }
  std::vector<std::string> parameter_names() const override { return {"x3"}; }
  bool evaluate(const Vector& u, const Vector& p, const Regime& /*regime*/,
                const Evaluation& out) const override {
    const double x = u(0), y = u(1), z = p(0) - 1;
    if (out.residual != nullptr) {
      *out.residual << x - y * y * y + 5 * y * y - 2 * y - 13 + 34 * z,
          x + y * y * y + y * y - 14 * y - 29 + 10 * z;
    }
    if (out.jacobian != nullptr) {
      *out.jacobian << 1, -3 * y * y + 10 * y - 2, 1, 3 * y * y + 2 * y - 14;
    }
    if (out.parameter_jacobian != nullptr) *out.parameter_jacobian << 34, 10;
    return true;
  }
};

/// u = height/(1 + (p/width)^2), a peak of any sharpness, in ln u.
class Needle : public Problem {
 public:
  explicit Needle(double width) : width_(width) {}
  Index size() const override { return 1; }
  std::vector<std::string> parameter_names() const override { return {"p"}; }
  bool evaluate(const Vector& u, const Vector& p, const Regime& /*regime*/,
                const Evaluation& out) const override {
    const double x = (p(0) - 1) / width_;
    if (out.residual != nullptr) (*out.residual)(0) = u(0) + 0.5 * std::log1p(x * x);
    if (out.jacobian != nullptr) (*out.jacobian)(0, 0) = 1;
    if (out.parameter_jacobian != nullptr) (*out.parameter_jacobian)(0, 0) = x / (1 + x * x) / width_;
    return true;
  }
  void scale(const Vector& /*u*/, const Vector& p, Vector& unknowns, Vector& parameters) const override {
    unknowns(0) = 1;
    parameters = p;
  }
  std::vector<Observable> observables() const override { return {{"amplitude", true}}; }
  void observe(const Vector& u, const Vector& /*p*/, const Regime& /*regime*/,
               Vector& values) const override {
    values = u.array().exp();
  }
  double observe(const Vector& u, const Vector& /*p*/, const Regime& /*regime*/, Index /*which*/,
                 Gradient& gradient) const override {
    gradient.unknowns(0) = std::exp(u(0));
    gradient.parameters(0) = 0;
    return std::exp(u(0));
  }

 private:
  double width_;
};

/// Two straight pieces that meet at u = 0: p = a u for u < 0 ("below") and p = b u for u > 0 ("above").
class Corner : public Problem {
 public:
  Corner(double a, double b) : a_(a), b_(b) {}
  Index size() const override { return 1; }
  std::vector<std::string> parameter_names() const override { return {"p"}; }
  Index switch_count() const override { return 1; }
  std::string describe(const Regime& regime) const override { return regime[0] == 0 ? "below" : "above"; }
  int border_count(const Regime& /*regime*/) const override { return 1; }
  std::optional<Regime> regime_beyond(const Regime& regime, int /*border*/) const override {
    return 1 - regime[0];
  }
  double border(const Vector& u, const Vector& /*p*/, const Regime& regime, int /*border*/,
                Gradient* gradient) const override {
    const double sign = regime == 0 ? 1 : -1;
    if (gradient != nullptr) {
      gradient->unknowns(0) = sign;
      gradient->parameters.setZero();
    }
    return sign * u(0);
  }
  bool evaluate(const Vector& u, const Vector& p, const Regime& regime,
                const Evaluation& out) const override {
    const double slope = regime == 0 ? a_ : b_;
    if (out.residual != nullptr) (*out.residual)(0) = p(0) - slope * u(0);
    if (out.jacobian != nullptr) (*out.jacobian)(0, 0) = -slope;
    if (out.parameter_jacobian != nullptr) (*out.parameter_jacobian)(0, 0) = 1;
    return true;
  }

 private:
  double a_, b_;
};

/// The same in one regime, which tells nothing of the corner.
class HiddenCorner : public Corner {
 public:
  using Corner::Corner;
  Index switch_count() const override { return 0; }
  int border_count(const Regime& /*regime*/) const override { return 0; }
  bool evaluate(const Vector& u, const Vector& p, const Regime& /*regime*/,
                const Evaluation& out) const override {
    return Corner::evaluate(u, p, u(0) < 0 ? 0 : 1, out);
  }
};

/// u = width^2 - (p - 1)^2, above the border only between p = 1 - width and 1 + width.
class Bump : public Corner {
 public:
  explicit Bump(double width) : Corner(1, 1), width_(width) {}
  bool evaluate(const Vector& u, const Vector& p, const Regime& /*regime*/,
                const Evaluation& out) const override {
    const double x = p(0) - 1;
    if (out.residual != nullptr) (*out.residual)(0) = u(0) - (width_ * width_ - x * x);
    if (out.jacobian != nullptr) (*out.jacobian)(0, 0) = 1;
    if (out.parameter_jacobian != nullptr) (*out.parameter_jacobian)(0, 0) = 2 * x;
    return true;
  }

 private:
  double width_;
};

/// Another problem with its unknowns and residuals multiplied, and its scale with them.
class Rescaled : public FreudensteinRoth {
 public:
  Rescaled(double unknowns, double residuals) : unknowns_(unknowns), residuals_(residuals) {}
  bool evaluate(const Vector& u, const Vector& p, const Regime& regime,
                const Evaluation& out) const override {
    FreudensteinRoth::evaluate(u / unknowns_, p, regime, out);
    if (out.residual != nullptr) *out.residual *= residuals_;
    if (out.jacobian != nullptr) *out.jacobian *= residuals_ / unknowns_;
    if (out.parameter_jacobian != nullptr) *out.parameter_jacobian *= residuals_;
    return true;
  }
  void scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const override {
    FreudensteinRoth::scale(u / unknowns_, p, unknowns, parameters);
    unknowns *= unknowns_;
  }

 private:
  double unknowns_, residuals_;
};

/// Discretised Bratu problem u'' + L e^u = 0, u(0) = u(1) = 0, central differences on m inner points.
class Bratu : public Problem {
 public:
  explicit Bratu(Index m) : m_(m) {}
  Index size() const override { return m_; }
  std::vector<std::string> parameter_names() const override { return {"L"}; }
  bool evaluate(const Vector& u, const Vector& p, const Regime& /*regime*/,
                const Evaluation& out) const override {
    const double h = 1.0 / static_cast<double>(m_ + 1);
    if (out.jacobian != nullptr) out.jacobian->setZero();
    for (Index i = 0; i < m_; ++i) {
      const double left = i > 0 ? u(i - 1) : 0;
      const double right = i + 1 < m_ ? u(i + 1) : 0;
      const double source = h * h * std::exp(u(i));
      if (out.residual != nullptr) (*out.residual)(i) = left - 2 * u(i) + right + p(0) * source;
      if (out.parameter_jacobian != nullptr) (*out.parameter_jacobian)(i, 0) = source;
      if (out.jacobian == nullptr) continue;
      (*out.jacobian)(i, i) = -2 + p(0) * source;
      if (i > 0) (*out.jacobian)(i, i - 1) = 1;
      if (i + 1 < m_) (*out.jacobian)(i, i + 1) = 1;
    }
    return true;
  }

 private:
  Index m_;
};

}  // namespace arcslip::testing
