// Branch points at which several eigenvalues vanish at once, as of polygons: normal forms and rings of cells,
// with all their branches in closed form.

#include <array>
#include <cmath>

#include "arcslip/continuation/path/switching.hpp"
#include "arcslip/continuation/path/symmetric_branches.hpp"
#include "branches.hpp"
#include "catch.hpp"
#include "scalar_problem.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;
using Catch::Matchers::ContainsSubstring;

namespace {

Complex power(Complex z, int exponent) {
  Complex product = 1;
  for (int i = 0; i < exponent; ++i) product *= z;
  return product;
}

/// z' = lambda z - |z|^2 z + b conj(z)^(N-1), z = x + jy, that of a polygon's symmetry.
class Polygon : public Problem {
 public:
  Polygon(int corners, double b) : corners_(corners), b_(b) {}
  Index size() const override { return 2; }
  std::vector<std::string> parameter_names() const override { return {"lambda"}; }
  bool is_equilibrium() const override { return true; }
  bool evaluate(const Vector& u, const Vector& p, const Regime& /*regime*/,
                const Evaluation& out) const override {
    const Complex z(u(0), u(1));
    const Complex value = p(0) * z - std::norm(z) * z + b_ * power(std::conj(z), corners_ - 1);
    const Complex by_z = p(0) - 2 * std::norm(z);  // and by conj z
    const Complex by_conjugate = -z * z + b_ * (corners_ - 1.0) * power(std::conj(z), corners_ - 2);
    const Complex by_x = by_z + by_conjugate;
    const Complex by_y = Complex(0, 1) * (by_z - by_conjugate);
    if (out.residual != nullptr) *out.residual << value.real(), value.imag();
    if (out.jacobian != nullptr) *out.jacobian << by_x.real(), by_y.real(), by_x.imag(), by_y.imag();
    if (out.parameter_jacobian != nullptr) *out.parameter_jacobian << u(0), u(1);
    return true;
  }
  std::vector<Symmetry> symmetries() const override {
    std::vector<Symmetry> all;
    for (int k = 1; k < 2 * corners_; ++k) {
      const double angle = two_pi * k / corners_;
      const double sign = k < corners_ ? 1 : -1;  // mirrors turn y over first
      const Matrix map{{std::cos(angle), -sign * std::sin(angle)}, {std::sin(angle), sign * std::cos(angle)}};
      all.push_back({(sign > 0 ? "turn " : "mirror ") + std::to_string(k % corners_), map.sparseView()});
    }
    return all;
  }

 private:
  int corners_;
  double b_;
};

/// x_i' = lambda x_i + q x_i^2 - x_i^3 + k (x_{i+1} - 2 x_i + x_{i-1}), i = 1..N in a ring.
class Cells : public Problem {
 public:
  Cells(Index count, double q, double k) : count_(count), q_(q), k_(k) {}
  Index size() const override { return count_; }
  std::vector<std::string> parameter_names() const override { return {"lambda"}; }
  bool evaluate(const Vector& u, const Vector& p, const Regime& /*regime*/,
                const Evaluation& out) const override {
    if (out.jacobian != nullptr) out.jacobian->setZero();
    for (Index i = 0; i < count_; ++i) {
      const Index next = (i + 1) % count_;
      const Index last = (i + count_ - 1) % count_;
      const double x = u(i);
      if (out.residual != nullptr)
        (*out.residual)(i) = p(0) * x + q_ * x * x - x * x * x + k_ * (u(next) - 2 * x + u(last));
      if (out.jacobian != nullptr) {
        (*out.jacobian)(i, i) += p(0) + 2 * q_ * x - 3 * x * x - 2 * k_;
        (*out.jacobian)(i, next) += k_;
        (*out.jacobian)(i, last) += k_;
      }
      if (out.parameter_jacobian != nullptr) (*out.parameter_jacobian)(i, 0) = x;
    }
    return true;
  }
  std::vector<Symmetry> symmetries() const override {
    std::vector<Symmetry> all;
    for (Index k = 1; k < 2 * count_; ++k) {
      SparseMatrix map(count_, count_);
      for (Index i = 0; i < count_; ++i)
        map.insert((k < count_ ? k + i : 2 * count_ + k - i) % count_, i) = 1;
      all.push_back({(k < count_ ? "shift " : "mirror ") + std::to_string(k % count_), map});
    }
    return all;
  }
  /// Where wave m of the rest becomes critical.
  double critical(Index m) const {
    return 2 * k_ * (1 - std::cos(two_pi * static_cast<double>(m) / static_cast<double>(count_)));
  }

