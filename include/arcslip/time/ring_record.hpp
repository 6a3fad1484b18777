#pragma once

// What is read off a motion of the ring, by Gauss quadrature on its polynomial pieces, to rounding. A record
// refers to its motion and must not outlive it.

#include "arcslip/time/ring_motion.hpp"

namespace arcslip {

/// Fourier coefficients of node 1 over what is followed, one or several whole periods T, in the coordinate of
/// the first contact: (2/T) int y e^{-jhwt} dt for each order h asked for, of which 0 is the mean. A step
/// holds at most 1/64 of a period: orders up to 64 are resolved to rounding. Of a settled travelling
/// response, which all nodes take part in, a record of `all_nodes` needs but nT/N, since node i lags by i
/// nT/N.
class HarmonicRecord : public RingObserver {
 public:
  /// `orders` are the h, in the order of the results.
  HarmonicRecord(const RingMotion& motion, std::vector<int> orders, bool all_nodes = false);
  void follow(const RingSegment& segment, const RingState& state) override;

  const std::vector<int>& orders() const { return orders_; }    ///< h
  ComplexVector base() const;                                   ///< y_h
  ComplexVector damper() const { return base() + relative(); }  ///< u_h
  ComplexVector relative() const { return mean(1); }            ///< r_h
  ComplexVector force() const { return mean(2); }               ///< of all elements there, against r

  /// Of any coordinate x of node 1, in the order of the ring's; their forces.
  ComplexVector motion(Index coordinate) const { return mean(1 + 2 * coordinate); }
  ComplexVector force(Index coordinate) const { return mean(2 + 2 * coordinate); }

 private:
  ComplexVector mean(Index quantity) const;

  const RingMotion& motion_;
  std::vector<int> orders_;
  bool all_nodes_;
  ComplexMatrix sums_;  ///< orders x (y, x and force of each coordinate)
  double time_ = 0;
};

/// Work done over what is followed.
class EnergyRecord : public RingObserver {
 public:
  /// Nothing yet.
  explicit EnergyRecord(const RingMotion& motion) : motion_(motion) {}
  void follow(const RingSegment& segment, const RingState& state) override;

  double input() const { return input_; }  ///< of the load
  double damping() const {
    return damping_;
  }  ///< lost to viscous damping and to a flow; negative where they drive
  double elements() const { return elements_; }  ///< done on the elements, which lose or store it

 private:
  const RingMotion& motion_;
  double input_ = 0;
  double damping_ = 0;
  double elements_ = 0;
};

}  // namespace arcslip
