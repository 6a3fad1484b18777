#pragma once

// What is told of work on its way: one line on stderr that follows it, where that is a terminal.

#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <string>

namespace arcslip {

using Clock = std::chrono::steady_clock;

inline double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// "1 branch", "2 branches".
inline std::string plural(std::size_t count, const std::string& what, const char* ending = "s") {
  return std::to_string(count) + " " + what + (count == 1 ? "" : ending);
}

class ProgressLine {
 public:
  explicit ProgressLine(bool shown) : shown_(shown && isatty(STDERR_FILENO) != 0) {}
  ~ProgressLine() {
    if (drawn_) std::fputs("\r\033[K", stderr);
  }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ProgressLine(ProgressLine&&) = delete;
  ProgressLine& operator=(ProgressLine&&) = delete;

  /// Draws what `text` returns, but not more than ten times a second.
  template <class Text>
  void show(const Text& text) {
    if (!shown_) return;
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ < std::chrono::milliseconds(100)) return;
    last_ = now;
    drawn_ = true;
    std::fputs(("\r\033[K" + std::string(text())).c_str(), stderr);
  }

  /// A line of its own, whether or not there is a terminal.
  void say(const std::string& text) {
    std::fputs(((drawn_ ? "\r\033[K" : "") + text + "\n").c_str(), stderr);
    drawn_ = false;
  }

 private:
  bool shown_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace arcslip
