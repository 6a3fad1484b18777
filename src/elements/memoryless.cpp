#include "arcslip/elements/memoryless.hpp"

#include <cmath>

namespace arcslip {
namespace {

// Samples theta_k = pi k/M of half a period, M > (degree + 1) h/2 for the highest h, take all products
// exactly:
//
//   f_h = (2/M) sum f(x_k) e^{-jh theta_k},   df_h = sum_l c_{h-l} dx_l + c_{h+l} conj(dx_l),
//   c_m = (1/M) sum f'(x_k) e^{-jm theta_k}
class Samples {
 public:
  Samples(int degree, std::span<const int> orders)
      : orders_(orders), count_((degree + 1) * orders.back() / 2 + 1), turn_(std::ssize(orders)) {}

  int count() const { return count_; }
  void go_to(int k) {
    for (Index a = 0; a < turn_.size(); ++a)
      turn_(a) = std::polar(1.0, -orders_[static_cast<std::size_t>(a)] * pi * k / count_);
  }
  double value(const HarmonicVector& x) const { return turn_.dot(x).real(); }

  void add_force(double value, HarmonicVector& harmonics) const { harmonics += (2 * value / count_) * turn_; }
  void add_slope(double slope, ComplexMatrix& linear, ComplexMatrix& conjugate) const {
    const double share = slope / count_;
    for (Index l = 0; l < turn_.size(); ++l) {
      linear.col(l) += (share * std::conj(turn_(l))) * turn_;
      conjugate.col(l) += (share * turn_(l)) * turn_;
    }
  }

 private:
  std::span<const int> orders_;
  int count_;
  HarmonicVector turn_;  // e^{-jh theta_k}
};

}  // namespace

void MemorylessElement::force(std::span<const int> orders, const HarmonicVector& x, double /*load*/,
                              bool /*slips*/, bool derivatives, ElementForce& out) const {
  const Index count = x.size();
  out.harmonics.setZero(count);
  out.energy = 0;
  if (derivatives) {
    out.linear.setZero(count, count);
    out.conjugate.setZero(count, count);
    out.by_log_load.setZero(count);
  }
  Samples samples(degree(), orders);
  for (int k = 0; k < samples.count(); ++k) {
    samples.go_to(k);
    const double here = samples.value(x);
    samples.add_force(value(here), out.harmonics);
    if (derivatives) samples.add_slope(slope(here), out.linear, out.conjugate);
  }
}

VaryingStiffness MemorylessElement::stiffness_in_time(std::span<const int> orders,
                                                      const HarmonicVector& x) const {
  // The slope has harmonics up to (degree - 1) h.
  const int count = (degree() - 1) * orders.back() + 1;
  VaryingStiffness stiffness;
  stiffness.harmonics.resize(static_cast<std::size_t>(count / 2 + 1));
  const OddMotion motion(orders, x);
  for (int k = 0; k < count; ++k) {
    const double theta = pi * k / count;
    const double share = slope(motion.value(theta)) / count;
    for (std::size_t m = 0; m < stiffness.harmonics.size(); ++m)
      stiffness.harmonics[m] +=
          (m == 0 ? 1 : 2) * share * std::polar(1.0, -2 * static_cast<double>(m) * theta);
  }
  return stiffness;
}

void MemorylessElement::second(const ElementForce& /*at*/, std::span<const int> orders,
                               const HarmonicVector& x, double /*load*/, const HarmonicVector& motion,
                               double /*log_load*/, ElementForce& change) const {
  Samples samples(degree(), orders);
  for (int k = 0; k < samples.count(); ++k) {
    samples.go_to(k);
    samples.add_slope(curvature(samples.value(x)) * samples.value(motion), change.linear, change.conjugate);
  }
}

}  // namespace arcslip
