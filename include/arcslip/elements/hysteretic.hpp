#pragma once

// Elements with a memory, whose force follows from the way that the displacement has taken and not from how
// fast: known by the samples of a period in its settled cycle, which is odd, f(theta + pi) = -f(theta). One
// of the samples lies where the motion is largest, so that a motion of one harmonic turns back at samples.
// With n of them in a period harmonics of the force are right to rounding where it is smooth, to some (2
// pi/n)^2 of it where it has kinks.

#include <memory>
#include <optional>

#include "arcslip/elements/element.hpp"
#include "arcslip/elements/jet.hpp"

namespace arcslip {

/// What a law is in its settled cycle, n samples.
struct CycleSamples {
  Vector force;       ///< f, n
  Matrix changes;     ///< of f along each way, n x ways
  Vector by_setting;  ///< df/ds by the setting that is continued, n; empty where none is
};

/// Where a law is a spring at first: up to this amplitude of the displacement.
struct StuckRange {
  Jet stiffness;  ///< k > 0
  Jet amplitude;  ///< S > 0, where the force has a corner
};

/// Such a law, used from all threads.
class CycleLaw {
 public:
  virtual ~CycleLaw() = default;

  /// n, even; there are more where harmonics are so high that these would have fewer than 8 in their period.
  virtual Index samples() const = 0;

  /// A typical magnitude of the setting that is continued, > 0.
  virtual double setting_scale() const = 0;

  /// Null where it has none, or no corner.
  virtual std::optional<StuckRange> stuck() const { return {}; }

  /// Fills the force of the cycle with the displacements x (n) and, with `derivatives`, its changes along
  /// `ways` (n x any number) and by the setting that is continued, which is by `setting` larger than it is.
  virtual void at(const Vector& x, const Matrix& ways, double setting, bool derivatives,
                  CycleSamples& out) const = 0;
};

/// By its law.
class HystereticElement final : public Element {
 public:
  bool dissipates() const override { return true; }
  /// `reference` > 0 is the stiffness relative to which the force is measured.
  HystereticElement(std::shared_ptr<const CycleLaw> law, double reference);

  double reference_stiffness(Index /*coordinate*/ = 0) const override { return reference_; }
  bool has_border() const override { return stuck_.has_value(); }
  bool takes_any_orders() const override { return false; }
  std::string beyond() const override { return stuck_ ? "slip" : ""; }
  double threshold(double load) const override {
    return stuck_ ? stuck_->amplitude.value : Element::threshold(load);
  }
  double log_threshold_by_setting() const override {
    return stuck_ ? stuck_->amplitude.first / stuck_->amplitude.value : 0;
  }
  void force(std::span<const int> orders, const HarmonicVector& x, double load, bool beyond, bool derivatives,
             ElementForce& out) const override;

 private:
  void at(std::span<const int> orders, const HarmonicVector& x, double setting, bool derivatives,
          ElementForce& out) const;
  /// By central differences wide enough to cross many samples, for kinks move between them by jumps.
  void second(const ElementForce& at, std::span<const int> orders, const HarmonicVector& x, double load,
              bool beyond, const Way& way, ElementForce& change) const override;

  std::shared_ptr<const CycleLaw> law_;
  double reference_;
  std::optional<StuckRange> stuck_;
};

}  // namespace arcslip
