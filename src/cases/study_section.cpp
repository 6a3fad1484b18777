#include "cases/study_section.hpp"

#include <fmt/format.h>

#include <tuple>

#include "cases/uncertain_section.hpp"

namespace arcslip {
namespace {

void read_window(StudyCase& study, const TomlSection& section) {
  std::tie(study.range.eta_low, study.range.eta_high) =
      section.rising("eta", "two numbers, 0 < low < high, between which peaks are sought");
}

}  // namespace

const KeyTable<StudyCase>& study_keys() {
  using S = StudyCase;
  using K = Key<S>;
  using problems::PreloadRange;
  const auto above = [](const S& study) {
    return NumberRule{[from = study.range.from](double to) { return to > from; },
                      fmt::format(" > study.from = {:g}", study.range.from)};
  };
  const auto uncertain = [](const S& study) {
    return study.uncertain ? uncertain_keys().values(*study.uncertain) : nlohmann::ordered_json();
  };
  static const KeyTable<S> keys{
      {K::special(
           "parameter", "\"P\"", "what is swept",
           [](S&, const TomlSection& section) { section.text("parameter", {"P"}); }, required),
       K("from", at(&S::range, &PreloadRange::from), positive(), "lowest preload", required),
       K("to", at(&S::range, &PreloadRange::to), {" > from", above}, "highest preload", required),
       K::special("eta", "two numbers",
                  "the window of frequencies in which peaks are sought; one on its edge counts", read_window,
                  required),
       K::special("for_each", "table, or list of tables",
                  "the designs: values of keys of `[system]` and `[geometry]`, each with each", {}),
       K::flag("sweep", &S::sweep, "whether `sweep.csv` and `quantiles.csv` are wanted"),
       K::special(
           "uncertain", "table", "what scatters",
           [](S& study, const TomlSection& section) {
             uncertain_keys().read(study.uncertain.emplace(), section.inside("uncertain", "a table"));
           },
           resolved(uncertain), otherwise("nothing"))}};
  return keys;
}

}  // namespace arcslip
