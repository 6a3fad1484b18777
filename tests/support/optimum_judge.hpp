#pragma once

// The optimum of a preload study against the dense scan, in words.

#include "study_judge.hpp"

namespace arcslip::testing {

inline const std::vector<std::string> no_complaints;

class OptimumJudge {
 public:
  using Real = dense::Real;
  using Optimum = problems::Optimum;

  /// Beside the optimum and at these preloads.
  OptimumJudge(const StudyRun& run, const problems::PreloadStudy& study, const std::vector<double>& preloads)
      : run_(run), case_(dense_case(run.system)), window_{run.range.eta_low, run.range.eta_high} {
    if (!study.optimum) {
      complaints_.emplace_back("no optimum");
      return;
    }
    optimum_ = *study.optimum;
    best_ = optimum_.peak.preload;
    lowest_ = std::log(static_cast<Real>(optimum_.peak.Y));
    if (!(std::abs(top(best_).log_Y - lowest_) < tight)) complain("it is not the highest there");
    for (const double p : preloads) judge_at(p);
    for (const Real distance : {1e-1L, 1e-2L, 1e-3L, 1e-4L}) {
      judge_at(best_ * (1 - distance));
      judge_at(best_ * (1 + distance));
    }
    judge_end_of_range(optimum_.low, run.range.from, -1);
    judge_end_of_range(optimum_.high, run.range.to, 1);
    judge_kind();
    judge_equivalents();
  }

  const std::vector<std::string>& complaints() const { return complaints_; }

 private:
  static constexpr Real tight = 1e-9L;

  void complain(const std::string& text) {
    complaints_.push_back(
        fmt::format("optimum ({}) {}: {}", to_string(optimum_.kind), describe(optimum_.peak), text));
  }

  dense::LocalPeak top(Real preload) const {
    return dense::highest(dense::peaks_at(case_, window_, preload));
  }

  bool in_range(Real p) const { return p >= run_.range.from && p <= run_.range.to; }

  void judge_at(Real p) {
    if (!in_range(p)) return;
    const Real here = top(p).log_Y;
    if (here < lowest_ - tight)
      complain(fmt::format("Y_max is {:.13g} at P = {:.15g}", static_cast<double>(std::exp(here)),
                           static_cast<double>(p)));
    if (p > optimum_.low && p < optimum_.high && here > lowest_ + std::log(2.0L) + tight)
      complain(fmt::format("Y_max is above 2 Y_opt at P = {:.15g}", static_cast<double>(p)));
  }

  void judge_end_of_range(Real p, Real end, Real outward) {
    const Real excess = top(p).log_Y - lowest_ - std::log(2.0L);
    const bool right = p == end ? excess <= tight
                                : std::abs(excess) < 1e-8L &&
                                      top(p * (1 + outward * 1e-5L)).log_Y - lowest_ - std::log(2.0L) > 0;
    if (!right) complain(fmt::format("{:.15g} does not bound the range of 2 Y_opt", static_cast<double>(p)));
  }

  /// d ln Y/d ln P at fixed eta, which is that of a peak but on a corner.
  Real slope(const dense::LocalPeak& peak, Real preload) const {
    return dense::Response(case_).solve(std::log(peak.eta), std::log(preload), true).log_Y_slope;
  }

