#include "study_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <memory>

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
  std::vector<std::unique_ptr<AtomicFile>> files;
  const auto write = [&](const char* name, const std::function<void(const Sink&)>& table) {
    files.push_back(std::make_unique<AtomicFile>(folder + "/" + name));
    table([&](std::string_view text) { files.back()->write(text); });
    files.back()->sync();
  };
  if (study.sweep) write("sweep.csv", [&](const Sink& sink) { store.write_sweep(sink); });
  if (store.has_quantiles()) write("quantiles.csv", [&](const Sink& sink) { store.write_quantiles(sink); });
  if (store.has_robust()) write("robust.csv", [&](const Sink& sink) { store.write_robust(sink); });
  write("optimum.csv", [&](const Sink& sink) { store.write_optimum(sink); });
  write("summary.json", [&](const Sink& sink) { sink(summarize(study, store, work).dump(2) + "\n"); });
  for (const auto& file : files) file->commit();
}

std::string study_table(const StudyCase& study, const StudyStore& store) {
  std::string text = fmt::format("{:>6}", "curve");
  for (const std::string& key : study.keys) text += fmt::format(" {:>{}}", key, width(key));
  text += fmt::format(" {:>13} {:>13} {:>13} {:>13}", "P_opt", "eta_opt", "Y_opt", "ratio_opt");
  if (store.has_robust()) text += fmt::format(" {:>13} {:>13}", "P_q95", "ratio_q95");
  if (study.is_physical) text += fmt::format(" {:>15} {:>13}", "preload_N_per_m", "Y_m");
  text += "  kind\n";
  std::size_t rows = 0;
  store.visit(StudyStore::Which::all, [&](const StoredDesign& design) {
    const auto [values, system, geometry] = study.design(design.curve);
    text += fmt::format("{:>6}", design.curve);
    for (const auto& [key, value] : values.items()) text += fmt::format(" {:>{}}", shown(value), width(key));
    text += fmt::format(" {:>13.8g} {:>13.8g} {:>13.8g} {:>13.6g}", design.preload, design.eta, design.Y,
                        design.ratio);
    if (store.has_robust())
      text += fmt::format(" {:>13.6g} {:>13.6g}", design.robust_preload, design.robust_ratio);
    if (geometry) {
      const PhysicalScale scale(*geometry, system);
      text += fmt::format(" {:>15.6g} {:>13.6g}", scale.preload_per_length(design.preload),
                          scale.displacement(design.Y));
    }
    text += fmt::format("  {}\n", design.kind);
    return ++rows < most_rows;
  });
  if (study.count > most_rows) text += fmt::format("... and {} more\n", study.count - most_rows);
  return text;
}

}  // namespace arcslip
