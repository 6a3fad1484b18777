// Forced responses that fold: a base with cubic springs, and one with negative damping.

#include <boost/math/tools/toms748_solve.hpp>

#include "arcslip/continuation/problem/derivative_check.hpp"
#include "arcslip/problems/response/cubic_response.hpp"
#include "catch.hpp"
#include "paper_cases.hpp"
#include "random_systems.hpp"
#include "rod_response.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using continuation::Branch;
using continuation::BranchPoint;
using continuation::PointType;
using problems::CubicResponse;
using problems::ForcedResponse;

namespace {

/// Rods on hardening springs that bend the resonance at eta = 4 by a fifth.
SystemParameters hardening_rods(double preload) {
  SystemParameters parameters = rods(preload);
  parameters.base_damping = 0.005;
  parameters.cubic_stiffness = 10;
  return parameters;
}

/// A base that structural negative damping excites, on a damper that is held.
SystemParameters excited_rods(double zeta) {
  SystemParameters parameters = rods(1);
  parameters.interface_stiffness = 100;
  parameters.base_damping = zeta;
  parameters.base_damping_kind = DampingKind::structural;
  parameters.fixed_damper = true;
  return parameters;
}

/// Folds and the number of solutions of a branch in eta against the second solver.
void check_against_scan(const Branch& branch, const SystemParameters& parameters, std::size_t fold_count) {
  const RodResponse rods(parameters);
  REQUIRE(branch.complete());
  const auto folds = of_type(branch, PointType::fold);
  REQUIRE(folds.size() == fold_count);
  for (const BranchPoint& fold : folds) CHECK(rods.folds_at(fold.parameters(0), fold.unknowns(0), 1e-9L));

  const auto [low, high] = std::minmax({folds.front().parameters(0), folds.back().parameters(0)});
  for (int i = 0; i < 60; ++i) {
    const double eta = 0.995 * low + (1.005 * high - 0.995 * low) * (i + 0.5) / 60;
    std::vector<double> found = passages(branch, eta);
    std::sort(found.begin(), found.end());
    const auto expected = rods.roots(eta, -10, 8, 2e-3L);
    INFO("eta = " << eta);
    REQUIRE(found.size() == expected.size());
    for (std::size_t k = 0; k < found.size(); ++k) {
      CHECK_THAT(found[k], WithinAbs(static_cast<double>(expected[k]), 0.05));  // between two points
    }
  }
}

/// A system with all that may differ from the paper's.
SystemParameters any_system(RandomSystems& draw) {
  SystemParameters s = draw.system();
  s.interface_stiffness = draw.log_uniform(1, 1e4);
  s.base_damping = draw.log_uniform(1e-2, 0.2) * (draw.integer(0, 1) == 0 ? 1 : -1);
  s.damper_damping = draw.log_uniform(1e-2, 0.2);
  s.base_damping_kind = draw.integer(0, 1) == 0 ? DampingKind::viscous : DampingKind::structural;
  s.fixed_damper = draw.integer(0, 3) == 0;
  s.cubic_stiffness = draw.uniform(-20, 20);
  s.preload = draw.log_uniform(0.1, 10) * s.interface_stiffness / s.stiffness_ratio();  // S from 0.1 to 10
  s.preload_growth = s.preload * draw.log_uniform(0.1, 10) / std::pow(resonance_range(s).second, 2);
  return s;
}

/// eta where |y_0/c_B|/Y has the Duffing equation's folds, without friction or stuck: with z = Y^2,
///   z ((A(z) - eta^2)^2 + beta^2 eta_1^4 eta^2) = b^2
/// whose upper root is eta^2 = A - h + sqrt((A - h)^2 - A^2 + b^2/z), h = beta^2 eta_1^4/2. In the order of
/// z.
std::vector<double> duffing_folds(const SystemParameters& parameters, bool stuck) {
  using Real = RodResponse::Real;
  const RodResponse rods(parameters);
  const Real unit = 1 / (rods.base_mass() * 4 * std::numbers::pi_v<Real> * std::numbers::pi_v<Real>);
  const Real natural = rods.base_stiffness() * unit;  // eta_1^2
  const Real linear = natural + (stuck ? rods.contact_stiffness() * unit : 0);
  const Real slope = rods.cubic() * unit;  // dA/dz
  const Real h = std::pow(rods.base_loss(1) * natural, 2) / 2;
  const Real b = rods.load() * unit;
  const auto root = [&](Real z) {
    const Real A = linear + slope * z;
    return std::sqrt(h * h - 2 * A * h + b * b / z);
  };
  const auto square = [&](Real z) { return linear + slope * z - h + root(z); };
  const auto derivative = [&](Real z) { return slope - (h * slope + b * b / (2 * z * z)) / root(z); };
  std::vector<double> folds;
  Real before = 1e-4L;
  for (Real z = before; !std::isnan(derivative(1.01L * z)); z *= 1.01L) {
    if (derivative(before) * derivative(z) < 0) {
      std::uintmax_t iterations = 200;
      const auto [low, high] = boost::math::tools::toms748_solve(
          derivative, before, z, boost::math::tools::eps_tolerance<Real>(60), iterations);
      folds.push_back(static_cast<double>(std::sqrt(square((low + high) / 2))));
    }
    before = z;
  }
  // The last one lies just before the peak, where the root is zero and the derivative falls to -infinity.
  Real top = before;
  for (Real width = 0.01L * before; width > 1e-15L * before; width /= 2) {
    if (!std::isnan(derivative(top + width))) top += width;
  }
  if (derivative(before) * derivative(top) < 0) {
    std::uintmax_t iterations = 200;
    const auto [low, high] = boost::math::tools::toms748_solve(
        derivative, before, top, boost::math::tools::eps_tolerance<Real>(60), iterations);
    folds.push_back(static_cast<double>(std::sqrt(square((low + high) / 2))));
  }
  return folds;
}

}  // namespace

