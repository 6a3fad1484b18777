#include "cases/sector_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <new>
#include <tuple>

#include "arcslip/sectors/matrix_market.hpp"
#include "keys/input_file.hpp"

namespace arcslip {
namespace {

using nlohmann::ordered_json;

/// The folder of a case file, which the names of other files start from. One in a pipe has none.
std::string folder_of(const std::string& path) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  return folder == "/dev" || folder == "/dev/fd" || folder == "/proc/self/fd" ? "" : folder.string();
}

/// What the file that the key names holds: `parse` of its text and its path.
template <class Parse>
auto parsed(PartSettings& part, const TomlSection& section, std::string_view key, std::size_t largest,
            const Parse& parse,
            const std::function<void(std::string_view, const std::string&)>& begins = {}) {
  const std::string path = (std::filesystem::path(part.folder) / section.text(key, {})).string();
  try {
    const std::string text = read_text(path, largest, [&](std::string_view beginning) {
      if (begins) begins(beginning, path);
    });
    for (const char c : text) {  // FNV-1a
      part.fingerprint ^= static_cast<unsigned char>(c);
      part.fingerprint *= 1099511628211U;
    }
    return parse(text, path);
  } catch (const InputError& error) {
    section.fail(key, error.what());
  } catch (const MatrixTextError& error) {
    section.fail(key, error.what());
  } catch (const std::bad_alloc&) {
    section.fail(key, path + ": there is not enough memory for it");
  }
}

std::vector<Index> listed(const PartSettings& part, const TomlSection& section, std::string_view key) {
  const Index size = part.sector.mass.rows();
  const NumberRule rule{
      [=](double dof) { return dof >= 1 && dof <= static_cast<double>(size) && dof == std::floor(dof); },
      fmt::format(" that is a dof from 1 to {}", size)};
  std::vector<Index> dofs;
  for (const double dof : section.numbers(key, rule)) dofs.push_back(static_cast<Index>(dof) - 1);
  return dofs;
}

void read_load(PartSettings& part, const TomlSection& section) {
  const Index size = part.sector.mass.rows();
  const char* expected = "a file of loads, or a table { dof = [...], value = [...] }";
  ComplexVector& load = part.sector.load;
  if (section.require("load", expected).is_string()) {
    load = parsed(part, section, "load", largest_list, [&](const std::string& text, const std::string& path) {
      return arcslip::read_load(text, path, size);
    });
  } else {
    const TomlSection table = section.inside("load", expected);
    table.allow_only({"dof", "value", "imaginary"});
    table.require("dof", "an array of dofs");
    table.require("value", "an array of numbers");
    const std::vector<Index> dofs = listed(part, table, "dof");
    const std::vector<double> real = table.numbers("value", any_number());
    std::vector<double> imaginary(dofs.size());
    if (table.has("imaginary")) imaginary = table.numbers("imaginary", any_number());
    const auto check = [&](const char* key, std::size_t count) {
      if (count != dofs.size())
        table.fail(key, fmt::format("expected {} numbers, as many as dofs, got {}", dofs.size(), count));
    };
    check("value", real.size());
    check("imaginary", imaginary.size());
    load = ComplexVector::Zero(size);
    for (std::size_t i = 0; i < dofs.size(); ++i) load(dofs[i]) += Complex(real[i], imaginary[i]);
  }
  if (load.isZero(0)) section.fail("load", "expected a force that is not 0");
}

namespace part {

using S = PartSettings;
using K = Key<S>;

K matrix(const char* name, SparseMatrix FiniteSector::*member, const std::string& meaning,
         const auto&... term) {
  const auto read = [=](S& part, const TomlSection& section) {
    section.require(name, "a Matrix Market file");
    part.sector.*member = parsed(part, section, name, largest_matrix, read_matrix_market, check_banner);
  };
  return K::special(name, "Matrix Market file", meaning, read, term...);
}

K dofs(const char* name, std::vector<Index> FiniteSector::*member, const std::string& meaning,
       const auto&... term) {
  const auto read = [=](S& part, const TomlSection& section) {
    const char* expected = "a file of dofs, or an array of them";
    const toml::node& node = section.require(name, expected);
    if (!node.is_string() && !node.is_array()) section.mismatch(name, expected);
    part.sector.*member =
        node.is_array() ? listed(part, section, name)
                        : parsed(part, section, name, largest_list, [&](const auto& text, const auto& path) {
                            return read_dofs(text, path, part.sector.mass.rows());
                          });
  };
  return K::special(name, "file or list of dofs", meaning, read, term...);
}

void check_contacts(const S& part, const TomlSection& section) {
  const std::size_t count = part.sector.contacts.size();
  if (count == 0 || count >= most_contacts)
    section.fail("contact", fmt::format("expected from 1 to {} dofs, got {}", most_contacts - 1, count));
}

void check_kind(const S& part, const TomlSection& section) {
  if (part.path == SectorPath::full && part.damping_kind == DampingKind::modal)
    section.fail(
        "damping_kind",
        R"(expected "viscous" or "structural" with system.path = "full", for which "modal" has no matrix)");
}

bool is_viscous(const S& part, const TomlSection& /*section*/) {
  return part.damping_kind == DampingKind::viscous;
}

/// Turns C into a loss of the modes.
void diagonalise(S& part, const TomlSection& section) {
  FiniteSector& sector = part.sector;
  if (part.path != SectorPath::reduced || sector.damping.size() == 0) return;
  try {
    part.fixed = proportional_loss(sector.damping, sector.mass, sector.stiffness);
  } catch (const SectorError& error) {
    section.fail("damping", std::string(error.what()) + R"(; path = "full" in [system] takes any)");
  }
  sector.damping = SparseMatrix();
}

KeyTable<S> keys(bool loaded) {
  using F = FiniteSector;
  const std::vector<K> keys{
      matrix("mass", &F::mass, "M: real, coordinate, symmetric, or general and so but for rounding",
             required),
      matrix("stiffness", &F::stiffness, "K", required),
      matrix("damping", &F::damping,
             "C = alpha M + beta K; any other symmetric one with `path = \"full\"` alone", otherwise("none")),
      dofs("left", &F::left, "the boundary to the sector before; dofs count from 1, in a file one a line",
           required),
      dofs("right", &F::right, "that to the next sector, paired with `left` in order", required),
      dofs("interior", &F::interior, "the rest", otherwise("all others")),
      dofs("contact", &F::contacts, "up to 12, not on the right; those of base and damper pair in order",
           required, then(check_contacts)),
      K::choice("damping_kind", &S::damping_kind,
                {{"viscous", DampingKind::viscous},
                 {"structural", DampingKind::structural},
                 {"modal", DampingKind::modal}},
                "of the zeta in `damping`: C proportional to K; K (1 + 2j zeta); zeta for every mode", "",
                then(check_kind)),
      K("reference_frequency", &S::reference_frequency, positive(), "eta at which the loss is 2 zeta",
        required, only(R"(only beside damping_kind = "viscous")", is_viscous)),
      K("mass_factor", &S::mass_factor, at_least(0),
        "alpha of a part alpha M of C; beside it or a C zeta adds to them and is 0 by default"),
      dofs("output", &F::outputs,
           "whose amplitudes follow in `branches.csv`: `Y_40` of the base, `U_40` of the damper",
           otherwise("none"))};
  if (!loaded) return keys;
  return {keys,
          {K::special("load", "file or table",
                      "of the base, the force on the sector of phase 0: a file of lines `dof value "
                      "[imaginary part]`, or a table `{ dof, value, imaginary }` of lists",
                      read_load, required)}};
}

SectorPart read(const TomlDocument& document, const std::string& path, SectorPath response) {
  const TomlSection section(document, path);
  const bool loaded = path == "system.base";
  S part;
  part.path = response;
  part.folder = folder_of(document.path());
  part.fingerprint = 14695981039346656037U;
  part_keys(loaded).read(part, section);
  if (!loaded) part.sector.load = ComplexVector::Zero(part.sector.mass.rows());
  try {
    part.sector = checked(std::move(part.sector));
  } catch (const SectorError& error) {
    document.fail(section.table(), path, error.what());
  }
  diagonalise(part, section);
  part.fixed.mass += part.mass_factor / two_pi;
  return std::move(static_cast<SectorPart&>(part));
}

}  // namespace part

using S = FrictionSettings;
using K = Key<S>;

void read_reduction_window(S& settings, const TomlSection& section) {
  std::tie(settings.eta_low, settings.eta_high) =
      section.rising("reduction_window",
                     "two numbers, 0 < low < high: the eta for which the modes of the sectors are found");
}

/// Reads a number for all contacts, or a list with one for each.
K::Reader for_contacts(const std::string& name, std::vector<double> S::*member) {
  return [=](S& settings, const TomlSection& section) {
    const std::size_t count = settings.sectors->base().sector.contacts.size();
    std::vector<double>& values = settings.*member;
    const toml::table* table = section.table();
    if (table == nullptr || !(*table)[name].is_array()) {
      values.assign(count, section.number(name, positive()));
      return;
    }
    values = section.numbers(name, positive());
    if (values.size() != count)
      section.fail(name, fmt::format("expected a number, or {} of them as there are contacts, got {}", count,
                                     values.size()));
  };
}

NumberRule wave_rule(const S& settings) {
  const Index most = settings.elements / 2;
  return within(0, static_cast<double>(most), fmt::format(" >= 0 and <= sectors/2 = {}", most));
}

void check_path(const S& settings, const TomlSection& section) {
  const bool is_free = settings.use != nullptr && settings.use->is_free;
  if (settings.path == SectorPath::full && is_free)
    section.fail(
        "path",
        R"(expected "reduced" for nonlinear modes and limit cycles, which begin from modes, got "full")");
}

/// What is held to the modes and contacts that there are.
void check_use(const TomlSection& section, const S& settings) {
  try {
    settings.sectors->check({settings.wave_number, settings.elements});
  } catch (const SectorError& error) {
    section.fail("wave_number", fmt::format("at {}: {}", settings.wave_number, error.what()));
  }
}

}  // namespace

