#include "arcslip/continuation/atlas/surface.hpp"

#include "arcslip/dense.hpp"

namespace arcslip::continuation {

Surface::Surface(const Problem& problem, const std::array<AtlasSide, 2>& sides, const Guess& guess,
                 const Vector& scale)
    : problem_(problem),
      size_(problem.size()),
      sides_(sides),
      guess_(guess),
      origin_(guess.unknowns),
      scale_(scale),
      at_(problem, true),
      residual_(size_),
      derivative_(size_, size_ + 2),
      row_lengths_(size_),
      square_(size_ + 2, size_ + 2),
      step_(size_ + 2) {}

Vector Surface::place(const Guess& guess) const {
  Vector x(size());
  x.head(size_) = (guess.unknowns - origin_).cwiseQuotient(scale_);
  for (Index k = 0; k < 2; ++k) {
    const AtlasSide& side = sides_[static_cast<std::size_t>(k)];
    x(size_ + k) = (guess.parameters(side.parameter) - side.low) / (side.high - side.low);
  }
  return x;
}

Guess Surface::solution(const Vector& x) const {
  Guess at = guess_;
  at.unknowns = origin_ + x.head(size_).cwiseProduct(scale_);
  for (Index k = 0; k < 2; ++k) {
    const AtlasSide& side = sides_[static_cast<std::size_t>(k)];
    const double share = x(size_ + k);
    // So that both ends are met to the last bit.
    at.parameters(side.parameter) = (1 - share) * side.low + share * side.high;
  }
  return at;
}

bool Surface::evaluate(const Vector& x) {
  guess_ = solution(x);
  if (!at_.evaluate(guess_.unknowns, guess_.parameters, guess_.regime)) return false;
  residual_ = at_.residual();
  if (at_.sparse()) {
    derivative_.leftCols(size_) = at_.sparse_jacobian().toDense() * scale_.asDiagonal();
  } else {
    derivative_.leftCols(size_).noalias() = at_.jacobian() * scale_.asDiagonal();
  }
  for (Index k = 0; k < 2; ++k) {
    const AtlasSide& side = sides_[static_cast<std::size_t>(k)];
    derivative_.col(size_ + k) = (side.high - side.low) * at_.parameter_jacobian().col(side.parameter);
  }
  for (Index i = 0; i < size_; ++i) {
    const double length = derivative_.row(i).norm();
    row_lengths_(i) = length > 0 ? length : 1;
    derivative_.row(i) /= row_lengths_(i);
    residual_(i) /= row_lengths_(i);
  }
  return derivative_.allFinite();
}

bool Surface::settle(Vector& x, const Matrix& rows, const Eigen::Vector2d& values) {
  constexpr int most = 12;            // iterations
  constexpr double rounding = 1e-13;  // of a correction, relative
  constexpr double settled = 1e-10;   // the largest that may be rounding
  constexpr double fast = 0.5;        // contraction that is no sign of leaving the surface
  double before = 0;
  for (int i = 0; i < most; ++i) {
    if (!evaluate(x)) return false;
    square_ << derivative_, rows;
    step_ << residual_, rows * x - values;
    step_ = solution_of(square_, step_);
    const double length = step_.norm();
    const double size = 1 + x.lpNorm<Eigen::Infinity>();
    if (!std::isfinite(length)) return false;
    if (i > 0 && length > fast * before) return before <= settled * size;
    x -= step_;
    if (length <= rounding * size) return true;
    before = length;
  }
  return false;
}

bool Surface::approach(Vector& x) {
  constexpr int most = 30;
  constexpr double settled = 1e-12;
  for (int i = 0; i < most; ++i) {
    if (!evaluate(x)) return false;
    step_ = shortest(derivative_, residual_);
    x -= step_;
    if (step_.norm() <= settled * (1 + x.lpNorm<Eigen::Infinity>())) return true;
  }
  return false;
}

bool Surface::tangent(const Vector& x, const Matrix& like, Matrix& plane) {
  constexpr double singular = 1e-9;  // of rows of unit length
  if (!evaluate(x)) return false;
  plane = perpendicular(derivative_.transpose(), singular);
  if (plane.cols() == 0) return false;
  if (like.size() > 0 && Eigen::Matrix2d(like.transpose() * plane).determinant() < 0) plane.col(1) *= -1;
  return true;
}

bool Surface::is_inside(const Vector& x) const {
  constexpr double outside =
      1e-9;  // of a border function, which is 0 on it: solutions there belong to both sides
  const Guess at = solution(x);
  return crossed_border(problem_, at.unknowns, at.parameters, at.regime, outside) < 0;
}

int Surface::orientation(const Matrix& plane) {
  square_ << derivative_, plane.transpose();
  return arcslip::orientation(square_);
}

}  // namespace arcslip::continuation
