#include "arcslip/elements/held_element.hpp"

#include <limits>
#include <stdexcept>

namespace arcslip {

void HeldElement::force(std::span<const int> orders, const HarmonicVector& x, double load, bool beyond,
                        bool derivatives, ElementForce& out) const {
  element_->force(orders, x, load, false, derivatives, out);
  const Index mean = place_of_mean(orders);
  if (beyond) out.harmonics.setConstant(std::numeric_limits<double>::quiet_NaN());
  if (mean == std::ssize(orders)) return;
  out.harmonics(mean) = force_;
  if (!derivatives) return;
  out.linear.row(mean).setZero();
  out.conjugate.row(mean).setZero();
  out.by_log_load(mean) = 0;
  if (out.by_setting.size() > 0) out.by_setting(mean) = 0;
}

void HeldElement::second(const ElementForce& /*at*/, std::span<const int> /*orders*/,
                         const HarmonicVector& /*x*/, double /*load*/, bool /*beyond*/, const Way& /*way*/,
                         ElementForce& /*change*/) const {
  throw std::logic_error("HeldElement: no second derivatives");
}

}  // namespace arcslip
