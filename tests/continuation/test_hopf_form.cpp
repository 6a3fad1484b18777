// First Lyapunov coefficients of Hopf points, against closed forms.

#include <Eigen/LU>
#include <cmath>

#include "arcslip/continuation/points/hopf_form.hpp"
#include "catch.hpp"
#include "engine_problems.hpp"

using namespace arcslip;
using namespace arcslip::continuation;

namespace {

/// y1' = p y1 - w y2 + f, y2' = w y1 + p y2 + g, y3' = -y3 + k (y1^2 + y2^2), with quadratic and cubic f and
/// g of y1 and y2, and m y3 (y1, y2) added; in the coordinates u = T y.
class Oscillator : public Problem {
 public:
  double w = 1.3;
  double k = 0;
  double m = 0;
  Eigen::Matrix<double, 2, 7> terms = Eigen::Matrix<double, 2, 7>::Zero();  // y1^2, y1 y2, y2^2, y1^3, ...
  Matrix to = Matrix::Identity(3, 3);                                       // T

  Index size() const override { return 3; }
  std::vector<std::string> parameter_names() const override { return {"p"}; }
  bool is_equilibrium() const override { return true; }
  bool evaluate(const Vector& u, const Vector& p, const Regime& /*regime*/,
                const Evaluation& out) const override {
    const Matrix from = to.inverse();
    const Vector y = from * u;
    const double a = y(0);
    const double b = y(1);
    Eigen::Matrix<double, 7, 1> powers;
    powers << a * a, a * b, b * b, a * a * a, a * a * b, a * b * b, b * b * b;
    Eigen::Matrix<double, 7, 2> slopes;
    slopes << 2 * a, 0, b, a, 0, 2 * b, 3 * a * a, 0, 2 * a * b, a * a, b * b, 2 * a * b, 0, 3 * b * b;
    Vector f(3);
    f.head(2) = terms * powers;
    f(0) += p(0) * a - w * b + m * a * y(2);
    f(1) += w * a + p(0) * b + m * b * y(2);
    f(2) = -y(2) + k * (a * a + b * b);
    Matrix j = Matrix::Zero(3, 3);
    j.topLeftCorner(2, 2) = terms * slopes;
    j.topLeftCorner(2, 2) += Eigen::Matrix2d{{p(0) + m * y(2), -w}, {w, p(0) + m * y(2)}};
    j(0, 2) = m * a;
    j(1, 2) = m * b;
    j.row(2) << 2 * k * a, 2 * k * b, -1;
    if (out.residual != nullptr) *out.residual = to * f;
    if (out.jacobian != nullptr) *out.jacobian = to * j * from;
    if (out.parameter_jacobian != nullptr) out.parameter_jacobian->col(0) = to * Eigen::Vector3d(a, b, 0);
    return true;
  }

  /// l_1 in y, where q = (1, -j)/sqrt(2): twice a/w, a of r' = a r^3 [J. Guckenheimer, P. Holmes, Nonlinear
  /// Oscillations, Springer 1983, (3.4.11)], to which y3 = k r^2 + ... adds k m.
  double expected() const {
    const auto f = terms.row(0);
    const auto g = terms.row(1);
    const double cubic = 6 * f(3) + 2 * f(5) + 2 * g(4) + 6 * g(6);
    const double quadratic =
        f(1) * (2 * f(0) + 2 * f(2)) - g(1) * (2 * g(0) + 2 * g(2)) - 4 * f(0) * g(0) + 4 * f(2) * g(2);
    return 2 * ((cubic + quadratic / w) / 16 + by_third()) / w;
  }

  /// Of the third coordinate: its mean k r^2 and, of twice the frequency, nothing, as r^2 has no such part.
  double by_third() const { return k * m; }
};

HopfForm form_of(const Problem& problem) {
  const auto form = hopf_form(problem, {Vector::Zero(problem.size()), Vector::Zero(1), 0, {}});
  REQUIRE(form);
  return *form;
}

}  // namespace

