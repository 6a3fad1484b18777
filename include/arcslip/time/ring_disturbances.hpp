#pragma once

// All small disturbances of a travelling response of n waves round a ring of N nodes, wave by wave.
//
// Waves l and l + 2 n hang together by friction (turned_flow.hpp), so that there are g = gcd(2 n, N) classes
// of N/g waves each; those of l and g - l are conjugates. Of few waves, N/gcd(n, N) < 2 H + 3 for a response
// with harmonics up to H, each class is looked at as a whole, exactly. Of more, those of 0, n, ..., (H + 1) n
// lengths either way are taken together in the harmonics of the response and the even ones between
// (disturbance_flow.hpp), the others in cells of up to H + 2 waves, and of more than 16 such cells side by
// side 16 that are evenly chosen: the cost does not depend on N.
//
// A response that is not odd repeats itself after a whole period alone: waves l and l + n hang together, in
// gcd(n, N) classes, and all of it is told by cells, of the response's own waves one. So it is where an
// element with a memory has no balance.
//
// In both ways every multiplier stands for one physical disturbance and every disturbance has one, but for
// those of cells left out.

#include <optional>
#include <set>

#include "arcslip/time/disturbance_flow.hpp"
#include "arcslip/time/turned_flow.hpp"

namespace arcslip {

/// Of one response's system; may be asked at any eta and pattern of stick.
class RingDisturbances {
 public:
  /// Of a response in the harmonics of `system`. Throws as oscillators() and the waves do.
  RingDisturbances(const HarmonicSystem& system, const RingWaves& waves);

  /// One that is multiplied by e^{lambda t}, lambda = 2 pi sigma, or by |mu| = e^{2 pi Re sigma/eta} a
  /// period: delta r_i(t) = e^{lambda t} e^{-2 pi j l (i-1)/N} q(t - (i-1) nT/N), q(t + T) = q(t).
  struct Disturbance {
    Complex exponent;  ///< sigma; with each that is not real comes its conjugate, of -l
    Index wave;        ///< l
    bool is_own;       ///< whether it is real and travels as the response does, so that a fold may be near
    Index cell;        ///< of waves that it belongs to
    Complex in_cell;   ///< sigma as the cell has it
    bool is_negative = false;  ///< whether mu is negative: sigma, real, has its modulus alone
  };

  /// What is found at one response.
  struct Disturbances {
    std::vector<Disturbance> all;  ///< cell by cell
    /// For each symmetry that a response with a real exponent 0 would break, and each way in which its period
    /// would double, a function that changes its sign with this exponent.
    std::vector<double> symmetries;
  };

  /// Whether all classes are looked at as a whole, where N/gcd(n, N) is `waves` and H `highest`.
  static bool is_exact(Index waves, int highest) { return waves < 2 * highest + 3; }

  /// The waves, 0 .. N/2, under which the structures are asked for.
  static std::set<Index> waves(Index wave_number, Index nodes, std::span<const int> orders);

  /// Of each of `symmetries` whether, instead, a multiplier -1 doubles the period.
  const std::vector<bool>& doubles() const { return doubles_; }

  /// Whether exponents of motions that travel as the response does are those of its own harmonics, and so
  /// vanish where its folds are.
  bool is_balanced() const { return balanced_.has_value(); }

  /// `elements`: of each contact, then of each further coordinate of the system. `active`: only those of
  /// cells in which something may grow, and of the response's own.
  Disturbances at(double eta, std::span<const StickPattern> elements, bool active) const;

  /// nu of ring_stability.hpp, which is the same for whatever l and lambda stand for a disturbance.
  Complex turned(const Disturbance& one, double eta) const;

  /// The wave, of 0 .. N - 1, that one of these mostly is (disturbed_wave.hpp).
  Index wave_of(const Disturbance& one, double eta, std::span<const StickPattern> elements) const;

 private:
  struct Cell {
    TurnedFlow flow;
    Index wave;  ///< l of f = 0
    bool is_own;
    bool is_halved;  ///< whether its f are odd halves
    /// A real nu that breaks a symmetry or doubles the period.
    struct Test {
      double at;             ///< 1 or -1
      bool doubles = false;  ///< the period
    };
    std::vector<Test> tests;
  };
  struct Balanced {
    DisturbanceFlow own;
    DisturbanceFlow even;
  };
  struct Builder;
  Disturbance seen(Index cell, const Complex& sigma, double eta) const;
  void add(Index cell, double eta, std::span<const StickPattern> elements, Disturbances& found) const;
  void add_balanced(double eta, std::span<const StickPattern> elements, Disturbances& found) const;

  RingWaves waves_;
  bool is_odd_;
  std::optional<Balanced> balanced_;
  std::vector<Cell> cells_;
  std::vector<bool> doubles_;
};

}  // namespace arcslip
