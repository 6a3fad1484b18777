#include "arcslip/continuation/path/newton.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "arcslip/continuation/problem/linearization.hpp"

namespace arcslip::continuation {
namespace {

constexpr double rounding = std::numeric_limits<double>::epsilon();
constexpr double converges = 1e-6;  // of a correction: what is left is its square, rounding

/// Newton's method with work space of its own and with known solutions taken out: with
/// m(u) = prod_i (1 + 1/|u - u_i|^2) the correction of m F = 0 is that of F = 0, stretched.
class Newton {
 public:
  Newton(const Problem& problem, const NewtonOptions& options)
      : problem_(problem),
        options_(options),
        at_(problem),
        solver_(at_.make_solver(1)),
        scale_(problem.size()),
        parameter_scale_(static_cast<Index>(problem.parameter_names().size())),
        absolute_(problem.size()),
        correction_(problem.size() + 1) {
    solver_->columns().setZero();
    solver_->rows().setZero();
    solver_->corner()(0, 0) = 1;
  }

  Solution run(const Guess& guess, const std::vector<Guess>& known) {
    Solution solution{Correction::too_many_iterations, guess.unknowns, 0, 0};
    double last = std::numeric_limits<double>::infinity();
    double length = last;
    while (true) {
      if (!at_.evaluate(solution.unknowns, guess.parameters, guess.regime))
        return ended(solution, Correction::cannot_evaluate);
      solution.residual = at_.residual().lpNorm<Eigen::Infinity>();
      problem_.scale(solution.unknowns, guess.parameters, scale_, parameter_scale_);
      const bool stagnant = solution.residual >= 0.5 * last || solution.residual == 0;
      const bool good =
          solution.residual <= options_.tolerance || solution.residual <= level(solution.unknowns);
      if (good && length <= converges && stagnant) return ended(solution, Correction::converged);
      if (solution.iterations >= options_.max_iterations)
        return ended(solution,
                     good && length <= converges ? Correction::converged : Correction::too_many_iterations);
      last = solution.residual;
      if (!correct(solution, guess, known, length)) return ended(solution, Correction::singular);
    }
  }

 private:
  static Solution ended(Solution& solution, Correction outcome) {
    solution.outcome = outcome;
    return std::move(solution);
  }

  double level(const Vector& u) {
    at_.multiply_absolute(u.cwiseAbs(), absolute_);
    return 8 * rounding * (1 + absolute_.lpNorm<Eigen::Infinity>());
  }

  bool correct(Solution& solution, const Guess& guess, const std::vector<Guess>& known, double& length) {
    const Index n = problem_.size();
    at_.fill(*solver_, scale_);
    if (solver_->factor() == 0) return false;
    correction_.head(n) = -at_.residual();
    correction_(n) = 0;
    solver_->solve(correction_);
    if (!correction_.allFinite()) return false;
    double stretch = 1;
    double slope = 0;  // of ln m along the correction
    for (const Guess& solved : known) {
      if (solved.regime != guess.regime) continue;
      const Vector away = (solution.unknowns - solved.unknowns).cwiseQuotient(scale_);
      const double square = away.squaredNorm();
      if (square == 0) return false;
      slope -= 2 * away.dot(correction_.head(n)) / (square * (1 + square));
    }
    stretch = 1 / (1 - slope);
    if (!std::isfinite(stretch)) return false;
    length = std::abs(stretch) * correction_.head(n).norm() / std::sqrt(static_cast<double>(n));
    if (options_.max_correction > 0 && length > options_.max_correction) {
      stretch *= options_.max_correction / length;
      length = options_.max_correction;
    }
    solution.unknowns += stretch * scale_.cwiseProduct(correction_.head(n));
    ++solution.iterations;
    return true;
  }

  const Problem& problem_;
  NewtonOptions options_;
  Linearization at_;
  std::unique_ptr<BorderedSolver> solver_;
  Vector scale_;
  Vector parameter_scale_;
  Vector absolute_;
  Vector correction_;
};

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

/// Collects solutions: each start is tried until nothing new comes of it, then the next.
class Collector {
 public:
  Collector(const Problem& problem, const SolveAllOptions& options)
      : problem_(problem),
        options_(options),
        newton_(problem, {options.tolerance, 60, 10}),
        plain_(problem, {options.tolerance}) {}

  void exhaust(const Guess& start) {
    while (!options_.go_on || options_.go_on()) {
      Solution deflated = newton_.run(start, known_);
      if (deflated.outcome != Correction::converged) return;
      // Once more without deflation, which would stretch the last corrections.
      Solution solution = plain_.run({deflated.unknowns, start.parameters, start.regime}, {});
      if (solution.outcome != Correction::converged) return;
      Guess found{std::move(solution.unknowns), start.parameters, start.regime};
      if (!is_new(found)) return;
      known_.push_back(std::move(found));
    }
  }

  const std::vector<Guess>& known() const { return known_; }

 private:
  bool is_new(const Guess& found) const {
    Vector scale(problem_.size());
    Vector parameter_scale(found.parameters.size());
    problem_.scale(found.unknowns, found.parameters, scale, parameter_scale);
    for (const Guess& other : known_) {
      if (other.regime == found.regime &&
          (found.unknowns - other.unknowns).cwiseQuotient(scale).lpNorm<Eigen::Infinity>() <
              options_.tolerances.same_solution) {
        return false;
      }
    }
    return true;
  }

  const Problem& problem_;
  const SolveAllOptions& options_;
  Newton newton_;
  Newton plain_;
  std::vector<Guess> known_;
};

}  // namespace

Solution solve(const Problem& problem, const Guess& guess, const NewtonOptions& options) {
  return Newton(problem, options).run(guess, {});
}

std::vector<Guess> solve_all(const Problem& problem, const std::vector<Guess>& guesses,
                             const SolveAllOptions& options) {
  if (guesses.empty()) throw std::invalid_argument("solve_all: at least one guess is needed");
  const double on_border = options.tolerances.both_sides;
  Collector collector(problem, options);
  for (const Guess& guess : guesses) collector.exhaust(guess);
  if (options.lower.size() == problem.size()) {
    std::mt19937_64 random(options.seed);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int i = 0; i < options.starts; ++i) {
      Vector u = options.lower;
      for (Index k = 0; k < u.size(); ++k) u(k) += unit(random) * (options.upper(k) - options.lower(k));
      collector.exhaust(in_its_regime(problem, {u, guesses.front().parameters, guesses.front().regime, {}}));
    }
  }
  for (std::size_t i = 0; i < collector.known().size(); ++i) {
    const Guess again = collector.known()[i];
    Vector near = again.unknowns;
    near.array() += 1e-3 * (1 + near.array().abs());
    collector.exhaust({near, again.parameters, again.regime, {}});
    if (!inside(problem, again, on_border)) collector.exhaust(in_its_regime(problem, again));
  }
  std::vector<Guess> solutions;
  for (const Guess& solution : collector.known()) {
    if (inside(problem, solution, on_border)) solutions.push_back(solution);
  }
  return solutions;
}

}  // namespace arcslip::continuation
