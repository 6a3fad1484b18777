// Statements 1 to 3: the frequency responses of figures 8 to 10.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "../support/paper_cases.hpp"
#include "statement.hpp"

namespace arcslip::testing {
namespace {

using continuation::BranchPoint;
using continuation::PointType;
using problems::ForcedResponse;

constexpr std::array preloads = {0.1, 1.0, 5.0, 10.0, 50.0};

/// One of the responses of figure 8.
class Response {
 public:
  explicit Response(double preload)
      : problem_(build_system(figure_8(preload))), branch_(trace_over_eta(problem_, preload, 0.5, 120)) {
    if (!branch_.complete()) throw std::runtime_error("figure 8: " + branch_.explanation);
  }

  const std::vector<BranchPoint>& points() const { return branch_.points; }
  double of(const BranchPoint& point, ForcedResponse::Quantity which) const {
    return quantity(problem_, point, which);
  }
  double Y(const BranchPoint& point) const { return of(point, ForcedResponse::Y); }

  std::vector<BranchPoint> peaks() const { return of_type(branch_, PointType::peak); }

  BranchPoint highest() const {
    const auto all = peaks();
    return *std::max_element(all.begin(), all.end(),
                             [&](const auto& a, const auto& b) { return Y(a) < Y(b); });
  }

  /// How far a peak rises above the higher one of the lowest points to its sides, up to the next peaks.
  double rise(const BranchPoint& peak) const {
    double lowest = INFINITY;
    double left = 0;
    bool passed = false;
    for (const BranchPoint& point : points()) {
      const bool is_peak = point.type == PointType::peak;
      if (is_peak && passed) break;
      if (is_peak && eta(point) < eta(peak)) lowest = INFINITY;
      lowest = std::min(lowest, Y(point));
      if (!is_peak || eta(point) != eta(peak)) continue;
      left = lowest;
      lowest = INFINITY;
      passed = true;
    }
    return Y(peak) / std::max(left, lowest) - 1;
  }

  /// Peaks that rise by 1 % at least.
  std::vector<BranchPoint> resonances() const {
    std::vector<BranchPoint> all = peaks();
    std::erase_if(all, [&](const BranchPoint& peak) { return rise(peak) < 0.01; });
    return all;
  }

  double phase_difference(const BranchPoint& point) const {
    return std::abs(
        std::remainder(of(point, ForcedResponse::alpha) - of(point, ForcedResponse::beta), 2 * pi));
  }

  /// Where the interface slips: ranges of eta.
  std::vector<std::pair<double, double>> slip_ranges() const {
    std::vector<std::pair<double, double>> ranges;
    for (std::size_t i = 1; i < points().size(); ++i) {
      const BranchPoint& from = points()[i - 1];  // at a switch, of the regime that is entered
      if (from.regime != ForcedResponse::slip) continue;
      const bool begins = ranges.empty() || ranges.back().second != eta(from);
      if (begins) ranges.emplace_back(eta(from), eta(from));
      ranges.back().second = eta(points()[i]);
    }
    return ranges;
  }

  static double eta(const BranchPoint& point) { return point.parameters(ForcedResponse::eta); }

