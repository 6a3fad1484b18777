#pragma once

// The answer in words: what a run or a study found, in sentences that stand by themselves, in the units of
// the case. A study may end with them, and a report begins with them.

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "results/result_table.hpp"

namespace arcslip {

/// The best preload of a design. Preloads, amplitudes and frequencies are in the units of `Findings`.
struct BestPreload {
  std::string design;     ///< what for_each sets on it, "mass_ratio = 5"; empty of a single design
  std::string kind;       ///< of the optimum, as in optimum.csv, or "failed"
  double preload = 0;     ///< where the highest peak is lowest
  double low = 0;         ///< the peak stays within a factor 2 from here ...
  double high = 0;        ///< ... to here
  bool from_end = false;  ///< whether `low` is where the range that was looked at begins
  bool to_end = false;    ///< whether `high` is where it ends
  double frequency = 0;   ///< of that peak
  double peak = 0;        ///< its height
  double ratio = 0;       ///< of it to the highest peak without damper; nan where the objective has none

  /// Where friction, preload or force scatter.
  struct Scatter {
    double preload = 0;       ///< where the 95 % quantile of the highest peak is lowest
    double peak = 0;          ///< that quantile there
    double peak_at_best = 0;  ///< and at the best preload without scatter
  };
  std::optional<Scatter> scatter = {};
};

/// What a study found.
struct Findings {
  /// Of preloads, "N/m" or "N", beside frequencies in Hz and amplitudes in m; "": all nondimensional.
  std::string preload_unit = {};
  std::string objective = "Y";  ///< the quantity whose highest peak is to be low
  std::vector<BestPreload> designs;
};

/// The best preload and what it gives, of several designs that of the one on which the damper does most, and
/// between what the others lie.
std::vector<std::string> study_answer(const Findings& findings);

/// What optimum.csv and, where something scatters, robust.csv tell; `input` is the study's resolved case.
/// Throws InputError, nlohmann's exceptions where the case is none.
Findings findings_of(const nlohmann::ordered_json& input, const ResultTable& optimum,
                     const ResultTable* robust);

/// The answer of the study whose tables are in `folder`; `input` is its resolved case. Throws as
/// `findings_of`.
std::vector<std::string> study_answer(const std::string& folder, const nlohmann::ordered_json& input);

/// A length with four digits in the unit, m to nm, that leaves one to three of them before the point.
std::string length_text(double metres);

/// "mass_ratio = 5", "damper.width = 0.012 m": what for_each sets, with its unit where [geometry] gives it
/// one.
std::string setting_text(const std::string& key, const std::string& value);

/// The peaks of a run, where the lowest of the highest ones is, what else was found, whether branches came to
/// their ends and are certified; `summary` is that of the run. Throws nlohmann's exceptions where it is none.
std::vector<std::string> run_answer(const nlohmann::ordered_json& summary);

/// How far verify.csv says that the points which were solved anew are from those traced; empty where none
/// was. Throws InputError.
std::string verification_answer(const ResultTable& verified);

}  // namespace arcslip
