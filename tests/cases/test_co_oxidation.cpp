// What hangs together with all solutions at one value of a parameter.

#include <Eigen/Eigenvalues>
#include <boost/math/tools/minima.hpp>

#include "arcslip/zero_between.hpp"
#include "case_runs.hpp"

using namespace arcslip;
using namespace arcslip::testing;

namespace {

constexpr double k = 0.4;

/// The state of the surface with so much oxygen.
struct State {
  double x, y, s, q2;

  explicit State(double oxygen) : x(oxygen) {
    const double a = k * k / (2 * x);
    const double b = 1 + k;
    const double c = 0.8 * x - 1;
    s = 2 * c / (-b - std::sqrt(b * b - 4 * a * c));
    y = a * s * s - x / 5;
    q2 = y * (0.1 + 10 * x) / (k * s);
  }

  /// Of the Routh-Hurwitz condition that vanishes where a pair of eigenvalues is imaginary.
  double pair() const {
    const double z = k * s;
    const Eigen::Matrix3d jacobian{{-10 * z - 4 * x - 10 * y, -10 * z - 10 * x, -10 * z},
                                   {-q2 - 10 * y, -q2 - 0.1 - 10 * x, -q2},
                                   {-0.0675, -0.0675, -0.0675 * (1 + k)}};
    const double trace = jacobian.trace();
    const double minors = 0.5 * (trace * trace - (jacobian * jacobian).trace());
    return trace * minors - jacobian.determinant();
  }
};

double fold_between(double low, double high, double sign) {
  return sign *
         boost::math::tools::brent_find_minima([&](double x) { return sign * State(x).q2; }, low, high, 40)
             .second;
}

double hopf_between(double low, double high) {
  const auto pair = [](double x) { return State(x).pair(); };
  return State(zero_between(pair, low, high, pair(low), pair(high))).q2;
}

std::vector<double> values(const std::vector<BranchPoint>& points) {
  std::vector<double> all;
  for (const BranchPoint& point : points) all.push_back(point.parameters(0));
  return all;
}

}  // namespace

TEST_CASE("Cycles are followed from all states at one value of a parameter", "[cases][cycles]") {
  const double first = hopf_between(0.07, 0.09);
  const double last = hopf_between(0.015, 0.018);
  const Run run("co_oxidation");
  REQUIRE(run.traced.size() == 3);
  CHECK(run.traced[0].solutions->complete);
  const std::vector<double> hopf = values(points(run.traced[0], PointType::hopf));
  const std::vector<double> folds = values(points(run.traced[0], PointType::fold));
  REQUIRE(hopf.size() == 2);
  REQUIRE(folds.size() == 2);
  CHECK_THAT(hopf[0], WithinRel(first, 1e-11));
  CHECK_THAT(hopf[1], WithinRel(last, 1e-11));
  CHECK_THAT(folds[0], WithinRel(fold_between(0.04, 0.07, -1), 1e-12));
  CHECK_THAT(folds[1], WithinRel(fold_between(0.02, 0.03, 1), 1e-12));
  const TracedBranch& cycles = run.traced[2];
  CHECK_THAT(cycles.branch.points.front().parameters(0), WithinRel(first, 1e-5));
  CHECK_THAT(cycles.branch.points.back().parameters(0), WithinRel(last, 1e-5));
  CHECK(count(cycles, PointType::fold) == 2);
  CHECK(run.traced[0].branch.complete());
  CHECK(run.traced[1].branch.complete());
  CHECK(cycles.branch.stop == continuation::Stop::left_regime);
}

TEST_CASE("From wherever it is begun the same hangs together", "[cases][cycles]") {
  const Run inside("co_oxidation", {"branch.start=1.5"});
  const Run at_end("co_oxidation", {"branch.start=0.5"});
  REQUIRE(inside.traced.size() == 3);
  REQUIRE(at_end.traced.size() == 3);
  for (const std::size_t i : {0, 2}) {
    for (const PointType type : {PointType::hopf, PointType::fold}) {
      std::vector<double> one = values(points(inside.traced[i], type));
      std::vector<double> other = values(points(at_end.traced[i], type));
      std::sort(one.begin(), one.end());
      std::sort(other.begin(), other.end());
      REQUIRE(one.size() == (i == 0 || type == PointType::fold ? 2 : 0));
      REQUIRE(other.size() == one.size());
      for (std::size_t j = 0; j < one.size(); ++j) CHECK_THAT(one[j], WithinRel(other[j], 1e-9));
    }
  }
}
