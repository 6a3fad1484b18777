#include "arcslip/problems/proof/enclosed_equation.hpp"

#include <algorithm>

namespace arcslip::problems {
namespace {

/// 1 + k phi c.
ComplexInterval closed(const Interval& k, const ComplexInterval& phi, const ComplexInterval& c) {
  return ComplexInterval{1, 0} + k * (phi * c);
}

ComplexInterval quotient(const ComplexInterval& a, const ComplexInterval& b) { return a * inverse(b); }

Interval symmetric(double half_width) { return {-half_width, half_width}; }

}  // namespace

struct EnclosedEquation::Piece {
  Piece(const PlanePoint& from, const PlanePoint& to, Axis which)
      : axis(which),
        q(joined(Interval(from.parameter), Interval(to.parameter))),
        rho(joined(Interval(from.rho), Interval(to.rho))),
        step_q(Interval(to.parameter) - Interval(from.parameter)),
        step_rho(Interval(to.rho) - Interval(from.rho)),
        middle_q(Interval(0.5) * (Interval(from.parameter) + Interval(to.parameter))),
        middle_rho(Interval(0.5) * (Interval(from.rho) + Interval(to.rho))) {}

  Axis axis;
  Interval q, rho;            ///< ranges on the piece
  Interval step_q, step_rho;  ///< from its first point to its last
  Interval middle_q, middle_rho;
  Terms middle = {};
};

ComplexInterval EnclosedEquation::compliance(const Interval& q) const {
  return enclose_response(system_.base, eta(q)).compliance +
         enclose_response(system_.damper, eta(q)).compliance;
}

EnclosedEquation::Terms EnclosedEquation::terms(const Interval& q, const Interval& rho) const {
  const bool over_eta = parameter_ == ContactProblem::eta;
  const Interval at = eta(q);
  const Interval preload = over_eta ? Interval(fixed_) : q;
  const EnclosedResponse base = enclose_response(system_.base, at);
  const EnclosedResponse damper = enclose_response(system_.damper, at);
  const Interval growth(system_.preload_growth);
  const Interval load = preload + growth * square(at);
  if (!(at.lower() > 0 && load.lower() > 0)) throw NoEnclosure("the contact may be open");
  const Interval ratio = load * Interval(system_.slip_per_preload) * exponential(-rho);  // S/R
  Terms terms;
  terms.compliance = base.compliance + damper.compliance;
  terms.free = base.free;
  terms.law = enclose_coefficient(ratio);
  terms.log_threshold_q = (over_eta ? Interval(2) * growth * at : Interval(1)) * inverse(load);
  if (over_eta) {
    terms.compliance_q = base.compliance_eta + damper.compliance_eta;
    terms.log_free_q = quotient(base.free_eta, base.free).real;
  }
  return terms;
}

Interval EnclosedEquation::value(const Terms& terms, const Interval& rho) const {
  const ComplexInterval factor = closed(Interval(system_.contact_stiffness), terms.law.phi, terms.compliance);
  return Interval(0.5) * logarithm(norm(factor) * exponential(Interval(2) * rho) * inverse(norm(terms.free)));
}

Interval EnclosedEquation::residual(const PlanePoint& point) const {
  const Interval rho(point.rho);
  return value(terms(Interval(point.parameter), rho), rho);
}

EnclosedGradient EnclosedEquation::gradient(const Interval& q, const Interval& rho) const {
  const Interval k(system_.contact_stiffness);
  const Terms at = terms(q, rho);
  const ComplexInterval gain = k * inverse(closed(k, at.law.phi, at.compliance));
  const Interval by_ratio = (gain * at.law.phi_log * at.compliance).real;
  return {(gain * at.law.phi * at.compliance_q).real - at.log_free_q - by_ratio * at.log_threshold_q,
          quotient(closed(k, at.law.slope, at.compliance), closed(k, at.law.phi, at.compliance)).real};
}

EnclosedEquation::Derivatives EnclosedEquation::derivatives(const Piece& piece, double half_width) const {
  const bool up = piece.axis == Axis::rho;
  const Interval side = symmetric(half_width);
  const Interval q = up ? piece.q : piece.q + side;
  const Interval box_rho = up ? piece.rho + side : piece.rho;
  Terms box = terms(q, box_rho);
  const Terms& middle = piece.middle;
  const Interval k(system_.contact_stiffness);
  const Interval half = symmetric(0.5);
  const ComplexInterval from_middle =
      middle.compliance + (q - piece.middle_q) * box.compliance_q;  // the mean value theorem, as below
  box.compliance = common(box.compliance, from_middle);

  // Derivative of R (1 + k phi c) along the piece and across it, over R.
  const ComplexInterval by_rho = ComplexInterval{1, 0} + k * (box.law.slope * box.compliance);
  const ComplexInterval by_q =
      k * (box.law.phi * box.compliance_q + -box.log_threshold_q * (box.law.phi_log * box.compliance));
  const ComplexInterval along = piece.step_rho * by_rho + piece.step_q * by_q;
  const ComplexInterval& across = up ? by_rho : by_q;
  const Interval growth = exponential(box_rho - piece.middle_rho);  // of R from the middle
  const ComplexInterval factor =
      common(closed(k, box.law.phi, box.compliance),
             inverse(growth) * (closed(k, middle.law.phi, middle.compliance) + (half * growth) * along +
                                (side * growth) * across));
  const ComplexInterval reciprocal = inverse(factor);
  return {(along * reciprocal).real - box.log_free_q * piece.step_q,
          (across * reciprocal).real - (up ? Interval(0) : box.log_free_q)};
}

std::optional<TiltedBox> EnclosedEquation::certified_box(const PlanePoint& from, const PlanePoint& to,
                                                         Axis axis) const {
  constexpr int attempts = 3;
  Piece piece(from, to, axis);
  try {
    piece.middle = terms(piece.middle_q, piece.middle_rho);
    const Derivatives line = derivatives(piece, 0);
    // |g(a, 0)| at most.
    const Interval residual = norm(value(piece.middle, piece.middle_rho) + line.along * symmetric(0.5));
    double half_width = 2 * norm(residual * inverse(line.across));
    for (int attempt = 0; attempt < attempts; ++attempt) {
      const Interval across = derivatives(piece, half_width).across;
      if (norm(residual * inverse(across)) < half_width)
        return TiltedBox{from, to, axis, half_width, std::max(across.lower(), -across.upper())};
      half_width *= 4;
    }
  } catch (const NoEnclosure&) {
    return std::nullopt;
  }
  return std::nullopt;
}

bool EnclosedEquation::is_passive(const Interval& q) const {
  try {
    return compliance(q).imaginary.upper() < 0;
  } catch (const NoEnclosure&) {
    return false;
  }
}

}  // namespace arcslip::problems
