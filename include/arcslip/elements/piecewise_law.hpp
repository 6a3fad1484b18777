#pragma once

// A force that follows from the momentary displacement alone, odd, f(-x) = -f(x), and for x >= 0 a polynomial
// from each displacement at which it changes its law to the next.

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

  /// The piece that holds at |x|.
  std::size_t piece_at(double x) const;

  // At x, by the law of a piece, whether it holds there or not.
  double value(double x, std::size_t piece) const;      ///< f
  double slope(double x, std::size_t piece) const;      ///< df/dx
  double curvature(double x, std::size_t piece) const;  ///< d2f/dx2

  /// The slope's polynomial of x where x is the distance from zero and may have become negative.
  double continued_slope(double x, std::size_t piece) const;

  /// int_0^x f dx.
  double energy(double x) const;

 private:
  std::vector<Piece> pieces_;
  int degree_ = 0;
};

}  // namespace arcslip
