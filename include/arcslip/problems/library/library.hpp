#pragma once

// The problems with published answers, by the names that case files give them: [system] model = "bratu". Each
// is one file in problems/library: NAME.cpp defines `LibraryModel NAME_model()`, and the build finds it.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "arcslip/continuation/cycles/orbit_branch.hpp"
#include "arcslip/continuation/path/trace.hpp"
#include "arcslip/continuation/problem/problem.hpp"
#include "arcslip/interval/zeros_in_box.hpp"
#include "arcslip/setting.hpp"

namespace arcslip::problems {

using arcslip::Setting;  // a key of [system] that a model understands: a parameter of the problem, or a size

/// A problem that can be built by name. Every parameter of the problem is a setting of the same name.
struct LibraryModel {
  using Values = std::vector<double>;  ///< one for each setting, in their order
  std::string name;                    ///< the value of `model`
  std::string title;                   ///< one line
  std::vector<Setting> settings;       ///< those that are parameters first
  /// the problem with these sizes
  std::function<std::unique_ptr<continuation::Problem>(const Values&)> build;
  /// A guess of a solution at the values' parameters, good where the case file's branch is meant to start.
  std::function<continuation::Guess(const continuation::Problem&, const Values&)> guess;
  bool is_driven = false;  ///< whether it depends on time: its solutions are cycles
  /// Of what has orbits alone, not equilibria, what it sets out from, on meshes of one's choice; null of
  /// others. Of `is_piecewise` after a time, where one is given.
  std::function<continuation::OrbitStart(const Values&, const continuation::OrbitOptions&,
                                         std::optional<double> settle)>
      orbit = {};
  bool is_piecewise = false;  ///< whether these are cycles made of pieces; else boundary value problems
  /// F and dF/du at the values over boxes of the unknowns; null where they have no enclosure.
  std::function<EnclosedMap(const Values&)> enclosed = {};
};

/// All of them, in alphabetical order.
const std::vector<LibraryModel>& library();

/// The defaults of a model's settings.
LibraryModel::Values defaults(const LibraryModel& model);

/// The one of this name, or null.
const LibraryModel* find_model(const std::string& name);

}  // namespace arcslip::problems
