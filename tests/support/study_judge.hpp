#pragma once

// A preload study held against the dense scan and the map of ridges, in words.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "arcslip/problems/ridges/preload_study.hpp"
#include "dense_history.hpp"

namespace arcslip::testing {

inline dense::Case dense_case(const SystemParameters& s) {
  return {s.model == StructureModel::beams,
          static_cast<int>(s.wave_number),
          static_cast<int>(s.elements),
          s.mass_ratio,
          s.frequency_ratio,
          s.interface_stiffness,
          s.base_damping,
          s.damper_damping,
          s.force,
          s.base_damping_kind == DampingKind::structural,
          s.fixed_damper,
          s.preload_growth};
}

struct StudyRun {
  SystemParameters system;
  problems::PreloadRange range;
};

inline std::string describe(const StudyRun& run) {
  const SystemParameters& s = run.system;
  return fmt::format(
      "{} n={} N={} M*={:.17g} gamma={:.17g} K_FD={:.17g} zeta_B={:.17g}{} zeta_D={:.17g} F={:.17g}{} "
      "P_2={:.17g}; P from {:.17g} to {:.17g}, eta from {:.17g} to {:.17g}",
      to_string(s.model), s.wave_number, s.elements, s.mass_ratio, s.frequency_ratio, s.interface_stiffness,
      s.base_damping, s.base_damping_kind == DampingKind::structural ? " (structural)" : "", s.damper_damping,
      s.force, s.fixed_damper ? " fixed damper" : "", s.preload_growth, run.range.from, run.range.to,
      run.range.eta_low, run.range.eta_high);
}

inline std::string describe(const problems::Peak& p) {
  return fmt::format("{} {} at P = {:.15g}, eta = {:.13g}, Y = {:.13g}, R/S = {:.9g}", to_string(p.site),
                     to_string(p.type), p.preload, p.eta, p.Y, p.R_over_S);
}

inline std::string describe(const dense::LocalPeak& p) {
  return fmt::format("{} peak at eta = {:.13g}, Y = {:.13g}, R/S = {:.9g}, depth {:.3g}", dense::name(p.site),
                     static_cast<double>(p.eta), static_cast<double>(std::exp(p.log_Y)),
                     static_cast<double>(std::exp(p.log_ratio)), static_cast<double>(p.depth));
}

/// Collects what is wrong with one study.
class StudyJudge {
 public:
  using Peak = problems::Peak;
  using Real = dense::Real;

  explicit StudyJudge(const StudyRun& run)
      : StudyJudge(run, problems::study_preload(run.system, run.range)) {}

  StudyJudge(StudyRun run, problems::PreloadStudy study)
      : run_(std::move(run)),
        case_(dense_case(run_.system)),
        window_{run_.range.eta_low, run_.range.eta_high},
        study_(std::move(study)) {
    judge_order();
    judge_tiles();
    judge_exchanges();
    judge_free_base();
  }

  const problems::PreloadStudy& study() const { return study_; }
  const std::vector<std::string>& complaints() const { return complaints_; }

  /// All local peaks at a preload where every branch has a row.
  void judge_at(double preload) {
    const std::vector<dense::LocalPeak> peaks = dense::peaks_at(case_, window_, preload);
    std::vector<Peak> rows;
    for (const problems::PeakBranch& branch : study_.branches) {
      const auto row =
          std::find_if(branch.begin(), branch.end(), [&](const Peak& p) { return p.preload == preload; });
      if (row != branch.end()) rows.push_back(*row);
    }
    for (const dense::LocalPeak& peak : peaks) {
      const auto row = std::find_if(rows.begin(), rows.end(), [&](const Peak& p) { return same(peak, p); });
      if (row != rows.end()) {
        rows.erase(row);
      } else if (peak.depth > shallow) {
        complain("missed at P = {:.15g}: {}", preload, describe(peak));
      }
    }
    for (const Peak& row : rows) {
      if (!is_shallow(row, peaks)) complain("spurious: {}", describe(row));
    }
    judge_height(preload, peaks);
  }

  /// The highest peak at any preload of a row.
  void judge_global(const Peak& row) {
    const dense::LocalPeak top = dense::highest(dense::peaks_at(case_, window_, row.preload));
    // a row is as near to its ridge as the tolerance in P
    if (!(std::abs(std::log(row.Y) - top.log_Y) < tight * std::max(1.0, std::abs(row.sensitivity.preload)))) {
      complain("called the highest: {}; but there is {}", describe(row), describe(top));
    }
  }

  std::vector<Peak> global_rows() const {
    std::vector<Peak> rows;
    for (const problems::PeakBranch& branch : study_.branches) {
      for (const Peak& p : branch) {
        if (p.is_global) rows.push_back(p);
      }
    }
    std::sort(rows.begin(), rows.end(), [](const Peak& a, const Peak& b) { return a.preload < b.preload; });
    return rows;
  }

