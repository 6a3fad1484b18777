#include "results/run_files.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "arcslip/continuation/path/polyline.hpp"
#include "arcslip/version.hpp"
#include "results/atlas_table.hpp"
#include "results/branch_columns.hpp"
#include "results/certificate_results.hpp"
#include "results/orbit_table.hpp"
#include "results/output.hpp"
#include "results/sector_table.hpp"

namespace arcslip {
namespace {

using nlohmann::ordered_json;

ordered_json beginning(const CasePlan& plan) {
  return {{"arcslip", release}, {"title", plan.title}, {"case", plan.resolved}};
}

constexpr const char* sectors_name = "/sectors.csv";
constexpr const char* orbits_name = "/orbits.csv";
constexpr const char* tori_name = "/tori.csv";
constexpr const char* atlas_name = "/atlas.csv";
constexpr const char* faces_name = "/faces.csv";
constexpr const char* folds_name = "/folds.csv";
constexpr const char* ridges_name = "/ridges.csv";
constexpr std::size_t most_curve_rows = 30'000;  // of more, nothing is seen between the points

/// The branch as a polyline that looks like the curve.
TracedBranch as_drawn(const TracedBranch& traced) {
  Columns columns(traced, BranchTable::Detail::drawn);
  continuation::DrawnPoints found = continuation::polyline(
      traced.branch,
      continuation::index_of(traced.problem().parameter_names(), traced.request->options.parameter),
      [&](const continuation::BranchPoint& point) -> const std::vector<double>& {
        return columns.values(point);
      },
      &traced.problem());
  TracedBranch drawn{traced.request, traced.base, traced.curve, {}};
  drawn.branch.points = std::move(found.points);
  drawn.drawn = std::make_shared<const Matrix>(std::move(found.values));
  return drawn;
}

}  // namespace

RunFiles::RunFiles(const std::string& folder, const CasePlan& plan, bool verified)
    : folder_(folder),
      is_of_ring_(plan.resolved.contains("ring")),
      branches_(folder + "/branches.csv", BranchTable::Detail::full),
      curves_(folder + "/curves.csv", BranchTable::Detail::drawn),
      summary_(folder, beginning(plan)) {
  const auto add_table = [&](const char* place, const char* name, auto header_of, auto rows_of) {
    if (plan.resolved.contains(ordered_json::json_pointer(place)))
      tables_.push_back({header_of, rows_of, std::make_unique<AtomicFile>(folder + name)});
  };
  add_table("/ring", sectors_name, sectors_header, sector_rows);
  add_table("/cycles", orbits_name, orbits_header, orbit_rows);
  add_table("/cycles", tori_name, tori_header, torus_rows);
  add_table("/branch/surface", atlas_name, atlas_header, atlas_rows);
  add_table("/branch/surface", faces_name, faces_header, face_rows);
  add_table("/branch/surface", folds_name, folds_header, fold_rows);
  add_table("/branch/surface", ridges_name, ridges_header, ridge_rows);
  if (!verified) return;
  verification_ = std::make_unique<AtomicFile>(folder + "/verify.csv");
  verification_->write(verification_header());
  offsets_ = std::make_unique<AtomicFile>(folder + "/offsets.csv");
  offsets_->write(offsets_header());
}

void RunFiles::take_over(std::size_t branches, const std::string& header) {
  if (branches == 0) return;
  const ordered_json summary = run_summary(folder_).value_or(ordered_json::object());
  if (!summary.contains("branches") || summary["branches"].size() < branches)
    throw OutputError(folder_ + "/summary.json: the branches of the interrupted run are not there any more");
  branches_.take_over(branches, header);
  curve_rows_ = curves_.take_over(branches, header);
  for (std::size_t i = 0; i < branches; ++i) summary_.add(summary["branches"][i]);
  count_ = branches;
  for (AtomicFile* file : further()) take_over_lines(*file, branches);
}

/// Files that there are beside those of all runs.
std::vector<AtomicFile*> RunFiles::further() const {
  std::vector<AtomicFile*> all;
  for (const auto& file : {verification_.get(), offsets_.get()}) {
    if (file != nullptr) all.push_back(file);
  }
  for (const PointTable& table : tables_) all.push_back(table.file.get());
  return all;
}

/// Those of so many branches, from the file of that name that stands in the folder.
void RunFiles::take_over_lines(AtomicFile& file, std::size_t branches) {
  std::ifstream before(file.path(), std::ios::binary);
  std::string line;
  std::getline(before, line);
  for (PointTable& table : tables_) {
    if (&file != table.file.get() || line.empty()) continue;
    file.write(line + "\n");
    table.has_header = true;
  }
  while (std::getline(before, line) && std::strtoul(line.c_str(), nullptr, 10) < branches)
    file.write(line + "\n");
}

void RunFiles::add(const TracedBranch& traced) {
  BranchFile::Rows rows = branches_.rows(count_, traced);
  // Points of whole rings lie close, and what is told of one costs as much as its solution.
  const bool many = is_of_ring_ || curve_rows_ + traced.branch.points.size() > most_curve_rows;
  BranchFile::Rows curve = curves_.rows(count_, many ? traced : as_drawn(traced));
  ordered_json summary = summarize(count_, traced);
  std::vector<std::string> special;
  for (const PointTable& table : tables_) special.push_back(table.rows(count_, traced));

  const std::scoped_lock lock(mutex_);
  if (finished_) return;
  write_summary();
  curve_rows_ += curve.count;
  branches_.add(std::move(rows));
  curves_.add(std::move(curve));
  for (std::size_t i = 0; i < tables_.size(); ++i) {
    PointTable& table = tables_[i];
    if (special[i].empty()) continue;
    if (!table.has_header) table.file->write(table.header(traced));
    table.has_header = true;
    table.file->write(special[i]);
  }
  last_ = std::move(summary);
  ++count_;
}

void RunFiles::add_failed(const CaseBranch& request, const std::string& why) {
  const std::scoped_lock lock(mutex_);
  if (finished_) return;
  write_summary();
  last_ = summary_of_failed(count_, request, why);
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
  if (finished_) return;
  verification_->write(verification_row(count_ - 1, traced, point));
  offsets_->write(offset_rows(count_ - 1, traced, point));
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

void RunFiles::finish(double seconds, bool interrupted) {
  const std::scoped_lock lock(mutex_);
  if (finished_) return;
  finished_ = true;
  write_summary();
  summary_.finish({{"seconds", seconds}, {"interrupted", interrupted}});
  if (verifying_) verification_->write(interrupted_verification_row(count_ - 1));
  branches_.finish();
  curves_.finish();  // the later one: pictures are drawn from it
  summary_.file().sync();
  for (AtomicFile* file : further()) file->sync();
  std::error_code ignored;
  for (const char* name : {"/verify.csv", "/offsets.csv"}) {  // they belong to other branches
    if (!verification_) std::filesystem::remove(folder_ + name, ignored);
  }
  std::erase_if(tables_, [](const PointTable& table) { return !table.has_header; });  // without a row
  for (const char* name : {sectors_name, orbits_name, tori_name, atlas_name, faces_name, folds_name}) {
    const auto is_own = [&](const PointTable& table) { return table.file->path() == folder_ + name; };
    if (std::none_of(tables_.begin(), tables_.end(), is_own))
      std::filesystem::remove(folder_ + name, ignored);
  }
  branches_.commit();
  curves_.commit();
  summary_.file().commit();
  for (AtomicFile* file : further()) file->commit();
}

}  // namespace arcslip
