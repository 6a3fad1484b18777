#include "results/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "results/output.hpp"

namespace arcslip {
namespace {

namespace fs = std::filesystem;

constexpr mode_t for_all = 0666;  // but for what the user's mask takes away

/// By which a file without a name is reached.
std::string link_to(int descriptor) { return fmt::format("/proc/self/fd/{}", descriptor); }

}  // namespace

AtomicFile::AtomicFile(std::string path, Hidden hidden)
    : path_(std::move(path)),
      temporary_(fmt::format("{}.{}.tmp", path_, getpid())),
      file_(nullptr, &std::fclose) {
  std::error_code ignored;
  if (fs::is_directory(path_, ignored)) {
    errno = EISDIR;
    fail();
  }
  int descriptor = hidden == Hidden::without_name ? open_unnamed() : -1;
  if (descriptor < 0) descriptor = open_named();
  if (descriptor >= 0) file_.reset(fdopen(descriptor, "w+b"));
  if (!file_) fail();
}

AtomicFile::~AtomicFile() {
  if (named_) unlink(temporary_.c_str());
}

int AtomicFile::open_unnamed() const {
  const fs::path folder = fs::path(path_).parent_path();
  const int descriptor = open(folder.empty() ? "." : folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, for_all);
  if (descriptor < 0 || access(link_to(descriptor).c_str(), F_OK) == 0) return descriptor;
  close(descriptor);
  return -1;
}

int AtomicFile::open_named() {
  int descriptor = -1;
  for (int i = 0; descriptor < 0 && i < 100; ++i) {
    temporary_ = fmt::format("{}.{}-{}.tmp", path_, getpid(), i);
    descriptor = open(temporary_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, for_all);
    if (descriptor < 0 && errno != EEXIST) break;
  }
  named_ = descriptor >= 0;
  return descriptor;
}

void AtomicFile::write(std::string_view text) {
  is_synced_ = false;
  if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size()) fail();
}

int AtomicFile::descriptor() const { return fileno(file_.get()); }

void AtomicFile::for_each_line(const std::function<void(std::string_view)>& use) {
  if (std::fflush(file_.get()) != 0 || std::fseek(file_.get(), 0, SEEK_SET) != 0) fail();
  char* line = nullptr;
  std::size_t size = 0;
  ssize_t length = 0;
  const std::unique_ptr<char*, void (*)(char**)> owner(&line, [](char** text) { std::free(*text); });
  while ((length = getline(&line, &size, file_.get())) > 0) {
    const std::string_view text(line, static_cast<std::size_t>(length));
    use(text.ends_with('\n') ? text.substr(0, text.size() - 1) : text);
  }
  if (std::ferror(file_.get()) != 0 || std::fseek(file_.get(), 0, SEEK_END) != 0) fail();
}

void AtomicFile::sync() {
  if (is_synced_) return;
  if (std::fflush(file_.get()) != 0 || fsync(descriptor()) != 0) fail();
  is_synced_ = true;
}

void AtomicFile::commit() {
  sync();
  if (!named_) {
    const std::string link = link_to(descriptor());
    unlink(temporary_.c_str());  // of a program that had this one's number
    if (linkat(AT_FDCWD, link.c_str(), AT_FDCWD, temporary_.c_str(), AT_SYMLINK_FOLLOW) != 0) fail();
    named_ = true;
  }
  if (std::rename(temporary_.c_str(), path_.c_str()) != 0) fail();
  named_ = false;
  file_.reset();
}

void AtomicFile::fail() const {
  throw OutputError(fmt::format("{}: cannot be written: {}", path_, std::generic_category().message(errno)));
}

}  // namespace arcslip
