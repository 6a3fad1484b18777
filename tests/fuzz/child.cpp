#include "child.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace arcslip::fuzz {
namespace {

using Clock = std::chrono::steady_clock;

constexpr rlim_t largest_file = rlim_t{256} << 20;

[[noreturn]] void become(char* const* words, const char* folder) {
  const rlimit files{largest_file, largest_file};
  setrlimit(RLIMIT_FSIZE, &files);
  const rlimit cores{0, 0};
  setrlimit(RLIMIT_CORE, &cores);
  const bool moved = chdir(folder) == 0;
  dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
  dup2(open("out", O_WRONLY | O_CREAT | O_TRUNC, 0600), STDOUT_FILENO);
  dup2(open("err", O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
  if (moved) execv(words[0], words);
  _exit(126);
}

std::string text_of(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

}  // namespace

Outcome run(const std::vector<std::string>& words, const std::string& folder, const Limits& limits) {
  std::vector<std::string> copies = words;
  std::vector<char*> pointers;
  for (std::string& word : copies) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const Clock::time_point begun = Clock::now();
  const pid_t process = fork();
  if (process < 0) throw std::runtime_error("no process can be started");
  if (process == 0) become(pointers.data(), folder.c_str());
  Outcome outcome;
  bool asked = false;
  int state = 0;
  std::chrono::microseconds nap(500);
  while (waitpid(process, &state, WNOHANG) == 0) {
    const std::chrono::duration<double> spent = Clock::now() - begun;
    if (limits.interrupt > 0 && !asked && spent.count() > limits.interrupt) {
      asked = true;
      kill(process, SIGTERM);
    }
    if (!outcome.late && spent.count() > limits.seconds) {
      outcome.late = true;
      kill(process, SIGKILL);
    }
    std::this_thread::sleep_for(nap);
    nap = std::min(2 * nap, std::chrono::microseconds(20'000));
  }
  if (WIFEXITED(state)) outcome.status = WEXITSTATUS(state);
  if (WIFSIGNALED(state)) outcome.signal = WTERMSIG(state);
  outcome.out = text_of(folder + "/out");
  outcome.err = text_of(folder + "/err");
  return outcome;
}

}  // namespace arcslip::fuzz
