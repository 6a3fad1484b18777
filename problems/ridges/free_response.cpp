#include "arcslip/problems/ridges/free_response.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "arcslip/problems/response/cubic_response.hpp"
#include "arcslip/problems/ridges/peak_search.hpp"
#include "arcslip/problems/ridges/slope_scan.hpp"

namespace arcslip::problems {
namespace {

using continuation::Branch;
using continuation::BranchPoint;
using continuation::Gradient;
using continuation::PointType;

/// The highest point of a response over eta that is traced.
Peak highest_peak(const continuation::Problem& problem, const continuation::Guess& start,
                  const PreloadRange& range, const continuation::TraceOptions& options) {
  continuation::TraceOptions over_eta = options;
  over_eta.parameter = "eta";
  over_eta.from = range.eta_low;
  over_eta.to = range.eta_high;
  over_eta.stop_at.clear();
  over_eta.extrema_of = {"Y"};
  const Branch branch = trace(problem, start, over_eta);
  if (!branch.complete())
    throw std::runtime_error("the response without damper could not be traced: " + branch.explanation);
  const Index eta = continuation::index_of(problem.parameter_names(), "eta");
  const Index Y = continuation::index_of(continuation::observable_names(problem), "Y");
  Gradient gradient{Vector::Zero(problem.size()),
                    Vector::Zero(static_cast<Index>(problem.parameter_names().size()))};
  Peak highest;
  for (const BranchPoint& point : branch.points) {
    if (point.type == PointType::regular) continue;
    const double height = problem.observe(point.unknowns, point.parameters, point.regime, Y, gradient);
    if (!(height > highest.Y)) continue;
    highest.Y = height;
    highest.eta = point.parameters(eta);
    highest.site = point.type == PointType::peak ? PeakSite::stick : PeakSite::edge;
  }
  return highest;
}

/// y_0 with its derivative in eta.
struct FreeMotion {
  Complex value;
  Complex by_eta;
};

/// The highest |y_0(eta)|, sought from what may be its resonances on.
template <class MotionAt>
Peak highest_free_peak(const MotionAt& motion_at, std::vector<double> resonances, const PreloadRange& range) {
  Peak highest;
  const auto compare = [&](double eta, PeakSite site) {
    const double height = std::abs(motion_at(eta).value);
    if (!(height > highest.Y)) return;
    highest.Y = height;
    highest.eta = eta;
    highest.site = site;
  };
  compare(range.eta_low, PeakSite::edge);
  compare(range.eta_high, PeakSite::edge);
  const auto log_at = [&](double eta) {
    const FreeMotion at = motion_at(eta);
    return std::array<ValueAndSlope, 1>{{{std::log(std::abs(at.value)), std::real(at.by_eta / at.value)}}};
  };
  const SlopeScan<1, decltype(log_at)> scan(between(std::move(resonances), range.eta_low, range.eta_high),
                                            log_at);
  for (std::size_t i = 0; i < scan.samples().size(); ++i) {
    const auto zero = scan.zero_behind(i, 0);
    if (zero && zero->falls) compare(zero->eta, PeakSite::stick);
  }
  if (!(highest.Y > 0)) throw std::runtime_error("the load does not move the base without damper");
  return highest;
}

template <class Modes>
std::vector<double> frequencies_of(const Modes& modes) {
  std::vector<double> values;
  for (const auto& mode : modes) values.push_back(mode.frequency);
  return values;
}

}  // namespace

Peak free_peak(const ContactModes& base, const PreloadRange& range) {
  const auto motion_at = [&](double eta) {
    const ContactReceptance at = base.at(eta);
    return FreeMotion{at.free(0), at.free_eta(0)};
  };
  return highest_free_peak(motion_at, frequencies_of(base.modes()), range);
}

Peak free_peak(const ModalModel& base, const PreloadRange& range) {
  const auto motion_at = [&](double eta) {
    const ContactResponse at = base.at(eta);
    return FreeMotion{at.free, at.free_eta};
  };
  return highest_free_peak(motion_at, frequencies_of(base.modes()), range);
}

Peak free_peak(FrictionSystem system, const PreloadRange& range, const continuation::TraceOptions& options) {
  if (system.cubic_stiffness == 0) return free_peak(system.base, range);
  system.contact_stiffness = 0;
  const CubicResponse problem(std::move(system));
  return highest_peak(problem, problem.guess(range.eta_low, out_of_reach), range, options);
}

/// By the secant method: the peak is about inverse to the damping.
double equivalent_damping(const FrictionSystem& system, double zeta, const PreloadRange& range,
                          const Peak& free, double Y) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  if (free.site == PeakSite::edge) return none;
  const auto excess = [&](double log_zeta) {
    if (!(log_zeta < 0)) return none;
    const Loss loss = system.base_loss_fixed + std::exp(log_zeta) * system.base_loss_per_zeta;
    const Peak peak = free_peak(system.base.damped(loss), range);
    return peak.site == PeakSite::edge ? none : std::log(peak.Y / Y);
  };
  double last = std::log(zeta);
  double last_excess = std::log(free.Y / Y);
  double log_zeta = last + last_excess;
  constexpr double rounding = 1e-11;
  for (int i = 0; i < 30 && std::abs(last_excess) > rounding; ++i) {
    const double value = excess(log_zeta);
    if (!std::isfinite(value)) return none;
    const double next =
        std::abs(value) > rounding ? log_zeta - value * (log_zeta - last) / (value - last_excess) : log_zeta;
    last = log_zeta;
    last_excess = value;
    log_zeta = next;
  }
  return std::abs(last_excess) <= rounding ? std::exp(last) : none;
}

}  // namespace arcslip::problems
