#pragma once

// Elements whose force is any smooth odd function of the momentary displacement, f(-x) = -f(x), known by its
// values alone. Means over half a period are taken from samples, which are doubled until they settle: to
// rounding where f is analytic, to some 1e-7 of f where it has a kink.

#include <memory>

#include "arcslip/elements/element.hpp"

namespace arcslip {

/// What a law is at some displacements.
struct LawSamples {
  Vector force;              ///< f
  Vector slope;              ///< df/dx
  Vector by_setting;         ///< df/ds by the setting that is continued; empty where none is
  Vector curvature;          ///< d2f/dx2
  Vector slope_by_setting;   ///< d2f/dx ds, as by_setting
  Vector second_by_setting;  ///< d2f/ds2, the same
};

/// Such a law, used from all threads.
class SampledLaw {
 public:
  virtual ~SampledLaw() = default;

  /// At the displacements x fills the force, with `derivatives` = 1 slope and by_setting as well, with 2 all.
  virtual void at(const Vector& x, int derivatives, LawSamples& out) const = 0;
};

/// By its law.
class SampledElement final : public Element {
 public:
  /// `reference` > 0 is the stiffness relative to which the force is measured.
  SampledElement(std::shared_ptr<const SampledLaw> law, double reference);

  double reference_stiffness(Index /*coordinate*/ = 0) const override { return reference_; }
  bool takes_any_orders() const override { return false; }
  void force(std::span<const int> orders, const HarmonicVector& x, double load, bool beyond, bool derivatives,
             ElementForce& out) const override;
  bool in_two_phases(const TwoPhases& phases, double load, const ComplexVector& x, double ratio,
                     bool derivatives, LineForce& out) const override;
  VaryingStiffness stiffness_in_time(std::span<const int> orders, const HarmonicVector& x) const override;

 private:
  void second(const ElementForce& at, std::span<const int> orders, const HarmonicVector& x, double load,
              bool beyond, const Way& way, ElementForce& change) const override;

  std::shared_ptr<const SampledLaw> law_;
  double reference_;
};

}  // namespace arcslip
