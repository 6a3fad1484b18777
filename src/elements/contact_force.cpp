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

}  // namespace arcslip