TEST_CASE("The forced problems have exact derivatives for any springs, damping and growth of the preload") {
  RandomSystems draw(3);
  for (int i = 0; i < 100; ++i) {
    const SystemParameters s = any_system(draw);
    const FrictionSystem system = build_system(s);
    const auto [from, to] = resonance_range(s);
    Vector p(2);
    p << draw.log_uniform(from, to), s.preload;
    const int regime = static_cast<int>(draw.integer(0, 1));
    const double log_ratio =
        regime == ForcedResponse::stick ? draw.uniform(-3, -0.01) : draw.uniform(0.01, 6);
    Vector u(2);
    u << system.log_threshold(p(0), p(1)).value + log_ratio, draw.uniform(-2, 1);
    const auto cubic = continuation::check_derivatives(CubicResponse(system), u, p, regime);
    const auto plain = continuation::check_derivatives(ForcedResponse(system), u.head(1), p, regime);
    INFO(i << " worst at " << cubic.where << " and " << plain.where);
    CHECK(cubic.worst < 1e-7);  // of the differences, near resonances
    CHECK(plain.worst < 1e-7);
  }
}

TEST_CASE("Springs of no stiffness leave the forced response as it is") {
  RandomSystems draw(4);
  for (int i = 0; i < 50; ++i) {
    SystemParameters s = any_system(draw);
    s.cubic_stiffness = 0;
    const CubicResponse cubic(build_system(s));
    const ForcedResponse forced(build_system(s));
    const auto [from, to] = resonance_range(s);
    const double eta = draw.log_uniform(from, to);
    const continuation::Guess a = cubic.guess(eta, s.preload);
    const continuation::Guess b = forced.guess(eta, s.preload);
    REQUIRE(a.regime == b.regime);
    CHECK_THAT(a.unknowns(0), WithinAbs(b.unknowns(0), 1e-12));
    Vector residual(2);
    Vector own(1);
    Vector u(2);
    u << b.unknowns(0) + 0.1, a.unknowns(1);
    REQUIRE(cubic.evaluate(u, b.parameters, ForcedResponse::slip, {&residual}));
    REQUIRE(forced.evaluate(u.head(1), b.parameters, ForcedResponse::slip, {&own}));
    CHECK_THAT(residual(1), WithinAbs(own(0), 1e-13));
  }
  const ForcedResponse forced(build_system(rods(1)));
  const CubicResponse cubic(build_system(rods(1)));
  for (const PointType type : {PointType::peak, PointType::trough, PointType::regime_switch}) {
    const auto expected = of_type(trace_over_eta(forced, 1, 0.5, 20), type);
    const auto found = of_type(trace_over_eta(cubic, 1, 0.5, 20), type);
    REQUIRE(found.size() == expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      CHECK_THAT(found[i].parameters(0), WithinRel(expected[i].parameters(0), 1e-9));
      const Vector a = values_at(cubic, found[i]);
      const Vector b = values_at(forced, expected[i]);
      CHECK((a - b).cwiseAbs().maxCoeff() < 1e-6 * b.cwiseAbs().maxCoeff());
    }
  }
}

