#include <numbers>

#include "arcslip/assembly/reduced_pair.hpp"
#include "arcslip/sectors/dynamic_stiffness.hpp"
#include "catch.hpp"
#include "sector_frequencies.hpp"

using namespace arcslip;

namespace {

SystemParameters figure_8_system() {
  SystemParameters parameters;
  parameters.mass_ratio = 5;
  parameters.frequency_ratio = 4;
  parameters.interface_stiffness = shear_interface_stiffness(33.3, 0.3);
  return parameters;
}

void check_close(Complex value, Complex expected, double tolerance) {
  CHECK(std::abs(value - expected) <= tolerance * std::abs(expected));
}

}  // namespace

TEST_CASE("The sum over modes is what solves with the dynamic stiffness give, derivatives included") {
  SystemParameters parameters = figure_8_system();
  parameters.model = GENERATE(StructureModel::rods, StructureModel::beams);
  parameters.elements = GENERATE(5, 30);
  parameters.base_damping = 0.02;
  const ReducedPair pair = reduce(parameters);
  const double damping = base_damping_factor(parameters);
  const ModalModel modal(pair.base, 0, damping);
  const DynamicStiffness direct = dynamic_stiffness(pair.base, damping);
  for (const double eta : {0.3, 1.0, 3.99, 4.0, 17.0, 95.0}) {
    const ContactResponse a = modal.at(eta);
    const ContactResponse b = direct.contact_response(eta, 0);
    // 1e-9: the solves lose a^4 of 16 digits near the resonance, the sums lose nothing.
    check_close(a.compliance, b.compliance, 1e-9);
    check_close(a.compliance_eta, b.compliance_eta, 1e-9);
    check_close(a.free, b.free, 1e-9);
    check_close(a.free_eta, b.free_eta, 1e-9);
  }
}

TEST_CASE("Structural damping is a complex stiffness, of the same loss at every eta") {
  SystemParameters parameters = figure_8_system();
  parameters.model = GENERATE(StructureModel::rods, StructureModel::beams);
  parameters.base_damping = GENERATE(0.02, -0.02);
  parameters.base_damping_kind = DampingKind::structural;
  const FrictionSystem system = build_system(parameters);
  DynamicStiffness direct = dynamic_stiffness(reduce(parameters).base, 0);
  direct.stiffness *= Complex(1, 2 * parameters.base_damping);
  for (const double eta : {0.3, 1.0, 3.99, 4.0, 17.0, 95.0}) {
    const ContactResponse a = system.base.at(eta);
    const ContactResponse b = direct.contact_response(eta, 0);
    check_close(a.compliance, b.compliance, 1e-9);  // as above
    check_close(a.compliance_eta, b.compliance_eta, 1e-9);
    check_close(a.free, b.free, 1e-9);
    check_close(a.free_eta, b.free_eta, 1e-9);
  }
}

TEST_CASE("The compliance as a function of zeta is that of the model with this damping") {
  SystemParameters parameters = figure_8_system();
  parameters.base_damping_kind = GENERATE(DampingKind::viscous, DampingKind::structural);
  parameters.base_damping = -0.03;
  const FrictionSystem system = build_system(parameters);
  for (const double eta : {0.3, 3.99, 4.0, 95.0}) {
    const DampedCompliance c = system.base.compliance(eta, -0.03, system.base_loss_per_zeta);
    check_close(c.value, system.base.at(eta).compliance, 1e-14);
    check_close(c.by_eta, system.base.at(eta).compliance_eta, 1e-14);
    const auto value = [&](double zeta) {
      return system.base.compliance(eta, zeta, system.base_loss_per_zeta).value;
    };
    check_close(c.by_zeta, (value(-0.03 + 1e-6) - value(-0.03 - 1e-6)) / 2e-6, 1e-7);
  }
}

TEST_CASE("A held structure does not respond") {
  SystemParameters parameters = figure_8_system();
  parameters.fixed_damper = true;
  const FrictionSystem system = build_system(parameters);
  CHECK(system.damper.at(1).compliance == 0.0);
  CHECK(system.damper.at(1).compliance_eta == 0.0);
  CHECK(joined_frequencies({&system.base, &system.damper}, system.contact_stiffness).size() == 2);
}

TEST_CASE("The derivatives in eta are those of the values") {
  const ReducedPair pair = reduce(figure_8_system());
  const ModalModel modal(pair.base, 0, 1e-3);
  for (const double eta : {0.5, 3.9, 4.1, 50.0}) {
    const double h = 1e-6 * eta;
    const auto slope = [&](auto member) {
      return (modal.at(eta + h).*member - modal.at(eta - h).*member) / (2 * h);
    };
    check_close(modal.at(eta).compliance_eta, slope(&ContactResponse::compliance), 1e-7);
    check_close(modal.at(eta).free_eta, slope(&ContactResponse::free), 1e-7);
  }
}

