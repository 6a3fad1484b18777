#include "arcslip/problems/response/nonlinear_mode.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace arcslip::problems {

NonlinearMode::NonlinearMode(HarmonicSystem system)
    : FreeVibration(std::move(system), {.eta = {Place::unknowns, Unknown::frequency},
                                        .preload = {Place::parameters, preload},
                                        .real = {Place::parameters, Parameter::amplitude},
                                        .damping = {Place::unknowns, Unknown::damping}}) {
  quantities_ = {{"eta", Measure::frequency},
                 {"zeta", Measure::damping},
                 {"S", Measure::threshold},
                 {"R_over_S", Measure::ratio},
                 {"Y", Measure::amplitude, Body::base},
                 {"U", Measure::amplitude, Body::damper},
                 {"dissipated", Measure::dissipated},
                 {"force", Measure::force}};
  if (system_.varied) layout_.varied = {Place::parameters, further};
  add_readings(0, "");
  add_further_contacts();
  add_further_elements();
  add_other_harmonics();
  add_drifts();
}

void NonlinearMode::scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const {
  constexpr double small_ratio = 1e-4;  // a damping ratio that crosses zero has no size of its own
  unknowns.setConstant(length(u, p));
  unknowns(Unknown::frequency) = u(Unknown::frequency);
  unknowns(Unknown::damping) = std::max(std::abs(u(Unknown::damping)), small_ratio);
  parameters = p;
  if (is_varied()) parameters(further) = varied_scale(u, p);
}

double NonlinearMode::synthesised_force(const Vector& u, const Vector& p,
                                        const continuation::Regime& regime) const {
  const Modal mode = modal(u, p, regime);
  return 2 * u(Unknown::damping) * std::pow(u(Unknown::frequency), 2) * mode.amplitude / mode.load;
}

NonlinearMode::Modal NonlinearMode::modal(const Vector& u, const Vector& p,
                                          const continuation::Regime& regime) const {
  const std::vector<ElementForce>& elements = forces(u, p, regime, false);
  const double mass = -2 * u(Unknown::damping) * u(Unknown::frequency);
  double square = 0;
  Complex load = 0;
  const auto add = [&](const ContactModes& structure, bool is_base) {
    ContactVector on_dofs;
    coordinates_.forces_on(is_base, elements, 0, on_dofs);
    for (const ContactMode& mode : structure.modes()) {
      const Complex d = ModalDenominator(u(Unknown::frequency), mode.frequency,
                                         structure.loss() + Loss{.mass = mass}, mode.influence)
                            .value;
      const Complex q = mode.shape.dot(on_dofs) / d;
      square += std::norm(q);
      load += std::conj(q) * mode.load;
    }
  };
  add(system_.base[0], true);
  add(system_.damper[0], false);
  return {std::sqrt(square), std::abs(load) / std::sqrt(square)};
}

std::optional<std::array<double, 2>> NonlinearMode::flanks(const Vector& u, const Vector& p,
                                                           const continuation::Regime& regime,
                                                           double force_value) const {
  const Modal mode = modal(u, p, regime);
  const double square = u(Unknown::frequency) * u(Unknown::frequency);
  const double middle = square * (1 - 2 * u(Unknown::damping) * u(Unknown::damping));
  const double width =
      std::pow(force_value * mode.load / mode.amplitude, 2) - (square - middle) * (square + middle);
  if (!(width >= 0) || std::sqrt(width) > middle) return std::nullopt;
  return std::array{std::sqrt(middle - std::sqrt(width)), std::sqrt(middle + std::sqrt(width))};
}

