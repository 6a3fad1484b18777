#include "cases/ring_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "arcslip/assembly/harmonic_system.hpp"
#include "arcslip/assembly/sector_pair.hpp"
#include "arcslip/assembly/whole_ring.hpp"
#include "cases/ring_changes.hpp"
#include "cases/ring_numbers.hpp"

namespace arcslip {
namespace {

using nlohmann::ordered_json;

constexpr Index most_sectors = 1000;

struct WholeSettings {
  Index sectors = 0;
  Index each = 1;  ///< contacts of a sector
  bool has_elements = false;
  Index pattern = 1;
  bool amplification = false;
  WholeLoad load = {};
  std::vector<double> preload = {};  ///< factors
  std::vector<double> stiffness = {};
  std::vector<double> friction = {};
  std::vector<Index> missing = {};
};

using WholeKey = Key<WholeSettings>;

constexpr const char* courses =
    R"("travelling", "standing", "point", a list with a number or a pair [amplitude, phase] for each sector, )"
    "or a CSV file of such rows";

Complex amplitude(const std::vector<double>& row) {
  return row.size() > 1 ? std::polar(row[0], row[1]) : Complex(row[0]);
}

void read_course(WholeSettings& settings, const TomlSection& section) {
  using Course = WholeLoad::Course;
  const toml::node& node = section.require("load", courses);
  for (const Course course : {Course::travelling, Course::standing, Course::point}) {
    if (node.value<std::string>() != to_string(course)) continue;
    settings.load.course = course;
    return;
  }
  const std::vector<std::vector<double>> rows = listed_rows(section, "load", courses);
  if (std::ssize(rows) != settings.sectors)
    section.fail("load", fmt::format("expected {} amplitudes, one for each sector, got {}", settings.sectors,
                                     rows.size()));
  settings.load.course = Course::given;
  for (const std::vector<double>& row : rows) {
    if (row.empty() || row.size() > 2) section.fail("load", "expected amplitudes, each perhaps with a phase");
    settings.load.sectors.push_back(amplitude(row));
  }
  if (std::all_of(settings.load.sectors.begin(), settings.load.sectors.end(),
                  [](const Complex& one) { return one == 0.0; }))
    section.fail("load", "expected a force that is not 0");
}

WholeKey factors_key(const char* name, std::vector<double> WholeSettings::*member,
                     const std::string& meaning) {
  const auto read = [=](WholeSettings& settings, const TomlSection& section) {
    settings.*member = factors_of_sectors(section, name, settings.sectors, settings.each, settings.pattern);
  };
  return WholeKey::special(name, "list, CSV file or table", meaning, read, otherwise("1 everywhere"));
}

const KeyTable<WholeSettings>& whole_keys() {
  const auto read_missing = [](WholeSettings& settings, const TomlSection& section) {
    settings.missing = listed_sectors(section, "missing", settings.sectors);
  };
  const auto has_elements = [](const WholeSettings& settings, const TomlSection&) {
    return settings.has_elements;
  };
  static const KeyTable<WholeSettings> keys{
      {WholeKey(
           "pattern", &WholeSettings::pattern, at_least(0, 9e15),
           "which of the patterns that a scatter gives: 1 is that of its seed itself, 0 the equal ring, all "
           "factors 1"),
       WholeKey::flag(
           "amplification", &WholeSettings::amplification,
           "whether `amplification` is told, Y_max over the highest one of the equal ring under the "
           "same load "
           "between `from` and `to`, whose branch is traced as well"),
       WholeKey::special(
           "load", "text, list or CSV file",
           "round the ring: `travelling` with the wave, `standing` as cos(n theta), `point` on sector 1, "
           "or an amplitude, perhaps with a phase in radians, for each sector",
           read_course, otherwise("\"travelling\""), resolved([](const WholeSettings& settings) {
             return ordered_json(to_string(settings.load.course));
           })),
       factors_key(
           "preload", &WholeSettings::preload,
           "factors on the preload of each sector's contacts, or of each contact: numbers, a file of them, "
           "or `{ scatter, seed, correlation, law }`"),
       factors_key("friction", &WholeSettings::friction,
                   "the same on their friction coefficient, which multiplies it"),
       factors_key("stiffness", &WholeSettings::stiffness,
                   "the same on their stiffness, at the same limit of the force"),
       WholeKey::special("missing", "list of sectors", "without contacts", read_missing, otherwise("none")),
       WholeKey::special("split", "list of nodes",
                         "of rods and beams: behind which the damper's element to the next one is missing",
                         {}, otherwise("none"),
                         only("only for rods and beams; links of sectors are cut by [[ring.cut]]",
                              has_elements, "only for rods and beams")),
       WholeKey::special("mistuning", "tables", "of base or damper: `[[ring.mistuning]]`", {},
                         otherwise("none")),
       WholeKey::special("cut", "tables", "links of sectors that are missing: `[[ring.cut]]`", {},
                         otherwise("none"))}};
  return keys;
}

/// Refuses what is not calculated of whole rings.
void check_ring_use(const TomlDocument& document, const TomlSection& section, const SystemUse& use,
                    const ProblemRequest& problem) {
  const SystemParameters& system = problem.system;
  const auto fail = [&](const std::string& why) { document.fail(section.table(), "ring", why); };
  if (use.is_free) fail("only of forced responses: limit cycles and nonlinear modes are those of one sector");
  if (system.elements < 2)
    fail("expected a structure of sectors or nodes, as rods, beams, or model = \"sector\" with `sectors`");
  if (system.elements > most_sectors)
    fail(fmt::format("expected at most {} sectors, got {}", most_sectors, system.elements));
  if (system.periods() > 1)
    fail("only of responses that repeat themselves with the load, not over `periods`");
}

/// Refuses loads that have a phase within a sector, but for the travelling one that it belongs to, and those
/// that cannot stand still beside sectors that turn.
void check_ring_load(const TomlSection& section, const WholeLoad& load, const SystemParameters& system) {
  const bool is_fixed = load.course == WholeLoad::Course::standing || load.course == WholeLoad::Course::point;
  if (system.rotation.per_eta != 0 && feels_rotation(system) && is_fixed)
    section.fail("load", fmt::format("expected \"travelling\" or a list beside engine_order, whose load the "
                                     "sectors pass, got \"{}\"",
                                     to_string(load.course)));
  const auto* pair = dynamic_cast<const SectorPair*>(system.structures.get());
  if (load.course == WholeLoad::Course::travelling || pair == nullptr) return;
  if (!pair->base().sector.load.imag().isZero(0))
    section.fail("load",
                 "expected \"travelling\", as the sector's load has an imaginary part, a phase that "
                 "belongs to a wave");
}

std::vector<double> product_of(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.empty() || b.empty()) return a.empty() ? b : a;
  std::vector<double> all = a;
  for (std::size_t i = 0; i < all.size(); ++i) all[i] *= b[i];
  return all;
}

}  // namespace

