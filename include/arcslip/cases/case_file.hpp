#pragma once

// Case files: TOML 1.0, read and checked whole before anything runs.

#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "arcslip/assembly/physical_scale.hpp"
#include "arcslip/cases/response_kind.hpp"
#include "arcslip/continuation/curves/curve.hpp"
#include "arcslip/continuation/cycles/cycle_branch.hpp"
#include "arcslip/keys/input_error.hpp"
#include "arcslip/problems/library/library.hpp"

namespace arcslip {

/// A curve of special points in two parameters.
struct CurveRequest {
  std::string name;              ///< what the case file calls it
  continuation::PointType type;  ///< of the special points; `event` where an observable has a value
  std::optional<continuation::Level> level;  ///< that value
  std::string active;                        ///< the first parameter, in which they are looked for at first
  continuation::CurveWindow window;          ///< its range
  double from = 0;                           ///< the end of the range at which the search begins
  double to = 0;                             ///< the other end
  double seed = 0;                           ///< value of the second parameter at which they are looked for
  std::string named = {};  ///< the first parameter as the case file has it, perhaps with a unit

  bool of_cycles = false;  ///< whether the points are looked for on cycles

  /// Whether what is asked for are not special points, but all solutions over both parameters.
  bool is_surface() const { return name == "surface"; }

  /// Whether it is a backbone: what the load does work on lags by a quarter of a period, as at a resonance.
  bool is_backbone() const { return name == "phase_resonance"; }
};

class Structures;
struct StructureKind;

/// The problem that a branch belongs to: one of the library's or of formulas, or a system with friction.
struct ProblemRequest {
  std::shared_ptr<const problems::LibraryModel> model;          ///< null for a system with friction
  problems::LibraryModel::Values settings;                      ///< the library model's
  const StructureKind* structure = nullptr;                     ///< what base and damper are then
  SystemParameters system;                                      ///< unless it is one of the library's
  std::optional<Geometry> geometry;                             ///< where rings are given in SI units
  std::optional<PhysicalScale> physical;                        ///< of a system that is given in SI units
  const ResponseKind* response = find_response_kind("forced");  ///< what is asked of a system with friction
  double eta = 0;  ///< the fixed frequency where eta is not continued; near that of a nonlinear mode
  double R = 0;    ///< the fixed amplitude of a nonlinear mode where R is not continued

  /// Where harmonics are added while tracing: the largest one left out, relative to R.
  std::optional<double> harmonics_tolerance;

  bool stability = false;  ///< whether its points come with their Floquet exponents
};

/// How cycles are followed.
struct CyclesRequest {
  continuation::CycleOptions options;
  /// Where the branch is one of cycles: for how long a motion is followed until it is looked for one.
  std::optional<double> settle;
};

/// A point that a run has left, which a branch begins from.
struct StoredPoint {
  Vector unknowns;                           ///< of the problem
  std::map<std::string, double> parameters;  ///< by name
  continuation::Regime regime;               ///< in which it lies
};

/// One branch that a case asks for. With `switching` or for a curve several may come of it.
struct CaseBranch {
  nlohmann::ordered_json values;       ///< what `for_each` sets on it, by key
  ProblemRequest problem;              ///< that is traced, or extended by the curve
  continuation::TraceOptions options;  ///< of [branch] and [continuation]
  std::string named = {};              ///< the parameter as the case file has it, perhaps with a unit
  std::optional<double> start;         ///< value of the parameter from which the branch is traced both ways
  std::optional<StoredPoint> stored;   ///< in place of a first guess at `start`
  /// Lowest and highest unknown of a box, once for all or for each; empty: by the problem's scale.
  std::vector<double> box = {};
  bool all_solutions = false;         ///< one for each solution at `start` that deflated Newton finds
  bool switching = false;             ///< follow the branches that branch points and corners lead to
  std::optional<CurveRequest> curve;  ///< none of a branch
  CyclesRequest cycles;               ///< of flows
};

/// What a case file asks for, branch by branch.
struct CasePlan {
  std::string title;                              ///< of the file, or empty
  nlohmann::ordered_json resolved;                ///< the input with its defaults filled in
  std::size_t count = 0;                          ///< of branches
  std::function<CaseBranch(std::size_t)> branch;  ///< the i-th, made when asked for
};

/// The same with all branches made.
struct Case {
  std::string title;                 ///< of the file, or empty
  nlohmann::ordered_json resolved;   ///< the input with its defaults filled in
  std::vector<CaseBranch> branches;  ///< in the order of their numbers
};

class TomlDocument;

/// What a case that a program gives may name beside files and the kinds that there are.
struct CaseParts {
  std::map<std::string, std::string> files;  ///< their texts, by the names that stand for them
  std::vector<std::shared_ptr<const ElementKind>> elements;             ///< for [[element]]
  std::map<std::string, std::shared_ptr<const Structures>> structures;  ///< GivenStructures, for `model`
};

/// A case file, read once, with `--set` arguments "section.key=value" applied on top.
class CaseFile {
 public:
  /// Throws InputError.
  explicit CaseFile(const std::string& path, const std::vector<std::string>& settings = {});

  /// The same of a text that is in no file; `name` stands for the file in errors. Throws InputError.
  static CaseFile of_text(const std::string& name, const std::string& text,
                          const std::vector<std::string>& settings = {},
                          std::shared_ptr<const CaseParts> parts = {});

  /// As it was given, and whether the file has a section of this name.
  const std::string& path() const;
  bool has(const std::string& section) const;

  /// Does what a section asks for; what that throws becomes an InputError that names file and section.
  void named(const std::string& section, const std::function<void()>& work) const;

  /// What was read; may be shared.
  const std::shared_ptr<const TomlDocument>& document() const { return document_; }

 private:
  explicit CaseFile(std::shared_ptr<const TomlDocument> document) : document_(std::move(document)) {}

  std::shared_ptr<const TomlDocument> document_;
};

/// Checks the whole file. Throws InputError.
CasePlan plan_case(const CaseFile& file);

/// The same with all branches at hand.
Case read_case(const std::string& path, const std::vector<std::string>& settings = {});

/// What a case file may hold at its top, and whether one does. Throws InputError where it cannot be read.
std::vector<std::string> case_sections();
bool has_section(const std::string& path, const std::string& name,
                 const std::vector<std::string>& settings = {});

/// "preload = 0.1" for the values of a branch; several are joined by commas, none gives "".
std::string describe(const nlohmann::ordered_json& values);

}  // namespace arcslip
