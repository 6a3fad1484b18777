#include "study_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "output.hpp"

namespace arcslip {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t most_rows = 40;

ordered_json summarize(const StudyCase& study, const StudyStore& store, const StudyWork& work) {
  ordered_json failed = ordered_json::array();
  store.visit(StudyStore::Which::failed, [&](const StoredDesign& design) {
    failed.push_back({{"curve", design.curve},
                      {"values", study.design(design.curve).values},
                      {"failure", design.failure}});
    return true;
  });
  return {{"arcslip", ARCSLIP_VERSION}, {"title", study.title},
          {"case", study.resolved},     {"designs", study.count},
          {"failed", failed},           {"computed", work.computed},
          {"seconds", work.seconds},    {"designs_per_second", work.rate()}};
}

std::size_t width(const std::string& key) { return std::max<std::size_t>(key.size(), 10); }

std::string shown(const ordered_json& value) {
  if (value.is_number_float()) return fmt::format("{:.6g}", value.get<double>());
  return value.is_string() ? value.get<std::string>() : value.dump();
}

}  // namespace

void write_results(const std::string& folder, const StudyCase& study, const StudyStore& store,
                   const StudyWork& work) {
  AtomicFile optimum(folder + "/optimum.csv");
  std::optional<AtomicFile> sweep;
  AtomicFile summary(folder + "/summary.json");
  store.write_optimum([&](std::string_view text) { optimum.write(text); });
  if (study.sweep) {
    sweep.emplace(folder + "/sweep.csv");
    store.write_sweep([&](std::string_view text) { sweep->write(text); });
    sweep->sync();
  }
  summary.write(summarize(study, store, work).dump(2) + "\n");
  optimum.sync();
  summary.sync();
  if (sweep) sweep->commit();
  optimum.commit();
  summary.commit();
}

std::string study_table(const StudyCase& study, const StudyStore& store) {
  std::string text = fmt::format("{:>6}", "curve");
  for (const std::string& key : study.keys) text += fmt::format(" {:>{}}", key, width(key));
  text += fmt::format(" {:>13} {:>13} {:>13} {:>13}  kind\n", "P_opt", "eta_opt", "Y_opt", "ratio_opt");
  std::size_t rows = 0;
  store.visit(StudyStore::Which::all, [&](const StoredDesign& design) {
    const ordered_json values = study.design(design.curve).values;
    text += fmt::format("{:>6}", design.curve);
    for (const auto& [key, value] : values.items()) text += fmt::format(" {:>{}}", shown(value), width(key));
    text += fmt::format(" {:>13.8g} {:>13.8g} {:>13.8g} {:>13.6g}  {}\n", design.preload, design.eta,
                        design.Y, design.ratio, design.kind);
    return ++rows < most_rows;
  });
  if (study.count > most_rows) text += fmt::format("... and {} more\n", study.count - most_rows);
  return text;
}

}  // namespace arcslip
