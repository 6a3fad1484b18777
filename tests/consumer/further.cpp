// What can be done with branches beyond tracing one, on two problems of the library.

#include <algorithm>
#include <arcslip/arcslip.hpp>
#include <iostream>
#include <sstream>

using namespace arcslip;
using namespace arcslip::continuation;

namespace {

TraceOptions over(const std::string& parameter, double from, double to) {
  TraceOptions options;
  options.parameter = parameter;
  options.from = from;
  options.to = to;
  return options;
}

bool switch_branches() {
  const problems::PredatorPrey problem;
  const Guess guess{Vector::Zero(2), Vector::Constant(1, 0.1)};
  // All branches that hang together, through branch points and corners at which several pieces meet.
  for (const Branch& branch : trace_connected(problem, guess, over("p", 0.1, 1)))
    std::cout << branch.points.size() << " points: " << branch.explanation << '\n';
  return trace_connected(problem, guess, over("p", 0.1, 1)).size() == 5;
}

bool follow_folds(const Problem& problem, const BranchPoint& fold) {
  // The curve through a fold of a branch in mu: both parameters move.
  const CurveStart start = curve_through(problem, "mu", fold);
  const Branch curve =
      trace_curve(*start.problem, start.point, over("lambda", -1, 3), {.low = -5, .high = 5});
  for (const BranchPoint& point : curve.points) {
    const BasePoint at = start.problem->split(point.unknowns, point.parameters, point.regime);
    std::cout << to_string(point.type) << ": mu, lambda = " << at.parameters.transpose() << '\n';
  }
  return curve.complete();
}

bool resume_later(const Problem& problem, const Guess& guess, TraceOptions options) {
  options.max_points = 10;
  const Branch begun = trace(problem, guess, options);
  // A checkpoint is text. The branch goes on from it bit by bit as if it had never been left.
  std::stringstream file;
  write(file, *begun.checkpoint);
  options.max_points = 100000;
  const Branch rest = resume(problem, read_checkpoint(file), options);
  const Branch whole = trace(problem, guess, options);
  return begun.points.size() + rest.points.size() == whole.points.size() &&
         rest.points.back().unknowns == whole.points.back().unknowns;
}

bool sample(const Problem& problem, const Branch& branch) {
  // Between its points a branch is a smooth curve, of which every sample knows its error; with a third
  // argument, &problem, samples are solved for.
  const InterpolatedBranch curve(branch, 0);
  for (const Sample& at : curve.where(0.1)) std::cout << at.unknowns(0) << " +- " << at.error(0) << '\n';
  // All solutions at fixed parameters: deflation, and branches that come back to them.
  const std::vector<Guess> all = solve_all(problem, {{Vector::Zero(1), Eigen::Vector2d(0.1, 1)}});
  return curve.where(0.1).size() == 3 && all.size() == 3;
}

}  // namespace

int main() {
  const problems::Cusp cusp;
  const Guess lowest{Vector::Constant(1, -1.5), Eigen::Vector2d(-2, 1)};  // x; mu and lambda
  const TraceOptions options = over("mu", -2, 2);
  const Branch branch = trace(cusp, lowest, options);
  const auto fold = std::find_if(branch.points.begin(), branch.points.end(),
                                 [](const BranchPoint& point) { return point.type == PointType::fold; });
  const bool good = fold != branch.points.end() && follow_folds(cusp, *fold) &&
                    resume_later(cusp, lowest, options) && sample(cusp, branch) && switch_branches();
  return good ? 0 : 1;
}
