#include "gnuplot.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string_view>
#include <system_error>

#include "output.hpp"

namespace arcslip {
namespace {

namespace fs = std::filesystem;

constexpr std::array formats = {"png", "svg"};

/// Where the scripts are: beside the program, as in the build tree so after installation.
fs::path scripts_folder() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  fs::path folder = program.parent_path().parent_path() / "share/arcslip/plots";
  if (error || !fs::exists(folder / "style.gp", error)) {
    throw OutputError(fmt::format("{}: holds no gnuplot scripts; install arcslip anew", folder.string()));
  }
  return folder;
}

/// gnuplot as it writes one picture: under a temporary name beside the final one until it is done.
class Drawing {
 public:
  explicit Drawing(fs::path picture);
  /// Stops gnuplot, and removes what it has written, unless the picture is finished.
  ~Drawing();
  Drawing(const Drawing&) = delete;
  Drawing& operator=(const Drawing&) = delete;
  Drawing(Drawing&&) = delete;
  Drawing& operator=(Drawing&&) = delete;

  /// Starts gnuplot. Throws GnuplotNotFound, OutputError.
  void start(const fs::path& script, const fs::path& table, const std::vector<std::string>& settings);

  /// Waits for gnuplot and gives the picture its name. Throws OutputError.
  void finish();

  const fs::path& picture() const { return picture_; }

 private:
  std::string format() const { return picture_.extension().string().substr(1); }
  std::string read_complaints();
  [[noreturn]] void fail(const std::string& reason) const;

  fs::path picture_;
  std::string temporary_;
  pid_t process_ = -1;
  int complaints_ = -1;  ///< what gnuplot writes to its stderr
};

Drawing::Drawing(fs::path picture)
    : picture_(std::move(picture)), temporary_(fmt::format("{}.{}.tmp", picture_.string(), getpid())) {}

Drawing::~Drawing() {
  if (process_ > 0) {
    kill(process_, SIGTERM);
    waitpid(process_, nullptr, 0);
  }
  if (complaints_ >= 0) close(complaints_);
  std::error_code ignored;
  fs::remove(temporary_, ignored);
}

void Drawing::start(const fs::path& script, const fs::path& table, const std::vector<std::string>& settings) {
  // Absolute paths: gnuplot would take one that begins with "<" or "|" for a command, with "-" for an option.
  std::vector<std::string> arguments = {"gnuplot",
                                        "-d",  // without the user's own settings
                                        "-c",
                                        script.string(),
                                        script.parent_path().string(),
                                        fs::absolute(table).string(),
                                        fs::absolute(temporary_).string(),
                                        format()};
  arguments.insert(arguments.end(), settings.begin(), settings.end());
  std::vector<char*> pointers;
  pointers.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);

  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) fail(std::generic_category().message(errno));
  complaints_ = ends[0];
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&files, ends[1], STDERR_FILENO);
  const int error = posix_spawnp(&process_, "gnuplot", &files, nullptr, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  close(ends[1]);
  if (error == 0) return;
  process_ = -1;
  if (error == ENOENT || error == ENOTDIR || error == EACCES) throw GnuplotNotFound();
  fail(fmt::format("gnuplot cannot be started: {}", std::generic_category().message(error)));
}

std::string Drawing::read_complaints() {
  std::string text;
  std::array<char, 4096> buffer{};
  for (;;) {
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

/// Whether a picture was written to its end: gnuplot does not say when the disk is full.
bool is_whole(const std::string& path, std::string_view format) {
  constexpr std::streamoff longest_end = 16;
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = file ? static_cast<std::streamoff>(file.tellg()) : 0;
  if (size < longest_end) return false;
  std::string end(longest_end, '\0');
  file.seekg(size - longest_end);
  file.read(end.data(), longest_end);
  return file && end.find(format == "svg" ? "</svg>" : "IEND") != std::string::npos;
}

void Drawing::finish() {
  const std::string text = read_complaints();
  int state = 0;
  while (waitpid(process_, &state, 0) < 0 && errno == EINTR) {
  }
  process_ = -1;
  if (WIFSIGNALED(state)) fail(fmt::format("gnuplot was ended by signal {}", WTERMSIG(state)));
  if (WEXITSTATUS(state) != 0) fail(fmt::format("gnuplot failed: {}", last_line(text)));
  if (!is_whole(temporary_, format())) fail("gnuplot wrote only a part of it");
  if (std::rename(temporary_.c_str(), picture_.c_str()) != 0) fail(std::generic_category().message(errno));
}

void Drawing::fail(const std::string& reason) const {
  throw OutputError(fmt::format("{}: cannot be drawn: {}", picture_.string(), reason));
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
    print(drawing->picture().string() + "\n");
  }
}

}  // namespace arcslip
