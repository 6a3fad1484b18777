#include "results/answer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <map>
#include <system_error>

#include "cases/key_catalogue.hpp"
#include "cases/unit_names.hpp"

namespace arcslip {

std::string length_text(double metres) {
  struct Unit {
    double size;
    const char* name;
  };
  constexpr std::array units = {Unit{1, "m"}, Unit{1e-3, "mm"}, Unit{1e-6, "um"}, Unit{1e-9, "nm"}};
  const auto fits = [&](const Unit& unit) { return std::abs(metres) >= unit.size; };
  const auto unit = std::find_if(units.begin(), units.end() - 1, fits);
  return fmt::format("{:.4g} {}", metres / unit->size, unit->name);
}

std::string setting_text(const std::string& key, const std::string& value) {
  static const std::map<std::string, std::string> units = [] {
    std::map<std::string, std::string> found;
    for (const KeySection& section : key_catalogue()) {
      if (section.name != "geometry") continue;
      for (const KeyWords& words : section.keys) found[words.name] = words.unit;
    }
    return found;
  }();
  const auto unit = units.find(key);
  return fmt::format("{} = {}{}{}", key, value, unit == units.end() || unit->second.empty() ? "" : " ",
                     unit == units.end() ? "" : unit->second);
}

namespace {

using nlohmann::ordered_json;
using Sentences = std::vector<std::string>;

/// Quantities as sentences name them.
struct Units {
  explicit Units(const Findings& findings)
      : physical(!findings.preload_unit.empty()),
        unit(findings.preload_unit),
        objective(findings.objective) {}

  std::string preload(double value) const {
    return physical ? fmt::format("{:.4g} {}", value, unit) : fmt::format("P = {:.4g}", value);
  }
  std::string range(double low, double high) const {
    return physical ? fmt::format("{:.4g} to {:.4g} {}", low, high, unit)
                    : fmt::format("P = {:.4g} to {:.4g}", low, high);
  }
  std::string frequency(double value) const {
    return physical ? fmt::format("{:.5g} Hz", value) : fmt::format("eta = {:.5g}", value);
  }
  std::string height(double value) const {
    return physical ? length_text(value) : fmt::format("{} = {:.4g}", objective, value);
  }
  /// Without the name of the quantity.
  std::string bare_height(double value) const {
    return physical ? length_text(value) : fmt::format("{:.4g}", value);
  }

