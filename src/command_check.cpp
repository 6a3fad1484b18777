#include <fmt/format.h>

#include "arcslip/case_file.hpp"
#include "commands.hpp"
#include "output.hpp"

namespace arcslip {

int check_command(const std::string& case_path, const std::vector<std::string>& settings) {
  const Case input = read_case(case_path, settings);
  std::string text = fmt::format("{}: {}\n", case_path, input.title.empty() ? "valid" : input.title);
  for (std::size_t i = 0; i < input.branches.size(); ++i) {
    const CaseBranch& branch = input.branches[i];
    const SystemParameters& system = branch.system;
    const std::string values = describe(branch.values);
    const bool in_eta = branch.options.parameter == "eta";
    text += fmt::format("branch {}{}{}\n", i, values.empty() ? "" : ": ", values);
    text +=
        fmt::format("  {} from {:g} to {:g} at {} = {:g}\n", branch.options.parameter, branch.options.from,
                    branch.options.to, in_eta ? "P" : "eta", in_eta ? system.preload : branch.eta);
    text += fmt::format(
        "  {}, n = {}, N = {}, M* = {:g}, gamma = {:g}, K_FD = {:.6g}, zeta = {:g} (base), {:g} (damper), F "
        "= {:g}\n",
        to_string(system.model), system.wave_number, system.elements, system.mass_ratio,
        system.frequency_ratio, system.interface_stiffness, system.base_damping, system.damper_damping,
        system.force);
  }
  print(text);
  return status::done;
}

}  // namespace arcslip
