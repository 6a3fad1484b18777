#include "arcslip/continuation/problem/symmetric_problem.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "arcslip/continuation/problem/evaluation.hpp"
#include "arcslip/dense.hpp"

namespace arcslip::continuation {
namespace {

/// dF/du in the scale on a space that it maps to itself, each column over its length, or over `little` where
/// that is shorter: a positive, smooth factor.
class Restricted {
 public:
  Restricted(const Matrix& jacobian, const SparseMatrix& space, double size)
      : matrix_(size * (space.transpose() * (jacobian * space))) {
    constexpr double little = 1e-2;
    for (auto column : matrix_.colwise()) column /= std::hypot(column.norm(), little);
    pivots_ = pivots_of(matrix_);
  }

  /// How far it is from being singular: the least pivot.
  double nearness() const { return pivots_.sizes.minCoeff(); }

  /// The product of all singular values s over sqrt(s^2 + small^2), with the determinant's sign: as smooth as
  /// that, but of size 1 wherever none of them is small. 0 where one is but for rounding.
  double determinant() const {
    constexpr double small = 0.3;
    const double rounding =
        1e2 * std::numeric_limits<double>::epsilon() * static_cast<double>(matrix_.rows());
    if (!(nearness() > rounding)) return 0;
    Matrix squares = matrix_.transpose() * matrix_;
    squares.diagonal().array() += small * small;
    const auto log = [](const Pivots& pivots) { return pivots.sizes.array().log().sum(); };
    return pivots_.sign * std::exp(log(pivots_) - 0.5 * log(pivots_of(squares)));
  }

 private:
  Matrix matrix_;
  Pivots pivots_;
};

}  // namespace

SymmetricProblem::SymmetricProblem(const Problem& whole, std::shared_ptr<const SymmetryGroup> group,
                                   Subgroup kept, double size, double tolerance)
    : whole_(whole),
      group_(std::move(group)),
      kept_(std::move(kept)),
      size_(size),
      tolerance_(tolerance),
      mean_(group_->projection(kept_)),
      complement_((Matrix::Identity(whole.size(), whole.size()) - Matrix(mean_)) / size),
      breakings_(group_->breakings(kept_)) {
  if (whole.sparse()) throw std::invalid_argument("SymmetricProblem: of a sparse problem");
}

bool SymmetricProblem::evaluate(const Vector& u, const Vector& p, const Regime& regime,
                                const Evaluation& out) const {
  if (!whole_.evaluate(mean_ * u, p, regime, out)) return false;
  if (out.residual != nullptr) *out.residual = Vector(mean_ * *out.residual + complement_ * u);
  if (out.jacobian != nullptr) {
    const Matrix product = *out.jacobian * mean_;
    *out.jacobian = complement_;
    *out.jacobian += mean_ * product;
  }
  if (out.parameter_jacobian != nullptr) *out.parameter_jacobian = Matrix(mean_ * *out.parameter_jacobian);
  return true;
}

bool SymmetricProblem::second(const Vector& u, const Vector& p, const Regime& regime, const Vector& w,
                              const Vector& du, const Vector& dp, Vector& out) const {
  const SparseMatrix transposed = mean_.transpose();
  if (!whole_.second(mean_ * u, p, regime, transposed * w, mean_ * du, dp, out)) return false;
  out.head(size()) = Vector(transposed * out.head(size()));
  return true;
}

std::vector<PointType> SymmetricProblem::test_types() const {
  std::vector<PointType> types = whole_.test_types();
  types.insert(types.end(), breakings_.size(), PointType::branch_point);
  return types;
}

void SymmetricProblem::test(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const {
  whole_.test(u, p, regime, values);
  const Index own = values.size();
  Vector all = Vector::Constant(own + std::ssize(breakings_), std::nan(""));
  all.head(own) = values;
  Matrix jacobian(size(), size());
  if (!breakings_.empty() && !has_more(u, p) &&
      continuation::evaluate(whole_, mean_ * u, p, regime, {nullptr, &jacobian})) {
    for (std::size_t i = 0; i < breakings_.size(); ++i)
      all(own + static_cast<Index>(i)) = Restricted(jacobian, breakings_[i].space, size_).determinant();
  }
  values = std::move(all);
}

std::vector<std::size_t> SymmetricProblem::broken(const Vector& u, const Vector& p, const Regime& regime,
                                                  double tolerance) const {
  std::vector<std::size_t> found;
  Matrix jacobian(size(), size());
  if (has_more(u, p) || !continuation::evaluate(whole_, mean_ * u, p, regime, {nullptr, &jacobian}))
    return found;
  for (std::size_t i = 0; i < breakings_.size(); ++i) {
    if (Restricted(jacobian, breakings_[i].space, size_).nearness() <= tolerance) found.push_back(i);
  }
  return found;
}

/// Whether a solution has further symmetries: where branches that lost them meet those that have them.
bool SymmetricProblem::has_more(const Vector& u, const Vector& p) const {
  Vector scale(u.size());
  Vector parameter_scale(p.size());
  whole_.scale(u, p, scale, parameter_scale);
  return group_->kept(u, scale, tolerance_).size() > kept_.size();
}

}  // namespace arcslip::continuation