  bool physical;
  std::string unit;
  std::string objective;
};

/// How a height compares with that of the base alone.
std::string reduction(double ratio) {
  if (!std::isfinite(ratio)) return "";
  if (ratio < 1e-8) return "while that of the free base, which nothing damps, has no bound";
  if (ratio < 0.02) {
    const double digits = std::pow(10, std::floor(std::log10(1 / ratio)) - 2);  // three of them
    return fmt::format("{:.0f} times lower than that of the free base",
                       digits * std::round(1 / ratio / digits));
  }
  if (ratio < 0.995) return fmt::format("{:.0f} % below the free base", 100 * (1 - ratio));
  if (ratio > 1.005) return fmt::format("{:.0f} % above the free base", 100 * (ratio - 1));
  return "as high as that of the free base";
}

std::string main_sentence(const BestPreload& best, const Units& units) {
  const std::string compared = reduction(best.ratio);
  return fmt::format("Best preload {}: highest peak {} at {}{}{}.", units.preload(best.preload),
                     units.height(best.peak), units.frequency(best.frequency), compared.empty() ? "" : ", ",
                     compared);
}

/// What kind of an optimum it is, where that is worth a sentence.
std::string kind_sentence(const BestPreload& best) {
  if (best.kind == "exchange") return "There two peaks are as high as each other.";
  if (best.kind == "corner") return "There the highest peak changes between stick and slip, with a kink.";
  if (best.kind == "jump") return "It lies beside a jump, behind which the response has a higher peak.";
  if (best.kind == "flat") return "The highest peak is the same over a range of preloads about it.";
  if (best.kind == "end") return "It is an end of the range of preloads: beyond it may lie a better one.";
  return "";
}

Sentences of_design(const BestPreload& best, const Units& units) {
  Sentences sentences;
  if (const std::string kind = kind_sentence(best); !kind.empty()) sentences.push_back(kind);
  if (best.from_end && best.to_end) {
    sentences.push_back("The highest peak is within a factor 2 of that at every preload of the range.");
  } else if (std::isfinite(best.low) && std::isfinite(best.high)) {
    sentences.push_back(fmt::format("The highest peak is within a factor 2 of that from {}{}.",
                                    units.range(best.low, best.high),
                                    best.from_end ? ", from the low end of the range on"
                                    : best.to_end ? ", the high end of the range"
                                                  : ""));
  }
  if (best.scatter) {
    sentences.push_back(
        fmt::format("With scatter the best preload is {}: 95 % of all stay below {}; made for {} they would "
                    "stay below {}.",
                    units.preload(best.scatter->preload), units.height(best.scatter->peak),
                    units.preload(best.preload), units.bare_height(best.scatter->peak_at_best)));
  }
  return sentences;
}

/// Whether the damper does more in the first design: its peak is lower, compared with that of the free base
/// where this is known.
bool is_better(const BestPreload* a, const BestPreload* b) {
  const bool compares = std::isfinite(a->ratio) && std::isfinite(b->ratio);
  return compares ? a->ratio < b->ratio : a->peak < b->peak;
}

/// Between what the designs lie.
std::string spread(const std::vector<const BestPreload*>& done, const Units& units) {
  const auto ends = [&](double BestPreload::*value) {
    const auto [low, high] = std::minmax_element(
        done.begin(), done.end(), [&](const auto* a, const auto* b) { return a->*value < b->*value; });
    return std::pair((*low)->*value, (*high)->*value);
  };
  const auto [low, high] = ends(&BestPreload::preload);
  const auto [least, most] = ends(&BestPreload::peak);
  std::string text = fmt::format("Of all designs the best preloads are {}, their highest peaks {} to {}",
                                 units.range(low, high), units.height(least), units.bare_height(most));
  if (std::all_of(done.begin(), done.end(), [](const auto* best) { return std::isfinite(best->ratio); })) {
    const auto [deepest, highest] = ends(&BestPreload::ratio);
    text += fmt::format(", {:.3g} to {:.3g} of those of the free base", deepest, highest);
  }
  return text + ".";
}

}  // namespace

std::vector<std::string> study_answer(const Findings& findings) {
  const Units units(findings);
  std::vector<const BestPreload*> done;
  for (const BestPreload& design : findings.designs) {
    if (design.kind != "failed") done.push_back(&design);
  }
  Sentences sentences;
  if (!done.empty()) {
    const BestPreload& best = **std::min_element(done.begin(), done.end(), is_better);
    const std::size_t count = findings.designs.size();
    sentences.push_back(
        (count == 1 ? "" : fmt::format("Of {} designs the damper does most with {}. ", count, best.design)) +
        main_sentence(best, units));
    for (std::string& sentence : of_design(best, units)) sentences.push_back(std::move(sentence));
  }
  if (done.size() > 1) sentences.push_back(spread(done, units));
  if (const std::size_t failed = findings.designs.size() - done.size(); failed > 0)
    sentences.push_back(fmt::format("{} of {} designs failed.", failed, findings.designs.size()));
  return sentences;
}

namespace {

/// The columns that a table has of these, the others empty.
class Fields {
 public:
  explicit Fields(const ResultTable& table) : table_(table) {}

  void begin(const std::vector<std::string>& row) { row_ = &row; }

  const std::string& text(const std::string& name) const { return (*row_)[table_.place(name)]; }

  /// nan where the column is missing or holds no number.
  double number(const std::string& name) const {
    if (!table_.has(name)) return std::numeric_limits<double>::quiet_NaN();
    const std::string& field = text(name);
    char* end = nullptr;
    const double value = std::strtod(field.c_str(), &end);
    return end == field.c_str() ? std::numeric_limits<double>::quiet_NaN() : value;
  }

