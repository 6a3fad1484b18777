// Equal parts that come apart where all but one of their eigenvalues vanish, without a word of symmetries.

#include <algorithm>
#include <cmath>

#include "arcslip/continuation/path/switching.hpp"
#include "branches.hpp"
#include "catch.hpp"
#include "scalar_problem.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;
using Catch::Matchers::ContainsSubstring;

namespace {

/// v_i' = v_i - v_i^3/3 + I + d (sum_j v_j - N v_i), equal cells of which all are coupled.
class EqualCells : public Problem {
 public:
  EqualCells(Index count, double d) : count_(count), d_(d) {}
  Index size() const override { return count_; }
  std::vector<std::string> parameter_names() const override { return {"I"}; }
  bool is_equilibrium() const override { return true; }
  bool evaluate(const Vector& u, const Vector& p, const Regime& /*regime*/,
                const Evaluation& out) const override {
    const auto n = static_cast<double>(count_);
    if (out.residual != nullptr)
      *out.residual = ((1 - n * d_) * u - u.cwiseAbs2().cwiseProduct(u) / 3).array() + p(0) + d_ * u.sum();
    if (out.jacobian != nullptr) {
      out.jacobian->setConstant(d_);
      out.jacobian->diagonal().array() += 1 - n * d_ - u.array().square();
    }
    if (out.parameter_jacobian != nullptr) out.parameter_jacobian->setOnes();
    return true;
  }
  /// v where all but one eigenvalue of equal cells vanish, and I there.
  double critical() const { return std::sqrt(1 - static_cast<double>(count_) * d_); }
  double critical_input() const { return std::pow(critical(), 3) / 3 - critical(); }

 private:
  Index count_;
  double d_;
};

/// The same cells with a sparse matrix.
class SparseCells : public EqualCells {
 public:
  using EqualCells::EqualCells;
  bool sparse() const override { return true; }
  bool evaluate(const Vector& u, const Vector& p, const Regime& regime,
                const Evaluation& out) const override {
    Matrix jacobian(size(), size());
    Evaluation dense = out;
    dense.jacobian = &jacobian;
    if (!EqualCells::evaluate(u, p, regime, dense)) return false;
    if (out.sparse_jacobian != nullptr) *out.sparse_jacobian = jacobian.sparseView(0, 0);
    return true;
  }
};

/// Modes X and Y, (u, v) turned by an angle, of two eigenvalues that vanish at p = 0:
/// X' = p X - X (X^2 + a Y^2), Y' = p Y - Y (Y^2 + b X^2).
class TwoModes : public Problem {
 public:
  TwoModes(double a, double b, double angle)
      : a_(a), b_(b), turn_{{std::cos(angle), std::sin(angle)}, {-std::sin(angle), std::cos(angle)}} {}
  Index size() const override { return 2; }
  std::vector<std::string> parameter_names() const override { return {"p"}; }
  bool is_equilibrium() const override { return true; }
  bool evaluate(const Vector& u, const Vector& p, const Regime& /*regime*/,
                const Evaluation& out) const override {
    const Vector modes = turn_ * u;
    const double x = modes(0);
    const double y = modes(1);
    const Vector rates{{p(0) - x * x - a_ * y * y, p(0) - y * y - b_ * x * x}};
    const Matrix slopes{{rates(0) - 2 * x * x, -2 * a_ * x * y}, {-2 * b_ * x * y, rates(1) - 2 * y * y}};
    if (out.residual != nullptr) *out.residual = turn_.transpose() * rates.cwiseProduct(modes);
    if (out.jacobian != nullptr) *out.jacobian = turn_.transpose() * slopes * turn_;
    if (out.parameter_jacobian != nullptr) *out.parameter_jacobian = u;
    return true;
  }
  /// The modes squared at p = 1/2 on the branch that begins so.
  Vector squares(const Vector& direction) const {
    const Vector modes = (turn_ * direction.head(2)).normalized();
    if (std::abs(modes(0)) < 1e-6) return Vector{{0, 0.5}};
    if (std::abs(modes(1)) < 1e-6) return Vector{{0.5, 0}};
    return Vector{{1 - a_, 1 - b_}} * 0.5 / (1 - a_ * b_);
  }
  Vector modes(const Vector& u) const { return turn_ * u; }

 private:
  double a_, b_;
  Matrix turn_;
};

}  // namespace

