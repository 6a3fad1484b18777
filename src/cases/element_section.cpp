#include "cases/element_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "arcslip/cases/case_file.hpp"

namespace arcslip {
namespace {

using ElementKey = Key<PlacedElement>;

ElementKey key_of(const ElementKind& kind, std::size_t i) {
  const ElementKind::Value& setting = kind.settings[i];
  const auto continued = parameter(fmt::format("{}.{}", kind.name, setting.name));
  std::string meaning = setting.meaning;
  if (setting.scales_force) meaning += "; of rods and beams N times that of a node, as K_FD";
  const auto setting_value = [i](auto& placed) -> auto& { return placed.settings[i]; };
  if (std::isnan(setting.value))
    return {setting.name, setting_value, rule_of(setting), meaning, required, continued};
  return {setting.name, setting_value, rule_of(setting), meaning, otherwise(fmt::format("{}", setting.value)),
          continued};
}

void read_name(PlacedElement& placed, const TomlSection& section) {
  placed.name = section.text("name", {});
  const auto fits = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  const bool is_of_contact =  // whose columns end so
      placed.name.rfind("contact_", 0) == 0 || placed.name == "contacts";
  if (placed.name.empty() || is_of_contact || !std::all_of(placed.name.begin(), placed.name.end(), fits))
    section.mismatch(
        "name", "a name of letters, digits and _ that does not begin with contact_, and is not contacts");
}

/// The further dofs along which it slides and closes.
void add_directions(const ElementKind& kind, std::vector<ElementKey>& keys) {
  const auto dof = [](const char* name, Index PlacedElement::*member) {
    return [=](PlacedElement& placed, const TomlSection& section) {
      placed.*member = section.integer(name, at_least(1)) - 1;
    };
  };
  if (kind.slides == 2)
    keys.push_back(ElementKey::special(
        "second", "integer >= 1", "at which of the contact dofs it slides in the other direction",
        dof("second", &PlacedElement::second), required,
        resolved([](const PlacedElement& placed) { return placed.second + 1; }), unlisted));
  if (kind.closes == ElementKind::Closing::must)
    keys.push_back(ElementKey::special(
        "normal", "integer >= 1", "at which of the contact dofs it closes; `contact` is where it slides",
        dof("normal", &PlacedElement::normal), required,
        resolved([](const PlacedElement& placed) { return placed.normal + 1; }), unlisted));
  if (kind.closes == ElementKind::Closing::may)
    keys.push_back(ElementKey::special(
        "normal", "integer >= 1", "at which of the contact dofs it closes; without it N is constant",
        dof("normal", &PlacedElement::normal), otherwise("none"), resolved([](const PlacedElement& placed) {
          return placed.closes() ? nlohmann::ordered_json(placed.normal + 1) : nlohmann::ordered_json();
        }),
        unlisted));
}

KeyTable<PlacedElement> keys_of(const ElementKind& kind) {
  const auto contact = [](PlacedElement& placed, const TomlSection& section) {
    placed.dof = section.integer("contact", at_least(1)) - 1;
  };
  std::vector<ElementKey> keys = {
      ElementKey::special("kind", fmt::format("\"{}\"", kind.name), kind.meaning, {}, otherwise("required"),
                          unlisted),
      ElementKey::choice("at", &PlacedElement::place,
                         {{"contact", PlacedElement::Place::contact},
                          {"base", PlacedElement::Place::base},
                          {"damper", PlacedElement::Place::damper}},
                         "between base and damper, or between one of them and ground", "", required,
                         unlisted),
      ElementKey::special("name", "name", "under which its settings are continued, as `stops.gap`", read_name,
                          resolved([](const PlacedElement& placed) {
                            return placed.name.empty() ? nlohmann::ordered_json()
                                                       : nlohmann::ordered_json(placed.name);
                          }),
                          otherwise("its kind; of the second of a kind `clearance_2`"), unlisted),
      ElementKey::special("contact", "integer >= 1", "of sectors, at which of the contact dofs", contact,
                          resolved([](const PlacedElement& placed) { return placed.dof + 1; }), unlisted)};
  add_directions(kind, keys);
  if (!kind.is_odd || kind.closes != ElementKind::Closing::cannot)
    keys.push_back(ElementKey::choice("closes", &PlacedElement::closes_backwards,
                                      {{"forwards", false}, {"backwards", true}},
                                      "whether it closes where the displacement of that dof grows or falls, "
                                      "at contacts that of the damper relative to the base",
                                      "", unlisted));
  for (std::size_t i = 0; i < kind.settings.size(); ++i) keys.push_back(key_of(kind, i));
  return {std::move(keys)};
}

/// Those of the document as well.
std::vector<std::string> kind_names(const TomlDocument& document) {
  std::vector<std::string> names;
  for (const ElementKind& kind : element_kinds()) names.push_back(kind.name);
  if (document.parts() == nullptr) return names;
  for (const auto& own : document.parts()->elements) names.push_back(own->name);
  return names;
}

void read_kind(PlacedElement& placed, const TomlDocument& document, const TomlSection& section) {
  const std::vector<std::string> names = kind_names(document);
  section.require("kind", one_of(names));
  const std::string name = section.text("kind", names);
  placed.kind = find_element_kind(name);
  if (placed.kind != nullptr) return;
  for (const auto& own : document.parts()->elements) {
    if (own->name == name) placed.own = own;
  }
  placed.kind = placed.own.get();
}

/// Refuses dofs that there are not.
void check_dofs(const TomlSection& section, const PlacedElement& placed, Index contacts) {
  if (placed.dof >= contacts)
    section.fail("contact", fmt::format("expected a contact from 1 to {}, got {}", contacts, placed.dof + 1));
  const auto check = [&](const char* key, const char* does, Index dof, const std::vector<Index>& taken) {
    if (contacts <= std::ssize(taken))
      section.fail(key, fmt::format("a structure with {} has no further one along which it could {}",
                                    contacts == 1 ? "one contact dof" : "two contact dofs", does));
    if (dof >= contacts || std::find(taken.begin(), taken.end(), dof) != taken.end())
      section.fail(
          key, fmt::format("expected a contact from 1 to {} other than {}{}, got {}", contacts, taken[0] + 1,
                           taken.size() > 1 ? fmt::format(" and {}", taken[1] + 1) : "", dof + 1));
  };
  std::vector<Index> taken{placed.dof};
  if (placed.kind->slides == 2) {
    check("second", "slide", placed.second, taken);
    taken.push_back(placed.second);
  }
  if (placed.closes()) return check("normal", "close", placed.normal, taken);
  if (placed.closes_backwards && placed.kind->closes != ElementKind::Closing::cannot)
    section.fail("closes", "without normal it does not close");
  for (std::size_t i = 0; i < placed.settings.size(); ++i) {
    if (placed.kind->settings[i].name == "normal_stiffness" && placed.settings[i] != 0)
      section.fail("normal_stiffness", "needs normal, the contact along which it closes");
  }
}

/// Refuses an element whose settings would have the names of another one's.
void check_names(const TomlSection& section, const SystemParameters& system) {
  const std::size_t last = system.others.size() - 1;
  for (std::size_t i = 0; i < last; ++i) {
    if (element_name(system, i) == element_name(system, last))
      section.fail(section.has("name") ? "name" : "kind",
                   fmt::format("element {} has the name {} already", i + 1, element_name(system, i)));
  }
}

}  // namespace

NumberRule rule_of(const Setting& setting) {
  constexpr double most = std::numeric_limits<double>::max();
  if (setting.low == -most && setting.high == most) return any_number();
  const auto holds = [setting](double x) {
    return (setting.may_be_low ? x >= setting.low : x > setting.low) && x <= setting.high;
  };
  const char* above = setting.may_be_low ? ">=" : ">";
  if (setting.high == most) return {holds, fmt::format(" {} {:g}", above, setting.low)};
  return {holds, fmt::format(" {} {:g} and <= {:g}", above, setting.low, setting.high)};
}

KeyTable<PlacedElement> element_keys(const ElementKind& kind) { return keys_of(kind); }

void read_elements(const TomlDocument& document, SystemParameters& system) {
  const toml::node* node = document.root().get("element");
  if (node == nullptr) return;
  if (!node->is_array_of_tables()) document.mismatch(*node, "element", "tables [[element]]");
  const auto contacts = std::max<Index>(1, std::ssize(system.contacts));
  for (std::size_t i = 0; i < node->as_array()->size(); ++i) {
    const TomlSection section(document, *node->as_array()->get(i)->as_table(), fmt::format("element[{}]", i));
    PlacedElement placed;
    read_kind(placed, document, section);
    for (const ElementKind::Value& setting : placed.kind->settings) placed.settings.push_back(setting.value);
    element_keys(*placed.kind).read(placed, section);
    check_dofs(section, placed, contacts);
    if (system.fixed_damper && placed.place == PlacedElement::Place::damper)
      section.fail("at", "there is no damper that moves");
    system.others.push_back(std::move(placed));
    check_names(section, system);
  }
}

}  // namespace arcslip
