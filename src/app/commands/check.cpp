#include <memory>
#include <string>
#include <vector>

#include "app/command.hpp"
#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "results/case_check.hpp"
#include "results/output.hpp"

namespace arcslip {

namespace {

struct CheckOptions {
  std::string case_path;
  std::vector<std::string> settings;  ///< "section.key=value"
  bool derivatives = false;           ///< compare the problems' derivatives with differences
};

int check(const CheckOptions& options) {
  catch_interrupts();
  const BeforeTheEnd say_so([] { complain("arcslip: interrupted"); });
  const CaseCheck found = check_case(CaseFile(options.case_path, options.settings), options.derivatives);
  print(found.text);
  return found.good ? status::done : status::incomplete_branch;
}

Command::Action add_check(CLI::App& app) {
  const auto options = std::make_shared<CheckOptions>();
  CLI::App* command = app.add_subcommand("check", "Read and validate a case file, print what would run");
  command->add_option("CASE", options->case_path, "Case file (TOML)")->required();
  command->add_flag(
      "--derivatives", options->derivatives,
      "Compare the problem's exact derivatives with differences on the branch; status 3 if one differs");
  add_settings(command, options->settings);
  return [options] { return check(*options); };
}

}  // namespace

Command check_command() { return {"check", add_check}; }

}  // namespace arcslip
