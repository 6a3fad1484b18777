#include "arcslip/problems/ridges/envelope_family.hpp"

#include <algorithm>

namespace arcslip::problems {

double FactorAxis::value(std::size_t i) const {
  return count == 1 ? low : low + (high - low) * static_cast<double>(i) / static_cast<double>(count - 1);
}

FactorAxis::Place FactorAxis::place(double value) const {
  if (count == 1 || high == low) return {0, 0};
  const double steps = (value - low) / (high - low) * static_cast<double>(count - 1);
  const double last = static_cast<double>(count - 2);
  const auto i = static_cast<std::size_t>(std::clamp(steps, 0.0, last));
  return {i, steps - static_cast<double>(i)};
}

EnvelopeFamily::EnvelopeFamily(const EnvelopeCurve& curve)
    : curves_{Curve(std::shared_ptr<const EnvelopeCurve>(), &curve)}, growths_{0} {}

EnvelopeFamily::EnvelopeFamily(FactorAxis growth, FactorAxis force, const Make& make)
    : growth_(growth), force_(force) {
  for (std::size_t k = 0; k < force.count; ++k) {
    for (std::size_t i = 0; i < growth.count; ++i) {
      growths_.push_back(growth.value(i));
      curves_.push_back(make({growth.value(i), force.value(k)}));
    }
  }
}

EnvelopeFamily::EnvelopeFamily(const std::vector<DesignFactors>& each, const Make& make) : is_grid_(false) {
  for (const DesignFactors& one : each) {
    growths_.push_back(one.log_growth);
    curves_.push_back(make(one));
  }
}

EnvelopeFamily::Walk::Walk(const EnvelopeFamily& family) : family_(family) {
  for (const Curve& curve : family.curves_) walks_.emplace_back(*curve);
}

double EnvelopeFamily::Walk::at(double z, std::size_t curve) {
  return walks_[curve].at(z + family_.growths_[curve]);
}

double EnvelopeFamily::Walk::at(double z, const DesignFactors& factors, std::size_t which) {
  if (!family_.is_grid_) return at(z, which);
  const auto [i, right] = family_.growth_.place(factors.log_growth);
  const auto [k, above] = family_.force_.place(factors.log_force);
  const auto in_row = [&](std::size_t row) {
    const std::size_t first = row * family_.growth_.count + i;
    return right == 0 ? at(z, first) : (1 - right) * at(z, first) + right * at(z, first + 1);
  };
  return above == 0 ? in_row(k) : (1 - above) * in_row(k) + above * in_row(k + 1);
}

}  // namespace arcslip::problems
