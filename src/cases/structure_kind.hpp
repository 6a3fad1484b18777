#pragma once

// What base and damper may be, as `model` of [system] names it. Each kind is one file in
// src/cases/structures: NAME.cpp defines `StructureKind NAME_structure()`, and the build finds it. It has the
// keys of its own and a class derived from Structures, unless that is shared with others.

#include "arcslip/assembly/structures.hpp"
#include "arcslip/cases/case_file.hpp"
#include "keys/key_table.hpp"

namespace arcslip {

/// What a system with friction is read for.
struct SystemUse {
  std::string parameter = {};   ///< the continuation parameter, which needs no value
  bool linear_passive = false;  ///< only damping > 0, as in studies

  /// What the kind has loaded, and the eta that matter to it; 0: not known.
  std::shared_ptr<const Structures> structures = {};
  double eta_low = 0;
  double eta_high = 0;
  double speed_low = 0;  ///< the speeds that are passed where it is continued
  double speed_high = 0;
  bool is_free = false;  ///< whether eta is an unknown
};

/// [system] of a model with friction as it is read. A kind derives its own settings from it.
struct FrictionSettings : SystemParameters {
  const SystemUse* use = nullptr;
  bool has_geometry = false;     ///< whether the case has [geometry], which then gives the groups
  bool has_damping_kind = true;  ///< whether damping.kind is one of its keys
  bool is_base_damped = false;   ///< by more than zeta, which then may be 0
  bool is_damper_damped = false;
  std::optional<double> harmonics_tolerance = {};
  bool in_SI = false;  ///< whether masses are in kg, stiffnesses in N/m
  double hertz = 1;    ///< eta = 1 of such a system
};

/// Keys that the models with friction share.
std::vector<Key<FrictionSettings>> shared_keys();
Key<FrictionSettings> preload_growth_key();
Key<FrictionSettings> units_key();

struct StructureKind {
  /// A section with keys of its own.
  struct Section {
    std::string name;  ///< "geometry"
    std::string note;
    std::function<std::vector<KeyWords>()> keys;
    bool is_listed = false;  ///< whether for_each may list its keys
  };
  /// What a case file's [system] is read from.
  struct Source {
    const TomlDocument& document;
    const TomlSection& section;
    const Replacements& replacements;
    const SystemUse& use;
  };

  std::string name;                             ///< of its file
  std::string title;                            ///< "rods and beams"
  std::vector<std::string> models;              ///< what `model` calls it
  std::function<std::vector<KeyWords>()> keys;  ///< of [system]
  std::vector<Section> sections = {};

  /// What takes long to read and is the same in all branches: files. Null: nothing. Throws InputError.
  std::function<std::shared_ptr<const Structures>(const TomlDocument&)> load = {};

  /// Reads [system] into the request's system, harmonics_tolerance and geometry. Throws InputError.
  std::function<void(const Source& source, ProblemRequest& problem)> read;

  /// The values that summary.json adds to those given in [system], `given`.
  std::function<nlohmann::ordered_json(const ProblemRequest& problem, const nlohmann::ordered_json& given)>
      resolved;

  /// A system in words, on a line.
  std::function<std::string(const ProblemRequest& problem)> describe;

  std::string frequency_unit =
      {};  ///< of eta in SI units; "" where it is relative to the damper's own frequency
};

/// All of them, in alphabetical order.
const std::vector<StructureKind>& structure_kinds();

/// The one that has this model, or null.
const StructureKind* structure_of(const std::string& model);

/// Puts what was read into a request.
void take(FrictionSettings settings, ProblemRequest& problem);

}  // namespace arcslip
