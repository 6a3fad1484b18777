#include "arcslip/elements/element.hpp"

#include <limits>
#include <stdexcept>

namespace arcslip {

void ElementForce::set_linear(double stiffness, const HarmonicVector& x, bool derivatives) {
  const Index count = x.size();
  harmonics = stiffness * x;
  energy = 0;
  if (!derivatives) return;
  linear.setZero(count, count);
  linear.diagonal().setConstant(stiffness);
  conjugate.setZero(count, count);
  by_log_load.setZero(count);
}

void ElementForce::add(const ElementForce& change, double part) {
  harmonics += part * change.harmonics;
  by_log_load += part * change.by_log_load;
  linear += part * change.linear;
  conjugate += part * change.conjugate;
}

ElementForce Element::change(const ElementForce& at, std::span<const int> orders, const HarmonicVector& x,
                             double load, bool slips, const HarmonicVector& motion, double log_load) const {
  ElementForce change;
  change.harmonics = at.linear * motion + at.conjugate * motion.conjugate() + at.by_log_load * log_load;
  change.by_log_load.setZero(x.size());
  change.linear.setZero(x.size(), x.size());
  change.conjugate.setZero(x.size(), x.size());
  if (!is_linear(slips)) second(at, orders, x, load, motion, log_load, change);
  return change;
}

StateBorder Element::border(std::span<const int> /*orders*/, const OddMotion::Maximum& /*top*/,
                            double /*load*/, bool /*slips*/) const {
  throw std::logic_error("Element: an element that does not slip has no border");
}

double Element::slip_threshold(double /*load*/) const { return std::numeric_limits<double>::infinity(); }

}  // namespace arcslip
