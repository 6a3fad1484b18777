// f = c dx/dt, in the time of the structure's masses.

#include "arcslip/elements/element_kind.hpp"
#include "arcslip/elements/two_phases.hpp"

namespace arcslip {
namespace {

class Dashpot final : public Element {
 public:
  Dashpot(const Jet& damping, double reference) : damping_(damping), reference_(reference) {}

  double reference_stiffness(Index /*coordinate*/ = 0) const override { return reference_; }
  void force(std::span<const int> /*orders*/, const HarmonicVector& x, double /*load*/, bool /*beyond*/,
             bool derivatives, ElementForce& out) const override {
    out.set_linear(0, x, derivatives);
  }
  bool dissipates() const override { return true; }
  bool holds_mean(Index /*coordinate*/, bool /*beyond*/) const override { return false; }
  Jet damping() const override { return damping_; }
  bool in_two_phases(const TwoPhases& phases, double /*load*/, const ComplexVector& /*x*/, double /*ratio*/,
                     bool /*derivatives*/, LineForce& out) const override {
    phases.rest(out);
    return true;
  }
  bool is_told_by_law() const override { return true; }
  DisturbedLaw disturbed(std::span<const int> /*orders*/, const HarmonicVector& /*x*/, double /*load*/,
                         bool /*beyond*/) const override {
    DisturbedLaw law = DisturbedLaw::constant(Matrix::Zero(1, 1));
    law.viscous = two_pi * damping_.value;
    return law;
  }

 private:
  void second(const ElementForce& /*at*/, std::span<const int> /*orders*/, const HarmonicVector& /*x*/,
              double /*load*/, bool /*beyond*/, const Way& /*way*/, ElementForce& /*change*/) const override {
  }

  Jet damping_;
  double reference_;
};

}  // namespace

ElementKind dashpot_element() {
  ElementKind kind{"dashpot",
                   "a damper of force c dx/dt, in units of damping matrices",
                   {{given_positive("damping", "c"), true}},
                   [](const ElementKind::Values& values) {
                     return std::make_shared<Dashpot>(values.settings[0] * (values.rate / two_pi),
                                                      values.usual_stiffness);
                   }};
  return kind;
}

}  // namespace arcslip
