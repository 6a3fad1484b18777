#pragma once

// Envelopes of designs that differ by factors on what their response is not proportional to: on P_2 of a
// preload that grows with the frequency, on the force F where springs are cubic, and on mu where elements
// have one of their own. Between the designs of a grid of factors ln Y_max is interpolated linearly in their
// logarithms, at the same P over the factor on P_2, so that the static and the growing part of the preload
// keep their ratio.

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "arcslip/problems/ridges/envelope_curve.hpp"

namespace arcslip::problems {

/// Logarithms of the factors.
struct DesignFactors {
  double log_growth = 0;    ///< of that on P_2
  double log_force = 0;     ///< of that on F
  double log_friction = 0;  ///< of that on mu of elements, where P has it as well

  /// All of them.
  static constexpr std::array<double DesignFactors::*, 3> each();
};

constexpr std::array<double DesignFactors::*, 3> DesignFactors::each() {
  return {&DesignFactors::log_growth, &DesignFactors::log_force, &DesignFactors::log_friction};
}

/// `count` values of a factor's logarithm in equal steps from low to high, or low alone.
struct FactorAxis {
  double low = 0;         ///< the first value
  double high = 0;        ///< the last one
  std::size_t count = 1;  ///< 1: `high` does not count

  /// The i-th, counted from 0.
  double value(std::size_t i) const;

  /// Where a value lies: that far, 0 to 1, from value(i) to the next one.
  struct Place {
    std::size_t i;  ///< below `count` - 1 where there are several
    double share;   ///< 0 where there is one
  };
  /// Beyond the ends the share is below 0 or above 1.
  Place place(double value) const;
};

/// Immutable; may be shared by threads.
class EnvelopeFamily {
 public:
  using Curve = std::shared_ptr<const EnvelopeCurve>;       ///< shared where several designs have the same
  using Make = std::function<Curve(const DesignFactors&)>;  ///< the envelope of a design

  /// The same for all factors; refers to the curve.
  EnvelopeFamily(const EnvelopeCurve& curve);  // NOLINT(google-explicit-constructor): one is a family

  /// Of a grid of designs, an axis for each factor.
  using Axes = std::array<FactorAxis, DesignFactors::each().size()>;
  EnvelopeFamily(const Axes& axes, const Make& make);

  /// Of each design by itself.
  EnvelopeFamily(const std::vector<DesignFactors>& each, const Make& make);

  /// Ends of the pieces of the envelope of a design in the middle.
  std::vector<double> places() const { return curves_[curves_.size() / 2]->places(); }

  /// ln Y_max at rising z = ln P - log_growth.
  class Walk {
   public:
    /// Refers to the family.
    explicit Walk(const EnvelopeFamily& family);

    /// Of the design with these factors, `which` of those that were given each by itself.
    double at(double z, const DesignFactors& factors, std::size_t which);

   private:
    double at(double z, std::size_t curve);
    double between(double z, const DesignFactors& factors, std::size_t axes, std::size_t curve);

    const EnvelopeFamily& family_;
    std::vector<EnvelopeCurve::Walk> walks_;
  };

 private:
  Axes axes_;
  bool is_grid_ = true;
  std::vector<Curve> curves_;  ///< of a grid, along the first axis first
  std::vector<double> growths_;
};

}  // namespace arcslip::problems
