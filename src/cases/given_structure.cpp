#include "cases/given_structure.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "arcslip/assembly/given_structures.hpp"
#include "cases/system_section.hpp"

namespace arcslip {
namespace {

using nlohmann::ordered_json;

struct GivenSettings : FrictionSettings {
  GivenSettings() {
    elements = 1;
    wave_number = 0;
    base_damping = 0;  // is in its responses
    damper_damping = 0;
  }

  std::size_t count = 1;  ///< of contacts
  std::vector<double> contact_stiffness = {};
  std::vector<double> limit_per_preload = {1};
};

using GivenKey = Key<GivenSettings>;

GivenKey::Reader for_given_contacts(const std::string& name, std::vector<double> GivenSettings::*member,
                                    const NumberRule& rule) {
  return [=](GivenSettings& settings, const TomlSection& section) {
    settings.*member = numbers_of_contacts(section, name, rule, settings.count);
  };
}

const KeyTable<GivenSettings>& given_keys() {
  using S = GivenSettings;
  const auto wave_rule = [](const S& settings) {
    const Index most = settings.elements / 2;
    return within(0, static_cast<double>(most), fmt::format(" >= 0 and <= sectors/2 = {}", most));
  };
  static const KeyTable<S> keys = [&] {
    std::vector<Key<FrictionSettings>> shared = shared_keys();
    std::erase_if(shared, [](const auto& key) { return key.words.name == "damping"; });
    return KeyTable<S>(
        {GivenKey::special("model", "a structure", "by its responses", {}, otherwise("required"), unlisted),
         GivenKey("sectors", &S::elements, within(1, 1e9, " >= 1 and <= 1e9"), "N"),
         GivenKey("wave_number", &S::wave_number, {" >= 0 and <= sectors/2", wave_rule},
                  "n, nodal diameters"),
         GivenKey::special("contact_stiffness", "number or list", "k of each contact, or of all",
                           for_given_contacts("contact_stiffness", &S::contact_stiffness, at_least(0)),
                           required, parameter("K_FD"))},
        keys_of<S>(shared),
        {GivenKey::special("limit_per_preload", "number or list",
                           "L: a contact slips where its force is L P, S = L P/k",
                           for_given_contacts("limit_per_preload", &S::limit_per_preload, positive()),
                           resolved([](const S&) { return 1.0; })),
         GivenKey("force", &S::force, positive(), "factor of the load", parameter("F")),
         preload_growth_key()});
  }();
  return keys;
}

/// The one that is named, as `model` was found to be.
std::shared_ptr<const Structures> load_given(const TomlDocument& document) {
  return find_given(document, *document.root().at_path("system.model").value<std::string>());
}

void read_given(const StructureKind::Source& source, ProblemRequest& problem) {
  const auto given = std::static_pointer_cast<const GivenStructures>(source.use.structures);
  if (source.use.is_free)
    source.section.fail("model",
                        "nonlinear modes and limit cycles begin from modes, which responses do not tell");
  GivenSettings settings;
  settings.use = &source.use;
  settings.structures = given;
  settings.fixed_damper = !given->has_damper();
  settings.count = static_cast<std::size_t>(given->contacts());
  settings.limit_per_preload.assign(settings.count, 1);
  given_keys().read(settings, source.section);
  settings.contacts = sector_contacts(settings.contact_stiffness, settings.limit_per_preload);
  settings.interface_stiffness = settings.contact_stiffness.front() * static_cast<double>(settings.elements);
  take(std::move(settings), problem);
}

ordered_json given_resolved(const ProblemRequest& problem, const ordered_json& /*given*/) {
  GivenSettings settings;
  static_cast<SystemParameters&>(settings) = problem.system;
  settings.harmonics_tolerance = problem.harmonics_tolerance;
  return given_keys().values(settings);
}

std::string given_in_words(const ProblemRequest& problem) {
  const SystemParameters& system = problem.system;
  return fmt::format("structure by its responses, n = {}, N = {}, {}", system.wave_number, system.elements,
                     contacts_in_words(system));
}

}  // namespace

const StructureKind& given_structure() {
  static const StructureKind kind{.name = "given",
                                  .title = "structures by their responses",
                                  .models = {},
                                  .keys = [] { return given_keys().words(); },
                                  .load = load_given,
                                  .read = read_given,
                                  .resolved = given_resolved,
                                  .describe = given_in_words};
  return kind;
}

std::shared_ptr<const Structures> find_given(const TomlDocument& document, const std::string& model) {
  if (document.parts() == nullptr) return nullptr;
  const auto found = document.parts()->structures.find(model);
  return found == document.parts()->structures.end() ? nullptr : found->second;
}

}  // namespace arcslip