std::vector<KeyWords> ring_words() {
  std::vector<KeyWords> words = whole_keys().words();
  for (KeyWords& key : words) {
    if (key.name == "preload") key.inner = scatter_keys().words();
    if (key.name == "mistuning") key.inner = mistuning_keys().words();
    if (key.name == "cut") key.inner = cut_keys().words();
  }
  return words;
}

std::vector<ListedKey> listed_ring_keys(const TomlDocument& document) {
  if (!document.root().contains("ring")) return {};
  return {{"pattern", "ring.pattern", ""}};
}

void read_ring(const TomlDocument& document, const Replacements& replacements, const SystemUse& use,
               ProblemRequest& problem) {
  const TomlSection section(document, "ring", &replacements);
  if (section.table() == nullptr) return;
  check_ring_use(document, section, use, problem);
  SystemParameters& system = problem.system;
  if (system.contacts.empty()) system.contacts = build_wave(system).contacts;
  WholeSettings settings{system.elements, std::ssize(system.contacts), system.structures == nullptr};
  settings.load.wave_number = system.wave_number;
  whole_keys().read(settings, section);
  check_ring_load(section, settings.load, system);
  RingContacts contacts{product_of(settings.preload, settings.friction), settings.stiffness};
  if (!settings.missing.empty()) {
    contacts.missing.assign(static_cast<std::size_t>(settings.sectors * settings.each), false);
    for (const Index i : settings.missing) {
      for (Index j = 0; j < settings.each; ++j)
        contacts.missing[static_cast<std::size_t>(i * settings.each + j)] = true;
    }
  }
  if (section.has("split") && system.fixed_damper) section.fail("split", "there is no damper that moves");
  RingMake ring{settings.sectors, system.structures, {}, settings.load};
  if (system.structures != nullptr) ring.contacts = system.contacts;
  if (settings.amplification) ring.equal_peak = std::numeric_limits<double>::quiet_NaN();
  read_changes(document, system, settings.pattern, ring);
  system.contacts = contacts.of(system.contacts, settings.sectors);
  const auto whole = std::make_shared<const WholeRing>(std::move(ring));
  system.structures = whole;
  try {
    whole->check_changes(system);
    system.structures->check(system.wave_number, system.elements);
    static_cast<void>(system.structures->wave(system));
  } catch (const std::invalid_argument& error) {
    document.fail(section.table(), "ring", error.what());
  }
}

ordered_json ring_values() { return whole_keys().values({}); }

ProblemRequest of_one_sector(ProblemRequest problem) {
  if (problem.model != nullptr) return problem;
  const WholeRing* whole = structures_of(problem.system).whole();
  if (whole != nullptr) problem.system = whole->one_sector(problem.system);
  return problem;
}

std::string ring_in_words(const SystemParameters& system) {
  const WholeRing* whole = structures_of(system).whole();
  if (whole == nullptr) return "";
  std::string text = fmt::format("whole ring of {} contacts in {} sectors, {} load", system.contacts.size(),
                                 whole->sectors(), to_string(whole->make().load.course));
  if (const std::size_t count = whole->make().changes.size(); count > 0)
    text += fmt::format(", {} {} not as in other sectors", count, count == 1 ? "part" : "parts");
  return text;
}

}  // namespace arcslip
