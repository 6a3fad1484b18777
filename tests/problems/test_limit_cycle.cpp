// Self-excited vibration: cycles that friction holds against the negative damping of the base.

#include "arcslip/problems/response/limit_cycle.hpp"

#include <Eigen/LU>
#include <boost/math/tools/toms748_solve.hpp>
#include <numbers>
#include <optional>

#include "arcslip/assembly/reduced_pair.hpp"
#include "arcslip/continuation/problem/derivative_check.hpp"
#include "arcslip/elements/contact.hpp"
#include "arcslip/problems/response/limit_cycle_search.hpp"
#include "arcslip/sectors/dynamic_stiffness.hpp"
#include "catch.hpp"
#include "paper_cases.hpp"
#include "random_systems.hpp"
#include "rod_response.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using continuation::Branch;
using continuation::BranchPoint;
using continuation::PointType;
using continuation::Stop;
using problems::LimitCycle;

namespace {

SystemParameters held_rods(DampingKind kind) {
  SystemParameters parameters = rods(1);
  parameters.interface_stiffness = 100;
  parameters.base_damping_kind = kind;
  parameters.fixed_damper = true;
  return parameters;
}

continuation::TraceOptions amplitude_over(const std::string& parameter, double from, double to) {
  continuation::TraceOptions options = over(parameter, from, to);
  options.extrema_of = {"Y"};
  return options;
}

/// The whole curve in zeta_B through a small cycle, from the border of stick to a large cycle.
Branch cycles(const LimitCycle& problem, double zeta, double preload) {
  return continuation::trace_both(problem, problem.guess(zeta, preload),
                                  amplitude_over("zeta_B", 0.1 * zeta, 1000 * zeta));
}

/// |1 + k phi c| by linear solves with the dynamic stiffness at this zeta_B.
double defect(const SystemParameters& system, const LimitCycle& problem, const BranchPoint& point) {
  SystemParameters parameters = system;
  parameters.base_damping = point.parameters(LimitCycle::zeta);
  const double eta = point.unknowns(LimitCycle::eta);
  const ReducedPair pair = reduce(parameters);
  const bool structural = parameters.base_damping_kind == DampingKind::structural;
  DynamicStiffness base = dynamic_stiffness(pair.base, structural ? 0 : base_damping_factor(parameters));
  if (structural) base.stiffness *= Complex(1, 2 * parameters.base_damping);
  Complex c = base.contact_response(eta, 0).compliance;
  if (!parameters.fixed_damper) {
    const DynamicStiffness damper = dynamic_stiffness(pair.damper, damper_damping_factor(parameters));
    c += damper.contact_response(eta, 0).compliance;
  }
  const Vector values = values_at(problem, point);
  const Complex phi = slip_coefficient(std::log(values(LimitCycle::R_over_S))).phi;
  return std::abs(1.0 + problem.system().contact_stiffness * phi * c);
}

}  // namespace

TEST_CASE("Of one mode with structural damping the cycle folds at R = 2S, with zeta = -k a/(2 pi eta_1^2)") {
  const SystemParameters parameters = held_rods(DampingKind::structural);
  const LimitCycle problem(build_system(parameters));
  const auto folds = of_type(cycles(problem, -1e-3, 1), PointType::fold);
  REQUIRE(folds.size() == 1);
  const Mode mode = problem.system().base.modes().at(0);
  const double ka = problem.system().contact_stiffness * mode.residue;
  const double square = mode.frequency * mode.frequency;
  CHECK_THAT(values_at(problem, folds[0])(LimitCycle::R_over_S), WithinRel(2, 1e-9));
  // The fold's zeta is stationary, so that it has all digits.
  CHECK_THAT(folds[0].parameters(LimitCycle::zeta), WithinRel(-ka / (2 * std::numbers::pi * square), 1e-12));
  // At x = 1/2, theta* = pi/2 and Re phi = 1/2.
  CHECK_THAT(folds[0].unknowns(LimitCycle::eta), WithinRel(std::sqrt(square + 0.5 * ka), 1e-9));
}