 private:
  Index count_;
  double q_;
  double k_;
};

/// The same problem, of which no symmetry is known.
template <class Base>
class Unaware : public Base {
 public:
  using Base::Base;
  std::vector<Symmetry> symmetries() const override { return {}; }
};

std::vector<double> lambdas(const std::vector<BranchPoint>& points) {
  std::vector<double> all;
  for (const BranchPoint& point : points) all.push_back(point.parameters(0));
  return all;
}

/// That no branch holds an image of a point in the midst of another one.
void check_images(const Problem& problem, const std::vector<Branch>& branches) {
  for (std::size_t i = 0; i < branches.size(); ++i) {
    const BranchPoint& point = branches[i].points[branches[i].points.size() / 2];
    for (const Symmetry& symmetry : problem.symmetries()) {
      const Vector image = symmetry.map * point.unknowns;
      Vector residual(problem.size());
      REQUIRE(problem.evaluate(image, point.parameters, {}, {&residual}));
      CHECK(residual.lpNorm<Eigen::Infinity>() < 1e-9);
      for (std::size_t j = 0; j < branches.size(); ++j) {
        if (j == i || branches[i].points.size() < 3) continue;
        for (const BranchPoint& other : branches[j].points) {
          if (other.type != PointType::regular) continue;
          CHECK((other.unknowns - image).norm() + (other.parameters - point.parameters).norm() > 1e-7);
        }
      }
    }
  }
}

}  // namespace

TEST_CASE("A polygon's branches leave the double point, of images one", "[multiple points]") {
  const int corners = GENERATE(3, 4, 5, 6, 7, 12);
  CAPTURE(corners);
  const double b = corners == 3 ? 1 : corners == 4 ? 0.5 : 0.3;
  const Polygon problem(corners, b);
  const std::vector<Branch> all =
      trace_connected(problem, {vector_of({0, 0}), vector_of({-0.5})}, over("lambda", -0.5, 0.6));
  REQUIRE(all.size() == 3);
  const std::vector<BranchPoint> points = of_type(all[0], PointType::branch_point);
  REQUIRE(points.size() == 1);
  CHECK_THAT(points[0].parameters(0), WithinAbs(0, 1e-12));
  CHECK(all[0].points.front().unstable == 0);
  CHECK(all[0].points.back().unstable == 2);
  CHECK(other_ways(problem, "lambda", points[0]).size() == (corners % 2 == 0 ? 4 : 2));
  const LostSymmetries lost = lost_symmetries(problem, SymmetryGroup(problem.symmetries()), points[0]);
  CHECK(lost.null_vectors == 2);
  CHECK(lost.names.size() == problem.symmetries().size());
  std::vector<int> signs;
  for (std::size_t i = 1; i < all.size(); ++i) {
    CHECK(is_end(all[i].stop));
    // z = r e^{j phi}: lambda = r^2 - b cos(N phi) r^(N-2), on the axes N phi = 0 or pi.
    const BranchPoint& last = all[i].points.back();
    const double turns = corners * std::atan2(last.unknowns(1), last.unknowns(0));
    CHECK_THAT(std::sin(turns), WithinAbs(0, 1e-9));
    const int sign = std::cos(turns) > 0 ? 1 : -1;
    signs.push_back(sign);
    for (const BranchPoint& point : all[i].points) {
      const double r = point.unknowns.norm();
      CHECK_THAT(point.parameters(0), WithinAbs(r * r - sign * b * std::pow(r, corners - 2), 1e-9));
    }
    // At rest on an axis along which the angle is stable, or not.
    CHECK(last.unstable == (sign > 0 ? 0 : 1));
    const auto folds = of_type(all[i], PointType::fold);
    CHECK(folds.size() == (corners == 3 && sign > 0 ? 1 : 0));
    if (!folds.empty()) CHECK_THAT(folds[0].parameters(0), WithinAbs(-b * b / 4, 1e-10));
    CHECK(of_type(all[i], PointType::branch_point).empty());
  }
  CHECK(signs[0] == -signs[1]);
}

