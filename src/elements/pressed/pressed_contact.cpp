#include "arcslip/elements/pressed/pressed_contact.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "arcslip/elements/element.hpp"
#include "arcslip/motion/swing.hpp"
#include "elements/pressed/arc_sums.hpp"

namespace arcslip {
namespace {

using Phase = PressedArcs::Phase;

/// What integrals over the arcs are needed for.
class PressedIntegrals {
 public:
  PressedIntegrals(const PressedSettings& settings, std::span<const int> orders,
                   const PeriodicMotion& sliding, const PeriodicMotion& closing,
                   std::span<const PressedArcs::Arc> arcs, PressedArcs::Course course)
      : settings_(settings),
        orders_(orders),
        sliding_(sliding),
        closing_(closing),
        press_(pressing_motion(settings, closing)),
        arcs_(arcs),
        stick_(2 * sliding.highest()),
        slip_(2 * sliding.highest()),
        touch_(2 * sliding.highest()) {
    for (const PressedArcs::Arc& arc : arcs_) {
      if (arc.phase == Phase::apart) continue;
      const ArcSums own(2 * sliding.highest(), arc.begin, arc.width);
      touch_.add(own);
      if (arc.phase == Phase::slip) {
        slip_.add(own, arc.direction);
      } else {
        stick_.add(own);
        held_.push_back({arc, own.harmonics(one_, orders)});
        if (course == PressedArcs::Course::drifts)
          ramps_.push_back(ramp_harmonics(arc.begin, arc.width, orders));
      }
    }
    stuck_ = stick_.harmonics(sliding, orders);
    for (const ComplexVector& ramp : ramps_) stuck_ += sliding.drift() * ramp;
    slipped_ = slip_.harmonics(press_, orders);
  }

  void forces(PressedForce& out) const {
    out.tangential = settings_.tangential_stiffness * stuck_ + settings_.friction * slipped_;
    for (const auto& [arc, constant] : held_) out.tangential -= arc.offset * constant;
    out.normal = touch_.harmonics(press_, orders_);
    out.slip_fraction = fraction_of(arcs_, Phase::slip);
    out.apart_fraction = fraction_of(arcs_, Phase::apart);
  }

  void by_motions(PressedForce& out) const {
    const double k = settings_.tangential_stiffness;
    out.tangential_by_sliding = stick_.derivative(orders_, k);
    out.tangential_by_closing = slip_.derivative(orders_, settings_.friction);
    for (const auto& [arc, constant] : held_) {
      if (!arc.is_set) continue;
      ComplexVector turns(std::ssize(orders_));
      for (std::size_t a = 0; a < orders_.size(); ++a)
        turns(static_cast<Index>(a)) = std::polar(0.5, orders_[a] * arc.anchor);
      add_product(out.tangential_by_sliding, -k, constant, turns);
      add_product(out.tangential_by_closing, -arc.by_press, constant, turns);
    }
    if (!ramps_.empty()) by_drift(out);
    out.normal_by_closing = touch_.derivative(orders_, settings_.normal_stiffness);
    out.tangential_by_closing.linear *= settings_.normal_stiffness;
    out.tangential_by_closing.conjugate *= settings_.normal_stiffness;
  }

  void by_settings(PressedForce& out) const {
    const double mu = settings_.friction;
    auto& by = out.tangential_by;
    by[PressedForce::friction] = slipped_;
    by[PressedForce::tangential_stiffness] = stuck_;
    by[PressedForce::normal_stiffness] = mu * slip_.harmonics(closing_, orders_);
    by[PressedForce::normal_force] = mu * slip_.harmonics(one_, orders_);
    for (const auto& [arc, constant] : held_) {
      if (!arc.is_set) continue;
      const double slid = sliding_.value(arc.anchor);
      if (!arc.was_apart) {  // A = k_t r -+ mu n
        const double press = press_.value(arc.anchor);
        by[PressedForce::friction] -= (mu > 0 ? arc.by_press / mu * press : 0) * constant;
      }
      by[PressedForce::tangential_stiffness] -= slid * constant;
      by[PressedForce::normal_stiffness] -= arc.by_press * closing_.value(arc.anchor) * constant;
      by[PressedForce::normal_force] -= arc.by_press * constant;
    }
    out.normal_by.fill(ComplexVector::Zero(std::ssize(orders_)));
    out.normal_by[PressedForce::normal_stiffness] = touch_.harmonics(closing_, orders_);
    out.normal_by[PressedForce::normal_force] = touch_.harmonics(one_, orders_);
  }

