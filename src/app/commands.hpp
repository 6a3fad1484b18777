#pragma once

// The commands of the program. Each returns its exit status; what it throws is for `guarded`.

#include <functional>
#include <string>
#include <vector>

namespace arcslip {

namespace status {
constexpr int done = 0;
constexpr int wrong_input = 1;
constexpr int wrong_command_line = 2;
constexpr int incomplete_branch = 3;
constexpr int cannot_write = 4;
}  // namespace status

struct RunOptions {
  std::string case_path;
  std::string folder;                 ///< empty: out/<name of the case file>
  std::vector<std::string> settings;  ///< "section.key=value"
  bool quiet = false;
  bool verify = false;   ///< solve points of each branch anew, by other means
  bool certify = false;  ///< prove each branch by interval arithmetic
  std::string resume;    ///< folder of the interrupted run to go on with; empty: none
};

/// Traces the branches, writes branches.csv, curves.csv and summary.json, prints the special points.
int run_command(const RunOptions& options);

struct StudyOptions {
  std::string case_path;
  std::string folder;                 ///< empty: out/<name of the case file>
  std::size_t jobs = 0;               ///< threads; 0: one for each core
  bool resume = false;                ///< go on with the study in the folder
  std::vector<std::string> settings;  ///< "section.key=value"
  bool quiet = false;
};

/// Studies the designs of a case, writes study.sqlite, sweep.csv, optimum.csv and summary.json, prints the
/// optima.
int study_command(const StudyOptions& options);

struct CheckOptions {
  std::string case_path;
  std::vector<std::string> settings;  ///< "section.key=value"
  bool derivatives = false;           ///< compare the problems' derivatives with differences
};

/// Prints what `run` and `study` would do.
int check_command(const CheckOptions& options);

struct HelpOptions {
  std::string key;        ///< empty: all of them
  bool markdown = false;  ///< tables of all keys, as the README has them
};

/// Tells what keys case files have, or all of one.
int help_command(const HelpOptions& options);

/// The keys of these sections, or of all, with their meanings.
std::string list_keys(const std::vector<std::string>& sections);

/// Runs a command; what it throws is printed on stderr and becomes the status.
int guarded(const std::function<int()>& command);

/// Where results go: `given`, or out/<name of the case file>.
std::string results_folder(const std::string& given, const std::string& case_path);

/// Draws what is in `folder`, as PNG and SVG beside it.
int plot_command(const std::string& folder);

}  // namespace arcslip