TEST_CASE("Fine rings resonate where the continuous ones do: eta = n gamma for rods, n^2 gamma for beams") {
  SystemParameters parameters = figure_8_system();
  parameters.wave_number = GENERATE(1, 2, 3);
  parameters.elements = GENERATE(1000, 1000000);
  const auto n = static_cast<double>(parameters.wave_number);
  const double mesh = n / static_cast<double>(parameters.elements);
  parameters.model = StructureModel::rods;
  // Error of the consistent mass: (pi n/N)^2/6 relative; beams converge as its square.
  CHECK_THAT(build_system(parameters).base.modes().front().frequency,
             WithinRel(4 * n, 2 * mesh * mesh + 1e-15));
  CHECK_THAT(build_system(parameters).damper.modes().front().frequency,
             WithinRel(n, 2 * mesh * mesh + 1e-15));
  parameters.model = StructureModel::beams;
  const double expected = std::pow(mesh * std::numbers::pi * 2, 4) + 1e-15;
  CHECK_THAT(build_system(parameters).base.modes().front().frequency, WithinRel(4 * n * n, expected));
  CHECK_THAT(build_system(parameters).damper.modes().front().frequency, WithinRel(n * n, expected));
}

TEST_CASE("A million elements lose no digit: beams of N = 10^6 respond as those of N = 10^5 to (n/N)^4") {
  SystemParameters coarse = figure_8_system();
  coarse.elements = 100000;
  SystemParameters fine = coarse;
  fine.elements = 1000000;
  const FrictionSystem a = build_system(coarse);
  const FrictionSystem b = build_system(fine);
  for (const double eta : {0.5, 3.8, 4.0, 93.0}) {
    check_close(a.contact_stiffness * a.base.at(eta).compliance,
                b.contact_stiffness * b.base.at(eta).compliance, 1e-9);
    check_close(a.base.at(eta).free, b.base.at(eta).free, 1e-9);
  }
}

TEST_CASE("The joined frequencies are the eigenvalues of the structures joined by the interface springs") {
  SystemParameters parameters = figure_8_system();
  parameters.elements = 8;
  parameters.interface_stiffness = GENERATE(1e-3, 10.0, 1e4, 1e8);
  const FrictionSystem system = build_system(parameters);
  const ReducedPair pair = reduce(parameters);
  const DynamicStiffness base = dynamic_stiffness(pair.base, 0);
  const DynamicStiffness damper = dynamic_stiffness(pair.damper, 0);
  ComplexMatrix stiffness = ComplexMatrix::Zero(4, 4);
  ComplexMatrix mass = ComplexMatrix::Zero(4, 4);
  stiffness.topLeftCorner(2, 2) = base.stiffness;
  stiffness.bottomRightCorner(2, 2) = damper.stiffness;
  mass.topLeftCorner(2, 2) = base.mass;
  mass.bottomRightCorner(2, 2) = damper.mass;
  ComplexVector difference = ComplexVector::Zero(4);
  difference(0) = -1;
  difference(2) = 1;
  stiffness += system.contact_stiffness * difference * difference.adjoint();
  const Vector squared = testing::squared_frequencies(stiffness, mass);
  const std::vector<double> joined =
      joined_frequencies({&system.base, &system.damper}, system.contact_stiffness);
  REQUIRE(joined.size() == 4);
  for (std::size_t k = 0; k < 4; ++k) {
    const double expected = std::sqrt(squared(static_cast<Index>(k))) / (2 * std::numbers::pi);
    CHECK_THAT(joined[k], WithinRel(expected, 1e-9));
  }
  CHECK(joined_frequencies({&system.damper}, system.contact_stiffness).size() == 2);
}

TEST_CASE("Base and damper of equal frequencies have their own as a joined frequency") {
  SystemParameters parameters = figure_8_system();
  parameters.model = StructureModel::rods;
  parameters.frequency_ratio = 1;
  parameters.interface_stiffness = 1000;
  const FrictionSystem system = build_system(parameters);
  const std::vector<double> joined =
      joined_frequencies({&system.base, &system.damper}, system.contact_stiffness);
  REQUIRE(joined.size() == 2);
  CHECK_THAT(joined[0], WithinRel(system.base.modes()[0].frequency, 1e-12));
  const double relative = std::sqrt(1 + 1000 * (1 + 1 / 5.0) / (4 * std::numbers::pi * std::numbers::pi));
  CHECK_THAT(joined[1], WithinRel(relative, 5e-3));  // continuous ring; N = 30 is within (pi/30)^2/6
}

TEST_CASE("A mass that is not positive definite is refused") {
  ReducedStructure bad{PreciseComplexMatrix::Constant(1, 1, PreciseComplex(-1)),
                       PreciseComplexMatrix::Constant(1, 1, PreciseComplex(1)),
                       PreciseComplexVector::Constant(1, PreciseComplex(1))};
  CHECK_THROWS_AS(ModalModel(bad, 0, 0), std::invalid_argument);
}
