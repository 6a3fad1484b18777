#include "cases/branch_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "arcslip/assembly/harmonic_system.hpp"
#include "arcslip/assembly/structures.hpp"
#include "arcslip/motion/swing.hpp"
#include "arcslip/problems/response/floquet_response.hpp"
#include "cases/ring_amplification.hpp"

namespace arcslip {
namespace {

/// Whether stiffness is complex, which has no motion in time.
bool is_structural(const SystemParameters& system) {
  const PairLosses losses = structures_of(system).losses(system);
  return losses.base(system).structural != 0 || losses.damper(system).structural != 0;
}

/// Refuses whole rings that have no modes of their own.
void check_whole_modes(const TomlSection& section, const SystemParameters& system) {
  if (structures_of(system).whole() == nullptr) return;
  SystemParameters modal = system;
  modal.structures = structures_of(system).in_modes();
  try {
    static_cast<void>(structures_of(modal).wave(modal));
  } catch (const std::invalid_argument& error) {
    section.fail("stability", fmt::format("disturbances are told by modes: {}", error.what()));
  }
}

/// Refuses sectors that disturbances cannot run through.
void check_disturbed_waves(const TomlSection& section, const SystemParameters& system) {
  for (const Index wave : problems::disturbed_waves(system)) {
    try {
      structures_of(system).check(wave, system.elements);
    } catch (const std::invalid_argument& error) {
      section.fail("stability", fmt::format("disturbances of {} waves: {}", wave, error.what()));
    }
  }
}

}  // namespace

void check_even(const TomlSection& section, const TomlSection& branch_section, const CaseBranch& branch) {
  const ProblemRequest& problem = branch.problem;
  const SystemParameters& system = problem.system;
  if (problem.model != nullptr) return;
  if (branch.curve && branch.curve->is_backbone() && structures_of(system).whole() != nullptr)
    branch_section.fail("curve", "not of whole rings, whose load acts on motions that lag differently");
  if (branch.curve && branch.curve->type == continuation::PointType::regime_switch && system.periods() > 1)
    branch_section.fail("curve",
                        "not of switches of responses over several periods: where all periods are "
                        "alike slip begins in all of them at once");
  if (all_odd(system.harmonics)) return;
  for (const PlacedElement& one : system.others) {
    if (!one.kind->takes_any_orders)
      section.fail("harmonics",
                   fmt::format("the mean and even harmonics, which elements that are not odd call for, are "
                               "balanced: not beside element '{}', which is taken as odd",
                               one.kind->name));
  }
}

void check_amplification(const TomlSection& section, const CaseBranch& branch) {
  if (!tells_amplification(branch)) return;
  const std::string over = "amplification of [ring] is over the highest amplitude between two values of eta";
  if (branch.curve) section.fail("curve", over);
  if (branch.options.parameter != "eta") section.fail("parameter", over);
}

void check_stability(const TomlSection& section, const CaseBranch& branch) {
  const ProblemRequest& problem = branch.problem;
  const SystemParameters& system = problem.system;
  if (!problem.stability) return;
  if (problem.model != nullptr) section.fail("stability", "only for systems with friction");
  if (branch.curve) section.fail("stability", "not beside curve");
  if (feels_rotation(system))
    section.fail("stability", "not of sectors that turn, whose modes rotation couples");
  using Kind = SystemParameter::Kind;
  const Kind kind = system.varied.empty() ? Kind::load : system_parameter(system, system.varied).kind;
  if (kind != Kind::load && kind != Kind::growth && kind != Kind::flow)
    section.fail("stability",
                 fmt::format("over eta, P, F, P_2 and influence, not over {}, with which the disturbances' "
                             "own waves would change",
                             system.varied));
  if (const std::string& why = problem.response->not_disturbed; !why.empty())
    section.fail("stability", fmt::format("not of {}, {}", problem.response->title, why));
  for (const PlacedElement& one : system.others) {
    if (one.kind->has_memory && !one.kind->follows)
      section.fail("stability", fmt::format("not beside element '{}', which has a memory", one.kind->name));
  }
  if (is_structural(system))
    section.fail("stability", "needs damping with a motion in time: viscous or modal, not structural");
  if (!structures_of(system).has_equations())
    section.fail("stability", "not of a structure by its responses, which has no motion in time");
  try {
    static_cast<void>(structures_of(system).in_modes());
  } catch (const std::invalid_argument& error) {
    section.fail("stability",
                 fmt::format("disturbances are told by modes, which this damping couples: {}", error.what()));
  }
  check_disturbed_waves(section, system);
  check_whole_modes(section, system);
}

}  // namespace arcslip
