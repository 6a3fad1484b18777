// Time of an evaluation and of a point of whole rings over the number of sectors: `benchmarks/whole_ring`.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "../support/whole_rings.hpp"
#include "arcslip/continuation/path/trace.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using Clock = std::chrono::steady_clock;

namespace {

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void measure(Index sectors, WholeLoad::Course course, bool is_split) {
  const Index waves = std::max<Index>(1, (sectors + 6) / 12);  // of nearly the same frequency
  const SystemParameters one = blisk(1, sectors, waves, DampingKind::modal, {}, {{{0, 1}}});
  RingMake ring = ring_of(one, course);
  if (is_split) {
    ring.damper_ports = 1;
    ring.changes = {{false, {{{sectors - 1, 0, -1}, {0, 0, 1}}}, Matrix::Constant(1, 1, -5e6)}};
  }
  const problems::HarmonicResponse problem = response_of(whole_of(one, ring));
  const continuation::Guess at = problem.guess(552.8, 1);
  Vector residual(problem.size());
  Matrix jacobian(problem.size(), problem.size());
  Matrix by_parameters(problem.size(), 2);
  int evaluations = 0;
  const Clock::time_point begun = Clock::now();
  while (seconds_since(begun) < .5) {
    if (!problem.evaluate(at.unknowns, at.parameters, at.regime, {&residual, &jacobian, &by_parameters}))
      return;
    ++evaluations;
  }
  const double each = seconds_since(begun) / evaluations;
  continuation::TraceOptions options;
  options.parameter = "eta";
  options.from = 540;
  options.to = 570;
  options.extrema_of = {"Y_3_max"};
  const continuation::Guess start = problem.guess(540, 1);
  const Clock::time_point traced = Clock::now();
  const continuation::Branch branch = trace(problem, start, options);
  const double whole = seconds_since(traced);
  fmt::print("{:4} {:>10} {:>5} {:12.0f} {:10.3f} {:8} {:10.2f} {:8.2f}  {}\n", sectors, to_string(course),
             is_split ? "split" : "", 1 / each, 1e3 * each, branch.points.size(),
             1e3 * whole / static_cast<double>(branch.points.size()), whole,
             branch.complete() ? "" : branch.explanation);
}

}  // namespace

int main() {
  fmt::print("   N       load        evaluations/s  ms each   points   ms/point  seconds\n");
  for (const Index sectors : {6, 12, 24, 50, 100}) {
    for (const auto course : {WholeLoad::Course::travelling, WholeLoad::Course::standing}) {
      measure(sectors, course, false);
      measure(sectors, course, true);
    }
  }
}