 private:
  /// An arc of stick and the harmonics of 1 over it.
  struct Held {
    PressedArcs::Arc arc;
    ComplexVector constant;
  };

  /// By the imaginary part of r_0, in whose columns the two derivatives then differ.
  void by_drift(PressedForce& out) const {
    const Index mean = place_of_mean(orders_);
    ComplexVector rate = ComplexVector::Zero(std::ssize(orders_));
    for (std::size_t i = 0; i < held_.size(); ++i)
      rate += settings_.tangential_stiffness * (ramps_[i] - held_[i].arc.anchor * held_[i].constant);
    out.tangential_by_sliding.linear.col(mean) -= Complex(0, 0.5) * rate;
    out.tangential_by_sliding.conjugate.col(mean) += Complex(0, 0.5) * rate;
  }

  const PressedSettings& settings_;
  std::span<const int> orders_;
  const PeriodicMotion& sliding_;
  const PeriodicMotion& closing_;
  PeriodicMotion one_{ComplexVector::Ones(1)};
  PeriodicMotion press_;
  std::span<const PressedArcs::Arc> arcs_;
  ArcSums stick_;
  ArcSums slip_;  // with the direction of slip as sign
  ArcSums touch_;
  std::vector<Held> held_;
  std::vector<ComplexVector> ramps_;  // of theta over each of these, where it drifts
  ComplexVector stuck_;               // of r where it sticks
  ComplexVector slipped_;             // of N where it slips, with that sign
};

}  // namespace

PeriodicMotion sliding_motion(std::span<const int> orders, const ComplexVector& sliding,
                              PressedArcs::Course course) {
  const PeriodicMotion motion(orders, sliding, highest_order(orders));
  if (course != PressedArcs::Course::drifts) return motion;
  return motion.drifting(sliding(place_of_mean(orders)).imag());
}

PressedForce pressed_force(const PressedSettings& settings, std::span<const int> orders,
                           const ComplexVector& sliding, const ComplexVector& closing, bool derivatives,
                           std::span<const PressedArcs::Arc> arcs, PressedArcs::Course course) {
  const PeriodicMotion slides = sliding_motion(orders, sliding, course);
  const PeriodicMotion closes(orders, closing, highest_order(orders));
  const PressedIntegrals integrals(settings, orders, slides, closes, arcs, course);
  PressedForce out;
  integrals.forces(out);
  out.energy = cycle_energy(orders, out.tangential, sliding);
  if (slides.drift() != 0)
    out.energy += two_pi * slides.drift() * out.tangential(place_of_mean(orders)).real();
  if (!derivatives) return out;
  integrals.by_motions(out);
  integrals.by_settings(out);
  return out;
}

PressedForce pressed_force(const PressedSettings& settings, std::span<const int> orders,
                           const ComplexVector& sliding, const ComplexVector& closing, bool derivatives,
                           PressedArcs::Course course) {
  if (orders.empty()) throw std::invalid_argument("pressed_force: no harmonics");
  const PressedArcs found(settings, sliding_motion(orders, sliding, course),
                          PeriodicMotion(orders, closing, highest_order(orders)), course);
  PressedForce out = pressed_force(settings, orders, sliding, closing, derivatives, found.arcs(), course);
  if (course != PressedArcs::Course::drifts) out.further_slips = found.further_slips();
  return out;
}

}  // namespace arcslip
