#include "cases/geometry_section.hpp"

#include <cmath>

namespace arcslip {
namespace {

using GeometryKey = Key<GeometrySettings>;

KeyTable<GeometrySettings> ring(RectangularRing Geometry::*which) {
  using R = RectangularRing;
  const auto is_needed = [=](const GeometrySettings& settings, const TomlSection&) {
    return settings.needs_shear && which == &Geometry::damper;
  };
  return {
      {GeometryKey("elastic_modulus", at(which, &R::elastic_modulus), positive(), "Young's modulus E",
                   unit("Pa"), required),
       GeometryKey("density", at(which, &R::density), positive(), "density rho", unit("kg/m^3"), required),
       GeometryKey("poisson_ratio", at(which, &R::poisson_ratio), poisson_rule(),
                   "Poisson's ratio nu; that of the base has no influence",
                   needed("required of the damper, unless `[system]` has interface_stiffness", is_needed)),
       GeometryKey("width", at(which, &R::width), positive(), "of the section, w", unit("m"), required),
       GeometryKey("height", at(which, &R::height), positive(),
                   "of the section, h, the direction in which transverse waves move", unit("m"), required)}};
}

/// Refuses sizes so extreme that the groups are beyond what a double holds.
void check(const TomlDocument& document, const Geometry& geometry, const SystemParameters& system) {
  const PhysicalScale scale(geometry, system);
  const double preload = geometry.preload_per_length > 0 ? system.preload : 1;
  for (const double value : {system.mass_ratio, system.frequency_ratio, system.interface_stiffness,
                             system.force, preload, scale.frequency(1), scale.energy(1)}) {
    if (!std::isnormal(value))
      document.fail(document.root().get("geometry"), "geometry",
                    "expected sizes and materials of rings, got extreme ones");
  }
}

}  // namespace

const KeyTable<GeometrySettings>& geometry_keys() {
  constexpr const char* shape = "a table { elastic_modulus, density, poisson_ratio, width, height }";
  static const KeyTable<GeometrySettings> base = ring(&Geometry::base);
  static const KeyTable<GeometrySettings> damper = ring(&Geometry::damper);
  const auto whole = [](auto& settings) -> auto& { return settings; };
  const auto is_needed = [](const GeometrySettings& settings, const TomlSection&) {
    return settings.needs_preload;
  };
  static const KeyTable<GeometrySettings> keys{
      {GeometryKey::table("base", whole, base, shape, "a table", "a ring of solid rectangular section",
                          required, unlisted),
       GeometryKey::table("damper", whole, damper, shape, "a table", "another one, pressed against it",
                          required, unlisted),
       GeometryKey("circumference", &GeometrySettings::circumference, positive(), "L of both, the mean one",
                   unit("m"), otherwise("required, or radius")),
       GeometryKey("radius", &GeometrySettings::radius, positive(), "the mean one, L/(2 pi)", unit("m"),
                   otherwise("required, or circumference")),
       GeometryKey("friction_coefficient", &GeometrySettings::friction_coefficient, positive(),
                   "mu of the contact", required),
       GeometryKey("preload_per_length", &GeometrySettings::preload_per_length, positive(),
                   "p_0 between the rings", unit("N/m"), needed("required, unless P varies", is_needed),
                   parameter("P")),
       GeometryKey("force_per_length", &GeometrySettings::force_per_length, positive(),
                   "f_0, amplitude of the travelling force on the base", unit("N/m"), required,
                   parameter("F"))}};
  return keys;
}

bool has_geometry(const TomlDocument& document) { return document.root().contains("geometry"); }

void read_geometry(const TomlDocument& document, const Replacements& replacements, const TomlSection& system,
                   FrictionSettings& settings, ProblemRequest& problem) {
  const TomlSection section(document, "geometry", &replacements);
  GeometrySettings geometry;
  const double given = settings.interface_stiffness;
  geometry.needs_shear = !system.has("interface_stiffness");
  geometry.needs_preload = settings.use->parameter != "P";
  geometry_keys().read(geometry, section);
  if (section.has("radius") == section.has("circumference"))
    section.fail(section.has("radius") ? "radius" : "circumference",
                 "expected either circumference or radius, the mean one");
  if (geometry.radius) geometry.circumference = two_pi * *geometry.radius;
  set_groups(geometry, settings);
  if (!geometry.needs_shear) settings.interface_stiffness = given;
  check(document, geometry, settings);
  problem.geometry = geometry;
  problem.physical.emplace(geometry, settings);
}

}  // namespace arcslip
