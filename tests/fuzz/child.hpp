#pragma once

// A program run with limits, and what it left.

#include <string>
#include <vector>

namespace arcslip::fuzz {

struct Outcome {
  int status = -1;    ///< exit status; -1 where a signal ended it
  int signal = 0;     ///< which one
  bool late = false;  ///< whether it did not end in time, and was killed
  std::string out;
  std::string err;
};

struct Limits {
  double seconds = 60;   ///< after which it is killed
  double interrupt = 0;  ///< after which it is asked to terminate; 0: never
};

/// Runs `words` in the folder.
Outcome run(const std::vector<std::string>& words, const std::string& folder, const Limits& limits);

}  // namespace arcslip::fuzz
