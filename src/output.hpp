#pragma once

// What the program writes: files that appear whole or not at all (written under a temporary name, then
// renamed), and standard output.

#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

namespace arcslip {

/// A file or folder that could not be written; the message names it and the reason.
class OutputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Creates the folder and its parents. Throws OutputError.
void create_folder(const std::string& path);

/// Prints on standard output, at once; a reader that has gone is no error. Throws OutputError.
void print(std::string_view text);

class AtomicFile {
 public:
  /// Opens the temporary file. Throws OutputError.
  explicit AtomicFile(std::string path);
  /// Removes the temporary file unless it was committed.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  AtomicFile(AtomicFile&&) = delete;
  AtomicFile& operator=(AtomicFile&&) = delete;

  void write(std::string_view text);

  /// Brings the content to the disk. Throws OutputError.
  void sync();

  /// The same, then gives the file its name. Files that belong together are all synced before the first
  /// commit.
  void commit();

 private:
  [[noreturn]] void fail() const;

  std::string path_;
  std::string temporary_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

}  // namespace arcslip
