// The quantities of whole rings among those of harmonic problems.

#include "harmonic_observation.hpp"

namespace arcslip::problems {

/// Of the motions of all sectors the largest amplitude. Where several sectors have it the gradient is the
/// middle of theirs, as differences to both sides have it.
double HarmonicProblem::Observation::largest(const Quantity& quantity) {
  constexpr double alike = 1e-9;
  const Vector sizes = of_sectors(quantity).cwiseAbs();
  const double most = sizes.maxCoeff();
  if (gradient_ == nullptr) return most;
  continuation::Gradient* const sum = gradient_;
  continuation::Gradient low, high, one{sum->unknowns, sum->parameters};
  for (Index i = 0; i < sizes.size(); ++i) {
    if (sizes(i) < most * (1 - alike)) continue;
    one.unknowns.setZero();
    one.parameters.setZero();
    gradient_ = &one;
    Quantity own = quantity;
    own.which += i * in_sector(quantity.of);
    amplitude(own, 1);
    const bool is_first = low.unknowns.size() == 0;
    if (is_first) low = high = one;
    low = {low.unknowns.cwiseMin(one.unknowns), low.parameters.cwiseMin(one.parameters)};
    high = {high.unknowns.cwiseMax(one.unknowns), high.parameters.cwiseMax(one.parameters)};
  }
  gradient_ = sum;
  sum->unknowns += (low.unknowns + high.unknowns) / 2;
  sum->parameters += (low.parameters + high.parameters) / 2;
  return most;
}

/// How many motions of a kind a sector has: those of the next one follow in their order.
Index HarmonicProblem::Observation::in_sector(Body of) const {
  return of == Body::output ? std::ssize(system_.outputs) : problem_.contacts() / system_.sectors;
}

/// A motion of all sectors, found once for quantities that follow one another.
const ComplexVector& HarmonicProblem::Observation::of_sectors(const Quantity& quantity) {
  const auto& [name, measure, of, which, order, wave] = quantity;
  if (known_ != nullptr && known_->of == of && known_->which == which && known_->order == order)
    return sectors_;
  known_ = &quantity;
  sectors_.resize(system_.sectors);
  ContactVector moved;
  if (of == Body::base || of == Body::damper) {
    const Row row = row_of(of, which, order);
    moved.noalias() = row.response.compliance * row.forces;
  }
  for (Index i = 0; i < system_.sectors; ++i) {
    const Index one = which + i * in_sector(of);
    const bool is_known = moved.size() > 0 && !is_rigid(order);
    if (!is_known) {
      sectors_(i) = phasor(of, one, order);
    } else {
      sectors_(i) = moved(one) - (of == Body::base ? problem_.motion(u_, p_, one)(order) : 0.0);
    }
  }
  return sectors_;
}

/// |sum_i d_i e^{j a q i}|/N of a motion, the part of the wave q.
double HarmonicProblem::Observation::of_wave(const Quantity& quantity) {
  const auto n = static_cast<double>(system_.sectors);
  const Complex turn = std::polar(1.0, two_pi * static_cast<double>(quantity.wave) / n);
  Complex factor = 1 / n;
  Complex sum = 0;
  for (const Complex& one : of_sectors(quantity)) {
    sum += factor * one;
    factor *= turn;
  }
  return std::abs(sum);
}

double HarmonicProblem::Observation::slipping() const {
  double count = 0;
  for (Index i = 0; i < problem_.contacts(); ++i) count += slips(regime_, i) ? 1 : 0;
  return count / static_cast<double>(problem_.contacts());
}

}  // namespace arcslip::problems
