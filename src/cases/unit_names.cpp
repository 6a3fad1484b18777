#include "cases/unit_names.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace arcslip {

std::string unit_in_words(const std::string& preload_unit) { return preload_unit == "N" ? "N" : "N/m"; }

std::string without_unit(const std::string& name) {
  if (name == frequency_name) return "eta";
  const bool is_preload = std::find(preload_names.begin(), preload_names.end(), name) != preload_names.end();
  return is_preload ? "P" : name;
}

std::string parameter_named(const std::string& name, const TomlDocument& document) {
  return name == speed_name && document.root().at_path("system.engine_order") ? "eta" : without_unit(name);
}

void add_unit_names(std::vector<std::string>& names) {
  const auto has = [&](const char* name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  const bool has_preload = has("P");
  if (has("eta")) names.push_back(frequency_name);
  if (has_preload) names.insert(names.end(), preload_names.begin(), preload_names.end());
}

double size_of_unit(const std::string& name, const std::optional<PhysicalScale>& scale,
                    const TomlSection& section, const std::string& key) {
  const std::string parameter = without_unit(name);
  if (parameter == name) return 1;
  if (!scale)
    section.fail(
        key, fmt::format("{} is for systems in SI units, by [geometry] or units = \"SI\"; expected {}", name,
                         parameter));
  if (parameter == "eta") return scale->frequency(1);
  const std::string own = std::string("preload_") + scale->preload_unit();
  if (name != own) section.fail(key, fmt::format("expected {} of this system, got {}", own, name));
  return scale->preload(1);
}

std::string frequency_key(const TomlSection& section) {
  if (!section.has(frequency_name)) return "eta";
  if (section.has("eta")) section.fail(frequency_name, "expected this or eta, not both");
  return frequency_name;
}

}  // namespace arcslip
