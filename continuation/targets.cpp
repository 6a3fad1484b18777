#include "arcslip/continuation/targets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace arcslip::continuation {

Targets::Targets(const Problem& problem, Index parameter, const TraceOptions& options) {
  const double low = std::min(options.from, options.to);
  const double high = std::max(options.from, options.to);
  std::vector<Target> targets{{options.to, Target::Kind::end}, {options.from, Target::Kind::bound}};
  for (const double value : options.stop_at) {
    if (!(value >= low && value <= high)) {
      throw std::invalid_argument(fmt::format("stop_at: {} is not between {} and {}", value, low, high));
    }
    targets.push_back({value, Target::Kind::user});
  }
  for (const double value : problem.landmarks(parameter, low, high)) {
    if (value > low && value < high) targets.push_back({value, Target::Kind::landmark});
  }
  // At equal values the more telling kind comes last and wins.
  std::stable_sort(targets.begin(), targets.end(), [](const Target& a, const Target& b) {
    return a.value != b.value ? a.value < b.value : a.kind < b.kind;
  });
  for (const Target& target : targets) {
    if (!targets_.empty() && targets_.back().value == target.value) targets_.pop_back();
    targets_.push_back(target);
  }
}

const Target* Targets::ahead(double here, double direction, double reach, double rounding) const {
  const Target* nearest = nullptr;
  for (const Target& target : targets_) {
    const double distance = direction * (target.value - here);
    if (distance > rounding && distance <= reach &&
        (nearest == nullptr || distance < direction * (nearest->value - here))) {
      nearest = &target;
    }
  }
  return nearest;
}

bool Targets::between(double a, double b, double rounding) const {
  return std::any_of(targets_.begin(), targets_.end(), [&](const Target& target) {
    return (target.value - a) * (target.value - b) < 0 && std::abs(target.value - a) > rounding &&
           std::abs(target.value - b) > rounding;
  });
}

const Target* Targets::at(double value, double tolerance) const {
  const auto found = std::find_if(targets_.begin(), targets_.end(), [&](const Target& target) {
    return std::abs(target.value - value) <= tolerance;
  });
  return found == targets_.end() ? nullptr : &*found;
}

}  // namespace arcslip::continuation
