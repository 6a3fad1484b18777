#include "arcslip/problems/response/harmonic_problem.hpp"

#include <cmath>
#include <stdexcept>

namespace arcslip::problems {

HarmonicProblem::HarmonicProblem(HarmonicSystem system, Layout layout)
    : system_(std::move(system)), coordinates_(system_), rigid_(system_, coordinates_), layout_(layout) {
  check(system_);
  if (system_.periods() < 1)
    throw std::invalid_argument("HarmonicProblem: the first harmonic is that of eta");
  find_drifts();
}

bool HarmonicProblem::contacts_stick(const continuation::Regime& regime) const {
  for (Index i = 0; i < contacts(); ++i) {
    if (slips(regime, i)) return false;
  }
  return true;
}

continuation::Regime HarmonicProblem::at_rest(const Vector& u, const Vector& p) const {
  continuation::Regime regime;
  for (Index e = 0; e < switch_count(); ++e) {
    if (coordinates_.element(e).rests_beyond(load(e, u, p))) regime = regime.with(static_cast<int>(e), 1);
  }
  return regime;
}

HarmonicProblem::Forces& HarmonicProblem::last_forces() {
  thread_local Forces last;
  return last;
}

HarmonicVector HarmonicProblem::motion(const Vector& u, const Vector& p, Index coordinate) const {
  HarmonicVector x(harmonics());
  for (Index a = 0; a < harmonics(); ++a) {
    const Index place = 2 * (coordinate * harmonics() + a);
    x(a) = place == 0 ? Complex(value(layout_.real, u, p), value(layout_.imaginary, u, p))
                      : Complex(u(place), u(place + 1));
  }
  return x;
}

HarmonicVector HarmonicProblem::element_motion(const Vector& u, const Vector& p, Index element) const {
  const Index first = coordinates_.first(element);
  const Index count = coordinates_.element(element).coordinates();
  if (count == 1) return motion(u, p, first);
  HarmonicVector x(count * harmonics());
  for (Index i = 0; i < count; ++i) x.segment(i * harmonics(), harmonics()) = motion(u, p, first + i);
  return x;
}

const std::vector<ElementForce>& HarmonicProblem::forces(const Vector& u, const Vector& p,
                                                         const continuation::Regime& regime,
                                                         bool derivatives) const {
  Forces& last = last_forces();
  last.of = this;
  last.orders = system_.orders;
  last.unknowns = u;
  last.parameters = p;
  last.regime = regime;
  last.of_elements.resize(at(coordinates_.elements()));
  for (Index e = 0; e < coordinates_.elements(); ++e) {
    ElementForce& force = last.of_elements[at(e)];
    with_element(e, u, p, [&](const Element& element) {
      const HarmonicVector x = element_motion(u, p, e);
      element.force(system_.orders, x, load(e, u, p), slips(regime, e), derivatives, force);
      force.by_eta.resize(0);
      if (const auto viscous = viscous_of(element, u, p)) force.add(*viscous, x, derivatives);
    });
    if (const double factor = force_factor(e, u, p); factor != 1) force.scale(factor, derivatives);
  }
  return last.of_elements;
}

std::optional<ElementForce::Viscous> HarmonicProblem::viscous_of(const Element& element, const Vector& u,
                                                                 const Vector& p) const {
  const Jet damping = element.damping();
  if (damping.value == 0 && damping.first == 0) return std::nullopt;
  return ElementForce::Viscous{damping, frequency(u, p), system_.periods(), system_.orders};
}

/// Found anew unless it was the last that was found, as at each point that a corrector ends on.
const ElementForce& HarmonicProblem::force_of(Index element, const Vector& u, const Vector& p,
                                              const continuation::Regime& regime) const {
  const Forces& last = last_forces();
  const bool is_known = last.of == this && last.unknowns.size() == u.size() && last.unknowns == u &&
                        last.parameters == p && last.regime == regime;
  return (is_known ? last.of_elements : forces(u, p, regime, false))[at(element)];
}

/// Known where the forces were last found, as at each point that a corrector ends on; else null.
const Swing* HarmonicProblem::known_swing(const Vector& u, const Vector& p, Index element) const {
  const Forces& last = last_forces();
  return slips(last.regime, element) && last.orders == system_.orders && last.unknowns.size() == u.size() &&
                 last.unknowns == u && last.parameters == p
             ? &last.of_elements[at(element)].swing
             : nullptr;
}

/// What the damping of the layout makes of a structure, and the rates by it and, of what varies it, through
/// it.
void HarmonicProblem::set_damping(bool is_base, const Vector& u, const Vector& p, Variation& here,
                                  Variation& by_varied, Variation& by_damping) const {
  const double zeta = value(layout_.damping, u, p);
  by_damping = Variation::none();
  if (!layout_.of_base) {
    by_damping.loss = {.mass = 1};
    here.loss = here.loss + Loss{.mass = -2 * zeta * frequency(u, p)};
  } else if (is_base) {
    Loss per_zeta = system_.base_loss_per_zeta;
    if (is_varied()) {
      const auto [at, rate] = variation(u, p);
      by_varied.loss = {.viscous = zeta * per_zeta.viscous * rate.base_viscous};
      per_zeta.viscous *= at.base_viscous;
    }
    by_damping.loss = per_zeta;
    here.loss = system_.base_loss_fixed + zeta * per_zeta;
  }
}

void HarmonicProblem::respond(const ContactModes& structure, bool is_base, Index order, const Vector& u,
                              const Vector& p, Response& response) const {
  const double h = system_.multiple(order);
  const double eta = frequency(u, p);
  const bool is_damped = layout_.damping.of != Place::nowhere;
  Variation here{.loss = structure.loss()};
  Variation by_varied = Variation::none();
  if (is_varied()) {
    const SystemParameter::At varied = variation(u, p);
    here = is_base ? varied.here.base : varied.here.damper;
    by_varied = is_base ? varied.rate.base : varied.rate.damper;
  }
  if (!is_damped && !is_varied()) {
    response.set_zero(structure.contacts());
    structure.add(h * eta, response);
    response.compliance_eta *= h;
    response.free_eta *= h;
    return;
  }
  Variation by_damping;
  if (is_damped) set_damping(is_base, u, p, here, by_varied, by_damping);
  const VariedReceptance found = structure.varied(h * eta, here, is_varied() ? by_varied : by_damping);
  static_cast<ContactReceptance&>(response) = found;
  response.compliance_eta *= h;
  response.free_eta *= h;
  response.by_varied = found.compliance_rate;
  response.free_by_varied = found.free_rate;
  if (!is_damped) return;
  const ContactMatrix by_loss =
      is_varied() ? structure.varied(h * eta, here, by_damping).compliance_rate : found.compliance_rate;
  if (!layout_.of_base) response.compliance_eta -= 2 * value(layout_.damping, u, p) * by_loss;
  response.by_damping = (layout_.of_base ? 1.0 : -2 * eta) * by_loss;
}

double HarmonicProblem::varied_scale(const Vector& u, const Vector& p) const {
  return system_.varied->scale(value(layout_.varied, u, p), value(layout_.preload, u, p), frequency(u, p));
}

HarmonicProblem::Place HarmonicProblem::place_of(Index unknown) const {
  if (unknown > 1) return {Place::unknowns, unknown};
  return unknown == 0 ? layout_.real : layout_.imaginary;
}

void HarmonicProblem::add(const Place& place, double value, continuation::Gradient& gradient) {
  if (place.of == Place::nowhere) return;
  (place.of == Place::unknowns ? gradient.unknowns : gradient.parameters)(place.index) += value;
}

void HarmonicProblem::add_log_load(double value, Index element, const Vector& u, const Vector& p,
                                   continuation::Gradient& gradient) const {
  const double by_load = value / pressing(u, p);
  add(layout_.preload, by_load, gradient);
  add(layout_.eta, 2 * growth(u, p) * frequency(u, p) * by_load, gradient);
  if (is_varied()) add(layout_.varied, value * log_load_rate(element, u, p), gradient);
}

int HarmonicProblem::crossed_border(const continuation::Guess& at) const {
  constexpr double rounding = 1e-12;
  return continuation::crossed_border(*this, at.unknowns, at.parameters, at.regime, rounding);
}

double HarmonicProblem::border(const Vector& u, const Vector& p, const continuation::Regime& regime,
                               int border, continuation::Gradient* gradient) const {
  const MotionNumber at_border = with_element(border, u, p, [&](const Element& element) {
    return element.border(system_.orders, element_motion(u, p, border), known_swing(u, p, border),
                          load(border, u, p), slips(regime, border));
  });
  if (gradient == nullptr) return at_border.value;
  gradient->unknowns.setZero();
  gradient->parameters.setZero();
  add(at_border, border, u, p, *gradient);
  return at_border.value;
}

/// A number of an element, with all its derivatives.
void HarmonicProblem::add(const MotionNumber& number, Index element, const Vector& u, const Vector& p,
                          continuation::Gradient& gradient) const {
  for (Index a = 0; a < number.by_motion.size(); ++a) {
    const Index place = 2 * (coordinates_.first(element) * harmonics() + a);
    add(place_of(place), number.by_motion(a).real(), gradient);
    add(place_of(place + 1), number.by_motion(a).imag(), gradient);
  }
  add_log_load(number.by_log_load, element, u, p, gradient);
  if (first(element).varied) add(layout_.varied, number.by_setting, gradient);
}

double HarmonicProblem::synthesised_force(const Vector& /*u*/, const Vector& /*p*/,
                                          const continuation::Regime& /*regime*/) const {
  return 0;
}

}  // namespace arcslip::problems
