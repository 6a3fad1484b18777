#include "cases/sector_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <new>
#include <numbers>

#include "arcslip/sectors/matrix_market.hpp"
#include "keys/input_file.hpp"

namespace arcslip {
namespace {

using nlohmann::ordered_json;

constexpr double default_tolerance = 1e-10;
constexpr double default_limit = 1;  // per preload

/// The folder of a case file, which the names of other files start from. One in a pipe has none.
std::filesystem::path folder_of(const std::string& path) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  return folder == "/dev" || folder == "/dev/fd" || folder == "/proc/self/fd" ? "" : folder;
}

/// [system.base] or [system.damper].
class PartSection {
 public:
  PartSection(const TomlDocument& document, const std::string& path, bool loaded, SectorPath response)
      : document_(document),
        path_(path),
        section_(document, path),
        folder_(folder_of(document.path())),
        loaded_(loaded),
        response_(response) {
    std::vector<std::string> keys = {
        "mass",         "stiffness",           "damping",    "left", "right", "interior", "contact",
        "damping_kind", "reference_frequency", "mass_factor"};
    keys.emplace_back("output");
    if (loaded) keys.emplace_back("load");
    section_.allow_only(keys);
  }

  SectorPart read() {
    SectorPart part;
    FiniteSector& sector = part.sector;
    sector.mass = matrix("mass");
    size_ = sector.mass.rows();
    sector.stiffness = matrix("stiffness");
    if (section_.has("damping")) sector.damping = matrix("damping");
    sector.left = dofs("left");
    sector.right = dofs("right");
    if (section_.has("interior")) sector.interior = dofs("interior");
    sector.contacts = dofs("contact");
    if (sector.contacts.empty() || std::ssize(sector.contacts) >= most_contacts)
      section_.fail("contact", fmt::format("expected from 1 to {} dofs, got {}", most_contacts - 1,
                                           sector.contacts.size()));
    if (section_.has("output")) sector.outputs = dofs("output");
    sector.load = loaded_ ? load() : ComplexVector::Zero(size_);
    if (loaded_ && sector.load.isZero(0)) section_.fail("load", "expected a force that is not 0");
    try {
      sector = checked(std::move(sector));
    } catch (const SectorError& error) {
      document_.fail(section_.table(), path_, error.what());
    }
    if (response_ == SectorPath::reduced) diagonalise(part);
    read_damping(part);
    part.fingerprint = fingerprint_;
    return part;
  }

 private:
  /// Turns C into a loss of the modes.
  void diagonalise(SectorPart& part) const {
    FiniteSector& sector = part.sector;
    if (sector.damping.size() == 0) return;
    try {
      part.fixed = proportional_loss(sector.damping, sector.mass, sector.stiffness);
    } catch (const SectorError& error) {
      section_.fail("damping", std::string(error.what()) + R"(; path = "full" in [system] takes any)");
    }
    sector.damping = SparseMatrix();
  }

  void read_damping(SectorPart& part) const {
    if (section_.has("damping_kind")) {
      const std::string kind = section_.text("damping_kind", {"viscous", "structural", "modal"});
      part.damping_kind = kind == "viscous" ? DampingKind::viscous
                          : kind == "modal" ? DampingKind::modal
                                            : DampingKind::structural;
    }
    if (response_ == SectorPath::full && part.damping_kind == DampingKind::modal)
      section_.fail(
          "damping_kind",
          R"(expected "viscous" or "structural" with system.path = "full", for which "modal" has no matrix)");
    if (part.damping_kind == DampingKind::viscous) {
      part.reference_frequency = section_.number("reference_frequency", positive());
    } else if (section_.has("reference_frequency")) {
      section_.fail("reference_frequency", R"(only beside damping_kind = "viscous")");
    }
    const NumberRule not_negative{[](double x) { return x >= 0; }, " >= 0"};
    part.fixed.mass += section_.number("mass_factor", not_negative, 0) / (2 * std::numbers::pi);
  }

  void add_to_fingerprint(const std::string& text) {
    for (const char c : text) {  // FNV-1a
      fingerprint_ ^= static_cast<unsigned char>(c);
      fingerprint_ *= 1099511628211U;
    }
  }

  /// What the file that the key names holds: `parse` of its text and its path.
  template <class Parse>
  auto parsed(std::string_view key, std::size_t largest, const Parse& parse,
              const std::function<void(std::string_view, const std::string&)>& begins = {}) {
    const std::string path = (folder_ / section_.text(key, {})).string();
    try {
      const std::string text = read_text(path, largest, [&](std::string_view beginning) {
        if (begins) begins(beginning, path);
      });
      add_to_fingerprint(text);
      return parse(text, path);
    } catch (const InputError& error) {
      section_.fail(key, error.what());
    } catch (const MatrixTextError& error) {
      section_.fail(key, error.what());
    } catch (const std::bad_alloc&) {
      section_.fail(key, path + ": there is not enough memory for it");
    }
  }

