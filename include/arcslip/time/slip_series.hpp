#pragma once

// A friction circle that slips, and small disturbances of it, as Taylor series in time. Its force has the
// direction n = e^{i phi} of the complex plane of x and y,
//
//   T = mu N n,   phi' = k/(mu N) Im(r' conj(n)),   z' = v n,   v = Re(r' conj(n)) - mu N'/k,
//
// and with t = i n disturbances dz = t m + n (n.dr - mu/k dN) of the slider's place z = r - T/k obey
//
//   dT = mu dN n + k (t.dr - m) t,   m' = -phi' (n.dr - mu/k dN) + k v/(mu N) (t.dr - m).

#include <vector>

#include "arcslip/time/ring_law.hpp"

namespace arcslip {

/// The motion, term by term as those of r and N become known.
class SlipSeries {
 public:
  /// From the direction `start` on.
  SlipSeries(const RingCircle& circle, const Complex& start) : circle_(circle), direction_{start} {}

  /// Takes the next terms of r' and of N, and gives that of T.
  Complex take(const Complex& rate, double normal_force);

  /// The size of the last term of n.
  double last() const { return std::abs(direction_.back()); }

  // Terms up to the last ones taken.
  const std::vector<Complex>& direction() const { return direction_; }  ///< n
  const std::vector<double>& turning() const { return turning_; }       ///< phi'
  Vector slip() const;                                                  ///< v
  Vector settling() const;                                              ///< k v/(mu N)

  /// n at this time.
  Complex direction(double time) const;

 private:
  RingCircle circle_;
  std::vector<Complex> direction_;
  std::vector<Complex> rate_;    // r'
  std::vector<double> normal_;   // N
  std::vector<double> turning_;  // phi'
};

/// Its disturbances over a step, in columns side by side.
class SlipTangent {
 public:
  /// What the terms of a step are, in units of its length.
  struct Step {
    RingCircle circle;
    std::vector<Complex> direction;
    std::vector<double> turning;
    Vector settling;
    Complex end;  ///< n there
    /// Of a motion over `part` of the time in which it is told.
    static Step of(const SlipSeries& series, const RingCircle& circle, double part);
  };
  using Row = Eigen::RowVectorXd;

  /// From disturbances of z on.
  SlipTangent(const Step& step, const Row& z_x, const Row& z_y);

  /// Takes the next terms of dr and dg and gives those of dT.
  void take(const Row& x, const Row& y, const Row& g, Row& force_x, Row& force_y);

  /// m at the end, of all terms taken, and dz there, where dr and dg have come to these.
  void finish(const Row& x, const Row& y, const Row& g, Row& z_x, Row& z_y) const;

 private:
  Row held_;    // sum of the terms of m
  Row memory_;  // the next term of m
  const Step& step_;
  std::vector<Row> motion_x_;  // dx
  std::vector<Row> motion_y_;  // dy
  std::vector<Row> closing_;   // dg
  std::vector<Row> aside_;     // t.dr - m
  std::vector<Row> along_;     // n.dr - mu/k dN
};

}  // namespace arcslip
