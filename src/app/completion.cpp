#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>
#include <vector>

#include "app/interface_text.hpp"
#include "cases/key_catalogue.hpp"

namespace arcslip {
namespace {

/// What may follow a command.
struct Place {
  std::string path;                      ///< "arcslip sector plate"
  std::vector<std::string> words;        ///< options and commands below
  std::vector<std::string> with_folder;  ///< options whose value is a folder
  std::vector<std::string> with_value;   ///< those with another
  bool cases = false, folders = false, keys = false;
};

void collect_places(const CLI::App& command, const std::string& path, std::vector<Place>& all) {
  Place place;
  place.path = path;
  for (const CLI::App* inner : command.get_subcommands(nullptr)) place.words.push_back(inner->get_name());
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_positional()) {
      const std::string name = option->get_name(true);
      place.cases = place.cases || name == "CASE";
      place.folders = place.folders || name == "DIR";
      place.keys = place.keys || name == "KEY";
      continue;
    }
    std::vector<std::string> names;
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    place.words.insert(place.words.end(), names.begin(), names.end());
    if (option->get_items_expected_max() == 0 || option->check_name("--set")) continue;
    std::vector<std::string>& kind = option->get_type_name() == "DIR" ? place.with_folder : place.with_value;
    kind.insert(kind.end(), names.begin(), names.end());
  }
  all.push_back(place);
  for (const CLI::App* inner : command.get_subcommands(nullptr))
    collect_places(*inner, path + " " + inner->get_name(), all);
}

std::set<std::string> keys_to_set() {
  std::set<std::string> keys;  // kinds of [system] share some
  for (const KeySection& section : key_catalogue()) {
    for (const KeyWords& key : section.keys) keys.insert(section.name + "." + key.name);
  }
  return keys;
}

/// A pattern of `case`: any of these options behind the path.
std::string pattern(const Place& place, const std::vector<std::string>& options) {
  std::vector<std::string> quoted;
  for (const std::string& option : options) quoted.push_back(fmt::format("'{} {}'", place.path, option));
  return fmt::format("{}", fmt::join(quoted, "|"));
}

/// How a shell offers something.
struct Shell {
  std::string begin, end, previous, words_so_far;
  std::string offer_words, offer_folders, offer_cases, offer_keys, offer_settings;
};

const Shell bash{
    "# Completion of arcslip for bash, written by `arcslip help --completion bash`.\n_arcslip() {\n"
    "  local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} at=arcslip word\n"
    "  COMPREPLY=()\n",
    "}\ncomplete -o filenames -F _arcslip arcslip\n",
    "$before",
    "\"${COMP_WORDS[@]:1:COMP_CWORD-1}\"",
    "mapfile -t -O ${{#COMPREPLY[@]}} COMPREPLY < <(compgen -W '{}' -- \"$current\")",
    "mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -d -- \"$current\")",
    "mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -f -X '!*.toml' -- \"$current\"; compgen -d -- "
    "\"$current\")",
    "mapfile -t -O ${{#COMPREPLY[@]}} COMPREPLY < <(compgen -W '{}' -- \"$current\")",
    "compopt -o nospace; mapfile -t COMPREPLY < <(compgen -S = -W '{}' -- \"$current\")",
};

const Shell zsh{
    "#compdef arcslip\n# Completion of arcslip for zsh, written by `arcslip help --completion "
    "zsh`.\n_arcslip() {\n"
    "  local before=${words[CURRENT-1]} at=arcslip word\n",
    "}\n_arcslip \"$@\"\n",
    "$before",
    "${words[2,CURRENT-1]}",
    "compadd -- {}",
    "_files -/",
    "_files -g '*.toml'",
    "compadd -- {}",
    "compadd -S = -- {}",
};

}  // namespace

std::string completion(const CLI::App& program, const std::string& name) {
  const Shell& shell = name == "zsh" ? zsh : bash;
  std::vector<Place> places;
  collect_places(program, "arcslip", places);
  const std::string keys = fmt::format("{}", fmt::join(keys_to_set(), " "));
  const auto offer = [](const std::string& how, const std::string& words) {
    return fmt::format(fmt::runtime(how), words);
  };
  std::string paths, values, follows;
  for (const Place& place : places) {
    if (place.path != "arcslip") paths += (paths.empty() ? "'" : "|'") + place.path + "'";
    if (!place.with_folder.empty())
      values +=
          fmt::format("    {}) {}; return ;;\n", pattern(place, place.with_folder), shell.offer_folders);
    if (!place.with_value.empty())
      values += fmt::format("    {}) return ;;\n", pattern(place, place.with_value));
    follows += fmt::format("    '{}')\n      {}\n", place.path,
                           offer(shell.offer_words, fmt::format("{}", fmt::join(place.words, " "))));
    if (place.cases) follows += "      " + shell.offer_cases + "\n";
    if (place.folders) follows += "      " + shell.offer_folders + "\n";
    if (place.keys) follows += "      " + offer(shell.offer_keys, keys) + "\n";
    follows += "      ;;\n";
  }
  return shell.begin +
         fmt::format(
             "  for word in {}; do\n    case \"$at $word\" in\n      {}) at=\"$at $word\" ;;\n"
             "    esac\n  done\n",
             shell.words_so_far, paths) +
         fmt::format("  case \"$at {}\" in\n    *' --set') {}; return ;;\n{}  esac\n", shell.previous,
                     offer(shell.offer_settings, keys), values) +
         "  case \"$at\" in\n" + follows + "  esac\n" + shell.end;
}

}  // namespace arcslip
