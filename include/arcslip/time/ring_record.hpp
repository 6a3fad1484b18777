#pragma once

// What is read off a motion of the ring, by Gauss quadrature on its polynomial pieces, to rounding. A record
// refers to its motion and must not outlive it.

#include "arcslip/time/ring_motion.hpp"

namespace arcslip {

/// Fourier coefficients of node 1 over what is followed, one or several whole periods T:
/// (2/T) int y e^{-jhwt} dt for each order h asked for. A step holds at most 1/64 of a period: orders up to
/// 64 are resolved to rounding.
class HarmonicRecord : public RingObserver {
 public:
  /// `orders` are the h, in the order of the results.
  HarmonicRecord(const RingMotion& motion, std::vector<int> orders);
  void follow(const RingSegment& segment, const RingState& state) override;

  const std::vector<int>& orders() const { return orders_; }             ///< h
  ComplexVector base() const { return sums_.col(0) * (2 / time_); }      ///< y_h
  ComplexVector damper() const { return sums_.col(1) * (2 / time_); }    ///< u_h
  ComplexVector relative() const { return sums_.col(2) * (2 / time_); }  ///< r_h
  ComplexVector force() const { return sums_.col(3) * (2 / time_); }  ///< of the friction force on the base

 private:
  const Ring& ring_;
  double frequency_;
  double threshold_;
  std::vector<int> orders_;
  ComplexMatrix sums_;  ///< orders x (y, u, r, force)
  double time_ = 0;
};

/// Work done over what is followed.
class EnergyRecord : public RingObserver {
 public:
  /// Nothing yet.
  explicit EnergyRecord(const RingMotion& motion)
      : ring_(motion.ring()), frequency_(motion.frequency()), threshold_(motion.slip_threshold()) {}
  void follow(const RingSegment& segment, const RingState& state) override;

  double input() const { return input_; }        ///< of the load
  double damping() const { return damping_; }    ///< lost to viscous damping; negative where it drives
  double friction() const { return friction_; }  ///< lost to slip

 private:
  const Ring& ring_;
  double frequency_;
  double threshold_;
  double input_ = 0;
  double damping_ = 0;
  double friction_ = 0;
};

}  // namespace arcslip