 private:
  ForcedResponse problem_;
  continuation::Branch branch_;
};

using Ranges = std::vector<std::pair<double, double>>;

bool lie_in(const Ranges& inner, const Ranges& outer) {
  return std::all_of(inner.begin(), inner.end(), [&](const auto& a) {
    return std::any_of(outer.begin(), outer.end(),
                       [&](const auto& b) { return b.first <= a.first && a.second <= b.second; });
  });
}

double width(const Ranges& ranges) {
  double sum = 0;
  for (const auto& [from, to] : ranges) sum += to - from;
  return sum;
}

std::string text_of(const Ranges& ranges) {
  std::vector<std::string> parts;
  for (const auto& [from, to] : ranges) parts.push_back(fmt::format("{:.4g} to {:.4g}", from, to));
  return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace

Statement peaks_and_phases() {
  Statement statement(
      1,
      "P = 0.1: one peak near eta = 4. P = 50: a second one near eta = 95, base and damper out "
      "of phase there, in phase at low frequency.");
  const Response loose(0.1);
  const auto single = loose.resonances();
  statement.require(single.size() == 1, "P = 0.1: peaks", fmt::format("{}", single.size()), "1");
  const double eta = Response::eta(loose.highest());
  statement.require(std::abs(eta - 4) < 0.04, "P = 0.1: eta of the peak", fmt::format("{:.8g}", eta),
                    "4 +- 1 %");

  const Response locked(50);
  const auto pair = locked.resonances();
  statement.require(pair.size() == 2, "P = 50: peaks", fmt::format("{}", pair.size()), "2");
  const BranchPoint& second = pair.back();
  statement.require(std::abs(Response::eta(second) / 95 - 1) < 0.02, "P = 50: eta of the second peak",
                    fmt::format("{:.7g}", Response::eta(second)), "95 +- 2 %");
  const double opposite = locked.phase_difference(second);
  statement.require(opposite > pi - 0.1, "P = 50: phase between base and damper there, rad",
                    fmt::format("{:.4f}", opposite), "> pi - 0.1");
  double most = 0;
  double turn = 0;
  for (std::size_t i = 1; i < locked.points().size(); ++i) {
    const double eta_before = Response::eta(locked.points()[i - 1]);
    const double eta_here = Response::eta(locked.points()[i]);
    const double before = locked.phase_difference(locked.points()[i - 1]) - pi / 2;
    const double here = locked.phase_difference(locked.points()[i]) - pi / 2;
    if (eta_here <= 50) most = std::max(most, here + pi / 2);
    if (before < 0 && here >= 0) turn = eta_before + (eta_here - eta_before) * before / (before - here);
  }
  statement.require(most < 0.1, "P = 50: the same for eta <= 50, at most", fmt::format("{:.4f}", most),
                    "< 0.1");

  for (const BranchPoint& peak : loose.peaks()) {
    if (loose.rise(peak) < 0.01) {
      statement.note(
          fmt::format("At P = 0.1 a hump at eta = {:.4f}, where slip sets in, rises by {:.1e} and is "
                      "no resonance.",
                      Response::eta(peak), loose.rise(peak)));
    }
  }
  statement.note(
      fmt::format("The phase turns by pi at eta = {:.3f}, in stick, where the base stands nearly still; "
                  "slip at the peaks changes it by less than {:.3f}.",
                  turn, most));
  return statement;
}

Statement best_of_five_preloads() {
  Statement statement(2, "Among the preloads of figure 8, P = 1 lowers the peak most.");
  std::vector<double> highest;
  for (const double preload : preloads) {
    const Response response(preload);
    highest.push_back(response.Y(response.highest()));
  }
  const auto lowest = std::min_element(highest.begin(), highest.end()) - highest.begin();
  for (std::size_t i = 0; i < preloads.size(); ++i) {
    statement.require(preloads[i] == 1 || highest[i] > highest[1],
                      fmt::format("P = {:g}: highest peak", preloads[i]), fmt::format("{:.6g}", highest[i]),
                      preloads[i] == 1 ? "" : fmt::format("> {:.6g}", highest[1]));
  }
  statement.require(preloads.at(static_cast<std::size_t>(lowest)) == 1, "the preload with the lowest",
                    fmt::format("{:g}", preloads.at(static_cast<std::size_t>(lowest))), "1");
  return statement;
}

Statement stick_and_slip() {
  Statement statement(
      3,
      "At eta = n = 1, R/S < 1 for every P of figure 8. As P grows the slipping ranges shrink to "
      "the two peaks.");
  Ranges before = {{0, INFINITY}};
  for (const double preload : preloads) {
    const Response response(preload);
    const ForcedResponse problem(build_system(figure_8(preload)));
    const continuation::Guess at_one = problem.guess(1, preload);
    const double ratio = std::exp(at_one.unknowns(0)) / problem.system().slip_threshold(1, preload);
    statement.require(ratio < 1, fmt::format("P = {:g}: R/S at eta = 1", preload),
                      fmt::format("{:.2e}", ratio), "< 1");

    const Ranges ranges = response.slip_ranges();
    statement.require(lie_in(ranges, before) && width(ranges) < width(before),
                      fmt::format("P = {:g}: slip at eta = {}", preload, text_of(ranges)),
                      fmt::format("width {:.4f}", width(ranges)), "within the one before");
    before = ranges;
  }
  const auto peaks = Response(preloads.back()).resonances();
  const bool holds_peaks =
      before.size() == 2 && peaks.size() == 2 && before[0].first < Response::eta(peaks[0]) &&
      Response::eta(peaks[0]) < before[0].second && before[1].first < Response::eta(peaks[1]) &&
      Response::eta(peaks[1]) < before[1].second;
  statement.require(holds_peaks, "P = 50: slipping ranges, each about a peak",
                    fmt::format("{}", before.size()), "2");
  return statement;
}

}  // namespace arcslip::testing
