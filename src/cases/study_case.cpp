#include "arcslip/cases/study_case.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cases/continuation_section.hpp"
#include "cases/for_each.hpp"
#include "cases/geometry_section.hpp"
#include "cases/sector_section.hpp"
#include "cases/system_section.hpp"
#include "cases/uncertain_section.hpp"

namespace arcslip {
namespace {

using nlohmann::ordered_json;

/// What the designs are made from.
struct Source {
  std::shared_ptr<const TomlDocument> file;
  std::optional<ForEach> for_each;
  std::shared_ptr<const SectorPair> sectors;
  problems::PreloadRange range;

  ProblemRequest problem(const Replacements& replacements) const {
    ProblemRequest problem;
    read_system(*file, replacements, {nullptr, "P", true, sectors, range.eta_low, range.eta_high}, problem);
    return problem;
  }

  StudyDesign design(std::size_t index) const {
    const TomlDocument& document = *file;
    auto [values, replacements, made] = for_each->at(index);
    const ProblemRequest problem = this->problem(replacements);
    if (problem.system.preload_growth != 0 && scatters(document))
      TomlSection(document, "system", &replacements)
          .fail("preload_growth",
                "not beside [study.uncertain], whose response is proportional to the force");
    return {std::move(values), problem.system, problem.geometry};
  }
};

std::vector<double> read_window(const TomlSection& section) {
  const char* expected = "two numbers, 0 < low < high, between which peaks are sought";
  section.require("eta", expected);
  std::vector<double> window = section.numbers("eta", positive());
  if (window.size() != 2 || !(window[0] < window[1])) section.mismatch("eta", expected);
  return window;
}

problems::PreloadRange read_preloads(const TomlDocument& document, const TomlSection& section) {
  section.text("parameter", {"P"});
  problems::PreloadRange range;
  range.from = section.number("from", positive());
  range.to = section.number(
      "to", {[&](double to) { return to > range.from; }, fmt::format(" > study.from = {:g}", range.from)});
  const std::vector<double> window = read_window(section);
  range.eta_low = window[0];
  range.eta_high = window[1];
  range.stop_at = TomlSection(document, "continuation").numbers("stop_at", within(range.from, range.to));
  return range;
}

/// The input as it is understood, without what belongs to [branch].
ordered_json resolve(const Source& source, const StudyCase& study) {
  ordered_json resolved = to_json(source.file->root());
  resolved.erase("branch");
  ProblemRequest first;
  first.system = study.design(0).system;
  resolve_system(first, resolved["system"]);
  resolved["study"]["sweep"] = study.sweep;
  if (!study.keys.empty()) resolved["study"]["for_each"] = source.for_each->to_json();
  if (study.uncertain) resolve_uncertainty(*study.uncertain, resolved["study"]["uncertain"]);
  resolve_continuation(study.options, resolved["continuation"]);
  return resolved;
}

}  // namespace

StudyCase read_study(const std::string& path, const std::vector<std::string>& settings) {
  return read_study(CaseFile(path, settings));
}

StudyCase read_study(const CaseFile& file) {
  const auto source = std::make_shared<Source>(Source{file.document(), {}, {}, {}});
  const TomlDocument& document = *file.document();
  const TomlSection root(document, "");
  root.allow_only(case_sections());
  const TomlSection section(document, "study");
  if (section.table() == nullptr) document.fail(nullptr, "study", "missing; expected a section [study]");
  section.allow_only({"parameter", "from", "to", "eta", "for_each", "sweep", "uncertain"});
  if (TomlSection(document, "system").table() == nullptr)
    document.fail(nullptr, "system", "missing; expected a section [system]");

  StudyCase study;
  study.title = root.has("title") ? root.text("title", {}) : "";
  study.range = read_preloads(document, section);
  study.options = read_continuation(document);
  study.options.stop_at = study.range.stop_at;
  study.sweep = section.boolean("sweep", true);
  if (scatters(document)) study.uncertain = read_uncertainty(document);
  check_keys(document, nullptr);
  source->range = study.range;
  source->sectors = read_sectors(document);
  study.is_physical = has_geometry(document);
  const std::vector<std::string> allowed = listed_keys(document, nullptr);
  source->for_each.emplace(document, section, allowed, ForEach::Lists::combined);
  for (const char* key : {"preload", "preload_per_length"}) {
    if (source->for_each->sets(key))
      section.fail("for_each", fmt::format("{} cannot be listed: P is swept", key));
  }
  study.keys = source->for_each->keys();
  study.count = source->for_each->count();
  study.design = [source](std::size_t index) { return source->design(index); };
  // Each key's rule is an interval that at most the largest value of another key narrows; what a combination
  // beyond the samples may still be, sizes that a double does not hold, ends the study when it is met.
  for (const std::size_t index : source->for_each->samples()) study.design(index);
  source->problem(source->for_each->lacking().replacements);  // values that for_each takes the place of
  study.resolved = resolve(*source, study);
  return study;
}

}  // namespace arcslip
