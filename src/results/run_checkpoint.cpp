#include "results/run_checkpoint.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "arcslip/version.hpp"
#include "keys/printable.hpp"
#include "results/atomic_file.hpp"

namespace arcslip {
namespace {

using nlohmann::ordered_json;

constexpr const char* signature = "arcslip-run-checkpoint-1";

std::string path_in(const std::string& folder) { return folder + "/run.checkpoint"; }

}  // namespace

std::string case_difference(nlohmann::json then, nlohmann::json now) {
  for (nlohmann::json* input : {&then, &now}) {
    if (input->contains("continuation")) input->at("continuation").erase("max_seconds");
  }
  const nlohmann::json all = nlohmann::json::diff(then, now);
  return all.empty() ? "" : printable(all.front().value("path", "").substr(1));
}

void write_checkpoint(const std::string& folder, const CasePlan& plan, const RunCheckpoint& checkpoint,
                      const Journals& journals) {
  std::vector<std::size_t> left;
  for (const auto& [request, journal] : journals) left.push_back(request);
  const ordered_json head = {{"arcslip", release},
                             {"case", plan.resolved},
                             {"requests", checkpoint.requests},
                             {"branches", checkpoint.branches},
                             {"points", checkpoint.points},
                             {"complete", checkpoint.complete},
                             {"header", checkpoint.header},
                             {"left", left}};
  std::ostringstream text;
  text << signature << '\n' << head.dump() << '\n';
  for (const auto& [request, journal] : journals) journal.write(text);
  AtomicFile file(path_in(folder));
  file.write(text.view());
  file.commit();
}

RunCheckpoint read_checkpoint(const std::string& folder, const CasePlan& plan, Journals& journals) {
  const auto refuse = [&](const std::string& why) {
    return InputError(
        fmt::format("{}: --resume: {}; without --resume the run is begun anew", path_in(folder), why));
  };
  std::ifstream file(path_in(folder), std::ios::binary);
  if (!file) throw refuse("there is no interrupted run in this folder");
  std::string first;
  std::string line;
  std::getline(file, first);
  std::getline(file, line);
  try {
    if (first != signature) throw refuse("it is no checkpoint of a run");
    const auto head = nlohmann::json::parse(line);
    const auto version = head.at("arcslip").get<std::string>();
    if (version != release)
      throw refuse(fmt::format("it was begun by arcslip {}, this is {}", printable(version), release));
    const auto other =
        case_difference(head.at("case"), nlohmann::json::parse(ordered_json(plan.resolved).dump()));
    if (!other.empty()) throw refuse(fmt::format("it is a run of another case, which differs in {}", other));
    for (const std::size_t request : head.at("left").get<std::vector<std::size_t>>())
      journals[request].read(file);
    return {head.at("requests"), head.at("branches"), head.at("points"), head.at("complete"),
            head.at("header")};
  } catch (const InputError&) {
    throw;
  } catch (const std::exception&) {
    throw refuse("it is damaged");
  }
}

void remove_checkpoint(const std::string& folder) {
  std::error_code ignored;
  std::filesystem::remove(path_in(folder), ignored);
}

}  // namespace arcslip
