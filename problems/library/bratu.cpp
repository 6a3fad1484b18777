#include "arcslip/problems/library/bratu.hpp"

#include <cmath>

#include "arcslip/problems/library/model.hpp"

namespace arcslip::problems {

bool Bratu::evaluate(const Vector& u, const Vector& p, const continuation::Regime& /*regime*/,
                     const continuation::Evaluation& out) const {
  const auto at = [&](Index i) { return i < 0 || i >= size_ ? 0 : u(i); };
  SparseMatrix* jacobian = out.sparse_jacobian;
  if (jacobian != nullptr) {
    jacobian->resize(size_, size_);
    jacobian->reserve(3 * size_);
  }
  for (Index i = 0; i < size_; ++i) {
    const double source = h_ * std::exp(u(i));
    if (out.residual != nullptr) (*out.residual)(i) = (at(i - 1) - 2 * u(i) + at(i + 1)) / h_ + p(0) * source;
    if (out.parameter_jacobian != nullptr) (*out.parameter_jacobian)(i, 0) = source;
    if (jacobian == nullptr) continue;
    jacobian->startVec(i);
    if (i > 0) jacobian->insertBack(i - 1, i) = 1 / h_;
    jacobian->insertBack(i, i) = -2 / h_ + p(0) * source;
    if (i + 1 < size_) jacobian->insertBack(i + 1, i) = 1 / h_;
  }
  if (jacobian != nullptr) jacobian->finalize();
  return true;
}

std::vector<continuation::Observable> Bratu::observables() const {
  return {{"u_mid", true}, {"slope", true}};
}

void Bratu::observe(const Vector& u, const Vector& p, const continuation::Regime& regime,
                    Vector& values) const {
  continuation::Gradient unused{Vector(size_), Vector(1)};
  values.resize(2);
  for (const Index which : {u_mid, slope}) values(which) = observe(u, p, regime, which, unused);
}

double Bratu::observe(const Vector& u, const Vector& p, const continuation::Regime& /*regime*/, Index which,
                      continuation::Gradient& gradient) const {
  gradient.unknowns.setZero();
  gradient.parameters.setZero();
  if (which == u_mid) {
    const Index left = (size_ - 1) / 2;
    const Index right = size_ / 2;
    gradient.unknowns(left) += 0.5;
    gradient.unknowns(right) += 0.5;
    return 0.5 * (u(left) + u(right));
  }
  // u(h) = h u'(0) + h^2/2 u''(0) + ..., u''(0) = -lambda
  gradient.unknowns(0) = 1 / h_;
  gradient.parameters(0) = 0.5 * h_;
  return u(0) / h_ + 0.5 * h_ * p(0);
}

LibraryModel bratu_model() {
  // Newton's method rises from zero to the lower of the two solutions.
  const auto zero = [](const continuation::Problem& problem, const Vector& /*p*/) -> Vector {
    return Vector::Zero(problem.size());
  };
  const auto build = [](const LibraryModel::Values& values) -> std::unique_ptr<continuation::Problem> {
    return std::make_unique<Bratu>(static_cast<Index>(values[1]));
  };
  return {"bratu",
          "Bratu's problem on an interval",
          {any_value("lambda", 0, "heat production"),
           {"intervals", 100, 2, 1e6, true, "how many the interval is divided into"}},
          build,
          guess_at(zero)};
}

}  // namespace arcslip::problems
