#include "cases/sector_part.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "cases/named_file.hpp"
#include "cases/output_weights.hpp"
#include "cases/ring_changes.hpp"

namespace arcslip {
namespace {

std::vector<Index> listed(const PartSettings& part, const TomlSection& section, std::string_view key) {
  return listed_dofs(section, key, part.sector.mass.rows());
}

void read_load(PartSettings& part, const TomlSection& section) {
  const Index size = part.sector.mass.rows();
  const char* expected = "a file of loads, or a table { dof = [...], value = [...] }";
  ComplexVector& load = part.sector.load;
  if (section.require("load", expected).is_string()) {
    load = parsed(section, "load", largest_list, &part.fingerprint,
                  [&](const std::string& text, const std::string& path) {
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

void read_weights(PartSettings& part, const TomlSection& section) {
  for (const WeightRow& row : read_weights(section, part.sector.mass.rows(), &part.fingerprint))
    add_combination(part, row);
}

void read_coordinates(PartSettings& part, const TomlSection& section) {
  part.places = parsed(section, "coordinates", largest_list, &part.fingerprint,
                       [&](const std::string& text, const std::string& path) {
                         return read_places(text, path, part.sector.mass.rows());
                       });
}

using PartKey = Key<PartSettings>;

PartKey matrix(const char* name, SparseMatrix FiniteSector::*member, const std::string& meaning,
               const auto&... term) {
  const auto read = [=](PartSettings& part, const TomlSection& section) {
    section.require(name, "a Matrix Market file");
    const auto& parse = member == &FiniteSector::gyroscopic ? read_gyroscopic : read_matrix_market;
    part.sector.*member = parsed(section, name, largest_matrix, &part.fingerprint, parse, check_banner);
  };
  return PartKey::special(name, "Matrix Market file", meaning, read, term...);
}

PartKey dofs(const char* name, std::vector<Index> FiniteSector::*member, const std::string& meaning,
             const auto&... term) {
  const auto read = [=](PartSettings& part, const TomlSection& section) {
    const char* expected = "a file of dofs, or an array of them";
    const toml::node& node = section.require(name, expected);
    if (!node.is_string() && !node.is_array()) section.mismatch(name, expected);
    part.sector.*member = node.is_array() ? listed(part, section, name)
                                          : parsed(section, name, largest_list, &part.fingerprint,
                                                   [&](const auto& text, const auto& path) {
                                                     return read_dofs(text, path, part.sector.mass.rows());
                                                   });
  };
  return PartKey::special(name, "file or list of dofs", meaning, read, term...);
}

/// A dof against ground or the other structure, or a pair of dofs against each other.
void read_contacts(PartSettings& part, const TomlSection& section) {
  const char* expected = "a file of dofs, or an array of dofs and of pairs [i, j] of them";
  const toml::node& node = section.require("contact", expected);
  FiniteSector& sector = part.sector;
  if (!node.is_array()) {
    if (!node.is_string()) section.mismatch("contact", expected);
    sector.contacts =
        parsed(section, "contact", largest_list, &part.fingerprint,
               [&](const auto& text, const auto& path) { return read_dofs(text, path, sector.mass.rows()); });
    return;
  }
  const toml::array& given = *node.as_array();
  if (std::none_of(given.begin(), given.end(), [](const toml::node& one) { return one.is_array(); })) {
    sector.contacts = listed(part, section, "contact");
    return;
  }
  const auto dof = [&](const toml::node* one) {
    const std::optional<double> number = one == nullptr ? std::nullopt : exact_number(*one);
    const Index size = sector.mass.rows();
    if (!number || !(*number >= 1 && *number <= static_cast<double>(size) && *number == std::floor(*number)))
      section.fail("contact", fmt::format("expected {}, which count from 1 to {}", expected, size));
    return static_cast<Index>(*number) - 1;
  };
  for (const toml::node& one : given) {
    const toml::array* pair = one.as_array();
    if (pair != nullptr && pair->size() != 2)
      section.fail("contact", fmt::format("expected pairs of two dofs, got {}", pair->size()));
    sector.contacts.push_back(dof(pair != nullptr ? pair->get(0) : &one));
    sector.against.push_back(pair != nullptr ? dof(pair->get(1)) : FiniteSector::ground);
  }
}

void check_contacts(const PartSettings& part, const TomlSection& section) {
  if (part.sector.contacts.empty()) section.fail("contact", "expected one dof or more, got none");
}

void check_kind(const PartSettings& part, const TomlSection& section) {
  if (part.path == SectorPath::full && part.damping_kind == DampingKind::modal)
    section.fail(
        "damping_kind",
        R"(expected "viscous" or "structural" with system.path = "full", for which "modal" has no matrix)");
}

bool is_viscous(const PartSettings& part, const TomlSection& /*section*/) {
  return part.damping_kind == DampingKind::viscous;
}

/// Turns C into a loss of the modes.
void diagonalise(PartSettings& part, const TomlSection& section) {
  FiniteSector& sector = part.sector;
  if (part.path != SectorPath::reduced || sector.damping.size() == 0) return;
  try {
    part.fixed = proportional_loss(sector.damping, sector.mass, sector.stiffness);
  } catch (const SectorError& error) {
    section.fail("damping", std::string(error.what()) + R"(; path = "full" in [system] takes any)");
  }
  sector.damping = SparseMatrix();
}

/// Whether a section has this key.
auto has(const char* name) {
  return [=](const PartSettings&, const TomlSection& section) { return section.has(name); };
}

KeyTable<PartSettings> keys_of_part(bool loaded) {
  using F = FiniteSector;
  const std::vector<PartKey> keys{
      matrix("mass", &F::mass, "M: real, symmetric, or general and so but for rounding", required),
      matrix("stiffness", &F::stiffness, "K", required),
      matrix("damping", &F::damping,
             "C = alpha M + beta K; any other, also a gyroscopic one, with `path = \"full\"` alone",
             otherwise("none")),
      matrix(
          "gyroscopic", &F::gyroscopic,
          "G, skew-symmetric, or jG as a complex Hermitian matrix: at a speed Omega, radians in the unit of "
          "time, C is C + Omega G",
          otherwise("none")),
      matrix("stiffness_speed2", &F::stiffness_speed2,
             "K_2: K is K + Omega^2 K_2, stress stiffness less centrifugal softening at Omega = 1",
             otherwise("none")),
      dofs("left", &F::left, "the boundary to the sector before; dofs count from 1, in a file one a line",
           needed("none, with `right`: no symmetry", has("right"))),
      dofs("right", &F::right, "that to the next sector, paired with `left` in order",
           needed("none, with `left`", has("left"))),
      dofs("interior", &F::interior, "the rest", otherwise("all others")),
      PartKey::special(
          "contact", "file or list of dofs, or of pairs [i, j]",
          "up to 12, not on the right; those of base and damper pair in order; [i, j] is between "
          "two dofs of one structure, whose y is y_i - y_j",
          read_contacts, required, then(check_contacts)),
      PartKey::choice("damping_kind", &PartSettings::damping_kind,
                      {{"viscous", DampingKind::viscous},
                       {"structural", DampingKind::structural},
                       {"modal", DampingKind::modal}},
                      "of the zeta in `damping`: C proportional to K; K (1 + 2j zeta); zeta for every mode",
                      "", then(check_kind)),
      PartKey("reference_frequency", &PartSettings::reference_frequency, positive(),
              "eta at which the loss is 2 zeta", required,
              only(R"(only beside damping_kind = "viscous")", is_viscous)),
      PartKey("mass_factor", &PartSettings::mass_factor, at_least(0),
              "alpha of a part alpha M of C; beside it or a C zeta adds to them and is 0 by default"),
      dofs("output", &F::outputs,
           "whose amplitudes follow in `branches.csv`: `Y_40` of the base, `U_40` of the damper",
           otherwise("none")),
      PartKey::special(
          "weights", "file or table",
          "outputs that are sums of dofs times weights, as stresses: a table `{ NAME = { dof, value } }` "
          "of lists, or a CSV file of rows `NAME, w_1, w_2, ...` with one weight for each dof; columns "
          "`Y_NAME`, `U_NAME`",
          read_weights, otherwise("none")),
      PartKey::special(
          "coordinates", "file",
          "where the dofs are, for `--shapes`: a line `dof x y z dx dy dz` for each, its place and "
          "the direction of its motion, z being the axis",
          read_coordinates, otherwise("none"))};
  if (!loaded) return keys;
  return {keys,
          {PartKey::special("load", "file or table",
                            "of the base, the force on the sector of phase 0: a file of lines `dof value "
                            "[imaginary part]`, or a table `{ dof, value, imaginary }` of lists",
                            read_load, required)}};
}

}  // namespace

const KeyTable<PartSettings>& part_keys(bool loaded) {
  static const KeyTable<PartSettings> base = keys_of_part(true);
  static const KeyTable<PartSettings> damper = keys_of_part(false);
  return loaded ? base : damper;
}

SectorPart read_part(const TomlDocument& document, const std::string& path, SectorPath response) {
  const TomlSection section(document, path);
  const bool loaded = path == "system.base";
  PartSettings part;
  part.path = response;
  part.fingerprint = 14695981039346656037U;
  part_keys(loaded).read(part, section);
  for (const WeightRow& row : changed_motions(document, loaded, part.sector.mass.rows()))
    add_combination(part, row);
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

}  // namespace arcslip