const KeyTable<PartSettings>& part_keys(bool loaded) {
  static const KeyTable<PartSettings> base = part::keys(true);
  static const KeyTable<PartSettings> damper = part::keys(false);
  return loaded ? base : damper;
}

const KeyTable<FrictionSettings>& sector_keys() {
  const auto of = [](const SectorPart* part) -> ordered_json {
    if (part == nullptr) return nullptr;
    return {{"damping_kind", to_string(part->damping_kind)},
            {"fingerprint", fmt::format("{:016x}", part->fingerprint)}};
  };
  const auto base = [=](const S& settings) {
    return of(settings.sectors ? &settings.sectors->base() : nullptr);
  };
  const auto damper = [=](const S& settings) {
    return of(settings.sectors ? settings.sectors->damper() : nullptr);
  };
  const auto window = [](const S& settings) { return ordered_json{settings.eta_low, settings.eta_high}; };
  const auto has_no_range = [](const S& settings, const TomlSection&) { return !(settings.eta_low > 0); };
  static const KeyTable<S> keys{
      {K::special("model", "\"sector\"", "any structure of N equal sectors", {}, otherwise("required"),
                  unlisted),
       K("sectors", &S::elements, within(1, 1e9, " >= 1 and <= 1e9"), "N", required),
       K("wave_number", &S::wave_number, {" >= 0 and <= sectors/2", wave_rule}, "n, nodal diameters",
         required),
       K::special("contact_stiffness", "number or list",
                  "k of the contact of a sector; of several contacts that of all, or a list",
                  for_contacts("contact_stiffness", &S::contact_stiffness), required, parameter("K_FD"))},
      shared_keys(),
      {K::special(
           "limit_per_preload", "number or list", "L: a contact slips where its force is L P, S = L P/k",
           for_contacts("limit_per_preload", &S::limit_per_preload), resolved([](const S&) { return 1.0; })),
       K("force", &S::force, positive(), "factor of the load", parameter("F")), preload_growth_key(),
       K::choice("path", &S::path, {{"reduced", SectorPath::reduced}, {"full", SectorPath::full}},
                 "the response by modes, or by a sparse LU factorisation at each eta", "", unlisted,
                 then(check_path)),
       K("reduction_tolerance", &S::reduction_tolerance, within(1e-14, 1e-2, " >= 1e-14 and <= 0.01"),
         "relative change of the response at which modes are no longer added", unlisted),
       K::special("reduction_window", "two numbers",
                  "the eta for which the modes serve or, with `path = \"full\"`, are found as resonances",
                  read_reduction_window,
                  needed("the range of `[branch]` or `[study]`; required of limit cycles", has_no_range),
                  resolved(window)),
       K::special("base", "table", "the base's sector", {}, otherwise("required"), unlisted, resolved(base)),
       K::special("damper", "table", "the damper's", {}, otherwise("none: the contact is to ground"),
                  unlisted, resolved(damper))}};
  return keys;
}

