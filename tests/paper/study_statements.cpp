// Statements 4 and 5: the highest peak over the preload, figures 11 and 12.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "../support/paper_cases.hpp"
#include "arcslip/problems/ridges/preload_study.hpp"
#include "statement.hpp"

namespace arcslip::testing {
namespace {

using problems::Peak;

/// The highest peak over the preload, over that of the base alone.
class Envelope {
 public:
  Envelope(const SystemParameters& system, const problems::PreloadRange& range)
      : study_(problems::study_preload(system, range)) {
    if (!study_.failure.empty()) throw std::runtime_error("preload study: " + study_.failure);
    for (const problems::PeakBranch& branch : study_.branches) {
      std::copy_if(branch.begin(), branch.end(), std::back_inserter(peaks_),
                   [](const Peak& peak) { return peak.is_global; });
    }
    std::sort(peaks_.begin(), peaks_.end(),
              [](const Peak& a, const Peak& b) { return a.preload < b.preload; });
  }

  const std::vector<Peak>& peaks() const { return peaks_; }
  double ratio(const Peak& peak) const { return peak.Y / study_.free_Y; }
  /// The least and the largest one.
  std::pair<double, double> ratios() const {
    const auto [low, high] = std::minmax_element(peaks_.begin(), peaks_.end(),
                                                 [](const Peak& a, const Peak& b) { return a.Y < b.Y; });
    return {ratio(*low), ratio(*high)};
  }

  const problems::Optimum& optimum() const { return study_.optimum.value(); }

  /// At a preload of `stop_at`.
  const Peak& at(double preload) const {
    return *std::find_if(peaks_.begin(), peaks_.end(),
                         [&](const Peak& peak) { return peak.preload == preload; });
  }

  /// The preloads between which the ratio lies below a value, linearly interpolated in the logarithms.
  std::pair<double, double> below(double value) const {
    std::pair<double, double> range{0, 0};
    for (std::size_t i = 1; i < peaks_.size(); ++i) {
      const double from = std::log(ratio(peaks_[i - 1]) / value);
      const double to = std::log(ratio(peaks_[i]) / value);
      if ((from < 0) == (to < 0)) continue;
      const double part = from / (from - to);
      const double preload =
          peaks_[i - 1].preload * std::pow(peaks_[i].preload / peaks_[i - 1].preload, part);
      (from > 0 ? range.first : range.second) = preload;
    }
    if (range.first == 0 || range.second == 0)
      throw std::runtime_error("the ratio stays low to an end of the range");
    return range;
  }

 private:
  problems::PreloadStudy study_;
  std::vector<Peak> peaks_;
};

SystemParameters beams(double mass_ratio, double frequency_ratio, double slenderness) {
  SystemParameters parameters = figure_8(1);
  parameters.mass_ratio = mass_ratio;
  parameters.frequency_ratio = frequency_ratio;
  parameters.interface_stiffness = shear_interface_stiffness(slenderness, 0.3);
  return parameters;
}

}  // namespace

Statement mass_ratio_and_preload() {
  Statement statement(
      4,
      "M* = 100, P > 45: the peak no longer depends on P. A smaller M* lowers the peak over a "
      "wider range of P.");
  // Wider than the figure's range, so that the peaks of all M* are half as high at two preloads.
  const problems::PreloadRange range{
      .from = 0.1, .to = 1000, .eta_low = 0.5, .eta_high = 6, .stop_at = {45, 100}};
  const Envelope heavy(beams(100, 4, 33.3), range);
  double least = INFINITY;
  double most = 0;
  double stuck = 0;
  for (const Peak& peak : heavy.peaks()) {
    if (peak.preload < 45) continue;
    least = std::min(least, peak.Y);
    most = std::max(most, peak.Y);
    if (stuck == 0 && peak.R_over_S <= 1 + 1e-9) stuck = peak.preload;
  }
  statement.require(most / least - 1 < 0.01, "M* = 100, P = 45 to 1000: change of the peak",
                    fmt::format("{:.2e}", most / least - 1), "< 1 %");
  const double constant = heavy.peaks().back().Y;
  double change = 0;
  for (const Peak& peak : heavy.peaks()) {
    if (stuck > 0 && peak.preload >= stuck) change = std::max(change, std::abs(peak.Y / constant - 1));
  }
  statement.require(stuck > 0 && change < 1e-8,
                    fmt::format("the same from P = {:.4f}, where the peak sticks", stuck),
                    fmt::format("{:.1e}", change), "< 1e-8");
  double wider = 0;
  for (const double mass_ratio : {100.0, 50.0, 20.0, 10.0, 5.0}) {
    const Envelope envelope(beams(mass_ratio, 4, 33.3), range);
    const auto [low, high] = envelope.below(0.5);
    const double decades = std::log10(high / low);
    statement.require(
        decades > wider,
        fmt::format("M* = {:g}: halved or better from P = {:.3g} to {:.4g}", mass_ratio, low, high),
        fmt::format("{:.3f} decades", decades), wider > 0 ? fmt::format("> {:.3f}", wider) : "");
    wider = decades;
  }
  const Peak& at_45 = heavy.at(45);
  statement.note(fmt::format(
      "At P = 45 the peak of M* = 100 still slips, R/S = {:.3f}, with the ratio {:.5f}. It does not "
      "depend on P at all from P = {:.3f} on, with the ratio {:.5f}.",
      at_45.R_over_S, heavy.ratio(at_45), stuck, heavy.ratio(heavy.peaks().back())));
  return statement;
}

Statement separated_frequencies() {
  Statement statement(
      5,
      "gamma = 1: least effective and insensitive to P. The better separated gamma is from 1, the "
      "more effective.");
  const problems::PreloadRange range{.from = 0.1, .to = 100, .eta_low = 0.5, .eta_high = 6, .stop_at = {}};
  const Envelope same(beams(10, 1, 8.3), range);
  const auto [least, most] = same.ratios();
  statement.require(most / least - 1 < 1e-3, "gamma = 1, P = 0.1 to 100: change of the peak",
                    fmt::format("{:.1e}", most / least - 1), "< 1e-3");
  const double joined = 10.0 / 11;
  statement.require(std::abs(least / joined - 1) < 1e-3, "gamma = 1: ratio", fmt::format("{:.6f}", least),
                    fmt::format("M*/(M* + 1) = {:.6f} +- 0.1 %", joined));
  struct Design {
    double frequency_ratio, slenderness;
  };
  double before = least;
  for (const auto& [gamma, slenderness] : {Design{1.5, 12.5}, Design{2, 16.7}, Design{4, 33.3}}) {
    const Envelope envelope(beams(10, gamma, slenderness), range);
    const double highest = envelope.ratios().second;
    statement.require(highest < least, fmt::format("gamma = {:g}, P = 0.1 to 100: highest ratio", gamma),
                      fmt::format("{:.5f}", highest), fmt::format("< {:.5f}", least));
    const problems::Optimum& optimum = envelope.optimum();
    const double best = envelope.ratio(optimum.peak);
    statement.require(best < before,
                      fmt::format("gamma = {:g}: lowest ratio, at P = {:.4g}", gamma, optimum.peak.preload),
                      fmt::format("{:.5f}", best), fmt::format("< {:.5f}", before));
    before = best;
  }
  statement.note(
      fmt::format("At gamma = 1 the peak sticks at every preload of the figure, R/S = {:.3f} at P = 0.1: "
                  "base and damper move as "
                  "one of the mass M* + 1.",
                  same.peaks().front().R_over_S));
  return statement;
}

}  // namespace arcslip::testing
