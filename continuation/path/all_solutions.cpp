#include "arcslip/continuation/path/all_solutions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <random>
#include <set>
#include <stdexcept>

#include "arcslip/continuation/path/deflated_newton.hpp"
#include "arcslip/continuation/path/switching.hpp"
#include "arcslip/dense.hpp"

namespace arcslip::continuation {
namespace {

constexpr std::size_t most_solutions = 1000;  // solutions: there are no more, or they are not isolated

bool inside(const Problem& problem, const Guess& solution, double on_border) {
  return crossed_border(problem, solution.unknowns, solution.parameters, solution.regime, on_border) < 0;
}

/// In the regime that the point lies in: borders that it lies beyond are crossed, the first of them first.
/// Where that does not end, as with borders that do not fit each other, in the last one.
Guess in_its_regime(const Problem& problem, Guess guess) {
  for (Index i = 0; i <= problem.switch_count(); ++i) {
    const int border = crossed_border(problem, guess.unknowns, guess.parameters, guess.regime, 0);
    const auto beyond = border < 0 ? std::nullopt : problem.regime_beyond(guess.regime, border);
    if (!beyond) break;
    guess.regime = *beyond;
  }
  return guess;
}

/// Collects solutions, each once.
class Collector {
 public:
  Collector(const Problem& problem, const SolveAllOptions& options)
      : problem_(problem),
        options_(options),
        newton_(problem, {options.tolerance, 60, 10}),
        plain_(problem, {options.tolerance}) {}

  /// Tries a start until nothing new comes of it.
  void exhaust(const Guess& start) {
    while (goes_on()) {
      Solution deflated = newton_.run(start, known_);
      if (deflated.outcome != Correction::converged) return;
      // Once more without deflation, which would stretch the last corrections.
      const std::size_t before = known_.size();
      if (!add({std::move(deflated.unknowns), start.parameters, start.regime, {}})) return;
      if (known_.size() == before) return;
    }
  }

  /// Which solution Newton's method finds from here; none where it finds none.
  std::optional<std::size_t> add(const Guess& start) {
    Solution solution = plain_.run(start, {});
    const bool is_exact = solution.outcome == Correction::singular && solution.residual == 0;
    if (solution.outcome != Correction::converged && !is_exact) return std::nullopt;
    Guess found{std::move(solution.unknowns), start.parameters, start.regime, {}};
    for (std::size_t i = 0; i < known_.size(); ++i) {
      if (is_same(known_[i], found, std::max(residuals_[i], solution.residual))) return i;
    }
    known_.push_back(std::move(found));
    residuals_.push_back(solution.residual);
    return known_.size() - 1;
  }

  bool goes_on() {
    if (known_.size() >= most_solutions || (options_.go_on && !options_.go_on())) ended_ = true;
    return !ended_;
  }
  bool ended() const { return ended_; }
  const std::vector<Guess>& known() const { return known_; }

 private:
  /// Whether what F has between both is rounding: a root that is double is known to the root of it.
  bool is_same(const Guess& a, const Guess& b, double residual) {
    constexpr double near = 1e-3;
    constexpr double rounding = 1e-12;
    constexpr double between = 0.382;  // not where a third one lies that is as far from both
    if (a.regime != b.regime) return false;
    Vector scale(problem_.size());
    Vector parameter_scale(b.parameters.size());
    problem_.scale(b.unknowns, b.parameters, scale, parameter_scale);
    const Vector apart = b.unknowns - a.unknowns;
    const double distance = apart.cwiseQuotient(scale).lpNorm<Eigen::Infinity>();
    if (distance < rounding) return true;
    return distance < near &&
           plain_.vanishes({a.unknowns + between * apart, b.parameters, b.regime, {}}, residual);
  }

  const Problem& problem_;
  const SolveAllOptions& options_;
  DeflatedNewton newton_;
  DeflatedNewton plain_;
  std::vector<Guess> known_;
  std::vector<double> residuals_;
  bool ended_ = false;
};

/// Looks for solutions where the branches through known ones come back to the parameters.
class Branches {
 public:
  Branches(const Problem& problem, const SolveAllOptions& options, Collector& collector)
      : problem_(problem), options_(options), collector_(collector), names_(problem.parameter_names()) {}

  void follow(std::size_t number) {
    const Guess from = collector_.known()[number];
    if (!inside(problem_, from, options_.tolerances.both_sides)) return;
    for (Index k = 0; k < std::ssize(names_) && collector_.goes_on(); ++k) {
      if (passed_.contains({number, k}) || !depends_on(from, k)) continue;
      const TraceOptions options = over(from, k);
      const Branch first = trace_both(problem_, from, options);
      gather(first, from, k);
      passed_.insert({number, k});
      if (!collector_.goes_on()) return;
      for (const Branch& branch : trace_leaving(problem_, first.points, options)) gather(branch, from, k);
    }
  }

  long count() const { return count_; }

 private:
  TraceOptions over(const Guess& from, Index k) const {
    Vector scale(from.unknowns.size());
    Vector parameter_scale(from.parameters.size());
    problem_.scale(from.unknowns, from.parameters, scale, parameter_scale);
    const double value = from.parameters(k);
    TraceOptions options;
    options.parameter = names_[static_cast<std::size_t>(k)];
    options.from = value - options_.window * parameter_scale(k);
    options.to = value + options_.window * parameter_scale(k);
    options.stop_at = {value};
    options.max_points = options_.max_points;
    options.max_branches = 20;
    options.go_on = options_.go_on;
    options.tolerances = options_.tolerances;
    return options;
  }

