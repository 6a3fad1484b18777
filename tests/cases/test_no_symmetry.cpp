// Structures without symmetry against harmonic balances of their own: all dofs or all harmonics at once, the
// dynamic stiffness by dense LU, and friction marched from event to event and integrated by Gauss.

#include <fmt/format.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "arcslip/sectors/matrix_market.hpp"
#include "catch.hpp"
#include "program.hpp"

using namespace arcslip;
using arcslip::testing::case_named;
using arcslip::testing::TemporaryFolder;

namespace {

/// x(theta) = Re sum x_a e^{j h_a theta}, h = 1, 3, 5, ...
struct Course {
  ComplexVector x;
  double value(double theta) const { return sums(theta).real(); }
  double slope(double theta) const { return sums(theta).imag(); }

  /// The value and, as imaginary part, the slope.
  Complex sums(double theta) const {
    const Complex twice = std::polar(1.0, 2 * theta);
    Complex turn = std::polar(1.0, theta);
    Complex total = 0;
    for (Index a = 0; a < x.size(); ++a, turn *= twice) {
      const Complex term = x(a) * turn;
      total += Complex(term.real(), -static_cast<double>(2 * a + 1) * term.imag());
    }
    return total;
  }
};

double bisect(const std::function<double(double)>& f, double a, double b) {
  const bool rises = f(b) > f(a);
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (a + b);
    ((f(middle) > 0) == rises ? b : a) = middle;
  }
  return 0.5 * (a + b);
}

/// Adds the harmonics of f over a stretch, its mean over one period of 2 pi.
void integrate(double a, double b, const std::function<double(double)>& f, ComplexVector& harmonics) {
  constexpr std::array<double, 4> node = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                          0.9602898564975363};
  constexpr std::array<double, 4> weight = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                            0.1012285362903763};
  const int panels = static_cast<int>((b - a) / 0.3) + 1;
  const double half = 0.5 * (b - a) / panels;
  for (int k = 0; k < panels; ++k) {
    for (std::size_t i = 0; i < 8; ++i) {
      const double theta = a + (2 * k + 1) * half + (i < 4 ? half : -half) * node[i % 4];
      const Complex twice = std::polar(1.0, -2 * theta);
      Complex part = weight[i % 4] * half / pi * f(theta) * std::polar(1.0, -theta);
      for (Index h = 0; h < harmonics.size(); ++h, part *= twice) harmonics(h) += part;
    }
  }
}

/// Of a spring k behind a slider that yields at `limit`, from event to event; the second period counts.
ComplexVector friction(const ComplexVector& x, double k, double limit) {
  const Course course{x};
  const double step = two_pi / 250;
  ComplexVector harmonics = ComplexVector::Zero(x.size());
  double at = 0;       // start of the stretch
  double slider = 0;   // where the spring is slack
  double sliding = 0;  // the sign of the force in slip, 0 in stick
  const auto force = [&](double theta) {
    return sliding != 0 ? sliding * limit : k * (course.value(theta) - slider);
  };
  const auto end_stretch = [&](double end) {
    const double from = std::max(at, two_pi);
    if (end > from) integrate(from, end, force, harmonics);
    at = end;
  };
  for (int i = 1; i <= 500; ++i) {
    double next = i * step;
    if (sliding == 0 && std::abs(force(next)) > limit) {
      const double sign = force(next) > 0 ? 1 : -1;
      next =
          bisect([&](double theta) { return sign * force(theta) - limit; }, std::max(at, next - step), next);
      end_stretch(next);
      sliding = sign;
    } else if (sliding != 0 && sliding * course.slope(next) < 0) {
      next = bisect([&](double theta) { return course.slope(theta); }, std::max(at, next - step), next);
      end_stretch(next);
      slider = course.value(next) - sliding * limit / k;
      sliding = 0;
    }
  }
  end_stretch(2 * two_pi);
  return harmonics;
}

ComplexVector cubic(const ComplexVector& x, double k3) {
  const Course course{x};
  ComplexVector harmonics = ComplexVector::Zero(x.size());
  integrate(
      0, two_pi, [&](double theta) { return k3 * std::pow(course.value(theta), 3); }, harmonics);
  return harmonics;
}

/// A force w f(w^T q).
struct HysteresisBranch {
  Vector w;
  std::function<ComplexVector(const ComplexVector&)> force;
};