TEST_CASE("Of one mode with viscous damping the cycle folds where Im phi/eta is largest") {
  using Real = RodResponse::Real;
  const SystemParameters parameters = held_rods(DampingKind::viscous);
  const LimitCycle problem(build_system(parameters));
  const auto folds = of_type(cycles(problem, -1e-3, 1), PointType::fold);
  REQUIRE(folds.size() == 1);
  const RodResponse rods(parameters);
  const Real k = rods.contact_stiffness();
  const Real mass = rods.base_mass() * 4 * std::numbers::pi_v<Real> * std::numbers::pi_v<Real>;
  const auto square = [&](Real x) { return (rods.base_stiffness() + rods.friction(1 / x, 1).real()) / mass; };
  // With y = x(1 - x)/eta(x): ln y' = (1 - 2x)/(x (1 - x)) - (eta^2)'/(2 eta^2), where
  // d(Re phi)/dx = (8/pi) sqrt(x (1 - x)).
  const auto slope = [&](Real x) {
    const Real rest = x * (1 - x);
    const Real square_slope = k * 8 / std::numbers::pi_v<Real> * std::sqrt(rest) / mass;
    return (1 - 2 * x) / rest - square_slope / (2 * square(x));
  };
  std::uintmax_t iterations = 200;
  const auto [a, b] = boost::math::tools::toms748_solve(
      slope, Real(0.3), Real(0.7), boost::math::tools::eps_tolerance<Real>(60), iterations);
  const Real x = (a + b) / 2;
  const Real eta = std::sqrt(square(x));
  const Real zeta =
      -rods.friction(1 / x, 1).imag() * parameters.frequency_ratio / (2 * eta * rods.base_stiffness());
  CHECK_THAT(values_at(problem, folds[0])(LimitCycle::R_over_S), WithinRel(static_cast<double>(1 / x), 1e-9));
  CHECK(std::abs(static_cast<double>(1 / x) - 2) > 1e-3);
  CHECK_THAT(folds[0].unknowns(LimitCycle::eta), WithinRel(static_cast<double>(eta), 1e-9));
  CHECK_THAT(folds[0].parameters(LimitCycle::zeta), WithinRel(static_cast<double>(zeta), 1e-12));
}

TEST_CASE("Every cycle solves the complex equation with compliances from linear solves") {
  SystemParameters parameters = rods(1);
  parameters.model = GENERATE(StructureModel::rods, StructureModel::beams);
  parameters.base_damping_kind = GENERATE(DampingKind::viscous, DampingKind::structural);
  parameters.damper_damping = 1e-3;
  parameters.preload_growth = 0.01;
  const LimitCycle problem(build_system(parameters));
  const Branch branch = cycles(problem, -1e-3, 1);
  REQUIRE(branch.points.size() > 20);
  CHECK(of_type(branch, PointType::fold).size() == 1);
  double worst = 0;
  for (const BranchPoint& point : branch.points) worst = std::max(worst, defect(parameters, problem, point));
  CHECK(worst < 1e-9);  // ten times the tolerance of the corrector
}

TEST_CASE("A cycle begins on the border of stick, where the stuck pair has no damping") {
  SystemParameters parameters = rods(1);
  parameters.damper_damping = 1e-3;
  const LimitCycle problem(build_system(parameters));
  const Branch branch =
      continuation::trace(problem, problem.guess(-1e-3, 1), amplitude_over("zeta_B", -1e-3, 0));
  REQUIRE(branch.stop == Stop::left_regime);
  const BranchPoint& last = branch.points.back();
  CHECK_THAT(values_at(problem, last)(LimitCycle::R_over_S), WithinAbs(1, 1e-10));
  // There the power that the base feeds in is what the damper's own damping takes.
  const RodResponse rods(parameters);
  const RodResponse::Real eta = last.unknowns(LimitCycle::eta);
  const auto motion = rods.contact_stiffness() * rods.c_damper(eta);  // -u/r; y = -r (1 + k c_D)
  const auto taken =
      rods.base_stiffness() / parameters.stiffness_ratio() * rods.damper_loss(eta) * std::norm(motion);
  const auto fed = -2 * last.parameters(LimitCycle::zeta) * eta / parameters.frequency_ratio *
                   rods.base_stiffness() * std::norm(1.0L + motion);
  CHECK_THAT(static_cast<double>(fed / taken), WithinAbs(1, 1e-7));  // of eta's 1e-10 near a resonance
}