TEST_CASE("All waves of a ring of cells are found where they become critical", "[multiple points]") {
  const Index count = GENERATE(2, 3, 4, 6, 8, 12);
  CAPTURE(count);
  const Cells problem(count, 0.0, 0.11);
  for (const double max_step : {0.1, 0.2}) {
    TraceOptions options = over("lambda", -0.1, 0.6);
    options.max_step = max_step;
    options.max_branches = 1;
    const std::vector<Branch> all =
        trace_connected(problem, {Vector::Zero(count), vector_of({-0.1})}, options);
    REQUIRE(all.size() == 1);
    CHECK_THAT(all[0].warning, ContainsSubstring("max_branches = 1 were followed; what leaves at lambda = "));
    const std::vector<double> found = lambdas(of_type(all[0], PointType::branch_point));
    REQUIRE(std::ssize(found) == count / 2 + 1);
    for (Index m = 0; m <= count / 2; ++m)
      CHECK_THAT(found[static_cast<std::size_t>(m)], WithinAbs(problem.critical(m), 1e-10));
  }
}

TEST_CASE("Branches of a ring of cells are localised, whole, and told once", "[multiple points]") {
  const Index count = GENERATE(3, 4);
  CAPTURE(count);
  const Cells problem(count, 0.3, 0.03);
  TraceOptions options = over("lambda", -0.1, 0.4);
  options.max_branches = 200;
  const std::vector<Branch> all = trace_connected(problem, {Vector::Zero(count), vector_of({-0.1})}, options);
  CHECK(all.size() < 200);
  for (const Branch& one : all) CHECK(one.warning.empty());
  CHECK(all.size() > 4);
  double most = 0;
  for (const Branch& one : all) {
    CAPTURE(one.explanation);
    CHECK(is_end(one.stop));
    for (const BranchPoint& point : one.points) {
      const double mean = point.unknowns.cwiseAbs().mean();
      if (mean > 0.05) most = std::max(most, point.unknowns.lpNorm<Eigen::Infinity>() / mean);
    }
  }
  CHECK(most > 1.5);
  check_images(problem, all);
}

TEST_CASE("Within some symmetries derivatives are those of the problem that is solved", "[multiple points]") {
  const Cells problem(6, 0.3, 0.11);
  const auto group = std::make_shared<const SymmetryGroup>(problem.symmetries());
  REQUIRE(group->order() == 12);
  const Vector u = vector_of({.1, .4, .2, .7, .2, .4});  // a mirror at the first cell
  const Subgroup kept = group->kept(u, Vector::Ones(6), 1e-9);
  REQUIRE(kept.size() == 2);
  const SymmetricProblem within(problem, group, kept, 2.0, 1e-6);
  CHECK((within.symmetric(u) - u).norm() < 1e-15);
  const Vector p = vector_of({0.2});
  CHECK(!within.wrong_derivative(u, p, {}, 0, {}));
  Vector residual(6);
  Vector whole(6);
  Matrix jacobian(6, 6);
  const Vector aside = u + vector_of({.01, .02, -.01, .005, .03, -.02});
  REQUIRE(within.evaluate(aside, p, {}, {&residual, &jacobian}));
  REQUIRE(problem.evaluate(within.symmetric(aside), p, {}, {&whole}));
  CHECK((residual - within.symmetric(whole) - (aside - within.symmetric(aside)) / 2.0).norm() < 1e-14);
  for (Index j = 0; j < 6; ++j) {
    constexpr double h = 1e-6;
    Vector more(6);
    Vector less(6);
    REQUIRE(within.evaluate(aside + h * Vector::Unit(6, j), p, {}, {&more}));
    REQUIRE(within.evaluate(aside - h * Vector::Unit(6, j), p, {}, {&less}));
    CHECK(((more - less) / (2 * h) - jacobian.col(j)).norm() < 1e-8);
  }
}

