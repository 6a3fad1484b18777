#include "python/binding/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "arcslip/cases/certification.hpp"
#include "arcslip/version.hpp"
#include "results/output_folder.hpp"

namespace arcslip::python {

using nlohmann::ordered_json;

CaseRun::CaseRun(CaseFile file, bool certify)
    : file_(std::move(file)), plan_(plan_case(file_)), certify_(certify) {
  if (certify_) {
    const std::string why = why_not_certifiable(plan_.branch(0));
    if (!why.empty())
      throw InputError(
          fmt::format("{}: certify is for forced responses of one contact with linear structures; not for {}",
                      file_.path(), why));
  }
  file_.named("system", [&] { build(plan_.branch(0).problem); });
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
    files = std::make_unique<RunFiles>(*folder, plan_, false);
  }
  for (std::size_t i = 0; i < plan_.count && interruption.go_on(); ++i)
    trace_request(i, files.get(), interruption);
  interrupted_ = interruption.is_stopped();
  seconds_ = seconds();
  if (!files) return;
  files->finish(seconds_, interrupted_);
  if (!interrupted_ && journals_.empty()) {
    remove_checkpoint(*folder);
  } else {
    write_checkpoint(*folder, plan_, reached_, journals_);
  }
}

namespace {

/// Whether it would go on where it was left.
bool has_more(const TracedBranch& traced) {
  const auto& first = traced.branch.first_stop;
  return is_unfinished(traced.branch.stop) || (first && is_unfinished(*first));
}

bool is_whole(const TracedBranch& traced) {
  const auto& first = traced.branch.first_stop;
  return is_end(traced.branch.stop) && (!first || is_end(*first)) &&
         (!traced.certificate || traced.certificate->proven());
}

}  // namespace

continuation::Journal& CaseRun::journal_of(std::size_t request, bool has_several, const RunFiles& files) {
  if (journals_.empty()) reached_ = {request, files.count(), points_, complete_, files.header()};
  const auto [place, is_new] = journals_.try_emplace(request);
  place->second.begin(has_several || place != journals_.begin());
  return place->second;
}

/// Of a request that is whole, unless one before it is not: of those behind it some are kept.
void CaseRun::forget(std::size_t request, const std::vector<TracedBranch>& traced) {
  constexpr std::size_t most_kept = 1'000'000;
  if (journals_.begin()->first != request) {
    for (const TracedBranch& one : traced) kept_points_ += one.branch.points.size();
    if (kept_points_ <= most_kept) return;
  }
  journals_.erase(request);
}

void CaseRun::trace_request(std::size_t i, RunFiles* files, Interruption& interruption) {
  CaseBranch request = plan_.branch(i);
  std::size_t points = 0;
  request.options.go_on = [&] { return interruption.go_on(); };
  if (files != nullptr) {
    const bool has_several = request.curve || request.switching || request.all_solutions || request.start ||
                             request.problem.harmonics_tolerance || certify_;
    request.options.journal = &journal_of(i, has_several, *files);
  }
  const auto watch = [&](const continuation::BranchPoint& point) {
    ++points;
    return interruption.go_on([&] { return py::make_tuple(i, plan_.count, points, point.arclength); });
  };
  std::vector<TracedBranch> traced;
  try {
    file_.named("system", [&] { traced = arcslip::trace(request, watch); });
  } catch (const InputError& error) {
    request.options.go_on = {};
    entries_.push_back({nullptr, request, error.what()});
    failures_.emplace_back(error.what());
    complete_ = false;
    if (files != nullptr) add(*files, entries_.back());
  }
  if (files != nullptr && !interruption.is_stopped() && std::none_of(traced.begin(), traced.end(), has_more))
    forget(i, traced);
  for (TracedBranch& one : traced) take(std::move(one), files);
}

void CaseRun::take(TracedBranch traced, RunFiles* files) {
  if (certify_) certify(traced);
  complete_ = complete_ && is_whole(traced);
  points_ += traced.branch.points.size();
  branches_.push_back(std::make_shared<BranchHandle>(settled(std::move(traced))));
  entries_.push_back({branches_.back(), {}, {}});
  if (files == nullptr) return;
  branches_.back()->table();  // which is told once, for the files and for Python
  add(*files, entries_.back());
}

void CaseRun::add(RunFiles& files, const Entry& entry) {
  if (!entry.branch) return files.add_failed(entry.request, entry.failure);
  const TracedBranch& traced = entry.branch->traced();
  files.add(traced);
  if (traced.certificate) files.add_certificate(*traced.certificate);
}

void CaseRun::write(const std::string& folder) const {
  const OutputFolder held(folder);
  RunFiles files(folder, plan_, false);
  for (const Entry& entry : entries_) add(files, entry);
  files.finish(seconds_, interrupted_);
}

std::string CaseRun::summary() const {
  ordered_json branches = ordered_json::array();
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
