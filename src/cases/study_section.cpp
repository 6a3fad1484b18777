#include "cases/study_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <tuple>

#include "cases/unit_names.hpp"

namespace arcslip {
namespace {

using problems::Scatter;
using problems::Uncertainty;

void read_frequencies(StudyCase& study, const TomlSection& section) {
  study.frequency_as = frequency_key(section);
  std::tie(study.range.eta_low, study.range.eta_high) =
      section.rising(study.frequency_as, "two numbers, 0 < low < high, between which peaks are sought");
}

void read_uniform(Scatter& scatter, const TomlSection& section) {
  scatter.kind = Scatter::Kind::uniform;
  std::tie(scatter.low, scatter.high) =
      section.rising("uniform", "two factors of the nominal value, 0 < low < high");
}

const KeyTable<Scatter>& scatter_keys() {
  using ScatterKey = Key<Scatter>;
  const auto is_lognormal = [](Scatter& scatter, const TomlSection&) {
    scatter.kind = Scatter::Kind::lognormal;
  };
  static const KeyTable<Scatter> keys{
      {ScatterKey("lognormal", &Scatter::deviation, up_to(1),
                  "standard deviation of the logarithm, whose median is 0", then(is_lognormal), unresolved),
       ScatterKey::special("uniform", "two numbers", "range, in place of lognormal", read_uniform)}};
  return keys;
}

template <class... Term>
Key<Uncertainty> factor(const std::string& name, Scatter Uncertainty::*member, const Term&... term) {
  const auto check = [=](const Uncertainty&, const TomlSection& section) {
    const TomlSection given = section.inside(name, "a table");
    if (given.has("lognormal") == given.has("uniform"))
      section.fail(name, "expected { lognormal = ... } or { uniform = [...] }");
  };
  return Key<Uncertainty>::table(name, member, scatter_keys(),
                                 "at least one of mu, preload and force, or patterns of a whole ring",
                                 "a table", "distribution of the factor on its nominal value", unresolved,
                                 then(check), otherwise("1"), term...);
}

void check_quantiles(const Uncertainty& uncertainty, const TomlSection& section) {
  const std::vector<double>& q = uncertainty.quantiles;
  if (q.empty() || std::adjacent_find(q.begin(), q.end(), std::greater_equal<>()) != q.end())
    section.mismatch("quantiles", "an array of rising numbers > 0 and < 1");
}

void check_patterns(const Uncertainty& uncertainty, const TomlSection& section) {
  for (const char* other : {"mu", "preload", "force", "samples", "seed"}) {
    if (uncertainty.patterns > 0 && section.has(other))
      section.fail(other, "not beside patterns, which the seeds in [ring] give");
  }
}

}  // namespace

const KeyTable<Uncertainty>& uncertain_keys() {
  using UncertainKey = Key<Uncertainty>;
  static const KeyTable<Uncertainty> keys{
      {factor("mu", &Uncertainty::friction,
              needed("1; one of these three, or patterns, is needed", lacks("preload", "force", "patterns"))),
       factor("preload", &Uncertainty::preload), factor("force", &Uncertainty::force),
       UncertainKey("samples", &Uncertainty::samples, within(100, 1e6, " >= 100 and <= 1e6"),
                    "of a Latin hypercube"),
       UncertainKey("seed", &Uncertainty::seed, at_least(0),
                    "the same one gives the same samples everywhere"),
       UncertainKey("quantiles", &Uncertainty::quantiles, inside(0, 1),
                    "of the highest peak, at every preload", then(check_quantiles)),
       UncertainKey("patterns", &Uncertainty::patterns, within(10, 1e6, " >= 10 and <= 1e6"),
                    "of whole rings: so many are made as `[ring]` scatters, and nothing else is sampled",
                    otherwise("none"), then(check_patterns), resolved([](const Uncertainty& uncertainty) {
                      return uncertainty.patterns > 0 ? nlohmann::ordered_json(uncertainty.patterns)
                                                      : nlohmann::ordered_json();
                    }))}};
  return keys;
}

const KeyTable<StudyCase>& study_keys() {
  using StudyKey = Key<StudyCase>;
  using problems::PreloadRange;
  const auto above = [](const StudyCase& study) {
    return NumberRule{[from = study.range.from](double to) { return to > from; },
                      fmt::format(" > study.from = {:g}", study.range.from)};
  };
  const auto uncertain = [](const StudyCase& study) {
    return study.uncertain ? uncertain_keys().values(*study.uncertain) : nlohmann::ordered_json();
  };
  const auto objective = [](const StudyCase& study) { return nlohmann::ordered_json(study.objective); };
  static const std::vector<std::string> swept = {"P", preload_names[0], preload_names[1]};
  static const KeyTable<StudyCase> keys{
      {StudyKey::special(
           "parameter", one_of(swept), "what is swept, in SI units where the system is given in them",
           [](StudyCase& study, const TomlSection& section) {
             study.preload_as = section.text("parameter", swept);
           },
           required),
       StudyKey("from", at(&StudyCase::range, &PreloadRange::from), positive(), "lowest preload", required),
       StudyKey("to", at(&StudyCase::range, &PreloadRange::to), {" > from", above}, "highest preload",
                required),
       StudyKey::special("eta", "two numbers",
                         "the window of frequencies in which peaks are sought; one on its edge counts",
                         read_frequencies, needed("required, or frequency_Hz", lacks(frequency_name))),
       StudyKey::special(frequency_name, "two numbers", "the same in Hz, of systems in SI units",
                         read_frequencies, unit("Hz")),
       StudyKey::special("for_each", "table, or list of tables",
                         "the designs: values of keys of `[system]` and `[geometry]`, each with each", {}),
       StudyKey::special(
           "objective", "name", "the quantity whose highest peak is to be low, one with a gradient",
           [](StudyCase& study, const TomlSection& section) {
             study.objective = section.text("objective", {});
           },
           resolved(objective), otherwise("`\"Y\"`")),
       StudyKey::flag("sweep", &StudyCase::sweep, "whether `sweep.csv` and `quantiles.csv` are wanted"),
       StudyKey::special(
           "uncertain", "table", "what scatters",
           [](StudyCase& study, const TomlSection& section) {
             uncertain_keys().read(study.uncertain.emplace(), section.inside("uncertain", "a table"));
           },
           resolved(uncertain), otherwise("nothing"))}};
  return keys;
}

}  // namespace arcslip
