// Cycles of a sparse field against those of the same field with dense Jacobians.

#include <algorithm>

#include "arcslip/continuation/cycles/cycle_branch.hpp"
#include "arcslip/continuation/cycles/floquet.hpp"
#include "arcslip/continuation/points/hopf_form.hpp"
#include "arcslip/problems/library/brusselator_1d.hpp"
#include "branches.hpp"
#include "catch.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using problems::BrusselatorLine;

namespace {

/// A sparse problem with its Jacobian as a full matrix.
class Filled : public Problem {
 public:
  explicit Filled(std::shared_ptr<const Problem> sparse) : sparse_(std::move(sparse)) {}
  Index size() const override { return sparse_->size(); }
  std::vector<std::string> parameter_names() const override { return sparse_->parameter_names(); }
  bool is_equilibrium() const override { return true; }
  bool evaluate(const Vector& u, const Vector& p, const Regime& regime,
                const Evaluation& out) const override {
    SparseMatrix jacobian;
    Evaluation wanted = out;
    wanted.jacobian = nullptr;
    if (out.jacobian != nullptr) wanted.sparse_jacobian = &jacobian;
    if (!sparse_->evaluate(u, p, regime, wanted)) return false;
    if (out.jacobian != nullptr) *out.jacobian = jacobian;
    return true;
  }

 private:
  std::shared_ptr<const Problem> sparse_;
};

/// Van der Pol's flow x' = y, y' = mu (1 - x^2) y - x, without the entry that is 0.
class SparsePlane : public Problem {
 public:
  Index size() const override { return 2; }
  std::vector<std::string> parameter_names() const override { return {"mu"}; }
  bool is_equilibrium() const override { return true; }
  bool sparse() const override { return true; }
  bool evaluate(const Vector& u, const Vector& p, const Regime& /*regime*/,
                const Evaluation& out) const override {
    const double x = u(0);
    const double y = u(1);
    if (out.residual != nullptr) *out.residual << y, p(0) * (1 - x * x) * y - x;
    if (out.parameter_jacobian != nullptr) *out.parameter_jacobian << 0, (1 - x * x) * y;
    if (out.sparse_jacobian == nullptr) return true;
    const std::vector<Eigen::Triplet<double>> entries{
        {0, 1, 1}, {1, 0, -2 * p(0) * x * y - 1}, {1, 1, p(0) * (1 - x * x)}};
    out.sparse_jacobian->resize(2, 2);
    out.sparse_jacobian->setFromTriplets(entries.begin(), entries.end());
    return true;
  }
};

/// The first Hopf point over the length.
Guess hopf_point(const Problem& problem) {
  const Vector p{{0.45, 2, 5.45, 0.008, 0.004}};
  const Vector rest = Vector{{2, 2.725}}.replicate(problem.size() / 2, 1);
  TraceOptions options;
  options.parameter = "L";
  options.from = 0.45;
  options.to = 0.6;
  const Branch branch = trace(problem, {rest, p}, options);
  const auto points = of_type(branch, PointType::hopf);
  REQUIRE(points.size() == 1);
  return {points[0].unknowns, points[0].parameters, points[0].regime, {}};
}

CycleOptions few_intervals(Index intervals, int degree = 3) {
  CycleOptions cycles;
  cycles.intervals = intervals;
  cycles.degree = degree;
  cycles.tolerance = 1;  // no more of them
  return cycles;
}

TraceOptions over_length(double to) {
  TraceOptions options;
  options.parameter = "L";
  options.from = 0.5;
  options.to = to;
  return options;
}

/// From its first Hopf point.
CycleBranch cycles_of(const std::shared_ptr<const Problem>& problem, const CycleOptions& cycles, double to) {
  const auto field = std::make_shared<EquilibriumField>(problem);
  const auto starts = cycles_from_hopf(field, hopf_point(*problem), cycles);
  REQUIRE(starts.size() == 1);
  CycleBranch found = trace_cycles(starts[0], over_length(to), cycles);
  INFO(found.branch.explanation);
  REQUIRE(found.branch.complete());
  REQUIRE(found.branch.points.back().parameters(0) == to);
  return found;
}

double period_at_end(const CycleBranch& found) {
  const BranchPoint& end = found.branch.points.back();
  return found.problem->duration(end.unknowns, end.parameters);
}

/// The mean over time of |u - rest|^2.
double mean_square(const CycleBranch& found, const Vector& rest) {
  const BranchPoint& end = found.branch.points.back();
  const OrbitMesh& mesh = found.problem->frame(end.regime).mesh;
  const Index m = mesh.rule().degree();
  double sum = 0;
  for (Index j = 0; j < mesh.intervals(); ++j) {
    const Matrix at =
        found.problem->orbit(end.unknowns).middleCols(j * m, m + 1) * mesh.rule().values().transpose();
    for (Index i = 0; i < m; ++i)
      sum += mesh.length(j) * mesh.rule().weights()(i) * (at.col(i) - rest).squaredNorm();
  }
  return sum;
}

std::vector<double> sizes(const ComplexVector& logs) {
  std::vector<double> result;
  for (const Complex& one : logs) result.push_back(std::exp(one.real()));
  std::sort(result.rbegin(), result.rend());
  return result;
}

std::vector<double> multipliers_at(const CycleBranch& found, const BranchPoint& at) {
  return sizes(found.problem->log_multipliers(at.unknowns, at.parameters, at.regime));
}

std::vector<double> multipliers_at_end(const CycleBranch& found) {
  return multipliers_at(found, found.branch.points.back());
}

/// The last cycle of a branch as a start on that of another problem with the same solutions.
CycleStart from_end(const CycleBranch& begun, const std::shared_ptr<const Problem>& problem) {
  const BranchPoint& from = begun.branch.points.back();
  return cycle_from_orbit(std::make_shared<EquilibriumField>(problem), begun.problem->frame(from.regime).mesh,
                          begun.problem->orbit(from.unknowns), period_at_end(begun), from.parameters);
}

}  // namespace

