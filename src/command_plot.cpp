#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>
#include <vector>

#include "arcslip/case_file.hpp"
#include "commands.hpp"
#include "output.hpp"

namespace arcslip {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// Each has a script in plots/ of its name.
constexpr std::array pictures = {"amplitude", "relative", "phases", "dissipated"};
constexpr std::array formats = {"png", "svg"};

/// What the scripts are told of a run.
struct Run {
  fs::path table;
  std::string parameter;  ///< "eta" or "P"
  std::string labels;     ///< a word in double quotes for each branch
};

std::ifstream open(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!fs::is_regular_file(path) || !file) {
    throw InputError(
        fmt::format("{}: cannot be read; expected a file that arcslip run has written", path.string()));
  }
  return file;
}

/// Refuses a table without points, or without a column that a script reads.
void check_table(const fs::path& path) {
  std::ifstream file = open(path);
  std::string header;
  std::string row;
  std::getline(file, header);
  for (const char* column : {"branch", "point", "type", "regime", "eta", "P", "S", "R_over_S", "Y", "beta",
                             "alpha", "psi", "dissipated"}) {
    if (("," + header + ",").find(fmt::format(",{},", column)) == std::string::npos) {
      throw InputError(fmt::format("{}: has no column {}; expected a table that arcslip run has written",
                                   path.string(), column));
    }
  }
  if (!std::getline(file, row)) throw InputError(fmt::format("{}: holds no points", path.string()));
}

/// Text without what gnuplot would take for markup or for the end of a word.
std::string plain(std::string text) {
  std::replace(text.begin(), text.end(), '_', ' ');
  std::erase_if(text,
                [](char c) { return std::string_view("\"\\{}^@&~").find(c) != std::string_view::npos; });
  return text;
}

/// The symbol that the paper has for a key of [system], in gnuplot's markup.
std::string symbol(const std::string& key) {
  static const std::map<std::string, std::string, std::less<>> symbols = {
      {"preload", "{/:Italic P}"},         {"eta", "{/:Italic η}"},
      {"force", "{/:Italic F}"},           {"wave_number", "{/:Italic n}"},
      {"elements", "{/:Italic N}"},        {"mass_ratio", "{/:Italic M}*"},
      {"frequency_ratio", "{/:Italic γ}"}, {"slenderness", "{/:Italic L}/{/:Italic h}_D"},
      {"poisson_ratio", "{/:Italic ν}"},   {"interface_stiffness", "{/:Italic K}_{FD}"}};
  const auto found = symbols.find(key);
  return found == symbols.end() ? plain(key) : found->second;
}

/// "P = 0.1" for what `for_each` sets on a branch. The blanks are unbreakable, since SVG drops others beside
/// markup.
std::string label(const ordered_json& values) {
  constexpr const char* blank = "\u00a0";
  std::vector<std::string> parts;
  for (const auto& [key, value] : values.items()) {
    const std::string text = value.is_number()   ? fmt::format("{:.6g}", value.get<double>())
                             : value.is_string() ? plain(value.get<std::string>())
                                                 : plain(value.dump());
    parts.push_back(fmt::format("{}{}={}{}", symbol(key), blank, blank, text));
  }
  return fmt::format("{}", fmt::join(parts, fmt::format(",{}", blank)));
}

Run read_run(const fs::path& folder) {
  if (!fs::is_directory(folder)) {
    throw InputError(
        fmt::format("{}: is not a folder; expected one that arcslip run has written", folder.string()));
  }
  Run run;
  run.table = folder / "branches.csv";
  check_table(run.table);
  const fs::path path = folder / "summary.json";
  std::ifstream file = open(path);
  try {
    const ordered_json summary = ordered_json::parse(file);
    run.parameter = summary.at("case").at("branch").at("parameter").get<std::string>();
    for (const ordered_json& branch : summary.at("branches")) {
      run.labels += fmt::format("{}\"{}\"", run.labels.empty() ? "" : " ", label(branch.at("values")));
    }
  } catch (const ordered_json::parse_error& error) {
    throw InputError(fmt::format("{}: is not JSON (byte {})", path.string(), error.byte));
  } catch (const ordered_json::exception&) {
    throw InputError(fmt::format("{}: is not a summary that arcslip run has written", path.string()));
  }
  if ((run.parameter != "eta" && run.parameter != "P") || run.labels.empty()) {
    throw InputError(fmt::format("{}: expected branches over eta or P", path.string()));
  }
  return run;
}

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

struct GnuplotNotFound {};

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
  void start(const fs::path& script, const Run& run);

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

void Drawing::start(const fs::path& script, const Run& run) {
  // Absolute paths: gnuplot would take one that begins with "<" or "|" for a command, with "-" for an option.
  std::array<std::string, 10> arguments = {"gnuplot",
                                           "-d",  // without the user's own settings
                                           "-c",
                                           script.string(),
                                           script.parent_path().string(),
                                           fs::absolute(run.table).string(),
                                           fs::absolute(temporary_).string(),
                                           format(),
                                           run.parameter,
                                           run.labels};
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

/// Draws all pictures, at the same time since each takes a gnuplot of its own.
void draw(const fs::path& folder, const Run& run) {
  const fs::path scripts = scripts_folder();
  std::vector<std::unique_ptr<Drawing>> drawings;
  for (const char* picture : pictures) {
    for (const char* format : formats) {
      drawings.push_back(std::make_unique<Drawing>(folder / fmt::format("{}.{}", picture, format)));
      drawings.back()->start(scripts / fmt::format("{}.gp", picture), run);
    }
  }
  for (const auto& drawing : drawings) {
    drawing->finish();
    print(drawing->picture().string() + "\n");
  }
}

}  // namespace

int plot_command(const std::string& folder) {
  const Run run = read_run(folder);
  if (access(folder.c_str(), W_OK) != 0) {
    throw OutputError(
        fmt::format("{}: cannot be written: {}", folder, std::generic_category().message(errno)));
  }
  try {
    draw(folder, run);
  } catch (const GnuplotNotFound&) {
    fmt::print(stderr,
               "arcslip plot: gnuplot was not found; install it (Debian: apt-get install gnuplot-nox)\n");
    return status::cannot_write;
  }
  if (std::fflush(stdout) != 0) throw OutputError("standard output: cannot be written");
  return status::done;
}

}  // namespace arcslip
