#include "arcslip/problems/ridges/preload_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <new>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "arcslip/assembly/structures.hpp"
#include "arcslip/problems/ridges/free_response.hpp"
#include "arcslip/problems/ridges/peak_envelope.hpp"
#include "arcslip/problems/ridges/peak_search.hpp"

namespace arcslip::problems {
namespace {

template <std::size_t count>
std::string_view name_of(const std::array<std::string_view, count>& names, int which) {
  return names.at(static_cast<std::size_t>(which));
}

void check(const SystemParameters& system, const PreloadRange& range) {
  if (!(range.from > 0 && range.to > range.from && std::isfinite(range.to)))
    throw std::invalid_argument("study_preload: the range of preloads must be positive and not empty");
  if (!(range.eta_low > 0 && range.eta_high > range.eta_low && std::isfinite(range.eta_high)))
    throw std::invalid_argument("study_preload: the window of eta must be positive and not empty");
  // Beside zeta there may be other damping, which then may be all.
  const auto passive = [](double zeta, const Loss& other) {
    return zeta > 0 || (zeta == 0 && (other.viscous > 0 || other.mass > 0));
  };
  const PairLosses losses = structures_of(system).losses(system);
  if (!(passive(system.base_damping, losses.base_fixed) &&
        passive(system.damper_damping, losses.damper_fixed) && !system.has_others()))
    throw std::invalid_argument("study_preload: the system must be linear and passive but for friction");
  for (const double preload : range.stop_at) {
    if (!(preload >= range.from && preload <= range.to))
      throw std::invalid_argument(fmt::format("study_preload: stop_at: {} is not in the range", preload));
  }
}

/// Preloads at which the frequency response is looked at, then those halfway between them (on the scale of
/// ln P), and again beside each at which something new was found.
void look_everywhere(PeakSearch& search, double from, double to) {
  const int count = std::max(2, static_cast<int>(std::ceil(2 * std::log10(to / from))) + 1);
  std::vector<double> places;
  for (int i = 0; i + 1 < count; ++i)
    places.push_back(i == 0 ? from : from * std::pow(to / from, static_cast<double>(i) / (count - 1)));
  places.push_back(to);
  for (const double preload : places) search.look_at(preload);
  search.follow_from_meetings();
  struct Gap {
    double from;
    double to;
    int depth;
  };
  std::vector<Gap> gaps;
  for (std::size_t i = 0; i + 1 < places.size(); ++i) gaps.push_back({places[i], places[i + 1], 0});
  constexpr int most_halvings = 12;
  while (!gaps.empty()) {
    const Gap gap = gaps.back();
    gaps.pop_back();
    const double middle = std::sqrt(gap.from * gap.to);
    if (!search.look_at(middle) || gap.depth == most_halvings) continue;
    gaps.push_back({gap.from, middle, gap.depth + 1});
    gaps.push_back({middle, gap.to, gap.depth + 1});
  }
}

/// Pieces that go on in one another, by their positions, each chain with P rising.
std::vector<std::vector<std::size_t>> chains(const std::vector<PeakPiece>& pieces) {
  const auto goes_on = [&](std::size_t a, std::size_t b) {
    const PeakNode& end = pieces[a].nodes().back();
    const PeakNode& start = pieces[b].nodes().front();
    return end.preload == start.preload && std::abs(end.eta - start.eta) <= 1e-9 * end.eta;
  };
  std::vector<std::size_t> next(pieces.size(), pieces.size());
  std::vector<bool> is_first(pieces.size(), true);
  for (std::size_t a = 0; a < pieces.size(); ++a) {
    for (std::size_t b = 0; b < pieces.size() && next[a] == pieces.size(); ++b) {
      if (a == b || !is_first[b] || !goes_on(a, b)) continue;
      next[a] = b;
      is_first[b] = false;
    }
  }
  std::vector<std::vector<std::size_t>> result;
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    if (!is_first[p]) continue;
    result.emplace_back();
    for (std::size_t i = p; i < pieces.size(); i = next[i]) result.back().push_back(i);
  }
  std::sort(result.begin(), result.end(), [&](const auto& a, const auto& b) {
    const PeakNode& first = pieces[a.front()].nodes().front();
    const PeakNode& second = pieces[b.front()].nodes().front();
    return std::pair(first.preload, first.eta) < std::pair(second.preload, second.eta);
  });
  return result;
}

/// Puts results together.
class Assembly {
 public:
  Assembly(const std::vector<PeakPiece>& pieces, const PreloadRange& range)
      : pieces_(pieces), range_(range), chains_(chains(pieces)), envelope_(pieces, range.from, range.to) {}