TEST_CASE("Cycles of a sparse field are those of the same dense one, and their multipliers") {
  constexpr Index points = 50;
  const CycleOptions cycles = few_intervals(10);
  const auto sparse_problem = std::make_shared<BrusselatorLine>(points);
  const CycleBranch begun = cycles_of(sparse_problem, cycles, 0.52);
  const auto traced = [&](const std::shared_ptr<const Problem>& problem) {
    const CycleStart start = from_end(begun, problem);
    CycleBranch found = trace_cycles(start, over_length(0.53), cycles);
    INFO(found.branch.explanation);
    REQUIRE(found.branch.complete());
    return found;
  };
  const CycleBranch sparse = traced(sparse_problem);
  const CycleBranch dense = traced(std::make_shared<Filled>(sparse_problem));
  CHECK_THAT(period_at_end(sparse), WithinRel(period_at_end(dense), 1e-10));
  const std::vector<double> few = multipliers_at_end(sparse);
  const std::vector<double> all = multipliers_at_end(dense);
  REQUIRE(few.size() >= 9);
  REQUIRE(few.size() < all.size());
  for (std::size_t i = 0; i < few.size(); ++i) CHECK_THAT(few[i], WithinAbs(all[i], 1e-9));
  CHECK(few[0] < 1);  // stable, as its Hopf point tells
}

TEST_CASE("Sparse cycles in the plane have the multiplier of dense ones") {
  const OrbitMesh mesh(CollocationRule(5), 40);
  const Vector angle = two_pi * mesh.places();
  Matrix circle(2, angle.size());
  circle << 2 * angle.array().cos().transpose(), -2 * angle.array().sin().transpose();
  TraceOptions options;
  options.parameter = "mu";
  options.from = 1;
  options.to = 1.5;
  const auto traced = [&](const std::shared_ptr<const Problem>& problem) {
    const CycleStart start = cycle_from_orbit(std::make_shared<EquilibriumField>(problem), mesh, circle, 6.6,
                                              Vector::Constant(1, 1));
    CycleBranch found = trace_cycles(start, options, few_intervals(40, 5));
    REQUIRE(found.branch.complete());
    return found;
  };
  const auto plane = std::make_shared<SparsePlane>();
  const CycleBranch sparse = traced(plane);
  const CycleBranch dense = traced(std::make_shared<Filled>(plane));
  CHECK_THAT(period_at_end(sparse), WithinRel(period_at_end(dense), 1e-8));
  const std::vector<double> one = multipliers_at_end(sparse);
  REQUIRE(one.size() == 1);
  CHECK_THAT(one[0], WithinRel(multipliers_at_end(dense).at(0), 1e-6));
}

TEST_CASE("Cycles on a line leave its Hopf point as its normal form tells") {
  const auto problem = std::make_shared<BrusselatorLine>(50);
  const Guess hopf = hopf_point(*problem);
  const double length = hopf.parameters(0);
  const auto form = hopf_form(*problem, hopf);
  REQUIRE(form);
  CHECK_THAT(form->omega, WithinRel(std::sqrt(4.5775), 1e-9));  // trace 0, (B - 1 - A^2)/(D_x + D_y) = 37.5
  const CycleBranch found = cycles_of(problem, few_intervals(20, 5), length * (1 + 1e-5));
  CHECK_THAT(period_at_end(found), WithinRel(two_pi / form->omega, 1e-4));  // changes as the length does
  const double growth = 0.45 / length * 1e-5 * length;  // d Re lambda/dL = (D_x + D_y) 37.5/L
  CHECK_THAT(mean_square(found, hopf.unknowns),
             WithinRel(-2 * growth / (form->lyapunov * form->omega), 2e-3));  // of the next order
}

