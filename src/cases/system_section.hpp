#pragma once

// The sections [system] and, by geometry_section.hpp, [geometry] of a case file.

#include <memory>

#include "arcslip/assembly/sector_pair.hpp"
#include "arcslip/cases/case_file.hpp"
#include "keys/key_table.hpp"

namespace arcslip {

/// What [system] is read for.
struct SystemUse {
  const problems::LibraryModel* model;  ///< null for a system with friction
  std::string parameter;                ///< the continuation parameter, which needs no value
  bool linear_passive = false;          ///< only damping > 0, as in studies

  std::shared_ptr<const SectorPair> sectors = {};  ///< null for other models
  double eta_low = 0;                              ///< the eta that matter to them; 0: not known
  double eta_high = 0;
  bool is_free = false;  ///< whether eta is an unknown
};

/// [system] of a model with friction as it is read.
struct FrictionSettings : SystemParameters {
  const SystemUse* use = nullptr;
  bool has_geometry = false;
  std::optional<double> slenderness = {};
  double poisson_ratio = 0.3;
  std::optional<double> harmonics_tolerance = {};
  std::vector<double> contact_stiffness = {};  ///< of sectors, for each contact
  std::vector<double> limit_per_preload = {};
  SectorPath path = SectorPath::reduced;
  double reduction_tolerance = 1e-10;
};

/// Keys that the models with friction share.
std::vector<Key<FrictionSettings>> shared_keys();
Key<FrictionSettings> preload_growth_key();

/// [system] of rods and beams, and of a model of the library.
const KeyTable<FrictionSettings>& ring_keys();
struct LibrarySettings {
  problems::LibraryModel::Values values;
  std::string parameter;  ///< the continuation parameter
};
const KeyTable<LibrarySettings>& library_keys(const problems::LibraryModel& model);

/// What for_each may list in [system] and [geometry].
std::vector<ListedKey> listed_keys(const TomlDocument& document, const problems::LibraryModel* model);

std::vector<std::string> model_names();

/// Reads the section, with [geometry] where it is given, into the problem's settings or system. Throws
/// InputError.
void read_system(const TomlDocument& document, const Replacements& replacements, const SystemUse& use,
                 ProblemRequest& problem);

/// Adds the defaults that were taken to the case file as JSON.
void resolve_system(const ProblemRequest& problem, nlohmann::ordered_json& file);

/// What Poisson's ratio may be.
NumberRule poisson_rule();

/// The numbers that a parameter of the problem may be.
NumberRule parameter_rule(const problems::LibraryModel* model, const std::string& parameter);

}  // namespace arcslip
