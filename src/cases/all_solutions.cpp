#include "cases/all_solutions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "arcslip/continuation/path/all_solutions.hpp"
#include "arcslip/continuation/path/newton.hpp"

namespace arcslip {
namespace {

using continuation::Guess;
using continuation::SolutionSearch;

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

/// As wide as to hold all that was found.
void widen(Corners& corners, const std::vector<Guess>& solutions) {
  constexpr double beyond = 1.1;
  const Vector centre = (corners.lower + corners.upper) / 2;
  for (const Guess& one : solutions) {
    const Vector away = one.unknowns - centre;
    corners.lower = corners.lower.cwiseMin(centre + beyond * away);
    corners.upper = corners.upper.cwiseMax(centre + beyond * away);
  }
}

Box box_of(const Corners& corners) {
  Box box;
  for (Index i = 0; i < corners.lower.size(); ++i) box.emplace_back(corners.lower(i), corners.upper(i));
  return box;
}

bool is_in(const Box& box, const Vector& u, double margin) {
  for (Index i = 0; i < u.size(); ++i) {
    const Interval& side = box[static_cast<std::size_t>(i)];
    const double more = margin * (1 + std::abs(u(i)));
    if (u(i) < side.lower() - more || u(i) > side.upper() + more) return false;
  }
  return true;
}

/// What an enclosure of F tells: adds the solutions that were not found before.
void prove(const Subject& subject, const EnclosedMap& map, const continuation::TimeBudget& time,
           AllSolutions& all) {
  BoxOptions options;
  options.go_on = [&] { return time.goes_on(); };
  const ZerosInBox found = zeros_in_box(map, all.count.box, options);
  std::size_t more = 0;
  for (const Box& zero : found.zeros) {
    const auto is_it = [&](const Guess& one) { return is_in(zero, one.unknowns, 1e-9); };
    if (std::any_of(all.solutions.begin(), all.solutions.end(), is_it)) continue;
    Guess start{Vector(std::ssize(zero)), subject.guess.parameters, {}, {}};
    for (Index i = 0; i < start.unknowns.size(); ++i)
      start.unknowns(i) = median(zero[static_cast<std::size_t>(i)]);
    const continuation::Solution solution = continuation::solve(*subject.built.problem, start);
    if (solution.outcome == continuation::Correction::converged) start.unknowns = solution.unknowns;
    all.solutions.push_back(start);
    ++more;
  }
  SolutionCount& count = all.count;
  if (found.proven()) {
    count.complete = true;
    count.reason = fmt::format("proven by interval arithmetic: the box holds {} and no other ({} boxes)",
                               found.zeros.size(), found.boxes);
    if (more > 0) count.reason += fmt::format(", {} of them found by it alone", more);
    const std::size_t outside = all.solutions.size() - std::min(found.zeros.size(), all.solutions.size());
    if (outside > 0) count.reason += fmt::format("; outside the box are {} more and perhaps others", outside);
  } else if (!found.finished) {
    count.reason = fmt::format("interval arithmetic came to no end in {} boxes", found.boxes);
  } else {
    count.reason = fmt::format(
        "proven by interval arithmetic but for {} region{}, where solutions coincide or nearly do: from",
        found.undecided.size(), found.undecided.size() == 1 ? "" : "s, the first of them");
    std::string to;
    for (const Interval& side : found.undecided.front()) {
      count.reason += fmt::format(" {:.9g}", side.lower());
      to += fmt::format(" {:.9g}", side.upper());
    }
    count.reason += " to" + to;
  }
}

/// What the search tells by itself.
std::string reason_of(const SolutionSearch& search) {
  if (!search.finished) return "the search was ended before it was done";
  std::string text = fmt::format("nothing more was found by deflation and on {} branch{}", search.branches,
                                 search.branches == 1 ? "" : "es");
  if (search.runs > 0) {
    const auto singles = static_cast<double>(search.singles);
    const double likely = singles + 2 * std::sqrt(singles + 1) + 1;  // Poisson's mean at most, at 95 %
    text += fmt::format(
        "; of {} Newton iterations from independent starts in the box {} ended where no other did, so that "
        "hardly more than {:.2g} % of further starts would end elsewhere",
        search.runs, search.singles, std::min(100.0, 100 * likely / static_cast<double>(search.runs)));
  }
  return text;
}

}  // namespace

AllSolutions find_all_solutions(const CaseBranch& request, const Subject& subject,
                                const continuation::TimeBudget& time) {
  const continuation::Problem& problem = *subject.built.problem;
  Corners corners = corners_of(request, subject);
  continuation::SolveAllOptions options;
  options.go_on = [&] { return time.goes_on(); };
  options.lower = corners.lower;
  options.upper = corners.upper;
  const SolutionSearch search = continuation::search_solutions(problem, {subject.guess}, options);
  AllSolutions all{search.solutions, {}};
  if (corners.lower.size() > 0) {
    if (request.box.empty()) widen(corners, search.solutions);
    all.count.box = box_of(corners);
    const problems::LibraryModel* model = request.problem.model.get();
    const std::vector<double> values(subject.guess.parameters.begin(), subject.guess.parameters.end());
    const EnclosedMap map = model != nullptr && model->enclosed ? model->enclosed(values) : EnclosedMap();
    if (map) prove(subject, map, time, all);
  }
  if (!all.count.complete) {
    all.count.reason += (all.count.reason.empty() ? "" : "; ") + reason_of(search);
    const auto degree = continuation::check_degree(problem, all.solutions, corners.lower, corners.upper);
    if (degree && degree->expected != degree->found) {
      all.count.complete = false;
      all.count.reason = fmt::format(
          "F points one way all over the surface of the ellipsoid in the box, at all points that were tried, "
          "so that the signs of det dF/du at the solutions in it have the sum {}, but that of those found is "
          "{}",
          degree->expected, degree->found);
    }
  }
  all.count.count = all.solutions.size();
  return all;
}

}  // namespace arcslip