  SparseMatrix matrix(std::string_view key) {
    section_.require(key, "a Matrix Market file");
    return parsed(key, largest_matrix, read_matrix_market, check_banner);
  }

  std::vector<Index> dofs(std::string_view key) {
    const char* expected = "a file of dofs, or an array of them";
    const toml::node& node = section_.require(key, expected);
    if (node.is_string()) {
      return parsed(key, largest_list, [&](const std::string& text, const std::string& path) {
        return read_dofs(text, path, size_);
      });
    }
    if (!node.is_array()) section_.mismatch(key, expected);
    return listed(section_, key);
  }

  std::vector<Index> listed(const TomlSection& section, std::string_view key) const {
    const NumberRule rule{
        [&](double dof) { return dof >= 1 && dof <= static_cast<double>(size_) && dof == std::floor(dof); },
        fmt::format(" that is a dof from 1 to {}", size_)};
    std::vector<Index> dofs;
    for (const double dof : section.numbers(key, rule)) dofs.push_back(static_cast<Index>(dof) - 1);
    return dofs;
  }

  ComplexVector load() {
    const char* expected = "a file of loads, or a table { dof = [...], value = [...] }";
    const toml::node& node = section_.require("load", expected);
    if (node.is_string()) {
      return parsed("load", largest_list, [&](const std::string& text, const std::string& path) {
        return read_load(text, path, size_);
      });
    }
    if (!node.is_table()) section_.mismatch("load", expected);
    const TomlSection table(document_, section_.name("load"));
    table.allow_only({"dof", "value", "imaginary"});
    table.require("dof", "an array of dofs");
    table.require("value", "an array of numbers");
    const std::vector<Index> dofs = listed(table, "dof");
    const std::vector<double> real = table.numbers("value", any_number());
    const std::vector<double> imaginary = table.numbers("imaginary", any_number());
    const auto check = [&](const char* key, std::size_t size) {
      if (size != dofs.size())
        table.fail(key, fmt::format("expected {} numbers, as many as dofs, got {}", dofs.size(), size));
    };
    check("value", real.size());
    if (table.has("imaginary")) check("imaginary", imaginary.size());
    ComplexVector load = ComplexVector::Zero(size_);
    for (std::size_t i = 0; i < dofs.size(); ++i)
      load(dofs[i]) += Complex(real[i], imaginary.empty() ? 0 : imaginary[i]);
    return load;
  }

  const TomlDocument& document_;
  std::string path_;
  TomlSection section_;
  std::filesystem::path folder_;
  bool loaded_;
  SectorPath response_;
  Index size_ = 0;
  std::uint64_t fingerprint_ = 14695981039346656037U;
};

bool has_damper(const TomlDocument& document) {
  return TomlSection(document, "system.damper").table() != nullptr;
}

void read_window(const TomlSection& section, const SystemUse& use, SystemParameters& system) {
  system.eta_low = use.eta_low;
  system.eta_high = use.eta_high;
  const char* expected = "two numbers, 0 < low < high: the eta for which the modes of the sectors are found";
  if (!(use.eta_low > 0)) section.require("reduction_window", expected);
  if (!section.has("reduction_window")) return;
  const std::vector<double> window = section.numbers("reduction_window", positive());
  if (window.size() != 2 || !(window[0] < window[1])) section.mismatch("reduction_window", expected);
  system.eta_low = window[0];
  system.eta_high = window[1];
}

/// A number for all contacts, or a list with one for each.
std::vector<double> for_contacts(const TomlSection& section, std::string_view key, std::size_t count,
                                 std::optional<double> standard) {
  const toml::table* table = section.table();
  if (table == nullptr || !(*table)[key].is_array())
    return std::vector<double>(
        count, standard ? section.number(key, positive(), *standard) : section.number(key, positive()));
  const std::vector<double> values = section.numbers(key, positive());
  if (values.size() != count)
    section.fail(key, fmt::format("expected a number, or {} of them as there are contacts, got {}", count,
                                  values.size()));
  return values;
}

void read_contacts(const TomlDocument& document, const TomlSection& section, const SystemUse& use,
                   SystemParameters& system) {
  const std::size_t count = use.sectors->base().sector.contacts.size();
  if (count > 1 && !use.balanced)
    TomlSection(document, "system.base")
        .fail("contact",
              fmt::format("expected one dof for a study, limit cycles and one-way responses, got {}", count));
  const std::vector<double> k = for_contacts(section, "contact_stiffness", count, {});
  const std::vector<double> limit = for_contacts(section, "limit_per_preload", count, default_limit);
  system.interface_stiffness = k.front() * static_cast<double>(system.elements);
  for (std::size_t i = 0; i < count; ++i) system.contacts.push_back({k[i], limit[i] / k[i]});
}

}  // namespace

