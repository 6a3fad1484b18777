#include "cases/geometry_section.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "cases/system_section.hpp"

namespace arcslip {
namespace {

const std::vector<std::string> ring_keys = {"elastic_modulus", "density", "poisson_ratio", "width", "height"};
const std::vector<std::string> keys = {"base",
                                       "damper",
                                       "circumference",
                                       "radius",
                                       "friction_coefficient",
                                       "preload_per_length",
                                       "force_per_length"};

/// The keys of [system] that the section stands for.
constexpr const char* replaced_keys[] = {"mass_ratio",    "frequency_ratio", "slenderness",
                                         "poisson_ratio", "force",           "preload"};

class GeometrySection {
 public:
  GeometrySection(const TomlDocument& document, const Replacements& replacements)
      : document_(document), replacements_(replacements), section_(document, "geometry", &replacements) {}

  Geometry read(bool needs_shear, bool needs_preload) const {
    Geometry geometry;
    geometry.base = read_ring("base", false);
    geometry.damper = read_ring("damper", needs_shear);
    geometry.circumference = read_circumference();
    geometry.friction_coefficient = section_.number("friction_coefficient", positive());
    if (needs_preload || section_.has("preload_per_length"))
      geometry.preload_per_length = section_.number("preload_per_length", positive());
    geometry.force_per_length = section_.number("force_per_length", positive());
    return geometry;
  }

  /// Refuses sizes so extreme that the groups are beyond what a double holds.
  void check(const Geometry& geometry, const SystemParameters& system) const {
    const PhysicalScale scale(geometry, system);
    const double preload = geometry.preload_per_length > 0 ? system.preload : 1;
    for (const double value : {system.mass_ratio, system.frequency_ratio, system.interface_stiffness,
                               system.force, preload, scale.frequency(1), scale.energy(1)}) {
      if (!std::isnormal(value))
        document_.fail(section_.table(), "geometry",
                       "expected sizes and materials of rings, got extreme ones");
    }
  }

 private:
  RectangularRing read_ring(const std::string& which, bool needs_shear) const {
    section_.require(which, "a table { elastic_modulus, density, poisson_ratio, width, height }");
    const TomlSection section(document_, "geometry." + which, &replacements_);
    RectangularRing ring;
    ring.elastic_modulus = section.number("elastic_modulus", positive());
    ring.density = section.number("density", positive());
    if (needs_shear || section.has("poisson_ratio"))
      ring.poisson_ratio = section.number("poisson_ratio", poisson_rule());
    ring.width = section.number("width", positive());
    ring.height = section.number("height", positive());
    return ring;
  }

  double read_circumference() const {
    if (section_.has("radius") == section_.has("circumference"))
      section_.fail(section_.has("radius") ? "radius" : "circumference",
                    "expected either circumference or radius, the mean one");
    if (section_.has("circumference")) return section_.number("circumference", positive());
    return 2 * std::numbers::pi * section_.number("radius", positive());
  }

  const TomlDocument& document_;
  const Replacements& replacements_;
  TomlSection section_;
};

}  // namespace

void check_geometry_keys(const TomlDocument& document) {
  const TomlSection section(document, "geometry");
  section.allow_only(keys);
  for (const char* ring : {"base", "damper"}) {
    if (section.has(ring)) TomlSection(document, section.name(ring)).allow_only(ring_keys);
  }
}

bool has_geometry(const TomlDocument& document) { return document.root().contains("geometry"); }

std::vector<std::string> geometry_keys() {
  std::vector<std::string> names(keys.begin() + 2, keys.end());
  for (const char* ring : {"base", "damper"}) {
    for (const std::string& key : ring_keys) names.push_back(fmt::format("{}.{}", ring, key));
  }
  return names;
}

void read_geometry(const TomlDocument& document, const Replacements& replacements, const TomlSection& system,
                   const std::string& parameter, ProblemRequest& problem) {
  for (const char* key : replaced_keys) {
    if (system.has(key)) system.fail(key, "not beside [geometry], which gives it");
  }
  const GeometrySection section(document, replacements);
  const bool is_given = system.has("interface_stiffness");
  const Geometry geometry = section.read(!is_given, parameter != "P");
  set_groups(geometry, problem.system);
  if (is_given) problem.system.interface_stiffness = system.number("interface_stiffness", positive());
  section.check(geometry, problem.system);
  problem.geometry = geometry;
}

}  // namespace arcslip