TEST_CASE("Several eigenvalues that vanish at once are located and passed without known symmetries",
          "[multiple points]") {
  const Index count = GENERATE(2, 3, 4, 5);
  const double d = GENERATE(0.1, -0.1);
  const double max_step = GENERATE(0.2, 0.1, 0.09, 0.05, 0.02, 0.01);
  CAPTURE(count, d, max_step);
  const EqualCells problem(count, d);
  TraceOptions options = over("I", -3, 3);
  options.max_step = max_step;
  const Branch branch = trace(problem, {Vector::Constant(count, -3.0), vector_of({-3})}, options);
  CHECK(branch.stop == Stop::reached_end);
  const std::vector<BranchPoint> points = of_type(branch, PointType::branch_point);
  REQUIRE(points.size() == 2);
  for (const double sign : {1.0, -1.0}) {
    const BranchPoint& point = points[sign < 0 ? 0 : 1];
    CHECK_THAT(point.parameters(0), WithinAbs(sign * problem.critical_input(), 1e-10));
    CHECK((point.unknowns.array() - sign * problem.critical()).abs().maxCoeff() < 1e-9);
  }
  REQUIRE(of_type(branch, PointType::fold).size() == 2);
  CHECK_THAT(of_type(branch, PointType::fold)[0].parameters(0), WithinAbs(2.0 / 3, 1e-10));
}

TEST_CASE("All branches of three equal cells are followed without known symmetries", "[multiple points]") {
  const double d = GENERATE(0.1, -0.1, 0.02);
  const double max_step = GENERATE(0.1, 0.03);
  CAPTURE(d, max_step);
  const EqualCells problem(3, d);
  TraceOptions options = over("I", -3, 3);
  options.max_step = max_step;
  const std::vector<Branch> all =
      trace_connected(problem, {Vector::Constant(3, -3.0), vector_of({-3})}, options);
  // In phase; two cells alike, of each three; and those that join these.
  REQUIRE(all.size() == 5);
  for (const Branch& branch : all) CHECK(branch.warning.empty());
  for (std::size_t i = 1; i < 5; ++i) CHECK(all[i].stop == Stop::closed_loop);
  for (std::size_t i = 0; i < 3; ++i) {
    const bool is_there = std::any_of(all.begin() + 1, all.end(), [&](const Branch& branch) {
      return std::all_of(branch.points.begin(), branch.points.end(), [&](const BranchPoint& point) {
        return std::abs(point.unknowns((i + 1) % 3) - point.unknowns((i + 2) % 3)) < 1e-6;
      });
    });
    CHECK(is_there);
  }
}

TEST_CASE("A sparse problem's branches leave its double points as a dense one's do", "[multiple points]") {
  const Guess start{Vector::Constant(3, -3.0), vector_of({-3})};
  const std::vector<Branch> dense = trace_connected(EqualCells(3, 0.1), start, over("I", -3, 3));
  const std::vector<Branch> sparse = trace_connected(SparseCells(3, 0.1), start, over("I", -3, 3));
  REQUIRE(sparse.size() == dense.size());
  for (std::size_t i = 0; i < sparse.size(); ++i) {
    CHECK(sparse[i].stop == dense[i].stop);
    const std::vector<BranchPoint> found = of_type(sparse[i], PointType::branch_point);
    const std::vector<BranchPoint> wanted = of_type(dense[i], PointType::branch_point);
    REQUIRE(found.size() == wanted.size());
    for (std::size_t k = 0; k < found.size(); ++k)
      CHECK_THAT(found[k].parameters(0), WithinAbs(wanted[k].parameters(0), 1e-9));
  }
}

TEST_CASE("Branches of three eigenvalues that vanish at once are said to be left", "[multiple points]") {
  const EqualCells cells(4, 0.1);
  const std::vector<Branch> of_cells =
      trace_connected(cells, {Vector::Constant(4, -3.0), vector_of({-3})}, over("I", -3, 3));
  REQUIRE(of_cells.size() == 1);
  CHECK_THAT(of_cells[0].warning, ContainsSubstring("several eigenvalues vanish at once"));
}

TEST_CASE("Branches leave a double point whatever the other mode becomes on them", "[multiple points]") {
  const auto [a, b] = GENERATE(std::pair(0.3, 0.2), std::pair(2.0, 3.0), std::pair(0.5, -0.5));
  const double angle = GENERATE(0.0, 0.3, 0.7);
  const double max_step = GENERATE(0.1, 0.03);
  CAPTURE(a, b, angle, max_step);
  const TwoModes problem(a, b, angle);
  TraceOptions options = over("p", -0.5, 0.5);
  options.max_step = max_step;
  const Branch rest = trace(problem, {vector_of({0, 0}), vector_of({-0.5})}, options);
  const auto points = of_type(rest, PointType::branch_point);
  REQUIRE(points.size() == 1);
  const std::vector<Guess> ways = other_ways(problem, "p", points[0], options.tolerances);
  REQUIRE(ways.size() == 8);
  for (const Guess& way : ways) {
    const Branch branch = trace(problem, way, options);
    REQUIRE(branch.stop == Stop::reached_end);
    const Vector squares = problem.modes(branch.points.back().unknowns).cwiseAbs2();
    CHECK((squares - problem.squares(way.direction)).norm() < 1e-8);
  }
}
