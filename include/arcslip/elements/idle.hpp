#pragma once

// A contact of stiffness 0: no force, in a coordinate that other elements may act in.

#include "arcslip/elements/element.hpp"
#include "arcslip/elements/two_phases.hpp"

namespace arcslip {

/// S/P of such a contact: beyond all motion, with a square that a double holds.
inline constexpr double never_slips = 1e100;

/// Nothing, which stays in its first state.
class Idle final : public Element {
 public:
  /// `reference` is the stiffness that its coordinate meets, > 0.
  explicit Idle(double reference) : reference_(reference) {}

  double reference_stiffness(Index /*coordinate*/ = 0) const override { return reference_; }
  bool has_border() const override { return true; }
  bool forgets_mean() const override { return true; }
  bool holds_mean(Index /*coordinate*/, bool /*slips*/) const override { return false; }
  std::string beyond() const override { return "slip"; }
  void force(std::span<const int> /*orders*/, const HarmonicVector& x, double /*load*/, bool /*slips*/,
             bool derivatives, ElementForce& out) const override {
    out.set_linear(0, x, derivatives);
  }
  std::vector<Reading> readings() const override { return {{"T_max", true}, {"slip"}}; }
  std::vector<MotionNumber> read(std::span<const int> /*orders*/, const HarmonicVector& x, double /*load*/,
                                 bool /*slips*/, bool /*derivatives*/) const override {
    return std::vector<MotionNumber>(2, {0, HarmonicVector::Zero(x.size()), 0, 0});
  }
  VaryingStiffness stiffness_in_time(std::span<const int> /*orders*/,
                                     const HarmonicVector& /*x*/) const override {
    return {{0}};
  }
  DisturbedLaw disturbed(std::span<const int> /*orders*/, const HarmonicVector& /*x*/, double /*load*/,
                         bool /*slips*/) const override {
    return DisturbedLaw::constant(Matrix::Zero(1, 1));
  }
  bool in_two_phases(const TwoPhases& phases, double /*load*/, const ComplexVector& /*x*/, double /*ratio*/,
                     bool /*derivatives*/, LineForce& out) const override {
    phases.rest(out);
    return true;
  }
  double threshold(double load) const override { return never_slips * load; }
  double threshold_by_log_load() const override { return 1; }

 private:
  void second(const ElementForce& /*at*/, std::span<const int> /*orders*/, const HarmonicVector& /*x*/,
              double /*load*/, bool /*slips*/, const Way& /*way*/, ElementForce& /*change*/) const override {}

  double reference_;
};

}  // namespace arcslip