  bool depends_on(const Guess& at, Index k) const {
    Vector residual(problem_.size());
    Matrix slopes(problem_.size(), std::ssize(names_));
    Evaluation out;
    out.residual = &residual;
    out.parameter_jacobian = &slopes;
    return problem_.evaluate(at.unknowns, at.parameters, at.regime, out) && !slopes.col(k).isZero(0);
  }

  void gather(const Branch& branch, const Guess& from, Index k) {
    ++count_;
    for (const BranchPoint& point : branch.points) {
      const Guess at{point.unknowns, from.parameters, point.regime, {}};
      if (point.parameters(k) == from.parameters(k)) {
        if (const auto found = collector_.add(at)) passed_.insert({*found, k});
      } else if (point.type == PointType::fold) {
        collector_.exhaust(at);
      }
    }
  }

  const Problem& problem_;
  const SolveAllOptions& options_;
  Collector& collector_;
  std::vector<std::string> names_;
  std::set<std::pair<std::size_t, Index>> passed_;  // solutions on branches in each parameter
  long count_ = 0;
};

void check_box(const SolveAllOptions& options, Index unknowns) {
  const Vector& lower = options.lower;
  const Vector& upper = options.upper;
  if (lower.size() == 0 && upper.size() == 0) return;
  const bool fits = lower.size() == unknowns && upper.size() == unknowns && lower.allFinite() &&
                    upper.allFinite() && (lower.array() < upper.array()).all();
  if (!fits)
    throw std::invalid_argument(
        fmt::format("box: expected the lowest and the highest value of {}, finite and in this order",
                    unknowns == 1 ? "the unknown" : fmt::format("each of the {} unknowns", unknowns)));
}

/// Starts spread over the box; counts what Newton's method finds from them by itself.
void start_in_box(const Problem& problem, const Guess& first, const SolveAllOptions& options,
                  Collector& collector, SolutionSearch& search) {
  std::mt19937_64 random(options.seed);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<long> hits;
  for (int i = 0; i < options.starts && collector.goes_on(); ++i) {
    Vector u = options.lower;
    for (Index k = 0; k < u.size(); ++k) u(k) += unit(random) * (options.upper(k) - options.lower(k));
    const Guess start = in_its_regime(problem, {u, first.parameters, first.regime, {}});
    const auto found = collector.add(start);
    collector.exhaust(start);
    if (!found || !inside(problem, collector.known()[*found], options.tolerances.both_sides)) continue;
    hits.resize(std::max(hits.size(), *found + 1));
    ++hits[*found];
    ++search.runs;
  }
  search.singles = std::count(hits.begin(), hits.end(), 1);
}

}  // namespace

SolutionSearch search_solutions(const Problem& problem, const std::vector<Guess>& guesses,
                                const SolveAllOptions& options) {
  if (guesses.empty()) throw std::invalid_argument("solve_all: at least one guess is needed");
  check_box(options, problem.size());
  const double on_border = options.tolerances.both_sides;
  SolutionSearch search;
  Collector collector(problem, options);
  Branches branches(problem, options, collector);
  for (const Guess& guess : guesses) collector.exhaust(guess);
  if (options.lower.size() == problem.size())
    start_in_box(problem, guesses.front(), options, collector, search);
  for (std::size_t i = 0; i < collector.known().size() && collector.goes_on(); ++i) {
    const Guess again = collector.known()[i];
    Vector near = again.unknowns;
    near.array() += 1e-3 * (1 + near.array().abs());
    collector.exhaust({near, again.parameters, again.regime, {}});
    if (!inside(problem, again, on_border)) collector.exhaust(in_its_regime(problem, again));
    if (options.branches) branches.follow(i);
  }
  for (const Guess& solution : collector.known()) {
    if (inside(problem, solution, on_border)) search.solutions.push_back(solution);
  }
  search.branches = branches.count();
  search.finished = !collector.ended();
  return search;
}

std::vector<Guess> solve_all(const Problem& problem, const std::vector<Guess>& guesses,
                             const SolveAllOptions& options) {
  return search_solutions(problem, guesses, options).solutions;
}

std::optional<DegreeCheck> check_degree(const Problem& problem, const std::vector<Guess>& solutions,
                                        const Vector& lower, const Vector& upper) {
  constexpr int samples_each = 200;  // of the surface, for each unknown
  constexpr double regular = 1e-10;  // reciprocal condition
  const Index n = problem.size();
  if (problem.sparse() || problem.switch_count() > 0 || solutions.empty() || lower.size() != n)
    return std::nullopt;
  const Vector centre = (lower + upper) / 2;
  const Vector radii = (upper - lower) / 2;
  const Guess& first = solutions.front();
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  Vector outward(n);
  Vector residual(n);
  int sign = 0;
  for (Index i = 0; i < samples_each * n; ++i) {
    for (double& entry : outward) entry = normal(random);
    outward.normalize();
    const Vector u = centre + radii.cwiseProduct(outward);
    if (!problem.evaluate(u, first.parameters, first.regime, {&residual})) return std::nullopt;
    const double along = residual.dot(outward.cwiseQuotient(radii));
    const int here = along > 0 ? 1 : along < 0 ? -1 : 0;
    if (here == 0 || (sign != 0 && here != sign)) return std::nullopt;
    sign = here;
  }
  DegreeCheck check{sign > 0 || n % 2 == 0 ? 1 : -1, 0};
  Matrix jacobian(n, n);
  for (const Guess& one : solutions) {
    if (!((one.unknowns - centre).cwiseQuotient(radii).norm() < 1)) continue;
    if (!problem.evaluate(one.unknowns, one.parameters, one.regime, {&residual, &jacobian}))
      return std::nullopt;
    if (!(reciprocal_condition(jacobian) > regular)) return std::nullopt;
    check.found += orientation(jacobian);
  }
  return check;
}

}  // namespace arcslip::continuation
