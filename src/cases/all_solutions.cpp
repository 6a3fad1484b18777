#include "cases/all_solutions.hpp"

#include <fmt/format.h>

namespace arcslip {
namespace {

using continuation::Guess;

/// Lowest and highest unknowns.
struct Corners {
  Vector lower, upper;
};

constexpr Index small = 50;  // unknowns up to which a box is looked through

/// The one of the case, or by the problem's scale around the guess.
Corners corners_of(const CaseBranch& request, const Subject& subject) {
  constexpr double wide = 10;  // of the problem's scale
  const Guess& guess = subject.guess;
  const Index n = guess.unknowns.size();
  if (!request.box.empty()) {
    const Index given = std::ssize(request.box) / 2;
    if (given != 1 && given != n)
      throw InputError(fmt::format("branch.box: expected 2 numbers, or 2 for each of the {} unknowns, got {}",
                                   n, request.box.size()));
    Corners corners{Vector(n), Vector(n)};
    for (Index i = 0; i < n; ++i) {
      const auto at = static_cast<std::size_t>(given == 1 ? 0 : 2 * i);
      corners.lower(i) = request.box[at];
      corners.upper(i) = request.box[at + 1];
    }
    return corners;
  }
  if (n > small) return {};
  Vector scale(n);
  Vector parameter_scale(guess.parameters.size());
  subject.built.problem->scale(guess.unknowns, guess.parameters, scale, parameter_scale);
  return {guess.unknowns - wide * scale, guess.unknowns + wide * scale};
}

}  // namespace

problems::AllSolutions find_all_solutions(const CaseBranch& request, const Subject& subject,
                                          const continuation::TimeBudget& time) {
  const Corners corners = corners_of(request, subject);
  continuation::SolveAllOptions options;
  options.go_on = [&] { return time.goes_on(); };
  options.lower = corners.lower;
  options.upper = corners.upper;
  const problems::LibraryModel* model = request.problem.model.get();
  const std::vector<double> values(subject.guess.parameters.begin(), subject.guess.parameters.end());
  const EnclosedMap map = model != nullptr && model->enclosed ? model->enclosed(values) : EnclosedMap();
  return problems::find_all_solutions(*subject.built.problem, {subject.guess}, options, map,
                                      request.box.empty());
}

}  // namespace arcslip
