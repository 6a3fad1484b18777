#include "results/study_results.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <span>

#include "arcslip/version.hpp"
#include "results/atomic_file.hpp"
#include "results/pattern_results.hpp"
#include "results/summary_file.hpp"

namespace arcslip {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t most_rows = 40;

/// Which designs of a study of many: in 3 of 40 designs (curves 0, 7, 8).
std::string places(const std::vector<std::size_t>& curves, std::size_t count) {
  constexpr std::size_t most = 10;
  if (count == 1) return "";
  const auto shown = std::span(curves).first(std::min(most, curves.size()));
  return fmt::format(" in {} of {} designs (curve{} {}{})", curves.size(), count,
                     curves.size() == 1 ? "" : "s", fmt::join(shown, ", "),
                     curves.size() > most ? ", ..." : "");
}

/// What the numbers do not say of themselves, in sentences.
std::vector<std::string> remarks(const StudyCase& study, const StudyStore& store,
                                 const std::vector<HarmonicsCheck>& checks) {
  const problems::PreloadRange& range = study.range;
  const bool is_same = study.frequency_as == "eta";  // of all designs
  std::vector<std::size_t> without_resonance, at_end;
  store.visit(StudyStore::Which::all, [&](const StoredDesign& design) {
    if (design.kind == "failed") return true;
    const problems::PreloadRange own = is_same ? range : study.design(design.item).range;
    const bool on_edge = design.free_eta == own.eta_low || design.free_eta == own.eta_high;
    if (on_edge) without_resonance.push_back(design.curve);
    if (design.kind == "end") at_end.push_back(design.curve);
    return true;
  });
  std::vector<std::string> sentences;
  if (!without_resonance.empty())
    sentences.push_back(fmt::format(
        "Without damper Y is highest on an end of the window {} = {:g} to {:g}, not at a "
        "resonance in it{}: the ratio compares with that.",
        study.frequency_as, range.eta_low, range.eta_high, places(without_resonance, study.count)));
  if (!at_end.empty())
    sentences.push_back(fmt::format(
        "Y_max is lowest on an end of the range {} = {:g} to {:g}{}: beyond it may lie a better preload.",
        study.preload_as, range.from, range.to, places(at_end, study.count)));
  const std::vector<std::string> of_checks = sentences_of(checks, study.count);
  sentences.insert(sentences.end(), of_checks.begin(), of_checks.end());
  return sentences;
}

ordered_json summarize(const StudyCase& study, const StudyStore& store, const StudyWork& work) {
  ordered_json failed = ordered_json::array();
  store.visit(StudyStore::Which::failed, [&](const StoredDesign& design) {
    failed.push_back(
        {{"curve", design.curve}, {"values", study.design(design.item).values}, {"failure", design.failure}});
    return true;
  });
  return {{"arcslip", release},
          {"title", study.title},
          {"case", study.resolved},
          {"designs", study.count},
          {"patterns", study.patterns},
          {"failed", failed},
          {"harmonics", harmonics_of(study, store)},
          {"more_harmonics", to_json(work.checks)},
          {"remarks", remarks(study, store, work.checks)},
          {"computed", work.computed},
          {"threads", work.threads},
          {"seconds", work.seconds},
          {"designs_per_second", work.rate()}};
}

std::size_t width(const std::string& key) { return std::max<std::size_t>(key.size(), 10); }

std::string shown(const ordered_json& value) {
  if (value.is_number_float()) return fmt::format("{:.6g}", value.get<double>());
  return value.is_string() ? value.get<std::string>() : value.dump();
}

}  // namespace

std::string in_words(double seconds) {
  if (seconds < 120) return fmt::format("{:.0f} s", seconds);
  if (seconds < 7200) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

std::string plan_of(std::size_t designs, const StudyWork& work) {
  constexpr double settled = 3;  // seconds
  constexpr double short_study = 60;
  if (work.computed < 2 * work.threads || work.seconds < settled) return "";
  const double total = static_cast<double>(designs) / work.rate();
  if (total < short_study) return "";
  const double each = static_cast<double>(work.threads) / work.rate();
  return fmt::format("{} designs on {} thread{}, {:.2g} {} each: about {}", designs, work.threads,
                     work.threads == 1 ? "" : "s", each < 1 ? 1e3 * each : each, each < 1 ? "ms" : "s",
                     in_words(total));
}

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
  if (study.patterns > 0) {
    const std::vector<DesignPatterns> designs = design_patterns(study, store);
    write("patterns.csv", [&](const Sink& sink) { store.write_patterns(sink); });
    write("robust.csv", [&](const Sink& sink) { write_pattern_robust(study, designs, sink); });
    if (study.sweep)
      write("quantiles.csv", [&](const Sink& sink) { write_pattern_quantiles(study, designs, sink); });
  }
  write("optimum.csv", [&](const Sink& sink) { store.write_optimum(sink); });
  write("summary.json", [&](const Sink& sink) {
    ordered_json summary = summarize(study, store, work);
    if (std::optional<ordered_json> of_run = run_summary(folder)) {
      (*of_run)["study"] = std::move(summary);
      summary = std::move(*of_run);
    }
    sink(summary.dump(2) + "\n");
  });
  for (const auto& file : files) file->commit();
}

std::string study_table(const StudyCase& study, const StudyStore& store, const StudyWork& work) {
  std::string text = fmt::format("{:>6}", "curve");
  for (const std::string& key : study.keys) text += fmt::format(" {:>{}}", key, width(key));
  text += fmt::format(" {:>13} {:>13} {:>13} {:>13}", "P_opt", "eta_opt", "Y_opt", "ratio_opt");
  if (store.has_robust()) text += fmt::format(" {:>13} {:>13}", "P_q95", "ratio_q95");
  if (!study.preload_unit.empty())
    text += fmt::format(" {:>15} {:>13}", "preload_" + study.preload_unit, "Y_m");
  text += "  kind\n";
  std::size_t rows = 0;
  store.visit(StudyStore::Which::all, [&](const StoredDesign& design) {
    const StudyDesign made = study.design(design.item);
    text += fmt::format("{:>6}", design.curve);
    for (const auto& [key, value] : made.values.items())
      text += fmt::format(" {:>{}}", shown(value), width(key));
    text += fmt::format(" {:>13.8g} {:>13.8g} {:>13.8g} {:>13.6g}", design.preload, design.eta, design.Y,
                        design.ratio);
    if (store.has_robust())
      text += fmt::format(" {:>13.6g} {:>13.6g}", design.robust_preload, design.robust_ratio);
    if (made.physical) {
      text += fmt::format(" {:>15.6g} {:>13.6g}", made.physical->preload(design.preload),
                          made.physical->displacement(design.Y));
    }
    text += fmt::format("  {}\n", design.kind);
    return ++rows < most_rows;
  });
  if (study.count > most_rows) text += fmt::format("... and {} more\n", study.count - most_rows);
  for (const std::string& sentence : remarks(study, store, work.checks)) text += "\n" + sentence + "\n";
  return text;
}

}  // namespace arcslip
