#pragma once

// What `arcslip run` writes: branches.csv, the same as it is drawn in curves.csv, summary.json and, where it
// is asked for, verify.csv and offsets.csv, of whole rings sectors.csv. Branches go to the disk as they come;
// the files appear together at the end.

#include <mutex>
#include <optional>

#include "arcslip/results/results.hpp"
#include "results/branch_file.hpp"
#include "results/summary_file.hpp"
#include "results/verification_results.hpp"

namespace arcslip {

/// To be filled from one thread; another one may finish it at any moment.
class RunFiles {
 public:
  /// The folder is there. Throws OutputError, as all that follows.
  RunFiles(const std::string& folder, const CasePlan& plan, bool verified);

  /// Begins with the results that stand in the folder, of the first so many branches of an interrupted run.
  /// The header is that of its table by then.
  void take_over(std::size_t branches, const std::string& header);

  std::string header() const { return branches_.header(); }

  /// The next branch. What is told of it afterwards is added to its summary.
  void add(const TracedBranch& traced);

  /// One that no problem could be built for, and why.
  void add_failed(const CaseBranch& request, const std::string& why);

  /// Of the last branch.
  void add_certificate(const problems::Certificate& certificate);
  void begin_verification();
  void add(const TracedBranch& traced, const problems::Verification& point);
  void end_verification(const VerifiedBranch& verified);

  /// How many branches there are.
  std::size_t count() const { return count_; }

  /// Gives the files their names, once. What is marked as interrupted is not complete.
  void finish(double seconds, bool interrupted);

 private:
  void write_summary();
  std::vector<AtomicFile*> further() const;
  void take_over_lines(AtomicFile& file, std::size_t branches);

  std::string folder_;
  bool is_of_ring_;
  std::mutex mutex_;
  bool finished_ = false;
  std::size_t count_ = 0;
  BranchFile branches_;
  BranchFile curves_;
  std::size_t curve_rows_ = 0;
  SummaryFile summary_;
  std::unique_ptr<AtomicFile> verification_;
  std::unique_ptr<AtomicFile> offsets_;  ///< beside it
  /// Rows that some kinds of branches have at their special points.
  struct PointTable {
    std::string (*header)(const TracedBranch&);
    std::string (*rows)(std::size_t, const TracedBranch&);
    std::unique_ptr<AtomicFile> file;
    bool has_header = false;
  };
  std::vector<PointTable> tables_;
  nlohmann::ordered_json last_;  ///< the last branch's summary
  bool verifying_ = false;       ///< whether a verification is not at its end
};

}  // namespace arcslip
