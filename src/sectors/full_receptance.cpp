#include "sectors/full_receptance.hpp"

#include <limits>
#include <stdexcept>

namespace arcslip {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

SectorResponse not_finite(Index contacts, Index outputs) {
  return {ComplexMatrix::Constant(contacts, contacts, unknown),
          ComplexMatrix::Constant(contacts, contacts, unknown),
          ComplexVector::Constant(contacts, unknown),
          ComplexVector::Constant(contacts, unknown),
          ComplexMatrix::Constant(outputs, contacts, unknown),
          ComplexVector::Constant(outputs, unknown),
          ComplexMatrix::Constant(outputs, contacts, unknown),
          ComplexVector::Constant(outputs, unknown),
          ComplexMatrix::Constant(contacts + 1, contacts + 1, unknown),
          ComplexVector::Constant(contacts + 1, unknown),
          ComplexVector::Constant(contacts + 1, unknown)};
}

/// With room for a further motion.
ContactReceptance with_one_more(const SectorResponse& found, double force) {
  const Index m = found.free.size();
  ContactReceptance receptance{
      ContactMatrix::Constant(m + 1, m + 1, unknown), ContactMatrix::Constant(m + 1, m + 1, unknown),
      ContactVector::Constant(m + 1, unknown), ContactVector::Constant(m + 1, unknown)};
  receptance.compliance.topLeftCorner(m, m) = found.compliance;
  receptance.compliance_eta.topLeftCorner(m, m) = found.compliance_eta;
  receptance.free.head(m) = force * found.free;
  receptance.free_eta.head(m) = force * found.free_eta;
  return receptance;
}

}  // namespace

SectorResponse FullReceptance::response(double eta) const {
  constexpr std::size_t most = 10000;
  const std::scoped_lock lock(mutex_);
  const auto known = known_.find(eta);
  if (known != known_.end()) return known->second;
  if (known_.size() == most) known_.clear();
  try {
    return known_[eta] = solver_.at(eta);
  } catch (const std::domain_error&) {  // as the sum over undamped modes at one of their frequencies
    return known_[eta] = not_finite(solver_.contacts(), solver_.outputs());
  }
}

ContactReceptance FullReceptance::at(double eta, double force) const {
  const SectorResponse found = response(eta);
  return {found.compliance, found.compliance_eta, force * found.free, force * found.free_eta};
}

ContactReceptance FullReceptance::with_output(Index output, double eta, double force) const {
  const SectorResponse found = response(eta);
  const Index m = found.free.size();
  ContactReceptance receptance = with_one_more(found, force);
  receptance.compliance.row(m).head(m) = found.output_compliance.row(output);
  receptance.compliance_eta.row(m).head(m) = found.output_compliance_eta.row(output);
  receptance.free(m) = force * found.output_free(output);
  receptance.free_eta(m) = force * found.output_free_eta(output);
  return receptance;
}

ContactReceptance FullReceptance::with_driven_motion(double eta, double force) const {
  const SectorResponse found = response(eta);
  const Index m = found.free.size();
  ContactReceptance receptance = with_one_more(found, force);
  receptance.compliance.row(m).head(m) = force * found.load_motion.head(m).transpose();
  receptance.compliance_eta.row(m).head(m) = force * found.load_motion_eta.head(m).transpose();
  receptance.free(m) = force * force * found.load_motion(m);
  receptance.free_eta(m) = force * force * found.load_motion_eta(m);
  return receptance;
}

CycleWork FullReceptance::work(double eta, double force, const ContactVector& forces) const {
  const SectorResponse found = response(eta);
  ComplexVector all(forces.size() + 1);
  all << forces, force;
  const Complex load_motion = (found.load_motion.transpose() * all).value();
  const ComplexVector motion = found.compliance * forces + force * found.free;
  return {-pi * force * load_motion.imag(), pi * all.dot(found.damping * all).real(),
          pi * (force * std::abs(load_motion) + forces.cwiseAbs().dot(motion.cwiseAbs()))};
}

int FullReceptance::factorisations() const {
  const std::scoped_lock lock(mutex_);
  return solver_.factorisations();
}

}  // namespace arcslip
