#include "arcslip/problems/ridges/free_response.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "arcslip/problems/response/cubic_response.hpp"
#include "arcslip/problems/response/forced_response.hpp"
#include "arcslip/problems/ridges/peak_search.hpp"

namespace arcslip::problems {
namespace {

using continuation::Branch;
using continuation::BranchPoint;
using continuation::Gradient;
using continuation::PointType;

/// The highest point of a response over eta.
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

}  // namespace

bool FreeResponse::evaluate(const Vector& u, const Vector& p, const continuation::Regime& /*regime*/,
                            const continuation::Evaluation& out) const {
  if (!(p(0) > 0)) return false;
  const ContactReceptance at = base_.at(p(0));
  const double square = std::norm(at.free(0));
  if (!(square > 0)) return false;
  if (out.residual != nullptr) (*out.residual)(0) = u(0) - 0.5 * std::log(square);
  if (out.jacobian != nullptr) (*out.jacobian)(0, 0) = 1;
  if (out.parameter_jacobian != nullptr)
    (*out.parameter_jacobian)(0, 0) = -std::real(at.free_eta(0) * std::conj(at.free(0))) / square;
  return true;
}

void FreeResponse::scale(const Vector& /*u*/, const Vector& p, Vector& unknowns, Vector& parameters) const {
  unknowns.setOnes();
  parameters = p;
}

void FreeResponse::observe(const Vector& u, const Vector& /*p*/, const continuation::Regime& /*regime*/,
                           Vector& values) const {
  values.setConstant(1, std::exp(u(0)));
}

double FreeResponse::observe(const Vector& u, const Vector& /*p*/, const continuation::Regime& /*regime*/,
                             Index /*which*/, Gradient& gradient) const {
  gradient.parameters.setZero();
  gradient.unknowns(0) = std::exp(u(0));
  return std::exp(u(0));
}

std::vector<double> FreeResponse::landmarks(Index /*parameter*/, double from, double to) const {
  std::vector<double> values;
  for (const ContactMode& mode : base_.modes()) {
    if (mode.frequency > from && mode.frequency < to) values.push_back(mode.frequency);
  }
  return values;
}

continuation::Guess FreeResponse::guess(double eta) const {
  return {Vector::Constant(1, std::log(std::abs(base_.at(eta).free(0)))), Vector::Constant(1, eta), 0, {}};
}

Peak free_peak(const ContactModes& base, const PreloadRange& range,
               const continuation::TraceOptions& options) {
  const FreeResponse problem(base);
  return highest_peak(problem, problem.guess(range.eta_low), range, options);
}

Peak free_peak(FrictionSystem system, const PreloadRange& range, const continuation::TraceOptions& options) {
  system.contact_stiffness = 0;
  if (system.cubic_stiffness != 0) {
    const CubicResponse problem(std::move(system));
    return highest_peak(problem, problem.guess(range.eta_low, out_of_reach), range, options);
  }
  const ForcedResponse problem(std::move(system));
  return highest_peak(problem, problem.guess(range.eta_low, out_of_reach), range, options);
}

/// By the secant method: the peak is about inverse to the damping.
double equivalent_damping(const FrictionSystem& system, double zeta, const PreloadRange& range,
                          const Peak& free, double Y, const continuation::TraceOptions& options) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  if (free.site == PeakSite::edge) return none;
  FrictionSystem damped = system;
  const auto excess = [&](double log_zeta) {
    if (!(log_zeta < 0)) return none;
    damped.base = system.base.damped(system.base_loss_fixed + std::exp(log_zeta) * system.base_loss_per_zeta);
    const Peak peak = free_peak(damped, range, options);
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
