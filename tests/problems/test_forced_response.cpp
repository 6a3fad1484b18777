#include <boost/math/constants/constants.hpp>
#include <numbers>

#include "arcslip/assembly/reduced_pair.hpp"
#include "arcslip/continuation/problem/derivative_check.hpp"
#include "arcslip/elements/contact.hpp"
#include "catch.hpp"
#include "paper_cases.hpp"
#include "random_systems.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using continuation::PointType;
using problems::ForcedResponse;

namespace {

struct Peak {
  double eta, Y;
};

/// Compares the branch of one preload with peaks and switches found by an independent solver, to all digits
/// printed.
void check_branch(const SystemParameters& parameters, double to, const std::vector<Peak>& peaks,
                  const std::vector<double>& switches) {
  const ForcedResponse problem(build_system(parameters));
  const continuation::Branch branch = trace_over_eta(problem, parameters.preload, 0.5, to);
  REQUIRE(branch.complete());
  const auto found_peaks = of_type(branch, PointType::peak);
  for (const Peak& peak : peaks) {
    const auto nearest =
        std::min_element(found_peaks.begin(), found_peaks.end(), [&](const auto& a, const auto& b) {
          return std::abs(a.parameters(0) - peak.eta) < std::abs(b.parameters(0) - peak.eta);
        });
    REQUIRE(nearest != found_peaks.end());
    CHECK_THAT(nearest->parameters(0), WithinRel(peak.eta, 1e-7));
    CHECK_THAT(quantity(problem, *nearest, ForcedResponse::Y), WithinRel(peak.Y, 1e-8));
  }
  const auto found_switches = of_type(branch, PointType::regime_switch);
  REQUIRE(found_switches.size() == switches.size());
  for (std::size_t i = 0; i < switches.size(); ++i) {
    CHECK_THAT(found_switches[i].parameters(0), WithinRel(switches[i], 2e-9));
  }
}

/// Motion of a two-dof structure under a force, and the energy that its damping takes per cycle, in fifty
/// digits.
struct PreciseBeam {
  ReducedStructure structure;
  double damping;  // beta: C = (beta/2 pi) K

  PreciseComplexVector solve(double eta, const PreciseComplexVector& force) const {
    const PreciseReal w = 2 * boost::math::constants::pi<PreciseReal>() * eta;
    const PreciseComplexMatrix z =
        structure.stiffness * PreciseComplex(1, damping * eta) - structure.mass * PreciseComplex(w * w);
    const PreciseComplex determinant = z(0, 0) * z(1, 1) - z(0, 1) * z(1, 0);
    PreciseComplexVector motion(2);
    motion << (z(1, 1) * force(0) - z(0, 1) * force(1)) / determinant,
        (z(0, 0) * force(1) - z(1, 0) * force(0)) / determinant;
    return motion;
  }

  double dissipated(double eta, const PreciseComplexVector& motion) const {
    const PreciseComplex form = motion.dot(structure.stiffness * motion);
    return std::numbers::pi * eta * damping * static_cast<double>(form.real());
  }
};

}  // namespace

TEST_CASE("Figure 8 has the peaks and switches of an independent solver") {
  check_branch(figure_8(0.1), 120, {{4.00000532, 2.79964423}}, {2.384417921});
  check_branch(figure_8(1), 120,
               {{3.46805307, 0.00585733304}, {3.841129, 0.00718851766}, {98.2606368, 2.07352002e-06}},
               {3.421960684, 4.000004101, 85.33521707, 100.9891812});
  check_branch(figure_8(50), 120, {{3.67128322, 0.257652932}, {93.6454667, 5.98201281e-05}},
               {3.668101803, 3.679431752, 93.3362192, 93.64817978});
}