TEST_CASE("A polygon's group breaks into its halves and by its mirrors", "[multiple points]") {
  const auto count_of = [](Index count, const Subgroup& of) {
    const Cells cells(count, 0.3, 0.11);
    const SymmetryGroup group(cells.symmetries());
    Subgroup whole;
    for (std::size_t i = 0; i < group.order(); ++i) whole.push_back(i);
    const std::vector<Breaking> all = group.breakings(of.empty() ? whole : of);
    Index dimensions = 0;
    std::size_t ways = 0;
    for (const Breaking& one : all) {
      dimensions += one.space.cols();
      ways += one.kept.size();
      const Matrix unit = one.space.transpose() * one.space;
      CHECK((unit - Matrix::Identity(unit.rows(), unit.cols())).norm() < 1e-12);
    }
    return std::array<Index, 3>{std::ssize(all), static_cast<Index>(ways), dimensions};
  };
  // Waves 1, 2, ... by mirrors, in one class of them or two; wave N/2 as a half.
  CHECK(count_of(5, {}) == std::array<Index, 3>{1, 1, 2});
  CHECK(count_of(6, {}) == std::array<Index, 3>{2, 3, 3});
  CHECK(count_of(8, {}) == std::array<Index, 3>{2, 3, 4});
  CHECK(count_of(2, {}) == std::array<Index, 3>{1, 1, 1});
  // Shifts alone lose half of themselves at most.
  CHECK(count_of(6, {0, 1, 2, 3, 4, 5}) == std::array<Index, 3>{1, 1, 1});
  CHECK(count_of(5, {0, 1, 2, 3, 4}) == std::array<Index, 3>{0, 0, 0});
  std::vector<Symmetry> half = Cells(6, 0, 1).symmetries();
  half.resize(2);
  CHECK_THROWS_AS(SymmetryGroup(half), std::logic_error);
}

TEST_CASE("A polygon's branches leave the double point without known symmetries", "[multiple points]") {
  const int corners = GENERATE(3, 4);
  CAPTURE(corners);
  const double b = corners == 3 ? 1 : 0.5;
  const Unaware<Polygon> problem(corners, b);
  const std::vector<Branch> all =
      trace_connected(problem, {vector_of({0, 0}), vector_of({-0.5})}, over("lambda", -0.5, 0.6));
  REQUIRE(all.size() == static_cast<std::size_t>(1 + 2 * corners));
  for (std::size_t i = 1; i < all.size(); ++i) {
    CHECK(is_end(all[i].stop));
    const BranchPoint& last = all[i].points.back();
    const double turns = corners * std::atan2(last.unknowns(1), last.unknowns(0));
    CHECK_THAT(std::sin(turns), WithinAbs(0, 1e-8));
    const double r = last.unknowns.norm();
    const double sign = std::cos(turns) > 0 ? 1 : -1;
    CHECK_THAT(last.parameters(0), WithinAbs(r * r - sign * b * std::pow(r, corners - 2), 1e-9));
  }
}

TEST_CASE("Branches that third derivatives do not tell are said to be left", "[multiple points]") {
  const Unaware<Polygon> pentagon(5, 0.3);
  const std::vector<Branch> of_pentagon =
      trace_connected(pentagon, {vector_of({0, 0}), vector_of({-0.5})}, over("lambda", -0.5, 0.6));
  REQUIRE(of_pentagon.size() == 1);
  CHECK_THAT(of_pentagon[0].warning, ContainsSubstring("several eigenvalues vanish at once"));
}
