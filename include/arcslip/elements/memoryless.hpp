#pragma once

// Elements whose force is a function of the momentary displacement. One whose law is odd, f(-x) = -f(x), and
// changes at some displacement has a border there: the motion that reaches the end of the law's first piece.
// Where it crosses other ends of pieces the force is continuous, and its second derivatives are one-sided.

#include <memory>

#include "arcslip/elements/element.hpp"

namespace arcslip {

/// By its law in pieces.
class MemorylessElement final : public Element {
 public:
  /// `reference` > 0 is the stiffness relative to which the force is measured; `beyond`: what it does past
  /// the first piece.
  MemorylessElement(PiecewiseLaw law, double reference, std::string beyond = "touch");

  double reference_stiffness(Index /*coordinate*/ = 0) const override { return reference_; }
  bool has_border() const override { return law_.pieces().size() > 1 && !law_.is_one_sided(); }
  bool is_odd() const override { return !law_.is_one_sided(); }
  std::string beyond() const override { return beyond_; }
  void force(std::span<const int> orders, const HarmonicVector& x, double load, bool beyond, bool derivatives,
             ElementForce& out) const override;
  DisturbedLaw disturbed(std::span<const int> orders, const HarmonicVector& x, double load,
                         bool beyond) const override;
  VaryingStiffness stiffness_in_time(std::span<const int> orders, const HarmonicVector& x) const override;
  /// Where the law has one piece.
  bool in_two_phases(const TwoPhases& phases, double load, const ComplexVector& x, double ratio,
                     bool derivatives, LineForce& out) const override;
  double threshold(double /*load*/) const override { return law_.pieces().front().end.value; }
  double log_threshold_by_setting() const override {
    return law_.pieces().front().end.first / law_.pieces().front().end.value;
  }
  const PiecewiseLaw* law() const override { return &law_; }

 private:
  /// Whether the motion may leave the first piece.
  bool crosses(bool beyond) const { return law_.is_one_sided() || beyond; }

  void second(const ElementForce& at, std::span<const int> orders, const HarmonicVector& x, double load,
              bool beyond, const Way& way, ElementForce& change) const override;

  PiecewiseLaw law_;
  double reference_;
  std::string beyond_;
};

/// f = k_3 x^3.
std::shared_ptr<const Element> cubic_spring(const Jet& coefficient, double reference);

}  // namespace arcslip