  /// Births and deaths.
  void judge_changes(const dense::History& history) {
    std::vector<Peak> rows;
    for (const problems::PeakBranch& branch : study_.branches) {
      for (const Peak& p : branch) {
        if (p.type == problems::PeakType::birth || p.type == problems::PeakType::death) rows.push_back(p);
      }
    }
    for (const dense::Change& change : history.changes()) {
      const auto row = std::find_if(rows.begin(), rows.end(), [&](const Peak& p) {
        return (p.type == problems::PeakType::birth) == (change.by > 0) &&
               std::abs(p.preload / change.preload - 1) < 1e-8L && std::abs(p.eta / change.eta - 1) < 1e-4L;
      });
      if (row != rows.end()) {
        rows.erase(row);
      } else {
        complain("number of peaks changes by {} at P = {:.15g}, eta = {:.10g} unseen", change.by,
                 static_cast<double>(change.preload), static_cast<double>(change.eta));
      }
    }
    for (const Peak& row : rows) complain("no such change: {}", describe(row));
  }

  /// Preloads at which a ridge of the map seems to be above the highest row nearby.
  std::vector<double> overtakings(const dense::RidgeMap& map) const;

  /// At one preload with rows, against differences.
  void judge_sensitivities(double preload);
  int sensitivities() const { return sensitivities_; }  ///< how many were judged

 private:
  /// Extrema shallower than this are decided by the last digits of Y.
  static constexpr Real shallow = 1e-9L;
  static constexpr Real tight = 1e-9L;  // of ln Y: tolerance 1e-10 on ln R, and its rounding

  template <class... T>
  void complain(fmt::format_string<T...> text, T&&... values) {
    complaints_.push_back(fmt::format(text, std::forward<T>(values)...));
  }

  static bool same(const dense::LocalPeak& peak, const Peak& row) {
    const bool flat = peak.depth <= shallow;
    const bool on_border = std::abs(peak.log_ratio) <= 1e-9L;  // what the site is, rounding decides
    return std::abs(row.eta / peak.eta - 1) <= (flat ? 1e-3L : 1e-7L) &&
           std::abs(std::log(row.Y) - peak.log_Y) <= tight &&
           (flat || ((on_border || dense::name(peak.site) == to_string(row.site)) &&
                     std::abs(std::log(row.R_over_S) - peak.log_ratio) <= 1e-6L));
  }

  bool is_shallow(const Peak& row, const std::vector<dense::LocalPeak>& peaks) const {
    const Real x = std::log(static_cast<Real>(row.eta));
    const dense::Response response(case_);
    const Real p = std::log(static_cast<Real>(row.preload));
    const Real here = response.solve(x, p, false).log_Y;
    if (std::abs(std::log(row.Y) - here) > tight) return false;
    for (const dense::LocalPeak& peak : peaks) {
      if (std::abs(row.eta / peak.eta - 1) < 1e-3L && same(peak, row)) return false;  // a second time
    }
    // no lower anywhere within reach than right beside it by more than the threshold
    const Real reach = 1e-6L;
    return here > response.solve(x - reach, p, false).log_Y - shallow &&
           here > response.solve(x + reach, p, false).log_Y - shallow &&
           std::abs(response.solve(x, p, false).log_Y_slope) * reach < shallow;
  }

  void judge_height(double preload, const std::vector<dense::LocalPeak>& peaks) {
    const Real top = dense::highest(peaks).log_Y;
    int marked = 0;
    for (const problems::PeakBranch& branch : study_.branches) {
      for (const Peak& p : branch) {
        if (std::abs(p.preload / preload - 1) > 1e-14 || !p.is_global) continue;
        ++marked;
        if (std::abs(std::log(p.Y) - top) > tight) complain("not the highest: {}", describe(p));
      }
    }
    if (marked == 0) complain("none is the highest at P = {:.15g}", preload);
  }

  void judge_order() {
    if (!study_.failure.empty()) complain("failure: {}", study_.failure);
    for (const problems::PeakBranch& branch : study_.branches) {
      for (std::size_t i = 0; i + 1 < branch.size(); ++i) {
        if (branch[i].preload > branch[i + 1].preload) complain("not rising: {}", describe(branch[i]));
      }
      for (const Peak& p : branch) {
        const bool inside = p.preload >= run_.range.from && p.preload <= run_.range.to &&
                            p.eta >= run_.range.eta_low && p.eta <= run_.range.eta_high;
        if (!inside) complain("outside: {}", describe(p));
      }
    }
  }

  /// Rows of the highest peak cover the range of preloads once.
  void judge_tiles() {
    std::vector<std::pair<double, double>> tiles;
    for (const problems::PeakBranch& branch : study_.branches) {
      for (std::size_t i = 0; i + 1 < branch.size(); ++i) {
        if (branch[i].is_global && branch[i + 1].is_global && branch[i].preload < branch[i + 1].preload)
          tiles.emplace_back(branch[i].preload, branch[i + 1].preload);
      }
    }
    std::sort(tiles.begin(), tiles.end());
    double covered = run_.range.from;
    for (const auto& [low, high] : tiles) {
      if (std::abs(low / covered - 1) > 1e-9)
        complain("highest from {:.15g}, known to {:.15g}", low, covered);
      covered = high;
    }
    if (std::abs(covered / run_.range.to - 1) > 1e-9)
      complain("the highest is known to {:.15g} only", covered);
  }

