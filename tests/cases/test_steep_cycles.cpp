// Branches of cycles on which the parameter all but stands still: relaxation oscillations as they grow, and
// orbits that come near an equilibrium.

#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "arcslip/continuation/linear/sparse_bordered_solver.hpp"
#include "cycle_cases.hpp"

namespace {

using namespace arcslip;
using namespace arcslip::testing;

/// What solutions leave of a right-hand side, over that and the solution: with the Jacobians along a branch
/// beside a parameter's column, at worst, where they are factored by blocks and where by single entries.
struct Left {
  double by_blocks = 0;
  double by_entries = 0;
};

Left left_by_solves(const TracedBranch& traced, Index parameter) {
  const continuation::Problem& problem = traced.problem();
  const Index n = problem.size();
  SparseMatrix jacobian;
  Matrix by_parameters(n, std::ssize(problem.parameter_names()));
  continuation::Evaluation wanted;
  wanted.sparse_jacobian = &jacobian;
  wanted.parameter_jacobian = &by_parameters;
  std::vector<int> order(static_cast<std::size_t>(n + 1));
  std::iota(order.begin(), order.end(), 0);
  const Vector right = Vector::LinSpaced(n + 1, 0.5, 1);
  continuation::SparseBorderedSolver by_blocks(n, 1);
  std::unique_ptr<continuation::SparseFactors> by_entries;
  Left left;
  for (const BranchPoint& point : traced.branch.points) {
    REQUIRE(problem.evaluate(point.unknowns, point.parameters, point.regime, wanted));
    by_blocks.set_jacobian(jacobian, Vector::Ones(n));
    by_blocks.columns() = by_parameters.col(parameter);
    by_blocks.rows().setOnes();
    by_blocks.corner()(0, 0) = 1;
    std::vector<Eigen::Triplet<double>> entries;
    for (Index k = 0; k <= n; ++k) {
      for (SparseMatrix::InnerIterator entry(jacobian, k); k < n && entry; ++entry)
        entries.emplace_back(entry.row(), entry.col(), entry.value());
      entries.emplace_back(n, k, 1);
      if (k < n) entries.emplace_back(k, n, by_parameters(k, parameter));
    }
    SparseMatrix matrix(n + 1, n + 1);
    matrix.setFromTriplets(entries.begin(), entries.end());
    if (by_entries == nullptr) by_entries = continuation::make_klu_factors(matrix, order);
    REQUIRE(by_blocks.factor() != 0);
    REQUIRE(by_entries->factor(matrix) != 0);
    const auto left_by = [&](auto& factors) {
      Vector x = right;
      factors.solve(x);
      return (matrix * x - right).norm() / (right.norm() + x.norm());
    };
    left.by_blocks = std::max(left.by_blocks, left_by(by_blocks));
    left.by_entries = std::max(left.by_entries, left_by(*by_entries));
  }
  return left;
}

}  // namespace

TEST_CASE("Relaxation oscillations that grow at one parameter value are no homoclinic orbits", "[cycles]") {
  // FitzHugh's and Nagumo's nerve: with (v, w, I) so is (-v, 7/4 - w, 7/4 - I) a cycle
  const Run run("nerve_cycles");
  const auto& all = run.traced;
  const auto hopf = all_values_at(all, PointType::hopf, "I");
  REQUIRE(hopf.size() == 2);
  CHECK_THAT(hopf[0] + hopf[1], WithinAbs(1.75, 1e-12));
  const auto found = cycles_of(all);
  REQUIRE(found.size() == 1);
  CHECK(found[0].branch.stop == Stop::left_regime);
  CHECK_THAT(found[0].branch.points.back().parameters(0), WithinAbs(hopf[1], 1e-6));
  const auto folds = all_values_at(found, PointType::fold, "I");
  REQUIRE(folds.size() == 2);
  CHECK_THAT(folds[0] + folds[1], WithinAbs(1.75, 1e-8));
  CHECK_THAT(folds[0], WithinAbs(0.3241785, 1e-7));
}

