// No row of a result hangs on what the engine takes for the same, for zero or for rounding.

#include <array>
#include <cmath>

#include "case_runs.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using continuation::Branch;
using continuation::Tolerances;

namespace {

constexpr std::array all = {
    &Tolerances::same_value,       &Tolerances::on_target,        &Tolerances::start_moves,
    &Tolerances::on_border,        &Tolerances::outside,          &Tolerances::together,
    &Tolerances::leaves,           &Tolerances::tangential,       &Tolerances::settled,
    &Tolerances::last_bits,        &Tolerances::both_sides,       &Tolerances::one_place,
    &Tolerances::located,          &Tolerances::just_passed,      &Tolerances::one_zero,
    &Tolerances::one_branch_point, &Tolerances::off_by_rounding,  &Tolerances::nearest_look,
    &Tolerances::as_cusp,          &Tolerances::tiny_step,        &Tolerances::turns,
    &Tolerances::no_rate,          &Tolerances::on_axis,          &Tolerances::rough,
    &Tolerances::significant,      &Tolerances::surely_imaginary, &Tolerances::zero_eigenvalue,
    &Tolerances::coincides,        &Tolerances::same_point,       &Tolerances::same_solution,
    &Tolerances::same_direction,   &Tolerances::no_slope,         &Tolerances::plain_slope,
    &Tolerances::same_slope,       &Tolerances::touches,          &Tolerances::on_extremum,
    &Tolerances::beside_extremum};
static_assert(sizeof(Tolerances) == all.size() * sizeof(double), "one of them is left out");

std::vector<TracedBranch> traced(const Case& input, const Tolerances& tolerances) {
  std::vector<TracedBranch> result;
  for (CaseBranch request : input.branches) {
    request.options.tolerances = tolerances;
    for (TracedBranch& one : trace(request)) result.push_back(std::move(one));
  }
  return result;
}

std::vector<const BranchPoint*> special(const Branch& branch) {
  std::vector<const BranchPoint*> points;
  for (const BranchPoint& point : branch.points) {
    if (point.type != PointType::regular) points.push_back(&point);
  }
  return points;
}

constexpr double located = 1e-8;  // of a fold or an extremum, which is flat, in the parameter and in u

/// Those that lie together, as the folds of a ridge and its extrema do, in the order of their types.
std::vector<const BranchPoint*> ordered(std::vector<const BranchPoint*> points) {
  const auto together = [](const BranchPoint* a, const BranchPoint* b) {
    return (a->parameters - b->parameters).lpNorm<Eigen::Infinity>() <=
               located * (1 + b->parameters.lpNorm<Eigen::Infinity>()) &&
           (a->unknowns - b->unknowns).lpNorm<Eigen::Infinity>() <=
               located * (1 + b->unknowns.lpNorm<Eigen::Infinity>());
  };
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (together(points[i - 1], points[i]) && points[i]->type < points[i - 1]->type)
      std::swap(points[i - 1], points[i]);
  }
  return points;
}

/// The same special points in the same order, as near as special points are located.
void check_same_rows(const Branch& now, const Branch& then) {
  CHECK(now.stop == then.stop);
  const auto a = ordered(special(now));
  const auto b = ordered(special(then));
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    CAPTURE(i, to_string(b[i]->type), b[i]->parameters.transpose());
    CHECK(to_string(a[i]->type) == to_string(b[i]->type));
    CHECK(a[i]->regime == b[i]->regime);
    CHECK(a[i]->unstable == b[i]->unstable);
    const double p = 1 + b[i]->parameters.lpNorm<Eigen::Infinity>();
    const double u = 1 + b[i]->unknowns.lpNorm<Eigen::Infinity>();
    CHECK((a[i]->parameters - b[i]->parameters).lpNorm<Eigen::Infinity>() <= located * p);
    CHECK((a[i]->unknowns - b[i]->unknowns).lpNorm<Eigen::Infinity>() <= located * u);
  }
}

void check_case(const std::string& name, const Settings& settings = {}) {
  const Case input = read_case(source_folder() + "/problems/" + name + ".toml", settings);
  const std::vector<TracedBranch> expected = traced(input, {});
  for (std::size_t which = 0; which < all.size(); ++which) {
    for (const double factor : {10.0, 0.1}) {
      CAPTURE(name, which, factor);
      Tolerances tolerances;
      tolerances.*all[which] *= factor;
      const std::vector<TracedBranch> found = traced(input, tolerances);
      REQUIRE(found.size() == expected.size());
      for (std::size_t i = 0; i < found.size(); ++i) check_same_rows(found[i].branch, expected[i].branch);
    }
  }
}

}  // namespace

TEST_CASE("Ten times more or less of any tolerance gives the same rows", "[tolerances][numbers]") {
  SECTION("folds") { check_case("freudenstein_roth"); }
  SECTION("folds and Hopf points") { check_case("ab"); }
  SECTION("branch points that are switched at") { check_case("pp2"); }
  SECTION("Hopf points and folds of three dimensions") { check_case("lorenz84"); }
  SECTION("cusps") { check_case("cusp_curve"); }
  SECTION("Bogdanov-Takens points, cusps and zero-Hopf points on a curve of folds") {
    check_case("lorenz84_fold_curve");
  }
  SECTION("borders, peaks, troughs") { check_case("figure_8", {"branch.for_each.preload=[0.1,5.0]"}); }
  SECTION("a border in two parameters") { check_case("border"); }
  SECTION("curves of peaks with their corners") { check_case("ridge", {"branch.to=2.0"}); }
  SECTION("borders of limit cycles") { check_case("limit_cycle"); }
}
