#pragma once

// A zero of a smooth function from values at some distance on both sides of it, for functions that cannot be
// evaluated well next to their zeros: that of the polynomial through them [Lagrange]. What else is smooth is
// interpolated at the zero from the same places.

#include <array>
#include <functional>
#include <optional>

namespace arcslip::continuation {

/// The zero, with the weights by which everything else is interpolated there.
struct RemoteZero {
  static constexpr std::size_t count = 6;  ///< places of which the polynomial is made
  double s = 0;                            ///< the zero
  bool agrees = false;  ///< with that of a polynomial of two degrees less, to 1e-9 of the range
  std::array<double, count> places{};        ///< rising
  std::array<double, count> weights{};       ///< of values there, in that at the zero
  std::array<double, count> slopes{};        ///< of values there, in the derivative at the zero
  std::array<double, count> other_slopes{};  ///< the same of the polynomial of two degrees less
};

/// What is known of where the zero lies.
struct ZeroRange {
  double low;        ///< between these two the function has no other,
  double high;       ///< see `low`
  double guess;      ///< of the zero
  int multiplicity;  ///< of this one
  double begin;      ///< the function is evaluated between these two only
  double end;        ///< see `begin`
};

/// Evaluates `f` within `radius` of the guess or, at an end, beside it. Nothing where f has no value or the
/// polynomials no zero.
std::optional<RemoteZero> remote_zero(const std::function<std::optional<double>(double s)>& f,
                                      const ZeroRange& range, double radius);

}  // namespace arcslip::continuation
