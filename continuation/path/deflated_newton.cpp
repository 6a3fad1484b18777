#include "arcslip/continuation/path/deflated_newton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "arcslip/continuation/problem/evaluation.hpp"

namespace arcslip::continuation {
namespace {

constexpr double rounding = std::numeric_limits<double>::epsilon();
constexpr double converges = 1e-6;  // of a correction: what is left is its square, rounding

Solution ended(Solution& solution, Correction outcome) {
  solution.outcome = outcome;
  return std::move(solution);
}

}  // namespace

DeflatedNewton::DeflatedNewton(const Problem& problem, const NewtonOptions& options)
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

Solution DeflatedNewton::run(const Guess& guess, const std::vector<Guess>& known) {
  double last = std::numeric_limits<double>::infinity();
  Solution solution{Correction::too_many_iterations, guess.unknowns, 0, last, 0};
  while (true) {
    if (options_.watch) options_.watch();
    if (!at_.evaluate(solution.unknowns, guess.parameters, guess.regime))
      return ended(solution, Correction::cannot_evaluate);
    solution.residual = at_.residual().lpNorm<Eigen::Infinity>();
    problem_.scale(solution.unknowns, guess.parameters, scale_, parameter_scale_);
    const bool stagnant = solution.residual >= 0.5 * last || solution.residual == 0;
    const bool good = solution.correction <= converges && (solution.residual <= options_.tolerance ||
                                                           solution.residual <= level(solution.unknowns));
    if (good && stagnant) return ended(solution, Correction::converged);
    if (solution.iterations >= options_.max_iterations)
      return ended(solution, good ? Correction::converged : Correction::too_many_iterations);
    last = solution.residual;
    if (!correct(solution, guess, known)) return ended(solution, Correction::singular);
  }
}

double DeflatedNewton::level(const Vector& u) {
  at_.multiply_absolute(u.cwiseAbs(), absolute_);
  return 8 * rounding * (1 + absolute_.lpNorm<Eigen::Infinity>());
}

bool DeflatedNewton::vanishes(const Guess& at, double elsewhere) {
  return at_.evaluate(at.unknowns, at.parameters, at.regime) &&
         at_.residual().lpNorm<Eigen::Infinity>() <= std::max(level(at.unknowns), 10 * elsewhere);
}

bool DeflatedNewton::correct(Solution& solution, const Guess& guess, const std::vector<Guess>& known) {
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
  solution.correction = std::abs(stretch) * correction_.head(n).norm() / std::sqrt(static_cast<double>(n));
  if (options_.max_correction > 0 && solution.correction > options_.max_correction) {
    stretch *= options_.max_correction / solution.correction;
    solution.correction = options_.max_correction;
  }
  if (options_.damped && solution.correction > converges) {
    stretch = part_of_correction(solution.unknowns, guess, stretch);
    if (stretch == 0) return false;
  }
  solution.unknowns += stretch * scale_.cwiseProduct(correction_.head(n));
  ++solution.iterations;
  return true;
}

/// The largest of `whole` and its halves after which the next correction is shorter, 0 if there is none.
double DeflatedNewton::part_of_correction(const Vector& u, const Guess& guess, double whole) {
  constexpr double least = 1e-4;
  const Index n = problem_.size();
  const double length = correction_.head(n).norm();
  Vector residual(n);
  Vector next(n + 1);
  for (double part = whole; part > least * whole; part *= 0.5) {
    if (!evaluate(problem_, u + part * scale_.cwiseProduct(correction_.head(n)), guess.parameters,
                  guess.regime, {.residual = &residual}))
      continue;
    next << -residual, 0;
    solver_->solve(next);
    if (next.head(n).norm() <= (1 - 0.25 * part) * length) return part;
  }
  return 0;
}

bool nearly_solves(const Problem& problem, const Guess& guess) {
  constexpr double hardly = 1e-8;
  Vector residual(problem.size());
  return evaluate(problem, guess.unknowns, guess.parameters, guess.regime, {.residual = &residual}) &&
         residual.lpNorm<Eigen::Infinity>() <= hardly;
}

Solution solve(const Problem& problem, const Guess& guess, const NewtonOptions& options) {
  return DeflatedNewton(problem, options).run(guess, {});
}

}  // namespace arcslip::continuation
