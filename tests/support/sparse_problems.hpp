#pragma once

// Discretised boundary value problems, the same with dense and with sparse derivatives.

#include <cmath>

#include "arcslip/continuation/problem/problem.hpp"

namespace arcslip::testing {

/// u'' + s(u; L, K) = 0, u(0) = u(1) = 0, by central differences on m inner points, an odd number of them;
/// times h^2. The observable "middle" is u(1/2), "L" is the parameter, and the border is at u(1/2) =
/// `highest`.
class Chain : public continuation::Problem {
 public:
  struct Source {
    double value, by_u, by_L, by_K;
  };

  Chain(Index m, bool sparse, double highest = 100) : m_(m), sparse_(sparse), highest_(highest) {}
  Index size() const override { return m_; }
  bool sparse() const override { return sparse_; }
  std::vector<std::string> parameter_names() const override { return {"L", "K"}; }
  Index middle() const { return m_ / 2; }
  double spacing() const { return 1 / static_cast<double>(m_ + 1); }

  bool evaluate(const Vector& u, const Vector& p, const continuation::Regime& /*regime*/,
                const continuation::Evaluation& out) const override {
    const double square = spacing() * spacing();
    SparseMatrix* const entries = out.sparse_jacobian;
    if (out.jacobian != nullptr) out.jacobian->setZero();
    if (entries != nullptr && entries->nonZeros() == 0) set_pattern(*entries);
    for (Index i = 0; i < m_; ++i) {
      const Source s = source(u(i), p);
      const double left = i > 0 ? u(i - 1) : 0;
      const double right = i + 1 < m_ ? u(i + 1) : 0;
      if (out.residual != nullptr) (*out.residual)(i) = left - 2 * u(i) + right + square * s.value;
      if (out.parameter_jacobian != nullptr)
        out.parameter_jacobian->row(i) << square * s.by_L, square * s.by_K;
      const double diagonal = -2 + square * s.by_u;
      if (entries != nullptr) entries->coeffRef(i, i) = diagonal;
      if (out.jacobian == nullptr) continue;
      (*out.jacobian)(i, i) = diagonal;
      if (i > 0) (*out.jacobian)(i, i - 1) = 1;
      if (i + 1 < m_) (*out.jacobian)(i, i + 1) = 1;
    }
    return true;
  }

  int border_count(const continuation::Regime& /*regime*/) const override { return 1; }
  std::optional<continuation::Regime> regime_beyond(const continuation::Regime& /*regime*/,
                                                    int /*border*/) const override {
    return {};
  }
  double border(const Vector& u, const Vector& /*p*/, const continuation::Regime& /*regime*/, int /*border*/,
                continuation::Gradient* gradient) const override {
    if (gradient != nullptr) {
      gradient->unknowns.setUnit(m_, middle());
      gradient->parameters.setZero(2);
    }
    return u(middle()) - highest_;
  }

  std::vector<continuation::Observable> observables() const override {
    return {{"middle", true}, {"L", true}};
  }
  void observe(const Vector& u, const Vector& p, const continuation::Regime& /*regime*/,
               Vector& values) const override {
    values.resize(2);
    values << u(middle()), p(0);
  }
  double observe(const Vector& u, const Vector& p, const continuation::Regime& /*regime*/, Index which,
                 continuation::Gradient& gradient) const override {
    gradient.unknowns.setZero(m_);
    gradient.parameters.setZero(2);
    (which == 0 ? gradient.unknowns(middle()) : gradient.parameters(0)) = 1;
    return which == 0 ? u(middle()) : p(0);
  }

 protected:
  virtual Source source(double u, const Vector& p) const = 0;

 private:
  void set_pattern(SparseMatrix& matrix) const {
    matrix.reserve(3 * m_);
    for (Index j = 0; j < m_; ++j) {
      matrix.startVec(j);
      if (j > 0) matrix.insertBack(j - 1, j) = 1;
      matrix.insertBack(j, j) = 0;
      if (j + 1 < m_) matrix.insertBack(j + 1, j) = 1;
    }
    matrix.finalize();
  }

  Index m_;
  bool sparse_;
  double highest_;
};

/// s = L exp(u/(1 + K u)): of Bratu for K = 0, a perturbed one else, whose two folds meet in a cusp.
class Ignition : public Chain {
 public:
  using Chain::Chain;

 protected:
  Source source(double u, const Vector& p) const override {
    const double a = 1 + p(1) * u;
    const double e = std::exp(u / a);
    return {p(0) * e, p(0) * e / (a * a), e, -p(0) * e * u * u / (a * a)};
  }
};

/// s = L sin u + K: for K = 0 branch points of u = 0 at h^2 L_k = 2 - 2 cos(k pi h).
class Buckling : public Chain {
 public:
  using Chain::Chain;

 protected:
  Source source(double u, const Vector& p) const override {
    return {p(0) * std::sin(u) + p(1), p(0) * std::cos(u), std::sin(u), 1};
  }
};

/// Bratu's problem in a rectangle of width 1, u_xx + u_yy + L e^u = 0 with u = 0 around, by five-point
/// differences on across x along inner points in a square grid, times h^2. Sparse.
class BratuRectangle : public continuation::Problem {
 public:
  BratuRectangle(Index across, Index along)
      : across_(across), along_(along), square_(1 / static_cast<double>((across + 1) * (across + 1))) {}
  Index size() const override { return across_ * along_; }
  bool sparse() const override { return true; }
  std::vector<std::string> parameter_names() const override { return {"L"}; }

  bool evaluate(const Vector& u, const Vector& p, const continuation::Regime& /*regime*/,
                const continuation::Evaluation& out) const override {
    SparseMatrix* const entries = out.sparse_jacobian;
    if (entries != nullptr && entries->nonZeros() == 0) set_pattern(*entries);
    double* value = entries != nullptr ? entries->valuePtr() : nullptr;
    for (Index y = 0, i = 0; y < along_; ++y) {
      for (Index x = 0; x < across_; ++x, ++i) {
        const double source = square_ * std::exp(u(i));
        double sum = -4 * u(i);
        if (y > 0) sum += u(i - across_);
        if (x > 0) sum += u(i - 1);
        if (x + 1 < across_) sum += u(i + 1);
        if (y + 1 < along_) sum += u(i + across_);
        if (out.residual != nullptr) (*out.residual)(i) = sum + p(0) * source;
        if (out.parameter_jacobian != nullptr) (*out.parameter_jacobian)(i, 0) = source;
        if (value == nullptr) continue;
        if (y > 0) *value++ = 1;
        if (x > 0) *value++ = 1;
        *value++ = -4 + p(0) * source;
        if (x + 1 < across_) *value++ = 1;
        if (y + 1 < along_) *value++ = 1;
      }
    }
    return true;
  }

 private:
  void set_pattern(SparseMatrix& matrix) const {
    matrix.reserve(5 * size());
    for (Index i = 0; i < size(); ++i) {
      matrix.startVec(i);
      if (i >= across_) matrix.insertBack(i - across_, i) = 1;
      if (i % across_ > 0) matrix.insertBack(i - 1, i) = 1;
      matrix.insertBack(i, i) = 0;
      if (i % across_ + 1 < across_) matrix.insertBack(i + 1, i) = 1;
      if (i + across_ < size()) matrix.insertBack(i + across_, i) = 1;
    }
    matrix.finalize();
  }

  Index across_;
  Index along_;
  double square_;
};

}  // namespace arcslip::testing