TEST_CASE("Without friction, and stuck to a held damper, the folds are those of the Duffing equation") {
  const bool stuck = GENERATE(false, true);
  SystemParameters parameters = hardening_rods(stuck ? 1e30 : 1e-30);
  parameters.fixed_damper = stuck;
  parameters.interface_stiffness = 100;
  const CubicResponse problem(build_system(parameters));
  const auto folds = of_type(trace_over_eta(problem, parameters.preload, 0.5, 12), PointType::fold);
  std::vector<double> expected = duffing_folds(parameters, stuck);
  REQUIRE(expected.size() == 2);
  REQUIRE(folds.size() == 2);
  CHECK_THAT(folds[0].parameters(0), WithinRel(expected[1], 1e-9));
  CHECK_THAT(folds[1].parameters(0), WithinRel(expected[0], 1e-9));
}

TEST_CASE("With friction the cubic response folds where a scan over R has two solutions more or fewer") {
  const double preload = GENERATE(0.1, 0.3);
  const double growth = GENERATE(0.0, 0.01);
  SystemParameters parameters = hardening_rods(preload);
  parameters.preload_growth = growth;
  const CubicResponse problem(build_system(parameters));
  check_against_scan(trace_over_eta(problem, preload, 0.5, 12), parameters, 2);
}

TEST_CASE("On the cubic response the power put in equals what friction and structures dissipate") {
  const double preload = GENERATE(0.1, 0.3, 1.0);
  const SystemParameters parameters = hardening_rods(preload);
  const CubicResponse problem(build_system(parameters));
  const RodResponse rods(parameters);
  double worst = 0;
  continuation::TraceOptions options = over_eta(0.5, 12);
  options.tolerance = 1e-12;  // for the balance over the phase angles, 1e-3 and more, that make the power
  const Branch branch = continuation::trace(problem, problem.guess(0.5, preload), options);
  REQUIRE(branch.complete());
  for (const BranchPoint& point : branch.points) {
    const Vector values = values_at(problem, point);
    const double eta = point.parameters(0);
    const RodResponse::Real R = values(CubicResponse::R);
    const auto r = std::polar(R, -static_cast<RodResponse::Real>(values(CubicResponse::psi)));
    const auto friction_force = r * rods.friction(R, rods.slip_threshold(eta));
    const auto beside = std::polar<RodResponse::Real>(values(CubicResponse::Y), -values(CubicResponse::beta));
    const auto y =
        rods.c_base(eta) * (rods.load() + friction_force - rods.cubic() * std::norm(beside) * beside);
    const auto u = -rods.c_damper(eta) * friction_force;
    const RodResponse::Real pi = std::numbers::pi_v<RodResponse::Real>;
    const auto put_in = -pi * rods.load() * y.imag();
    const auto structural =
        pi * (rods.base_stiffness() * rods.base_loss(eta) * std::norm(y) +
              rods.base_stiffness() / parameters.stiffness_ratio() * rods.damper_loss(eta) * std::norm(u));
    const auto friction = rods.contact_stiffness() * values(CubicResponse::S) * values(CubicResponse::S) *
                          values(CubicResponse::dissipated);
    worst = std::max(worst, static_cast<double>(std::abs((put_in - structural - friction) / put_in)));
  }
  CHECK(worst < 1e-9);
}

TEST_CASE("A forced base with negative damping folds where a scan over R has two solutions more or fewer") {
  const double zeta = GENERATE(-1e-3, -3e-3, -1e-2);
  const SystemParameters parameters = excited_rods(zeta);
  const ForcedResponse problem(build_system(parameters));
  check_against_scan(trace_over_eta(problem, 1, 2, 8), parameters, 2);
}

