// Cost of friction in many harmonics, as ratios measured in one run: that of a point of a branch, with all
// corrector iterations and events that belong to it, over that of as many marches of the loop and transforms
// with their derivatives alone, goal: at most 2; that of drawing a branch over that of tracing it; the time
// of a point's Floquet exponents; and that of the periodic motion of all 30 nodes in time, found by Newton's
// method or by marching 1000 periods, over that of such a point.

#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "arcslip/assembly/system.hpp"
#include "arcslip/continuation/path/polyline.hpp"
#include "arcslip/elements/jenkins.hpp"
#include "arcslip/problems/response/floquet_response.hpp"
#include "arcslip/time/ring_response.hpp"

namespace {

using namespace arcslip;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

SystemParameters figure_8() {
  SystemParameters parameters;
  parameters.mass_ratio = 5;
  parameters.frequency_ratio = 4;
  parameters.interface_stiffness = shear_interface_stiffness(33.3, 0.3);
  return parameters;
}

/// Figure 8 at P = 1 with its contact cut into `contacts` of different strength at one place.
HarmonicSystem cut(int highest, int contacts) {
  SystemParameters parameters = figure_8();
  parameters.harmonics = odd_up_to(highest);
  HarmonicSystem system = build_harmonic_system(parameters);
  const auto spread = [&](const ContactModes& one) {
    std::vector<ContactMode> modes;
    for (const ContactMode& mode : one.modes())
      modes.push_back({mode.frequency, ContactVector::Constant(contacts, mode.shape(0)), mode.load});
    return ContactModes(contacts, std::move(modes), one.loss());
  };
  for (ContactModes& one : system.base) one = spread(one);
  for (ContactModes& one : system.damper) one = spread(one);
  const SectorContact whole = system.contacts.front();
  system.contacts.clear();
  for (int i = 0; i < contacts; ++i)
    system.contacts.push_back(
        {whole.stiffness / contacts, whole.slip_per_preload * (0.7 + 0.6 * i / contacts)});
  return system;
}

void report(int highest, int contacts) {
  const problems::HarmonicResponse problem(cut(highest, contacts));
  continuation::TraceOptions options;
  options.parameter = "eta";
  options.from = 3.45;
  options.to = 3.99;
  const continuation::Guess guess = problem.guess(options.from, 1);
  const Clock::time_point start = Clock::now();
  const continuation::Branch branch = continuation::trace(problem, guess, options);
  const double traced = seconds_since(start);

  // the same number of evaluations, of the contacts' forces alone
  ElementForce force;
  const Clock::time_point again = Clock::now();
  double sum = 0;
  for (long i = 0; i < branch.work.evaluations; ++i) {
    const auto& point = branch.points[static_cast<std::size_t>(i) * branch.points.size() /
                                      static_cast<std::size_t>(branch.work.evaluations)];
    for (int k = 0; k < contacts; ++k) {
      const SectorContact& contact = problem.system().contacts[static_cast<std::size_t>(k)];
      const Jenkins element(contact.stiffness, contact.slip_per_preload);
      element.force(problem.system().orders, problem.motion(point.unknowns, k), 1, point.regime[k] != 0, true,
                    force);
      sum += force.energy;
    }
  }
  const double marched = seconds_since(again);
  const auto points = static_cast<double>(branch.points.size());

  Vector observed;
  std::vector<double> values;
  long looks = 0;
  const Clock::time_point drawing = Clock::now();
  const auto drawn = continuation::polyline(
      branch, continuation::index_of(problem.parameter_names(), "eta"),
      [&](const continuation::BranchPoint& point) -> const std::vector<double>& {
        ++looks;
        problem.observe_quickly(point.unknowns, point.parameters, point.regime, observed);
        values.assign(observed.begin(), observed.end());
        return values;
      },
      &problem);
  const double drew = seconds_since(drawing);
  fmt::print(
      "H = {:2}, {} contacts: {:4} points, {:7.1f} us a point, {:.2f} of marches and transforms alone; "
      "drawn by {:5} points in {:.2f} looks each, {:.2f} of tracing{}\n",
      highest, contacts, branch.points.size(), 1e6 * traced / points, traced / marched, drawn.points.size(),
      static_cast<double>(looks) / static_cast<double>(drawn.points.size()), drew / traced,
      branch.complete() && std::isfinite(sum) ? "" : " (incomplete)");
}

/// Time of the Floquet exponents of a point, whatever the number of nodes.
void report_stability(int highest, Index nodes) {
  SystemParameters parameters = figure_8();
  parameters.harmonics = odd_up_to(highest);
  parameters.elements = nodes;
  const auto problem = problems::build_floquet_response(parameters);
  continuation::Guess at = problem->guess(3.841, 1);
  const Vector found_there = at.unknowns;
  ComplexVector values;
  constexpr int times = 20;
  const Clock::time_point start = Clock::now();
  bool found = true;
  for (int i = 0; i < times; ++i) {
    at.unknowns = found_there * (1 + 1e-9 * i);  // what was found last is known
    found = problem->eigenvalues(at.unknowns, at.parameters, at.regime, values) && found;
  }
  fmt::print("H = {:2}, N = {:4}: {} Floquet exponents in {:.3g} ms{}\n", highest, nodes, values.size(),
             1e3 * seconds_since(start) / times, found ? "" : " (not found)");
}

/// Seconds of the ring in time at figure 8's best preload, over those of a point of nine harmonics there.
void report_time_integration() {
  SystemParameters parameters = figure_8();
  parameters.harmonics = odd_up_to(9);
  const problems::HarmonicResponse problem(build_harmonic_system(parameters));
  const Clock::time_point start = Clock::now();
  const continuation::Guess at = problem.guess(3.841, 1);
  const double balanced = seconds_since(start);

  RingMotion motion(build_ring(parameters), 3.841, 1);
  const Clock::time_point again = Clock::now();
  const SettledMotion settled = shoot(motion, motion.at_rest());
  const double shot = seconds_since(again);
  RingState state = motion.at_rest();
  const Clock::time_point marching = Clock::now();
  motion.advance(state, 20 * motion.period());
  const double marched = 50 * seconds_since(marching);
  fmt::print(
      "N = 30 nodes in time: {:.3g} s by Newton's method{}, {:.3g} s for 1000 periods; by balance from no "
      "guess "
      "{:.3g} s, {:.3g} and {:.3g} times less\n",
      shot, settled.settled && at.regime == 1 ? "" : " (not settled)", marched, balanced, shot / balanced,
      marched / balanced);
}

}  // namespace

int main() {
  for (const int highest : {1, 3, 5, 9, 15, 21, 31}) report(highest, 1);
  for (const int contacts : {2, 4, 8}) report(9, contacts);
  for (const int highest : {1, 3, 9, 31}) report_stability(highest, 30);
  report_stability(9, 3000);
  report_time_integration();
}
