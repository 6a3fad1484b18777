#include "run_files.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "certificate_results.hpp"

namespace arcslip {
namespace {

using nlohmann::ordered_json;

ordered_json beginning(const CasePlan& plan) {
  return {{"arcslip", ARCSLIP_VERSION}, {"title", plan.title}, {"case", plan.resolved}};
}

}  // namespace

RunFiles::RunFiles(const std::string& folder, const CasePlan& plan, bool verified)
    : folder_(folder),
      branches_(std::make_unique<AtomicFile>(folder + "/branches.csv")),
      summary_(folder, beginning(plan)) {
  if (!verified) return;
  verification_ = std::make_unique<AtomicFile>(folder + "/verify.csv");
  verification_->write(verification_header());
}

void RunFiles::add(const TracedBranch& traced) {
  const std::size_t number = count_;
  BranchTable table = table_;
  table.widen(traced);
  const std::string rows = table.rows(number, traced);
  ordered_json summary = summarize(number, traced);

  const std::scoped_lock lock(mutex_);
  if (finished_) return;
  write_summary();
  if (widths_.empty()) branches_->write(table.header());
  if (widths_.empty() || table != table_) widths_.emplace_back(rows_, table);
  branches_->write(rows);
  rows_ += traced.branch.points.size();
  table_ = std::move(table);
  last_ = std::move(summary);
  ++count_;
}

void RunFiles::add_failed(const CaseBranch& request, const std::string& why) {
  const std::scoped_lock lock(mutex_);
  if (finished_) return;
  write_summary();
  if (widths_.empty()) branches_->write(table_.header());
  if (widths_.empty()) widths_.emplace_back(0, table_);
  last_ = {{"branch", count_},   {"values", request.values},
           {"points", 0},        {"stop", to_string(continuation::Stop::no_start)},
           {"explanation", why}, {"special", ordered_json::array()},
           {"peak", nullptr}};
  ++count_;
}

void RunFiles::add_certificate(const problems::Certificate& certificate) {
  const std::scoped_lock lock(mutex_);
  last_["certificate"] = certificate_to_json(certificate);
}

void RunFiles::begin_verification() {
  const std::scoped_lock lock(mutex_);
  verifying_ = true;
}

void RunFiles::add(const TracedBranch& traced, const problems::Verification& point) {
  const std::scoped_lock lock(mutex_);
  if (!finished_) verification_->write(verification_row(count_ - 1, traced, point));
}

void RunFiles::end_verification(const VerifiedBranch& verified) {
  const std::scoped_lock lock(mutex_);
  if (finished_) return;
  if (!verified.is_complete()) verification_->write(interrupted_verification_row(count_ - 1));
  verifying_ = false;
}

void RunFiles::write_summary() {
  if (!last_.is_null()) summary_.add(last_);
  last_ = nullptr;
}

/// Branches with more harmonics have more columns: the rows before them get these as well.
void RunFiles::widen_rows() {
  if (widths_.size() < 2) return;
  auto wide = std::make_unique<AtomicFile>(branches_->path());
  wide->write(table_.header());
  std::size_t row = 0;
  bool is_header = true;
  auto width = widths_.begin();
  branches_->for_each_line([&](std::string_view line) {
    if (std::exchange(is_header, false)) return;
    while (std::next(width) != widths_.end() && std::next(width)->first <= row) ++width;
    wide->write(table_.widened(line, width->second) + "\n");
    ++row;
  });
  branches_ = std::move(wide);
}

void RunFiles::finish(double seconds, bool interrupted) {
  const std::scoped_lock lock(mutex_);
  if (finished_) return;
  finished_ = true;
  if (widths_.empty()) branches_->write(table_.header());
  write_summary();
  widen_rows();
  summary_.finish({{"seconds", seconds}, {"interrupted", interrupted}});
  if (verifying_) verification_->write(interrupted_verification_row(count_ - 1));
  branches_->sync();
  summary_.file().sync();
  if (verification_) verification_->sync();
  std::error_code ignored;
  // It belongs to other branches.
  if (!verification_) std::filesystem::remove(folder_ + "/verify.csv", ignored);
  branches_->commit();
  summary_.file().commit();
  if (verification_) verification_->commit();
}

}  // namespace arcslip
