#include "arcslip/continuation/cycles/growth_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "arcslip/continuation/points/fold_problem.hpp"

namespace arcslip::continuation {
namespace {

constexpr double grown = 1.05;

}  // namespace

GrowthWatch::GrowthWatch(const OrbitProblem& orbits, const std::string& parameter, double tolerance,
                         const ExtendedProblem* curve)
    : orbits_(orbits),
      parameter_(parameter),
      nearly_(std::min(1e-8, 0.01 * tolerance)),
      is_curve_(curve != nullptr),
      of_folds_(dynamic_cast<const FoldProblem*>(curve) != nullptr),
      surely_(std::sqrt(tolerance)) {}

/// Whether the multiplier of a fold is no longer 1.
bool GrowthWatch::is_hidden(const BasePoint& at) const {
  if (!of_folds_) return false;
  const ComplexVector logs = orbits_.log_multipliers(at.unknowns, at.parameters, at.regime);
  return logs.size() > 0 && logs.cwiseAbs().minCoeff() > surely_;
}

/// Whether the folds come to lie at two values while their periods grow.
bool GrowthWatch::snakes(const Fold& last, double same) {
  constexpr double apart = 1e3;  // times what is the same: of two values
  std::rotate(folds_.begin(), folds_.end() - 1, folds_.end());
  folds_[0] = last;
  const auto is_as = [&](std::size_t i) {
    return std::abs(folds_[i].value - folds_[i + 2].value) <= same && folds_[i].period > folds_[i + 2].period;
  };
  return is_as(0) && is_as(1) && std::abs(folds_[0].value - folds_[1].value) > apart * same;
}

bool GrowthWatch::goes_on(const BasePoint& at, bool is_fold) {
  constexpr double hardly = 0.01;
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
  snakes_ = is_fold && snakes({value, period}, same);
  if (snakes_) return false;
  if (!(std::abs(value - value_) <= same) || period < period_) {
    value_ = value;
    period_ = period;
    points_ = 0;
  }
  if (!(std::abs(period - crept_) <= hardly * crept_ &&
        std::abs(value - crept_to_) <= 0.1 * hardly * scale(parameter))) {
    crept_ = period;
    crept_to_ = value;
    crept_for_ = 0;
  }
  const bool stands = is_curve_ ? ++crept_for_ >= 2 * many : ++points_ >= many;
  hidden_ = is_hidden(at);
  return (period < grown * period_ && !stands && !hidden_) ||
         orbits_.least_speed(at.unknowns, at.parameters, at.regime) > rest;
}

void GrowthWatch::end(Branch& branch) const {
  branch.checkpoint.reset();
  if (is_curve_ && (hidden_ || last_period_ < grown * period_)) {
    branch.stop = Stop::no_value;
    branch.explanation = fmt::format(
        "the orbits all but rest on their way, where rounding and meshes hide how the curve goes on: the "
        "period is {:.6g} at {} = {:.10g}",
        last_period_, parameter_, value_);
    return;
  }
  branch.stop = Stop::infinite_period;
  const int digits = static_cast<int>(std::ceil(-std::log10(nearly_)));
  if (snakes_) {
    branch.explanation = fmt::format(
        "the period grows without bound, past {:.6g}, as orbits go round another one ever longer on "
        "their way: they turn back at {} = {:.{}g} and {:.{}g}",
        last_period_, parameter_, folds_[1].value, digits, folds_[0].value, digits);
    return;
  }
  branch.explanation = fmt::format(
      "the period grows without bound, past {:.6g}: an orbit that begins and ends on an equilibrium lies at "
      "{} = {:.{}g}",
      last_period_, parameter_, value_, digits);
}

}  // namespace arcslip::continuation
