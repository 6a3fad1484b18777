#include "arcslip/continuation/cycles/growth_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace arcslip::continuation {

GrowthWatch::GrowthWatch(const OrbitProblem& orbits, const std::string& parameter, double tolerance)
    : orbits_(orbits), parameter_(parameter), nearly_(std::min(1e-8, 0.01 * tolerance)) {}

bool GrowthWatch::goes_on(const BasePoint& at) {
  constexpr double grown = 1.05;
  constexpr int many = 30;       // points: where rounding hides how an orbit goes on
  constexpr double rest = 1e-2;  // of the mean speed: that from an equilibrium falls with e^(-T/2) at least
  if (!orbits_.has_duration()) return true;
  const Index parameter = index_of(orbits_.parameter_names(), parameter_);
  Vector unknowns(orbits_.size());
  Vector scale(at.parameters.size());
  orbits_.scale(at.unknowns, at.parameters, unknowns, scale);
  const double value = at.parameters(parameter);
  const double period = orbits_.duration(at.unknowns, at.parameters);
  const double same = nearly_ * scale(parameter);
  last_period_ = period;
  if (!(std::abs(value - value_) <= same) || period < period_) {
    value_ = value;
    period_ = period;
    points_ = 0;
  }
  return (period < grown * period_ && ++points_ < many) ||
         orbits_.least_speed(at.unknowns, at.parameters, at.regime) > rest;
}

void GrowthWatch::end(Branch& branch) const {
  branch.stop = Stop::infinite_period;
  branch.explanation = fmt::format(
      "the period grows without bound, past {:.6g}: an orbit that begins and ends on an equilibrium lies at "
      "{} = "
      "{:.{}g}",
      last_period_, parameter_, value_, static_cast<int>(std::ceil(-std::log10(nearly_))));
  branch.checkpoint.reset();
}

}  // namespace arcslip::continuation
