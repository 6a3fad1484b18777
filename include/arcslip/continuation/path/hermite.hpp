#pragma once

// The polynomial with given values and slopes at several places [Hermite], by divided differences [Newton]:
//
//   z(s) = c_0 + c_1 (s - s_0) + c_2 (s - s_0)^2 + c_3 (s - s_0)^2 (s - s_1) + ...
//
// Its first terms are the polynomial of the first places. A curve that leaves a corner as a series in the
// root of s does is one in sqrt|s - s_corner| instead, whose slope at the corner is zero and whose second
// derivative is twice the curve's slope.

#include <array>
#include <optional>

#include "arcslip/types.hpp"

namespace arcslip::continuation {

/// Of a vector function of s, at up to four places.
class Hermite {
 public:
  static constexpr std::size_t most_places = 4;

  /// Where the curve has a corner; all places lie on the side to which `into` points, 1 or -1, or on it.
  struct Corner {
    double s;
    double into;
  };

  /// In s, or in the root of the distance from a corner.
  explicit Hermite(std::optional<Corner> corner = std::nullopt) : corner_(corner) {}

  /// Another place, with the function's value and slope there.
  void add(double s, const Vector& value, const Vector& slope);

  /// The function at s, by the first places alone.
  void at(double s, std::size_t places, Vector& out) const;

  /// The sizes of the terms that the last of the first places adds to the function at s, summed.
  void added(double s, std::size_t places, Vector& out) const;

  /// The coefficient of the cubic through two places.
  auto cubic() const { return terms_.col(3); }

 private:
  double variable(double s) const;
  double node(Index term) const { return nodes_[static_cast<std::size_t>(term)]; }
  void add(double x, std::array<const Vector*, 3> derivatives, Index count);

  std::optional<Corner> corner_;
  std::size_t places_ = 0;
  static constexpr std::size_t most_terms = 2 * most_places + 1;

  std::array<Index, most_places + 1> counts_{};  // of terms, by places
  std::array<double, most_terms> nodes_{};
  Matrix terms_;  // in columns
  Matrix last_;   // divided differences that end at the last node, by order
  std::array<Vector, 2> scaled_;
};

}  // namespace arcslip::continuation