continuation::Guess NonlinearMode::guess(double eta_value, const Vector& parameters,
                                         const continuation::TraceOptions& limits) const {
  if (is_varied()) {
    const NonlinearMode fixed(at_value(system_, parameters(further)));
    continuation::Guess guess = fixed.guess(eta_value, parameters.head<2>(), limits);
    guess.parameters = parameters;
    return guess;
  }
  continuation::TraceOptions options;
  options.parameter = "R";
  options.to = parameters(amplitude);
  options.max_points = 10000;
  options.max_seconds = limits.max_seconds;
  options.go_on = limits.go_on;
  constexpr double least = 1e-9;  // of R: so far does a contact not slip at more than the preload lets it
  for (options.from = options.to; options.from > least * options.to; options.from *= 0.1) {
    std::optional<continuation::Guess> stuck;
    try {
      stuck = guess(eta_value, options.from, parameters(preload));
    } catch (const std::invalid_argument&) {
      continue;
    }
    if (options.from == options.to) return *stuck;
    const continuation::Branch branch = trace(*this, *stuck, options);
    if (is_unfinished(branch.stop))
      throw continuation::Unfinished(branch.stop, "on the way from stick: " + branch.explanation);
    if (!branch.complete())
      throw std::invalid_argument("NonlinearMode: no way from stick: " + branch.explanation);
    const continuation::BranchPoint& end = branch.points.back();
    return {end.unknowns, end.parameters, end.regime};
  }
  return guess(eta_value, parameters(amplitude), parameters(preload));
}

std::vector<JoinedMode> NonlinearMode::small_modes(double eta_value, double R_value,
                                                   double preload_value) const {
  Vector u = Vector::Constant(size(), R_value);
  u(Unknown::frequency) = eta_value;
  const Vector p = Eigen::Vector2d(R_value, preload_value);
  const continuation::Regime regime = at_rest(u, p);
  Vector springs(coordinates_.size());
  springs.head(contacts()) = contact_springs(system_.contacts);
  for (Index j = contacts(); j < springs.size(); ++j) {
    const Index e = coordinates_.element_of(j);
    const Element& element = coordinates_.element(e);
    HarmonicVector x = HarmonicVector::Zero(element.coordinates() * harmonics());
    for (Index i = 0; i < element.coordinates(); ++i) x(i * harmonics()) = R_value;
    ElementForce pull;
    element.force(system_.orders, x, load(e, u, p), slips(regime, e), true, pull);
    springs(j) = pull.linear(place(j, 0), place(j, 0)).real() * force_factor(e, u, p);
  }
  return joined_modes({&system_.base[0], &system_.damper[0]}, springs,
                      [&](const ContactVector& shape, bool is_base) {
                        ContactVector x(coordinates_.size());
                        for (Index j = 0; j < x.size(); ++j)
                          x(j) = coordinates_[j].move(is_base) * shape(coordinates_[j].dof);
                        return x;
                      });
}

continuation::Guess NonlinearMode::guess(double eta_value, double R_value, double preload_value) const {
  if (!(eta_value > 0 && R_value > 0 && preload_value > 0))
    throw std::invalid_argument("NonlinearMode: eta, R and the preload must be positive");
  std::vector<JoinedMode> modes = small_modes(eta_value, R_value, preload_value);
  constexpr double still = 1e-8;  // of the most that any mode moves it: rounding, as of both moving as one
  double most = 0;
  for (const JoinedMode& mode : modes) most = std::max(most, std::abs(mode.relative(0)));
  std::erase_if(modes, [&](const JoinedMode& mode) { return !(std::abs(mode.relative(0)) > still * most); });
  const auto nearest = std::min_element(modes.begin(), modes.end(), [&](const auto& one, const auto& other) {
    return std::abs(one.frequency - eta_value) < std::abs(other.frequency - eta_value);
  });
  if (nearest == modes.end())
    throw std::invalid_argument("NonlinearMode: there is no mode that moves the first contact");
  continuation::Guess guess{Vector::Zero(size()), Vector(2), 0};
  guess.parameters << R_value, preload_value;
  for (Index i = 1; i < coordinates_.size(); ++i) {
    const Complex x = R_value / nearest->relative(0) * nearest->relative(i);
    guess.unknowns(2 * i * harmonics()) = x.real();
    guess.unknowns(2 * i * harmonics() + 1) = x.imag();
  }
  guess.unknowns(Unknown::frequency) = nearest->frequency;
  guess.unknowns(Unknown::damping) = nearest->damping;
  guess.regime = at_rest(guess.unknowns, guess.parameters);
  if (const int beyond = crossed_border(guess); beyond >= 0) {
    throw std::invalid_argument(fmt::format(
        "NonlinearMode: {} at R = {:g}; begin with a smaller R",
        beyond < contacts()
            ? fmt::format("contact {} slips", beyond + 1)
            : fmt::format("element '{}' is beyond its border", coordinates_[coordinates_.first(beyond)].name),
        R_value));
  }
  return guess;
}

}  // namespace arcslip::problems
