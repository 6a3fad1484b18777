#pragma once

// Slopes over eta sampled densely enough to tell what they do between the samples, and their zeros.

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "arcslip/problems/response/contact_problem.hpp"
#include "arcslip/zero_between.hpp"

namespace arcslip::problems {

/// The ends and those of the places that lie between them, ascending.
inline std::vector<double> between(std::vector<double> places, double low, double high) {
  std::erase_if(places, [&](double place) { return !(place > low && place < high); });
  places.insert(places.end(), {low, high});
  std::sort(places.begin(), places.end());
  return places;
}

/// `at(eta)` gives `count` logarithms and their derivatives by eta, with nan for a logarithm that is not
/// known.
template <std::size_t count, class At>
class SlopeScan {
 public:
  struct Sample {
    double eta;
    std::array<ValueAndSlope, count> logs;
  };

  /// A zero of a slope.
  struct Zero {
    double eta;
    bool falls;  ///< from plus to minus
  };

  /// From places with eta rising, between which more are taken.
  SlopeScan(const std::vector<double>& etas, At at) : at_(std::move(at)) {
    for (const double eta : etas) {
      const Sample next{eta, at_(eta)};
      if (!samples_.empty()) refine(Sample(samples_.back()), next, 0);
      samples_.push_back(next);
    }
  }

  const std::vector<Sample>& samples() const { return samples_; }

  /// That of the slope k between the sample i and the next, if there is one.
  std::optional<Zero> zero_behind(std::size_t i, std::size_t k) const {
    if (i + 1 == samples_.size()) return std::nullopt;
    const Sample& a = samples_[i];
    const Sample& b = samples_[i + 1];
    const bool falls = a.logs[k].slope > 0;
    if (falls == (b.logs[k].slope > 0)) return std::nullopt;
    const auto slope = [&](double eta) { return at_(eta)[k].slope; };
    return Zero{zero_between(slope, a.eta, b.eta, a.logs[k].slope, b.logs[k].slope, 52), falls};
  }

 private:
  /// A resonance's slope from minus to plus infinity by its decades, those below 1 as they are.
  static double bounded(const Sample& at, std::size_t k) { return std::asinh(at.eta * at.logs[k].slope); }

  /// Whether the parabola through values of one sign at both ends and the middle of an interval comes so near
  /// to zero in it that there may be two zeros.
  static bool may_turn_at_zero(double a, double m, double b) {
    const double sign = m > 0 ? 1 : -1;
    const double bend = sign * (a - 2 * m + b);
    const double fall = sign * (3 * a - 4 * m + b);
    const bool turns = fall > 0 && fall < 4 * bend && sign * a > 0 && sign * b > 0;
    return turns && sign * a - 0.125 * fall * fall / bend < 2 * bend;
  }

  /// Whether the middle of an interval is what the ends tell of it.
  static bool is_told(const Sample& from, const Sample& middle, const Sample& to) {
    constexpr double slope_close = 0.1;
    constexpr double value_close = 0.01;
    const double length = to.eta - from.eta;
    for (std::size_t k = 0; k < count; ++k) {
      const double a = bounded(from, k);
      const double b = bounded(to, k);
      const double m = bounded(middle, k);
      if (std::abs(m - 0.5 * (a + b)) > slope_close || may_turn_at_zero(a, m, b)) return false;
      const ValueAndSlope& first = from.logs[k];
      const ValueAndSlope& last = to.logs[k];
      const double value = 0.5 * (first.value + last.value) + 0.125 * length * (first.slope - last.slope);
      if (std::abs(middle.logs[k].value - value) > value_close) return false;
    }
    return true;
  }

  void refine(const Sample& from, const Sample& to, int depth) {
    constexpr int deepest = 20;
    const double eta = 0.5 * (from.eta + to.eta);
    if (!(eta > from.eta && eta < to.eta)) return;
    const Sample middle{eta, at_(eta)};
    const bool split = depth < deepest && !is_told(from, middle, to);
    if (split) refine(from, middle, depth + 1);
    samples_.push_back(middle);
    if (split) refine(middle, to, depth + 1);
  }

  At at_;
  std::vector<Sample> samples_;
};

}  // namespace arcslip::problems