  /// "mass_ratio = 5, frequency_ratio = 4": what stands between the first column and `after`.
  std::string design(const std::string& after) const {
    std::string told;
    for (std::size_t i = 1; i < table_.place(after); ++i) {
      const double value = number(table_.columns()[i]);
      told +=
          (told.empty() ? "" : ", ") +
          setting_text(table_.columns()[i], std::isnan(value) ? (*row_)[i] : fmt::format("{:.6g}", value));
    }
    return told;
  }

 private:
  const ResultTable& table_;
  const std::vector<std::string>* row_ = nullptr;
};

bool same(double a, double b) { return std::abs(a - b) <= 1e-12 * std::abs(b); }

/// The suffix of columns of preloads: "N_per_m" or "N", and "" where there are none.
std::string preload_suffix(const ResultTable& table) {
  for (const char* suffix : {"N_per_m", "N"}) {
    if (table.has(std::string("preload_") + suffix)) return suffix;
  }
  return "";
}

BestPreload best_preload(const Fields& row, const ordered_json& study, const std::string& unit) {
  const bool is_physical = !unit.empty();
  BestPreload best;
  best.design = row.design("P_opt");
  best.kind = row.text("kind");
  best.preload = row.number(is_physical ? "preload_" + unit : "P_opt");
  best.low = row.number(is_physical ? "preload_low_" + unit : "P_low");
  best.high = row.number(is_physical ? "preload_high_" + unit : "P_high");
  const bool in_units = study.value("parameter", "P") != "P";
  best.from_end = same(in_units ? best.low : row.number("P_low"), study.at("from").get<double>());
  best.to_end = same(in_units ? best.high : row.number("P_high"), study.at("to").get<double>());
  best.frequency = row.number(is_physical ? "frequency_Hz" : "eta_opt");
  best.peak = row.number(is_physical ? "Y_m" : "Y_opt");
  best.ratio = row.number("ratio_opt");
  return best;
}

}  // namespace

Findings findings_of(const ordered_json& input, const ResultTable& optimum, const ResultTable* robust) {
  const ordered_json& study = input.at("study");
  Findings findings;
  findings.objective = study.value("objective", "Y");
  const std::string unit = findings.objective == "Y" ? preload_suffix(optimum) : "";
  if (!unit.empty()) findings.preload_unit = unit_in_words(unit);
  Fields row(optimum);
  optimum.for_each_row([&](const std::vector<std::string>& fields) {
    row.begin(fields);
    findings.designs.push_back(best_preload(row, study, unit));
  });
  if (robust == nullptr) return findings;
  Fields of_scatter(*robust);
  std::size_t design = 0;
  robust->for_each_row([&](const std::vector<std::string>& fields) {
    of_scatter.begin(fields);
    if (design >= findings.designs.size()) return;
    const double peak = of_scatter.number("Y_q95");
    const double length = unit.empty() ? 1 : of_scatter.number("Y_q95_m") / peak;
    BestPreload::Scatter scatter{of_scatter.number(unit.empty() ? "P_q95" : "preload_" + unit), peak * length,
                                 of_scatter.number("Y_q95_opt") * length};
    if (std::isfinite(peak)) findings.designs[design].scatter = scatter;
    ++design;
  });
  return findings;
}

std::vector<std::string> study_answer(const std::string& folder, const ordered_json& input) {
  const std::filesystem::path place = folder;
  const ResultTable optimum(place / "optimum.csv",
                            {"curve", "P_opt", "eta_opt", "Y_opt", "ratio_opt", "kind", "P_low", "P_high"},
                            "designs");
  std::optional<ResultTable> robust;
  std::error_code none;
  if (std::filesystem::exists(place / "robust.csv", none))
    robust.emplace(place / "robust.csv", std::vector<std::string>{"curve", "P_q95", "Y_q95", "Y_q95_opt"},
                   "designs");
  return study_answer(findings_of(input, optimum, robust ? &*robust : nullptr));
}

}  // namespace arcslip
