#pragma once

// Files that appear whole or not at all, whatever ends the program: without a name until they are whole.

#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace arcslip {

class AtomicFile {
 public:
  /// How a file is kept from sight until it is whole.
  enum class Hidden { without_name, under_temporary_name };

  /// Opens a file that has no name yet; where the file system has none such, one under a temporary name,
  /// which `OutputFolder` removes if the program is killed. Throws OutputError.
  explicit AtomicFile(std::string path, Hidden hidden = Hidden::without_name);
  /// Leaves nothing behind unless it was committed.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  AtomicFile(AtomicFile&&) = delete;
  AtomicFile& operator=(AtomicFile&&) = delete;

  const std::string& path() const { return path_; }
  void write(std::string_view text);

  /// For another program to write to.
  int descriptor() const;

  /// Calls `use` with each line of what was written, without its end.
  void for_each_line(const std::function<void(std::string_view)>& use);

  /// Brings the content to the disk. Throws OutputError.
  void sync();

  /// The same, then gives the file its name. Files that belong together are all synced before the first
  /// commit.
  void commit();

 private:
  [[noreturn]] void fail() const;
  int open_unnamed() const;
  int open_named();

  std::string path_;
  std::string temporary_;
  bool named_ = false;      ///< whether it stands under the temporary name
  bool is_synced_ = false;  ///< whether all that was written is
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

}  // namespace arcslip
