#include "arcslip/cases/study_case.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "arcslip/assembly/whole_ring.hpp"
#include "arcslip/cases/runs.hpp"
#include "cases/continuation_section.hpp"
#include "cases/for_each.hpp"
#include "cases/geometry_section.hpp"
#include "cases/model_section.hpp"
#include "cases/study_section.hpp"
#include "cases/system_section.hpp"
#include "cases/unit_names.hpp"

namespace arcslip {
namespace {

using nlohmann::ordered_json;

/// What the designs are made from.
struct Source {
  std::shared_ptr<const TomlDocument> file;
  std::optional<ForEach> for_each;
  std::shared_ptr<const Structures> structures;
  problems::PreloadRange range;
  std::string preload_as;
  std::string frequency_as;
  std::size_t patterns = 0;

  ProblemRequest problem(const Replacements& replacements) const {
    ProblemRequest problem;
    read_system(*file, replacements, nullptr, {"P", true, structures, range.eta_low, range.eta_high},
                problem);
    return problem;
  }

  StudyDesign design(std::size_t index) const {
    auto [values, replacements, made] = for_each->at(index / (patterns + 1));
    const std::size_t pattern = index % (patterns + 1);
    const toml::value<std::int64_t> number(static_cast<std::int64_t>(pattern));
    if (patterns > 0) replacements["ring.pattern"] = {&number, "study.uncertain.patterns", for_patterns()};
    if (pattern > 0) values["pattern"] = pattern;
    const ProblemRequest problem = this->problem(replacements);
    return {std::move(values),           problem.system,    problem.geometry,  problem.physical,
            problem.harmonics_tolerance, problem.structure, range_of(problem), pattern};
  }

  const toml::node* for_patterns() const {
    return TomlSection(*file, "study").table()->at_path("uncertain.patterns").node();
  }

  /// In the model's units.
  problems::PreloadRange range_of(const ProblemRequest& problem) const {
    const TomlSection section(*file, "study");
    const double preload = size_of_unit(preload_as, problem.physical, section, "parameter");
    const double frequency = size_of_unit(frequency_as, problem.physical, section, frequency_as);
    problems::PreloadRange converted = range;
    converted.from /= preload;
    converted.to /= preload;
    for (double& value : converted.stop_at) value /= preload;
    converted.eta_low /= frequency;
    converted.eta_high /= frequency;
    return converted;
  }
};

/// The input as it is understood, without what belongs to [branch].
ordered_json resolve(const Source& source, const StudyCase& study) {
  ordered_json resolved = to_json(source.file->root());
  resolved.erase("branch");
  resolve_system(*source.file, study.design(0).problem(), resolved);
  fill(resolved["study"], study_keys().values(study));
  if (!study.keys.empty()) resolved["study"]["for_each"] = source.for_each->to_json();
  resolved["continuation"].update(continuation_keys().values(study.options));
  return resolved;
}

/// Adds the patterns of each design.
void take_patterns(const TomlDocument& document, Source& source, StudyCase& study) {
  constexpr std::size_t most = 1'000'000'000;
  const TomlSection section(document, "study.uncertain");
  if (!document.root().contains("ring"))
    section.fail("patterns", "only of whole rings, whose sectors scatter as a section [ring] says");
  if (source.for_each->sets("pattern"))
    TomlSection(document, "study").fail("for_each", "pattern cannot be listed beside uncertain.patterns");
  study.patterns = source.patterns = study.uncertain->patterns;
  if (study.each() > most / study.count)
    section.fail("patterns", fmt::format("with {} designs there are more than {:g} rings", study.count, 1e9));
}

/// Refuses patterns that are all the equal ring.
void check_scatter(const TomlDocument& document, const StudyCase& study) {
  const SystemParameters equal = study.design(0).system;
  const SystemParameters other = study.design(1).system;
  const auto same = [](const SectorContact& a, const SectorContact& b) {
    return a.stiffness == b.stiffness && a.slip_per_preload == b.slip_per_preload;
  };
  const bool alike = std::equal(equal.contacts.begin(), equal.contacts.end(), other.contacts.begin(), same) &&
                     structures_of(equal).whole()->make().changes.size() ==
                         structures_of(other).whole()->make().changes.size();
  if (alike)
    TomlSection(document, "study.uncertain")
        .fail("patterns",
              "nothing in [ring] scatters: expected { scatter = ... } of preload, friction, "
              "stiffness or mistuning");
}

/// Whether the designs are whole rings.
bool is_ring(const StudyCase& study) { return structures_of(study.design(0).system).whole() != nullptr; }

}  // namespace

ProblemRequest StudyDesign::problem() const {
  ProblemRequest request;
  request.structure = structure;
  request.system = system;
  request.geometry = geometry;
  request.physical = physical;
  request.harmonics_tolerance = harmonics_tolerance;
  return request;
}

StudyCase read_study(const std::string& path, const std::vector<std::string>& settings) {
  return read_study(CaseFile(path, settings));
}

StudyCase read_study(const CaseFile& file) {
  const auto source = std::make_shared<Source>(Source{file.document(), {}, {}, {}, {}, {}});
  const TomlDocument& document = *file.document();
  const TomlSection root(document, "");
  root.allow_only(case_sections());
  const TomlSection section(document, "study");
  if (section.table() == nullptr)
    document.fail(
        nullptr, "study",
        std::string("missing; expected a section [study]") +
            (document.root().contains("branch") ? "; what [branch] asks for is done by arcslip run" : ""));
  if (has_model(document))
    document.fail(root.table()->get("model"), "model", "not of studies, which are of systems with friction");
  if (TomlSection(document, "system").table() == nullptr)
    document.fail(nullptr, "system", "missing; expected a section [system]");

  StudyCase study;
  study.title = root.has("title") ? root.text("title", {}) : "";
  study_keys().read(study, section);
  study.options.from = study.range.from;
  study.options.to = study.range.to;
  continuation_keys().read(study.options, TomlSection(document, "continuation"));
  study.range.stop_at = study.options.stop_at;
  study.options.stop_after.clear();  // no branch of the search may end before its window does
  source->range = study.range;
  source->preload_as = study.preload_as;
  source->frequency_as = study.frequency_as;
  source->structures = load_structures(document);
  const std::vector<ListedKey> allowed = listed_keys(document, nullptr);
  source->for_each.emplace(document, section, allowed, ForEach::Lists::combined);
  for (const char* key : {"preload", "preload_per_length"}) {
    if (source->for_each->sets(key))
      section.fail("for_each", fmt::format("{} cannot be listed: P is swept", key));
  }
  study.keys = source->for_each->keys();
  study.count = source->for_each->count();
  if (study.uncertain && study.uncertain->patterns > 0) take_patterns(document, *source, study);
  study.design = [source](std::size_t index) { return source->design(index); };
  // Each key's rule is an interval that at most the largest value of another key narrows; what a combination
  // beyond the samples may still be, sizes that a double does not hold, ends the study when it is met.
  for (const std::size_t index : source->for_each->samples()) study.design(index * study.each());
  if (study.patterns > 0) check_scatter(document, study);
  if (const auto& scale = study.design(0).physical) study.preload_unit = scale->preload_unit();
  source->problem(source->for_each->lacking().replacements);  // values that for_each takes the place of
  if (is_ring(study)) study.objective = "Y_max";
  if (section.has("objective"))
    study.objective = section.text("objective", tracked_observables(study.design(0).problem(), false));
  study.resolved = resolve(*source, study);
  return study;
}

}  // namespace arcslip