TEST_CASE("Coupled pendula go round as AUTO-07p has it, to where they come to rest on their way",
          "[cycles][numbers]") {
  const Run run("coupled_pendula");
  const auto all = cycles_of(run.traced);
  REQUIRE(all.size() == 4);
  // AUTO-07p: 0.179163 and 0.331445, 0.175511; all digits by degree 7 on 80 intervals
  check_values(values_at(all[0], PointType::period_doubling, "I"), {0.179163776}, 2e-9);
  check_values(values_at(all[1], PointType::branch_point, "I"), {0.331445241, 0.175511713}, 2e-9);
  check_values(values_at(all[1], PointType::fold, "I"), {0.399074389, 0.158594857}, 2e-9);
  check_values(values_at(all[3], PointType::fold, "I"), {0.173029639, 0.173029639}, 2e-9);
  for (const TracedBranch& one : all) {
    CHECK(one.branch.stop == Stop::infinite_period);
    const Left left = left_by_solves(one, 2);
    CHECK(left.by_blocks < 1e-10);
    CHECK(left.by_entries < 1e-6);  // before refinement
  }
  const BranchPoint& start = all[0].branch.points.front();  // rotations settle turns away from their guess
  CHECK(std::abs(value(all[0], start, "phi_1_max")) < 2 * pi);
}

TEST_CASE("Canards fold and double their period nearer to one another than can be told, each once",
          "[cycles]") {
  // M. T. M. Koper, Physica D 80 (1995) 72: where the slow scales part further, multipliers pass -1 and 1
  // ever nearer together. AUTO-07p on 200 intervals: -7.46088, folds at -6.23500 and -6.28395; all digits by
  // degree 7 and by a tolerance of 1e-9.
  const std::string koper = R"([model.parameters]
k = -10
slow = 0.1
lam = -17.935
[model.equations]
x = "(k*y - x^3 + 3*x - lam)/slow"
y = "x - 2*y + z"
z = "y - z"
[model.start]
x = 1.77
y = 1.77
z = 1.77
[branch]
parameter = "lam"
from = -17.935
to = 0
switching = true
[cycles]
doublings = 0
)";
  const auto one = cycles_of(traced_of(koper));
  REQUIRE(one.size() == 1);  // a mesh was made anew on the second point, which then was told twice more
  check_values(values_at(one[0], PointType::period_doubling, "lam"), {-7.46088181, -6.23500432}, 1e-8);
  check_values(values_at(one[0], PointType::fold, "lam"), {-6.23500432, -6.28395116}, 1e-8);
  for (const std::string tolerance : {"1e-6", "1e-9"}) {
    const auto all =
        cycles_of(traced_of(koper, {"model.parameters.slow=0.02", "cycles.tolerance=" + tolerance}));
    REQUIRE(all.size() == 1);
    check_values(values_at(all[0], PointType::period_doubling, "lam"),
                 {-7.87341289, -6.57473979, -6.74547269, -6.68641441}, 1e-8);
    check_values(values_at(all[0], PointType::fold, "lam"), {-6.57473979, -6.74547269}, 1e-8);
  }
}

TEST_CASE("A nerve's cycles fold and double their period next to one another", "[cycles]") {
  const Run run("hodgkin_huxley");
  check_values(all_values_at(run.traced, PointType::hopf, "I"), {9.779338, 154.526334}, 1e-7);
  const auto all = cycles_of(run.traced);
  REQUIRE(all.size() == 1);
  CHECK(all[0].branch.stop == Stop::left_regime);
  // by degree 7 on 80 intervals with a tolerance of 1e-9
  check_values(values_at(all[0], PointType::fold, "I"), {7.84624712, 7.92168549, 6.26422127}, 1e-8);
  check_values(values_at(all[0], PointType::period_doubling, "I"), {7.8492374, 7.92167768}, 1e-8);
}

