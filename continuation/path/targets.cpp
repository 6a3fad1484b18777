#include "arcslip/continuation/path/targets.hpp"

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
      throw std::invalid_argument(
          fmt::format("stop_at: {} = {} is not between {} and {}", options.parameter, value, low, high));
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

bool Targets::wants_point(const Target& target) {
  return target.kind == Target::Kind::user || target.kind == Target::Kind::end;
}

bool Targets::is_taken(const Target& target) const {
  return std::find(taken_.begin(), taken_.end(), &target) != taken_.end();
}

void Targets::keep_taken(double value, double tolerance) {
  std::erase_if(taken_,
                [&](const Target* target) { return !(std::abs(target->value - value) <= tolerance); });
}

std::vector<double> Targets::taken() const {
  std::vector<double> values;
  for (const Target* target : taken_) values.push_back(target->value);
  return values;
}

void Targets::restore(const std::vector<double>& taken) {
  for (const Target& target : targets_) {
    if (std::find(taken.begin(), taken.end(), target.value) != taken.end()) take(target);
  }
}

const Target* Targets::ahead(double here, double direction, double reach, double rounding) const {
  const Target* nearest = nullptr;
  for (const Target& target : targets_) {
    const double distance = direction * (target.value - here);
    const double least = wants_point(target) ? 0 : rounding;
    if (distance > least && distance <= reach &&
        (nearest == nullptr || distance < direction * (nearest->value - here)) && !is_taken(target)) {
      nearest = &target;
    }
  }
  return nearest;
}

bool Targets::between(double a, double b, double tolerance, double rough) const {
  return std::any_of(targets_.begin(), targets_.end(), [&](const Target& target) {
    const double from_a = std::abs(target.value - a);
    const double from_b = std::abs(target.value - b);
    return (target.value - a) * (target.value - b) < 0 && from_b > tolerance &&
           (wants_point(target) || (from_a > rough && from_b > rough)) && !is_taken(target);
  });
}

std::vector<const Target*> Targets::around(double value, double tolerance) const {
  std::vector<const Target*> found;
  for (const Target& target : targets_) {
    if (target.kind != Target::Kind::landmark && std::abs(target.value - value) <= tolerance &&
        !is_taken(target))
      found.push_back(&target);
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Target* a, const Target* b) { return a->kind < b->kind; });
  return found;
}

}  // namespace arcslip::continuation
