#pragma once

// A periodic motion of odd harmonics as it passes in time, theta = w t:
//
//   r(theta) = Re sum_h r_h e^{jh theta},   h = 1, 3, 5, ...,   r(theta + pi) = -r(theta).

#include <array>
#include <span>

#include "arcslip/types.hpp"

namespace arcslip {

/// The highest harmonic is at most 2 most_harmonics - 1; vectors of harmonics live on the stack.
inline constexpr int most_harmonics = 128;
/// One coefficient for each harmonic.
using HarmonicVector = Eigen::Matrix<Complex, Eigen::Dynamic, 1, 0, most_harmonics, 1>;

/// Angles in ascending order.
struct Angles {
  std::array<double, std::size_t{2} * most_harmonics> values;  ///< the first `count` of them count
  int count = 0;                                               ///< how many there are

  /// All of them, and the i-th of `count`.
  std::span<const double> all() const { return {values.data(), static_cast<std::size_t>(count)}; }
  double operator[](int i) const { return values[static_cast<std::size_t>(i)]; }
  /// More than fit in are zeros of rounding, where all but three of them meet.
  void push(double angle) {
    if (count < std::ssize(values)) values[static_cast<std::size_t>(count++)] = angle;
  }
};

/// Looks at coefficients that somebody else owns.
class OddMotion {
 public:
  /// `orders` are the h, odd and different, with one coefficient each. Both must outlive the motion.
  OddMotion(std::span<const int> orders, const HarmonicVector& coefficients);

  /// What it was made of.
  std::span<const int> orders() const { return orders_; }
  const HarmonicVector& coefficients() const { return coefficients_; }

  /// r(theta).
  double value(double theta) const;

  /// Derivatives at one theta.
  struct Slopes {
    double first;   ///< dr/dtheta
    double second;  ///< d2r/dtheta2
  };
  Slopes slopes(double theta) const;  ///< of r at theta

  /// How the motion goes on from one theta.
  class Departure {
   public:
    /// The motion is to live as long.
    Departure(const OddMotion& motion, double theta);

    /// At theta + step.
    struct Way {
      double change;  ///< r(theta + step) - r(theta) to the rounding of the difference, however small it is
      double slope;   ///< dr/dtheta
    };
    Way after(double step) const;  ///< ahead, or behind where it is below 0
    double bend() const;           ///< d2r/dtheta2 at theta

   private:
    std::span<const int> orders_;
    HarmonicVector turned_;  // r_h e^{jh theta}
  };

  /// r(theta + step) - r(theta), so.
  double change(double theta, double step) const { return Departure(*this, theta).after(step).change; }

  /// Where the motion turns back, within half a period: all zeros of dr/dtheta but pairs of them closer than
  /// 1e-8. Bounds on derivatives, not samples, tell that none is left. None of a motion that is zero.
  Angles turning_points() const;

  /// Where r is largest, and how large.
  struct Maximum {
    double angle;  ///< theta, 0 <= theta < 2 pi
    double value;  ///< r
  };
  /// max r, which is max |r|; 0 of a motion that is zero.
  Maximum maximum() const { return maximum(turning_points()); }

  /// The same where the turning points are known.
  Maximum maximum(const Angles& turns) const;

 private:
  std::span<const int> orders_;
  const HarmonicVector& coefficients_;
};

}  // namespace arcslip