TEST_CASE("What the base feeds in over a cycle is what friction dissipates") {
  const SystemParameters parameters = held_rods(DampingKind::structural);
  const LimitCycle problem(build_system(parameters));
  const RodResponse rods(parameters);
  for (const BranchPoint& point : cycles(problem, -1e-3, 1).points) {
    const Vector values = values_at(problem, point);
    if (values(LimitCycle::R_over_S) < 1.0001) continue;  // both tend to zero
    const double S = values(LimitCycle::S);
    const double lost =
        static_cast<double>(rods.contact_stiffness()) * S * S * values(LimitCycle::dissipated);
    const double fed = -2 * point.parameters(LimitCycle::zeta) * std::numbers::pi *
                       static_cast<double>(rods.base_stiffness()) * std::pow(values(LimitCycle::Y), 2);
    CHECK_THAT(fed, WithinRel(lost, 1e-6));  // 1e-10 over an Im phi of 1e-4 or more
  }
}

TEST_CASE("The preload scales a cycle and folds nothing, also where it grows with eta") {
  SystemParameters parameters = rods(1);
  parameters.preload_growth = GENERATE(0.0, 0.1);
  parameters.damper_damping = 1e-3;
  const LimitCycle problem(build_system(parameters));
  const Branch branch =
      continuation::trace(problem, problem.guess(-1e-2, 0.01), amplitude_over("P", 0.01, 100));
  REQUIRE(branch.complete());
  const BranchPoint& first = branch.points.front();
  const Vector at_first = values_at(problem, first);
  for (const BranchPoint& point : branch.points) {
    CHECK(
        (point.type == PointType::regular || point.type == PointType::start || point.type == PointType::end));
    const Vector values = values_at(problem, point);
    CHECK_THAT(values(LimitCycle::frequency), WithinRel(at_first(LimitCycle::frequency), 1e-8));
    CHECK_THAT(values(LimitCycle::R_over_S), WithinRel(at_first(LimitCycle::R_over_S), 1e-6));
  }
}

TEST_CASE("The guess gives the small and the large cycle, and none below the fold or with positive damping") {
  const SystemParameters parameters = held_rods(DampingKind::structural);
  const LimitCycle problem(build_system(parameters));
  const double fold = of_type(cycles(problem, -1e-3, 1), PointType::fold).at(0).parameters(LimitCycle::zeta);
  for (const double zeta : {0.01 * fold, 0.5 * fold, 0.99 * fold}) {
    const auto small = problem.guess(zeta, 2, LimitCycle::Size::small);
    const auto large = problem.guess(zeta, 2, LimitCycle::Size::large);
    // The held mode's Im phi = zeta/(pi fold) has the two solutions x = (1 -+ sqrt(1 - zeta/fold))/2.
    const double S = problem.system().slip_threshold(4, 2);
    const double root = std::sqrt(1 - zeta / fold);
    CHECK_THAT(std::exp(small.unknowns(LimitCycle::log_R)), WithinRel(2 * S / (1 + root), 1e-9));
    CHECK_THAT(std::exp(large.unknowns(LimitCycle::log_R)), WithinRel(2 * S / (1 - root), 1e-9));
    Vector residual(2);
    REQUIRE(problem.evaluate(large.unknowns, large.parameters, 0, {&residual}));
    CHECK(residual.norm() < 1e-10);
  }
  CHECK_THROWS_AS(problem.guess(1.01 * fold, 1), std::invalid_argument);
  CHECK_THROWS_AS(problem.guess(0.01, 1), std::invalid_argument);
}

namespace {

struct KnownCycle {
  double eta;
  double zeta = 0;
};

/// The cycle with this R/S, by Newton's method for eta and zeta_B on k phi + 1/c = 0 from a resonance.
std::optional<KnownCycle> cycle_with(const FrictionSystem& system, double log_ratio, double resonance) {
  KnownCycle at{resonance, -1e-6};  // c is infinite on a resonance without damping
  const Complex force = system.contact_stiffness * slip_coefficient(log_ratio).phi;
  for (int i = 0; i < 50; ++i) {
    const DampedCompliance base =
        system.base.compliance(at.eta, at.zeta, system.base_loss_per_zeta, system.base_loss_fixed);
    const ContactResponse damper = system.damper.at(at.eta);
    const Complex c = base.value + damper.compliance;
    const Complex value = force + 1.0 / c;
    Eigen::Matrix2d slopes;
    const Complex by_eta = -(base.by_eta + damper.compliance_eta) / (c * c);
    const Complex by_zeta = -base.by_zeta / (c * c);
    slopes << by_eta.real(), by_zeta.real(), by_eta.imag(), by_zeta.imag();
    const Eigen::Vector2d step = slopes.partialPivLu().solve(Eigen::Vector2d(value.real(), value.imag()));
    at.eta -= step(0);
    at.zeta -= step(1);
    if (!(at.eta > 0) || !step.allFinite()) return std::nullopt;
    if (std::abs(step(0)) < 1e-13 * at.eta && std::abs(step(1)) < 1e-10 * std::abs(at.zeta)) return at;
  }
  return std::nullopt;
}

}  // namespace

