#include "results/solution_results.hpp"

#include <fmt/format.h>

namespace arcslip {

using nlohmann::ordered_json;

ordered_json solutions_to_json(const problems::SolutionCount& solutions) {
  ordered_json json = {{"count", solutions.count}, {"complete", "unknown"}, {"reason", solutions.reason}};
  if (solutions.complete) json["complete"] = *solutions.complete;
  if (solutions.box.empty()) return json;
  ordered_json& box = json["box"] = ordered_json::array();
  for (const Interval& side : solutions.box) box.push_back({side.lower(), side.upper()});
  return json;
}

std::string solutions_sentence(const ordered_json& told) {
  const auto count = told.at("count").get<std::size_t>();
  const ordered_json& complete = told.at("complete");
  return fmt::format("{} solution{}, complete: {}: {}.", count, count == 1 ? "" : "s",
                     complete.is_string() ? "unknown" : complete.dump(),
                     told.at("reason").get<std::string>());
}

std::string describe_solutions(const CaseBranch& request, const problems::SolutionCount& solutions) {
  return fmt::format("at {} = {:.10g}: {}\n", request.options.parameter, request.start.value_or(0),
                     solutions_sentence(solutions_to_json(solutions)));
}

}  // namespace arcslip