TEST_CASE("At every peak and trough the slope of Y along the branch vanishes, to 1e-10 in eta") {
  const double preload = GENERATE(0.1, 1.0, 5.0, 50.0);
  const ForcedResponse problem(build_system(figure_8(preload)));
  const auto slope = [&](double eta) {  // dY/d eta = Y_eta - Y_rho g_eta/g_rho
    const continuation::Guess at = problem.guess(eta, preload);
    Matrix by_rho(1, 1);
    Matrix by_parameters(1, 2);
    problem.evaluate(at.unknowns, at.parameters, at.regime, {nullptr, &by_rho, &by_parameters});
    continuation::Gradient gradient{Vector(1), Vector(2)};
    problem.observe(at.unknowns, at.parameters, at.regime, ForcedResponse::Y, gradient);
    return gradient.parameters(0) - gradient.unknowns(0) * by_parameters(0, 0) / by_rho(0, 0);
  };
  const continuation::Branch branch = trace_over_eta(problem, preload, 0.5, 120);
  int checked = 0;
  for (std::size_t i = 1; i < branch.points.size(); ++i) {
    const continuation::BranchPoint& point = branch.points[i];
    if (point.type != PointType::peak && point.type != PointType::trough) continue;
    if (point.arclength == branch.points[i - 1].arclength) continue;  // a corner: the slope jumps
    const double eta = point.parameters(0);
    const double h = 1e-8 * eta;
    const double curvature = (slope(eta + h) - slope(eta - h)) / (2 * h);
    CHECK(std::abs(slope(eta) / curvature) < 1e-10 * eta);
    ++checked;
  }
  CHECK(checked >= 3);
}

TEST_CASE("The rods have the peaks and switches of an independent solver") {
  check_branch(rods(1), 20, {{3.20898337, 0.14659864}, {5.7601505, 0.0364682334}},
               {3.203034808, 4.00398297, 5.154137971, 6.519723608});
}

TEST_CASE("The state at eta = 3.841, P = 1 of figure 8 is that of an independent solver") {
  const ForcedResponse problem(build_system(figure_8(1)));
  const continuation::Guess guess = problem.guess(3.841, 1);
  Vector values;
  problem.observe(guess.unknowns, guess.parameters, guess.regime, values);
  CHECK_THAT(values(ForcedResponse::R_over_S), WithinRel(797.8003785, 1e-9));
  CHECK_THAT(values(ForcedResponse::Y), WithinRel(0.007188515919, 1e-9));
  CHECK_THAT(values(ForcedResponse::U), WithinRel(0.004751338963, 1e-9));
  CHECK_THAT(values(ForcedResponse::beta), WithinRel(1.4921532, 1e-7));
  CHECK_THAT(values(ForcedResponse::alpha), WithinRel(2.388983553, 1e-9));
  CHECK_THAT(values(ForcedResponse::psi), WithinRel(-2.370561322, 1e-9));
}

TEST_CASE("Residual, border and Y have exact derivatives in R, eta and P in both regimes") {
  const ForcedResponse problem(build_system(rods(1)));
  for (const double eta : {1.5, 3.3, 5.9}) {
    for (const double log_ratio : {-3.0, -0.1, 0.1, 1.0, 6.0}) {
      Vector u(1);
      u << std::log(problem.system().slip_per_preload) + log_ratio;
      Vector p(2);
      p << eta, 1.0;
      const int regime = log_ratio < 0 ? ForcedResponse::stick : ForcedResponse::slip;
      const continuation::DerivativeReport report = continuation::check_derivatives(problem, u, p, regime);
      INFO("worst at " << report.where);
      CHECK(report.worst < 1e-8);  // of the differences
    }
  }
}