TEST_CASE("All cycles are found at their zeta_B, however large they are and light the damping is") {
  RandomSystems draw(17);
  int known = 0;
  for (int i = 0; i < 120; ++i) {
    SystemParameters s = draw.ring(3, 100);
    s.mass_ratio = draw.log_uniform(0.3, 60);
    s.frequency_ratio = draw.log_uniform(0.5, 6);
    s.interface_stiffness = draw.log_uniform(1, 1e5);
    s.damper_damping = draw.log_uniform(1e-6, 0.3);
    s.fixed_damper = draw.integer(0, 2) == 0;
    s.base_damping_kind = draw.integer(0, 1) == 0 ? DampingKind::viscous : DampingKind::structural;
    const LimitCycle problem(build_system(s));
    const FrictionSystem& system = problem.system();
    const double log_ratio = draw.uniform(0.01, 18);  // R/S up to 7e7
    const double resonance =
        log_ratio < 1 ? joined_frequencies({&system.base, &system.damper}, system.contact_stiffness)[0]
                      : system.base.modes().front().frequency;
    const auto cycle = cycle_with(system, log_ratio, resonance);
    if (!cycle || !(cycle->zeta < 0)) continue;
    ++known;
    CAPTURE(i, log_ratio, cycle->eta, cycle->zeta);
    const auto found = problems::cycles_at(system, cycle->zeta);
    CHECK(std::any_of(found.begin(), found.end(), [&](const problems::CycleAtZeta& at) {
      return std::abs(at.eta / cycle->eta - 1) < 1e-9 && std::abs(at.log_ratio - log_ratio) < 1e-4;
    }));
    CHECK_NOTHROW(problem.guess(cycle->zeta, 1));
  }
  CHECK(known > 60);
}

TEST_CASE("Where there is no small cycle the large one is the start of a branch") {
  SystemParameters s;
  s.model = StructureModel::rods;
  s.wave_number = 1;
  s.elements = 115;
  s.mass_ratio = 26.6681;
  s.frequency_ratio = 2.03272;
  s.interface_stiffness = 1038.09;
  s.damper_damping = 0.00785035;
  const LimitCycle problem(build_system(s));
  const double preload = 1.39744;
  CHECK_THROWS_WITH(problem.guess(-1e-5, preload, LimitCycle::Size::small),
                    "LimitCycle: no small limit cycle was found at zeta_B = -1e-05, P = 1.39744");
  continuation::TraceOptions options = amplitude_over("zeta_B", -1e-5, -2e-5);
  options.stop_at = {-1.523e-5};
  const Branch branch = continuation::trace(problem, problem.guess(-1e-5, preload), options);
  REQUIRE(branch.complete());
  const auto at = of_type(branch, PointType::user);
  REQUIRE(at.size() == 1);
  CHECK_THAT(values_at(problem, at[0])(LimitCycle::R_over_S), WithinRel(9974, 5e-4));
}

TEST_CASE("The limit cycle has exact derivatives in eta, R, zeta_B and P") {
  RandomSystems draw(7);
  for (int i = 0; i < 100; ++i) {
    SystemParameters s = draw.system();
    s.interface_stiffness = draw.log_uniform(1, 1e4);
    s.damper_damping = draw.log_uniform(1e-2, 0.2);
    s.base_damping_kind = draw.integer(0, 1) == 0 ? DampingKind::viscous : DampingKind::structural;
    s.fixed_damper = draw.integer(0, 3) == 0;
    s.preload = draw.log_uniform(0.1, 10) * s.interface_stiffness / s.stiffness_ratio();  // S from 0.1 to 10
    const auto [from, to] = resonance_range(s);
    s.preload_growth = s.preload * draw.log_uniform(0.1, 10) / (to * to);
    const LimitCycle problem(build_system(s));
    Vector u(2);
    Vector p(2);
    p << -draw.log_uniform(2e-2, 0.2), s.preload;
    u << draw.log_uniform(from, to), 0;
    u(1) = problem.system().log_threshold(u(0), p(1)).value + draw.uniform(0.01, 6);
    const auto report = continuation::check_derivatives(problem, u, p, 0);
    INFO(i << " worst at " << report.where);
    CHECK(report.worst < 1e-7);  // of the differences, near resonances
  }
}
