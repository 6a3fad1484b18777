// What the engine adds to the work that a step cannot do without: the time of a branch over that of as many
// evaluations of F with its derivatives and as many factorisations of the bordered Jacobian, each with one
// solution, as the branch took by its own count. These are timed alone in the same run, on points of the
// branch. Goals: 3 for one unknown, 1.5 for 10, 1.2 for 100 (dense), 1.5 for 10^4 and 10^5 (sparse).
//
// At the end: what a point of a curve of folds costs beside one of the branch that it begins on, with a
// thousand unknowns. Goal: 10.
//
// usage: step_cost [largest number of unknowns, default 10^5]

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <vector>

#include "../support/engine_problems.hpp"
#include "../support/least_seconds.hpp"
#include "../support/sparse_problems.hpp"
#include "arcslip/continuation/curves/curve.hpp"
#include "arcslip/continuation/path/trace.hpp"
#include "arcslip/continuation/problem/linearization.hpp"

namespace {

using namespace arcslip;
using namespace arcslip::continuation;
using testing::least_seconds;

/// Bratu's problem in one dimension as an integral equation, u(x) = L int G(x, y) e^u(y) dy with Green's
/// function G = min(x, y) (1 - max(x, y)): its Jacobian is full.
class IntegralEquation : public Problem {
 public:
  explicit IntegralEquation(Index size) : kernel_(size, size) {
    const double h = 1 / static_cast<double>(size + 1);
    for (Index i = 0; i < size; ++i) {
      for (Index j = 0; j < size; ++j) {
        const auto low = static_cast<double>(std::min(i, j) + 1);
        const auto high = static_cast<double>(std::max(i, j) + 1);
        kernel_(i, j) = h * low * h * (1 - high * h);
      }
    }
  }
  Index size() const override { return kernel_.rows(); }
  std::vector<std::string> parameter_names() const override { return {"L"}; }
  bool evaluate(const Vector& u, const Vector& p, const Regime& /*regime*/,
                const Evaluation& out) const override {
    if (out.jacobian != nullptr) out.jacobian->setIdentity();
    if (out.residual != nullptr) *out.residual = u;
    if (out.parameter_jacobian != nullptr) out.parameter_jacobian->setZero();
    for (Index j = 0; j < size(); ++j) {
      const double source = std::exp(u(j));
      if (out.residual != nullptr) out.residual->noalias() -= p(0) * source * kernel_.col(j);
      if (out.parameter_jacobian != nullptr)
        out.parameter_jacobian->col(0).noalias() -= source * kernel_.col(j);
      if (out.jacobian != nullptr) out.jacobian->col(j).noalias() -= p(0) * source * kernel_.col(j);
    }
    return true;
  }

 private:
  Matrix kernel_;
};

struct Case {
  const char* name;
  const Problem& problem;
  Vector unknowns;
  Vector parameters;
  double from;
  double to;
  long points;
  double goal;
};

struct Cost {
  double evaluation;
  double factorization;
};

/// Seconds of one of each, over the points of a branch.
Cost cost_of_work(const Problem& problem, const Branch& branch, int runs) {
  const Index n = problem.size();
  Linearization at(problem);
  const auto solver = make_bordered_solver(n, 1, problem.sparse());
  const Vector scale = Vector::Ones(n);
  Vector x(n + 1);
  const std::size_t stride = 1 + branch.points.size() / (n < 50000 ? 200 : 8);
  const std::size_t visited = (branch.points.size() + stride - 1) / stride;
  const auto count = static_cast<double>(visited);
  const auto over_points = [&](bool factor) {
    for (std::size_t i = 0; i < branch.points.size(); i += stride) {
      const BranchPoint& point = branch.points[i];
      if (!at.evaluate(point.unknowns, point.parameters, point.regime)) std::abort();
      if (!factor) continue;
      at.fill(*solver, scale);
      solver->columns() = at.parameter_jacobian().col(0);
      solver->rows() = point.tangent.head(n).transpose();
      solver->corner()(0, 0) = point.tangent(n);
      x.setOnes();
      if (solver->factor() == 0) std::abort();
      solver->solve(x);
    }
  };
  over_points(true);  // orders a sparse matrix
  const int repeats = n < 1000 ? 20 : 1;
  const auto repeated = [&](bool factor) {
    return least_seconds(runs,
                         [&] {
                           for (int i = 0; i < repeats; ++i) over_points(factor);
                         }) /
           (repeats * count);
  };
  const double both = repeated(true);
  const double evaluation = repeated(false);
  return {evaluation, both - evaluation};
}

long peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss / 1024;
}