bool is_sector(const TomlDocument& document) {
  const toml::table* table = TomlSection(document, "system").table();
  return table != nullptr && (*table)["model"].value<std::string>() == "sector";
}

std::shared_ptr<const SectorPair> read_sectors(const TomlDocument& document) {
  if (!is_sector(document)) return nullptr;
  const TomlSection section(document, "system");
  section.allow_only(sector_keys().names());
  section.require("base", "a table with the matrices of the base's sector");
  S settings;
  for (const char* key : {"reduction_tolerance", "path"}) sector_keys().read(key, settings, section);
  std::optional<SectorPart> damper;
  if (section.has("damper")) damper = part::read(document, "system.damper", settings.path);
  SectorPart base = part::read(document, "system.base", settings.path);
  const std::size_t contacts = base.sector.contacts.size();
  if (damper && damper->sector.contacts.size() != contacts)
    TomlSection(document, "system.damper")
        .fail("contact", fmt::format("expected {} dofs, as many as of the base, got {}", contacts,
                                     damper->sector.contacts.size()));
  return std::make_shared<const SectorPair>(std::move(base), std::move(damper), settings.reduction_tolerance,
                                            settings.path);
}

void read_sector_system(const TomlSection& section, S& settings) {
  const SystemUse& use = *settings.use;
  settings.model = StructureModel::sector;
  settings.sectors = use.sectors;
  settings.eta_low = use.eta_low;
  settings.eta_high = use.eta_high;
  settings.fixed_damper = settings.sectors->damper() == nullptr;
  const std::size_t count = settings.sectors->base().sector.contacts.size();
  settings.limit_per_preload.assign(count, 1);
  if (settings.sectors->base().is_damped()) settings.base_damping = 0;
  if (!settings.fixed_damper && settings.sectors->damper()->is_damped()) settings.damper_damping = 0;
  sector_keys().read(settings, section);
  const std::vector<double>& k = settings.contact_stiffness;
  settings.interface_stiffness = k.front() * static_cast<double>(settings.elements);
  for (std::size_t i = 0; i < count; ++i)
    settings.contacts.push_back({k[i], settings.limit_per_preload[i] / k[i]});
  check_use(section, settings);
}

}  // namespace arcslip
