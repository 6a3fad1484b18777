#pragma once

// What a case asks for, done: problems built, branches and curves traced.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "arcslip/cases/case_file.hpp"
#include "arcslip/continuation/atlas/atlas.hpp"
#include "arcslip/continuation/path/branch.hpp"
#include "arcslip/continuation/problem/problem.hpp"
#include "arcslip/problems/proof/certificate.hpp"
#include "arcslip/problems/tasks/all_solutions.hpp"

namespace arcslip {

/// A problem with a guess of one of its solutions.
struct Subject {
  Built built;                                             ///< the problem
  continuation::Guess guess;                               ///< only where `failure` is empty
  std::string failure;                                     ///< why there is no guess, or empty
  continuation::Stop stop = continuation::Stop::no_start;  ///< what ended the search for it
};

/// The observables of which `extrema_of` may ask for the extrema, phases among them or not.
std::vector<std::string> tracked_observables(const ProblemRequest& request, bool with_phases = true);

/// The value of a parameter that is not continued.
double fixed_value(const ProblemRequest& problem, const std::string& parameter);

/// The branch over a curve's first parameter on which its first points are looked for.
CaseBranch seed_branch(const CaseBranch& request);

/// Whether a system with friction takes more than one contact in one harmonic on linear structures, solved by
/// its modes.
bool needs_balance(const SystemParameters& system, const std::optional<double>& harmonics_tolerance);

/// Builds the problem. Throws if no system fits what was asked for.
Built build(const ProblemRequest& request);

/// The same with a guess where `parameter` has this value and all else is as requested;
/// max_seconds and go_on of the limits may end the search for it.
Subject build(const ProblemRequest& request, const std::string& parameter, double value,
              const continuation::TraceOptions& limits = {});

/// A branch, or a curve of special points, with the problem that it solves.
struct TracedBranch {
  std::shared_ptr<const CaseBranch> request;                   ///< what was asked for
  Built base;                                                  ///< the problem that was built
  std::shared_ptr<const continuation::ExtendedProblem> curve;  ///< null of a branch
  continuation::Branch branch;                                 ///< of the curve, if it is one
  double seconds = 0;                                          ///< wall clock
  std::optional<problems::Certificate> certificate = {};       ///< where one was asked for
  /// What tables say of its points, where that is known already: a row for each, a column for each name, and
  /// maybe more.
  std::shared_ptr<const Matrix> told = nullptr;
  /// The same of tables that pictures are drawn from.
  std::shared_ptr<const Matrix> drawn = nullptr;
  /// Of the solutions that it was traced from, where all were asked for.
  std::shared_ptr<const problems::SolutionCount> solutions = nullptr;
  /// Of two parameters, in place of points.
  std::shared_ptr<const continuation::Atlas> surface = nullptr;

  /// That of which the branch holds solutions.
  const continuation::Problem& problem() const {
    return curve ? static_cast<const continuation::Problem&>(*curve) : *base.problem;
  }
};

/// Traces what is asked for: one branch, or several where branches are switched or several curves are found.
/// Never throws for a branch that fails: its `stop` tells.
std::vector<TracedBranch> trace(const CaseBranch& request, const continuation::Observer& observer = {});

/// The harmonics that a system leaves out although their force would move a contact by more than `tolerance`
/// times R at some point of its forced response, looked for up to about twice its highest one; none where
/// there is no time left.
std::vector<int> missing_orders(const SystemParameters& system, const continuation::Branch& branch,
                                double tolerance, const continuation::TimeBudget& time);

/// Adds orders to others, each once; the first one stays the first, the rest ascends.
void add_orders(std::vector<int>& orders, const std::vector<int>& more);

}  // namespace arcslip
