// Responses from end to end, and the solutions that they start from.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "arcslip/continuation/path/newton.hpp"
#include "arcslip/problems/ridges/response_peaks.hpp"

namespace arcslip::problems {

using continuation::Branch;
using continuation::BranchPoint;
using continuation::Guess;
using continuation::Stop;

Guess ResponsePeaks::guess_at(const BranchPoint& point) {
  return {point.unknowns, point.parameters, point.regime, {}};
}

std::vector<Guess>::iterator ResponsePeaks::found_at(End& end, double across) const {
  return std::lower_bound(end.known.begin(), end.known.end(), across, [&](const Guess& guess, double wanted) {
    return guess.parameters(across_) < wanted;
  });
}

/// The solution at an end of `along`, traced over `across` from the nearest one that is known; null where
/// that does not lead there.
const Guess* ResponsePeaks::start(End& end, double across, std::string& why_not) {
  const auto value = [&](const Guess& guess) { return guess.parameters(across_); };
  std::vector<Guess>& known = end.known;
  const auto place = found_at(end, across);
  if (place != known.end() && value(*place) == across) return &*place;
  auto near = place;
  if (place == known.end() ||
      (place != known.begin() && across / value(*(place - 1)) < value(*place) / across))
    near = place - 1;
  constexpr double beside = 1e-6;  // too near for steps between the two
  constexpr double same = 1e-3;    // of a solution: what hardly depends on it is the same one
  const bool is_beside = std::abs(across / value(*near) - 1) < beside;
  if (is_beside || response_.is_polished) {
    Guess guess = *near;
    guess.parameters(across_) = across;
    const continuation::Solution solution = continuation::solve(*response_.problem, guess);
    guess.unknowns = solution.unknowns;
    const bool is_same =
        is_beside || (guess.unknowns - near->unknowns).norm() <= same * near->unknowns.norm();
    if (solution.outcome == continuation::Correction::converged && is_same && is_inside(guess))
      return &*known.insert(place, std::move(guess));
  }
  continuation::TraceOptions options = response_.options;
  options.parameter = response_.across;
  options.from = value(*near);
  options.to = across;
  options.extrema_of.clear();
  const Branch way = trace(*response_.problem, *near, options);
  if (is_unfinished(way.stop)) throw continuation::Unfinished(way.stop, way.explanation);
  if (!way.complete() || way.points.back().parameters(across_) != across) {
    why_not =
        fmt::format("at {} = {:.10g} no way leads there: {}", response_.along, end.place, way.explanation);
    return nullptr;
  }
  return &*known.insert(place, guess_at(way.points.back()));
}

/// From one end towards the other; with steps a fifth as long, where other points may do, if it is not whole.
Branch ResponsePeaks::trace_from(End& end, double across, bool is_rough) {
  constexpr double finer = 0.2;
  Branch branch = trace_from(end, across, is_rough, response_.options.max_step);
  if (branch.complete() || branch.stop == Stop::no_start) return branch;
  return trace_from(end, across, is_rough, finer * response_.options.max_step);
}

Branch ResponsePeaks::trace_from(End& end, double across, bool is_rough, double longest) {
  continuation::TraceOptions options = response_.options;
  options.parameter = response_.along;
  options.from = end.place;
  options.to = &end == &first_ ? response_.to : response_.from;
  options.max_step = longest;
  options.rough_extrema = is_rough;
  ++traced_;
  Branch branch;
  if (const Guess* guess = start(end, across, branch.explanation)) {
    branch = trace(*response_.problem, *guess, options);
  } else {
    branch.stop = Stop::no_start;
  }
  if (is_unfinished(branch.stop)) throw continuation::Unfinished(branch.stop, branch.explanation);
  return branch;
}

Branch ResponsePeaks::response_at(double across) { return traced_at(across, false); }

/// From end to end. Where several solutions begin, all but one of them come back: that one is met from the
/// other end.
Branch ResponsePeaks::traced_at(double across, bool is_rough) {
  Branch branch = trace_from(first_, across, is_rough);
  if (branch.stop == Stop::reached_end) {
    remember(last_, branch.points.back());
    return branch;
  }
  if ((branch.stop == Stop::left_range || branch.stop == Stop::no_start) && knows_last(across)) {
    Branch other = trace_from(last_, across, is_rough);
    if (other.stop == Stop::reached_end) {
      remember(first_, other.points.back());
      return other;
    }
  }
  const bool asks = response_.reason_of_end && !branch.points.empty();
  const std::string why =
      asks ? response_.reason_of_end(branch.points.back().parameters(along_)) : std::string();
  throw std::runtime_error(fmt::format("the response at {} = {:.10g} could not be traced: {}{}{}",
                                       response_.across, across, branch.explanation, why.empty() ? "" : ": ",
                                       why));
}

void ResponsePeaks::remember(End& end, const BranchPoint& point) const {
  const auto place = found_at(end, point.parameters(across_));
  const bool is_known = place != end.known.end() && place->parameters(across_) == point.parameters(across_);
  if (is_known)
    *place = guess_at(point);
  else
    end.known.insert(place, guess_at(point));
}

/// Whether some response is known to lead to the last value of `along`: if none is yet, others are tried.
bool ResponsePeaks::knows_last(double across) {
  for (double factor = 10; last_.known.empty() && factor < 1e5; factor *= 10) {
    for (const double other : {across * factor, across / factor}) {
      const Branch branch = trace_from(first_, other, true);
      if (branch.stop == Stop::reached_end) remember(last_, branch.points.back());
    }
  }
  return !last_.known.empty();
}

}  // namespace arcslip::problems
