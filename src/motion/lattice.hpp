#pragma once

// Harmonics at angles where they are known without a sine: i 2 pi/lattice_size.

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "motion/isolated_zeros.hpp"

namespace arcslip {

constexpr std::size_t lattice_size = 64;
constexpr double lattice_width = 2 * std::numbers::pi / lattice_size;

/// e^{jh theta} there.
struct LatticeTurns {
  std::array<double, lattice_size> cosine;
  std::array<double, lattice_size> sine;
};

/// Of any h >= 0: they are the same of h + lattice_size.
inline const LatticeTurns& lattice_turns(int h) {
  static const auto all = [] {
    std::array<LatticeTurns, lattice_size> turns;
    for (std::size_t k = 0; k < lattice_size; ++k) {
      for (std::size_t i = 0; i < lattice_size; ++i) {
        const auto place = static_cast<double>(k * i % lattice_size);
        turns[k].cosine[i] = std::cos(place * lattice_width);
        turns[k].sine[i] = std::sin(place * lattice_width);
      }
    }
    return turns;
  }();
  return all[static_cast<std::size_t>(h) % lattice_size];
}

/// A sum of harmonics and three derivatives at the first `count` angles.
template <std::size_t count>
struct Lattice {
  using Values = std::array<double, count>;
  Values value{};
  Values first{};
  Values second{};
  Values third{};

  /// Re x e^{jh theta} more.
  void add(int h, double real, double imaginary) {
    const LatticeTurns& turns = lattice_turns(h);
    const double rate = h;
    for (std::size_t i = 0; i < count; ++i) {
      const double x = real * turns.cosine[i] - imaginary * turns.sine[i];
      const double y = real * turns.sine[i] + imaginary * turns.cosine[i];
      value[i] += x;
      first[i] -= rate * y;
      second[i] -= rate * rate * x;
      third[i] += rate * rate * rate * y;
    }
  }

  /// Bound of the second derivative all over the two cells round an angle, by that of the fourth.
  double bound_round(std::size_t middle, double fourth) const {
    return std::abs(second[middle]) +
           (std::abs(third[middle]) + 0.5 * fourth * lattice_width) * lattice_width;
  }

  /// Whether these cells surely hold no zero.
  bool keeps_from_zero(std::size_t middle, double bound) const {
    return arcslip::keeps_from_zero(value[middle], first[middle], bound, lattice_width);
  }
};

}  // namespace arcslip
