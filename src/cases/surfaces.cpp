#include "cases/surfaces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "cases/all_solutions.hpp"
#include "cases/curves.hpp"

namespace arcslip {

TracedBranch cover_surface(const std::shared_ptr<const CaseBranch>& request, const Subject& subject,
                           const continuation::TimeBudget& time) {
  constexpr double widest = 0.5;        // radius of a chart
  constexpr Index most_unknowns = 100;  // full matrices of all are factored
  const auto begun = std::chrono::steady_clock::now();
  const CurveRequest& asked = *request->curve;
  TracedBranch traced{request, subject.built, nullptr, {}, 0};
  if (const Index n = subject.built.problem->size(); n > most_unknowns)
    return unstarted(
        request, subject,
        fmt::format("a surface is covered in up to {} unknowns, and there are {}", most_unknowns, n));
  std::vector<continuation::Guess> starts{subject.guess};
  if (request->all_solutions) {
    problems::AllSolutions all = find_all_solutions(*request, subject, time);
    starts = std::move(all.solutions);
    traced.solutions = std::make_shared<const problems::SolutionCount>(std::move(all.count));
  }
  const continuation::TraceOptions given = time.rest();
  continuation::AtlasOptions options;
  options.parameters = {asked.active, given.parameter};
  options.from = {asked.from, given.from};
  options.to = {asked.to, given.to};
  options.max_radius = std::min(given.max_step, widest);
  if (given.max_points != continuation::TraceOptions().max_points) options.most_charts = given.max_points;
  options.extrema_of = given.extrema_of;
  if (options.extrema_of.empty()) {
    options.extrema_of = tracked_observables(request->problem, false);
    options.extrema_of.resize(std::min<std::size_t>(options.extrema_of.size(), 1));
  }
  options.max_seconds = given.max_seconds;
  options.go_on = given.go_on;
  traced.branch.stop = continuation::Stop::no_start;
  traced.branch.explanation = "there is no solution at the parameters of [system]";
  if (starts.empty()) return traced;
  auto atlas =
      std::make_shared<continuation::Atlas>(continuation::cover(*subject.built.problem, starts, options));
  traced.branch.stop = atlas->stop;
  traced.branch.explanation =
      atlas->complete() ? "the surface is covered as far as the box goes" : atlas->reason;
  traced.branch.work.evaluations = atlas->evaluations;
  traced.surface = std::move(atlas);
  traced.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  return traced;
}

}  // namespace arcslip
