#pragma once

// The program in the background, to be ended before it is done. What is told to it waits for events, never
// for a time: a test is as sure on a fast machine as on a busy one.

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <functional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "program.hpp"

namespace arcslip::testing {

class Background {
 public:
  /// Runs the program with signals as in a terminal, whatever the test inherited; `prepare` is called in the
  /// new process before.
  explicit Background(
      std::vector<std::string> arguments, const std::function<void()>& prepare = [] {})
      : arguments_(std::move(arguments)) {
    arguments_.insert(arguments_.begin(), program);
    std::vector<char*> words;
    for (std::string& word : arguments_) words.push_back(word.data());
    words.push_back(nullptr);
    const std::string out = folder_.write("out", ""), err = folder_.write("err", "");
    int until_it_runs[2];
    if (pipe2(until_it_runs, O_CLOEXEC) != 0) throw std::runtime_error("there is no pipe");
    id_ = fork();
    if (id_ != 0) {
      char none = 0;
      close(until_it_runs[1]);
      while (::read(until_it_runs[0], &none, 1) != 0) {
      }
      close(until_it_runs[0]);
      return;
    }
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    for (const int number : {SIGHUP, SIGINT, SIGTERM}) std::signal(number, SIG_DFL);
    dup2(open(out.c_str(), O_WRONLY), STDOUT_FILENO);
    dup2(open(err.c_str(), O_WRONLY), STDERR_FILENO);
    prepare();
    execv(words[0], words.data());
    _exit(127);
  }
  ~Background() {
    signal(SIGKILL);
    wait();
  }
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  pid_t id() const { return id_; }

  /// What it has written on standard output so far.
  std::string printed() const { return read(folder_.path("out")); }

  /// Waits until it happens or the program ends. Whether it happened.
  bool wait_until(const std::function<bool()>& happens) {
    while (!happens()) {
      if (ended(WNOHANG)) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return true;
  }

  void signal(int number) {
    if (!ended_) kill(id_, number);
  }

  /// What became of it; the status is -1 where a signal ended it.
  Outcome wait() {
    ended(0);
    return {WIFEXITED(code_) ? WEXITSTATUS(code_) : -1, read(folder_.path("out")), read(folder_.path("err"))};
  }

 private:
  bool ended(int options) {
    if (!ended_) ended_ = waitpid(id_, &code_, options) == id_;
    return ended_;
  }

  TemporaryFolder folder_;
  std::vector<std::string> arguments_;
  pid_t id_;
  bool ended_ = false;
  int code_ = 0;
};

/// A terminal, for a program to draw the line on that follows its work.
class Terminal {
 public:
  Terminal() : side_(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)) {
    grantpt(side_);
    unlockpt(side_);
    other_side_ = ptsname(side_);
  }
  ~Terminal() { close(side_); }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  /// In a process that is to have it as standard error.
  void take() const { dup2(open(other_side_.c_str(), O_WRONLY | O_NOCTTY), STDERR_FILENO); }

  /// How often the line was drawn that tells how many points there are.
  int drawn() {
    char piece[4096];
    for (ssize_t count = 0; (count = ::read(side_, piece, sizeof piece)) > 0;)
      shown_.append(piece, static_cast<std::size_t>(count));
    int count = 0;
    for (std::size_t at = 0; (at = shown_.find(" points", at)) != std::string::npos; ++at) ++count;
    return count;
  }

 private:
  int side_;
  std::string other_side_;
  std::string shown_;
};

/// Whether the process has a handler for the signal.
inline bool handles(pid_t process, int signal) {
  std::istringstream status(read("/proc/" + std::to_string(process) + "/status"));
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("SigCgt:"))
      return (std::stoull(line.substr(7), nullptr, 16) >> (signal - 1) & 1) != 0;
  }
  return false;
}

}  // namespace arcslip::testing
