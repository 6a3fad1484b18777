#pragma once

// A study's results as files and tables.

#include <nlohmann/json.hpp>
#include <string>

#include "results/study_harmonics.hpp"

namespace arcslip {

/// What a run of the program did.
struct StudyWork {
  std::size_t computed = 0;  ///< designs
  double seconds = 0;
  std::vector<HarmonicsCheck> checks = {};  ///< of best preloads in more harmonics
  std::size_t threads = 1;                  ///< that computed

  double rate() const { return seconds > 0 ? static_cast<double>(computed) / seconds : 0; }
};

/// "90 s", "3 min", "2.5 h".
std::string in_words(double seconds);

/// What a study will cost, once the first designs tell it: "20000 designs on 2 threads, 1.1 s each: about
/// 3.1 h". Empty before, and of one that takes less than a minute.
std::string plan_of(std::size_t designs, const StudyWork& work);

/// Writes optimum.csv, sweep.csv, robust.csv and quantiles.csv as asked for, and summary.json. Throws
/// OutputError.
void write_results(const std::string& folder, const StudyCase& study, const StudyStore& store,
                   const StudyWork& work);

/// One row for each design up to a few dozen.
std::string study_table(const StudyCase& study, const StudyStore& store, const StudyWork& work);

}  // namespace arcslip
