#pragma once

// summary.json: what a run and a study of one folder say of themselves.
//
// A run's summary has its branches, a study's its designs. Where a folder holds the results of both, the
// study's stands within the run's, as "study".

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "results/atomic_file.hpp"

namespace arcslip {

/// The summary of a folder's run without that of its study, or the study's; none where there are no such
/// results.
std::optional<nlohmann::ordered_json> run_summary(const std::string& folder);
std::optional<nlohmann::ordered_json> study_summary(const std::string& folder);

/// Takes what is said of a study out of the summary. Throws OutputError.
void forget_study(const std::string& folder);

/// A run's summary, which is written branch by branch.
class SummaryFile {
 public:
  /// What comes before the branches, at least one entry. Keeps the summary of the folder's study. Throws
  /// OutputError.
  SummaryFile(const std::string& folder, const nlohmann::ordered_json& beginning);

  void add(const nlohmann::ordered_json& branch);

  /// What comes after the branches.
  void finish(const nlohmann::ordered_json& end);

  AtomicFile& file() { return file_; }

 private:
  AtomicFile file_;
  std::optional<nlohmann::ordered_json> study_;
  bool first_ = true;
};

}  // namespace arcslip