  /// At a minimum within the range, right before and right after it.
  void judge_kind() {
    using problems::OptimumKind;
    if (optimum_.kind == OptimumKind::end) {
      if (best_ != run_.range.from && best_ != run_.range.to) complain("it is not at an end");
      return;
    }
    if (optimum_.kind == OptimumKind::flat) return judge_middle();
    const Real near = 1e-8L;
    const dense::LocalPeak before = top(best_ * (1 - near));
    const dense::LocalPeak after = top(best_ * (1 + near));
    const bool jumps = std::abs(before.eta / after.eta - 1) > 1e-7L;
    if (jumps != (optimum_.kind == OptimumKind::exchange)) complain("another kind");
    if (jumps) judge_exchange(before, after);
    if (optimum_.kind == OptimumKind::corner) {
      if (top(best_ * (1 - 1e-6L)).log_Y <= lowest_ || top(best_ * (1 + 1e-6L)).log_Y <= lowest_)
        complain("Y_max does not rise to both sides");
      return;
    }
    const auto jump = [&](Real distance) {
      return std::pair(slope(top(best_ * (1 - distance)), best_ * (1 - distance)),
                       slope(top(best_ * (1 + distance)), best_ * (1 + distance)));
    };
    const auto [fall, rise] = jump(near);
    if (std::max(std::abs(fall), std::abs(rise)) < 1e-13L) return;  // as flat as double precision can tell
    if (!(fall < 0 && rise > 0))
      complain(fmt::format("slopes {:.3g} and {:.3g} beside it", static_cast<double>(fall),
                           static_cast<double>(rise)));
    const auto [closer_fall, closer_rise] = jump(near / 10);
    if (optimum_.kind == OptimumKind::smooth && closer_rise - closer_fall > 0.3L * (rise - fall))
      complain("there is a kink");
  }

  void judge_exchange(const dense::LocalPeak& before, const dense::LocalPeak& after) {
    if (!optimum_.other) return complain("without the other peak");
    if (std::abs(optimum_.other->Y / optimum_.peak.Y - 1) > 1e-9) complain("heights differ");
    if (std::abs(before.eta / optimum_.peak.eta - 1) > 1e-6L) complain("another peak before");
    if (std::abs(after.eta / optimum_.other->eta - 1) > 1e-6L) complain("another peak after");
  }

  /// Of the preloads to either side up to which Y_max stays.
  void judge_middle() {
    const Real level = top(best_).log_Y;
    if (top(best_).log_ratio > 0) return;  // it slips, and is flat in double precision only
    const auto border = [&](Real out) {
      if (std::abs(top(out).log_Y - level) < 1e-16L) return out;
      Real in = best_;
      for (int i = 0; i < 60; ++i) {
        const Real middle = std::sqrt(in * out);
        (std::abs(top(middle).log_Y - level) < 1e-16L ? in : out) = middle;
      }
      return in;
    };
    const Real middle = std::sqrt(border(run_.range.from) * border(run_.range.to));
    if (std::abs(best_ / middle - 1) > 1e-6L)
      complain(fmt::format("the middle is {:.12g}", static_cast<double>(middle)));
  }

  void judge_equivalents() {
    const Real S = best_ * case_.stiffness_ratio() / case_.interface_stiffness +
                   case_.preload_growth * optimum_.peak.eta * optimum_.peak.eta * case_.stiffness_ratio() /
                       case_.interface_stiffness;
    const Real energy = 4 * case_.interface_stiffness * S * S * std::max(0.0L, optimum_.peak.R_over_S - 1.0L);
    if (std::abs(optimum_.energy - energy) > 1e-12L * energy + 1e-15L * energy / (optimum_.peak.R_over_S - 1))
      complain(fmt::format("energy {:.15g}", optimum_.energy));
    judge_damping();
  }

  /// zeta_B between the system's own and 1 at which the base alone has this peak, within the window.
  void judge_damping() {
    const auto free = [&](Real log_zeta) {
      dense::Case alone = case_;
      alone.base_damping = std::exp(log_zeta);
      return dense::free_peak(alone, window_);
    };
    Real low = std::log(case_.base_damping);
    Real high = 0;
    if (free(low).log_Y < lowest_ || free(high).log_Y > lowest_) return;
    for (int i = 0; i < 50; ++i) {
      const Real middle = (low + high) / 2;
      (free(middle).log_Y > lowest_ ? low : high) = middle;
    }
    const Real eta = free(low).eta;
    if (eta < window_.low * (1 + 1e-12L) || eta > window_.high * (1 - 1e-12L)) return;
    if (!(std::abs(std::log(optimum_.damping) - low) < 1e-8L))
      complain(fmt::format("equivalent damping {:.12g}, not {:.12g}", static_cast<double>(std::exp(low)),
                           optimum_.damping));
  }

  StudyRun run_;
  dense::Case case_;
  dense::Window window_;
  Optimum optimum_;
  Real best_ = 0;
  Real lowest_ = 0;
  std::vector<std::string> complaints_;
};

}  // namespace arcslip::testing