  Optimum optimum() const;
  std::vector<PeakBranch> branches(double optimum) const;

 private:
  std::pair<std::size_t, std::size_t> lowest() const;
  bool linked(std::size_t a, std::size_t b) const;
  Peak peak_at(std::size_t piece, double preload) const;
  std::vector<double> places(std::size_t piece, double optimum) const;
  PeakType type_of(const std::vector<std::size_t>& chain, std::size_t position, const Peak& peak,
                   double optimum) const;
  bool is_exchange(std::size_t piece, double preload) const;

  const std::vector<PeakPiece>& pieces_;
  const PreloadRange& range_;
  std::vector<std::vector<std::size_t>> chains_;
  PeakEnvelope envelope_;
};

bool Assembly::linked(std::size_t a, std::size_t b) const {
  return std::any_of(chains_.begin(), chains_.end(), [&](const std::vector<std::size_t>& chain) {
    return std::count(chain.begin(), chain.end(), a) > 0 && std::count(chain.begin(), chain.end(), b) > 0;
  });
}

/// A peak may lie beyond the window's end by the error of curves.
Peak Assembly::peak_at(std::size_t piece, double preload) const {
  Peak peak = pieces_[piece].at(preload);
  peak.eta = std::clamp(peak.eta, range_.eta_low, range_.eta_high);
  return peak;
}

/// The knots from the first to the last one at which Y_max is as low as anywhere, as far as Y is known: of
/// what slips and sticks there, what sticks, whose Y does not depend on P at all. Only the lowest where they
/// are next to each other, as at the bottom of a valley.
std::pair<std::size_t, std::size_t> Assembly::lowest() const {
  constexpr double same = 1e-9;    // ln R is solved to 1e-10
  constexpr double valley = 1e-3;  // of ln P: within it even a curvature of 1e-3 would not show
  const std::vector<PeakEnvelope::Knot>& knots = envelope_.knots();
  const auto least = std::min_element(knots.begin(), knots.end(),
                                      [](const auto& a, const auto& b) { return a.log_Y < b.log_Y; });
  const auto position = static_cast<std::size_t>(least - knots.begin());
  const auto is_lowest = [&](std::size_t knot) { return knots[knot].log_Y <= least->log_Y + same; };
  std::size_t first = position;
  std::size_t last = position;
  while (first > 0 && is_lowest(first - 1)) --first;
  while (last + 1 < knots.size() && is_lowest(last + 1)) ++last;
  const auto is_long = [&](std::size_t a, std::size_t b) {
    return std::log(knots[b].preload / knots[a].preload) > valley;
  };
  if (!is_long(first, last)) return {position, position};
  for (std::size_t a = first, b = first; a <= last; a = b + 1) {
    for (b = a; b < last && knots[b + 1].log_Y == knots[a].log_Y;) ++b;
    if (is_long(a, b)) return {a, b};
  }
  return {first, last};
}

Optimum Assembly::optimum() const {
  const std::vector<PeakEnvelope::Knot>& knots = envelope_.knots();
  const auto [first, last] = lowest();
  const PeakEnvelope::Knot& least = knots[first];
  const std::vector<PeakEnvelope::Span>& spans = envelope_.spans();
  // Of two spans that meet there the lower one.
  const bool starts_span = least.span > 0 && least.preload == spans[least.span].from;
  const std::size_t span = starts_span ? least.span - 1 : least.span;

  Optimum best;
  best.peak = peak_at(spans[span].piece, least.preload);
  if (last > first) {
    best.kind = OptimumKind::flat;
    best.peak = envelope_.at(std::sqrt(least.preload * knots[last].preload));
  } else if (least.preload == spans[span].to && span + 1 < spans.size()) {
    const std::size_t next = spans[span + 1].piece;
    best.kind = linked(spans[span].piece, next) ? OptimumKind::corner : OptimumKind::exchange;
    if (best.kind == OptimumKind::exchange) best.other = peak_at(next, least.preload);
  } else if (least.preload == range_.from || least.preload == range_.to) {
    best.kind = OptimumKind::end;
  }
  const double level = least.log_Y + std::numbers::ln2;
  best.low = envelope_.leaves(first, level, false);
  best.high = envelope_.leaves(first, level, true);
  best.peak.type = PeakType::optimum;
  best.peak.is_global = true;
  return best;
}

std::vector<double> Assembly::places(std::size_t piece, double optimum) const {
  const PeakPiece& followed = pieces_[piece];
  std::vector<double> preloads = range_.stop_at;
  preloads.push_back(optimum);
  for (const PeakEnvelope::Span& span : envelope_.spans()) preloads.push_back(span.to);
  std::erase_if(preloads, [&](double preload) { return !followed.covers(preload); });
  for (const PeakNode& node : followed.nodes()) preloads.push_back(node.preload);
  std::sort(preloads.begin(), preloads.end());
  preloads.erase(std::unique(preloads.begin(), preloads.end()), preloads.end());
  return preloads;
}

bool Assembly::is_exchange(std::size_t piece, double preload) const {
  const std::vector<PeakEnvelope::Span>& spans = envelope_.spans();
  for (std::size_t i = 0; i + 1 < spans.size(); ++i) {
    if (spans[i].to == preload && (spans[i].piece == piece || spans[i + 1].piece == piece) &&
        !linked(spans[i].piece, spans[i + 1].piece))
      return true;
  }
  return false;
}

PeakType Assembly::type_of(const std::vector<std::size_t>& chain, std::size_t position, const Peak& peak,
                           double optimum) const {
  const std::size_t piece = chain[position];
  const double preload = peak.preload;
  if (preload == optimum && envelope_.owns(piece, preload)) return PeakType::optimum;
  if (is_exchange(piece, preload)) return PeakType::exchange;
  if (preload == range_.from) return PeakType::start;
  if (preload == range_.to) return PeakType::end;
  if (preload == pieces_[piece].from()) return position == 0 ? PeakType::birth : PeakType::corner;
  if (preload == pieces_[piece].to())
    return position + 1 == chain.size() ? PeakType::death : PeakType::corner;
  const std::vector<double>& listed = range_.stop_at;
  return std::count(listed.begin(), listed.end(), preload) > 0 ? PeakType::user : PeakType::regular;
}

std::vector<PeakBranch> Assembly::branches(double optimum) const {
  std::vector<PeakBranch> result;
  for (const std::vector<std::size_t>& chain : chains_) {
    PeakBranch branch;
    for (std::size_t position = 0; position < chain.size(); ++position) {
      const std::size_t piece = chain[position];
      for (const double preload : places(piece, optimum)) {
        Peak peak = peak_at(piece, preload);
        peak.type = type_of(chain, position, peak, optimum);
        peak.is_global = envelope_.owns(piece, preload);
        if (!branch.empty() &&
            branch.back().preload == preload) {  // both pieces hold the corner between them
          branch.back().is_global = branch.back().is_global || peak.is_global;
        } else {
          branch.push_back(peak);
        }
      }
    }
    result.push_back(std::move(branch));
  }
  return result;
}

}  // namespace

