// Checks the paper's seven statements and prints what was measured for each. Status 1 if one does not hold.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>

#include "statement.hpp"

namespace arcslip::testing {

bool Statement::holds() const {
  return !findings_.empty() && std::all_of(findings_.begin(), findings_.end(),
                                           [](const Finding& finding) { return finding.holds; });
}

std::string Statement::text() const {
  std::string text = fmt::format("{}  {}\n", number_, words_);
  for (const Finding& finding : findings_) {
    text += fmt::format("   {:<5} {:<58} {:<14} {}\n", finding.holds ? "ok" : "WRONG", finding.what,
                        finding.measured, finding.required);
  }
  text += fmt::format("   {}\n", holds() ? "holds" : "DOES NOT HOLD");
  for (const std::string& note : notes_) text += fmt::format("   Note: {}\n", note);
  return text;
}

}  // namespace arcslip::testing

int main() {
  using namespace arcslip::testing;
  constexpr std::array statements = {peaks_and_phases,         best_of_five_preloads, stick_and_slip,
                                     mass_ratio_and_preload,   separated_frequencies, convergence_of_rods,
                                     damper_driven_by_the_base};
  try {
    std::size_t holding = 0;
    for (const auto& measure : statements) {
      const Statement statement = measure();
      fmt::print("{}\n", statement.text());
      holding += static_cast<std::size_t>(statement.holds());
    }
    fmt::print("{} of {} statements hold\n", holding, statements.size());
    return holding == statements.size() ? 0 : 1;
  } catch (const std::exception& error) {
    fmt::print(stderr, "paper_statements: {}\n", error.what());
    return 1;
  }
}
