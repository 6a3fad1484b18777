// Whole bifurcation diagrams, branch points and all, against closed forms.

#include <cmath>
#include <numbers>

#include "arcslip/continuation/path/switching.hpp"
#include "branches.hpp"
#include "catch.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;

namespace {

/// u'' + lambda (u - u^3) = 0, u(0) = u(pi) = 0 [Chafee & Infante 1974] by differences on m inner points,
/// times h^2. From u = 0 pitchforks leave at lambda = 4/h^2 sin^2(k h/2), near k^2.
class ChafeeInfante : public Problem {
 public:
  ChafeeInfante(Index m, bool sparse) : m_(m), sparse_(sparse) {}
  Index size() const override { return m_; }
  std::vector<std::string> parameter_names() const override { return {"lambda"}; }
  bool sparse() const override { return sparse_; }
  double spacing() const { return std::numbers::pi / static_cast<double>(m_ + 1); }

  bool evaluate(const Vector& u, const Vector& p, const Regime& /*regime*/,
                const Evaluation& out) const override {
    const double h = spacing();
    Matrix jacobian = Matrix::Zero(m_, m_);
    for (Index i = 0; i < m_; ++i) {
      const double left = i > 0 ? u(i - 1) : 0;
      const double right = i + 1 < m_ ? u(i + 1) : 0;
      const double source = h * h * (u(i) - u(i) * u(i) * u(i));
      if (out.residual != nullptr) (*out.residual)(i) = left - 2 * u(i) + right + p(0) * source;
      if (out.parameter_jacobian != nullptr) (*out.parameter_jacobian)(i, 0) = source;
      jacobian(i, i) = -2 + p(0) * h * h * (1 - 3 * u(i) * u(i));
      if (i > 0) jacobian(i, i - 1) = 1;
      if (i + 1 < m_) jacobian(i, i + 1) = 1;
    }
    if (out.sparse_jacobian != nullptr) *out.sparse_jacobian = jacobian.sparseView();
    if (out.jacobian != nullptr) *out.jacobian = jacobian;
    return true;
  }

 private:
  Index m_;
  bool sparse_;
};

/// x' = s (y - x), y' = x (r - z) - y, z' = x y - b z [Lorenz 1963], s = 10, b = 8/3.
class Lorenz : public Problem {
 public:
  Index size() const override { return 3; }
  std::vector<std::string> parameter_names() const override { return {"r"}; }
  bool is_equilibrium() const override { return true; }
  bool evaluate(const Vector& u, const Vector& p, const Regime& /*regime*/,
                const Evaluation& out) const override {
    constexpr double s = 10, b = 8.0 / 3;
    const double x = u(0), y = u(1), z = u(2), r = p(0);
    if (out.residual != nullptr) *out.residual << s * (y - x), x * (r - z) - y, x * y - b * z;
    if (out.jacobian != nullptr) *out.jacobian << -s, s, 0, r - z, -1, -x, y, x, -b;
    if (out.parameter_jacobian != nullptr) *out.parameter_jacobian << 0, x, 0;
    return true;
  }
};

}  // namespace

TEST_CASE("From the rest state of Chafee and Infante's problem all pitchforks are found and left both ways") {
  const bool sparse = GENERATE(false, true);
  const ChafeeInfante problem(30, sparse);
  const std::vector<Branch> all =
      trace_connected(problem, {Vector::Zero(30), Vector::Constant(1, 0.5)}, over("lambda", 0.5, 20));
  const auto found = of_type(all.front(), PointType::branch_point);
  REQUIRE(found.size() == 4);
  const double h = problem.spacing();
  for (std::size_t k = 0; k < 4; ++k) {
    const double root = std::sin(static_cast<double>(k + 1) * h / 2);
    CHECK_THAT(found[k].parameters(0), WithinRel(4 / (h * h) * root * root, 1e-10));
  }
  REQUIRE(all.size() == 9);
  for (std::size_t i = 1; i < 9; i += 2) {  // u and -u
    CHECK(all[i].stop == Stop::reached_end);
    CHECK((all[i].points.back().unknowns + all[i + 1].points.back().unknowns).norm() < 1e-8);
    CHECK(of_type(all[i], PointType::fold).empty());
    CHECK(of_type(all[i], PointType::branch_point).empty());
  }
}

TEST_CASE("Lorenz' convection begins at r = 1 and becomes unstable at r = 470/19") {
  const std::vector<Branch> all =
      trace_connected(Lorenz(), {Vector::Zero(3), Vector::Zero(1)}, over("r", 0, 30));
  REQUIRE(all.size() == 3);
  const auto onset = of_type(all[0], PointType::branch_point);
  REQUIRE(onset.size() == 1);
  CHECK_THAT(onset[0].parameters(0), WithinRel(1.0, 1e-10));
  for (const std::size_t i : {1, 2}) {
    // s (s + b + 3)/(s - b - 1), with omega^2 = 2 s b (s + 1)/(s - b - 1)
    const auto hopf = of_type(all[i], PointType::hopf);
    REQUIRE(hopf.size() == 1);
    CHECK_THAT(hopf[0].parameters(0), WithinRel(470.0 / 19, 1e-10));
    const double omega = hopf[0].eigenvalues.imag().maxCoeff();
    CHECK_THAT(omega * omega, WithinRel(2 * 10 * (8.0 / 3) * 11 / (10 - 8.0 / 3 - 1), 1e-9));
    CHECK(all[i].points.back().unstable == 2);
  }
}
