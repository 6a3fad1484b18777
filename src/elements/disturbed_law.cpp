#include "arcslip/elements/disturbed_law.hpp"

#include <cmath>
#include <numeric>

#include "arcslip/dense.hpp"

namespace arcslip {
namespace {

constexpr Index points_in_step = 12;
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
Matrix interpolated_terms(const std::function<Vector(double)>& at, double theta, double width) {
  struct Points {
    Vector places{points_in_step};
    Matrix powers{points_in_step, points_in_step};
  };
  static const Points points = [] {
    Points all;
    Matrix values(points_in_step, points_in_step);
    for (Index i = 0; i < points_in_step; ++i) {
      all.places(i) =
          0.5 - 0.5 * std::cos(pi * (static_cast<double>(i) + 0.5) / static_cast<double>(points_in_step));
      for (Index m = 0; m < points_in_step; ++m) values(i, m) = m == 0 ? 1 : values(i, m - 1) * all.places(i);
    }
    all.powers = inverse_of(values).value();
    return all;
  }();
  const Vector first = at(theta + width * points.places(0));
  Matrix values(points_in_step, first.size());
  values.row(0) = first;
  for (Index i = 1; i < points_in_step; ++i) values.row(i) = at(theta + width * points.places(i));
  return points.powers * values;
}

}  // namespace

std::function<Matrix(double theta, double width)> interpolated(std::function<Vector(double theta)> at) {
  return [at = std::move(at)](double theta, double width) { return interpolated_terms(at, theta, width); };
}

bool is_resolved(const std::function<Vector(double theta)>& at, double theta, double width) {
  constexpr double exact = 1e-8;  // powers take digits from rounding
  const Matrix terms = interpolated_terms(at, theta, width);
  for (const double s : {0.0, 0.21, 0.5, 0.83, 1.0}) {
    Vector sum = terms.row(terms.rows() - 1);
    for (Index m = terms.rows() - 2; m >= 0; --m) sum = s * sum + terms.row(m).transpose();
    const Vector here = at(theta + s * width);
    if (!((sum - here).cwiseAbs().maxCoeff() <= exact * (1 + here.cwiseAbs().maxCoeff()))) return false;
  }
  return true;
}

VaryingLaw interpolated_slope(std::function<double(double theta)> at, double bound, double rate) {
  const auto both = [at = std::move(at)](double theta) {
    const double slope = at(theta);
    return Vector(Eigen::Vector2d(slope, -slope));
  };
  return {{{0, 0}, {0, 1}}, interpolated(both), bound, rate, 0};
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
  pieces.back().varying = std::make_shared<const VaryingLaw>(VaryingLaw{
      {{0, 0}},
      [harmonics](double theta, double step) { return Matrix(fourier_terms(harmonics, theta, step)); },
      bound,
      static_cast<double>(harmonics.size() - 1),
      0});
}

void DisturbedLaw::scale(double factor) {
  viscous *= factor;
  for (Piece& piece : pieces) {
    piece.stiffness *= factor;
    for (auto& [memory, force] : piece.held) force *= factor;
    if (!piece.varying) continue;
    VaryingLaw varying = *piece.varying;
    varying.bound *= std::abs(factor);
    varying.terms = [law = piece.varying, factor, forces = coordinates](double theta, double width) {
      Matrix terms = law->terms(theta, width);
      for (Index i = 0; i < terms.cols(); ++i) {
        if (law->places[static_cast<std::size_t>(i)].row < forces) terms.col(i) *= factor;
      }
      return terms;
    };
    piece.varying = std::make_shared<const VaryingLaw>(std::move(varying));
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
