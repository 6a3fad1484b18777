#pragma once

// The branches of a case file, as `arcslip run` traces and writes them.

#include <memory>
#include <string>
#include <vector>

#include "python/binding/branch.hpp"
#include "results/run_checkpoint.hpp"
#include "results/run_files.hpp"

namespace arcslip::python {

class CaseRun {
 public:
  /// Reads the whole file. Throws InputError.
  CaseRun(CaseFile file, bool certify);

  /// Traces all branches, or those that come before an interruption; into a folder, if one is given, as they
  /// come; an interrupted run leaves a checkpoint there, from which the program goes on. Without the lock.
  /// Throws InputError, OutputError.
  void trace(const std::optional<std::string>& folder, Interruption& interruption);

  const std::vector<std::shared_ptr<BranchHandle>>& branches() const { return branches_; }
  /// Why no problem could be built for some.
  const std::vector<std::string>& failures() const { return failures_; }
  bool interrupted() const { return interrupted_; }
  double seconds() const { return seconds_; }
  const std::string& title() const { return plan_.title; }

  /// summary.json.
  std::string summary() const;

  /// The files of a run in a folder. Throws OutputError.
  void write(const std::string& folder) const;

 private:
  /// A branch, or why there is none.
  struct Entry {
    std::shared_ptr<BranchHandle> branch;
    CaseBranch request;
    std::string failure;
  };

  void trace_request(std::size_t i, RunFiles* files, Interruption& interruption);
  void take(TracedBranch traced, RunFiles* files);
  static void add(RunFiles& files, const Entry& entry);
  continuation::Journal& journal_of(std::size_t request, bool has_several, const RunFiles& files);
  void forget(std::size_t request, const std::vector<TracedBranch>& traced);

  CaseFile file_;
  CasePlan plan_;
  bool certify_;
  std::vector<Entry> entries_;
  std::vector<std::shared_ptr<BranchHandle>> branches_;
  std::vector<std::string> failures_;
  RunCheckpoint reached_;  ///< before the first request that has a journal
  Journals journals_;      ///< of the first request that is not whole and those behind it
  std::size_t kept_points_ = 0;
  std::size_t points_ = 0;
  bool complete_ = true;
  bool interrupted_ = false;
  double seconds_ = 0;
};

}  // namespace arcslip::python