void report(const Case& c) {
  TraceOptions options;
  options.parameter = c.problem.parameter_names().front();
  options.from = c.from;
  options.to = c.to;
  options.max_points = c.points;
  const Index n = c.problem.size();
  const int runs = n < 1000 ? 25 : n < 50000 ? 5 : 1;
  Branch branch;
  const double seconds = least_seconds(runs, [&] {
    branch = trace(c.problem, {c.unknowns, c.parameters, 0, {}}, options);
  });
  const Cost cost = cost_of_work(c.problem, branch, std::max(runs, 3));
  const auto steps = static_cast<double>(branch.points.size());
  const auto folds = std::count_if(branch.points.begin(), branch.points.end(),
                                   [](const BranchPoint& point) { return point.type == PointType::fold; });
  const auto evaluations = static_cast<double>(branch.work.evaluations);
  const auto factorizations = static_cast<double>(branch.work.factorizations);
  const double bare = evaluations * cost.evaluation + factorizations * cost.factorization;
  fmt::print(
      "{:<20} {:>7} {:>6} {:>5} {:>5.1f} {:>5.1f} {:>11.4g} {:>11.4g} {:>11.4g} {:>6.2f} {:>5} {:>6}\n",
      c.name, n, branch.points.size(), folds, evaluations / steps, factorizations / steps,
      1e6 * seconds / steps, 1e6 * cost.evaluation, 1e6 * cost.factorization, seconds / bare, c.goal,
      peak_megabytes());
  std::fflush(stdout);
}

void report_folds(Index n) {
  const testing::Ignition ignition(n, true);
  TraceOptions over;
  over.parameter = "L";
  over.to = 5;
  over.stop_after = {{PointType::fold, 1, {}}};
  TraceOptions along;
  along.parameter = "K";
  along.to = 0.5;
  along.max_points = 41;
  Branch branch;
  Branch folds;
  const double of_branch = least_seconds(5, [&] {
    branch = trace(ignition, {Vector::Zero(n), Vector{{0.0, 0.0}}, 0, {}}, over);
  });
  const double of_folds = least_seconds(5, [&] {
    const CurveStart start = curve_through(ignition, "L", branch.points.back());
    folds = trace_curve(*start.problem, start.point, along);
  });
  const auto each = [](double seconds, const Branch& b) {
    return 1e6 * seconds / static_cast<double>(b.points.size());
  };
  fmt::print(
      "\ncurve of folds, {} unknowns: {} points, {:.4g} us/point, {:.1f} times one of the branch (goal: "
      "10)\n",
      n, folds.points.size(), each(of_folds, folds), each(of_folds, folds) / each(of_branch, branch));
}

}  // namespace

int main(int argc, char** argv) {
  const long largest = argc > 1 ? std::strtol(argv[1], nullptr, 10) : 100000;
  fmt::print("{:<20} {:>7} {:>6} {:>5} {:>5} {:>5} {:>11} {:>11} {:>11} {:>6} {:>5} {:>6}\n", "branch", "n",
             "points", "folds", "eval", "fact", "us/point", "us/eval", "us/fact", "ratio", "goal", "MB");
  const testing::Cusp cusp;
  report({"cusp", cusp, Vector{{-1.5}}, Vector{{-2.0}}, -2, 2, 100000, 3});
  for (const Index n : {Index{10}, Index{100}}) {
    const IntegralEquation equation(n);
    // 55 points: beyond, the peak is narrower than the grid, which makes branch points of its own.
    report({"integral equation", equation, Vector::Zero(n), Vector{{0.0}}, 0, 5, 55, n == 10 ? 1.5 : 1.2});
  }
  for (const Index n : {Index{10000}, Index{100000}}) {
    if (n > largest) break;
    const testing::BratuRectangle channel(10, n / 10);
    report({"channel", channel, Vector::Zero(n), Vector{{0.0}}, 0, 10, 20, 1.5});
    const auto side = static_cast<Index>(std::sqrt(static_cast<double>(n)));
    const testing::BratuRectangle square(side, side);
    report({"square", square, Vector::Zero(square.size()), Vector{{0.0}}, 0, 10, 60, 1.5});
  }
  const testing::BratuRectangle square(63, 63);
  report({"square, to L = 0", square, Vector::Zero(square.size()), Vector{{0.0}}, 0, 8, 100000, 1.5});
  report_folds(999);
  return 0;
}
