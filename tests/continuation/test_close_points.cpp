// Special points of a branch that lie in one step, against closed forms.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <utility>

#include "catch.hpp"
#include "polynomial_systems.hpp"
#include "same_points.hpp"
#include "scalar_problem.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;

namespace {

/// Cells in a row, each with the reaction 100 x/(1 + x + x^2), between which it diffuses:
/// x' = p - 100 x/(1 + x + x^2) - (1 + L) x, L the Laplacian of a path, with the eigenvalues 2 - 2 cos(k
/// pi/n).
class ReactingCells : public Problem {
 public:
  ReactingCells(Index cells, bool equilibrium)
      : equilibrium_(equilibrium), exchange_(Matrix::Zero(cells, cells)) {
    for (Index i = 0; i < cells; ++i) exchange_(i, i) = i == 0 || i == cells - 1 ? 2 : 3;
    exchange_.diagonal(1).setConstant(-1);
    exchange_.diagonal(-1).setConstant(-1);
  }
  Index size() const override { return exchange_.rows(); }
  bool is_equilibrium() const override { return equilibrium_; }
  std::vector<std::string> parameter_names() const override { return {"p"}; }
  bool evaluate(const Vector& u, const Vector& p, const Regime& /*regime*/,
                const Evaluation& out) const override {
    const Vector d = 1 + u.array() + u.array().square();
    if (out.residual != nullptr)
      *out.residual = (p(0) - 100 * u.array() / d.array()).matrix() - exchange_ * u;
    if (out.jacobian != nullptr) {
      *out.jacobian = -exchange_;
      out.jacobian->diagonal().array() -= 100 * (1 - u.array().square()) / d.array().square();
    }
    if (out.parameter_jacobian != nullptr) out.parameter_jacobian->setOnes();
    return true;
  }

  /// p where the mode k of equal cells has a zero eigenvalue, between two values of x.
  double singular(int k, double low, double high) const {
    const double stiffness = 3 - 2 * std::cos(k * std::numbers::pi / static_cast<double>(size()));
    const auto rate = [=](double x) {
      const double d = 1 + x + x * x;
      return 100 * (1 - x * x) / (d * d) + stiffness;
    };
    for (int i = 0; i < 200; ++i) {
      const double middle = 0.5 * (low + high);
      (rate(middle) * rate(low) > 0 ? low : high) = middle;
    }
    return 100 * low / (1 + low + low * low) + low;
  }

 private:
  bool equilibrium_;
  Matrix exchange_;
};

}  // namespace

TEST_CASE("All branch points of reacting cells are found, however long the steps are") {
  const int cells = GENERATE(2, 5, 7, 12);
  const double max_step = GENERATE(0.4, 0.1, 0.05);
  const bool equilibrium = GENERATE(false, true);
  CAPTURE(cells, max_step, equilibrium);
  const ReactingCells problem(cells, equilibrium);
  TraceOptions options = over("p", 0, 60);
  options.max_step = max_step;
  const Branch branch = trace(problem, {Vector::Zero(cells), Vector::Zero(1)}, options);
  REQUIRE(branch.complete());
  CHECK(of_type(branch, PointType::fold).size() == 2);
  const auto found = of_type(branch, PointType::branch_point);
  std::vector<double> expected;
  const double least = 2 * std::cos(std::numbers::pi / 9);  // where the slope of the reaction is least
  for (int k = 1; k < cells; ++k) {
    expected.push_back(problem.singular(k, 1, least));
    expected.push_back(problem.singular(k, least, 60));
  }
  std::sort(expected.begin(), expected.end(), std::greater<>());
  REQUIRE(found.size() == expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    CHECK_THAT(found[i].parameters(0), WithinRel(expected[i], 1e-9));
    CHECK(found[i].unknowns.maxCoeff() - found[i].unknowns.minCoeff() < 1e-9);
  }
}

TEST_CASE("Special points down to 1e-6 apart are all located, each as what it is") {
  for (unsigned seed = 1; seed <= 150; ++seed) {
    const RandomPolynomials random(seed);
    const Branch branch = random.trace();
    CAPTURE(seed, branch.explanation, random.system.size());
    REQUIRE(branch.complete());
    const std::vector<SpecialPoint> found = random.found(branch);
    REQUIRE(found.size() == random.special.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      CHECK(found[i].second == random.special[i].second);
      CHECK_THAT(found[i].first,
                 WithinAbs(random.special[i].first, 1e-8));  // of a step of 0.1, by 1e-9 of it
    }
  }
}

TEST_CASE("A double branch point and a simple one beside it are both found, in either order") {
  TraceOptions options = over("p", -1, 1);
  options.max_step = 0.05 * std::sqrt(5);  // of p by 0.1: some steps end on them, some have them midway
  for (const double apart : {-0.1, -0.03, -0.003, 0.003, 0.01, 0.1}) {
    for (const double at : {-0.3, -0.11, 0.0, 0.03, 0.24, 0.5}) {
      for (const bool equilibrium : {false, true}) {
        CAPTURE(apart, at, equilibrium);
        PolynomialSystem system;
        system.branch_points = {at, at, at + apart};
        system.quadratic = {0, 0, 0};
        system.equilibrium = equilibrium;
        system.to_x = system.from_x = Matrix::Identity(4, 4);
        system.sign = -1;
        const Branch branch =
            trace(system, {-Vector::Unit(4, 0), Vector::Constant(1, system.value(-1))}, options);
        REQUIRE(branch.complete());
        const auto found = of_type(branch, PointType::branch_point);
        REQUIRE(found.size() == 2);
        CHECK_THAT(found[0].parameters(0), WithinAbs(std::min(at, at + apart), 1e-8));
        CHECK_THAT(found[1].parameters(0), WithinAbs(std::max(at, at + apart), 1e-8));
      }
    }
  }
}

