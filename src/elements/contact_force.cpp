#include "arcslip/elements/contact_force.hpp"

#include "arcslip/elements/hysteresis_loop.hpp"

namespace arcslip {

void ContactForce::set(std::span<const int> orders, const HarmonicVector& r, double stiffness,
                       double threshold, bool slips, bool derivatives) {
  const Index count = r.size();
  if (!slips) {
    harmonics = stiffness * r;
    energy = 0;
    if (!derivatives) return;
    linear.setZero(count, count);
    linear.diagonal().setConstant(stiffness);
    conjugate.setZero(count, count);
    by_log_threshold.setZero(count);
    return;
  }
  const OddMotion motion(orders, r);
  const HysteresisLoop loop(motion, threshold);
  loop.force(harmonics);
  harmonics *= stiffness;
  energy = loop.energy() / (threshold * threshold);
  maximum = loop.maximum();
  if (!derivatives) return;
  loop.derivative(linear, conjugate);
  linear *= stiffness;
  conjugate *= stiffness;
  by_log_threshold = harmonics;  // f is homogeneous in r and S
  by_log_threshold.noalias() -= linear * r;
  by_log_threshold.noalias() -= conjugate * r.conjugate();
}

ContactForce ContactForce::change(std::span<const int> orders, const HarmonicVector& r, double stiffness,
                                  double threshold, bool slips, const HarmonicVector& motion,
                                  double log_threshold) const {
  ContactForce change;
  change.harmonics = linear * motion + conjugate * motion.conjugate() + by_log_threshold * log_threshold;
  if (slips) {
    const OddMotion moved(orders, r);
    HysteresisLoop(moved, threshold)
        .second(motion, threshold * log_threshold, change.linear, change.conjugate);
    change.linear *= stiffness;
    change.conjugate *= stiffness;
  } else {
    change.linear.setZero(r.size(), r.size());
    change.conjugate.setZero(r.size(), r.size());
  }
  change.by_log_threshold =
      by_log_threshold * log_threshold - change.linear * r - change.conjugate * r.conjugate();
  return change;
}

void ContactForce::add(const ContactForce& change, double part) {
  harmonics += part * change.harmonics;
  by_log_threshold += part * change.by_log_threshold;
  linear += part * change.linear;
  conjugate += part * change.conjugate;
}

}  // namespace arcslip
