#include "arcslip/interval/interval_response.hpp"

#include <algorithm>
#include <array>

namespace arcslip {
namespace {

constexpr int most_terms = 60;

/// c_k/(k + 3/2), where sqrt(1 - s) = sum c_k s^k.
std::array<Interval, most_terms> segment_coefficients() {
  std::array<Interval, most_terms> values;
  Interval coefficient = 1;
  for (int k = 0; k < most_terms; ++k) {
    if (k > 0) coefficient *= Interval(2 * k - 3) / Interval(2 * k);
    values[static_cast<std::size_t>(k)] = coefficient / Interval(k + 1.5);
  }
  return values;
}

/// (8/pi) int_0^x sqrt(s (1 - s)) ds for x up to 1/2 and a little more. After the first one all terms of the
/// series are negative, and their coefficients fall.
Interval segment_series(const Interval& x) {
  static const std::array<Interval, most_terms> coefficients = segment_coefficients();
  Interval sum = coefficients[0];
  Interval power = x;
  for (std::size_t k = 1;; ++k) {
    const Interval term = coefficients[k] * power;
    if (term.lower() > -1e-17 || k + 1 == most_terms) {
      sum += Interval((term / (Interval(1) - x)).lower(), 0);  // this term and all that follow
      break;
    }
    sum += term;
    power *= x;
  }
  return Interval(8) * inverse_pi() * x * sqrt(x) * sum;
}

/// Re phi in slip, for 0 < x <= 1.
Interval segment_at(double x) {
  if (x <= 0.5) return segment_series(Interval(x));
  const Interval rest = Interval(1) - Interval(x);
  return Interval(1) - segment_series(Interval(std::max(rest.lower(), 0.0), rest.upper()));
}

/// The range of a function that rises up to `top` and falls beyond, or the other way round.
template <class Function>
Interval unimodal(const Function& function, const Interval& x, double top) {
  const Interval range = joined(function(Interval(x.lower())), function(Interval(x.upper())));
  return x.lower() < top && top < x.upper() ? joined(range, function(Interval(top))) : range;
}

/// Slip, for 0 < x <= 1.
EnclosedCoefficient enclose_slip(const Interval& x) {
  const Interval scale = Interval(4) * inverse_pi();
  const Interval low(x.lower());
  const Interval high(x.upper());
  const auto loss = [](const Interval& s) { return s * (Interval(1) - s); };
  const auto loss_slope = [](const Interval& s) { return s * (Interval(1) - Interval(2) * s); };
  const auto stiffness_slope = [&](const Interval& s) {
    const Interval radicand = loss(s);
    return Interval(2) * scale * s *
           sqrt(Interval(std::max(radicand.lower(), 0.0), std::max(radicand.upper(), 0.0)));
  };
  const Interval real_at_low = segment_at(x.lower());
  const Interval real_at_high = segment_at(x.upper());
  Interval slope = joined(real_at_low - stiffness_slope(low), real_at_high - stiffness_slope(high));
  if (x.lower() < 0.5 && 0.5 < x.upper())  // where it is least, 1/2 - 2/pi
    slope = joined(slope, Interval(0.5) - Interval(2) * inverse_pi());
  return {{Interval(real_at_low.lower(), real_at_high.upper()), scale * unimodal(loss, x, 0.5)},
          {-unimodal(stiffness_slope, x, 0.75), -(scale * unimodal(loss_slope, x, 0.25))},
          {slope, scale * square(x)}};
}

}  // namespace

EnclosedCoefficient enclose_coefficient(const Interval& x) {
  EnclosedCoefficient stick{{1, 0}, {0, 0}, {1, 0}};
  if (!(x.lower() > 0)) throw NoEnclosure("S/R may not be positive");
  if (x.lower() >= 1) return stick;
  if (x.upper() <= 1) return enclose_slip(x);
  const EnclosedCoefficient slip = enclose_slip({x.lower(), 1});
  return {joined(stick.phi, slip.phi), joined(stick.phi_log, slip.phi_log), joined(stick.slope, slip.slope)};
}

EnclosedResponse enclose_response(const ModalModel& model, const Interval& eta) {
  const Loss& loss = model.loss();
  EnclosedResponse response;
  for (const Mode& mode : model.modes()) {
    const Interval frequency(mode.frequency);
    const ModeInfluence& influence = mode.influence;
    const Interval by_eta = Interval(loss.viscous) * square(frequency) + Interval(loss.modal) * frequency +
                            Interval(loss.mass) + Interval(influence.damping);
    const ComplexInterval d{
        (frequency - eta) * (frequency + eta) - Interval(influence.stiffness.real()),
        by_eta * eta + Interval(loss.structural) * square(frequency) - Interval(influence.stiffness.imag())};
    const ComplexInterval reciprocal = inverse(d);
    const ComplexInterval slope = reciprocal * reciprocal * ComplexInterval{Interval(2) * eta, -by_eta};
    const ComplexInterval load{mode.load_residue.real(), mode.load_residue.imag()};
    response.compliance = response.compliance + Interval(mode.residue) * reciprocal;
    response.compliance_eta = response.compliance_eta + Interval(mode.residue) * slope;
    response.free = response.free + load * reciprocal;
    response.free_eta = response.free_eta + load * slope;
  }
  return response;
}

}  // namespace arcslip
