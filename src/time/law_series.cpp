#include "time/law_series.hpp"

#include <algorithm>

namespace arcslip {

LawSeries::LawSeries(const std::vector<std::vector<double>>& powers, Index terms) {
  std::size_t degree = 1;
  for (const std::vector<double>& one : powers) degree = std::max(degree, one.size());
  coefficients_ = Matrix::Zero(std::ssize(powers), static_cast<Index>(degree));
  for (Index i = 0; i < coefficients_.rows(); ++i) {
    const std::vector<double>& one = powers[static_cast<std::size_t>(i)];
    for (Index k = 0; k < std::ssize(one); ++k) coefficients_(i, k) = one[static_cast<std::size_t>(k)];
  }
  powers_.assign(degree, Matrix(std::ssize(powers), terms));
}

void LawSeries::take(const Vector& displacements) {
  ++last_;
  powers_.front().col(last_) = displacements;
  for (std::size_t k = 1; k < powers_.size(); ++k) {
    powers_[k].col(last_).setZero();
    for (Index m = 0; m <= last_; ++m)
      powers_[k].col(last_) += powers_[k - 1].col(m).cwiseProduct(powers_.front().col(last_ - m));
  }
}

/// The term of x^k.
Vector LawSeries::power(Index k) const {
  if (k > 0) return powers_[static_cast<std::size_t>(k - 1)].col(last_);
  return Vector::Constant(coefficients_.rows(), last_ == 0 ? 1 : 0);
}

Vector LawSeries::force() const {
  Vector sum = Vector::Zero(coefficients_.rows());
  for (Index k = 0; k < coefficients_.cols(); ++k) sum += coefficients_.col(k).cwiseProduct(power(k + 1));
  return sum;
}

Vector LawSeries::slope() const {
  Vector sum = Vector::Zero(coefficients_.rows());
  for (Index k = 0; k < coefficients_.cols(); ++k)
    sum += static_cast<double>(k + 1) * coefficients_.col(k).cwiseProduct(power(k));
  return sum;
}

}  // namespace arcslip
