#pragma once

// The sections [system] and, by geometry_section.hpp, [geometry] of a case file.

#include <memory>

#include "cases/structure_kind.hpp"

namespace arcslip {

/// Of numbers that [geometry] gives where the case has it.
inline constexpr const char* in_geometry = "not beside [geometry], which gives it";
inline bool without_geometry(const FrictionSettings& settings, const TomlSection& /*section*/) {
  return !settings.has_geometry;
}

/// [system] of a model of the library.
struct LibrarySettings {
  problems::LibraryModel::Values values;
  std::string parameter;  ///< the continuation parameter
};
const KeyTable<LibrarySettings>& library_keys(const problems::LibraryModel& model);

/// What for_each may list in [system] and [geometry].
std::vector<ListedKey> listed_keys(const TomlDocument& document, const problems::LibraryModel* model);

/// What `model` may be in a document.
std::vector<std::string> model_names(const TomlDocument& document);

/// A number for all contacts, or a list with one for each. Throws InputError.
std::vector<double> numbers_of_contacts(const TomlSection& section, const std::string& name,
                                        const NumberRule& rule, std::size_t count);

/// Contacts of these k, which slip where their force is L P; nothing rubs where k is 0.
std::vector<SectorContact> sector_contacts(const std::vector<double>& stiffness,
                                           const std::vector<double>& limit_per_preload);

/// Stiffness and limits of the contacts, and the load.
std::string contacts_in_words(const SystemParameters& system);

/// What the kind of structure loads of a system with friction; null if nothing. Throws InputError.
std::shared_ptr<const Structures> load_structures(const TomlDocument& document);

/// Reads the section, with [geometry] where it is given, into the problem's settings or system. Throws
/// InputError.
void read_system(const TomlDocument& document, const Replacements& replacements,
                 const std::shared_ptr<const problems::LibraryModel>& model, const SystemUse& use,
                 ProblemRequest& problem);

/// Adds the defaults that were taken to the case file as JSON.
void resolve_system(const TomlDocument& document, const ProblemRequest& problem,
                    nlohmann::ordered_json& file);

/// What Poisson's ratio may be.
NumberRule poisson_rule();

/// The numbers that a parameter of the problem may be.
NumberRule parameter_rule(const problems::LibraryModel* model, const std::string& parameter);

}  // namespace arcslip
