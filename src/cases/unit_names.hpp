#pragma once

// eta and P under names that say their SI units, as ranges of a system in such units may be given:
// frequency_Hz, and preload_N_per_m of rings, preload_N of a contact.

#include <array>
#include <optional>
#include <string>

#include "arcslip/assembly/physical_scale.hpp"
#include "keys/toml_reader.hpp"

namespace arcslip {

inline constexpr std::array preload_names = {"preload_N_per_m", "preload_N"};
inline constexpr const char* frequency_name = "frequency_Hz";
inline constexpr const char* speed_name = "speed";

/// "N/m" of PhysicalScale's "N_per_m", and "N" of "N".
std::string unit_in_words(const std::string& preload_unit);

/// "eta" or "P" of a name with a unit; any other as it is.
std::string without_unit(const std::string& name);

/// The parameter of a case that a name stands for: that without its unit or, for the speed beside an engine
/// order m, eta = m speed.
std::string parameter_named(const std::string& name, const TomlDocument& document);

/// Adds the names with units of those that are there.
void add_unit_names(std::vector<std::string>& names);

/// What one of the parameter that the key `key` names is in the unit of `name`; 1 of a name without unit.
/// Throws InputError at the key where the system is not given in SI units, or in others.
double size_of_unit(const std::string& name, const std::optional<PhysicalScale>& scale,
                    const TomlSection& section, const std::string& key);

/// The key of `section` that gives a frequency, "eta" or "frequency_Hz". Throws InputError where both are
/// there.
std::string frequency_key(const TomlSection& section);

}  // namespace arcslip
