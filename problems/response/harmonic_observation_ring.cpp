// The quantities of whole rings among those of harmonic problems.

#include <algorithm>

#include "harmonic_observation.hpp"

namespace arcslip::problems {

/// Of the motions of all sectors the largest amplitude, with the gradient of the first one that has it: where
/// several have, it is a corner, but along a branch on which they are alike they change alike.
double HarmonicProblem::Observation::largest(const Quantity& quantity) {
  constexpr double alike = 1e-9;
  Index found = 0;
  const double most = of_sectors(quantity).cwiseAbs().maxCoeff(&found);
  if (gradient_ == nullptr) return most;
  gradient_->piece = 0;
  while (std::abs(sectors_(gradient_->piece)) < (1 - alike) * most) ++gradient_->piece;
  Quantity own = quantity;
  own.which += found * in_sector(quantity.of);
  return amplitude(own, 1);
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

/// Of the contacts that there are.
double HarmonicProblem::Observation::slipping() const {
  double count = 0;
  double all = 0;
  for (Index i = 0; i < problem_.contacts(); ++i) {
    count += slips(regime_, i) ? 1 : 0;
    all += system_.contacts[at(i)].stiffness > 0 ? 1 : 0;
  }
  return count / std::max(1.0, all);
}

/// Of all contacts, in each of the load's periods.
double HarmonicProblem::Observation::losses() const {
  double sum = 0;
  for (Index i = 0; i < problem_.contacts(); ++i) sum += elements_[at(i)].energy;
  return sum / system_.periods();
}

}  // namespace arcslip::problems
