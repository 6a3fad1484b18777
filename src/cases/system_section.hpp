#pragma once

// The sections [system] and, by geometry_section.hpp, [geometry] of a case file.

#include "arcslip/cases/case_file.hpp"
#include "keys/toml_reader.hpp"

namespace arcslip {

/// Keys that [system] may have for a model, and the names of models.
std::vector<std::string> system_keys(const problems::LibraryModel* model);
std::vector<std::string> model_names();

/// Refuses keys that [system] and, of rods and beams, [geometry] do not have.
void check_keys(const TomlDocument& document, const problems::LibraryModel* model);

/// Keys that for_each may list, those of [geometry] by dotted names, and the path of the value that a key
/// stands for.
std::vector<std::string> listed_keys(const TomlDocument& document, const problems::LibraryModel* model);
std::string path_of(const std::string& key);

/// What [system] is read for.
struct SystemUse {
  const problems::LibraryModel* model;  ///< null for a system with friction
  std::string parameter;                ///< the continuation parameter, which needs no value
  bool linear_passive = false;          ///< only damping > 0 and no cubic stiffness, as in studies

  std::shared_ptr<const SectorPair> sectors = {};  ///< null for other models
  double eta_low = 0;                              ///< the eta that matter to them; 0: not known
  double eta_high = 0;
  bool balanced =
      false;  ///< whether several contacts and the full path of a sector, and several harmonics, may be taken
};

/// Reads the section, with [geometry] where it is given, into the problem's settings or system. Throws
/// InputError.
void read_system(const TomlDocument& document, const Replacements& replacements, const SystemUse& use,
                 ProblemRequest& problem);

/// Refuses sectors that cannot travel as the waves of these harmonics, in the name of a key.
void check_waves(const TomlSection& section, const std::string& key, const SystemParameters& system,
                 const std::vector<int>& orders);

/// Adds the defaults that were taken to the section as JSON.
void resolve_system(const ProblemRequest& problem, nlohmann::ordered_json& section);

/// What Poisson's ratio may be.
NumberRule poisson_rule();

/// The numbers that a parameter of the problem may be.
NumberRule parameter_rule(const problems::LibraryModel* model, const std::string& parameter);

}  // namespace arcslip
