// Speed of studies: designs a second on one thread, and how much faster two threads are (goal: 1.9 times).
// The designs are beams like the paper's, combinations of mass ratio and frequency ratio; each is computed,
// stored and at the end exported, as `arcslip study` does. Where other programs use the cores as well the
// times say little; the processor time of a design does not depend on them, and is the same on two threads
// where these neither wait for one another nor take turns in the memory. Last what one design costs as a
// ratio to what noise hits alike, measured by turns in the same run: a point of one traced response, and an
// evaluation of its residual and derivatives (goal: 2500 points).

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <thread>
#include <vector>

#include "../../src/results/study_results.hpp"
#include "../../src/results/study_run.hpp"
#include "../support/least_seconds.hpp"
#include "arcslip/cases/study_case.hpp"
#include "arcslip/problems/response/forced_response.hpp"

namespace {

using namespace arcslip;
using Clock = std::chrono::steady_clock;

constexpr const char* chart = R"([system]
model = "beams"
wave_number = 1
elements = 30
mass_ratio = 5.0
frequency_ratio = 4.0
slenderness = 33.3
force = 1.0
[study]
parameter = "P"
from = 0.1
to = 100.0
eta = [0.5, 6.0]
for_each = { mass_ratio = { from = 5.0, to = 50.0, count = 10 }, frequency_ratio = { from = 2.0, to = 5.0, count = 10 } }
)";

struct Times {
  double wall = 0;
  double processor = 0;
};

double processor_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

Times run(const std::string& folder, const StudyCase& study, std::size_t jobs) {
  const Clock::time_point start = Clock::now();
  const double before = processor_seconds();
  {
    StudyStore store(folder, study, false);
    PendingDesigns pending(store.finished());
    StudyWorkers workers(study, jobs);
    compute(
        workers, pending,
        [&](const FinishedDesign& design) { store.add(design.curve, design.values, design.result); },
        [] { return true; });
    write_results(folder, study, store, {});
  }
  return {std::chrono::duration<double>(Clock::now() - start).count(), processor_seconds() - before};
}

/// The least of each: whatever else runs only adds to them.
Times least(const std::vector<Times>& times) {
  Times best = times.front();
  for (const Times& one : times)
    best = {std::min(best.wall, one.wall), std::min(best.processor, one.processor)};
  return best;
}

/// What one design costs, in points of the response at the middle of its preloads and in evaluations.
void print_ratios(const StudyCase& study) {
  const StudyDesign design = study.design(0);
  const problems::ForcedResponse problem(build_system(design.system));
  continuation::TraceOptions options = study.options;
  options.parameter = "eta";
  options.from = design.range.eta_low;
  options.to = design.range.eta_high;
  options.extrema_of = {"Y"};
  const double preload = std::sqrt(design.range.from * design.range.to);
  const auto traced = [&] {
    return continuation::trace(problem, problem.guess(design.range.eta_low, preload), options);
  };
  const continuation::Branch branch = traced();
  Vector residual(1);
  Matrix jacobian(1, 1);
  Matrix parameter_jacobian(1, 2);
  double sum = 0;
  double design_seconds = HUGE_VAL;
  double trace_seconds = HUGE_VAL;
  double evaluations_seconds = HUGE_VAL;
  for (int turn = 0; turn < 40; ++turn) {
    design_seconds =
        std::min(design_seconds, testing::least_seconds(1, [&] {
                   sum += problems::study_preload(design.system, design.range, study.options).free_Y;
                 }));
    trace_seconds =
        std::min(trace_seconds, testing::least_seconds(4, [&] { sum += traced().points[0].arclength; }));
    evaluations_seconds = std::min(evaluations_seconds, testing::least_seconds(4, [&] {
                                     for (const continuation::BranchPoint& point : branch.points) {
                                       problem.evaluate(point.unknowns, point.parameters, point.regime,
                                                        {&residual, &jacobian, &parameter_jacobian});
                                       sum += residual(0);
                                     }
                                   }));
  }
  const auto points = static_cast<double>(branch.points.size());
  fmt::print("\none design, of {:.2f} ms: {:.0f} points of a traced response, {:.0f} evaluations{}\n",
             1e3 * design_seconds, design_seconds / trace_seconds * points,
             design_seconds / evaluations_seconds * points, sum == 1 ? " " : "");  // which keeps the work
}

}  // namespace

int main() {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / fmt::format("arcslip_study_speed_{}", getpid());
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "case.toml") << chart;
  const StudyCase study = read_study((folder / "case.toml").string());
  std::array<std::vector<Times>, 2> times;
  for (int repeat = 0; repeat < 3; ++repeat) {
    for (const std::size_t jobs : {1, 2}) times[jobs - 1].push_back(run(folder.string(), study, jobs));
  }
  std::filesystem::remove_all(folder);
  const Times one = least(times[0]);
  const Times two = least(times[1]);
  const auto count = static_cast<double>(study.count);
  fmt::print("{:<10} {:>12} {:>16} {:>10}\n", "threads", "designs/s", "processor ms", "speed-up");
  fmt::print("{:<10} {:>12.1f} {:>16.2f} {:>10.2f}\n", 1, count / one.wall, 1e3 * one.processor / count, 1.0);
  fmt::print("{:<10} {:>12.1f} {:>16.2f} {:>10.2f}\n", 2, count / two.wall, 1e3 * two.processor / count,
             one.wall / two.wall);
  if (std::thread::hardware_concurrency() < 2) fmt::print("this machine has one core\n");
  print_ratios(study);
  return 0;
}
