#include "arcslip/problems/ridges/highest_peak.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace arcslip::problems {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double per_decade = 8;       // samples at first
constexpr std::size_t most = 400;      // samples in all
constexpr double settled = 1e-9;       // of M: as well as heights are known, with room for rounding
constexpr double level_slope = 1e-9;   // dM/dx of a smooth minimum, as exact as peaks are known
constexpr double same_height = 1e-10;  // of peaks, the tolerance of responses
constexpr double rounding = 1e-12;     // of L
constexpr double narrow = 1e-11;       // in x: what is left of a minimum on a corner
constexpr double beside_jump = 1e-7;   // in x: so near to where parts of a response meet they are told apart

/// The zero of a function that is positive at `low` and negative at `high`.
template <class Function>
double falls_to_zero(const Function& function, double low, double high) {
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (function(middle) > 0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double slope_of(const EnvelopePiece& piece, double x) {
  const double h = piece.to.x - piece.from.x;
  const double t = (x - piece.from.x) / h;
  const double chord = (piece.to.value - piece.from.value) / h;
  return (1 - t) * (1 - 3 * t) * piece.from.slope + t * (3 * t - 2) * piece.to.slope +
         6 * t * (1 - t) * chord;
}

}  // namespace

HighestPeak::HighestPeak(ResponsePeaks& responses, double from, double to, const std::vector<double>& wanted,
                         Looks looks)
    : responses_(responses), looks_(looks) {
  const double length = std::log(to / from);
  const double count = std::max(2.0, std::ceil(per_decade * length / std::numbers::ln10));
  const double stride = looks == Looks::followed ? 2 : 1;
  add(std::log(to), to);
  for (double i = count - stride; i > 0; i -= stride) add(std::log(from) + length * i / count);
  add(std::log(from), from);
  for (double i = count - 1; i > 0; --i) add(std::log(from) + length * i / count);
  for (const double value : wanted) add(std::log(value), value);
}

std::size_t HighestPeak::position(double x) const {
  const auto place =
      std::lower_bound(samples_.begin(), samples_.end(), x,
                       [](const PeakSample& sample, double value) { return sample.x < value; });
  return static_cast<std::size_t>(place - samples_.begin());
}

double HighestPeak::value(double x) const {
  const std::size_t place = position(x);
  return place < samples_.size() && samples_[place].x == x ? samples_[place].value : std::exp(x);
}

const PeakSample& HighestPeak::add(double x) { return add(x, std::exp(x)); }

PeakSample HighestPeak::whole_sample(double x, double value) {
  PeakSample sample{x, value, responses_.at(value), 0};
  if (sample.peaks.empty()) throw std::runtime_error("there is no peak in the window");
  sample.top = highest_of(sample.peaks);
  return sample;
}

const PeakSample& HighestPeak::add(double x, double value) {
  const std::size_t place = position(x);
  if (place < samples_.size() && samples_[place].x == x) return samples_[place];
  if (samples_.size() >= most)
    throw std::runtime_error("the preload with the lowest peak is not settled by 400 responses");
  const bool may_follow = looks_ == Looks::followed && place > 0 && place < samples_.size();
  std::optional<PeakSample> followed;
  if (may_follow) followed = followed_peaks(responses_, samples_[place - 1], samples_[place], x, value);
  PeakSample sample = followed ? *std::move(followed) : whole_sample(x, value);
  return *samples_.insert(samples_.begin() + static_cast<std::ptrdiff_t>(place), std::move(sample));
}

/// By how much the cubic between its neighbours misses the highest peak of a sample, over the product of the
/// squares of the distances: d4L/dx4/24. None where the peak does not go on to both.
double HighestPeak::fourth_order(std::size_t i) const {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  if (i == 0 || i + 1 >= samples_.size()) return unknown;
  const PeakSample& below = samples_[i - 1];
  const PeakSample& here = samples_[i];
  const PeakSample& above = samples_[i + 1];
  for (const auto& [k, middle] : joined_peaks(below, here)) {
    if (middle != here.top) continue;
    for (const auto& [left, right] : joined_peaks(here, above)) {
      if (left != here.top) continue;
      const EnvelopePiece wide{node_of(below, k), node_of(above, right)};
      const double distances = (here.x - below.x) * (above.x - here.x);
      return std::abs(wide.at(here.x) - here.highest().log_height) / (distances * distances);
    }
  }
  return unknown;
}

PeakInterval HighestPeak::interval(std::size_t i) const {
  const PeakSample& from = samples_[i];
  const PeakSample& to = samples_[i + 1];
  PeakInterval interval{from, to, joined_peaks(from, to), {}, 0};
  for (const auto& [k, l] : interval.pairs) interval.pieces.push_back({node_of(from, k), node_of(to, l)});
  const double h = interval.length();
  const double coefficient = std::fmax(fourth_order(i), fourth_order(i + 1));  // the one that is known
  // Where a ridge changes its site its second derivative jumps, and errors fall as squares only.
  constexpr double safety = 4;
  interval.error =
      std::isnan(coefficient)
          ? 0.1 * h * std::max({0.5, std::abs(from.highest().slope), std::abs(to.highest().slope)})
          : safety * coefficient * std::pow(0.5 * h, 4);
  return interval;
}

/// Where M may be lower than `level`.
std::optional<double> HighestPeak::room_below(double level) const {
  constexpr int parts = 16;
  constexpr double shortest = 1e-6;  // an end of a ridge is not followed further
  std::optional<double> place;
  for (std::size_t i = 0; i + 1 < samples_.size(); ++i) {
    const PeakInterval between = interval(i);
    const double h = between.length();
    if (h < shortest) continue;
    for (int k = 1; k < parts; ++k) {
      const double x = between.from.x + h * k / parts;
      const double bound = between.pieces.empty() ? -infinity : between.height(x) - between.error_at(x);
      if (!(bound < level)) continue;
      level = bound;
      place = between.is_clear() ? x : between.from.x + 0.5 * h;
    }
  }
  return place;
}

double HighestPeak::least() const {
  const auto lowest = std::min_element(samples_.begin(), samples_.end(), [](const auto& a, const auto& b) {
    return a.highest().log_height < b.highest().log_height;
  });
  return lowest->x;
}

void HighestPeak::bound() {
  while (const auto x = room_below(sample(least()).highest().log_height - settled)) add(*x);
}

/// Where the minimum between two samples seems to be; of a search that does not get nearer, where their
/// tangents meet.
double HighestPeak::next_place(std::size_t low, bool stagnates) const {
  const PeakInterval between = interval(low);
  const EnvelopePiece falling = between.ahead(between.from.top);
  const EnvelopePiece rising = between.back(between.to.top);
  const double a = between.from.x;
  const double b = between.to.x;
  const EnvelopePiece left = stagnates ? line(falling.from, a, b) : falling;
  const EnvelopePiece right = stagnates ? line(rising.to, a, b) : rising;
  const bool one_ridge = between.partner_of_from(between.from.top) == between.to.top && !stagnates;
  const double x = one_ridge ? falls_to_zero([&](double at) { return -slope_of(left, at); }, a, b)
                             : falls_to_zero([&](double at) { return left.at(at) - right.at(at); }, a, b);
  const double margin = 1e-4 * (b - a);
  return std::clamp(x, a + margin, b - margin);
}

/// Whether two peaks of equal height change places here, one rising, one falling.
bool HighestPeak::settle_exchange(const PeakSample& here, Lowest& lowest) const {
  for (std::size_t k = 0; k < here.peaks.size(); ++k) {
    if (k == here.top) continue;
    const double steepness = std::abs(here.peaks[k].slope - here.highest().slope);
    const double above = here.highest().log_height - here.peaks[k].log_height;
    const bool equal = above <= same_height * std::min(1.0, steepness);
    if (!equal || !(here.peaks[k].slope * here.highest().slope < 0)) continue;
    const bool falls = here.highest().slope < 0;
    lowest = {OptimumKind::exchange, here.x, falls ? here.top : k, falls ? k : here.top, 0, 0};
    return true;
  }
  return false;
}

/// Two neighbouring samples, that of the lowest M and one, between which M falls and rises again; one place
/// where M falls as far as the range goes, or does so to no more than the width of a corner.
std::pair<double, double> HighestPeak::valley() {
  for (;;) {
    std::size_t at = position(least());
    const bool rises = samples_[at].highest().slope > 0;
    const auto is_last = [&] { return rises ? at == 0 : at + 1 == samples_.size(); };
    const auto goes_on = [&](const PeakSample& next) {  // of heights that differ by rounding the slopes tell
      return next.highest().slope * samples_[at].highest().slope > 0 &&
             next.highest().log_height <= samples_[at].highest().log_height + rounding;
    };
    while (!is_last() && goes_on(samples_[rises ? at - 1 : at + 1])) at = rises ? at - 1 : at + 1;
    if (is_last()) return {samples_[at].x, samples_[at].x};
    const PeakSample& low = samples_[rises ? at - 1 : at];
    const PeakSample& high = samples_[rises ? at : at + 1];
    const bool found = low.highest().slope <= 0 && high.highest().slope >= 0;
    if (found || high.x - low.x <= narrow) return {low.x, high.x};
    add(0.5 * (low.x + high.x));
  }
}

/// The minimum next to the lowest sample.
void HighestPeak::settle(Lowest& lowest) {
  const auto is_settled = [&](double x) {
    const PeakSample& here = sample(x);
    lowest = {OptimumKind::smooth, x, here.top, std::nullopt, 0, 0};
    // What is level may be a range that sticks, above the minimum.
    if (here.highest().log_height > sample(least()).highest().log_height + same_height) return false;
    return settle_exchange(here, lowest) || std::abs(here.highest().slope) <= level_slope;
  };
  if (is_settled(least())) return;
  auto [low, high] = valley();
  if (low == high) {
    lowest = {OptimumKind::end, low, sample(low).top, std::nullopt, 0, 0};
    return;
  }
  int slow = 0;
  while (high - low > narrow) {
    if (high - low <= beside_jump && jumps(sample(low), sample(high))) break;
    const double width = high - low;
    const double x = add(slow % 4 == 3 ? 0.5 * (low + high) : next_place(position(low), slow % 4 == 2)).x;
    if (is_settled(x)) return;
    const double slope = sample(x).highest().slope;
    (slope < 0 || (slope == 0 && x < least()) ? low : high) = x;
    slow = high - low > 0.5 * width ? slow + 1 : 0;
  }
  settle_corner(low, high, lowest);
}

/// What a minimum is that lies between two samples at one place.
void HighestPeak::settle_corner(double low, double high, Lowest& lowest) const {
  const PeakSample& from = sample(low);
  const PeakSample& to = sample(high);
  constexpr double unlike = 1e-5;  // of slopes, as that of a peak close beside a corner
  if (jumps(from, to)) {
    const PeakSample& lower = to.highest().log_height < from.highest().log_height ? to : from;
    lowest = {OptimumKind::jump, lower.x, lower.top, std::nullopt, 0, 0};
    return;
  }
  const PeakInterval between = interval(position(low));
  lowest = {OptimumKind::corner, low, from.top, std::nullopt, 0, 0};
  if (to.highest().slope - from.highest().slope <= unlike) {
    lowest.kind = OptimumKind::smooth;
  } else if (between.partner_of_from(from.top) != to.top) {
    lowest.kind = OptimumKind::exchange;
    lowest.other = between.partner_of_to(to.top);
  }
}

/// The place beyond x, towards larger (way = 1) or smaller ones, where M rises above a level.
double HighestPeak::leaves(double x, double level, int way, double precision) {
  const auto is_above = [&](const PeakSample& sample) { return sample.highest().log_height > level; };
  std::size_t inside = position(x);
  while (!is_above(samples_[inside])) {
    if (way > 0 ? inside + 1 == samples_.size() : inside == 0) return samples_[inside].x;
    inside = way > 0 ? inside + 1 : inside - 1;
  }
  double outside = samples_[inside].x;
  double within = samples_[way > 0 ? inside - 1 : inside + 1].x;
  for (int i = 1; std::abs(outside - within) > precision; ++i) {
    const PeakInterval between = interval(position(std::min(outside, within)));
    double next = 0.5 * (outside + within);
    if (i % 4 != 0 && !between.pieces.empty()) {
      const double found =
          falls_to_zero([&](double at) { return between.height(at) - level; }, outside, within);
      // Beyond it by what the cubics may be wrong, so that the place is soon between two samples.
      const double beyond = std::max(0.5 * precision, 1e-3 * std::abs(outside - within));
      next = found + (i % 2 == 0 ? beyond : -beyond);
    }
    const double low = std::min(outside, within);
    const double high = std::max(outside, within);
    const double margin = 0.01 * std::min(precision, high - low);
    const PeakSample& here = add(std::clamp(next, low + margin, high - margin));
    (is_above(here) ? outside : within) = here.x;
  }
  return within;
}

/// What is the same to 1e-9 over a range: the middle of it.
bool HighestPeak::settle_flat(Lowest& lowest) {
  constexpr double same = 1e-9;
  constexpr double constant = 1e-12;  // slope of what sticks, but for rounding
  constexpr double precise = 1e-8;
  const double x = least();
  const double level = sample(x).highest().log_height + same;
  const auto is_flat = [&](std::size_t i) {
    return samples_[i].highest().log_height <= level && std::abs(samples_[i].highest().slope) <= constant;
  };
  const std::size_t at = position(x);
  const bool before = at > 0 && is_flat(at - 1);
  const bool behind = at + 1 < samples_.size() && is_flat(at + 1);
  if (!is_flat(at) || !(before || behind)) return false;
  const double low = leaves(x, level, -1, precise);
  const double high = leaves(x, level, 1, precise);
  const PeakSample& middle = add(0.5 * (low + high));
  lowest = {OptimumKind::flat, middle.x, middle.top, std::nullopt, 0, 0};
  return true;
}

/// Whether the response there was looked at whole, and those on both sides of what seems a corner or a jump,
/// which a peak that was not followed may have made; from now on they are.
bool HighestPeak::is_confirmed(const Lowest& lowest) {
  const std::size_t at = position(lowest.x);
  const bool is_of_two = lowest.kind == OptimumKind::corner || lowest.kind == OptimumKind::jump;
  const std::size_t beside = is_of_two ? 1 : 0;
  bool all = true;
  for (std::size_t i = at - std::min(at, beside); i <= std::min(at + beside, samples_.size() - 1); ++i) {
    PeakSample& known = samples_[i];
    if (known.is_whole) continue;
    known = whole_sample(known.x, known.value);
    all = false;
  }
  return all;
}

HighestPeak::Lowest HighestPeak::lowest(double precise) {
  Lowest lowest;
  // On the way to one minimum a lower one may show, in a valley between samples.
  constexpr int most_valleys = 10;
  for (int i = 0; i < most_valleys; ++i) {
    bound();
    if (!settle_flat(lowest)) settle(lowest);
    const bool is_least =
        sample(least()).highest().log_height >= sample(lowest.x).highest().log_height - settled;
    if (is_least && is_confirmed(lowest)) break;
  }
  const double level = sample(lowest.x).highest().log_height + std::numbers::ln2;
  lowest.low = leaves(lowest.x, level, -1, precise);
  lowest.high = leaves(lowest.x, level, 1, precise);
  return lowest;
}

/// Where the highest peak is another one, to where both are of equal height.
void HighestPeak::settle_exchanges() {
  constexpr double precise = 1e-9;
  for (std::size_t i = 0; i + 1 < samples_.size(); ++i) {
    double low = samples_[i].x;
    double high = samples_[i + 1].x;
    const PeakInterval at_first = interval(i);
    const bool exchange =
        at_first.is_clear() && at_first.partner_of_from(samples_[i].top) != samples_[i + 1].top;
    if (!exchange || !(at_first.pieces.size() > 1)) continue;
    for (int tries = 0; tries < 12 && high - low > precise; ++tries) {
      const PeakInterval between = interval(position(low));
      const auto difference = [&](double x) {
        return between.ahead(between.from.top).at(x) - between.back(between.to.top).at(x);
      };
      const double margin = 1e-4 * (high - low);
      const double place = std::clamp(falls_to_zero(difference, low, high), low + margin, high - margin);
      const PeakSample& here = add(place);
      const auto is_as_high = [&](const ResponsePeak& peak) {
        return peak.log_height >= here.highest().log_height - same_height;
      };
      if (std::count_if(here.peaks.begin(), here.peaks.end(), is_as_high) > 1) break;
      const PeakInterval below = interval(position(low));
      const bool is_first = below.is_clear() && below.partner_of_from(below.from.top) == below.to.top;
      (is_first ? low : high) = place;
    }
    i = position(high) - 1;
  }
}

double HighestPeak::refine(double tolerance, std::size_t most_samples) {
  for (;;) {
    double worst = 0;
    double place = 0;
    for (std::size_t i = 0; i + 1 < samples_.size(); ++i) {
      const PeakInterval between = interval(i);
      const bool ends = between.length() < 1e-6;
      if (ends || between.error <= worst) continue;
      worst = between.error;
      place = between.from.x + 0.5 * between.length();
    }
    if (worst <= tolerance || samples_.size() >= most_samples) return worst;
    add(place);
  }
}

std::vector<EnvelopePiece> HighestPeak::pieces() const {
  std::vector<EnvelopePiece> all;
  for (std::size_t i = 0; i + 1 < samples_.size(); ++i) {
    const PeakInterval between = interval(i);
    all.insert(all.end(), between.pieces.begin(), between.pieces.end());
    if (between.pieces.empty())
      all.push_back({node_of(between.from, between.from.top), node_of(between.to, between.to.top)});
  }
  return all;
}

}  // namespace arcslip::problems
