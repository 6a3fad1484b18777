#pragma once

// What a study of patterns says of each of its designs, whole rings as they are made: quantiles of the
// highest peak over the patterns, in robust.csv and quantiles.csv, and the amplification by them, the highest
// peak over that of the equal ring at the same preload.

#include <string>
#include <vector>

#include "results/study_store.hpp"

namespace arcslip {

/// One design.
struct DesignPatterns {
  std::size_t curve = 0;           ///< of for_each
  problems::UncertainPeaks peaks;  ///< empty where fewer than two patterns, or not the equal ring, are known
  std::vector<double> equal = {};  ///< highest peak of the equal ring, for each row of `peaks`
  double equal_at_best = 0;        ///< the same where the 95 % quantile is lowest
  double optimum = 0;              ///< best preload of the equal ring
  std::size_t failed = 0;          ///< patterns without a result
};

/// Of all designs of a study of patterns, in their order.
std::vector<DesignPatterns> design_patterns(const StudyCase& study, const StudyStore& store);

/// The two files. The first has a row for each design, the second one for each nominal preload.
void write_pattern_robust(const StudyCase& study, const std::vector<DesignPatterns>& designs,
                          const Sink& sink);
void write_pattern_quantiles(const StudyCase& study, const std::vector<DesignPatterns>& designs,
                             const Sink& sink);

}  // namespace arcslip
