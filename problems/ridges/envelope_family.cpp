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

EnvelopeFamily::EnvelopeFamily(const Axes& axes, const Make& make) : axes_(axes) {
  std::size_t count = 1;
  for (const FactorAxis& axis : axes) count *= axis.count;
  for (std::size_t i = 0; i < count; ++i) {
    DesignFactors factors;
    std::size_t place = i;
    for (std::size_t a = 0; a < axes.size(); ++a) {
      factors.*DesignFactors::each()[a] = axes[a].value(place % axes[a].count);
      place /= axes[a].count;
    }
    growths_.push_back(factors.log_growth);
    curves_.push_back(make(factors));
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
  return family_.is_grid_ ? between(z, factors, family_.axes_.size(), 0) : at(z, which);
}

/// Along so many of the axes, from that curve on.
double EnvelopeFamily::Walk::between(double z, const DesignFactors& factors, std::size_t axes,
                                     std::size_t curve) {
  if (axes == 0) return at(z, curve);
  const std::size_t last = axes - 1;
  std::size_t stride = 1;
  for (std::size_t a = 0; a < last; ++a) stride *= family_.axes_[a].count;
  const auto [i, share] = family_.axes_[last].place(factors.*DesignFactors::each()[last]);
  const double here = between(z, factors, last, curve + i * stride);
  return share == 0 ? here : (1 - share) * here + share * between(z, factors, last, curve + (i + 1) * stride);
}

}  // namespace arcslip::problems