TEST_CASE("Two branch points 1e-8 apart are passed, beyond which both eigenvalues are positive") {
  for (const double apart : {1e-8, 2e-8, 3e-8, 1e-7}) {
    CAPTURE(apart);
    PolynomialSystem system;
    system.branch_points = {0, apart};
    system.quadratic = {0, 0};
    system.equilibrium = true;
    system.to_x = system.from_x = Matrix::Identity(3, 3);
    system.sign = 1;
    const Branch branch =
        trace(system, {-Vector::Unit(3, 0), Vector::Constant(1, system.value(-1))}, over("p", -1, 1));
    REQUIRE(branch.complete());
    const auto found = of_type(branch, PointType::branch_point);
    REQUIRE(found.size() == 2);
    CHECK_THAT(found[0].parameters(0), WithinAbs(0, 1e-9));
    CHECK_THAT(found[1].parameters(0), WithinAbs(apart, 1e-9));
    CHECK(branch.points.back().unstable == branch.points.front().unstable + 2);
  }
}

TEST_CASE("The fold next to the value that a branch is to land on is passed with the tangent kept") {
  for (int i = 1; i <= 8; ++i) {
    PolynomialSystem bend;
    bend.folds = {0.5};
    bend.to_x = bend.from_x = Matrix::Identity(1, 1);
    bend.sign = -1;
    const double top = bend.value(0.5);
    const double before = std::pow(10, -i);
    // p = P(y) comes down to its fold and turns; the value lies just beyond.
    const Branch branch = trace(bend, {Vector::Constant(1, -1), Vector::Constant(1, bend.value(-1))},
                                over("p", bend.value(-1), top - before));
    CAPTURE(i, branch.explanation);
    CHECK(branch.stop == Stop::left_range);
    CHECK(of_type(branch, PointType::fold).size() == 1);
  }
}

namespace {

/// p = 1 + a e^(-k x) cos(w x), which turns where tan(w x) = -k/w.
struct Winding {
  double a;
  double k;
  double w;

  ScalarProblem problem() const {
    return {{"p"},
            [*this](double x, const Vector& p) { return 1 + a * std::exp(-k * x) * std::cos(w * x) - p(0); },
            [*this](double x, const Vector&) {
              return -a * std::exp(-k * x) * (k * std::cos(w * x) + w * std::sin(w * x));
            },
            {[](double, const Vector&) { return -1.0; }}};
  }

  Branch trace(TraceOptions options) const {
    constexpr double begin = 0.3;
    const Guess guess{vector_of({begin}),
                      vector_of({1 + a * std::exp(-k * begin) * std::cos(w * begin)}),
                      {},
                      vector_of({1, 0})};
    return trace_one_way(problem(), guess, true, options);
  }

  /// The number of a fold, from the start on, and how far it lies from its place.
  std::pair<long, double> number(double x) const {
    const double turns = (w * x + std::atan(k / w)) / std::numbers::pi;
    return {std::lround(turns), std::abs(turns - std::round(turns))};
  }
};

}  // namespace

TEST_CASE("A branch that winds has all its folds told, once each, however little the parameter moves") {
  for (const double a : {1e-2, 1e-4, 1e-6}) {
    for (const double k : {0.02, 0.3}) {
      for (const double w : {2.0, 6.0}) {
        for (const double step : {0.02, 0.05, 0.2, 0.5}) {
          TraceOptions options = over("p", 0, 2);
          options.max_step = step;
          options.max_points = 300;
          const Winding winding{a, k, w};
          const Branch branch = winding.trace(options);
          CAPTURE(a, k, w, step);
          long last = 0;
          for (const BranchPoint& point : of_type(branch, PointType::fold)) {
            if (a * std::exp(-k * point.unknowns(0)) < 1e-9) break;  // of the parameter: rates are rounding
            const auto [number, error] = winding.number(point.unknowns(0));
            CHECK(number == last + 1);
            CHECK(error < 1e-4);
            last = number;
          }
          CHECK(last > 3);
        }
      }
    }
  }
}

TEST_CASE("A branch that winds is resumed as it was left") {
  TraceOptions options = over("p", 0, 2);
  options.max_step = 0.5;
  options.max_points = 60;
  const Winding winding{1e-4, 0.02, 6};
  const Branch whole = winding.trace(options);
  options.max_points = 31;
  const Branch first = winding.trace(options);
  REQUIRE(first.checkpoint);
  std::stringstream text;
  write(text, *first.checkpoint);
  options.max_points = 29;
  check_gone_on(first, resume(winding.problem(), read_checkpoint(text), options), whole);
}
