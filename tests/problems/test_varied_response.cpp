// Responses whose force, damping, stiffness or ratios are continued: derivatives, and the response of the
// system that is built with the value.

#include "arcslip/assembly/harmonic_system.hpp"
#include "arcslip/cases/case_file.hpp"
#include "arcslip/continuation/path/newton.hpp"
#include "arcslip/continuation/problem/derivative_check.hpp"
#include "arcslip/problems/response/harmonic_cycle.hpp"
#include "arcslip/problems/response/harmonic_response.hpp"
#include "arcslip/problems/response/nonlinear_mode.hpp"
#include "arcslip/problems/response/power_balance.hpp"
#include "catch.hpp"
#include "composition.hpp"

using namespace arcslip;
using namespace arcslip::problems;

namespace {

SystemParameters some_rods(const std::string& varied) {
  SystemParameters s;
  s.model = StructureModel::rods;
  s.wave_number = 1;
  s.elements = 12;
  s.mass_ratio = 3;
  s.frequency_ratio = 1.5;
  s.interface_stiffness = 40;
  s.base_damping = 1e-2;
  s.damper_damping = 2e-2;
  s.preload = 0.3;
  s.preload_growth = 0.02;
  s.harmonics = {1, 3, 5};
  s.cubic_stiffness = 0.3;
  s.others = {{"", find_element_kind("clearance"), PlacedElement::Place::contact, 0, {20, 0.12}},
              {"soft", find_element_kind("cubic"), PlacedElement::Place::damper, 0, {-0.2}}};
  s.varied = varied;
  return s;
}

/// A sector with three contacts, each with numbers of its own.
SystemParameters three_contacts() {
  const testing::TemporaryFolder folder;
  testing::write_row(folder, "base", {3, 2.5, 2}, {4, 3, 5}, {5, 4, 6});
  testing::write_row(folder, "damper", {1, 0.8, 0.9}, {2, 1.5, 2.5}, {0.1, 0.2, 0.1});
  std::string text =
      testing::composition::sector("[1, 2, 3]", "limit_per_preload = [1.0, 0.8, 1.3]\nharmonics = 3") +
      "[branch]\nparameter = \"eta\"\nfrom = 0.1\nto = 0.6\n";
  const std::string same = "contact_stiffness = 2.0";
  text.replace(text.find(same), same.size(), "contact_stiffness = [2.0, 3.0, 1.5]");
  return read_case(folder.write("case.toml", text)).branches[0].problem.system;
}

/// At the system's eta, preload and another value of the parameter.
Vector parameters_at(double eta, double preload, double value) {
  Vector p(3);
  p << eta, preload, value;
  return p;
}

}  // namespace

TEST_CASE("A response over a parameter of the system is that of the system with its value", "[harmonics]") {
  for (const std::string& name : system_parameter_names(some_rods(""))) {
    const SystemParameters system = some_rods(name);
    const HarmonicResponse problem(build_harmonic_system(system));
    CHECK(problem.parameter_names() == std::vector<std::string>{"eta", "P", name});
    const double value = 1.2 * system_parameter(system, name).value;
    SystemParameters other = with_parameter(system, name, value);
    other.varied.clear();
    const HarmonicResponse built(build_harmonic_system(other));
    for (const double eta : {1.2, 1.5}) {
      CAPTURE(name, eta);
      const continuation::Guess at = problem.guess(parameters_at(eta, 0.3, value));
      const continuation::Guess wanted = built.guess(eta, 0.3);
      CHECK(at.regime == wanted.regime);
      const continuation::Solution one = continuation::solve(problem, at);
      const continuation::Solution same = continuation::solve(built, wanted);
      REQUIRE(one.outcome == continuation::Correction::converged);
      REQUIRE(same.outcome == continuation::Correction::converged);
      CHECK((one.unknowns - same.unknowns).norm() < 1e-9 * same.unknowns.norm());
      Vector values;
      Vector wanted_values;
      problem.observe(one.unknowns, at.parameters, at.regime, values);
      built.observe(same.unknowns, wanted.parameters, wanted.regime, wanted_values);
      for (Index i = 0; i < values.size(); ++i)
        CHECK_THAT(values(i), Catch::Matchers::WithinAbs(wanted_values(i), 1e-8 * wanted_values.norm()));
      const PowerBalance power = power_balance(problem, one.unknowns, at.parameters, at.regime);
      CHECK(power.error() < 1e-9);
      CHECK(motion_error(problem, one.unknowns, at.parameters, at.regime) < 1e-9);
    }
  }
}

TEST_CASE("Derivatives by a parameter of the system are those of differences", "[harmonics]") {
  for (const std::string& name : system_parameter_names(some_rods(""))) {
    CAPTURE(name);
    const SystemParameters system = some_rods(name);
    const HarmonicResponse problem(build_harmonic_system(system));
    const continuation::Guess at =
        problem.guess(parameters_at(1.5, 0.3, 0.9 * system_parameter(system, name).value));
    REQUIRE(at.regime[0] == 1);
    const auto report = continuation::check_derivatives(problem, at.unknowns, at.parameters, at.regime);
    CAPTURE(report.where);
    CHECK(report.worst < 1e-5);  // differences of small amplitudes, which turn quickly
  }
}