TEST_CASE("The power put in equals the energy that friction and structures dissipate, at every point") {
  const double preload = GENERATE(0.1, 1.0, 50.0);
  const SystemParameters parameters = figure_8(preload);
  const ForcedResponse problem(build_system(parameters));
  const ReducedPair pair = reduce(parameters);
  const PreciseBeam base{pair.base, base_damping_factor(parameters)};
  const PreciseBeam damper{pair.damper, damper_damping_factor(parameters)};
  const double k = problem.system().contact_stiffness;
  const PreciseComplexVector contact = PreciseComplexVector::Unit(2, 0);
  Vector values;
  double worst = 0;
  for (const auto& point : trace_over_eta(problem, preload, 0.5, 120).points) {
    problem.observe(point.unknowns, point.parameters, point.regime, values);
    const double eta = point.parameters(0);
    const double s = values(ForcedResponse::S);
    const Complex r = std::polar(values(ForcedResponse::R), -values(ForcedResponse::psi));
    const Complex force = k * r * hysteresis_coefficient(values(ForcedResponse::R), s).phi;
    // Both structures move under the load and the friction force k phi r; the energies are per cycle and
    // node.
    const PreciseComplexVector friction_force = contact * PreciseComplex(force.real(), force.imag());
    const PreciseComplexVector y = base.solve(eta, pair.base.load + friction_force);
    const PreciseComplexVector u = damper.solve(eta, -friction_force);
    const double put_in = std::numbers::pi * static_cast<double>(y.dot(pair.base.load).imag());
    const double structural = base.dissipated(eta, y) + damper.dissipated(eta, u);
    const double friction = k * s * s * values(ForcedResponse::dissipated);
    worst = std::max(worst, std::abs(put_in - structural - friction) / put_in);
  }
  CHECK(worst < 1e-8);  // the residual of 1e-10 over the small phase angles that make the power
}

TEST_CASE("The observables are consistent with each other: r = u - y") {
  const ForcedResponse problem(build_system(figure_8(1)));
  Vector values;
  for (const auto& point : trace_over_eta(problem, 1, 0.5, 120).points) {
    problem.observe(point.unknowns, point.parameters, point.regime, values);
    const Complex y = std::polar(values(ForcedResponse::Y), -values(ForcedResponse::beta));
    const Complex u = std::polar(values(ForcedResponse::U), -values(ForcedResponse::alpha));
    const Complex r = std::polar(values(ForcedResponse::R), -values(ForcedResponse::psi));
    CHECK(std::abs(u - y - r) <= 1e-9 * std::max(std::abs(y), std::abs(u)));
    CHECK_THAT(values(ForcedResponse::R) / values(ForcedResponse::S),
               WithinRel(values(ForcedResponse::R_over_S), 1e-12));
  }
}

TEST_CASE("What the paper says of figure 8 in words holds") {
  std::vector<double> highest;
  for (const double preload : {0.1, 1.0, 5.0, 10.0, 50.0}) {
    const ForcedResponse problem(build_system(figure_8(preload)));
    const continuation::Branch branch = trace_over_eta(problem, preload, 0.5, 120);
    double top = 0;
    for (const auto& peak : of_type(branch, PointType::peak)) {
      top = std::max(top, quantity(problem, peak, ForcedResponse::Y));
    }
    highest.push_back(top);
    const continuation::Guess at_one = problem.guess(1, preload);
    CHECK(at_one.regime == ForcedResponse::stick);  // R/S < 1 at eta = n = 1 for every preload
  }
  CHECK(std::min_element(highest.begin(), highest.end()) - highest.begin() == 1);  // P = 1 reduces most

  const ForcedResponse locked(build_system(figure_8(50)));
  const auto phase_difference = [&](double eta) {
    const continuation::Guess guess = locked.guess(eta, 50);
    Vector values;
    locked.observe(guess.unknowns, guess.parameters, guess.regime, values);
    return std::abs(
        std::remainder(values(ForcedResponse::alpha) - values(ForcedResponse::beta), 2 * std::numbers::pi));
  };
  CHECK(phase_difference(2) < 0.01);                       // in phase at low frequency
  CHECK(phase_difference(93.5) > std::numbers::pi - 0.1);  // out of phase at the second peak
}

TEST_CASE("A light damper far from the base's resonance leaves the base moving as if alone") {
  SystemParameters parameters = figure_8(1);
  parameters.mass_ratio = 1e4;
  const ForcedResponse problem(build_system(parameters));
  for (const double eta : {1.5, 2.5, 8.0}) {
    const continuation::Guess guess = problem.guess(eta, 1);
    Vector values;
    problem.observe(guess.unknowns, guess.parameters, guess.regime, values);
    CHECK_THAT(values(ForcedResponse::Y), WithinRel(std::abs(problem.system().base.at(eta).free), 1e-2));
  }
}

