// Speed of tracing, as ratios to the time of one bare evaluation of residual and derivatives measured in the
// same run: that of an accepted point with all that belongs to it (prediction, tests, events, storage), and
// that of a corrector iteration (evaluation, bordered factorisation, solve). Goal for the latter: at most 3.
// How many points the rods take, with a third of those that AUTO-07p takes of the same as goal, and how far
// the curve through the points is from the branch, across it and in the problem's scale: goal 1e-6.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>
#include <vector>

#include "arcslip/continuation/path/interpolation.hpp"
#include "arcslip/continuation/path/stepper.hpp"
#include "arcslip/problems/response/forced_response.hpp"

namespace {

using namespace arcslip;
using continuation::Correction;
using Clock = std::chrono::steady_clock;

/// Median over 15 runs of the seconds that `work` takes.
template <class Work>
double median_seconds(Work work) {
  std::vector<double> times;
  for (int run = 0; run < 15; ++run) {
    const Clock::time_point start = Clock::now();
    work();
    times.push_back(std::chrono::duration<double>(Clock::now() - start).count());
  }
  std::nth_element(times.begin(), times.begin() + 7, times.end());
  return times[7];
}

/// Seconds of one evaluation of residual, Jacobian and parameter derivatives, over the points of a branch.
double evaluation_seconds(const problems::ForcedResponse& problem, const continuation::Branch& branch) {
  Vector residual(1);
  Matrix jacobian(1, 1);
  Matrix parameter_jacobian(1, 2);
  double sum = 0;
  const double seconds = median_seconds([&] {
    for (int repeat = 0; repeat < 20; ++repeat) {
      for (const continuation::BranchPoint& point : branch.points) {
        problem.evaluate(point.unknowns, point.parameters, point.regime,
                         {&residual, &jacobian, &parameter_jacobian});
        sum += residual(0) + jacobian(0, 0);
      }
    }
  });
  if (sum == 1) fmt::print(" ");  // keeps the evaluations
  return seconds / (20.0 * static_cast<double>(branch.points.size()));
}

/// Seconds of one corrector iteration, over corrections of a step of 0.05 from points along the branch.
double iteration_seconds(const problems::ForcedResponse& problem, const continuation::Branch& branch) {
  continuation::Corrector corrector(problem, problems::ForcedResponse::eta, {});
  continuation::Stepper stepper(problem, corrector, {}, 0.1);
  continuation::CurvePoint point = corrector.make_point();
  double seconds = 0;
  long iterations = 0;
  long failed = 0;
  for (std::size_t i = 0; i < branch.points.size(); i += 10) {
    const continuation::BranchPoint& at = branch.points[i];
    if (stepper.start(at.unknowns, at.parameters, at.regime, 1) != continuation::Correction::converged)
      continue;
    const continuation::CurvePoint origin = stepper.here();
    const Vector step = 0.05 * origin.tangent;
    const long before = corrector.work().evaluations;
    seconds += median_seconds([&] {
      for (int repeat = 0; repeat < 20; ++repeat) {
        corrector.displace(origin, step, point);
        failed += static_cast<long>(corrector.correct(point, origin, origin.tangent, 0.05) !=
                                    Correction::converged);
      }
    });
    iterations += (corrector.work().evaluations - before) / 15;
  }
  if (failed > 0) fmt::print("{} corrections failed\n", failed);
  return seconds / static_cast<double>(iterations);
}

/// The farthest that the curve is from the branch in the middle of the pieces.
double between_points(const problems::ForcedResponse& problem, const continuation::Branch& branch) {
  constexpr double shortest = 1e-7;  // below, tips of needles are passed as corners
  const continuation::InterpolatedBranch curve(branch, problems::ForcedResponse::eta);
  const continuation::InterpolatedBranch solved(branch, problems::ForcedResponse::eta, &problem);
  double worst = 0;
  for (std::size_t k = 0; k + 1 < branch.points.size(); ++k) {
    if (branch.points[k + 1].arclength - branch.points[k].arclength < shortest) continue;
    const continuation::Sample on_curve = curve.between(k, 0.5);
    const continuation::Sample on_branch = solved.between(k, 0.5);
    worst = std::max(worst, std::hypot(on_curve.unknowns(0) - on_branch.unknowns(0),
                                       on_curve.parameters(0) / on_branch.parameters(0) - 1));
  }
  return worst;
}

void report(const char* name, const SystemParameters& parameters, double to, double goal) {
  const problems::ForcedResponse problem(build_system(parameters));
  continuation::TraceOptions options;
  options.parameter = "eta";
  options.from = 0.5;
  options.to = to;
  options.extrema_of = {"Y"};
  const continuation::Guess guess = problem.guess(options.from, parameters.preload);
  continuation::Branch branch;
  const double seconds = median_seconds([&] { branch = continuation::trace(problem, guess, options); });
  const double evaluation = evaluation_seconds(problem, branch);
  const auto points = static_cast<double>(branch.points.size());
  const double iteration = iteration_seconds(problem, branch);
  fmt::print("{:<16} {:>7} {:>5.0f} {:>10.0f} {:>12.0f} {:>10.0f} {:>12.2f} {:>15.2f} {:>10.1e}\n", name,
             branch.points.size(), goal, points / seconds, 1e9 * seconds / points, 1e9 * evaluation,
             seconds / points / evaluation, iteration / evaluation, between_points(problem, branch));
}

}  // namespace

int main() {
  fmt::print("{:<16} {:>7} {:>5} {:>10} {:>12} {:>10} {:>12} {:>15} {:>10}\n", "branch", "points", "goal",
             "points/s", "ns/point", "ns/eval", "point/eval", "iteration/eval", "between");
  const std::pair<double, double> preloads[] = {
      {0.1, 7090}, {1.0, 415}, {5.0, 551}, {10.0, 682}, {50.0, 1771}};
  for (const auto& [preload, of_auto] : preloads) {
    SystemParameters beams;
    beams.mass_ratio = 5;
    beams.frequency_ratio = 4;
    beams.interface_stiffness = shear_interface_stiffness(33.3, 0.3);
    beams.preload = preload;
    report(fmt::format("beams P = {:g}", preload).c_str(), beams, 120, std::nan(""));
    SystemParameters rods = beams;
    rods.model = StructureModel::rods;
    rods.interface_stiffness = 1000;
    report(fmt::format("rods  P = {:g}", preload).c_str(), rods, 20, of_auto / 3);
  }
  return 0;
}
