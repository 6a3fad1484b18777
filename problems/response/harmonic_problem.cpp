#include "arcslip/problems/response/harmonic_problem.hpp"

#include <cmath>
#include <stdexcept>

#include "arcslip/problems/response/contact_problem.hpp"

namespace arcslip::problems {

/// Forces of all elements with what they were found for: work space of a thread.
struct HarmonicProblem::Forces {
  std::vector<int> orders;
  Vector unknowns;
  Vector parameters;
  continuation::Regime regime;
  std::vector<ElementForce> of_elements;
};

HarmonicProblem::HarmonicProblem(HarmonicSystem system, Layout layout)
    : system_(std::move(system)), coordinates_(system_), layout_(layout) {
  check(system_);
  if (system_.orders.front() != 1) throw std::invalid_argument("HarmonicProblem: the first harmonic is 1");
}

bool HarmonicProblem::contacts_stick(const continuation::Regime& regime) const {
  for (Index i = 0; i < contacts(); ++i) {
    if (slips(regime, i)) return false;
  }
  return true;
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
  last.orders = system_.orders;
  last.unknowns = u;
  last.parameters = p;
  last.regime = regime;
  last.of_elements.resize(at(coordinates_.elements()));
  for (Index e = 0; e < coordinates_.elements(); ++e) {
    ElementForce& force = last.of_elements[at(e)];
    with_element(e, u, p, [&](const Element& element) {
      element.force(system_.orders, element_motion(u, p, e), load(e, u, p), slips(regime, e), derivatives,
                    force);
    });
    if (const double factor = force_factor(e, u, p); factor != 1) force.scale(factor, derivatives);
  }
  return last.of_elements;
}

/// Known where the forces were last found, as at each point that a corrector ends on; else null.
const Swing* HarmonicProblem::known_swing(const Vector& u, const Vector& p, Index element) const {
  const Forces& last = last_forces();
  return slips(last.regime, element) && last.orders == system_.orders && last.unknowns == u &&
                 last.parameters == p
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
  const double h = system_.orders[at(order)];
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
    static_cast<ContactReceptance&>(response) = structure.at(h * eta);
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

/// What is known of one point, with the gradient of what is asked of it.
class HarmonicProblem::Observation {
 public:
  Observation(const HarmonicProblem& problem, const Vector& u, const Vector& p,
              const continuation::Regime& regime, continuation::Gradient* gradient)
      : problem_(problem),
        system_(problem.system_),
        u_(u),
        p_(p),
        regime_(regime),
        gradient_(gradient),
        elements_(problem.forces(u, p, regime, gradient != nullptr)) {}

  /// A quantity; its gradient is added.
  double value(const Quantity& quantity) {
    switch (quantity.measure) {
      case Measure::frequency: return plain(problem_.layout_.eta);
      case Measure::damping: return plain(problem_.layout_.damping);
      case Measure::threshold: return threshold(quantity.which, 1);
      case Measure::ratio: return ratio(quantity.which);
      case Measure::amplitude: return amplitude(quantity, 1);
      case Measure::mean: return mean(quantity);
      case Measure::lag: return lag_of(quantity);
      case Measure::dissipated: return dissipated(quantity.which);
      case Measure::greatest: return greatest(quantity.of);
      case Measure::force: return problem_.synthesised_force(u_, p_, regime_);
      case Measure::reading: return elements_[at(quantity.which)].readings[at(quantity.order)];
    }
    return 0;
  }

 private:
  double plain(const Place& place) {
    add(place, 1);
    return problem_.value(place, u_, p_);
  }

  /// S of a contact, with so much of its gradient.
  double threshold(Index contact, double part) {
    const double S = problem_.slip_threshold(contact, u_, p_);
    add_log_load(part * S, contact);
    return S;
  }

  double ratio(Index contact) {
    const double R = std::abs(phasor(Body::contact, contact, 0));
    const double S = problem_.slip_threshold(contact, u_, p_);
    if (gradient_ != nullptr) {
      amplitude({"", Measure::amplitude, Body::contact, contact, 0}, 1 / S);
      threshold(contact, -R / (S * S));
    }
    return R / S;
  }

  /// Of what is zero but for rounding the gradient is zero, the mean of those all around.
  double amplitude(const Quantity& quantity, double part) {
    constexpr double rounding = 1e-15;
    const Complex z = phasor(quantity.of, quantity.which, quantity.order);
    const double size = std::abs(z);
    if (size > rounding * u_.norm()) add(quantity.of, quantity.which, quantity.order, part / size * z);
    return size;
  }

  double mean(const Quantity& quantity) {
    add(quantity.of, quantity.which, quantity.order, 1);
    return phasor(quantity.of, quantity.which, quantity.order).real();
  }

  double lag_of(const Quantity& quantity) {
    const Complex z = phasor(quantity.of, quantity.which, quantity.order);
    if (z != 0.0) add(quantity.of, quantity.which, quantity.order, Complex(0, -1) / std::conj(z));
    return lag(z);
  }

  /// E/(k S^2) of a contact, E = pi sum_h h Im(f_h conj(x_h)), since x has no other harmonics.
  double dissipated(Index contact) {
    const double S = problem_.slip_threshold(contact, u_, p_);
    const double unit = problem_.reference_stiffness(contact, u_, p_) * S * S;
    const ElementForce& element = elements_[at(contact)];
    if (gradient_ != nullptr) {
      const HarmonicVector x = problem_.motion(u_, p_, contact);
      for (Index a = 0; a < problem_.harmonics(); ++a) {
        const Complex per = Complex(0, pi * system_.orders[at(a)] / unit);
        add_force(contact, a, per * x(a));
        add_motion(contact, a, -per * element.harmonics(a));
      }
      threshold(contact, -2 * element.energy / (unit * S));
      add_log_force(contact, -element.energy / unit);
    }
    return element.energy / unit;
  }

  /// The greatest value in time, which changes as the value at its own time.
  double greatest(Body of) {
    HarmonicVector motion(problem_.harmonics());
    for (Index a = 0; a < motion.size(); ++a) motion(a) = phasor(of, 0, a);
    const Swing swing = Swing::of(system_.orders, motion);
    for (Index a = 0; a < motion.size() && gradient_ != nullptr; ++a)
      add(of, 0, a, swing.peak_by(system_.orders[at(a)]));
    return swing.peak();
  }

  /// One harmonic of a motion: of the base y = u - x.
  Complex phasor(Body of, Index which, Index order) {
    if (of == Body::contact) return problem_.motion(u_, p_, which)(order);
    const Row row = row_of(of, which, order);
    Complex z = row.times(row.response.compliance);
    if (of == Body::output) z += row.response.free(row.index);
    if (of == Body::base) z -= problem_.motion(u_, p_, which)(order);
    return z;
  }

  /// Adds Re(conj(weight) dz) of that harmonic.
  void add(Body of, Index which, Index order, Complex weight) {
    if (gradient_ == nullptr) return;
    if (of == Body::contact) return add_motion(which, order, weight);
    if (of == Body::base) add_motion(which, order, -weight);
    const Row row = row_of(of, which, order);
    Complex by_eta = row.times(row.response.compliance_eta);
    if (of == Body::output) by_eta += row.response.free_eta(row.index);
    add(problem_.layout_.eta, std::real(std::conj(weight) * by_eta));
    if (problem_.layout_.damping.of != Place::nowhere)
      add(problem_.layout_.damping, std::real(std::conj(weight) * row.times(row.response.by_damping)));
    if (problem_.is_varied()) {
      Complex by_varied = row.times(row.response.by_varied);
      if (of == Body::output) by_varied += row.response.free_by_varied(row.index);
      add(problem_.layout_.varied, std::real(std::conj(weight) * by_varied));
    }
    for (Index j = 0; j < problem_.coordinates(); ++j) {
      const double share = problem_.coordinates_[j].push(row.is_base);
      if (share == 0) continue;
      const Complex c = row.response.compliance(row.index, problem_.coordinates_[j].dof);
      add_force(j, order, -share * std::conj(c) * weight);
    }
  }

  void add_motion(Index coordinate, Index order, Complex weight) {
    const Index place = 2 * (coordinate * problem_.harmonics() + order);
    add(problem_.place_of(place), weight.real());
    add(problem_.place_of(place + 1), weight.imag());
  }

  void add_force(Index coordinate, Index order, Complex weight) {
    const Index of = problem_.coordinates_.element_of(coordinate);
    const Index first = problem_.coordinates_.first(of);
    const Index row = problem_.place(coordinate, order);
    const ElementForce& element = elements_[at(of)];
    const Complex w = std::conj(weight);
    for (Index b = 0; b < element.linear.cols(); ++b) {
      const Complex linear = w * element.linear(row, b);
      const Complex conjugate = w * element.conjugate(row, b);
      add_motion(first + b / problem_.harmonics(), b % problem_.harmonics(),
                 {std::real(linear + conjugate), -std::imag(linear - conjugate)});
    }
    add_log_load(std::real(w * element.by_log_load(row)), of);
    add_log_force(of, std::real(w * element.harmonics(row)));
    if (element.by_setting.size() > 0) add(problem_.layout_.varied, std::real(w * element.by_setting(row)));
  }

  /// What is `value` times a change of the logarithm of the factor on a force.
  void add_log_force(Index element, double value) {
    if (!problem_.is_varied()) return;
    add(problem_.layout_.varied, value * problem_.log_force_rate(element, problem_.variation(u_, p_)));
  }

  void add_log_load(double value, Index element) {
    if (gradient_ != nullptr) problem_.add_log_load(value, element, u_, p_, *gradient_);
  }
  void add(const Place& place, double value) {
    if (gradient_ != nullptr) HarmonicProblem::add(place, value, *gradient_);
  }

  /// The row of a structure's compliance that a motion of damper or output is, found once for quantities that
  /// follow one another, and the forces on it.
  struct Row {
    const Response& response;
    bool is_base;
    Index index;
    ContactVector forces;

    Complex times(const ContactMatrix& compliance) const {
      return (compliance.row(index).head(forces.size()) * forces).value();
    }
  };
  Row row_of(Body of, Index which, Index order) {
    const ContactOutput* output = of == Body::output ? &system_.outputs[at(which)] : nullptr;
    const ContactModes* structure = output != nullptr ? &output->modes : &system_.damper[at(order)];
    const bool is_base = output != nullptr && output->on_base;
    if (structure != responded_) problem_.respond(*structure, is_base, order, u_, p_, response_);
    responded_ = structure;
    return {response_, is_base, output != nullptr ? problem_.contacts() : which,
            problem_.coordinates_.forces_on(is_base, elements_, order, problem_.harmonics())};
  }

  const HarmonicProblem& problem_;
  const HarmonicSystem& system_;
  const Vector& u_;
  const Vector& p_;
  continuation::Regime regime_;
  continuation::Gradient* gradient_;
  const std::vector<ElementForce>& elements_;
  const ContactModes* responded_ = nullptr;
  Response response_;
};

double HarmonicProblem::border(const Vector& u, const Vector& p, const continuation::Regime& regime,
                               int border, continuation::Gradient* gradient) const {
  const StateBorder at_border = with_element(border, u, p, [&](const Element& element) {
    return element.border(system_.orders, element_motion(u, p, border), known_swing(u, p, border),
                          load(border, u, p), slips(regime, border));
  });
  if (gradient == nullptr) return at_border.value;
  gradient->unknowns.setZero();
  gradient->parameters.setZero();
  for (Index a = 0; a < at_border.by_motion.size(); ++a) {
    const Index place = 2 * (coordinates_.first(border) * harmonics() + a);
    add(place_of(place), at_border.by_motion(a).real(), *gradient);
    add(place_of(place + 1), at_border.by_motion(a).imag(), *gradient);
  }
  add_log_load(at_border.by_log_load, border, u, p, *gradient);
  if (first(border).varied) add(layout_.varied, at_border.by_setting, *gradient);
  return at_border.value;
}

std::vector<continuation::Observable> HarmonicProblem::observables() const {
  std::vector<continuation::Observable> all;
  for (const Quantity& quantity : quantities_) {
    const bool is_lag = quantity.measure == Measure::lag;
    const bool by_solves =
        quantity.of == Body::output && !is_lag && system_.outputs[at(quantity.which)].modes.is_solved();
    const bool has_gradient =
        quantity.measure != Measure::force && quantity.measure != Measure::reading && !by_solves;
    all.push_back({quantity.name, has_gradient});
    if (is_lag) all.back() = angle(quantity.name);
  }
  return all;
}

void HarmonicProblem::observe(const Vector& u, const Vector& p, const continuation::Regime& regime,
                              Vector& values) const {
  values.resize(std::ssize(quantities_));
  Observation at_point(*this, u, p, regime, nullptr);
  for (std::size_t i = 0; i < quantities_.size(); ++i)
    values(static_cast<Index>(i)) = at_point.value(quantities_[i]);
}

double HarmonicProblem::observe(const Vector& u, const Vector& p, const continuation::Regime& regime,
                                Index which, continuation::Gradient& gradient) const {
  gradient.unknowns.setZero();
  gradient.parameters.setZero();
  return Observation(*this, u, p, regime, &gradient).value(quantities_[at(which)]);
}

double HarmonicProblem::synthesised_force(const Vector& /*u*/, const Vector& /*p*/,
                                          const continuation::Regime& /*regime*/) const {
  return 0;
}

}  // namespace arcslip::problems
