#include "arcslip/interval_response.hpp"

#include <algorithm>

namespace arcslip {
namespace {

/// (8/pi) int_0^x sqrt(s (1 - s)) ds for x up to 1/2 and a little more, by the series of sqrt(1 - s): after
/// the first one all its coefficients c_k are negative, and their magnitudes fall.
Interval segment_series(const Interval& x) {
  Interval sum = Interval(2) / Interval(3);
  Interval coefficient = 1;  // c_k
  Interval power = 1;        // x^k
  for (int k = 1;; ++k) {
    coefficient *= Interval(2 * k - 3) / Interval(2 * k);
    power *= x;
    const Interval term = coefficient * power / Interval(k + 1.5);
    if (term.lower() > -1e-17 || k == 60) {
      sum += Interval((term / (Interval(1) - x)).lower(), 0);  // this term and all that follow
      break;
    }
    sum += term;
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
  const auto rest = [](const Interval& s) { return Interval(1) - s; };
  const auto loss = [&](const Interval& s) { return s * rest(s); };
  const auto loss_slope = [&](const Interval& s) { return s * (rest(s) - s); };
  const auto stiffness_slope = [&](const Interval& s) {
    const Interval radicand = s * rest(s);
    return s * sqrt(Interval(std::max(radicand.lower(), 0.0), std::max(radicand.upper(), 0.0)));
  };
  const Interval real(segment_at(x.lower()).lower(), segment_at(x.upper()).upper());
  return {{real, scale * unimodal(loss, x, 0.5)},
          {-(Interval(2) * scale * unimodal(stiffness_slope, x, 0.75)),
           -(scale * unimodal(loss_slope, x, 0.25))}};
}

}  // namespace

EnclosedCoefficient enclose_coefficient(const Interval& x) {
  const EnclosedCoefficient stick{{1, 0}, {0, 0}};
  if (!(x.lower() > 0)) throw NoEnclosure("S/R may not be positive");
  if (x.lower() >= 1) return stick;
  if (x.upper() <= 1) return enclose_slip(x);
  const EnclosedCoefficient slip = enclose_slip({x.lower(), 1});
  return {joined(stick.phi, slip.phi), joined(stick.phi_log, slip.phi_log)};
}

EnclosedResponse enclose_response(const ModalModel& model, const Interval& eta) {
  const Loss& loss = model.loss();
  EnclosedResponse response;
  for (const Mode& mode : model.modes()) {
    const Interval frequency(mode.frequency);
    const Interval by_eta = Interval(loss.viscous) * square(frequency) + Interval(loss.modal) * frequency +
                            Interval(loss.mass);
    const ComplexInterval d{(frequency - eta) * (frequency + eta),
                            by_eta * eta + Interval(loss.structural) * square(frequency)};
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
