#include <fmt/format.h>

#include <algorithm>

#include "app/interface_text.hpp"
#include "app/wrap.hpp"
#include "arcslip/version.hpp"
#include "cases/key_catalogue.hpp"

namespace arcslip {
namespace {

/// Text in which nothing is a request or an escape.
std::string man_text(const std::string& text) {
  std::string result;
  for (const char c : text) {
    const bool begins = result.empty() || result.back() == '\n';
    if (begins && (c == '.' || c == '\'')) result += "\\&";
    if (c == '\\') {
      result += "\\e";
    } else if (c == '-') {
      result += "\\-";
    } else if (c != '`') {
      result += c;
    }
  }
  return result;
}

/// Lines as they are, the longer ones broken between words.
std::string man_lines(const std::string& text) {
  constexpr std::size_t longest = 76;
  const std::string told = text.substr(std::min(text.find_first_not_of('\n'), text.size()));
  return ".nf\n" + man_text(wrapped(told, longest)) + ".fi\n";
}

std::string man_option(const CLI::Option& option) {
  std::string value = option.get_items_expected_max() > 0 ? option.get_type_name() : "";
  if (option.get_positional() || value.empty()) value.clear();
  return fmt::format(".TP\n\\fB{}\\fR{}\n{}\n", man_text(option.get_name(option.get_positional(), true)),
                     value.empty() ? "" : " \\fI" + man_text(value) + "\\fR",
                     man_text(option.get_description()));
}

/// A command, and those below it.
std::string man_command(const CLI::App& command, const std::string& path) {
  std::string text = fmt::format(".SS {}\n{}\n", man_text(path), man_text(command.get_description()));
  for (const CLI::Option* option : command.get_options()) {
    if (!option->check_name("--help")) text += man_option(*option);
  }
  for (const CLI::App* inner : command.get_subcommands(nullptr))
    text += man_command(*inner, path + " " + inner->get_name());
  return text;
}

std::string man_keys() {
  std::string text = ".SH KEYS OF CASE FILES\n";
  for (const KeySection& section : key_catalogue()) {
    text += fmt::format(".SS {}\n",
                        man_text(section.heading() + (section.note.empty() ? "" : ", ") + section.note));
    for (const KeyWords& key : section.keys) {
      text += fmt::format(".TP\n\\fB{}\\fR\n{}: {}", man_text(key.name), man_text(key.type + key.allowed),
                          man_text(key.meaning));
      if (!key.unit.empty()) text += ", in " + man_text(key.unit);
      if (!key.otherwise.empty()) text += "; if not given: " + man_text(key.otherwise);
      if (!key.condition.empty()) text += "; " + man_text(key.condition);
      text += "\n";
    }
  }
  return text;
}

}  // namespace

std::string man_page(const CLI::App& program) {
  std::string text = fmt::format(".TH ARCSLIP 1 \"\" \"arcslip {}\" \"User Commands\"\n", release);
  text +=
      ".SH NAME\narcslip \\- trace the response of structures damped by dry friction\n"
      ".SH SYNOPSIS\n\\fBarcslip\\fR \\fICOMMAND\\fR [\\fIARGUMENT\\fR...]\n.SH DESCRIPTION\n" +
      man_text(program.get_description()) + "\n.SH COMMANDS\n";
  for (const CLI::App* command : program.get_subcommands(nullptr))
    text += man_command(*command, command->get_name());
  text += man_keys();
  return text + ".SH EXAMPLES AND EXIT STATUS\n" + man_lines(program.get_footer());
}

}  // namespace arcslip
