#include "results/run_progress.hpp"

#include <fmt/format.h>

#include <sstream>

namespace arcslip {
namespace {

constexpr std::size_t most_kept = 1'000'000;  // points; branches with more are traced again

}  // namespace

bool has_more(const TracedBranch& traced) {
  const auto& first = traced.branch.first_stop;
  return is_unfinished(traced.branch.stop) || (first && is_unfinished(*first));
}

std::string why_not_whole(const continuation::Branch& branch) {
  if (!is_end(branch.stop)) return fmt::format("{}: {}", to_string(branch.stop), branch.explanation);
  if (branch.first_stop && !is_end(*branch.first_stop))
    return fmt::format("{}, before the start: {}", to_string(*branch.first_stop), branch.first_explanation);
  return "";
}

std::string doubt_about(const continuation::Branch& branch) {
  const std::string why = why_not_whole(branch);
  return why.empty() ? branch.warning : why;
}

void RunProgress::take_up(const std::string& folder, const CasePlan& plan) {
  reached_ = read_checkpoint(folder, plan, journals_);
}

void RunProgress::take_up(const RunProgress& before) {
  reached_ = before.reached_;
  for (const auto& [request, journal] : before.journals_) {
    std::stringstream text;
    journal.write(text);
    journals_[request].read(text);
  }
}

/// Notes where the run stands before a request, unless one before is to be gone on with.
continuation::Journal& RunProgress::begin(const CaseBranch& request, bool proves, const RunCheckpoint& here) {
  const bool has_several = proves || request.curve || request.switching || request.all_solutions ||
                           request.start || request.problem.harmonics_tolerance;
  const std::scoped_lock lock(mutex_);
  if (journals_.empty() || journals_.begin()->first >= here.requests) reached_ = here;
  const auto [place, is_new] = journals_.try_emplace(here.requests);
  if (is_new) place->second.begin(has_several || place != journals_.begin());
  return place->second;
}

/// Drops its journal, but for some behind one that is not whole.
void RunProgress::end(std::size_t request, std::size_t points) {
  const std::scoped_lock lock(mutex_);
  const bool is_first = journals_.begin()->first == request;
  if (!is_first) kept_points_ += points;
  if (is_first || kept_points_ > most_kept) journals_.erase(request);
}

void RunProgress::settle(const std::string& folder, const CasePlan& plan, bool is_cut_short) {
  const std::scoped_lock lock(mutex_);
  if (!is_cut_short && journals_.empty()) return remove_checkpoint(folder);
  write_checkpoint(folder, plan, reached_, journals_);
}

}  // namespace arcslip
