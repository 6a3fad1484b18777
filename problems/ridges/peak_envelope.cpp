#include "arcslip/problems/ridges/peak_envelope.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "arcslip/zero_between.hpp"

namespace arcslip::problems {
namespace {

constexpr double doubt = 1e-3;  // of ln Y: estimates that are nearer to each other are not relied upon
constexpr int deepest = 40;

/// The zero of a function of ln P that changes its sign between two preloads.
template <class Function>
double preload_between(const Function& function, double from, double to) {
  const double at_from = function(from);
  const double at_to = function(to);
  if (at_from == 0 || from == to) return from;
  if (at_to == 0) return to;
  const double log_P = arcslip::zero_between([&](double x) { return function(std::exp(x)); }, std::log(from),
                                             std::log(to), at_from, at_to);
  return std::clamp(std::exp(log_P), from, to);
}

}  // namespace

PeakEnvelope::PeakEnvelope(const std::vector<PeakPiece>& pieces, double from, double to) : pieces_(pieces) {
  std::vector<double> breaks{from, to};
  for (const PeakPiece& piece : pieces) {
    breaks.push_back(std::clamp(piece.from(), from, to));
    breaks.push_back(std::clamp(piece.to(), from, to));
  }
  std::sort(breaks.begin(), breaks.end());
  breaks.erase(std::unique(breaks.begin(), breaks.end()), breaks.end());
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    std::vector<std::size_t> alive;
    std::vector<double> places{breaks[i], breaks[i + 1]};
    for (std::size_t p = 0; p < pieces.size(); ++p) {
      if (!pieces[p].covers(breaks[i]) || !pieces[p].covers(breaks[i + 1])) continue;
      alive.push_back(p);
      for (const PeakNode& node : pieces[p].nodes()) {
        if (node.preload > breaks[i] && node.preload < breaks[i + 1]) places.push_back(node.preload);
      }
    }
    if (alive.empty()) {
      throw std::runtime_error(
          fmt::format("no peak is known between P = {:.10g} and {:.10g}", breaks[i], breaks[i + 1]));
    }
    std::sort(places.begin(), places.end());
    std::size_t first = top(alive, places.front());
    for (std::size_t k = 0; k + 1 < places.size(); ++k) {
      const std::size_t last = top(alive, places[k + 1]);
      resolve(alive, places[k], first, places[k + 1], last, 0);
      first = last;
    }
  }
  place_knots();
}

std::size_t PeakEnvelope::top(const std::vector<std::size_t>& alive, double preload) const {
  if (alive.size() == 1) return alive.front();
  double highest = -std::numeric_limits<double>::infinity();
  std::size_t best = alive.front();
  std::vector<double> estimates;
  for (const std::size_t p : alive) {
    estimates.push_back(pieces_[p].estimate(preload).value);
    if (estimates.back() > highest) {
      highest = estimates.back();
      best = p;
    }
  }
  double exact = 0;  // Y of the best one, once it is known
  for (std::size_t i = 0; i < alive.size(); ++i) {
    if (alive[i] == best || estimates[i] < highest - doubt) continue;
    if (exact == 0) exact = pieces_[best].at(preload).Y;
    const double other = pieces_[alive[i]].at(preload).Y;
    if (other > exact) {
      exact = other;
      best = alive[i];
    }
  }
  return best;
}

/// Between two preloads at which it is known which peak is the highest.
void PeakEnvelope::resolve(const std::vector<std::size_t>& alive, double from, std::size_t first, double to,
                           std::size_t last, int depth) {
  if (first == last) return check_between(alive, from, to, first, depth);
  const auto lead = [&](double preload) {
    return std::log(pieces_[first].at(preload).Y / pieces_[last].at(preload).Y);
  };
  const double exchange = preload_between(lead, from, to);
  const std::size_t third = top(alive, exchange);
  if (third == first || third == last || depth > deepest || exchange == from || exchange == to) {
    append(from, exchange, first);
    append(exchange, to, last);
  } else {
    resolve(alive, from, first, exchange, third, depth + 1);
    resolve(alive, exchange, third, to, last, depth + 1);
  }
}