TEST_CASE("Cycles of a stiff field converge by one order less than twice their degree") {
  const auto problem = std::make_shared<BrusselatorLine>(24);
  const CycleBranch exact = cycles_of(problem, few_intervals(30, 5), 0.6);
  const CycleBranch coarse = cycles_of(problem, few_intervals(10), 0.6);
  const CycleBranch fine = cycles_of(problem, few_intervals(20), 0.6);
  const double coarse_error = std::abs(period_at_end(coarse) - period_at_end(exact));
  const double fine_error = std::abs(period_at_end(fine) - period_at_end(exact));
  CHECK(fine_error < 1e-5);
  CHECK(coarse_error > 16 * fine_error);
  CHECK(coarse_error < 64 * fine_error);
  const std::vector<double> a = multipliers_at_end(fine);
  const std::vector<double> b = multipliers_at_end(exact);
  for (std::size_t i = 0; i < 3; ++i) CHECK_THAT(a[i], WithinAbs(b[i], 1e-4));
}

TEST_CASE("What decays within an interval has no multiplier, however fine the line is", "[numbers]") {
  const auto largest = [](Index points) {
    return multipliers_at_end(cycles_of(std::make_shared<BrusselatorLine>(points), few_intervals(20), 0.52));
  };
  const std::vector<double> coarse = largest(60);
  const std::vector<double> fine = largest(120);
  for (std::size_t i = 0; i < 5; ++i) CHECK_THAT(fine[i], WithinAbs(coarse[i], 1e-3));
}

TEST_CASE("A branch point of sparse cycles is that of dense ones, as is what leaves it") {
  constexpr Index points = 20;
  const CycleOptions cycles = few_intervals(10);
  const auto sparse_problem = std::make_shared<BrusselatorLine>(points);
  const CycleBranch begun = cycles_of(sparse_problem, cycles, 1.2);
  const auto traced = [&](const std::shared_ptr<const Problem>& problem) {
    const CycleStart start = from_end(begun, problem);
    auto found = trace_connected_cycles(start, over_length(1.26), cycles);
    REQUIRE(found.size() == 2);
    return found;
  };
  const auto sparse = traced(sparse_problem);
  const auto dense = traced(std::make_shared<Filled>(sparse_problem));
  const auto located = [](const std::vector<CycleBranch>& found) {
    const auto all = of_type(found[0].branch, PointType::branch_point);
    REQUIRE(all.size() == 1);
    return all[0];
  };
  const BranchPoint one = located(sparse);
  const BranchPoint other = located(dense);
  CHECK_THAT(one.parameters(0), WithinRel(other.parameters(0), 1e-8));
  CHECK_THAT(one.unknowns.tail(1)(0), WithinRel(other.unknowns.tail(1)(0), 1e-8));
  CHECK_THAT(multipliers_at(sparse[0], one)[0], WithinAbs(1, 1e-6));
  for (std::size_t i = 0; i < 2; ++i)
    CHECK_THAT(period_at_end(sparse[i]), WithinRel(period_at_end(dense[i]), 1e-8));
  CHECK(std::abs(period_at_end(sparse[1]) - period_at_end(sparse[0])) > 1e-3);  // it has left
  CHECK(multipliers_at_end(sparse[0])[0] > 1);
  CHECK(multipliers_at_end(sparse[1])[0] < 1);
}

TEST_CASE("The multiplier of a sparse cycle's own velocity is 1, as exactly as the cycle is known") {
  const auto distance = [](Index intervals) {
    const CycleBranch found = cycles_of(std::make_shared<BrusselatorLine>(20), few_intervals(intervals), 0.6);
    const BranchPoint& end = found.branch.points.back();
    SparseMatrix jacobian;
    Evaluation out;
    out.sparse_jacobian = &jacobian;
    REQUIRE(found.problem->evaluate(end.unknowns, end.parameters, end.regime, out));
    const ComplexVector all = largest_log_multipliers(jacobian, found.problem->field().size(), intervals,
                                                      found.problem->degree(), Matrix(), 20);
    return all.cwiseAbs().minCoeff();
  };
  const double coarse = distance(10);
  const double fine = distance(20);
  CHECK(fine < 1e-4);
  CHECK(coarse > 16 * fine);  // of order 2 m - 1 = 5
}
