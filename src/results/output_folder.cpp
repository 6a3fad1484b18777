#include "results/output_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <vector>

#include "results/output.hpp"

namespace arcslip {
namespace {

namespace fs = std::filesystem;

/// The process that a temporary file of ours belongs to, "NAME.PROCESS.tmp" or "NAME.PROCESS-NUMBER.tmp"; 0
/// of any other file.
pid_t owner_of(std::string_view name) {
  for (const std::string_view end : {".tmp-journal", ".tmp"}) {  // a database leaves its journal beside it
    if (!name.ends_with(end)) continue;
    name.remove_suffix(end.size());
    const std::size_t dot = name.rfind('.');
    if (dot == std::string_view::npos) return 0;
    const std::string_view digits = name.substr(dot + 1);
    const fs::path of_result = name.substr(0, dot);
    constexpr std::array endings = {".csv", ".json", ".sqlite", ".png",       ".svg",
                                    ".mtx", ".txt",  ".toml",   ".checkpoint"};
    if (std::find(endings.begin(), endings.end(), of_result.extension()) == endings.end()) return 0;
    pid_t process = 0;
    const auto [last, error] = std::from_chars(digits.data(), digits.data() + digits.size(), process);
    return error == std::errc{} && (last == digits.data() + digits.size() || *last == '-') ? process : 0;
  }
  return 0;
}

}  // namespace

OutputFolder::OutputFolder(std::string path) : path_(std::move(path)) {
  std::error_code error;
  fs::create_directories(path_, error);
  if (!error && !fs::is_directory(path_, error)) error = std::make_error_code(std::errc::not_a_directory);
  if (error) throw OutputError(fmt::format("{}: the folder cannot be made: {}", path_, error.message()));
  lock();
  remove_leftovers();
}

OutputFolder::~OutputFolder() {
  if (descriptor_ >= 0) close(descriptor_);
}

/// Where folders cannot be locked, as on some network file systems, does without.
void OutputFolder::lock() {
  descriptor_ = open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor_ < 0 || flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  close(descriptor_);
  throw OutputError(fmt::format("{}: cannot be written: another arcslip is writing there", path_));
}

void OutputFolder::remove_leftovers() const {
  std::error_code ignored;
  std::vector<fs::path> leftovers;
  const fs::directory_iterator end;
  for (fs::directory_iterator entry(path_, ignored); entry != end; entry.increment(ignored)) {
    const pid_t owner = owner_of(entry->path().filename().native());
    if (owner > 0 && kill(owner, 0) != 0 && errno == ESRCH) leftovers.push_back(entry->path());
  }
  for (const fs::path& leftover : leftovers) fs::remove(leftover, ignored);
}

}  // namespace arcslip
