#include "sectors/full_receptance.hpp"

#include <limits>
#include <stdexcept>

namespace arcslip {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// The m contacts, with room for `more` further motions.
VariedReceptance receptance_of(const SectorResponse& found, double force, Index more) {
  const Index m = found.free.size();
  const auto matrix = [&](const ComplexMatrix& compliance) {
    ContactMatrix all = ContactMatrix::Constant(m + more, m + more, unknown);
    all.topLeftCorner(m, m) = compliance;
    return all;
  };
  const auto vector = [&](const ComplexVector& free) {
    ContactVector all = ContactVector::Constant(m + more, unknown);
    all.head(m) = force * free;
    return all;
  };
  return {{matrix(found.compliance), matrix(found.by_eta.compliance), vector(found.free),
           vector(found.by_eta.free)},
          matrix(found.by_speed.compliance),
          vector(found.by_speed.free)};
}

/// With derivatives by eta along a rotation that follows it.
VariedReceptance along(const Rotation& rotation, VariedReceptance receptance) {
  if (rotation.per_eta == 0) return receptance;
  receptance.compliance_eta += rotation.per_eta * receptance.compliance_rate;
  receptance.free_eta += rotation.per_eta * receptance.free_rate;
  return receptance;
}

/// Fills the motion after the contacts, row by row of the same motions.
template <class Row, class Free>
void fill_last(const SectorResponse& found, const Row& row, const Free& free, VariedReceptance& receptance) {
  const Index m = found.free.size();
  receptance.compliance.row(m).head(m) = row(found);
  receptance.compliance_eta.row(m).head(m) = row(found.by_eta);
  receptance.compliance_rate.row(m).head(m) = row(found.by_speed);
  receptance.free(m) = free(found);
  receptance.free_eta(m) = free(found.by_eta);
  receptance.free_rate(m) = free(found.by_speed);
}

/// Of a singular Z.
SectorResponse not_finite(Index contacts, Index outputs) {
  SectorResponse response;
  for (SectorMotions* motions :
       std::initializer_list<SectorMotions*>{&response, &response.by_eta, &response.by_speed})
    motions->fill(contacts, outputs, unknown);
  response.damping.setConstant(contacts + 1, contacts + 1, unknown);
  return response;
}

}  // namespace

VariedReceptance SectorSolves::at(double eta, double force, const Rotation& rotation) const {
  return along(rotation, receptance_of(response(eta, rotation), force, 0));
}

VariedReceptance SectorSolves::with_output(Index output, double eta, double force,
                                           const Rotation& rotation) const {
  const SectorResponse found = response(eta, rotation);
  VariedReceptance receptance = receptance_of(found, force, 1);
  fill_last(
      found, [&](const SectorMotions& motions) { return motions.output_compliance.row(output); },
      [&](const SectorMotions& motions) { return force * motions.output_free(output); }, receptance);
  return along(rotation, std::move(receptance));
}

VariedReceptance SectorSolves::with_driven_motion(double eta, double force, const Rotation& rotation) const {
  const SectorResponse found = response(eta, rotation);
  const Index m = found.free.size();
  VariedReceptance receptance = receptance_of(found, force, 1);
  fill_last(
      found,
      [&](const SectorMotions& motions) -> ComplexMatrix {
        return force * motions.load_motion.head(m).transpose();
      },
      [&](const SectorMotions& motions) { return force * force * motions.load_motion(m); }, receptance);
  return along(rotation, std::move(receptance));
}

CycleWork SectorSolves::work(double eta, double force, const ContactVector& forces,
                             const Rotation& rotation) const {
  const SectorResponse found = response(eta, rotation);
  ComplexVector all(forces.size() + 1);
  all << forces, force;
  const Complex load_motion = (found.load_motion.transpose() * all).value();
  const ComplexVector motion = found.compliance * forces + force * found.free;
  return {-pi * force * load_motion.imag(), pi * all.dot(found.damping * all).real(),
          pi * (force * std::abs(load_motion) + forces.cwiseAbs().dot(motion.cwiseAbs()))};
}

SectorResponse SectorSolves::response(double eta, const Rotation& rotation) const {
  const std::scoped_lock lock(mutex_);
  const std::pair<double, double> place(eta, rotation.at(eta));
  const auto known = known_.find(place);
  if (known != known_.end()) return known->second;
  if (known_.size() == kept_) known_.clear();
  try {
    return known_[place] = solved(eta, place.second);
  } catch (const std::domain_error&) {  // as the sum over undamped modes at one of their frequencies
    return known_[place] = not_finite(contacts(), outputs());
  }
}

int FullReceptance::factorisations() const {
  const std::scoped_lock lock(mutex_);
  return solver_.factorisations();
}

}  // namespace arcslip