TEST_CASE("Negative damping turns the response at the border of stick where slip begins to lose too little") {
  // There R = S = |b/d|, d = (eta_s^2 - eta^2) + 2 j zeta eta_1^2 of the stuck mode, and as slip begins Im
  // phi rises by 4/pi for each ln R: dg/dln R = 1 + (4/pi) k a Im d/|d|^2, at every eta. It vanishes at
  //   zeta = -(pi/8) b^2/(S^2 k a eta_1^2).
  const FrictionSystem system = build_system(excited_rods(-1e-2));
  const Mode mode = system.base.modes().at(0);
  const double threshold = -std::numbers::pi / 8 *
                           std::norm(mode.load_residue / system.slip_threshold(4, 1)) /
                           (system.contact_stiffness * mode.residue * mode.frequency * mode.frequency);
  const auto corner_folds = [&](double zeta) {
    const ForcedResponse problem(build_system(excited_rods(zeta)));
    const Branch branch = trace_over_eta(problem, 1, 2, 8);
    REQUIRE(branch.complete());
    for (const BranchPoint& corner : of_type(branch, PointType::corner_fold))
      CHECK_THAT(values_at(problem, corner)(ForcedResponse::R_over_S), WithinRel(1, 1e-10));
    return of_type(branch, PointType::corner_fold).size();
  };
  CHECK(corner_folds(0.999 * threshold) == 0);
  CHECK(corner_folds(1.001 * threshold) == 2);
}

TEST_CASE("The guess is the solution of the smallest amplitude") {
  const bool cubic = GENERATE(false, true);
  const SystemParameters parameters = cubic ? hardening_rods(0.3) : excited_rods(-3e-3);
  const RodResponse rods(parameters);
  const CubicResponse problem(build_system(parameters));
  const ForcedResponse forced(build_system(parameters));
  std::size_t several = 0;
  for (int i = 0; i < 100; ++i) {
    const double eta = cubic ? 4 + 0.01 * i : 4 + 0.0002 * i;
    const auto expected = rods.roots(eta, -10, 8, 2e-3L);
    REQUIRE_FALSE(expected.empty());
    several += expected.size() > 1 ? 1 : 0;
    const continuation::Guess guess = problem.guess(eta, parameters.preload);
    CHECK_THAT(guess.unknowns(0), WithinAbs(static_cast<double>(expected.front()), 2e-3));
    CHECK(std::abs(static_cast<double>(rods.G(eta, guess.unknowns(0)))) < 1e-10);
    if (!cubic)
      CHECK_THAT(forced.guess(eta, parameters.preload).unknowns(0), WithinAbs(guess.unknowns(0), 1e-10));
  }
  CHECK(several > 20);
}

TEST_CASE("No solution of any rods, springs hardening or softening, lies below the guess") {
  RandomSystems draw(5);
  for (int i = 0; i < 60; ++i) {
    SystemParameters s = any_system(draw);
    s.model = StructureModel::rods;
    const CubicResponse problem(build_system(s));
    const RodResponse rods(s);
    const auto [from, to] = resonance_range(s);
    const double eta = draw.log_uniform(from, to);
    const RodResponse::Real rho = problem.guess(eta, s.preload).unknowns(0);
    CAPTURE(i, eta, static_cast<double>(rho));
    CHECK(std::abs(static_cast<double>(rods.G(eta, rho))) < 1e-10);
    CHECK(rods.G(eta, rho - 12) < 0);
    CHECK(rods.roots(eta, rho - 12, rho - 1e-6L, 2e-3L).empty());
  }
}

TEST_CASE("A response without value has no guess") {
  SystemParameters parameters = rods(1);
  parameters.preload_growth = -1;
  const FrictionSystem system = build_system(parameters);
  CHECK_THROWS_AS(ForcedResponse(system).guess(2, 1), std::invalid_argument);
  CHECK_THROWS_AS(CubicResponse(system).guess(2, 1), std::invalid_argument);
  CHECK_THROWS_AS(CubicResponse(system).guess(-1, 1), std::invalid_argument);
  CHECK_NOTHROW(ForcedResponse(system).guess(0.5, 1));
}
