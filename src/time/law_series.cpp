#include "time/law_series.hpp"

#include <cstdlib>

namespace arcslip {

std::vector<int> zones_of(const PiecewiseLaw& law, const Vector& displacements, const Vector& direction,
                          const Vector& loose) {
  std::vector<int> zones;
  for (Index i = 0; i < displacements.size(); ++i) {
    const double x = displacements(i);
    int zone = law.zone_at(x);
    const auto [low, high] = law.ends(zone);
    if (direction(i) > 0 && high - x <= loose(i)) {
      ++zone;
    } else if (direction(i) < 0 && x - low <= loose(i)) {
      --zone;
    }
    zones.push_back(zone);
  }
  return zones;
}

LawSeries::LawSeries(const PiecewiseLaw& law, const std::vector<int>& zones, Index order)
    : coefficients_(Matrix::Zero(std::ssize(zones), law.degree() + 1)) {
  for (Index i = 0; i < coefficients_.rows(); ++i) {
    const int zone = zones[static_cast<std::size_t>(i)];
    const auto& of_distance = law.pieces()[static_cast<std::size_t>(std::abs(zone))].coefficients;
    for (Index k = 0; k < std::ssize(of_distance); ++k)
      coefficients_(i, k) =
          (zone < 0 && k % 2 == 0 ? -1 : 1) * of_distance[static_cast<std::size_t>(k)].value;
  }
  powers_.assign(static_cast<std::size_t>(std::max(1, law.degree())), Matrix(std::ssize(zones), order + 1));
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
  for (Index k = 0; k < coefficients_.cols(); ++k) sum += coefficients_.col(k).cwiseProduct(power(k));
  return sum;
}

Vector LawSeries::slope() const {
  Vector sum = Vector::Zero(coefficients_.rows());
  for (Index k = 1; k < coefficients_.cols(); ++k)
    sum += static_cast<double>(k) * coefficients_.col(k).cwiseProduct(power(k - 1));
  return sum;
}

}  // namespace arcslip