TEST_CASE("Force and preload scaled together scale the response") {
  SystemParameters scaled = figure_8(3);
  scaled.force = 3;
  const ForcedResponse one(build_system(figure_8(1)));
  const ForcedResponse three(build_system(scaled));
  for (const double eta : {1.0, 3.6, 4.0, 95.0}) {
    CHECK_THAT(three.guess(eta, 3).unknowns(0) - one.guess(eta, 1).unknowns(0),
               WithinAbs(std::log(3.0), 1e-12));
  }
}

TEST_CASE("A branch has the same special points in either direction") {
  const double preload = GENERATE(0.1, 1.0, 50.0);
  const ForcedResponse problem(build_system(figure_8(preload)));
  const auto special = [&](double from, double to) {
    std::vector<std::pair<PointType, double>> found;
    for (const auto& point : trace_over_eta(problem, preload, from, to).points) {
      const bool inner = point.type == PointType::regime_switch || point.type == PointType::peak ||
                         point.type == PointType::trough;
      if (inner) found.emplace_back(point.type, point.parameters(0));
    }
    if (from > to) std::reverse(found.begin(), found.end());
    return found;
  };
  const auto up = special(0.5, 120);
  const auto down = special(120, 0.5);
  REQUIRE(up.size() == down.size());
  for (std::size_t i = 0; i < up.size(); ++i) CHECK_THAT(up[i].second, WithinRel(down[i].second, 1e-10));
}

TEST_CASE("The work of a branch does not depend on N, from 4 to a million elements") {
  const bool beams = GENERATE(false, true);
  std::vector<double> evaluations;
  for (const Index elements : {beams ? 10 : 4, 30, 1000, 1000000}) {  // a coarser beam has a mode in range
    SystemParameters parameters = beams ? figure_8(1) : rods(1);
    parameters.elements = elements;
    const continuation::Branch branch = trace_over_eta(ForcedResponse(build_system(parameters)), 1, 0.5, 20);
    REQUIRE(branch.complete());
    evaluations.push_back(static_cast<double>(branch.work.evaluations));
  }
  for (const double count : evaluations) CHECK_THAT(count, WithinRel(evaluations.back(), 0.2));
}

TEST_CASE("Parameters that are not positive cannot be evaluated") {
  const ForcedResponse problem(build_system(figure_8(1)));
  Vector residual(1);
  Vector p(2);
  p << -1, 1;
  CHECK_FALSE(problem.evaluate(Vector::Zero(1), p, ForcedResponse::slip, {&residual}));
  for (const double preload : {0.0, 1e-305}) {  // of the last a double does not hold S^2
    p << 1, preload;
    CHECK_FALSE(problem.evaluate(Vector::Zero(1), p, ForcedResponse::slip, {&residual}));
  }
}

TEST_CASE("Resonances of a width of 1e-9 and less are passed, beside their landmarks too") {
  RandomSystems draw(23);
  for (int i = 0; i < 200; ++i) {
    SystemParameters s;
    s.model = draw.integer(0, 1) == 0 ? StructureModel::rods : StructureModel::beams;
    s.wave_number = draw.integer(1, 3);
    s.elements = draw.integer(2 * s.wave_number + 1, 60);
    s.mass_ratio = draw.log_uniform(1e-3, 1e3);
    s.frequency_ratio = draw.log_uniform(0.01, 100);
    s.interface_stiffness = draw.log_uniform(1e-3, 1e8);
    s.base_damping = draw.log_uniform(2e-10, 1e-7);
    s.damper_damping = draw.log_uniform(2e-10, 1e-7);
    const double preload = draw.log_uniform(1e-6, 1e6);
    const ForcedResponse problem(build_system(s));
    const FrictionSystem& system = problem.system();
    const std::vector<double> resonances =
        joined_frequencies({&system.base, &system.damper}, system.contact_stiffness);
    const continuation::TraceOptions options = over("eta", 0.3 * resonances[0], 1.3 * resonances[1]);
    const continuation::Branch branch = trace(problem, problem.guess(options.from, preload), options);
    CAPTURE(i, branch.explanation);
    CHECK(branch.complete());
  }
}
