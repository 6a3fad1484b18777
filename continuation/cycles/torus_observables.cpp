// What is told of tori.

#include <cmath>

#include "arcslip/continuation/cycles/torus.hpp"
#include "arcslip/dense.hpp"

namespace arcslip::continuation {
namespace {

/// 1, cos(theta), sin(theta), cos(2 theta), ... and two derivatives: m x 3.
Matrix waves_at(double theta, Index m) {
  Matrix result = Matrix::Zero(m, 3);
  result(0, 0) = 1;
  for (Index h = 1; 2 * h < m; ++h) {
    const auto rate = static_cast<double>(h);
    const Complex wave = std::polar(1.0, rate * theta);
    result.middleRows(2 * h - 1, 2) << wave.real(), -rate * wave.imag(), -rate * rate * wave.real(),  //
        wave.imag(), rate * wave.real(), -rate * rate * wave.imag();
  }
  return result;
}

}  // namespace

/// Of one unknown, with the ends of both angles: (m_1 + 1) x (m_2 + 1).
Matrix Torus::closed(const Matrix& values, Index unknown) const {
  Matrix result(count(0) + 1, count(1) + 1);
  result.topLeftCorner(count(0), count(1)) = values.row(unknown).reshaped(count(0), count(1));
  result.rightCols(1) = result.col(0);
  result.bottomRows(1) = result.row(0).array() + grid_.winding(unknown);
  return result;
}

/// The largest value between places, about the highest of many.
double Torus::highest(const Matrix& values, double sign) const {
  const Matrix seen = sign * first_.looks() * values * second_.looks().transpose();
  Index row = 0;
  Index column = 0;
  const double best = seen.maxCoeff(&row, &column);
  if (std::abs(values(count(0), 0) - values(0, 0)) > 1e-6 * (best + (-seen).maxCoeff())) return sign * best;
  const Matrix half = first_.coefficients(values.leftCols(count(1)).transpose());  // m_2 x m_1
  Matrix closed_half(count(0), count(1) + 1);
  closed_half << half.transpose(), half.transpose().col(0);
  const Matrix coefficients = sign * second_.coefficients(closed_half);  // m_1 x m_2
  Eigen::Vector2d place(two_pi * static_cast<double>(row) / static_cast<double>(seen.rows() - 1),
                        two_pi * static_cast<double>(column) / static_cast<double>(seen.cols() - 1));
  double value = best;
  constexpr int rounds = 6;
  for (int round = 0; round < rounds; ++round) {
    const Matrix at = waves_at(place(0), count(0)).transpose() * coefficients * waves_at(place(1), count(1));
    value = std::max(value, at(0, 0));
    const Matrix bend{{at(2, 0), at(1, 1)}, {at(1, 1), at(0, 2)}};
    constexpr double unchanged = 1e-6;  // it may not change with one of them
    place -= least_squares_of(bend, unchanged)(Eigen::Vector2d(at(1, 0), at(0, 1)));
  }
  return sign * value;
}

std::vector<Observable> Torus::observables() const {
  std::vector<Observable> all{{"omega_1"}, {"omega_2"}, {"rotation"}};
  for (const std::string& name : field_->names()) {
    all.push_back({name + "_max"});
    all.push_back({name + "_min"});
  }
  all.push_back({"norm"});
  return all;
}

void Torus::observe(const Vector& u, const Vector& p, const Regime& /*regime*/, Vector& values) const {
  const Matrix on_grid = this->values(u);
  const Index n = on_grid.rows();
  values.resize(2 * n + 4);
  values.head(3) << omega_1(u, p), omega_2(u), omega_2(u) / omega_1(u, p);
  for (Index i = 0; i < n; ++i) {
    const Matrix one = closed(on_grid, i);
    values(3 + 2 * i) = highest(one, 1);
    values(4 + 2 * i) = highest(one, -1);
  }
  values(2 * n + 3) = std::sqrt(on_grid.squaredNorm() / static_cast<double>(on_grid.cols()));
}

}  // namespace arcslip::continuation
