#include "results/pattern_results.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <memory>
namespace arcslip {
namespace {

using problems::EnvelopeCurve;
using problems::EnvelopeFamily;

EnvelopeFamily::Curve envelope(const StudyStore& store, std::size_t curve) {
  return std::make_shared<const EnvelopeCurve>(EnvelopeCurve::over_gaps(store.branches(curve)));
}

DesignPatterns of_design(const StudyCase& study, const StudyStore& store, std::size_t design,
                         const std::vector<bool>& failed, double optimum) {
  DesignPatterns found;
  found.curve = design;
  found.optimum = optimum;
  const std::size_t first = design * study.each();
  std::vector<EnvelopeFamily::Curve> rings;
  for (std::size_t i = first + 1; i < first + study.each(); ++i) {
    if (failed[i]) {
      ++found.failed;
    } else {
      rings.push_back(envelope(store, i));
    }
  }
  if (failed[first] || rings.size() < 2) return found;
  found.peaks =
      problems::study_patterns(study.design(first).range, rings, study.uncertain->quantiles, optimum);
  const EnvelopeFamily::Curve equal = envelope(store, first);
  const auto at = [&](double preload) { return std::exp(equal->at(std::log(preload))); };
  for (const problems::QuantileRow& row : found.peaks.rows) found.equal.push_back(at(row.preload));
  found.equal_at_best = at(found.peaks.preload);
  return found;
}

/// Appends a row; what is not known is nan.
class Row {
 public:
  explicit Row(std::string start) : text_(std::move(start)) {}
  Row& add(double value) {
    text_ += fmt::format(",{:.17g}", value);
    return *this;
  }
  void write(const Sink& sink) const { sink(text_ + "\n"); }

 private:
  std::string text_;
};

/// What for_each sets.
void append_setting(const nlohmann::ordered_json& value, std::string& row) {
  row += ',';
  if (value.is_number_float()) {
    row += fmt::format("{:.17g}", value.get<double>());
  } else {
    append_csv(value.is_string() ? value.get<std::string>() : value.dump(), row);
  }
}

}  // namespace

std::vector<DesignPatterns> design_patterns(const StudyCase& study, const StudyStore& store) {
  std::vector<bool> failed(study.items(), false);
  store.visit(StudyStore::Which::failed, [&](const StoredDesign& design) {
    failed[design.item] = true;
    return true;
  });
  std::vector<DesignPatterns> all;
  store.visit(StudyStore::Which::all, [&](const StoredDesign& design) {
    all.push_back(of_design(study, store, design.curve, failed, design.preload));
    return true;
  });
  return all;
}

void write_pattern_robust(const StudyCase& study, const std::vector<DesignPatterns>& designs,
                          const Sink& sink) {
  std::string names = "curve";
  for (const std::string& key : study.keys) names += "," + key;
  names += ",P_q95,Y_q95,amplification_q95,P_opt,Y_q95_opt,error,sampling_error,failed";
  const bool is_physical = !study.preload_unit.empty();
  if (is_physical) names += fmt::format(",preload_{},Y_q95_m", study.preload_unit);
  sink(names + "\n");
  for (const DesignPatterns& design : designs) {
    const StudyDesign made = study.design(design.curve * study.each());
    std::string start = fmt::format("{}", design.curve);
    for (const std::string& key : study.keys) append_setting(made.values.at(key), start);
    const problems::UncertainPeaks& peaks = design.peaks;
    const bool is_known = !peaks.rows.empty();
    const auto known = [&](double value) { return is_known ? value : std::nan(""); };
    Row row(start);
    row.add(known(peaks.preload)).add(known(peaks.Y)).add(known(peaks.Y / design.equal_at_best));
    row.add(design.optimum)
        .add(known(peaks.Y_nominal))
        .add(known(peaks.error))
        .add(known(peaks.sampling_error));
    row.add(static_cast<double>(design.failed));
    if (is_physical) {
      row.add(known(made.physical->preload(peaks.preload)));
      row.add(known(made.physical->displacement(peaks.Y)));
    }
    row.write(sink);
  }
}

void write_pattern_quantiles(const StudyCase& study, const std::vector<DesignPatterns>& designs,
                             const Sink& sink) {
  const bool is_physical = !study.preload_unit.empty();
  const auto levels = [&](const char* prefix) {
    return fmt::format("{}", fmt::join(quantile_names(*study.uncertain, prefix), ","));
  };
  sink(fmt::format("curve,P,{},{},{},Y_equal{}\n", levels("Y_"), levels("amplification_"), levels("error_"),
                   is_physical ? ",preload_" + study.preload_unit : ""));
  for (const DesignPatterns& design : designs) {
    for (std::size_t i = 0; i < design.peaks.rows.size(); ++i) {
      const problems::QuantileRow& found = design.peaks.rows[i];
      Row row(fmt::format("{}", design.curve));
      row.add(found.preload);
      for (const double Y : found.Y) row.add(Y);
      for (const double Y : found.Y) row.add(Y / design.equal[i]);
      for (const double error : found.errors) row.add(error);
      row.add(design.equal[i]);
      if (is_physical) row.add(study.design(design.curve * study.each()).physical->preload(found.preload));
      row.write(sink);
    }
  }
}

}  // namespace arcslip
