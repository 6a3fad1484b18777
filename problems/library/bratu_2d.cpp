#include "arcslip/problems/library/bratu_2d.hpp"

#include <cmath>

#include "arcslip/problems/library/model.hpp"

namespace arcslip::problems {

bool BratuSquare::evaluate(const Vector& u, const Vector& p, const continuation::Regime& /*regime*/,
                           const continuation::Evaluation& out) const {
  const double area = h_ * h_;
  if (out.residual != nullptr) {
    const auto at = [&](Index i, Index j) {
      return i < 0 || j < 0 || i >= side_ || j >= side_ ? 0 : u(i * side_ + j);
    };
    for (Index i = 0; i < side_; ++i) {
      for (Index j = 0; j < side_; ++j) {
        (*out.residual)(i * side_ + j) = at(i - 1, j) + at(i + 1, j) + at(i, j - 1) + at(i, j + 1) -
                                         4 * at(i, j) + p(0) * area * std::exp(at(i, j));
      }
    }
  }
  if (out.parameter_jacobian != nullptr) out.parameter_jacobian->col(0) = area * u.array().exp();
  if (out.sparse_jacobian != nullptr) fill(u, p(0), *out.sparse_jacobian);
  return true;
}

void BratuSquare::fill(const Vector& u, double lambda, SparseMatrix& jacobian) const {
  jacobian.resize(size(), size());
  jacobian.reserve(5 * size());
  for (Index k = 0; k < size(); ++k) {
    const Index i = k / side_;
    const Index j = k % side_;
    jacobian.startVec(k);
    if (i > 0) jacobian.insertBack(k - side_, k) = 1;
    if (j > 0) jacobian.insertBack(k - 1, k) = 1;
    jacobian.insertBack(k, k) = -4 + lambda * h_ * h_ * std::exp(u(k));
    if (j + 1 < side_) jacobian.insertBack(k + 1, k) = 1;
    if (i + 1 < side_) jacobian.insertBack(k + side_, k) = 1;
  }
  jacobian.finalize();
}

void BratuSquare::observe(const Vector& u, const Vector& p, const continuation::Regime& regime,
                          Vector& values) const {
  continuation::Gradient unused{Vector(size()), Vector(1)};
  values.setConstant(1, observe(u, p, regime, 0, unused));
}

double BratuSquare::observe(const Vector& u, const Vector& /*p*/, const continuation::Regime& /*regime*/,
                            Index /*which*/, continuation::Gradient& gradient) const {
  gradient.unknowns.setZero();
  gradient.parameters.setZero();
  double value = 0;
  for (const Index i : {(side_ - 1) / 2, side_ / 2}) {
    for (const Index j : {(side_ - 1) / 2, side_ / 2}) {
      gradient.unknowns(i * side_ + j) += 0.25;
      value += 0.25 * u(i * side_ + j);
    }
  }
  return value;
}

LibraryModel bratu_2d_model() {
  // Newton's method rises from zero to the lower of the two solutions.
  const auto zero = [](const continuation::Problem& problem, const Vector& /*p*/) -> Vector {
    return Vector::Zero(problem.size());
  };
  const auto build = [](const LibraryModel::Values& values) -> std::unique_ptr<continuation::Problem> {
    return std::make_unique<BratuSquare>(static_cast<Index>(values[1]));
  };
  return {"bratu_2d",
          "Bratu's problem on a square",
          {any_value("lambda", 0, "heat production"),
           {"intervals", 32, 2, 1e4, true, "how many each side is divided into"}},
          build,
          guess_at(zero)};
}

}  // namespace arcslip::problems