/// Whether another peak is higher for a while between two preloads at which `owner` is the highest: where its
/// distance is least, by the slopes.
void PeakEnvelope::check_between(const std::vector<std::size_t>& alive, double from, double to,
                                 std::size_t owner, int depth) {
  for (const std::size_t p : alive) {
    if (p == owner || depth > deepest) continue;
    const auto lead = [&](double preload) {
      const ValueAndSlope a = pieces_[owner].estimate(preload);
      const ValueAndSlope b = pieces_[p].estimate(preload);
      return ValueAndSlope{a.value - b.value, a.slope - b.slope};
    };
    const ValueAndSlope at_from = lead(from);
    const ValueAndSlope at_to = lead(to);
    if (!(at_from.slope < 0 && at_to.slope > 0)) continue;
    const double least = preload_between([&](double preload) { return lead(preload).slope; }, from, to);
    if (least == from || least == to || lead(least).value > doubt) continue;
    const std::size_t between = top(alive, least);
    if (between == owner) continue;
    resolve(alive, from, owner, least, between, depth + 1);
    resolve(alive, least, between, to, owner, depth + 1);
    return;
  }
  append(from, to, owner);
}

void PeakEnvelope::append(double from, double to, std::size_t piece) {
  if (!(to > from)) return;
  if (!spans_.empty() && spans_.back().piece == piece) {
    spans_.back().to = to;
  } else {
    spans_.push_back({from, to, piece});
  }
}

double PeakEnvelope::extremum(const PeakPiece& piece, double from, double to) const {
  return preload_between([&](double preload) { return piece.at(preload).sensitivity.preload; }, from, to);
}

void PeakEnvelope::place_knots() {
  for (std::size_t s = 0; s < spans_.size(); ++s) {
    const Span& span = spans_[s];
    const PeakPiece& piece = pieces_[span.piece];
    std::vector<double> places{span.from, span.to};
    for (const PeakNode& node : piece.nodes()) {
      if (node.preload > span.from && node.preload < span.to) places.push_back(node.preload);
    }
    std::sort(places.begin(), places.end());
    Peak last = piece.at(places.front());
    knots_.push_back({last.preload, std::log(last.Y), s});
    for (std::size_t i = 1; i < places.size(); ++i) {
      const Peak next = piece.at(places[i]);
      if (last.sensitivity.preload * next.sensitivity.preload < 0) {
        const double turn = extremum(piece, last.preload, next.preload);
        if (turn > last.preload && turn < next.preload)
          knots_.push_back({turn, std::log(piece.at(turn).Y), s});
      }
      knots_.push_back({next.preload, std::log(next.Y), s});
      last = next;
    }
  }
}

Peak PeakEnvelope::at(double preload) const {
  const auto span = std::find_if(spans_.begin(), spans_.end() - 1,
                                 [&](const Span& candidate) { return preload <= candidate.to; });
  return pieces_[span->piece].at(preload);
}

bool PeakEnvelope::owns(std::size_t piece, double preload) const {
  return std::any_of(spans_.begin(), spans_.end(), [&](const Span& span) {
    return span.piece == piece && preload >= span.from && preload <= span.to;
  });
}

double PeakEnvelope::leaves(std::size_t knot, double log_level, bool upwards) const {
  std::size_t i = knot;
  while (upwards ? i + 1 < knots_.size() : i > 0) {
    const Knot& inside = knots_[i];
    i = upwards ? i + 1 : i - 1;
    const Knot& outside = knots_[i];
    if (outside.log_Y <= log_level) continue;
    const PeakPiece& piece = pieces_[spans_[outside.span].piece];
    const auto above = [&](double preload) { return std::log(piece.at(preload).Y) - log_level; };
    return preload_between(above, std::min(inside.preload, outside.preload),
                           std::max(inside.preload, outside.preload));
  }
  return knots_[i].preload;
}

}  // namespace arcslip::problems