/// Newton's method with differences, to rounding.
Vector solved(const std::function<Vector(const Vector&)>& residual, Vector u) {
  for (int i = 0; i < 30; ++i) {
    const Vector r = residual(u);
    Matrix jacobian(r.size(), u.size());
    for (Index j = 0; j < u.size(); ++j) {
      Vector moved = u;
      const double step = 1e-6 * (std::abs(u(j)) + 1e-3 * u.cwiseAbs().maxCoeff());
      moved(j) = u(j) + step;
      jacobian.col(j) = residual(moved);
      moved(j) = u(j) - step;
      jacobian.col(j) = (jacobian.col(j) - residual(moved)) / (2 * step);
    }
    const Vector change = jacobian.partialPivLu().solve(r);
    u -= change;
    if (change.norm() < 1e-13 * u.norm()) return u;
  }
  return u;
}

struct Balance {
  Matrix m, c, k;
  Vector load;
  std::vector<HysteresisBranch> branches;
  Index harmonics;

  /// q of all harmonics, real parts and imaginary ones, harmonic by harmonic.
  ComplexMatrix motion(const Vector& u) const {
    ComplexMatrix q(m.rows(), harmonics);
    for (Index i = 0; i < q.size(); ++i) q(i % m.rows(), i / m.rows()) = Complex(u(2 * i), u(2 * i + 1));
    return q;
  }
  Vector residual(const Vector& u, double w) const {
    const ComplexMatrix q = motion(u);
    ComplexMatrix r(q.rows(), q.cols());
    for (Index a = 0; a < harmonics; ++a) {
      const double hw = static_cast<double>(2 * a + 1) * w;
      r.col(a) = k * q.col(a) + Complex(0, hw) * (c * q.col(a)) - hw * hw * (m * q.col(a));
    }
    r.col(0) -= load;
    for (const HysteresisBranch& branch : branches)
      r += branch.w * branch.force(q.transpose() * branch.w).transpose();
    Vector out(u.size());
    for (Index i = 0; i < r.size(); ++i) out.segment<2>(2 * i) << r(i).real(), r(i).imag();
    return out;
  }
};

Matrix matrix(const std::string& name) {
  const std::string path = testing::source_folder() + "/problems/nlvib/" + name + ".mtx";
  return Matrix(read_matrix_market(testing::read(path), path));
}

/// The run of a case, at the `user` points by the name of the column.
struct CaseRun {
  CaseRun(const std::string& name, const std::string& values) {
    const auto outcome =
        testing::arcslip_program(fmt::format("run '{}' -o '{}' --quiet --set 'continuation.stop_at=[{}]'",
                                             case_named(name), folder.path("out"), values));
    INFO(outcome.err);
    REQUIRE(outcome.status == 0);
    rows = testing::read_csv(folder.path("out/branches.csv"));
    for (std::size_t i = 1; i < rows.size(); ++i) {
      if (rows[i][2] == "user") points.push_back(i);
    }
  }
  double operator()(std::size_t point, const std::string& column) const {
    const auto found = std::find(rows[0].begin(), rows[0].end(), column);
    INFO(column);
    REQUIRE(found != rows[0].end());
    return std::stod(rows[points.at(point)][static_cast<std::size_t>(found - rows[0].begin())]);
  }
  TemporaryFolder folder;
  std::vector<std::vector<std::string>> rows;
  std::vector<std::size_t> points;
};

void check_near(double value, double expected, double tolerance = 1e-9) {
  CHECK_THAT(value, Catch::Matchers::WithinRel(expected, tolerance));
}

