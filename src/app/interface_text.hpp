#pragma once

// What is told of the command line elsewhere than in --help, read off the program itself, so that new
// commands and keys appear by themselves.

#include <CLI/CLI.hpp>
#include <string>

namespace arcslip {

/// The manual page arcslip(1), in the language of man(7).
std::string man_page(const CLI::App& program);

/// Completes commands, options, files and keys in "bash" or "zsh".
std::string completion(const CLI::App& program, const std::string& shell);

}  // namespace arcslip
