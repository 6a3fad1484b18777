#include "arcslip/problems/library/lure.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "arcslip/continuation/linear/hill.hpp"
#include "arcslip/problems/library/model.hpp"

namespace arcslip::problems {
namespace {

constexpr Index first_cosine = 1;
constexpr Index first_sine = 2;

/// Amplitude 0 marks a birth of the cycle that lies ahead.
struct Birth {
  double frequency_squared;
  double amplitude_squared;
  Complex second;  // amplitude of the second harmonic over A^2
};

/// With amplitude A: c_0 = A^2/2, X_2 = A^2/(2 L(2 j w)), L(j w) = A^2 g, L(s) = s^3 + a s^2 + b s + 1, and
/// w^2 = b, a = 1/b in what is multiplied by A^2.
Birth near_birth(double a, double b) {
  const double root = std::sqrt(b);
  const Complex second = 0.5 / Complex(-3, -6 * b * root);
  const Complex g = 1.0 + second;
  const double bend = g.real() - g.imag() / (b * root);  // a = (1 - bend A^2)/b; at least 1/2
  const double square = std::max(0.0, 1 - a * b) / bend;
  return {b - square * g.imag() / root, square, second};
}

/// A_0, A_1, ... of disturbances (x, y, z).
std::vector<ComplexMatrix> variation(const Vector& u, const Vector& p) {
  ComplexVector slope(u.size() / 2);  // of x^2
  slope(0) = 2 * u(0);
  for (Index k = 1; k < slope.size(); ++k) slope(k) = Complex(u(2 * k - 1), -u(2 * k));
  const auto count = static_cast<std::size_t>(continuation::significant(slope));
  std::vector<ComplexMatrix> coefficients(count, ComplexMatrix::Zero(3, 3));
  coefficients[0] << 0, 1, 0, 0, 0, 1, -1, -p(LureCycle::b), -p(LureCycle::a);
  for (std::size_t k = 0; k < count; ++k) coefficients[k](2, 0) += slope(static_cast<Index>(k));
  return coefficients;
}

Index twice_dense_order(const std::vector<ComplexMatrix>& coefficients) {
  return 2 * static_cast<Index>(coefficients.size()) - 2;
}

}  // namespace

// x^2 cos k t has harmonics up to 3 H.
LureCycle::LureCycle(Index harmonics) {
  const Index samples = 3 * harmonics + 1;
  basis_.resize(samples, 2 * harmonics + 1);
  for (Index j = 0; j < samples; ++j) {
    const double t = two_pi * static_cast<double>(j) / static_cast<double>(samples);
    basis_(j, 0) = 1;
    for (Index k = 1; k <= harmonics; ++k) {
      basis_(j, 2 * k - 1) = std::cos(static_cast<double>(k) * t);
      basis_(j, 2 * k) = std::sin(static_cast<double>(k) * t);
    }
  }
}

bool LureCycle::evaluate(const Vector& u, const Vector& p, const continuation::Regime& /*regime*/,
                         const continuation::Evaluation& out) const {
  const Index n = basis_.cols();
  const double w = u(n);
  const Vector x = basis_ * u.head(n);
  Matrix projection = 2 / static_cast<double>(basis_.rows()) * basis_.transpose();
  projection.row(0) *= 0.5;
  Matrix linear = Matrix::Identity(n, n);
  Vector by_w = Vector::Zero(n), by_a = by_w, by_b = by_w;
  for (Index k = 1; k <= harmonics(); ++k) {
    const auto order = static_cast<double>(k);
    const double v = order * w;
    const double c = u(2 * k - 1), s = u(2 * k);
    const double even = 1 - p(a) * v * v, odd = p(b) * v - v * v * v;
    const double even_slope = -2 * p(a) * v * order, odd_slope = (p(b) - 3 * v * v) * order;
    linear.block<2, 2>(2 * k - 1, 2 * k - 1) << even, odd, -odd, even;
    by_w.segment<2>(2 * k - 1) << even_slope * c + odd_slope * s, even_slope * s - odd_slope * c;
    by_a.segment<2>(2 * k - 1) << -v * v * c, -v * v * s;
    by_b.segment<2>(2 * k - 1) << v * s, -v * c;
  }
  if (out.residual != nullptr)
    *out.residual << linear * u.head(n) - projection * x.cwiseAbs2(), u(first_sine);
  if (out.jacobian != nullptr) {
    out.jacobian->setZero();
    out.jacobian->topLeftCorner(n, n) = linear - projection * (2 * x).asDiagonal() * basis_;
    out.jacobian->col(n).head(n) = by_w;
    (*out.jacobian)(n, first_sine) = 1;
  }
  if (out.parameter_jacobian != nullptr) {
    out.parameter_jacobian->setZero();
    out.parameter_jacobian->col(a).head(n) = by_a;
    out.parameter_jacobian->col(b).head(n) = by_b;
  }
  return true;
}

void LureCycle::observe(const Vector& u, const Vector& /*p*/, const continuation::Regime& /*regime*/,
                        Vector& values) const {
  values.resize(2);
  values << std::hypot(u(first_cosine), u(first_sine)), two_pi / u(basis_.cols());
}

double LureCycle::observe(const Vector& u, const Vector& p, const continuation::Regime& regime, Index which,
                          continuation::Gradient& gradient) const {
  Vector values;
  observe(u, p, regime, values);
  gradient.unknowns.setZero();
  gradient.parameters.setZero();
  if (which == 1) gradient.unknowns(basis_.cols()) = -values(1) / u(basis_.cols());
  if (which == 0 && values(0) > 0) gradient.unknowns.segment<2>(1) = u.segment<2>(1) / values(0);
  return values(which);
}

bool LureCycle::eigenvalues(const Vector& u, const Vector& p, const continuation::Regime& /*regime*/,
                            ComplexVector& values) const {
  if (!u.allFinite() || !p.allFinite()) return false;
  const auto coefficients = variation(u, p);
  const auto all =
      continuation::floquet_exponents(coefficients, u(basis_.cols()), twice_dense_order(coefficients));
  Index shift = 0;  // in time, which the truncated problem has exactly
  all.exponents.cwiseAbs().minCoeff(&shift);
  values.resize(2);
  values << all.rates.head(shift), all.rates.tail(2 - shift);
  return values.allFinite();
}

void LureCycle::test(const Vector& u, const Vector& p, const continuation::Regime& /*regime*/,
                     Vector& values) const {
  values.setConstant(1, std::nan(""));
  if (!u.allFinite() || !p.allFinite()) return;
  const auto coefficients = variation(u, p);
  values(0) =
      continuation::doubling_determinant(coefficients, u(basis_.cols()), twice_dense_order(coefficients));
}

continuation::Guess LureCycle::guess(const Vector& p) const {
  constexpr double near = 0.01;  // of a, where the amplitude is a tenth and its cube what is left out
  Vector start = p;
  start(a) = std::max(p(a), (1 - near) / p(b));
  const Birth birth = near_birth(start(a), p(b));
  Vector u = Vector::Zero(size());
  u(0) = 0.5 * birth.amplitude_squared;
  u(first_cosine) = std::sqrt(birth.amplitude_squared);
  if (harmonics() > 1) {
    u(3) = birth.amplitude_squared * birth.second.real();
    u(4) = -birth.amplitude_squared * birth.second.imag();
  }
  u(size() - 1) = std::sqrt(birth.frequency_squared);
  if (start(a) == p(a)) return {u, p, 0, {}};
  continuation::TraceOptions options;
  options.parameter = "a";
  options.from = start(a);
  options.to = p(a);
  const continuation::Branch branch = continuation::trace(*this, {u, start, 0, {}}, options);
  return {branch.points.empty() ? u : branch.points.back().unknowns, p, 0, {}};
}

LibraryModel lure_model() {
  const auto build = [](const LibraryModel::Values& values) -> std::unique_ptr<continuation::Problem> {
    return std::make_unique<LureCycle>(static_cast<Index>(values[2]));
  };
  const auto guess = [](const continuation::Problem& /*problem*/, const LibraryModel::Values& values) {
    return LureCycle(static_cast<Index>(values[2])).guess(parameters_of(values, 2));
  };
  constexpr double most = std::numeric_limits<double>::max();
  return {"lure",
          "the cycle of a Lur'e system by harmonic balance",
          {any_value("a", 0.9, "damping"),
           {"b", 1, 1e-3, most, false, "stiffness"},
           {"harmonics", 12, 1, 99, true, "highest harmonic"}},
          build,
          guess};
}

}  // namespace arcslip::problems
