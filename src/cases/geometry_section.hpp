#pragma once

// The section [geometry] of a case file: base and damper in SI units, in place of most of [system].

#include "cases/system_section.hpp"

namespace arcslip {

/// [geometry] as it is read.
struct GeometrySettings : Geometry {
  bool needs_shear = false;
  bool needs_preload = false;
  std::optional<double> radius = {};
};

const KeyTable<GeometrySettings>& geometry_keys();

/// Whether the case has the section.
bool has_geometry(const TomlDocument& document);

/// Reads the section and sets what `settings`, whose model is known, does not have from [system], the section
/// `system`. Throws InputError.
void read_geometry(const TomlDocument& document, const Replacements& replacements, const TomlSection& system,
                   FrictionSettings& settings, ProblemRequest& problem);

}  // namespace arcslip
