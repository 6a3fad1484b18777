#include "arcslip/problems/response/harmonic_cycle.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>

#include "arcslip/continuation/path/newton.hpp"
#include "arcslip/problems/response/nonlinear_mode.hpp"

namespace arcslip::problems {

using continuation::Branch;
using continuation::BranchPoint;
using continuation::Guess;

HarmonicCycle::HarmonicCycle(HarmonicSystem system)
    : FreeVibration(std::move(system), {.eta = {Place::unknowns, eta},
                                        .preload = {Place::parameters, preload},
                                        .real = {Place::unknowns, Unknown::amplitude},
                                        .damping = {Place::parameters, zeta},
                                        .of_base = true}) {
  quantities_ = {{"eta", Measure::frequency},
                 {"R", Measure::amplitude},
                 {"S", Measure::threshold},
                 {"R_over_S", Measure::ratio},
                 {"Y", Measure::amplitude, Body::base},
                 {"U", Measure::amplitude, Body::damper},
                 {"dissipated", Measure::dissipated}};
  if (system_.varied) layout_.varied = {Place::parameters, further};
  add_readings(0, "");
  add_further_contacts();
  add_further_elements();
  add_other_harmonics();
  add_drifts();
  // A static load's k c_B/(2 pi) is the fold of one mode on a held damper.
  for (const ContactMode& mode : system_.base[0].modes()) {
    if (!(mode.frequency > 0)) continue;
    for (Index i = 0; i < contacts(); ++i)
      zeta_scale_ += system_.contacts[at(i)].stiffness * std::norm(mode.shape(i) / mode.frequency);
  }
  zeta_scale_ = std::min(zeta_scale_ / two_pi, 1.0);
}

bool HarmonicCycle::evaluate(const Vector& u, const Vector& p, const continuation::Regime& regime,
                             const continuation::Evaluation& out) const {
  return !all_stick(regime) && FreeVibration::evaluate(u, p, regime, out);
}

void HarmonicCycle::scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const {
  unknowns.setConstant(length(u, p));
  unknowns(eta) = u(eta);
  parameters.head<2>() << std::max(std::abs(p(zeta)), zeta_scale_), p(preload);
  if (is_varied()) parameters(further) = varied_scale(u, p);
}

std::optional<continuation::Regime> HarmonicCycle::regime_beyond(const continuation::Regime& regime,
                                                                 int border) const {
  const auto beyond = HarmonicProblem::regime_beyond(regime, border);
  return beyond && all_stick(*beyond) ? std::nullopt : beyond;
}

struct HarmonicCycle::Found {
  Guess at;
  bool is_large;

  auto order() const { return std::tuple(is_large, at.unknowns(eta), at.unknowns(Unknown::amplitude)); }
};

/// Those on one mode.
void HarmonicCycle::add_cycles(const HarmonicSystem& damped, const JoinedMode& mode, double zeta_value,
                               double preload_value, const continuation::TraceOptions& limits,
                               std::vector<Found>& found) const {
  constexpr double stuck = 0.5;    // of the amplitude at which the first contact slips
  constexpr double longest = 1e7;  // beyond it friction is nothing even to a damping ratio of 1e-6
  const NonlinearMode problem(damped);
  double first = std::numeric_limits<double>::infinity();
  for (Index i = 0; i < contacts(); ++i) {
    if (!(system_.contacts[at(i)].stiffness > 0)) continue;
    const double S = coordinates_.element(i).threshold(preload_value + system_.preload_growth *
                                                                           mode.frequency * mode.frequency);
    first = std::min(first, stuck * S * std::abs(mode.relative(0) / mode.relative(i)));
  }
  if (!std::isfinite(first)) first = 1;  // no contact rubs: what else slips tells what is small
  // The first contact may stand still, or what is stuck not vibrate.
  if (!(first > 0 && mode.frequency > 0 && std::abs(mode.damping) < 1)) return;
  continuation::TraceOptions options;
  options.parameter = "R";
  options.from = first;
  options.to = longest * first;
  options.max_points = 1000;  // some two hundred do
  options.max_seconds = limits.max_seconds;
  options.go_on = limits.go_on;
  const Vector begin = Eigen::Vector2d(first, preload_value);
  const Branch branch = trace(problem, problem.guess(mode.frequency, begin, limits), options);
  if (is_unfinished(branch.stop))
    throw continuation::Unfinished(branch.stop, "on the way to a limit cycle: " + branch.explanation);
  for (std::size_t k = 0; k + 1 < branch.points.size(); ++k) {
    const BranchPoint& a = branch.points[k];
    const BranchPoint& b = branch.points[k + 1];
    const double at_a = a.unknowns(NonlinearMode::damping);
    const double at_b = b.unknowns(NonlinearMode::damping);
    if (all_stick(a.regime) || (at_a < 0) == (at_b < 0)) continue;
    const double part = at_a / (at_a - at_b);
    Guess guess{a.unknowns + part * (b.unknowns - a.unknowns), Vector(2), a.regime};
    guess.unknowns(Unknown::amplitude) = a.parameters(0) + part * (b.parameters(0) - a.parameters(0));
    guess.parameters << zeta_value, preload_value;
    const continuation::Solution solution = continuation::solve(*this, guess);
    if (solution.outcome != continuation::Correction::converged) continue;
    guess.unknowns = solution.unknowns;
    if (crossed_border(guess) < 0) found.push_back({std::move(guess), at_a > 0});
  }
}

Guess HarmonicCycle::guess(const Vector& parameters, const continuation::TraceOptions& limits) const {
  if (!is_varied()) return guess(parameters(zeta), parameters(preload), limits);
  const HarmonicCycle fixed(at_value(system_, parameters(further)));
  Guess guess = fixed.guess(parameters(zeta), parameters(preload), limits);
  guess.parameters = parameters;
  return guess;
}

Guess HarmonicCycle::guess(double zeta_value, double preload_value,
                           const continuation::TraceOptions& limits) const {
  HarmonicSystem damped = system_;
  for (ContactModes& base : damped.base)
    base = base.with(system_.base_loss_fixed + zeta_value * system_.base_loss_per_zeta);
  std::vector<Found> found;
  constexpr double small = 1e-6;  // of the amplitude at which the first contact slips, if it rubs
  const double S = system_.contacts[0].stiffness > 0 ? coordinates_.element(0).threshold(preload_value) : 1;
  const double R = small * S;
  for (const JoinedMode& mode : NonlinearMode(damped).small_modes(0, R, preload_value)) {
    add_cycles(damped, mode, zeta_value, preload_value, limits, found);
    if (std::any_of(found.begin(), found.end(), [](const Found& one) { return !one.is_large; })) break;
  }
  if (found.empty())
    throw std::invalid_argument(
        fmt::format("HarmonicCycle: no limit cycle was found at zeta_B = {:g}, P = {:g}{}{}", zeta_value,
                    preload_value, reason_of_end().empty() ? "" : "; ", reason_of_end()));
  return std::min_element(found.begin(), found.end(),
                          [](const Found& a, const Found& b) { return a.order() < b.order(); })
      ->at;
}

}  // namespace arcslip::problems
