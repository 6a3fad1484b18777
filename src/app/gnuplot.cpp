#include "app/gnuplot.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string_view>
#include <system_error>

#include "app/interrupt.hpp"
#include "app/share.hpp"
#include "results/atomic_file.hpp"
#include "results/output.hpp"

namespace arcslip {
namespace {

namespace fs = std::filesystem;

constexpr std::array formats = {"png", "svg"};

// Exit statuses of a process that could not become gnuplot, which has none such.
constexpr int not_found = 127;
constexpr int not_started = 126;

fs::path scripts_folder() {
  std::error_code error;
  fs::path folder = share_folder() / "plots";
  if (!fs::exists(folder / "style.gp", error)) {
    throw OutputError(fmt::format("{}: holds no gnuplot scripts; install arcslip anew", folder.string()));
  }
  return folder;
}

/// Gnuplot would take a path that begins with "<" or "|" for a command, with "-" for an option.
std::string whole_path(const fs::path& path) {
  std::error_code error;
  const fs::path whole = fs::absolute(path, error);
  return error ? "./" + path.string() : whole.string();
}

/// gnuplot as it writes one picture, to a file that has no name until it is done.
class Drawing {
 public:
  explicit Drawing(const fs::path& picture)
      : format_(picture.extension().string().substr(1)), file_(picture) {}
  /// Stops gnuplot unless the picture is finished.
  ~Drawing();
  Drawing(const Drawing&) = delete;
  Drawing& operator=(const Drawing&) = delete;
  Drawing(Drawing&&) = delete;
  Drawing& operator=(Drawing&&) = delete;

  /// Starts gnuplot. Throws GnuplotNotFound, OutputError.
  void start(const fs::path& script, const fs::path& table, const std::vector<std::string>& settings);

  /// Waits for gnuplot and gives the picture its name. Throws OutputError, Interrupted.
  void finish();

  const std::string& picture() const { return file_.path(); }

 private:
  std::string read_complaints();
  bool is_whole() const;
  [[noreturn]] void fail(const std::string& reason) const;

  std::string format_;
  AtomicFile file_;
  pid_t process_ = -1;
  int complaints_ = -1;  ///< what gnuplot writes to its stderr
};

Drawing::~Drawing() {
  if (process_ > 0) {
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }
  if (complaints_ >= 0) close(complaints_);
}

/// Becomes gnuplot, which ends with the program that wants its pictures, whatever ends that one.
[[noreturn]] void become_gnuplot(char* const* arguments, int picture, int complaints, pid_t parent) {
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_DFL);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const int nothing = open("/dev/null", O_RDONLY);
  if (getppid() == parent && dup2(nothing, STDIN_FILENO) >= 0 && dup2(picture, STDOUT_FILENO) >= 0 &&
      dup2(complaints, STDERR_FILENO) >= 0)
    execvp("gnuplot", arguments);
  _exit(errno == ENOENT || errno == ENOTDIR || errno == EACCES ? not_found : not_started);
}

void Drawing::start(const fs::path& script, const fs::path& table, const std::vector<std::string>& settings) {
  std::vector<std::string> arguments = {
      "gnuplot",
      "-d",  // without the user's own settings
      "-c",      script.string(), script.parent_path().string(), whole_path(table), "/dev/stdout", format_};
  arguments.insert(arguments.end(), settings.begin(), settings.end());
  std::vector<char*> pointers;
  pointers.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);

  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) fail(std::generic_category().message(errno));
  complaints_ = ends[0];
  const pid_t self = getpid();
  process_ = fork();
  if (process_ == 0) become_gnuplot(pointers.data(), file_.descriptor(), ends[1], self);
  const int error = errno;
  close(ends[1]);
  if (process_ < 0)
    fail(fmt::format("gnuplot cannot be started: {}", std::generic_category().message(error)));
}

std::string Drawing::read_complaints() {
  constexpr int moment = 50;  // milliseconds
  std::string text;
  std::array<char, 4096> buffer{};
  for (;;) {
    pollfd waiting{complaints_, POLLIN, 0};
    const int ready = poll(&waiting, 1, moment);
    if (interrupted()) throw Interrupted();
    if (ready <= 0) continue;
    const ssize_t count = read(complaints_, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return text;
    text.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

/// The last line with a word in it: where gnuplot says what is wrong.
std::string last_line(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n";
  const std::size_t last = text.find_last_not_of(blanks);
  if (last == std::string_view::npos) return "no reason given";
  text = text.substr(0, last + 1);
  const std::size_t line_end = text.find_last_of('\n');
  return std::string(line_end == std::string_view::npos ? text : text.substr(line_end + 1));
}

/// Whether the picture was written to its end: gnuplot does not say when the disk is full.
bool Drawing::is_whole() const {
  std::array<char, 16> end{};
  const off_t size = lseek(file_.descriptor(), 0, SEEK_END);
  const ssize_t count = pread(file_.descriptor(), end.data(), end.size(), std::max<off_t>(0, size - 16));
  const std::string_view text(end.data(), static_cast<std::size_t>(std::max<ssize_t>(0, count)));
  return text.find(format_ == "svg" ? "</svg>" : "IEND") != text.npos;
}

void Drawing::finish() {
  const std::string text = read_complaints();
  int state = 0;
  while (waitpid(process_, &state, 0) < 0 && errno == EINTR) {
  }
  process_ = -1;
  if (WIFSIGNALED(state)) fail(fmt::format("gnuplot was ended by signal {}", WTERMSIG(state)));
  if (WEXITSTATUS(state) == not_found && text.empty()) throw GnuplotNotFound();
  if (WEXITSTATUS(state) != 0) fail(fmt::format("gnuplot failed: {}", last_line(text)));
  if (!is_whole()) fail("gnuplot wrote only a part of it");
  file_.commit();
}

void Drawing::fail(const std::string& reason) const {
  throw OutputError(fmt::format("{}: cannot be drawn: {}", picture(), reason));
}

}  // namespace

void draw(const std::string& folder, const std::vector<Picture>& pictures) {
  const fs::path scripts = scripts_folder();
  const fs::path target = folder;
  std::vector<std::unique_ptr<Drawing>> drawings;
  for (const Picture& picture : pictures) {
    for (const char* format : formats) {
      drawings.push_back(std::make_unique<Drawing>(target / fmt::format("{}.{}", picture.name, format)));
      drawings.back()->start(scripts / fmt::format("{}.gp", picture.script), target / picture.table,
                             picture.settings);
    }
  }
  for (const auto& drawing : drawings) {
    drawing->finish();
    print(drawing->picture() + "\n");
  }
}

}  // namespace arcslip
