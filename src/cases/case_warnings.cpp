#include "cases/case_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "arcslip/assembly/resonances.hpp"
#include "arcslip/assembly/structures.hpp"
#include "cases/unit_names.hpp"

namespace arcslip {
namespace {

constexpr std::size_t most_looked_at = 100;

using Range = std::pair<double, double>;  // rising

/// What a branch or a design passes, in the model's units.
struct Ranges {
  std::optional<Range> eta;            ///< in which a resonance is looked for
  std::optional<Range> preload;        ///< of all preloads
  std::vector<double> fixed_eta = {};  ///< where the frequency does not vary
};

/// In SI units as well where there are any.
std::string frequency_text(double eta, const std::optional<PhysicalScale>& scale) {
  return scale ? fmt::format("{:.5g} Hz (eta = {:.5g})", scale->frequency(eta), eta)
               : fmt::format("eta = {:.5g}", eta);
}

std::string preload_text(double preload, const std::optional<PhysicalScale>& scale) {
  if (!scale) return fmt::format("P = {:.4g}", preload);
  return fmt::format("{:.4g} {} (P = {:.4g})", scale->preload(preload), unit_in_words(scale->preload_unit()),
                     preload);
}

/// The resonance of a part that is nearest to a range, as a factor; null if it has none.
const Resonance* nearest(const std::vector<Resonance>& all, const std::string& part, const Range& range) {
  const Resonance* found = nullptr;
  const auto distance = [&](const Resonance& one) {
    return std::max(range.first / one.eta, one.eta / range.second);
  };
  for (const Resonance& one : all) {
    if (one.part != part || !(one.eta > 0)) continue;
    if (found == nullptr || distance(one) < distance(*found)) found = &one;
  }
  return found;
}

/// Those of base and damper, alone or stuck: without modes of stuck contacts that are hardly more than their
/// springs, far above what both structures do alone.
std::vector<Resonance> meant_resonances(const SystemParameters& system, const ContactSystem& wave) {
  constexpr double far = 10;
  std::vector<Resonance> all = resonances(system, wave);
  double alone = 0;
  for (const Resonance& one : all) {
    if (one.part != "stuck") alone = std::max(alone, one.eta);
  }
  std::erase_if(
      all, [&](const Resonance& one) { return one.part == "stuck" && alone > 0 && one.eta > far * alone; });
  return all;
}

/// Whether a resonance of any harmonic lies in the range.
bool resonates(const SystemParameters& system, const Range& range) {
  const HarmonicSystem harmonics = build_harmonic_system(system);
  for (std::size_t i = 0; i < harmonics.orders.size(); ++i) {
    const ContactSystem wave{harmonics.base[i], harmonics.damper[i], harmonics.contacts};
    for (const Resonance& one : meant_resonances(system, wave)) {
      const double eta = one.eta / harmonics.multiple(static_cast<Index>(i));
      if (eta >= range.first && eta <= range.second) return true;
    }
  }
  return false;
}

std::string about_window(const ProblemRequest& problem, const Ranges& ranges) {
  if (!ranges.eta || resonates(problem.system, *ranges.eta)) return "";
  const std::vector<Resonance> all = meant_resonances(problem.system, build_wave(problem.system));
  if (all.empty()) return "";  // not known
  std::string text = fmt::format("no resonance of the base or the damper lies from {} to {}",
                                 frequency_text(ranges.eta->first, problem.physical),
                                 frequency_text(ranges.eta->second, problem.physical));
  std::string others;
  for (const auto& [part, told] :
       {std::pair("base", "of the base alone"), std::pair("stuck", "of the stuck whole")}) {
    const Resonance* one = nearest(all, part, *ranges.eta);
    if (one == nullptr) continue;
    others += fmt::format("{} {} at {}", others.empty() ? "; the nearest are that" : " and", told,
                          frequency_text(one->eta, problem.physical));
  }
  return text + others;
}

/// Whether the stuck state is a linear one whose limit is known.
bool has_limit(const SystemParameters& system) {
  return !system.has_others() && !system.one_way && system.preload_growth == 0 &&
         (system.excitation.kind == nullptr || system.harmonics.size() == 1);
}

std::string about_preloads(const ProblemRequest& problem, const Ranges& ranges) {
  const SystemParameters& system = problem.system;
  if (!ranges.preload || !has_limit(system)) return "";
  const ContactSystem wave = build_order(system, system.periods());
  std::vector<double> etas = ranges.fixed_eta;
  if (ranges.eta) {
    const auto [low, high] = *ranges.eta;
    etas = {low, high};
    for (const Resonance& one : resonances(wave)) {
      if (one.eta > low && one.eta < high) etas.push_back(one.eta);
    }
  }
  const double limit = locking_preload(wave, etas);
  // The damped peak lies beside the undamped resonance, and is higher by far less than this.
  if (etas.empty() || !(ranges.preload->first > 1.5 * limit)) return "";
  return fmt::format("no contact slips from {} to {}: all stick above about {}",
                     preload_text(ranges.preload->first, problem.physical),
                     preload_text(ranges.preload->second, problem.physical),
                     preload_text(limit, problem.physical));
}

/// None where another parameter moves resonances and limits.
Ranges ranges_of(const CaseBranch& branch) {
  const continuation::TraceOptions& options = branch.options;
  std::vector<std::pair<std::string, Range>> varied{
      {options.parameter, std::minmax(options.from, options.to)}};
  if (branch.curve)
    varied.emplace_back(branch.curve->active, Range(branch.curve->window.low, branch.curve->window.high));
  Ranges ranges;
  for (const auto& [name, range] : varied) {
    if (name != "eta" && name != "P") return {};
    (name == "eta" ? ranges.eta : ranges.preload) = range;
  }
  if (!ranges.eta) ranges.fixed_eta = {branch.problem.eta};
  return ranges;
}

/// How many of some have each slip, in the words of the first that has it.
class Slips {
 public:
  void look(const ProblemRequest& problem, const Ranges& ranges) {
    ++count_;
    try {
      add(0, about_window(problem, ranges));
      add(1, about_preloads(problem, ranges));
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception&) {  // what cannot be built is named when it is met
    }
  }