TEST_CASE("Canards fold where the parameter stands still but for rounding", "[cycles]") {
  // Nagumo's and FitzHugh's nerve: folds by degree 7 and a tolerance of 1e-9
  const std::string nerve = R"case([model.parameters]
a = 0
b = 0.8
c = 4
[model.equations]
x = "c*(x - x^3/3 + y)"
y = "-(x - a + b*y)/c"
[branch]
parameter = "a"
from = 0.3
to = 1
switching = true
)case";
  const std::vector<std::pair<std::string, double>> folds = {
      {"3", 0.43051824}, {"3.6", 0.44158145}, {"3.7", 0.44292046}, {"4", 0.44635136}, {"5", 0.45366695}};
  for (const auto& [c, a] : folds) {
    CAPTURE(c);
    const auto all = cycles_of(traced_of(nerve, {"model.parameters.c=" + c}));
    REQUIRE(all.size() == 1);
    check_values(values_at(all[0], PointType::fold, "a"), {a}, 1e-8);
  }
}

TEST_CASE("Canards of a stiff reaction double no period where meshes differ in signs", "[cycles]") {
  // the Oregonator: fold by degree 7 and a tolerance of 1e-10
  const auto all = cycles_of(traced_of(R"case([model.parameters]
f = 0.3
[model.equations]
x = "(8e-4*y - x*y + x*(1 - x))/0.04"
y = "(-8e-4*y - x*y + f*z)/4e-4"
z = "x - z"
[model.start]
x = 0.7
y = 0.3
z = 0.7
[branch]
parameter = "f"
from = 0.3
to = 0.6
switching = true
)case"));
  REQUIRE(all.size() == 1);
  check_values(values_at(all[0], PointType::fold, "f"), {0.512644491}, 1e-8);
  CHECK(points(all[0], PointType::period_doubling).empty());
}

TEST_CASE("Cycles that go round another one ever longer end between two values", "[cycles]") {
  // J. L. Hindmarsh, R. M. Rose, Proc. R. Soc. Lond. B 221 (1984) 87
  const auto all = cycles_of(traced_of(R"case([model.parameters]
I = 5.45
[model.equations]
x = "y - x^3 + 3*x^2 + I - z"
y = "1 - 5*x^2 - y"
z = "0.01*(4*(x + 1.6) - z)"
[model.start]
x = 0
y = 1
z = 6.4
[model.scale]
I = 1e3
[branch]
parameter = "I"
from = 5.2
to = 5.5
start = 5.45
switching = true
[cycles]
doublings = 0
)case"));
  REQUIRE(all.size() == 1);
  const continuation::Branch& branch = all[0].branch;
  CHECK(branch.stop == Stop::infinite_period);
  CHECK(branch.explanation.find("turn back at I = 5.2586") != std::string::npos);
  const auto folds = values_at(all[0], PointType::fold, "I");
  REQUIRE(folds.size() >= 4);
  CHECK_THAT(folds.end()[-1] + folds.end()[-2], WithinAbs(5.2586262 + 5.2858987, 1e-4));
}

TEST_CASE("What decays by decades within an interval has its multiplier in the plane", "[cycles]") {
  // r' = 1000 r (mu - r^2), turning once in 2 pi
  const auto all = cycles_of(traced_of(R"case([model.parameters]
mu = -0.1
[model.definitions]
g = "1000*(mu - x^2 - y^2)"
[model.equations]
x = "g*x - y"
y = "x + g*y"
[branch]
parameter = "mu"
from = -0.1
to = 1
switching = true
)case"));
  REQUIRE(all.size() == 1);
  CHECK(values_at(all[0], PointType::period_doubling, "mu").empty());
  for (const BranchPoint& point : all[0].branch.points) {
    const ComplexVector logs =
        cycles(all[0])->log_multipliers(point.unknowns, point.parameters, point.regime);
    REQUIRE(logs.size() == 1);
    CHECK(logs(0).imag() == 0);
    const double mu = value(all[0], point, "mu");
    CHECK_THAT(logs(0).real(), WithinAbs(-4e3 * pi * mu, 1e-4 * (1 + 4e3 * pi * mu)));
    CHECK(point.unstable == 0);
  }
}
