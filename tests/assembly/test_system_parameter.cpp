// A system that is varied is the one that is built with the other value, and its rates are differences.

#include "arcslip/assembly/system_parameter.hpp"

#include <stdexcept>

#include "arcslip/assembly/harmonic_system.hpp"
#include "arcslip/assembly/system.hpp"
#include "catch.hpp"

using namespace arcslip;

namespace {

SystemParameters some_rings(StructureModel model, DampingKind kind) {
  SystemParameters s;
  s.model = model;
  s.wave_number = 2;
  s.elements = 10;
  s.mass_ratio = 3;
  s.frequency_ratio = 1.7;
  s.interface_stiffness = 40;
  s.base_damping = 0.01;
  s.damper_damping = 0.03;
  s.force = 0.7;
  s.base_damping_kind = kind;
  s.cubic_stiffness = 0.4;
  s.preload_growth = 0.02;
  s.influence = std::make_shared<const Influence>(Influence{{{0, -0.4}, {1, 3.0}, {-1, -2.0}}, {}, {}});
  s.influence_factor = 1.5;
  return s;
}

double difference(const ContactReceptance& a, const ContactReceptance& b) {
  return std::max({(a.compliance - b.compliance).norm() / b.compliance.norm(),
                   (a.compliance_eta - b.compliance_eta).norm() / b.compliance_eta.norm(),
                   (a.free - b.free).norm() / (b.free.norm() + 1e-300),
                   (a.free_eta - b.free_eta).norm() / (b.free_eta.norm() + 1e-300)});
}

}  // namespace

TEST_CASE("A varied system is the one built with the other value", "[systems]") {
  const auto model = GENERATE(StructureModel::rods, StructureModel::beams);
  const auto kind = GENERATE(DampingKind::viscous, DampingKind::structural);
  const SystemParameters system = some_rings(model, kind);
  const HarmonicSystem built = build_harmonic_system(system);
  for (const std::string& name : system_parameter_names(system)) {
    CAPTURE(name);
    const SystemParameter parameter = system_parameter(system, name);
    const double value = 1.3 * parameter.value;
    const SystemParameters other = with_parameter(system, name, value);
    const HarmonicSystem wanted = build_harmonic_system(other);
    const auto [here, rate] = parameter.at(value);
    for (const double eta : {0.3, 1.9, 2.8, 7.7}) {
      CHECK(difference(built.base[0].varied(eta, here.base, rate.base), wanted.base[0].at(eta)) < 1e-12);
      CHECK(difference(built.damper[0].varied(eta, here.damper, rate.damper), wanted.damper[0].at(eta)) <
            1e-12);
    }
    CHECK_THAT(built.contacts[0].stiffness * here.contact_stiffness,
               Catch::Matchers::WithinRel(wanted.contacts[0].stiffness, 1e-14));
    CHECK_THAT(built.contacts[0].slip_per_preload * here.slip_per_preload,
               Catch::Matchers::WithinRel(wanted.contacts[0].slip_per_preload, 1e-14));
    CHECK_THAT(here.preload_growth, Catch::Matchers::WithinRel(wanted.preload_growth, 1e-14));
    if (parameter.kind == SystemParameter::Kind::element) continue;  // made anew
    CHECK_THAT(cubic_coefficient(system) * here.others,
               Catch::Matchers::WithinRel(cubic_coefficient(other), 1e-14));
  }
}

TEST_CASE("The rates of a varied system are those of differences", "[systems]") {
  const SystemParameters system = some_rings(StructureModel::beams, DampingKind::viscous);
  const HarmonicSystem built = build_harmonic_system(system);
  for (const std::string& name : system_parameter_names(system)) {
    CAPTURE(name);
    const SystemParameter parameter = system_parameter(system, name);
    const double value = 0.8 * parameter.value;
    const double h = 1e-5 * value;
    const auto close = [h](double above, double below, double rate) {
      CHECK_THAT((above - below) / (2 * h), Catch::Matchers::WithinAbs(rate, 1e-8 * (1 + std::abs(rate))));
    };
    const auto [above, above_rate] = parameter.at(value + h);
    const auto [below, below_rate] = parameter.at(value - h);
    const auto [here, rate] = parameter.at(value);
    close(above.contact_stiffness, below.contact_stiffness, rate.contact_stiffness);
    close(above.slip_per_preload, below.slip_per_preload, rate.slip_per_preload);
    close(above.others, below.others, rate.others);
    close(above.preload_growth, below.preload_growth, rate.preload_growth);
    for (const double eta : {0.3, 2.8}) {
      const auto check = [&](const ContactModes& structure, const Variation& plus, const Variation& minus,
                             const Variation& middle, const Variation& slope) {
        const VariedReceptance up = structure.varied(eta, plus, slope);
        const VariedReceptance down = structure.varied(eta, minus, slope);
        const VariedReceptance at = structure.varied(eta, middle, slope);
        const ContactMatrix compliance = (up.compliance - down.compliance) / (2 * h);
        const ContactVector free = (up.free - down.free) / (2 * h);
        CHECK((compliance - at.compliance_rate).norm() <=
              1e-7 * at.compliance_rate.norm() + 1e-9 * at.compliance.norm());
        CHECK((free - at.free_rate).norm() <= 1e-7 * at.free_rate.norm() + 1e-9 * at.free.norm());
      };
      check(built.base[0], above.base, below.base, here.base, rate.base);
      check(built.damper[0], above.damper, below.damper, here.damper, rate.damper);
    }
  }
}

TEST_CASE("A system has no parameters but its own", "[systems]") {
  CHECK_THROWS_AS(system_parameter(some_rings(StructureModel::rods, DampingKind::viscous), "nu"),
                  std::invalid_argument);
}
