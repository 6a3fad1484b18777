// Cubic springs beside friction, in several harmonics.

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "arcslip/continuation/problem/derivative_check.hpp"
#include "arcslip/problems/response/cubic_response.hpp"
#include "arcslip/problems/response/harmonic_response.hpp"
#include "arcslip/problems/response/nonlinear_mode.hpp"
#include "arcslip/problems/response/power_balance.hpp"
#include "branches.hpp"
#include "catch.hpp"

using namespace arcslip;
using namespace arcslip::problems;
using continuation::Branch;
using continuation::BranchPoint;
using continuation::PointType;

namespace {

/// The rods of problems/cubic_response.toml.
SystemParameters sprung_rods(std::vector<int> harmonics) {
  SystemParameters system;
  system.model = StructureModel::rods;
  system.mass_ratio = 5;
  system.frequency_ratio = 4;
  system.interface_stiffness = 1000;
  system.base_damping = 5e-3;
  system.cubic_stiffness = 10;
  system.harmonics = std::move(harmonics);
  return system;
}

continuation::TraceOptions between(double from, double to) {
  continuation::TraceOptions options;
  options.parameter = "eta";
  options.from = from;
  options.to = to;
  return options;
}

double value_of(const continuation::Problem& problem, const BranchPoint& point, Index which) {
  Vector values;
  problem.observe(point.unknowns, point.parameters, point.regime, values);
  return values(which);
}

template <class Response>
Branch traced_from(const Response& problem, double preload, continuation::TraceOptions options) {
  return continuation::trace(problem, problem.guess(options.from, preload), options);
}

}  // namespace

TEST_CASE("One harmonic of cubic springs and friction is that of the scalar response, folds included",
          "[cubic_harmonics]") {
  const double preload = GENERATE(0.1, 0.3, 0.6, 3.0);
  CAPTURE(preload);
  const SystemParameters system = sprung_rods({1});
  const CubicResponse scalar(build_system(system));
  const HarmonicResponse general(build_harmonic_system(system));
  continuation::TraceOptions options = between(0.5, 12);
  options.extrema_of = {"Y"};
  const Branch expected = traced_from(scalar, preload, options);
  const Branch found = traced_from(general, preload, options);
  REQUIRE(expected.complete());
  REQUIRE(found.complete());
  for (const PointType type :
       {PointType::fold, PointType::regime_switch, PointType::peak, PointType::trough}) {
    const auto a = of_type(expected, type);
    const auto b = of_type(found, type);
    CAPTURE(to_string(type));
    REQUIRE(a.size() == b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      CHECK_THAT(b[i].parameters(0), WithinRel(a[i].parameters(0), 1e-9));
      CHECK_THAT(value_of(general, b[i], HarmonicResponse::Y),
                 WithinRel(value_of(scalar, a[i], CubicResponse::Y), 1e-9));
    }
  }
}

TEST_CASE("A point of the scalar response solves the general one", "[cubic_harmonics]") {
  const SystemParameters system = sprung_rods({1});
  const CubicResponse scalar(build_system(system));
  const HarmonicResponse general(build_harmonic_system(system));
  const Branch branch = traced_from(scalar, 0.3, between(3, 5));
  REQUIRE(branch.points.size() > 20);
  Vector residual(general.size());
  Vector u(general.size());
  for (const BranchPoint& point : branch.points) {
    const ComplexVector x = scalar.motions(point.unknowns, point.parameters, point.regime);
    for (Index i = 0; i < x.size(); ++i) u.segment<2>(2 * i) << x(i).real(), x(i).imag();
    REQUIRE(general.evaluate(u, point.parameters, point.regime, {&residual}));
    CHECK(residual.lpNorm<Eigen::Infinity>() < 1e-10);  // to which the scalar one was solved
  }
}

TEST_CASE("Y at eta = 4.6 of hardening springs is that of an independent balance", "[cubic_harmonics]") {
  struct Published {
    std::vector<int> orders;
    double Y;
  };
  const Published published = GENERATE(values<Published>(
      {{{1}, 1.316944}, {{1, 3}, 1.273057}, {{1, 3, 5, 7, 9}, 1.271885}, {odd_up_to(15), 1.271886}}));
  const HarmonicResponse problem(build_harmonic_system(sprung_rods(published.orders)));
  continuation::TraceOptions options = between(0.5, 4.6);
  const Branch branch = traced_from(problem, 0.1, options);
  REQUIRE(branch.complete());
  CHECK_THAT(value_of(problem, branch.points.back(), HarmonicResponse::Y), WithinAbs(published.Y, 2e-6));
}

TEST_CASE("The upper fold of hardening springs in nine harmonics is the published one", "[cubic_harmonics]") {
  const HarmonicResponse problem(build_harmonic_system(sprung_rods(odd_up_to(9))));
  const Branch branch = traced_from(problem, 0.1, between(0.5, 8));
  REQUIRE(branch.complete());
  const std::vector<BranchPoint> folds = of_type(branch, PointType::fold);
  REQUIRE(folds.size() == 2);
  CHECK_THAT(folds.front().parameters(HarmonicResponse::eta), WithinAbs(4.820, 1e-3));
  CHECK_THAT(value_of(problem, folds.front(), HarmonicResponse::Y), WithinAbs(1.4872, 1e-4));
}

TEST_CASE("Derivatives of responses and modes with cubic springs are exact in stick and slip",
          "[cubic_harmonics]") {
  const SystemParameters system = sprung_rods({1, 3, 5});
  const HarmonicResponse response(build_harmonic_system(system));
  const NonlinearMode mode(build_harmonic_system(system));
  const double preload = GENERATE(0.1, 30.0);
  continuation::Guess at = response.guess(3.9, preload);
  CHECK(at.regime == (preload < 1 ? 1 : 0));
  at.unknowns.array() += 0.01 * at.unknowns.norm();  // the amplitude of a harmonic that is nothing has none
  const auto errors = continuation::check_derivatives(response, at.unknowns, at.parameters, at.regime);
  INFO(errors.where);
  CHECK(errors.worst < 1e-6);
}

TEST_CASE("Cubic springs take no power", "[cubic_harmonics]") {
  const HarmonicResponse problem(build_harmonic_system(sprung_rods({1, 3, 5, 7, 9})));
  const Branch branch = traced_from(problem, 0.3, between(3, 6));
  REQUIRE(branch.complete());
  for (const BranchPoint& point : branch.points) {
    CHECK(power_balance(problem, point.unknowns, point.parameters, point.regime).error() < 1e-7);
    CHECK(motion_error(problem, point.unknowns, point.parameters, point.regime) < 1e-7);
  }
}

TEST_CASE("A mode on hardening springs rises in frequency as its backbone says", "[cubic_harmonics]") {
  // Where nothing slips the base's mode at the ground springs rises by 3/8 k_3 y^4/(...): to first order in
  // R^2, which halving R must show.
  SystemParameters system = sprung_rods({1, 3});
  const NonlinearMode problem(build_harmonic_system(system));
  const auto frequency = [&](double R) {
    continuation::TraceOptions options;
    options.parameter = "R";
    options.from = 1e-7;
    options.to = R;
    const Branch branch = continuation::trace(problem, problem.guess(4, options.from, 1e6), options);
    REQUIRE(branch.complete());
    return branch.points.back().unknowns(NonlinearMode::frequency) -
           branch.points.front().unknowns(NonlinearMode::frequency);
  };
  const double small = frequency(1e-5);
  const double large = frequency(2e-5);
  CHECK(small > 0);
  CHECK_THAT(large / small, WithinAbs(4, 0.02));
}
