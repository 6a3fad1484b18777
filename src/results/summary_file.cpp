#include "results/summary_file.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <system_error>

namespace arcslip {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

bool is_file(const fs::path& path) {
  std::error_code none;
  return fs::is_regular_file(path, none);
}

/// The folder's summary.json; null where it is none.
ordered_json read_summary(const std::string& folder) {
  const fs::path path = fs::path(folder) / "summary.json";
  if (!is_file(path)) return nullptr;
  std::ifstream file(path, std::ios::binary);
  const ordered_json summary = ordered_json::parse(file, nullptr, false);
  return summary.is_object() ? summary : ordered_json(nullptr);
}

/// As it stands within an object, two blanks for each level.
std::string dumped(const ordered_json& value, int level) {
  std::string text;
  for (const char c : value.dump(2, ' ', false, ordered_json::error_handler_t::replace)) {
    text += c;
    if (c == '\n') text.append(static_cast<std::size_t>(2 * level), ' ');
  }
  return text;
}

/// The entries of an object as they stand in one.
std::string entries(const ordered_json& object) {
  std::string text;
  for (const auto& [key, value] : object.items())
    text += fmt::format("{}\n  {}: {}", text.empty() ? "" : ",", ordered_json(key).dump(), dumped(value, 1));
  return text;
}

}  // namespace

std::optional<ordered_json> run_summary(const std::string& folder) {
  ordered_json summary = read_summary(folder);
  if (!summary.contains("branches") || !is_file(fs::path(folder) / "branches.csv")) return std::nullopt;
  summary.erase("study");
  return summary;
}

std::optional<ordered_json> study_summary(const std::string& folder) {
  const ordered_json summary = read_summary(folder);
  if (!is_file(fs::path(folder) / "optimum.csv")) return std::nullopt;
  const auto is_study = [](const ordered_json& one) {
    const auto input = one.find("case");
    return input != one.end() && input->is_object() && input->contains("study");
  };
  const auto within = summary.find("study");
  if (within != summary.end() && is_study(*within)) return *within;
  if (is_study(summary)) return summary;
  return std::nullopt;
}

void forget_study(const std::string& folder) {
  const ordered_json summary = read_summary(folder);
  const std::optional<ordered_json> of_run = run_summary(folder);
  if (!of_run) {
    std::error_code none;
    fs::remove(fs::path(folder) / "summary.json", none);
  } else if (summary.contains("study")) {
    AtomicFile file(folder + "/summary.json");
    file.write(of_run->dump(2) + "\n");
    file.commit();
  }
}

SummaryFile::SummaryFile(const std::string& folder, const ordered_json& beginning)
    : file_(folder + "/summary.json"), study_(study_summary(folder)) {
  file_.write(fmt::format("{{{},\n  \"branches\": [", entries(beginning)));
}

void SummaryFile::add(const ordered_json& branch) {
  file_.write(first_ ? "\n    " : ",\n    ");
  file_.write(dumped(branch, 2));
  first_ = false;
}

void SummaryFile::finish(const ordered_json& end) {
  ordered_json rest = end;
  if (study_) rest["study"] = *study_;
  file_.write(fmt::format("{}],{}\n}}\n", first_ ? "" : "\n  ", entries(rest)));
}

}  // namespace arcslip
