#include "app/drawing.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "app/share.hpp"
#include "arcslip/cases/case_file.hpp"
#include "arcslip/version.hpp"
#include "results/output.hpp"

namespace arcslip {
namespace {

namespace fs = std::filesystem;

// Exit statuses: of plots/plot.py beside those of the program, and of a process that could not become Python.
constexpr int no_matplotlib = 5;
constexpr int not_found = 127;

std::string script() {
  std::error_code error;
  const fs::path path = share_folder() / "plots/plot.py";
  if (!fs::exists(path, error))
    throw OutputError(fmt::format("{}: what draws pictures is missing; install arcslip anew", path.string()));
  return path.string();
}

std::vector<std::string> pythons() {
  const char* const given = std::getenv("ARCSLIP_PYTHON");
  if (given != nullptr && *given != '\0') return {given};
  return {"python3", "/usr/bin/python3"};
}

/// Becomes Python, which ends with the program that wants its pictures, whatever ends that one.
[[noreturn]] void become_python(char* const* arguments, int names, int complaints, pid_t parent) {
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_DFL);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const int nothing = open("/dev/null", O_RDONLY);
  if (getppid() == parent && dup2(nothing, STDIN_FILENO) >= 0 && dup2(names, STDOUT_FILENO) >= 0 &&
      dup2(complaints, STDERR_FILENO) >= 0)
    execvp(arguments[0], arguments);
  _exit(not_found);
}

/// A process of Python; it is stopped unless it has ended by itself.
class Python {
 public:
  explicit Python(std::vector<std::string> arguments);
  ~Python();
  Python(const Python&) = delete;
  Python& operator=(const Python&) = delete;
  Python(Python&&) = delete;
  Python& operator=(Python&&) = delete;

  /// Waits for its end and gives its status, as waitpid does. Throws Interrupted.
  int wait();

  std::string printed() const;
  const std::string& complaints() const { return complaints_; }

 private:
  pid_t process_ = -1;
  int names_ = -1;
  int pipe_ = -1;
  std::string complaints_;
};

Python::Python(std::vector<std::string> arguments) {
  std::vector<char*> pointers;
  pointers.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  std::array<int, 2> ends{};
  names_ = memfd_create("pictures", MFD_CLOEXEC);
  if (names_ < 0 || pipe2(ends.data(), O_CLOEXEC) != 0)
    throw OutputError(fmt::format("python3 cannot be started: {}", std::generic_category().message(errno)));
  pipe_ = ends[0];
  const pid_t self = getpid();
  process_ = fork();
  if (process_ == 0) become_python(pointers.data(), names_, ends[1], self);
  const int error = errno;
  close(ends[1]);
  if (process_ < 0)
    throw OutputError(fmt::format("python3 cannot be started: {}", std::generic_category().message(error)));
}

Python::~Python() {
  if (process_ > 0) {
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }
  for (const int descriptor : {names_, pipe_}) {
    if (descriptor >= 0) close(descriptor);
  }
}

int Python::wait() {
  constexpr int moment = 50;  // milliseconds
  std::array<char, 4096> buffer{};
  for (;;) {
    pollfd waiting{pipe_, POLLIN, 0};
    const int ready = poll(&waiting, 1, moment);
    if (interrupted()) throw Interrupted();
    if (ready <= 0) continue;
    const ssize_t count = read(pipe_, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    complaints_.append(buffer.data(), static_cast<std::size_t>(count));
  }
  int state = 0;
  while (waitpid(process_, &state, 0) < 0 && errno == EINTR) {
  }
  process_ = -1;
  return state;
}

std::string Python::printed() const {
  std::string text;
  std::array<char, 4096> buffer{};
  for (;;) {
    const ssize_t count = pread(names_, buffer.data(), buffer.size(), static_cast<off_t>(text.size()));
    if (count <= 0) return text;
    text.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

/// The last line with a word in it: where Python says what is wrong.
std::string last_line(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n";
  const std::size_t last = text.find_last_not_of(blanks);
  if (last == std::string_view::npos) return "no reason given";
  text = text.substr(0, last + 1);
  const std::size_t line_end = text.find_last_of('\n');
  return std::string(line_end == std::string_view::npos ? text : text.substr(line_end + 1));
}

}  // namespace

std::string draw(const std::string& folder, const std::vector<std::string>& options) {
  const std::string drawer = script();
  for (const std::string& python : pythons()) {
    std::vector<std::string> arguments = {python, "-B", drawer, fmt::format("--release={}", release)};
    arguments.insert(arguments.end(), options.begin(), options.end());
    arguments.insert(arguments.end(), {"--", folder});
    Python process(arguments);
    const int state = process.wait();
    const std::string reason = last_line(process.complaints());
    if (WIFSIGNALED(state))
      throw OutputError(
          fmt::format("{}: cannot be drawn: python3 was ended by signal {}", folder, WTERMSIG(state)));
    switch (WEXITSTATUS(state)) {
      case status::done: return process.printed();
      case no_matplotlib:
      case not_found: continue;
      default: break;
    }
    if (process.complaints().find("Traceback") == std::string::npos) {
      switch (WEXITSTATUS(state)) {
        case status::wrong_input: throw InputError(reason);
        case status::wrong_command_line: throw WrongRequest{reason};
        case status::cannot_write: throw OutputError(reason);
        default: break;
      }
    }
    throw OutputError(fmt::format("{}: cannot be drawn: python3 failed: {}", folder, reason));
  }
  throw MatplotlibNotFound();
}

}  // namespace arcslip
