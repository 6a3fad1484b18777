#include "cases/ring_changes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "arcslip/assembly/sector_pair.hpp"
#include "arcslip/structure/chain_elements.hpp"
#include "cases/ring_numbers.hpp"

namespace arcslip {
namespace {

using ChangeKey = Key<RingChangeSettings>;

Choices<bool> changed_parts() { return {{"base", true}, {"damper", false}}; }

ChangeKey::Rule changed_dof_rule() {
  return {" that is a dof of the sector", [](const RingChangeSettings& settings) {
            const auto most = static_cast<double>(settings.size);
            return NumberRule{[=](double dof) { return dof >= 1 && dof <= most && dof == std::floor(dof); },
                              fmt::format(" that is a dof from 1 to {}", settings.size)};
          }};
}

/// Which are the tables of one kind.
std::vector<TomlSection> changing_tables(const TomlDocument& document, const std::string& name) {
  const TomlSection ring(document, "ring");
  std::vector<TomlSection> all;
  const toml::node* node = ring.table() == nullptr ? nullptr : ring.table()->get(name);
  if (node == nullptr) return all;
  if (!node->is_array_of_tables()) ring.mismatch(name, fmt::format("tables [[ring.{}]]", name));
  for (std::size_t i = 0; i < node->as_array()->size(); ++i)
    all.emplace_back(document, *node->as_array()->get(i)->as_table(), fmt::format("ring.{}[{}]", name, i));
  return all;
}

bool is_mistuning(const TomlSection& section) { return section.name("").starts_with("ring.mistuning"); }

constexpr auto check_changed_dofs = [](const RingChangeSettings& settings, const TomlSection& section) {
  const std::size_t count = settings.dofs.size();
  if (!is_mistuning(section)) {
    if (count != 2 && (count == 0 || count % 2 != 0 || !section.has("weights")))
      section.fail("dofs",
                   fmt::format("expected two dofs, one of the sector behind which the link is and one of the "
                               "next, or beside `weights` as many of each, got {}",
                               count));
    return;
  }
  if (count < 1 || count > 2)
    section.fail("dofs", fmt::format("expected one dof, or two with a spring between them, got {}", count));
  if (count == 2 && settings.dofs[0] == settings.dofs[1])
    section.fail("dofs", "expected two dofs that differ");
};

constexpr auto check_link_weights = [](const RingChangeSettings& settings, const TomlSection& section) {
  if (settings.weights.size() != settings.dofs.size())
    section.fail("weights", fmt::format("expected {} numbers, one for each of `dofs`, got {}",
                                        settings.dofs.size(), settings.weights.size()));
  const auto half = settings.weights.begin() + std::ssize(settings.weights) / 2;
  const auto is_zero = [](double weight) { return weight == 0; };
  if (std::all_of(settings.weights.begin(), half, is_zero) ||
      std::all_of(half, settings.weights.end(), is_zero))
    section.fail("weights", "expected numbers of both sectors that are not 0");
};

/// Reads one but for its dofs alone.
RingChangeSettings read_change(const TomlSection& section, RingChangeSettings settings) {
  const bool mistuned = is_mistuning(section);
  (mistuned ? mistuning_keys() : cut_keys()).read(settings, section);
  if (!mistuned) return settings;
  if (settings.dofs.empty() && !settings.has_elements)
    section.require("dofs", "one dof, or two with a spring between them");
  if (settings.dofs.empty()) return settings;
  if (settings.stiffness == 0 && settings.mass == 0)
    section.require("stiffness", "a number > 0 that the factors scale, or `mass`");
  if (settings.mass != 0 && settings.dofs.size() != 1)
    section.fail("mass", "expected one dof beside it, on which it is");
  return settings;
}

WeightRow motion_row(std::vector<Index> dofs, std::vector<double> weights) {
  return {"", std::move(dofs), std::move(weights)};
}

Index dof_of(const RingChangeSettings& settings, std::size_t i) {
  return static_cast<Index>(settings.dofs[i]) - 1;
}

/// Motions of a sector that a table is about.
std::vector<WeightRow> motions_of(const RingChangeSettings& settings, bool mistuned) {
  if (settings.dofs.empty()) return {};
  if (!mistuned) {  // what both ends stretch the link by
    std::vector<WeightRow> ends(2, motion_row({}, {}));
    const std::size_t count = settings.dofs.size();
    for (std::size_t i = 0; i < count; ++i) {
      WeightRow& end = ends[2 * i / count];
      end.dofs.push_back(dof_of(settings, i));
      end.weights.push_back(settings.weights.empty() ? (i == 0 ? -1 : 1) : settings.weights[i]);
    }
    return ends;
  }
  if (settings.dofs.size() == 1) return {motion_row({dof_of(settings, 0)}, {1})};
  return {motion_row({dof_of(settings, 0), dof_of(settings, 1)}, {1, -1})};
}

/// Those of a mistuning of springs and masses.
void add_mistuning(const RingChangeSettings& settings, Index port, std::vector<RingChange>& changes) {
  for (Index i = 0; i < settings.sectors; ++i) {
    const double more = settings.factors[static_cast<std::size_t>(i)] - 1;
    if (more == 0) continue;
    RingChange change{settings.on_base, {{{i, port, 1}}}, Matrix::Constant(1, 1, more * settings.stiffness)};
    if (settings.mass != 0) change.mass = Matrix::Constant(1, 1, more * settings.mass);
    changes.push_back(std::move(change));
  }
}

void add_cut(const RingChangeSettings& settings, Index port, std::vector<RingChange>& changes) {
  for (const Index i : settings.after) {
    const Index next = (i + 1) % settings.sectors;
    changes.push_back({settings.on_base,
                       {{{i, port, 1}, {next, port + 1, 1}}},
                       Matrix::Constant(1, 1, -settings.stiffness)});
  }
}

/// The element between a node and the next one of rods and beams, as a factor on it changes; whole with its
/// mass where it is missing.
RingChange element_change(const SystemParameters& system, bool on_base, Index node, double more, bool whole) {
  const auto make = system.model == StructureModel::rods ? rod_element : beam_element;
  const ChainElement element = on_base ? make(system.mass_ratio, system.stiffness_ratio(), 1, system.elements)
                                       : make(1, 1, 1, system.elements);
  const Index dofs = element.mass.rows() / 2;
  RingChange change{on_base, {}, more * element.stiffness.cast<double>()};
  if (whole) change.mass = more * element.mass.cast<double>();
  for (Index k = 0; k < 2 * dofs; ++k)
    change.of.push_back({{(node + k / dofs) % system.elements, k % dofs, 1}});
  return change;
}

/// Of rods and beams, whose ports are the dofs of their nodes.
void read_element_changes(const TomlDocument& document, const SystemParameters& system,
                          const RingChangeSettings& start, RingMake& ring) {
  const auto port = [](const RingChangeSettings& settings) { return dof_of(settings, 0); };
  for (const TomlSection& section : changing_tables(document, "mistuning")) {
    const RingChangeSettings settings = read_change(section, start);
    if (settings.dofs.size() > 1) section.fail("dofs", "expected one dof of a node");
    if (!settings.dofs.empty()) add_mistuning(settings, port(settings), ring.changes);
    for (Index i = 0; settings.dofs.empty() && i < start.sectors; ++i) {
      const double more = settings.factors[static_cast<std::size_t>(i)] - 1;
      if (more != 0) ring.changes.push_back(element_change(system, settings.on_base, i, more, false));
    }
  }
  if (const std::vector<TomlSection> cuts = changing_tables(document, "cut"); !cuts.empty())
    cuts.front().fail("part", "not of rods and beams, whose damper is cut by `split`");
  const TomlSection section(document, "ring");
  const std::vector<Index> split = listed_sectors(section, "split", ring.sectors);
  for (const Index i : split) {
    const Index next = (i + 1) % ring.sectors;
    if (std::count(split.begin(), split.end(), next) > 0)
      section.fail(
          "split",
          fmt::format("expected no neighbours, got {} and {}: of the damper nothing would be left at "
                      "node {}",
                      i + 1, next + 1, next + 1));
    ring.changes.push_back(element_change(system, false, i, -1, true));
  }
  for (const bool on_base : {true, false}) {
    const bool is_changed = std::any_of(ring.changes.begin(), ring.changes.end(),
                                        [=](const RingChange& change) { return change.on_base == on_base; });
    if (!is_changed) continue;
    (on_base ? ring.base_ports : ring.damper_ports) = start.size;
    for (Index k = 0; k < start.size; ++k)
      ring.wanted.push_back({fmt::format("#{}", k + 1), on_base, Vector::Unit(2 * start.size, k)});
  }
}

/// Refuses masses on dofs that Coriolis' forces act on, since those of a further mass are not known.
void check_turning_mass(const TomlSection& section, const RingChangeSettings& settings,
                        const SystemParameters& system) {
  const auto* pair = dynamic_cast<const SectorPair*>(system.structures.get());
  if (settings.mass == 0 || pair == nullptr || !feels_rotation(system)) return;
  const FiniteSector& sector = (settings.on_base ? pair->base() : *pair->damper()).sector;
  if (sector.gyroscopic.size() == 0) return;
  std::vector<Index> dofs{dof_of(settings, 0)};
  for (std::size_t i = 0; i < sector.left.size(); ++i) {
    if (sector.left[i] == dofs[0]) dofs.push_back(sector.right[i]);
    if (sector.right[i] == dofs[0]) dofs.push_back(sector.left[i]);
  }
  for (const Index dof : dofs) {
    if (sector.gyroscopic.col(dof).norm() > 0)
      section.fail("mass",
                   fmt::format("not on dof {:g}, which Coriolis' forces act on: those of the mass are "
                               "not known",
                               settings.dofs[0]));
  }
}

}  // namespace

const KeyTable<RingChangeSettings>& mistuning_keys() {
  const auto read_factors = [](RingChangeSettings& settings, const TomlSection& section) {
    if (settings.sectors > 0)
      settings.factors = factors_of_sectors(section, "factors", settings.sectors, 1, settings.pattern);
  };
  static const KeyTable<RingChangeSettings> keys{
      {ChangeKey::choice("part", &RingChangeSettings::on_base, changed_parts(), "what is mistuned", "",
                         required),
       ChangeKey(
           "dofs", &RingChangeSettings::dofs, changed_dof_rule(),
           "a dof of the sector, or two with a spring between them; of rods and beams one of a node",
           otherwise("required of sectors; of rods and beams the stiffness of the elements behind the nodes"),
           then(check_changed_dofs), unresolved),
       ChangeKey("stiffness", &RingChangeSettings::stiffness, positive(),
                 "of the spring between the dofs, or from the one to ground", otherwise("none"), unresolved),
       ChangeKey("mass", &RingChangeSettings::mass, positive(), "on the one dof", otherwise("none"),
                 unresolved),
       ChangeKey::special(
           "factors", "list, CSV file or table",
           "on these in each sector: numbers, a file of them, or `{ scatter, seed, correlation, law }`",
           read_factors, required)}};
  return keys;
}

const KeyTable<RingChangeSettings>& cut_keys() {
  const auto read_after = [](RingChangeSettings& settings, const TomlSection& section) {
    section.require("after", "an array of sectors");
    if (settings.sectors > 0) settings.after = listed_sectors(section, "after", settings.sectors);
  };
  static const KeyTable<RingChangeSettings> keys{
      {ChangeKey::choice("part", &RingChangeSettings::on_base, changed_parts(), "what is cut", "", required),
       ChangeKey::special("after", "list of sectors", "behind which the link to the next one is missing",
                          read_after, required),
       ChangeKey("dofs", &RingChangeSettings::dofs, changed_dof_rule(),
                 "the dof of the sector and that of the next one between which it is, or as many of each, "
                 "first those of the sector",
                 required, then(check_changed_dofs)),
       ChangeKey("weights", &RingChangeSettings::weights, any_number(),
                 "of the dofs, in what stretches the link: that times `stiffness` is its force",
                 otherwise("[-1, 1]"), then(check_link_weights)),
       ChangeKey("stiffness", &RingChangeSettings::stiffness, positive(), "of the link", required)}};
  return keys;
}

std::vector<WeightRow> changed_motions(const TomlDocument& document, bool on_base, Index size) {
  std::vector<WeightRow> all;
  for (const char* name : {"mistuning", "cut"}) {
    for (const TomlSection& section : changing_tables(document, name)) {
      if (section.text("part", {"base", "damper"}) != (on_base ? "base" : "damper")) continue;
      RingChangeSettings settings;
      settings.size = size;
      const RingChangeSettings given = read_change(section, settings);
      for (WeightRow& one : motions_of(given, is_mistuning(section))) {
        one.name = fmt::format("#{}", all.size() + 1);
        all.push_back(std::move(one));
      }
    }
  }
  return all;
}

void read_changes(const TomlDocument& document, const SystemParameters& system, Index pattern,
                  RingMake& ring) {
  RingChangeSettings start;
  start.pattern = pattern;
  start.sectors = ring.sectors;
  if (ring.structures == nullptr) {
    start.has_elements = true;
    start.size = system.model == StructureModel::rods ? 1 : 2;
    return read_element_changes(document, system, start, ring);
  }
  start.size = std::numeric_limits<int>::max();  // checked as the sectors were read
  for (const char* name : {"mistuning", "cut"}) {
    for (const TomlSection& section : changing_tables(document, name)) {
      const RingChangeSettings settings = read_change(section, start);
      Index& ports = settings.on_base ? ring.base_ports : ring.damper_ports;
      if (!settings.on_base && system.fixed_damper) section.fail("part", "there is no damper that moves");
      const bool mistuned = is_mistuning(section);
      if (mistuned) check_turning_mass(section, settings, system);
      mistuned ? add_mistuning(settings, ports, ring.changes) : add_cut(settings, ports, ring.changes);
      ports += std::ssize(motions_of(settings, mistuned));
    }
  }
}

}  // namespace arcslip
