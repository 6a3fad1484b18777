#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "app/command.hpp"
#include "app/commands.hpp"
#include "app/interface_text.hpp"
#include "app/wrap.hpp"
#include "cases/key_catalogue.hpp"
#include "keys/printable.hpp"
#include "results/output.hpp"

namespace arcslip {
namespace {

struct HelpOptions {
  std::string key;        ///< or a command; empty: all keys
  bool markdown = false;  ///< tables of all keys, as the manual has them
  bool man = false;       ///< the manual page
  std::string shell;      ///< whose completion is asked for
};

/// Without the marks of code.
std::string plain(std::string text) {
  std::erase(text, '`');
  return text;
}

/// With stars that are no marks.
std::string marked(const std::string& text) {
  std::string result;
  bool code = false;
  for (const char c : text) {
    code = code != (c == '`');
    if (!code && (c == '*' || c == '|')) result += '\\';
    result += c;
  }
  return result;
}

/// Both, with what parts them where there are both.
std::string joined(const std::string& text, const char* part, const std::string& more) {
  return text.empty() || more.empty() ? text + more : text + part + more;
}

std::string as_markdown(const KeySection& section) {
  std::string text = fmt::format("| key of {} | is | if not given | means |\n|---|---|---|---|\n",
                                 joined("`" + section.heading() + "`", ", ", section.note));
  for (const KeyWords& key : section.keys)
    text += fmt::format("| `{}` | {} | {} | {} |\n", key.name,
                        marked(joined(key.type + key.allowed, ", ", key.unit)), marked(key.otherwise),
                        marked(joined(key.meaning, "; ", key.condition)));
  return text;
}

/// All that is known of a key, a line each.
std::string explained(const KeySection& section, const KeyWords& key) {
  std::string text = fmt::format("{}.{}: {}\n", section.name, key.name, plain(key.meaning));
  const auto add = [&](const char* what, const std::string& value) {
    if (!value.empty()) text += fmt::format("  {:<14}{}\n", what, plain(value));
  };
  add("of", section.note);
  add("is", key.type + key.allowed);
  add("unit", key.unit);
  add("if not given", key.otherwise);
  add("may be given", key.condition);
  add("continued as", key.parameter);
  add("for_each", key.is_listed ? "may list it" : "");
  return text;
}

/// A line for each key.
std::string told(const KeySection& section) {
  std::string text = plain(joined(section.heading(), ", ", section.note)) + "\n";
  for (const KeyWords& key : section.keys) {
    const std::string choices = key.type.starts_with('"') ? ": " + key.type : "";
    text += fmt::format("  {:<24} {}{}\n", key.name, plain(key.meaning), choices);
  }
  return text;
}

/// Whether a dotted name ends with these words.
bool ends_with(const std::string& name, const std::string& words) {
  return name == words || name.ends_with("." + words);
}

int help_of(const std::string& asked, const std::vector<KeySection>& sections, const CLI::App& app) {
  if (is_command(asked)) {
    print(wrapped(app.get_subcommand(asked)->help(app.get_name())));
    return status::done;
  }
  std::string text;
  std::vector<std::string> names;
  for (const KeySection& section : sections) {
    if (section.name == asked) text += told(section) + "\n";
  }
  for (const KeySection& section : sections) {
    for (const KeyWords& key : section.keys) {
      names.push_back(key.name.substr(key.name.rfind('.') + 1));
      if (ends_with(section.name + "." + key.name, asked)) text += explained(section, key);
    }
  }
  if (!text.empty()) {
    print(wrapped(text));
    return status::done;
  }
  const std::string meant = nearest_name(asked.substr(asked.rfind('.') + 1), names);
  complain(fmt::format("arcslip help: {}: unknown key; {}", printable(asked, longest_name),
                       meant.empty() ? "arcslip help lists all" : "did you mean '" + meant + "'?"));
  return status::wrong_command_line;
}

}  // namespace

std::string list_keys(const std::vector<std::string>& names) {
  std::string text;
  for (const KeySection& section : key_catalogue()) {
    if (!names.empty() && std::find(names.begin(), names.end(), section.name) == names.end()) continue;
    text += (text.empty() ? "" : "\n") + told(section);
  }
  return text;
}

namespace {

int help(const CLI::App& program, const HelpOptions& options) {
  if (options.man || !options.shell.empty()) {
    print(options.man ? man_page(program) : completion(program, options.shell));
    return status::done;
  }
  const std::vector<KeySection> sections = key_catalogue();
  if (!options.key.empty()) return help_of(options.key, sections, program);
  std::string text;
  if (!options.markdown)
    text =
        wrapped(list_keys({}) + "\narcslip help KEY tells all of one, arcslip help COMMAND of a command.\n");
  for (const KeySection& section : sections) {
    if (options.markdown) text += as_markdown(section) + "\n";
  }
  print(text);
  return status::done;
}

Command::Action add_help(CLI::App& app) {
  const auto options = std::make_shared<HelpOptions>();
  CLI::App* command =
      app.add_subcommand("help", "List the keys of case files, or tell all of one or of a command");
  command->add_option("KEY", options->key,
                      "As max_step, or continuation.max_step; a section, as model; or a command");
  command->add_flag("--markdown", options->markdown, "All keys as tables in Markdown");
  command->add_flag("--man", options->man, "The manual page, for man -l");
  command->add_option("--completion", options->shell, "Completion for a shell: bash or zsh")
      ->type_name("SHELL")
      ->check(CLI::IsMember({"bash", "zsh"}));
  return [options, &app] { return help(app, *options); };
}

}  // namespace

Command help_command() { return {"help", add_help}; }

}  // namespace arcslip
