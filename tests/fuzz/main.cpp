// Runs the program on case files made wrong, and reports whatever is no clean answer: a crash, a finding of a
// sanitizer, a hang, a second line, a control character, a message that does not say where the mistake is, a
// file left over.
//
//   arcslip_fuzz --program FILE --cases FOLDER [--seed N] [--check N] [--run N] [--study N] [--first N]
//   [--jobs N]
//                [--keep FOLDER]
//
// Case i of a seed is the same wherever and whenever it runs; what is reported is kept and can be run again
// by itself.

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <mutex>
#include <sstream>
#include <thread>

#include "child.hpp"
#include "mutation.hpp"

namespace {

namespace fs = std::filesystem;
using namespace arcslip::fuzz;

/// A valid case, with the files that it names.
struct Example {
  std::string name;
  std::string text;
  std::map<std::string, std::string> files;
};

struct Options {
  std::string program;
  std::string cases;
  std::string keep = "fuzz-findings";
  std::uint64_t seed = 1;
  std::size_t first = 0;
  std::size_t jobs = 2;
  std::map<std::string, std::size_t> counts = {{"check", 0}, {"run", 0}, {"study", 0}};
};

std::string text_of(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

void write(const fs::path& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

std::vector<Example> read_examples(const Options& options, const fs::path& scratch) {
  std::vector<Example> examples;
  for (const fs::directory_entry& entry : fs::directory_iterator(options.cases)) {
    if (entry.path().extension() == ".toml")
      examples.push_back({entry.path().stem(), text_of(entry.path()), {}});
  }
  const std::vector<std::vector<std::string>> kinds = {
      {"ring", "--elements", "2", "--ring-elements", "2"},
      {"ring", "--elements", "2", "--ring-elements", "2", "--contact", "tangential", "--contacts", "2"},
      {"beams", "--elements-per-sector", "3"}};
  for (const std::vector<std::string>& kind : kinds) {
    std::vector<std::string> words = {options.program, "sector"};
    words.insert(words.end(), kind.begin(), kind.end());
    words.insert(words.end(), {"-o", "sector"});
    fs::remove_all(scratch / "sector");
    if (run(words, scratch, {}).status != 0) throw std::runtime_error("arcslip sector fails");
    Example example{"sector_" + kind[0], text_of(scratch / "sector/case.toml"), {}};
    for (const fs::directory_entry& entry : fs::directory_iterator(scratch / "sector"))
      if (entry.path().filename() != "case.toml")
        example.files[entry.path().filename()] = text_of(entry.path());
    for (int i = 0; i < 4; ++i) examples.push_back(example);  // as often as all others of a kind together
  }
  std::sort(examples.begin(), examples.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return examples;
}

std::size_t lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

/// Whether a terminal would obey some of it.
bool has_control(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if ((byte < 0x20 && byte != '\n') || byte == 0x7f) return true;
    if (byte == 0xc2 && i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) < 0xa0) return true;
  }
  return false;
}

std::string leftovers(const fs::path& folder) {
  std::error_code none;
  for (fs::recursive_directory_iterator entry(folder, none), end; entry != end; entry.increment(none))
    if (entry->path().extension() == ".tmp") return entry->path().filename();
  return "";
}

/// What is wrong with an answer, or nothing.
std::string judge(const std::string& command, const Outcome& outcome, const fs::path& folder) {
  constexpr std::size_t longest = 5000;
  if (outcome.late) return "does not end";
  if (outcome.signal != 0) return fmt::format("is ended by signal {}", outcome.signal);
  if (outcome.err.find("Sanitizer") != outcome.err.npos ||
      outcome.err.find("runtime error:") != outcome.err.npos)
    return "is stopped by a sanitizer";
  const bool may_be_incomplete = command != "check";
  if (outcome.status != 0 && outcome.status != 1 && !(may_be_incomplete && outcome.status == 3))
    return fmt::format("has status {}", outcome.status);
  if (outcome.status == 0 && !outcome.err.empty() && !outcome.err.starts_with("arcslip: warning: "))
    return "complains although all is well";
  if (outcome.status == 1 && (lines(outcome.err) != 1 || outcome.err.back() != '\n'))
    return "has not one line to say";
  if (outcome.status == 1 && outcome.err.size() > longest) return "says too much";
  if (outcome.status == 1 && outcome.err.find("case.toml") == outcome.err.npos &&
      !outcome.err.starts_with("--set"))
    return "does not say where";
  if (has_control(outcome.err) || has_control(outcome.out)) return "prints a control character";
  if (outcome.status == 3 && outcome.err.empty()) return "does not say why";
  if (const std::string name = leftovers(folder); !name.empty()) return "leaves " + name;
  return "";
}

/// One case: its files in the folder, and the words to run.
std::vector<std::string> make_case(const Options& options, const std::string& command, std::size_t number,
                                   const std::vector<Example>& examples, const fs::path& folder) {
  std::seed_seq sequence{options.seed, static_cast<std::uint64_t>(command[0]), std::uint64_t{number}};
  std::vector<std::uint32_t> words(2);
  sequence.generate(words.begin(), words.end());
  Mutator mutator(std::uint64_t{words[0]} << 32 | words[1]);
  const std::string section = command == "study" ? "\n[study]" : "\n[branch]";
  const Example* example = &mutator.one_of(examples);
  while (command != "check" && example->text.find(section) == std::string::npos)
    example = &mutator.one_of(examples);
  std::map<std::string, std::string> files = example->files;
  const bool of_files = !files.empty() && mutator.pick(3) == 0;
  if (of_files) {
    auto file = files.begin();
    std::advance(file, mutator.pick(files.size()));
    file->second = mutator.mutated(file->second);
  }
  write(folder / "case.toml",
        of_files && mutator.pick(2) == 0 ? example->text : mutator.mutated(example->text));
  for (const auto& [name, text] : files) write(folder / name, text);

  std::vector<std::string> arguments = {options.program, command, "case.toml"};
  if (command != "check")
    arguments.insert(arguments.end(), {"-o", "r", "--set", "continuation.max_seconds=1", "--set",
                                       "continuation.max_points=300"});
  for (std::size_t i = mutator.pick(8); i > 6; --i)
    arguments.insert(arguments.end(), {"--set", mutator.setting()});
  if (command == "run" && mutator.pick(20) == 0) arguments.emplace_back("--verify");
  if (command == "run" && mutator.pick(20) == 0) arguments.emplace_back("--certify");
  return arguments;
}

class Campaign {
 public:
  Campaign(const Options& options, std::vector<Example> examples, fs::path scratch)
      : options_(options), examples_(std::move(examples)), scratch_(std::move(scratch)) {}

  /// How many cases had no clean answer.
  std::size_t run_all() {
    for (const auto& [command, count] : options_.counts) {
      next_ = options_.first;
      const std::size_t end = options_.first + count;
      std::vector<std::thread> threads;
      for (std::size_t job = 0; job < options_.jobs; ++job)
        threads.emplace_back([this, job, end, name = command] { work(job, name, end); });
      for (std::thread& thread : threads) thread.join();
      if (count > 0) fmt::print("{}: {} cases, {}\n", command, count, tally());
    }
    return findings_;
  }

 private:
  void work(std::size_t job, const std::string& command, std::size_t end) {
    // The time in which a check must end; a run is asked to, and must do so then.
    const Limits limits = command == "check" ? Limits{120, 0} : Limits{60, 6};
    const fs::path folder = scratch_ / std::to_string(job);
    for (std::size_t number = next_++; number < end; number = next_++) {
      fs::remove_all(folder);
      fs::create_directories(folder);
      const std::vector<std::string> words = make_case(options_, command, number, examples_, folder);
      const Outcome outcome = run(words, folder, limits);
      note(command, number, words, outcome, judge(command, outcome, folder), folder);
    }
  }

  void note(const std::string& command, std::size_t number, const std::vector<std::string>& words,
            const Outcome& outcome, const std::string& wrong, const fs::path& folder) {
    const std::scoped_lock lock(mutex_);
    ++statuses_[outcome.status];
    if (wrong.empty()) return;
    ++findings_;
    const fs::path kept = fs::path(options_.keep) / fmt::format("{}-{}-{}", command, options_.seed, number);
    fs::remove_all(kept);
    fs::create_directories(kept);
    fs::copy(folder, kept, fs::copy_options::recursive);
    std::string text;
    for (const std::string& word : words) text += word + '\0';
    write(kept / "words", text);  // for xargs -0
    fmt::print("{} {}: {}\n", kept.string(), wrong, outcome.err.substr(0, 300));
    std::fflush(stdout);
  }

  std::string tally() {
    std::string text;
    for (const auto& [status, count] : statuses_)
      text += fmt::format("{}{} with status {}", text.empty() ? "" : ", ", count, status);
    statuses_.clear();
    return text;
  }

  const Options& options_;
  std::vector<Example> examples_;
  fs::path scratch_;
  std::atomic<std::size_t> next_ = 0;
  std::mutex mutex_;
  std::map<int, std::size_t> statuses_;
  std::size_t findings_ = 0;
};

Options options_from(const std::vector<std::string>& words) {
  Options options;
  for (std::size_t i = 0; i + 1 < words.size(); i += 2) {
    const std::string& name = words[i];
    const std::string& value = words[i + 1];
    if (name == "--program")
      options.program = fs::absolute(value);
    else if (name == "--cases")
      options.cases = value;
    else if (name == "--keep")
      options.keep = value;
    else if (name == "--seed")
      options.seed = std::stoull(value);
    else if (name == "--first")
      options.first = std::stoull(value);
    else if (name == "--jobs")
      options.jobs = std::stoull(value);
    else if (name.size() > 2 && options.counts.contains(name.substr(2)))
      options.counts[name.substr(2)] = std::stoull(value);
    else
      throw std::runtime_error("unknown option " + name);
  }
  if (options.program.empty() || options.cases.empty())
    throw std::runtime_error("--program and --cases are needed");
  return options;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const Options options = options_from({argv + 1, argv + argc});
    const fs::path scratch = fs::temp_directory_path() / fmt::format("arcslip_fuzz_{}", getpid());
    fs::create_directories(scratch);
    const std::size_t findings = Campaign(options, read_examples(options, scratch), scratch).run_all();
    fs::remove_all(scratch);
    fmt::print("{} findings\n", findings);
    return findings == 0 ? 0 : 1;
  } catch (const std::exception& error) {
    fmt::print(stderr, "arcslip_fuzz: {}\n", error.what());
    return 2;
  }
}
