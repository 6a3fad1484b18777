#pragma once

// What is told of all solutions at one value of the parameter.

#include <nlohmann/json.hpp>
#include <string>

#include "arcslip/cases/case_file.hpp"
#include "arcslip/problems/tasks/all_solutions.hpp"

namespace arcslip {

/// For summary.json: how many, whether these are all, true, false or "unknown", and why; and the box.
nlohmann::ordered_json solutions_to_json(const problems::SolutionCount& solutions);

/// The same of such a summary as a sentence.
std::string solutions_sentence(const nlohmann::ordered_json& told);

/// A line for the terminal.
std::string describe_solutions(const CaseBranch& request, const problems::SolutionCount& solutions);

}  // namespace arcslip