TEST_CASE("The first Lyapunov coefficient is that of the normal form") {
  Oscillator problem;
  problem.terms.row(0) << 0, 0, 0, -.7, -.4, -.7, -.4;  // z' = j w z + (s + j b) z |z|^2 in y1 + j y2
  problem.terms.row(1) << 0, 0, 0, .4, -.7, .4, -.7;
  CHECK_THAT(form_of(problem).omega, WithinRel(1.3, 1e-12));
  CHECK_THAT(form_of(problem).lyapunov, WithinRel(-2 * .7 / 1.3, 1e-9));
  CHECK_THAT(problem.expected(), WithinRel(-2 * .7 / 1.3, 1e-12));
}

TEST_CASE("First Lyapunov coefficients of quadratic and cubic terms, in any coordinates") {
  std::srand(5);
  for (int i = 0; i < 20; ++i) {
    Oscillator problem;
    problem.w = .3 + .2 * i;
    problem.terms.setRandom();
    if (i % 2 == 1) {
      problem.k = .8;
      problem.m = -.6;
    }
    const double expected = problem.expected();
    CAPTURE(i, expected);
    CHECK_THAT(form_of(problem).lyapunov, WithinAbs(expected, 1e-7 * (1 + std::abs(expected))));
    problem.to = Matrix::Random(3, 3) + 2 * Matrix::Identity(3, 3);
    ComplexVector q(3);
    q << Complex(1, 0), Complex(0, -1), 0;
    const double stretched = (problem.to.cast<Complex>() * q).squaredNorm() / 2;
    CHECK_THAT(form_of(problem).lyapunov,
               WithinAbs(expected / stretched, 1e-7 * (1 + std::abs(expected / stretched))));
  }
}

TEST_CASE("Where no pair of eigenvalues is imaginary there is no normal form of a Hopf point") {
  const testing::Cusp cusp;
  const Vector parameters = Vector::Zero(static_cast<Index>(cusp.parameter_names().size()));
  CHECK_FALSE(hopf_form(cusp, {Vector::Zero(1), parameters, 0, {}}));
}

namespace {

/// Three equal oscillators x_i'' = (mu - x_i^2) x_i' - x_i + d (sum of v_j - 3 v_i), v_i = x_i': in phase one
/// pair is on the axis at mu = 0, out of phase two are at mu = 3 d.
class EqualOscillators : public Problem {
 public:
  static constexpr double d = 0.1;
  Index size() const override { return 6; }
  std::vector<std::string> parameter_names() const override { return {"mu"}; }
  bool is_equilibrium() const override { return true; }
  bool evaluate(const Vector& u, const Vector& p, const Regime& /*regime*/,
                const Evaluation& out) const override {
    const Vector x = u.head(3);
    const Vector v = u.tail(3);
    if (out.residual != nullptr) {
      out.residual->head(3) = v;
      out.residual->tail(3) =
          ((p(0) - 3 * d - x.array().square()) * v.array() - x.array() + d * v.sum()).matrix();
    }
    if (out.jacobian != nullptr) {
      out.jacobian->setZero();
      out.jacobian->topRightCorner(3, 3).setIdentity();
      out.jacobian->bottomRightCorner(3, 3).setConstant(d);
      for (Index i = 0; i < 3; ++i) {
        (*out.jacobian)(3 + i, i) = -1 - 2 * x(i) * v(i);
        (*out.jacobian)(3 + i, 3 + i) += p(0) - 3 * d - x(i) * x(i);
      }
    }
    if (out.parameter_jacobian != nullptr) *out.parameter_jacobian << Vector::Zero(3), v;
    return true;
  }
};

}  // namespace

TEST_CASE("Two equal pairs that are on the axis together have no Lyapunov coefficient") {
  const EqualOscillators problem;
  const auto at = [&](double mu) {
    const auto form = hopf_form(problem, {Vector::Zero(6), Vector::Constant(1, mu), 0, {}});
    REQUIRE(form);
    CHECK_THAT(form->omega, WithinAbs(1, 1e-9));
    return *form;
  };
  CHECK(at(0).pairs == 1);
  CHECK(at(0).lyapunov < 0);
  CHECK(at(3 * EqualOscillators::d).pairs == 2);
  CHECK(std::isnan(at(3 * EqualOscillators::d).lyapunov));
}