  std::vector<std::string> sentences(const char* what) const {
    std::vector<std::string> all;
    for (const auto& [number, text] : found_) {
      if (number == 0) continue;
      all.push_back(count_ == 1 ? text : fmt::format("{} of {} {}: {}", number, count_, what, text));
    }
    return all;
  }

 private:
  void add(std::size_t kind, const std::string& text) {
    if (text.empty()) return;
    auto& [number, first] = found_[kind];
    if (number++ == 0) first = text;
  }

  std::size_t count_ = 0;
  std::array<std::pair<std::size_t, std::string>, 2> found_ = {};
};

}  // namespace

std::vector<std::string> warnings_of(const CasePlan& plan) {
  Slips slips;
  for (std::size_t i = 0; i < std::min(plan.count, most_looked_at); ++i) {
    const CaseBranch branch = plan.branch(i);
    if (branch.problem.model != nullptr || branch.problem.response->has_own_frequency()) return {};
    if (structures_of(branch.problem.system).whole() != nullptr) return {};  // waves have too many resonances
    slips.look(branch.problem, ranges_of(branch));
  }
  return slips.sentences("branches");
}

std::vector<std::string> warnings_of(const StudyCase& study) {
  Slips slips;
  for (std::size_t i = 0; i < std::min(study.count, most_looked_at); ++i) {
    const StudyDesign design = study.design(i * study.each());
    const problems::PreloadRange& range = design.range;
    slips.look(design.problem(), {Range(range.eta_low, range.eta_high), Range(range.from, range.to)});
  }
  return slips.sentences("designs");
}

}  // namespace arcslip
