#include "arcslip/continuation/linear/hill.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "arcslip/dense.hpp"

namespace arcslip::continuation {
namespace {

/// A real eigenvalue, or a pair of conjugates by that with Im > 0.
struct Candidate {
  Complex rate;
  bool alternates;  ///< i = +-1/2, ...
  double mean;      ///< |sum i |p_i|^2|/sum |p_i|^2
  double spread;    ///< sum i^2 |p_i|^2/sum |p_i|^2

  Index count() const { return rate.imag() == 0 ? 1 : 2; }
};

/// The truncated problem in cosines, in the place of p_i, and sines, in that of p_{-i}.
Matrix hill_matrix(const std::vector<ComplexMatrix>& coefficients, double w, Index twice_h) {
  const Index n = coefficients.front().rows();
  const Index blocks = twice_h + 1;
  ComplexMatrix hill = ComplexMatrix::Zero(blocks * n, blocks * n);
  for (Index row = 0; row < blocks; ++row) {
    for (Index column = 0; column < blocks; ++column) {
      const auto k = static_cast<std::size_t>(std::abs(row - column));
      if (k >= coefficients.size()) continue;
      auto block = hill.block(row * n, column * n, n, n);
      block = row >= column ? coefficients[k] : ComplexMatrix(coefficients[k].conjugate());
    }
    hill.diagonal().segment(row * n, n).array() -=
        Complex(0, w * (static_cast<double>(row) - 0.5 * static_cast<double>(twice_h)));
  }
  const double half = 1 / std::numbers::sqrt2;
  for (Index row = 0; 2 * row < twice_h; ++row) {
    const Index minus = row * n;
    const Index plus = (twice_h - row) * n;
    const ComplexMatrix upper = hill.middleRows(plus, n);
    const ComplexMatrix lower = hill.middleRows(minus, n);
    hill.middleRows(plus, n) = half * (upper + lower);
    hill.middleRows(minus, n) = Complex(0, half) * (upper - lower);
  }
  for (Index column = 0; 2 * column < twice_h; ++column) {
    const Index minus = column * n;
    const Index plus = (twice_h - column) * n;
    const ComplexMatrix right = hill.middleCols(plus, n);
    const ComplexMatrix left = hill.middleCols(minus, n);
    hill.middleCols(plus, n) = half * (right + left);
    hill.middleCols(minus, n) = Complex(0, half) * (left - right);
  }
  return hill.real();
}

void add_candidates(const std::vector<ComplexMatrix>& coefficients, double w, Index twice_h,
                    std::vector<Candidate>& candidates) {
  const Index n = coefficients.front().rows();
  const Matrix hill = hill_matrix(coefficients, w, twice_h);
  ComplexMatrix vectors;
  const ComplexVector values = eigenvalues(hill, &vectors);
  for (Index v = 0; v < values.size(); ++v) {
    if (values(v).imag() < 0) continue;
    Candidate candidate{values(v), twice_h % 2 != 0, 0, 0};
    for (Index row = 0; 2 * row < twice_h; ++row) {
      const double i = 0.5 * static_cast<double>(twice_h) - static_cast<double>(row);
      const auto sine = vectors.col(v).segment(row * n, n);
      const auto cosine = vectors.col(v).segment((twice_h - row) * n, n);
      candidate.mean += 2 * i * sine.dot(cosine).imag();
      candidate.spread += i * i * (sine.squaredNorm() + cosine.squaredNorm());
    }
    candidate.mean = std::abs(candidate.mean) / vectors.col(v).squaredNorm();
    candidate.spread /= vectors.col(v).squaredNorm();
    candidates.push_back(candidate);
  }
}

/// lambda + j w Z with |Im| <= w/2.
Complex folded(Complex exponent, double w) { return {exponent.real(), std::remainder(exponent.imag(), w)}; }

double hill_determinant(const std::vector<ComplexMatrix>& coefficients, double w, Index twice_h) {
  Matrix hill = hill_matrix(coefficients, w, twice_h);
  const Index n = coefficients.front().rows();
  for (Index row = 0; row <= twice_h; ++row)  // to the size of -j i w, which the far ones approach
    hill.middleRows(row * n, n) /=
        std::hypot(1, w * (static_cast<double>(row) - 0.5 * static_cast<double>(twice_h)));
  return determinant_of(hill);
}

}  // namespace

FloquetExponents floquet_exponents(const std::vector<ComplexMatrix>& coefficients, double w, Index twice_h) {
  std::vector<Candidate> candidates;
  for (const Index size : {twice_h, twice_h + 1}) add_candidates(coefficients, w, size, candidates);
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return std::tie(a.mean, a.spread) < std::tie(b.mean, b.spread);
  });
  const Index n = coefficients.front().rows();
  FloquetExponents result{ComplexVector(n), ComplexVector(n)};
  Index found = 0;
  for (const Candidate& candidate : candidates) {
    if (found + candidate.count() > n) continue;
    const Complex shift(0, candidate.alternates ? 0.5 * w : 0);
    for (Index i = 0; i < candidate.count(); ++i, ++found) {
      const Complex rate = i == 0 ? candidate.rate : std::conj(candidate.rate);
      result.rates(found) = rate;
      result.exponents(found) = folded(rate + shift, w);
    }
  }
  return result;
}

double doubling_determinant(const std::vector<ComplexMatrix>& coefficients, double w, Index twice_h) {
  return hill_determinant(coefficients, w, twice_h + 1 - twice_h % 2);
}

double returning_determinant(const std::vector<ComplexMatrix>& coefficients, double w, Index twice_h) {
  const double sign = coefficients.front().rows() % 2 == 0 ? 1 : -1;  // of -1 for each multiplier
  return sign * hill_determinant(coefficients, w, twice_h + twice_h % 2);
}

Index significant(const ComplexVector& coefficients) {
  const double least = 1e-12 * coefficients.cwiseAbs().maxCoeff();
  Index count = coefficients.size();
  while (count > 1 && !(std::abs(coefficients(count - 1)) > least)) --count;
  return std::min(count + 2, coefficients.size());
}

}  // namespace arcslip::continuation
