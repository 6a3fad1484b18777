#include "python/binding/run.hpp"

#include <fmt/format.h>

#include <chrono>

#include "arcslip/cases/certification.hpp"
#include "arcslip/version.hpp"
#include "results/output_folder.hpp"

namespace arcslip::python {

using nlohmann::ordered_json;

CaseRun::CaseRun(const CaseFile& file, bool certify)
    : file_(file), plan_(plan_case(file_)), certify_(certify) {
  if (certify_) {
    const std::string why = why_not_certifiable(plan_.branch(0));
    if (!why.empty())
      throw InputError(fmt::format("{}: certify is for forced responses of one contact with linear structures; not for {}",
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
  if (files) files->finish(seconds_, interrupted_);
}

void CaseRun::trace_request(std::size_t i, RunFiles* files, Interruption& interruption) {
  CaseBranch request = plan_.branch(i);
  std::size_t points = 0;
  request.options.go_on = [&] { return interruption.go_on(); };
  const auto watch = [&](const continuation::BranchPoint& point) {
    ++points;
    return interruption.go_on([&] { return py::make_tuple(i, plan_.count, points, point.arclength); });
  };
  std::vector<TracedBranch> traced;
  std::string failure;
  try {
    file_.named("system", [&] { traced = arcslip::trace(request, watch); });
  } catch (const InputError& error) {
    failure = error.what();
  }
  request.options.go_on = {};
  if (!failure.empty()) {
    entries_.push_back({nullptr, request, failure});
    failures_.push_back(failure);
    if (files != nullptr) add(*files, entries_.back());
  }
  for (TracedBranch& one : traced) {
    if (certify_) certify(one);
    branches_.push_back(std::make_shared<BranchHandle>(settled(std::move(one))));
    entries_.push_back({branches_.back(), {}, {}});
    if (files != nullptr) add(*files, entries_.back());
  }
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
  return ordered_json{{"arcslip", release},
                      {"title", plan_.title},
                      {"case", plan_.resolved},
                      {"branches", branches},
                      {"seconds", seconds_},
                      {"interrupted", interrupted_}}
      .dump();
}

}  // namespace arcslip::python
