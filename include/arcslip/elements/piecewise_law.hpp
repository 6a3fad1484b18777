#pragma once

// A force that follows from the momentary displacement alone, odd, f(-x) = -f(x), and for x >= 0 a polynomial
// from each displacement at which it changes its law to the next.

#include <cstdlib>
#include <vector>

namespace arcslip {

class PiecewiseLaw {
 public:
  /// f = sum_m c_m x^m for x up to `end`.
  struct Piece {
    double end;                        ///< infinite of the last one
    std::vector<double> coefficients;  ///< c_m
  };

  /// Throws std::invalid_argument unless the ends ascend from above 0 to infinity, the first piece has odd
  /// powers alone and the force is continuous.
  explicit PiecewiseLaw(std::vector<Piece> pieces);

  const std::vector<Piece>& pieces() const { return pieces_; }
  int degree() const { return degree_; }  ///< the highest of the pieces

  /// The position of the piece that holds at x, negative where x is: each such zone has one polynomial, and
  /// the first piece, of both signs, is one zone.
  int zone_at(double x) const;

  /// Where a zone ends, downwards and upwards; infinite where there is no other.
  struct Ends {
    double low;
    double high;
  };
  Ends ends(int zone) const;

  // At x, by the polynomial of a zone, whether it holds there or not.
  double value(double x, int zone) const;      ///< f
  double slope(double x, int zone) const;      ///< df/dx
  double curvature(double x, int zone) const;  ///< d2f/dx2

  /// int_0^x f dx.
  double energy(double x) const;

 private:
  const Piece& piece(int zone) const { return pieces_[static_cast<std::size_t>(std::abs(zone))]; }

  std::vector<Piece> pieces_;
  int degree_ = 0;
};

}  // namespace arcslip