  /// Two of equal height change places at one preload.
  void judge_exchanges() {
    std::vector<Peak> rows;
    for (const Peak& p : global_rows()) {
      if (p.type == problems::PeakType::exchange) rows.push_back(p);
    }
    if (rows.size() % 2 != 0) complain("{} rows of exchanges", rows.size());
    for (std::size_t i = 0; i + 1 < rows.size(); i += 2) {
      if (rows[i].preload != rows[i + 1].preload || std::abs(rows[i].Y / rows[i + 1].Y - 1) > 1e-9 ||
          rows[i].eta == rows[i + 1].eta)
        complain("no exchange: {} and {}", describe(rows[i]), describe(rows[i + 1]));
    }
  }

  void judge_free_base() {
    const dense::LocalPeak free = dense::free_peak(case_, window_);
    if (!(std::abs(std::log(study_.free_Y) - free.log_Y) < tight &&
          std::abs(study_.free_eta / free.eta - 1) < 1e-8L))
      complain("free base: eta = {:.15g}, Y = {:.15g}, but {}", study_.free_eta, study_.free_Y,
               describe(free));
  }

  static Real interpolated(const Peak& a, const Peak& b, Real preload);

  StudyRun run_;
  dense::Case case_;
  dense::Window window_;
  problems::PreloadStudy study_;
  std::vector<std::string> complaints_;
  int sensitivities_ = 0;
};

/// ln Y of the highest peak over ln P as a cubic through values and slopes of neighbouring rows.
inline std::vector<double> StudyJudge::overtakings(const dense::RidgeMap& map) const {
  std::vector<std::pair<Peak, Peak>> spans;
  for (const problems::PeakBranch& branch : study_.branches) {
    for (std::size_t i = 0; i + 1 < branch.size(); ++i) {
      if (branch[i].is_global && branch[i + 1].is_global) spans.emplace_back(branch[i], branch[i + 1]);
    }
  }
  std::vector<double> found;
  for (const dense::RidgePiece& piece : map.pieces()) {
    for (const dense::RidgePoint& point : {piece.a, piece.b}) {
      const Real P = std::exp(point.log_preload);
      const auto span = std::find_if(spans.begin(), spans.end(), [&](const auto& rows) {
        return P >= rows.first.preload && P <= rows.second.preload;
      });
      if (!point.is_peak || span == spans.end()) continue;
      if (point.log_Y > interpolated(span->first, span->second, P) + 1e-5L)
        found.push_back(static_cast<double>(P));
    }
  }
  return found;
}

inline dense::Real StudyJudge::interpolated(const Peak& a, const Peak& b, Real preload) {
  const Real h = std::log(static_cast<Real>(b.preload) / a.preload);
  const Real x = std::log(preload / a.preload) / h;
  const Real rise = std::log(static_cast<Real>(b.Y) / a.Y);
  const Real bow = (a.sensitivity.preload * h - rise) * (1 - x) - (b.sensitivity.preload * h - rise) * x;
  return std::log(static_cast<Real>(a.Y)) + rise * x + x * (1 - x) * bow;
}

/// Each sensitivity of each peak, where the differences agree with those of half the step.
inline void StudyJudge::judge_sensitivities(double preload) {
  using dense::Case;
  const auto judge = [&](const char* what, const Peak& row, const dense::LocalPeak& peak, double value,
                         auto change) {
    for (const Real step : {1e-3L, 1e-4L, 1e-5L, 1e-10L}) {
      const Real once = dense::sensitivity(case_, window_, preload, peak, change, step);
      const Real again = dense::sensitivity(case_, window_, preload, peak, change, step / 2);
      if (std::abs(again - once) > 2e-8L * std::max(1.0L, std::abs(again))) continue;
      ++sensitivities_;
      if (std::abs(again - value) > 1e-7L * std::max(1.0L, std::abs(again)))
        complain("sensitivity to {} is {:.12g}, not {:.12g}: {}", what, static_cast<double>(again), value,
                 describe(row));
      return;
    }
  };
  for (const dense::LocalPeak& peak : dense::peaks_at(case_, window_, preload)) {
    if (peak.depth < 1e-6L) continue;
    for (const problems::PeakBranch& branch : study_.branches) {
      for (const Peak& row : branch) {
        if (row.preload != preload || !same(peak, row)) continue;
        const problems::PeakSensitivity& s = row.sensitivity;
        judge("P", row, peak, s.preload, [](Case&, Real& log_P, Real h) { log_P += h; });
        judge("mu", row, peak, s.friction, [](Case& c, Real& log_P, Real h) {
          log_P += h;
          c.preload_growth *= std::exp(h);
        });
        judge("F", row, peak, s.force, [](Case& c, Real&, Real h) { c.force *= std::exp(h); });
        judge("M*", row, peak, s.mass_ratio, [](Case& c, Real&, Real h) { c.mass_ratio *= std::exp(h); });
        judge("gamma", row, peak, s.frequency_ratio,
              [](Case& c, Real&, Real h) { c.frequency_ratio *= std::exp(h); });
        break;
      }
    }
  }
}

}  // namespace arcslip::testing
