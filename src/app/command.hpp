#pragma once

// The commands of the program. Each is one file in src/app/commands: NAME.cpp defines `Command
// NAME_command()`, and the build finds it.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <string>
#include <vector>

namespace arcslip {

struct Command {
  /// What a command does once its arguments are known; it returns the exit status, what it throws is for
  /// `guarded`.
  using Action = std::function<int()>;

  std::string name;
  /// Adds it to the program with its arguments; gives what is done with them.
  std::function<Action(CLI::App& app)> add;
};

/// All of them, in alphabetical order.
const std::vector<Command>& commands();

/// Whether one has this name.
inline bool is_command(const std::string& name) {
  return std::any_of(commands().begin(), commands().end(),
                     [&](const Command& command) { return command.name == name; });
}

/// `--set`.
void add_settings(CLI::App* command, std::vector<std::string>& settings);

/// An option that names a folder.
CLI::Option* add_folder(CLI::App* command, const std::string& option, std::string& folder,
                        const std::string& help);
/// That for the results, `-o`.
CLI::Option* add_results_folder(CLI::App* command, std::string& folder);

/// Lets an option be a finite number > 0.
CLI::Validator positive_number();

}  // namespace arcslip
