#pragma once

// The branches of a case file, as `arcslip run` traces and writes them.

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "python/binding/branch.hpp"
#include "results/run_files.hpp"
#include "results/run_progress.hpp"

namespace arcslip::python {

class CaseRun;

/// What is done with what is traced.
struct RunWishes {
  bool verify = false;
  bool certify = false;
  std::string folder;                     ///< of the interrupted run to go on with, or empty
  std::shared_ptr<const CaseRun> before;  ///< the same that is at hand, or null
};

class CaseRun {
 public:
  /// Reads the whole file. Throws InputError.
  CaseRun(CaseFile file, RunWishes wishes);

  /// Traces all branches, or those that come before an interruption; into a folder, if one is given, as they
  /// come; an interrupted run leaves a checkpoint there, from which the program goes on. Without the lock.
  /// Throws InputError, OutputError.
  void trace(const std::optional<std::string>& folder, Interruption& interruption);

  /// What the case is warned of before the work.
  std::vector<std::string> warnings() const;

  const std::vector<std::shared_ptr<BranchHandle>>& branches() const { return branches_; }
  /// verify.csv of those that were verified, by their number among `branches`.
  std::map<std::size_t, std::string> verifications() const;
  /// How many branches stand in the folder that was gone on with, before those at hand.
  std::size_t taken_over() const { return taken_over_.size(); }
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
    std::optional<VerifiedBranch> verified;
  };

  void require_provable() const;
  void take_up();
  void add(Entry entry);
  void trace_request(std::size_t i, RunFiles* files, Interruption& interruption);
  void take(TracedBranch traced, RunFiles* files, const Interruption::Tell& tell, Interruption& interruption);
  static void put(RunFiles& files, const Entry& entry);

  CaseFile file_;
  RunWishes wishes_;
  CasePlan plan_;
  std::vector<nlohmann::ordered_json> taken_over_;  ///< the summaries of branches that are in the folder
  std::vector<Entry> entries_;
  std::vector<std::shared_ptr<BranchHandle>> branches_;
  std::vector<std::string> failures_;
  RunProgress progress_;
  std::size_t points_ = 0;
  bool complete_ = true;
  bool interrupted_ = false;
  double seconds_ = 0;
};

}  // namespace arcslip::python