TEST_CASE("Second derivatives along a parameter of the system are those of differences", "[harmonics]") {
  for (const std::string& name : system_parameter_names(some_rods(""))) {
    CAPTURE(name);
    const SystemParameters system = some_rods(name);
    const HarmonicResponse problem(build_harmonic_system(system));
    const Index n = problem.size();
    const continuation::Guess at =
        problem.guess(parameters_at(1.5, 0.3, 0.9 * system_parameter(system, name).value));
    const Vector w = Vector::LinSpaced(n, -1, 1);
    const Vector du = at.unknowns.norm() * Vector::LinSpaced(n, 1, -0.5);
    const Vector dp = at.parameters.cwiseProduct(Eigen::Vector3d(0.3, -0.4, 1));
    Vector exact;
    REQUIRE(problem.second(at.unknowns, at.parameters, at.regime, w, du, dp, exact));
    const auto gradient = [&](double h) {
      Matrix jacobian(n, n);
      Matrix by_parameters(n, 3);
      REQUIRE(problem.evaluate(at.unknowns + h * du, at.parameters + h * dp, at.regime,
                               {nullptr, &jacobian, &by_parameters}));
      Vector out(n + 3);
      out << jacobian.transpose() * w, by_parameters.transpose() * w;
      return out;
    };
    constexpr double h = 1e-5;
    const Vector differences = (gradient(h) - gradient(-h)) / (2 * h);
    CHECK((differences - exact).norm() < 1e-5 * exact.norm());
  }
}

TEST_CASE("Stiffness and limit of all contacts or of one are continued as the system is built with them",
          "[harmonics]") {
  SystemParameters system = three_contacts();
  const std::vector<std::string> names = system_parameter_names(system);
  for (const char* name : {"K_FD", "K_FD_1", "K_FD_3", "L", "L_1", "L_2", "P_2"}) {
    CAPTURE(name);
    REQUIRE(std::find(names.begin(), names.end(), name) != names.end());
    system.varied = name;
    const double value = name == std::string("P_2") ? 0.7 : 1.4 * system_parameter(system, name).value;
    const HarmonicResponse problem(build_harmonic_system(system));
    SystemParameters other = with_parameter(system, name, value);
    other.varied.clear();
    const HarmonicResponse built(build_harmonic_system(other));
    for (const double preload : {0.3, 3.0}) {
      const continuation::Guess at = problem.guess(parameters_at(0.25, preload, value));
      const continuation::Guess wanted = built.guess(0.25, preload);
      CHECK(at.regime == wanted.regime);
      CHECK((at.unknowns - wanted.unknowns).norm() < 1e-9 * wanted.unknowns.norm());
      Vector residual(built.size());
      REQUIRE(built.evaluate(at.unknowns, wanted.parameters, at.regime, {&residual}));
      CHECK(residual.norm() < 1e-9);
      CHECK(power_balance(problem, at.unknowns, at.parameters, at.regime).error() < 1e-9);
      const auto report = continuation::check_derivatives(problem, at.unknowns, at.parameters, at.regime);
      CAPTURE(report.where);
      if (at.regime != continuation::Regime(0)) CHECK(report.worst < 1e-5);
    }
  }
}

namespace {

/// What of a problem over a parameter is held against the one that is built with its value.
void check_free(const continuation::Problem& problem, const continuation::Guess& at,
                const continuation::Problem& built, const continuation::Guess& wanted) {
  CHECK(at.regime == wanted.regime);
  REQUIRE(at.regime != continuation::Regime(0));
  CHECK((at.unknowns - wanted.unknowns).norm() < 1e-9 * wanted.unknowns.norm());
  Vector residual(built.size());
  REQUIRE(built.evaluate(at.unknowns, wanted.parameters, at.regime, {&residual}));
  CHECK(residual.norm() < 1e-9);
  const auto report = continuation::check_derivatives(problem, at.unknowns, at.parameters, at.regime);
  CAPTURE(report.where);
  CHECK(report.worst < 1e-5);
}

}  // namespace

TEST_CASE("Modes and cycles over a parameter are those of the system with its value, derivatives exact",
          "[harmonics]") {
  for (const std::string& name : system_parameter_names(some_rods(""))) {
    if (name == "F") continue;
    CAPTURE(name);
    SystemParameters system = some_rods(name);
    system.base_damping = -0.02;
    const double value = 1.2 * system_parameter(system, name).value;
    SystemParameters other = with_parameter(system, name, value);
    other.varied.clear();
    const NonlinearMode mode(build_harmonic_system(system));
    const NonlinearMode built_mode(build_harmonic_system(other));
    const continuation::Guess at = mode.guess(1.5, parameters_at(0.4, 0.3, value), {});
    check_free(mode, at, built_mode, built_mode.guess(1.5, at.parameters.head(2), {}));
    if (name == "zeta_B") continue;
    const HarmonicCycle cycle(build_harmonic_system(system));
    const HarmonicCycle built_cycle(build_harmonic_system(other));
    const continuation::Guess around = cycle.guess(parameters_at(-0.02, 0.3, value));
    check_free(cycle, around, built_cycle, built_cycle.guess(-0.02, 0.3));
  }
}
