#include "cases/design_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <stdexcept>

#include "arcslip/assembly/harmonic_system.hpp"
#include "arcslip/assembly/resonances.hpp"
#include "arcslip/assembly/structures.hpp"
#include "arcslip/assembly/whole_ring.hpp"
#include "arcslip/cases/runs.hpp"
#include "arcslip/continuation/problem/one_piece.hpp"
#include "arcslip/motion/swing.hpp"
#include "arcslip/problems/ridges/free_response.hpp"
#include "arcslip/problems/ridges/response_study.hpp"

namespace arcslip {
namespace {

using problems::PreloadRange;
using problems::PreloadStudy;

bool is_whole(const SystemParameters& system) { return structures_of(system).whole() != nullptr; }

/// Whether closed slopes serve.
bool is_closed(const StudyCase& study, const StudyDesign& design) {
  return study.objective == "Y" && !needs_balance(design.system, design.harmonics_tolerance);
}

/// Of a whole ring, whose contacts begin and cease to slip one after the other all along a response, the
/// pieces taken as one, unless other elements join them less smoothly.
std::shared_ptr<const continuation::Problem> in_one_piece(
    const StudyDesign& design, std::shared_ptr<const continuation::Problem> problem) {
  const bool joins = is_whole(design.system) && !design.system.has_others();
  return joins ? std::make_shared<const continuation::OnePiece>(std::move(problem)) : problem;
}

/// The design's response, from where it is known at the range's highest preload.
problems::ResponsePeaks responses(const StudyCase& study, const StudyDesign& design,
                                  const std::vector<int>& harmonics) {
  ProblemRequest request = design.problem();
  request.system.harmonics = harmonics;
  request.system.preload = design.range.to;
  const Subject subject = build(request, "eta", design.range.eta_low, study.options);
  if (!subject.failure.empty())
    throw std::runtime_error(fmt::format("no response at eta = {:g}, P = {:g}: {}", design.range.eta_low,
                                         design.range.to, subject.failure));
  return problems::ResponsePeaks(
      {in_one_piece(design, subject.built.problem), "eta", "P", design.range.eta_low, design.range.eta_high,
       study.objective, subject.guess, study.options, design.pattern > 0,
       [system = request.system](double eta) { return undamped_resonance(system, eta); }});
}

problems::StudiedContacts contacts_of(const SystemParameters& system) {
  std::vector<std::string> others;
  if (is_whole(system)) others.emplace_back("contacts");
  for (std::size_t i = 0; i < system.others.size(); ++i) {
    if (system.others[i].kind->has_memory) others.push_back(element_name(system, i));
  }
  const bool homogeneous = !system.has_others();
  const bool by_load = !has_own_friction(system);
  if (is_whole(system)) return {{}, 1, system.preload_growth, homogeneous, by_load, others};
  return {build_wave(system).contacts,
          static_cast<double>(system.elements),
          system.preload_growth,
          homogeneous,
          by_load,
          others};
}

/// What the base does without damper, which shares no objective with the damper but Y. With elements that may
/// stand anywhere it is not known.
void compare_to_free(const StudyCase& study, const StudyDesign& design, PreloadStudy& result) {
  const SystemParameters& system = design.system;
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  result.free_eta = result.free_Y = unknown;
  if (study.objective != "Y" || !system.others.empty()) return;
  problems::Peak free;
  if (!structures_of(system).is_one_contact(system)) {
    free = problems::free_peak(build_order(system, system.periods()).base, design.range);
  } else {
    const FrictionSystem pair = build_system(system);
    free = problems::free_peak(pair, design.range, study.options);
    if (result.optimum && system.cubic_stiffness == 0 && system.base_damping > 0) {
      result.optimum->damping =
          problems::equivalent_damping(pair, system.base_damping, design.range, free, result.optimum->peak.Y);
    }
  }
  result.free_eta = free.eta;
  result.free_Y = free.Y;
}

/// Envelopes of designs that scatter.
std::pair<problems::EnvelopeCurve, double> envelope_over(problems::ResponsePeaks& peaks, double from,
                                                         double to) {
  constexpr double tolerance = 1e-5;  // of ln Y: well below what samples of the scatter tell
  constexpr std::size_t most = 300;
  problems::HighestPeak highest(peaks, from, to, {});
  const double error = highest.refine(tolerance, most);
  return {problems::EnvelopeCurve(highest.pieces()), error};
}

/// All harmonics that the response at one preload asks for.
void complete_orders(const StudyCase& study, const StudyDesign& design, double preload,
                     std::vector<int>& orders) {
  SystemParameters system = design.system;
  const continuation::TimeBudget time(study.options);
  for (;;) {
    system.harmonics = orders;
    problems::ResponsePeaks peaks = responses(study, design, orders);
    const std::vector<int> missing =
        missing_orders(system, peaks.response_at(preload), *design.harmonics_tolerance, time);
    if (missing.empty()) return;
    add_orders(orders, missing);
  }
}

PreloadStudy study_with(const StudyCase& study, const StudyDesign& design, const std::vector<int>& orders) {
  problems::ResponsePeaks peaks = responses(study, design, orders);
  problems::StudyPrecision precision;
  if (study.patterns > 0) precision.envelope = 1e-3;  // well below what samples of the scatter tell
  if (design.pattern > 0) {
    precision.range = 0.05;  // of which nothing is told
    precision.looks = problems::HighestPeak::Looks::followed;
  }
  return problems::study_response(peaks, design.range, contacts_of(design.system), precision);
}

/// The study in as many harmonics as the response at its own best preload asks for.
PreloadStudy study_balanced(const StudyCase& study, const StudyDesign& design) {
  constexpr int first = 5;  // harmonics that any contact which slips asks for
  std::vector<int> orders = orders_up_to(first, design.system);
  for (;;) {
    PreloadStudy result = study_with(study, design, orders);
    result.harmonics = orders;
    if (!result.optimum) return result;
    complete_orders(study, design, result.optimum->peak.preload, orders);
    if (orders == result.harmonics) return result;
  }
}

}  // namespace

PreloadStudy study_preload(const StudyCase& study, const StudyDesign& design) {
  if (is_closed(study, design)) return problems::study_preload(design.system, design.range, study.options);
  PreloadStudy result = design.harmonics_tolerance ? study_balanced(study, design)
                                                   : study_with(study, design, design.system.harmonics);
  compare_to_free(study, design, result);
  return result;
}

problems::UncertainPeaks study_uncertainty(const StudyCase& study, const StudyDesign& design,
                                           const PreloadStudy& nominal) {
  if (is_closed(study, design))
    return problems::study_uncertainty(design.system, design.range, *study.uncertain, nominal, study.options);
  const std::vector<int>& harmonics = nominal.harmonics.empty() ? design.system.harmonics : nominal.harmonics;
  const auto envelope = [&](const problems::DesignFactors& factors, double from, double to) {
    StudyDesign other = design;
    other.system = problems::scaled(design.system, factors);
    problems::ResponsePeaks peaks = responses(study, other, harmonics);
    return envelope_over(peaks, from, to);
  };
  return problems::study_uncertainty(
      design.range, *study.uncertain,
      {design.system.preload_growth != 0, design.system.has_others(), has_own_friction(design.system)},
      nominal, envelope);
}

namespace {

/// Whether the peak nearest to a place is as high as the highest one, of several that are.
bool is_near_highest(const std::vector<problems::ResponsePeak>& peaks, double place) {
  constexpr double same = 1e-6;  // of ln Y: both peaks of an exchange, as the best preload is known
  const auto distance = [&](const problems::ResponsePeak& peak) {
    return std::abs(std::log(peak.place / place));
  };
  const auto nearest = std::min_element(
      peaks.begin(), peaks.end(), [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
  return nearest->log_height >= peaks[highest_of(peaks)].log_height - same;
}

}  // namespace

HarmonicsCheck check_harmonics(const StudyCase& study, const StudyDesign& design,
                               const std::vector<int>& harmonics, double preload) {
  constexpr int least = 9;
  HarmonicsCheck check;
  check.preload = preload;
  check.harmonics = orders_up_to(std::max(2 * highest_order(harmonics) + 1, least), design.system);
  try {
    const std::vector<problems::ResponsePeak> before = responses(study, design, harmonics).at(preload);
    const std::vector<problems::ResponsePeak> after = responses(study, design, check.harmonics).at(preload);
    const problems::ResponsePeak& highest = after[highest_of(after)];
    check.eta = highest.place;
    check.Y = std::exp(highest.log_height);
    check.moved_by = std::expm1(highest.log_height - before[highest_of(before)].log_height);
    check.same_peak = is_near_highest(before, highest.place);
  } catch (const std::bad_alloc&) {
    throw;  // no property of the design
  } catch (const std::exception& error) {
    check.failure = error.what();
  }
  return check;
}

}  // namespace arcslip
