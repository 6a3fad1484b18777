#pragma once

// What the commands share.

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

/// The keys of these sections, or of all, with their meanings.
std::string list_keys(const std::vector<std::string>& sections);

/// Runs a command; what it throws is printed on stderr and becomes the status.
int guarded(const std::function<int()>& command);

/// Says them on stderr, before the work or after it.
void warn(const std::vector<std::string>& warnings);

/// Where results go: `given`, or out/<name of the case file>.
std::string results_folder(const std::string& given, const std::string& case_path);

}  // namespace arcslip
