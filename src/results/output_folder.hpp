#pragma once

// Where results go.

#include <string>

namespace arcslip {

/// A folder that no other arcslip writes to meanwhile.
class OutputFolder {
 public:
  /// Makes the folder and its parents, and removes the temporary files of programs that were killed. Throws
  /// OutputError.
  explicit OutputFolder(std::string path);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;
  OutputFolder(OutputFolder&&) = delete;
  OutputFolder& operator=(OutputFolder&&) = delete;

  const std::string& path() const { return path_; }

 private:
  void lock();
  void remove_leftovers() const;

  std::string path_;
  int descriptor_ = -1;  ///< of the folder, which holds the lock
};

}  // namespace arcslip
