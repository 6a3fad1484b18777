#pragma once

// Case files of preload studies: [system], [geometry], [study], [study.uncertain] and [continuation].

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "arcslip/cases/case_file.hpp"
#include "arcslip/problems/ridges/uncertainty.hpp"

namespace arcslip {

/// One system of a study.
struct StudyDesign {
  nlohmann::ordered_json values;                   ///< what `for_each` sets on it, by key
  SystemParameters system;                         ///< with its values set
  std::optional<Geometry> geometry;                ///< where rings are given in SI units
  std::optional<PhysicalScale> physical;           ///< of a system that is given in SI units
  std::optional<double> harmonics_tolerance = {};  ///< where harmonics are added as the best preload asks for
  const StructureKind* structure = nullptr;        ///< what base and damper are
  problems::PreloadRange range = {};               ///< that is swept, with the window
  std::size_t pattern = 0;                         ///< of those of a whole ring, 0 being the equal one

  /// Its forced response.
  ProblemRequest problem() const;
};

/// A study of `count` designs, which are made when asked for, from several threads: there may be millions.
struct StudyCase {
  std::string title;                   ///< of the file, or empty
  nlohmann::ordered_json resolved;     ///< the input with its defaults filled in
  std::vector<std::string> keys;       ///< of for_each, in the order of the columns of optimum.csv
  problems::PreloadRange range;        ///< as it is given, in the units of `preload_as` and `frequency_as`
  std::string preload_as = "P";        ///< what the range is of, perhaps with a unit: "preload_N_per_m"
  std::string frequency_as = "eta";    ///< what the window is of, or "frequency_Hz"
  std::string objective = "Y";         ///< the observable whose peaks are to be low
  continuation::TraceOptions options;  ///< tolerance and limits
  bool sweep = true;                   ///< whether sweep.csv is wanted beside optimum.csv
  std::optional<problems::Uncertainty> uncertain;  ///< what scatters, if anything does
  std::string preload_unit = {};                   ///< of designs in SI units, as PhysicalScale has it; or ""
  std::size_t count = 1;                           ///< of designs
  std::size_t patterns = 0;  ///< of whole rings: how many of each design are made, besides the equal ring
  std::function<StudyDesign(std::size_t)> design;  ///< the i-th item

  /// What is studied by itself: a design or, of one with patterns, the equal ring and after it each of them.
  std::size_t each() const { return patterns + 1; }
  std::size_t items() const { return count * each(); }
};

/// Checks the whole file, with all of its designs. Throws InputError.
StudyCase read_study(const CaseFile& file);
StudyCase read_study(const std::string& path, const std::vector<std::string>& settings = {});

}  // namespace arcslip