/// Walks from eta `from` to each of `values` and compares all dofs there.
void compare(const std::string& name, const Balance& balance, double from,
             const std::vector<double>& values) {
  const CaseRun run(name, fmt::format("{}", fmt::join(values, ", ")));
  REQUIRE(run.points.size() >= values.size());
  Vector u = Vector::Zero(2 * balance.m.rows() * balance.harmonics);
  for (Index i = 0; i < balance.m.rows(); ++i) u(2 * i) = 1e-2 * balance.load.norm();
  double eta = from;
  for (std::size_t point = 0; point < values.size(); ++point) {
    while (eta < values[point]) {
      eta = std::min(eta + 0.001, values[point]);
      u = solved([&](const Vector& v) { return balance.residual(v, two_pi * eta); }, u);
    }
    CAPTURE(name, eta);
    check_near(run(point, "eta"), eta, 1e-14);
    const ComplexMatrix q = balance.motion(u);
    for (Index i = 0; i < q.rows(); ++i)
      check_near(run(point, fmt::format("Y_{}", i + 1)), std::abs(q(i, 0)));
    const ComplexVector first = q.transpose() * balance.branches.front().w;
    check_near(run(point, "R"), std::abs(first(0)));
    check_near(run(point, "R_h3"), std::abs(first(1)), 1e-8);
  }
}

}  // namespace

TEST_CASE("Two Jenkins elements and two cubic springs in a row of masses are as balanced otherwise",
          "[numbers]") {
  Balance chain{
      matrix("chain_mass"), matrix("chain_damping"), matrix("chain_stiffness"), Vector::Unit(3, 1), {}, 4};
  const auto jenkins = [](const ComplexVector& x) { return friction(x, 20, 1); };
  const auto spring = [](const ComplexVector& x) { return cubic(x, 1); };
  chain.branches = {{Eigen::Vector3d(1, 0, 0), jenkins},
                    {Eigen::Vector3d(-1, 1, 0), jenkins},
                    {Eigen::Vector3d(0, 1, 0), spring},
                    {Eigen::Vector3d(0, -1, 1), spring}};
  compare("nlvib_jenkins", chain, 0.0796, {0.1, 0.135, 0.18});
}

TEST_CASE("Two Duffing oscillators, where nothing rubs, are as balanced otherwise", "[numbers]") {
  Balance pair{matrix("pair_mass"),
               matrix("pair_damping"),
               matrix("pair_stiffness"),
               0.11 * Vector::Unit(2, 0),
               {},
               4};
  pair.branches = {{Eigen::Vector2d(1, 0), [](const ComplexVector& x) { return cubic(x, 1); }},
                   {Eigen::Vector2d(1, -1), [](const ComplexVector& x) { return cubic(x, 0.0042); }}};
  compare("nlvib_duffing_pair", pair, 0.1274, {0.14, 0.16, 0.17});
}

TEST_CASE("Frequency and damping of a beam's mode over its amplitude are as balanced otherwise",
          "[numbers]") {
  const Matrix m = matrix("beam_mass");
  const Matrix k = matrix("beam_stiffness");
  constexpr Index dof = 20;
  const double beta = 2 * 0.01 / (two_pi * 99.270419269413949);
  const std::vector<double> values = {5e-5, 1e-4, 2e-4, 1e-3};
  const CaseRun run("nlvib_beam", fmt::format("{}", fmt::join(values, ", ")));
  REQUIRE(run.points.size() == values.size());
  Vector u = Vector::Zero(12);  // x_3, ..., x_11, eta, zeta, with x_1 = R
  u.tail<2>() << 99.270419269413949, 0.0065;
  double R = 2e-5;
  for (std::size_t point = 0; point < values.size(); ++point) {
    for (bool done = false; !done;) {
      R = std::min(1.5 * R, values[point]);
      done = R == values[point];
      const auto residual = [&](const Vector& v) {
        ComplexVector x(6);
        x(0) = R;
        for (Index a = 1; a < 6; ++a) x(a) = R * Complex(v(2 * a - 2), v(2 * a - 1));
        const ComplexVector f = friction(x, 3e7, 2400);
        const double w = two_pi * v(10);
        Vector out(12);
        for (Index a = 0; a < 6; ++a) {
          const double hw = static_cast<double>(2 * a + 1) * w;
          const ComplexMatrix z = Complex(1, beta * hw) * k + Complex(-hw * hw, -2 * v(11) * w * hw) * m;
          const Complex c = z.partialPivLu().solve(ComplexVector::Unit(m.rows(), dof))(dof);
          const Complex r = (x(a) / c + f(a)) / (3e7 * R);
          out.segment<2>(2 * a) << r.real(), r.imag();
        }
        return out;
      };
      u = solved(residual, u);
    }
    CAPTURE(R);
    check_near(run(point, "R"), R, 1e-12);
    check_near(run(point, "eta"), u(10));
    check_near(run(point, "zeta"), u(11));
  }
}
