#pragma once

// A force that follows from the momentary displacement alone, a polynomial from each displacement at which it
// changes its law to the next: odd, f(-x) = -f(x), with pieces for x >= 0, or one-sided, with pieces for all
// x.

#include <cstdlib>
#include <vector>

#include "arcslip/elements/jet.hpp"

namespace arcslip {

/// Such a law.
class PiecewiseLaw {
 public:
  /// f = sum_m c_m x^m for x up to `end`, with their derivatives by a setting if one is continued.
  struct Piece {
    Jet end;                        ///< infinite of the last one
    std::vector<Jet> coefficients;  ///< c_m
  };

  /// Throws std::invalid_argument unless the ends ascend to infinity and the force is continuous and, of an
  /// odd one, the ends are positive and the first piece has odd powers alone.
  explicit PiecewiseLaw(std::vector<Piece> pieces, bool is_one_sided = false);

  /// Whether the first piece goes on to the least of x.
  bool is_one_sided() const { return is_one_sided_; }

  /// In their order from x = 0.
  const std::vector<Piece>& pieces() const { return pieces_; }
  int degree() const { return degree_; }  ///< the highest of the pieces

  /// The position of the piece that holds at x, negative where x is: each such zone has one polynomial, and
  /// the first piece, of both signs, is one zone.
  int zone_at(double x) const;

  /// Where a zone ends, downwards and upwards; infinite where there is no other.
  struct Ends {
    double low;   ///< downwards
    double high;  ///< upwards
  };
  /// Those of one zone.
  Ends ends(int zone) const;

  // At x, by the polynomial of a zone, whether it holds there or not.
  double value(double x, int zone) const;      ///< f
  double slope(double x, int zone) const;      ///< df/dx
  double curvature(double x, int zone) const;  ///< d2f/dx2

  /// Whether it depends on a setting that is continued, and at x its derivatives by that.
  bool is_varied() const { return is_varied_; }
  double by_setting(double x, int zone) const;         ///< df/ds
  double slope_by_setting(double x, int zone) const;   ///< d2f/dx ds
  double second_by_setting(double x, int zone) const;  ///< d2f/ds2

  /// d/ds of the displacement at which a zone gives way to the next one, outwards or inwards.
  double end_by_setting(int zone, int next) const;

  /// int_0^x f dx.
  double energy(double x) const;

 private:
  const Piece& piece(int zone) const { return pieces_[static_cast<std::size_t>(std::abs(zone))]; }

  std::vector<Piece> pieces_;
  bool is_one_sided_ = false;
  int degree_ = 0;
  bool is_varied_ = false;
};

}  // namespace arcslip