bool is_sector(const TomlDocument& document) {
  const toml::table* table = TomlSection(document, "system").table();
  return table != nullptr && (*table)["model"].value<std::string>() == "sector";
}

std::vector<std::string> sector_keys() {
  return {"model",
          "wave_number",
          "sectors",
          "contact_stiffness",
          "limit_per_preload",
          "force",
          "preload",
          "preload_growth",
          "damping",
          "reduction_tolerance",
          "reduction_window",
          "base",
          "damper",
          "harmonics",
          "harmonics_tolerance",
          "path"};
}

std::shared_ptr<const SectorPair> read_sectors(const TomlDocument& document) {
  if (!is_sector(document)) return nullptr;
  const TomlSection section(document, "system");
  section.require("base", "a table with the matrices of the base's sector");
  const NumberRule rule{[](double x) { return x >= 1e-14 && x <= 1e-2; }, " >= 1e-14 and <= 0.01"};
  const double tolerance = section.number("reduction_tolerance", rule, default_tolerance);
  const SectorPath path = section.has("path") && section.text("path", {"reduced", "full"}) == "full"
                              ? SectorPath::full
                              : SectorPath::reduced;
  std::optional<SectorPart> damper;
  if (section.has("damper")) damper = PartSection(document, "system.damper", false, path).read();
  SectorPart base = PartSection(document, "system.base", true, path).read();
  const std::size_t contacts = base.sector.contacts.size();
  if (damper && damper->sector.contacts.size() != contacts)
    TomlSection(document, "system.damper")
        .fail("contact", fmt::format("expected {} dofs, as many as of the base, got {}", contacts,
                                     damper->sector.contacts.size()));
  return std::make_shared<const SectorPair>(std::move(base), std::move(damper), tolerance, path);
}

void read_sector_system(const TomlDocument& document, const TomlSection& section, const SystemUse& use,
                        SystemParameters& system) {
  constexpr Index most = 1'000'000'000;
  system.model = StructureModel::sector;
  system.sectors = use.sectors;
  system.elements = section.integer("sectors", 1, most, [] { return "an integer >= 1 and <= 1e9"; });
  system.wave_number = section.integer("wave_number", 0, system.elements / 2, [&] {
    return fmt::format("an integer >= 0 and <= sectors/2 = {}", system.elements / 2);
  });
  const bool forced = use.balanced && use.parameter != "R";
  if (system.sectors->path() == SectorPath::full && !forced)
    section.fail(
        "path",
        R"(expected "reduced" for a study, nonlinear modes, limit cycles and one-way responses, got "full")");
  read_contacts(document, section, use, system);
  system.force = section.number("force", positive(), 1);
  if (use.parameter != "P" || section.has("preload")) system.preload = section.number("preload", positive());
  system.fixed_damper = !has_damper(document);
  read_window(section, use, system);
  try {
    system.sectors->check({system.wave_number, system.elements});
  } catch (const SectorError& error) {
    section.fail("wave_number", fmt::format("at {}: {}", system.wave_number, error.what()));
  }
}

void resolve_sectors(const SystemParameters& system, ordered_json& section) {
  const auto set = [](ordered_json& table, const char* key, const ordered_json& value) {
    if (!table.contains(key)) table[key] = value;
  };
  set(section, "limit_per_preload", default_limit);
  set(section, "force", system.force);
  set(section, "preload_growth", system.preload_growth);
  set(section, "path", to_string(system.sectors->path()));
  set(section, "reduction_tolerance", system.sectors->tolerance());
  set(section, "reduction_window", {system.eta_low, system.eta_high});
  const auto add = [&](const char* name, const SectorPart& part) {
    ordered_json& table = section[name];
    set(table, "damping_kind", to_string(part.damping_kind));
    table["fingerprint"] = fmt::format("{:016x}", part.fingerprint);
  };
  add("base", system.sectors->base());
  if (system.sectors->damper() != nullptr) add("damper", *system.sectors->damper());
}

}  // namespace arcslip
