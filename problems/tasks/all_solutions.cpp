#include "arcslip/problems/tasks/all_solutions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "arcslip/continuation/path/newton.hpp"

namespace arcslip::problems {
namespace {

using continuation::Guess;
using continuation::SolutionSearch;

/// As wide as to hold all that was found.
void widen(Vector& lower, Vector& upper, const std::vector<Guess>& solutions) {
  constexpr double beyond = 1.1;
  const Vector centre = (lower + upper) / 2;
  for (const Guess& one : solutions) {
    const Vector away = one.unknowns - centre;
    lower = lower.cwiseMin(centre + beyond * away);
    upper = upper.cwiseMax(centre + beyond * away);
  }
}

Box box_of(const Vector& lower, const Vector& upper) {
  Box box;
  for (Index i = 0; i < lower.size(); ++i) box.emplace_back(lower(i), upper(i));
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
void prove(const continuation::Problem& problem, const Guess& at, const EnclosedMap& map,
           const std::function<bool()>& go_on, AllSolutions& all) {
  BoxOptions options;
  options.go_on = go_on;
  const ZerosInBox found = zeros_in_box(map, all.count.box, options);
  std::size_t more = 0;
  for (const Box& zero : found.zeros) {
    const auto is_it = [&](const Guess& one) { return is_in(zero, one.unknowns, 1e-9); };
    if (std::any_of(all.solutions.begin(), all.solutions.end(), is_it)) continue;
    Guess start{Vector(std::ssize(zero)), at.parameters, {}, {}};
    for (Index i = 0; i < start.unknowns.size(); ++i)
      start.unknowns(i) = median(zero[static_cast<std::size_t>(i)]);
    const continuation::Solution solution = continuation::solve(problem, start);
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

AllSolutions find_all_solutions(const continuation::Problem& problem, const std::vector<Guess>& guesses,
                                const continuation::SolveAllOptions& options, const EnclosedMap& enclosed,
                                bool widened) {
  const SolutionSearch search = continuation::search_solutions(problem, guesses, options);
  AllSolutions all{search.solutions, {}};
  Vector lower = options.lower;
  Vector upper = options.upper;
  if (lower.size() > 0) {
    if (widened) widen(lower, upper, search.solutions);
    all.count.box = box_of(lower, upper);
    if (enclosed) prove(problem, guesses.front(), enclosed, options.go_on, all);
  }
  if (!all.count.complete) {
    all.count.reason += (all.count.reason.empty() ? "" : "; ") + reason_of(search);
    const auto degree = continuation::check_degree(problem, all.solutions, lower, upper);
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

}  // namespace arcslip::problems
