#pragma once

// The branches of a case file, as `arcslip run` traces and writes them.

#include <memory>
#include <string>
#include <vector>

#include "python/binding/branch.hpp"
#include "results/run_files.hpp"

namespace arcslip::python {

class CaseRun {
 public:
  /// Reads the whole file. Throws InputError.
  CaseRun(const CaseFile& file, bool certify);

  /// Traces all branches, or those that come before an interruption; into a folder, if one is given, as they
  /// come. Without the lock. Throws InputError, OutputError.
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
  static void add(RunFiles& files, const Entry& entry);

  CaseFile file_;
  CasePlan plan_;
  bool certify_;
  std::vector<Entry> entries_;
  std::vector<std::shared_ptr<BranchHandle>> branches_;
  std::vector<std::string> failures_;
  bool interrupted_ = false;
  double seconds_ = 0;
};

}  // namespace arcslip::python