std::string_view to_string(PeakSite site) {
  return name_of(std::array<std::string_view, 4>{"slip", "stick", "corner", "edge"}, static_cast<int>(site));
}

std::string_view to_string(PeakType type) {
  return name_of(std::array<std::string_view, 9>{"regular", "start", "end", "birth", "death", "corner",
                                                 "exchange", "optimum", "user"},
                 static_cast<int>(type));
}

std::string_view to_string(OptimumKind kind) {
  return name_of(std::array<std::string_view, 6>{"smooth", "exchange", "corner", "flat", "end", "jump"},
                 static_cast<int>(kind));
}

PreloadStudy study_preload(const SystemParameters& parameters, const PreloadRange& range,
                           const continuation::TraceOptions& options) {
  check(parameters, range);
  PreloadStudy study;
  try {
    const FrictionSystem system = build_system(parameters);
    const Peak free = free_peak(system.base, range);
    study.free_eta = free.eta;
    study.free_Y = free.Y;
    const ForcedResponse problem(system);
    PeakSearch search(problem, range, options);
    look_everywhere(search, range.from, range.to);
    study.failure = search.failure();
    const Assembly assembly(search.pieces(), range);
    Optimum optimum = assembly.optimum();
    const double S = system.slip_threshold(optimum.peak.eta, optimum.peak.preload);
    optimum.energy = parameters.interface_stiffness * S * S * optimum.peak.dissipated;
    optimum.damping = equivalent_damping(system, parameters.base_damping, range, free, optimum.peak.Y);
    study.branches = assembly.branches(optimum.peak.preload);
    study.optimum = optimum;
  } catch (const std::bad_alloc&) {
    throw;  // no property of the system
  } catch (const std::exception& error) {
    study.failure = error.what();
  }
  return study;
}

}  // namespace arcslip::problems
