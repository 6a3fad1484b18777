#pragma once

// How far a run of a case has come, and from where it goes on if it is interrupted.

#include <mutex>
#include <string>

#include "arcslip/cases/runs.hpp"
#include "results/run_checkpoint.hpp"

namespace arcslip {

/// Whether it would go on where it was left.
bool has_more(const TracedBranch& traced);

/// Why a branch is not whole, or nothing if it is: a border beyond which the problem has no regime is an end
/// as good as any, and of a branch traced both ways both parts must have one.
std::string why_not_whole(const continuation::Branch& branch);

/// The same or, of one that is whole, what makes its special points doubtful.
std::string doubt_about(const continuation::Branch& branch);

/// To be told from one thread; another one may settle it at any moment.
class RunProgress {
 public:
  /// Takes up the interrupted run in a folder. Throws InputError, see read_checkpoint.
  void take_up(const std::string& folder, const CasePlan& plan);

  /// Takes up another run of the same case, which has ended.
  void take_up(const RunProgress& before);

  /// Before the first request that is not whole.
  const RunCheckpoint& reached() const { return reached_; }

  /// The journal of a request, `here` being where the run stands before it. It has several entries where
  /// what is traced is proven as well.
  continuation::Journal& begin(const CaseBranch& request, bool proves, const RunCheckpoint& here);

  /// A request that is whole, with so many points.
  void end(std::size_t request, std::size_t points);

  /// Whether nothing is left to go on with.
  bool is_whole() const { return journals_.empty(); }

  /// Leaves a checkpoint in a folder of what is not done, or removes it. Throws OutputError.
  void settle(const std::string& folder, const CasePlan& plan, bool is_cut_short);

 private:
  mutable std::mutex mutex_;
  RunCheckpoint reached_;
  /// Of the first request that had no time to be whole, of those behind it, and of the one under way.
  Journals journals_;
  std::size_t kept_points_ = 0;  ///< of branches behind it that are whole
};

}  // namespace arcslip
