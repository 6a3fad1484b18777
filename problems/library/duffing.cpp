#include "arcslip/problems/library/duffing.hpp"

#include <cmath>
#include <complex>
#include <numbers>

#include "arcslip/continuation/linear/hill.hpp"
#include "arcslip/problems/library/model.hpp"

namespace arcslip::problems {
namespace {

double order(Index which) { return static_cast<double>(2 * which + 1); }

/// i = +-1/2, ... over half a period: the response's own harmonics.
Index twice_order(const std::vector<ComplexMatrix>& coefficients) {
  return static_cast<Index>(coefficients.size()) - 1;
}

/// The response in the first harmonic without the cubic term.
Vector linear_response(const continuation::Problem& problem, const Vector& p) {
  using Duffing = DuffingOscillator;
  const double frequency = p(Duffing::frequency);
  const Complex response =
      p(Duffing::force) / Complex(1 - frequency * frequency, p(Duffing::damping) * frequency);
  Vector u = Vector::Zero(problem.size());
  u.head(2) << response.real(), -response.imag();
  return u;
}

}  // namespace

// With q antisymmetric over half a period q^3 cos k has harmonics 0, 2 .. 4 H, which 2 H + 1 samples of half
// a period tell apart from 0.
DuffingOscillator::DuffingOscillator(Index harmonics) {
  const Index pairs = (harmonics + 1) / 2;
  const Index samples = 4 * pairs - 1;
  basis_.resize(samples, 2 * pairs);
  for (Index j = 0; j < samples; ++j) {
    const double t = pi * static_cast<double>(j) / static_cast<double>(samples);
    for (Index k = 0; k < pairs; ++k) {
      basis_(j, 2 * k) = std::cos(order(k) * t);
      basis_(j, 2 * k + 1) = std::sin(order(k) * t);
    }
  }
}

Matrix DuffingOscillator::linear_part(const Vector& p) const {
  Matrix stiffness = Matrix::Zero(size(), size());
  for (Index k = 0; k < count(); ++k) {
    const double w = order(k) * p(frequency);
    const double damped = p(damping) * w;
    stiffness.block<2, 2>(2 * k, 2 * k) << 1 - w * w, damped, -damped, 1 - w * w;
  }
  return stiffness;
}

bool DuffingOscillator::evaluate(const Vector& u, const Vector& p, const continuation::Regime& /*regime*/,
                                 const continuation::Evaluation& out) const {
  const double weight = 2 / static_cast<double>(basis_.rows());
  const Matrix stiffness = linear_part(p);
  const Vector q = basis_ * u;
  const Vector cube = weight * (basis_.transpose() * q.array().cube().matrix());
  if (out.residual != nullptr) {
    *out.residual = stiffness * u + p(cubic) * cube;
    (*out.residual)(0) -= p(force);
  }
  if (out.jacobian != nullptr) {
    const Vector slope = 3 * weight * p(cubic) * q.array().square();
    *out.jacobian = stiffness + basis_.transpose() * slope.asDiagonal() * basis_;
  }
  if (out.parameter_jacobian == nullptr) return true;
  Matrix& by = *out.parameter_jacobian;
  by.setZero();
  by(0, force) = -1;
  by.col(cubic) = cube;
  for (Index k = 0; k < count(); ++k) {
    const double a = u(2 * k), b = u(2 * k + 1);
    const double w = order(k) * p(frequency);
    by.col(damping).segment<2>(2 * k) << w * b, -w * a;
    by.col(frequency).segment<2>(2 * k) << -2 * w * a + p(damping) * b, -2 * w * b - p(damping) * a;
    by.col(frequency).segment<2>(2 * k) *= order(k);
  }
  return true;
}

std::vector<continuation::Observable> DuffingOscillator::observables() const {
  std::vector<continuation::Observable> result;
  for (Index k = 0; k < count(); ++k) {
    std::string name = std::to_string(2 * k + 1);
    name.insert(name.begin(), 'a');
    // the higher ones may vanish, where an amplitude has no gradient
    result.push_back({std::move(name), k == 0});
  }
  result.push_back({"rms", true});
  return result;
}

void DuffingOscillator::observe(const Vector& u, const Vector& /*p*/, const continuation::Regime& /*regime*/,
                                Vector& values) const {
  values.resize(count() + 1);
  for (Index k = 0; k < count(); ++k) values(k) = u.segment<2>(2 * k).norm();
  values(count()) = u.norm() / std::numbers::sqrt2;
}

double DuffingOscillator::observe(const Vector& u, const Vector& /*p*/,
                                  const continuation::Regime& /*regime*/, Index which,
                                  continuation::Gradient& gradient) const {
  const bool all = which == count();
  const Index first = all ? 0 : 2 * which;
  const Index length = all ? size() : 2;
  const double norm = u.segment(first, length).norm();
  const double factor = all ? 1 / std::numbers::sqrt2 : 1;
  gradient.unknowns.setZero();
  gradient.parameters.setZero();
  if (norm > 0) gradient.unknowns.segment(first, length) = factor / norm * u.segment(first, length);
  return factor * norm;
}

/// A_0, A_1, ... of disturbances (y, y') over the harmonics 0, 2, 4, ... of the force.
std::vector<ComplexMatrix> DuffingOscillator::variation(const Vector& u, const Vector& p) const {
  ComplexVector half(count());
  for (Index k = 0; k < count(); ++k) half(k) = 0.5 * Complex(u(2 * k), -u(2 * k + 1));
  const Index pairs = continuation::significant(half);
  // q = sum c_m e^{jmWt} over odd m, c in their order; q^2 has the harmonics 2k.
  ComplexVector c(2 * pairs);
  c << half.head(pairs).conjugate().reverse(), half.head(pairs);
  std::vector<ComplexMatrix> coefficients(static_cast<std::size_t>(2 * pairs), ComplexMatrix::Zero(2, 2));
  coefficients[0] << 0, 1, -1, -p(damping);
  for (Index k = 0; k < 2 * pairs; ++k) {
    const auto upper = c.tail(2 * pairs - k).array();
    const Complex square = (upper * upper.reverse()).sum();
    coefficients[static_cast<std::size_t>(k)](1, 0) -= 3 * p(cubic) * square;
  }
  return coefficients;
}

void DuffingOscillator::test(const Vector& u, const Vector& p, const continuation::Regime& /*regime*/,
                             Vector& values) const {
  values.setConstant(1, std::nan(""));
  if (!u.allFinite() || !p.allFinite()) return;
  const auto coefficients = variation(u, p);
  values(0) = continuation::returning_determinant(coefficients, 2 * p(frequency), twice_order(coefficients));
}

bool DuffingOscillator::eigenvalues(const Vector& u, const Vector& p, const continuation::Regime& /*regime*/,
                                    ComplexVector& values) const {
  if (!u.allFinite() || !p.allFinite()) return false;
  const auto coefficients = variation(u, p);
  values = continuation::floquet_exponents(coefficients, 2 * p(frequency), twice_order(coefficients)).rates;
  if (values(0).imag() != 0) values.real().setConstant(-0.5 * p(damping));  // Liouville, without rounding
  return values.allFinite();
}

LibraryModel duffing_model() {
  const auto build = [](const LibraryModel::Values& values) -> std::unique_ptr<continuation::Problem> {
    return std::make_unique<DuffingOscillator>(static_cast<Index>(values[4]));
  };
  return {"duffing",
          "Duffing's oscillator by harmonic balance",
          {not_negative("W", 0.5, "frequency of the force"),
           any_value("force", 0.18, "its amplitude"),
           any_value("delta", 0.05, "damping"),
           any_value("k3", 0.1, "cubic stiffness"),
           {"harmonics", 9, 1, 999, true, "highest odd harmonic"}},
          build,
          guess_at(linear_response)};
}

}  // namespace arcslip::problems
