#include "python/binding/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "arcslip/cases/certification.hpp"
#include "arcslip/version.hpp"
#include "cases/case_warnings.hpp"
#include "results/output_folder.hpp"
#include "results/summary_file.hpp"

namespace arcslip::python {

using nlohmann::ordered_json;

CaseRun::CaseRun(CaseFile file, RunWishes wishes)
    : file_(std::move(file)), wishes_(std::move(wishes)), plan_(plan_case(file_)) {
  require_provable();
  file_.named("system", [&] { build(plan_.branch(0).problem); });
  take_up();
}

void CaseRun::require_provable() const {
  const CaseBranch first = plan_.branch(0);
  if (wishes_.verify) {
    std::string why = why_not_verifiable(first);
    for (const PlacedElement& element : first.problem.system.others) {
      if (element.own) why = "elements of one's own, which the ring in time does not know";
    }
    if (!why.empty())
      throw InputError(fmt::format("{}: verify is for forced responses, not for {}", file_.path(), why));
  }
  if (!wishes_.certify) return;
  const std::string why = why_not_certifiable(first);
  if (!why.empty())
    throw InputError(
        fmt::format("{}: certify is for forced responses of one contact with linear structures; not for {}",
                    file_.path(), why));
}

/// Begins where an earlier run was left.
void CaseRun::take_up() {
  if (!wishes_.folder.empty()) {
    try {
      progress_.take_up(wishes_.folder, plan_);
    } catch (const InputError& error) {
      std::string text = error.what();  // the program's option is an argument here
      for (std::size_t at = 0; (at = text.find("--resume", at)) != std::string::npos;) text.erase(at, 2);
      throw InputError(text);
    }
    const ordered_json summary = run_summary(wishes_.folder).value_or(ordered_json::object());
    for (std::size_t i = 0; i < progress_.reached().branches; ++i)
      taken_over_.push_back(summary.at("branches").at(i));
  } else if (wishes_.before) {
    const CaseRun& before = *wishes_.before;
    const std::string other = case_difference(before.plan_.resolved, plan_.resolved);
    if (!other.empty())
      throw InputError(fmt::format("resume: it is a run of another case, which differs in {}", other));
    taken_over_ = before.taken_over_;
    progress_.take_up(before.progress_);
    for (std::size_t i = 0; i + taken_over_.size() < progress_.reached().branches; ++i)
      add(before.entries_[i]);
  }
  points_ = progress_.reached().points;
  complete_ = progress_.reached().complete;
}

void CaseRun::add(Entry entry) {
  if (entry.branch) {
    branches_.push_back(entry.branch);
  } else {
    failures_.push_back(entry.failure);
  }
  entries_.push_back(std::move(entry));
}

std::vector<std::string> CaseRun::warnings() const {
  std::vector<std::string> all;
  file_.named("system", [&] { all = warnings_of(plan_); });
  return all;
}

void CaseRun::trace(const std::optional<std::string>& folder, Interruption& interruption) {
  const auto start = std::chrono::steady_clock::now();
  const auto seconds = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  std::optional<OutputFolder> held;
  std::unique_ptr<RunFiles> files;
  if (folder) {
    held.emplace(*folder);
    files = std::make_unique<RunFiles>(*folder, plan_, wishes_.verify);
    files->take_over(taken_over_.size(), progress_.reached().header);
    for (const Entry& entry : entries_) put(*files, entry);
  }
  for (std::size_t i = progress_.reached().requests; i < plan_.count && interruption.go_on(); ++i)
    trace_request(i, files.get(), interruption);
  interrupted_ = interruption.is_stopped();
  seconds_ = seconds();
  if (!files) return;
  files->finish(seconds_, interrupted_);
  progress_.settle(*folder, plan_, interrupted_);
}

namespace {

bool is_whole(const TracedBranch& traced) {
  return why_not_whole(traced.branch).empty() && (!traced.certificate || traced.certificate->proven());
}

}  // namespace

void CaseRun::trace_request(std::size_t i, RunFiles* files, Interruption& interruption) {
  CaseBranch request = plan_.branch(i);
  std::size_t points = 0;
  request.options.go_on = [&] { return interruption.go_on(); };
  const std::size_t before = points_;
  request.options.journal =
      &progress_.begin(request, wishes_.verify || wishes_.certify,
                       {i, taken_over_.size() + entries_.size(), points_, complete_,
                        files != nullptr ? files->header() : progress_.reached().header});
  double arclength = 0;
  const Interruption::Tell tell = [&] { return py::make_tuple(i, plan_.count, points, arclength); };
  const auto watch = [&](const continuation::BranchPoint& point) {
    ++points;
    arclength = point.arclength;
    return interruption.go_on(tell);
  };
  std::vector<TracedBranch> traced;
  try {
    file_.named("system", [&] { traced = arcslip::trace(request, watch); });
  } catch (const InputError& error) {
    request.options.go_on = {};
    request.options.journal = nullptr;
    add({nullptr, request, error.what(), {}});
    complete_ = false;
    if (files != nullptr) put(*files, entries_.back());
  }
  const bool is_left = std::any_of(traced.begin(), traced.end(), has_more);
  for (TracedBranch& one : traced) take(std::move(one), files, tell, interruption);
  if (!interruption.is_stopped() && !is_left) progress_.end(i, points_ - before);
}

void CaseRun::take(TracedBranch traced, RunFiles* files, const Interruption::Tell& tell,
                   Interruption& interruption) {
  if (wishes_.certify) certify(traced);
  complete_ = complete_ && is_whole(traced);
  points_ += traced.branch.points.size();
  Entry entry{std::make_shared<BranchHandle>(settled(std::move(traced))), {}, {}, {}};
  if (files != nullptr) entry.branch->table();  // which is told once, for the files and for Python
  if (wishes_.verify) {
    problems::VerifyOptions options;
    options.progress = [&](std::size_t, std::size_t) { return interruption.go_on(tell); };
    entry.verified = verify(taken_over_.size() + entries_.size(), entry.branch->traced(), std::move(options));
  }
  if (files != nullptr) put(*files, entry);
  add(std::move(entry));
}

void CaseRun::put(RunFiles& files, const Entry& entry) {
  if (!entry.branch) return files.add_failed(entry.request, entry.failure);
  const TracedBranch& traced = entry.branch->traced();
  files.add(traced);
  if (traced.certificate) files.add_certificate(*traced.certificate);
  if (!entry.verified) return;
  files.begin_verification();
  for (const problems::Verification& point : entry.verified->points) files.add(traced, point);
  files.end_verification(*entry.verified);
}

void CaseRun::write(const std::string& folder) const {
  const OutputFolder held(folder);
  RunFiles files(folder, plan_, wishes_.verify);
  for (const Entry& entry : entries_) put(files, entry);
  files.finish(seconds_, interrupted_);
}

std::map<std::size_t, std::string> CaseRun::verifications() const {
  std::map<std::size_t, std::string> all;
  std::size_t number = 0;
  for (const Entry& entry : entries_) {
    if (entry.verified) {
      std::string& text = all[number] = verification_header();
      for (const problems::Verification& point : entry.verified->points)
        text += verification_row(entry.verified->number, entry.branch->traced(), point);
    }
    if (entry.branch) ++number;
  }
  return all;
}

std::string CaseRun::summary() const {
  ordered_json branches = ordered_json::array();
  for (const ordered_json& one : taken_over_) branches.push_back(one);
  for (const Entry& entry : entries_) {
    const std::size_t number = branches.size();
    branches.push_back(entry.branch ? summarize(number, entry.branch->traced())
                                    : summary_of_failed(number, entry.request, entry.failure));
  }
  return ordered_json{{"arcslip", release},   {"title", plan_.title}, {"case", plan_.resolved},
                      {"branches", branches}, {"seconds", seconds_},  {"interrupted", interrupted_}}
      .dump();
}

}  // namespace arcslip::python
