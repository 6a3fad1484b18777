#include "arcslip/elements/disturbed_law.hpp"

#include <Eigen/LU>
#include <cmath>
#include <numeric>

namespace arcslip {
namespace {

constexpr Index interpolated = 12;   // of points
constexpr Index terms_in_step = 64;  // of e^{jz}, |z| <= 8, far more than rounding leaves

Vector fourier_terms(const std::vector<Complex>& harmonics, double theta, double width) {
  Vector terms = Vector::Zero(terms_in_step);
  for (std::size_t n = 0; n < harmonics.size(); ++n) {
    const double turns = static_cast<double>(n);
    Complex term = harmonics[n] * std::polar(1.0, turns * theta);
    for (Index m = 0; m < terms_in_step; ++m) {
      terms(m) += term.real();
      term *= Complex(0, turns * width / static_cast<double>(m + 1));
    }
  }
  return terms;
}

/// Powers by values at Chebyshev points of [0, 1].
Vector interpolated_terms(const std::function<double(double)>& at, double theta, double width) {
  struct Points {
    Vector places{interpolated};
    Matrix powers{interpolated, interpolated};
  };
  static const Points points = [] {
    Points all;
    Matrix values(interpolated, interpolated);
    for (Index i = 0; i < interpolated; ++i) {
      all.places(i) =
          0.5 - 0.5 * std::cos(pi * (static_cast<double>(i) + 0.5) / static_cast<double>(interpolated));
      for (Index m = 0; m < interpolated; ++m) values(i, m) = m == 0 ? 1 : values(i, m - 1) * all.places(i);
    }
    all.powers = values.inverse();
    return all;
  }();
  Vector values(interpolated);
  for (Index i = 0; i < interpolated; ++i) values(i) = at(theta + width * points.places(i));
  Vector terms = Vector::Zero(terms_in_step);
  terms.head(interpolated) = points.powers * values;
  return terms;
}

}  // namespace

VaryingSlope interpolated_slope(std::function<double(double theta)> at, double bound, double rate) {
  return {[at = std::move(at)](double theta, double width) { return interpolated_terms(at, theta, width); },
          bound, rate};
}

DisturbedLaw DisturbedLaw::constant(const Matrix& stiffness) {
  return {stiffness.rows(), {{0, two_pi, stiffness}}};
}

void DisturbedLaw::add_slope(double begin, double width, const std::vector<Complex>& harmonics) {
  if (harmonics.size() <= 1) {
    const double slope = harmonics.empty() ? 0 : harmonics[0].real();
    pieces.push_back({begin, width, Matrix::Constant(1, 1, slope)});
    return;
  }
  const double bound = std::accumulate(harmonics.begin(), harmonics.end(), 0.0,
                                       [](double sum, const Complex& one) { return sum + std::abs(one); });
  pieces.push_back({begin, width, Matrix::Zero(1, 1), {}});
  pieces.back().slope = std::make_shared<const VaryingSlope>(
      VaryingSlope{[harmonics](double theta, double step) { return fourier_terms(harmonics, theta, step); },
                   bound, static_cast<double>(harmonics.size() - 1)});
}

void DisturbedLaw::scale(double factor) {
  viscous *= factor;
  for (Piece& piece : pieces) {
    piece.stiffness *= factor;
    for (auto& [memory, force] : piece.held) force *= factor;
    if (!piece.slope) continue;
    piece.slope = std::make_shared<const VaryingSlope>(
        VaryingSlope{[slope = piece.slope, factor](double theta, double width) {
                       return Vector(factor * slope->terms(theta, width));
                     },
                     std::abs(factor) * piece.slope->bound, piece.slope->rate});
  }
}

DisturbedLaw law_of(const VaryingStiffness& stiffness) {
  DisturbedLaw law;
  for (const VaryingStiffness::Arc& arc : stiffness.arcs) law.add_slope(arc.begin, arc.width, arc.harmonics);
  if (!law.pieces.empty()) return law;
  std::vector<Complex> all;  // of e^{j theta}
  for (const Complex& k : stiffness.harmonics) {
    if (!all.empty()) all.emplace_back(0);
    all.push_back(k);
  }
  law.add_slope(0, pi, all);
  return law;
}

}  // namespace arcslip
