#include "arcslip/contact_modes.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace arcslip {

ContactModes::ContactModes(Index contacts, std::vector<ContactMode> modes, const Loss& loss)
    : contacts_(contacts), modes_(std::move(modes)), loss_(loss) {
  if (contacts < 1 || contacts > most_contacts)
    throw std::invalid_argument(
        fmt::format("ContactModes: from 1 to {} contacts, not {}", most_contacts, contacts));
  for (const ContactMode& mode : modes_) {
    if (mode.shape.size() != contacts)
      throw std::invalid_argument("ContactModes: every shape needs one entry for each contact");
  }
}

ContactReceptance ContactModes::at(double eta) const {
  ContactReceptance response;
  response.compliance.setZero(contacts_, contacts_);
  response.compliance_eta.setZero(contacts_, contacts_);
  response.free.setZero(contacts_);
  response.free_eta.setZero(contacts_);
  for (const ContactMode& mode : modes_) {
    const ModalDenominator d(eta, mode.frequency, loss_);
    const Complex inverse = std::conj(d.value) / std::norm(d.value);
    const Complex slope = -inverse * inverse * d.by_eta;
    response.compliance.noalias() += (inverse * mode.shape) * mode.shape.adjoint();
    response.compliance_eta.noalias() += (slope * mode.shape) * mode.shape.adjoint();
    response.free += (mode.load * inverse) * mode.shape;
    response.free_eta += (mode.load * slope) * mode.shape;
  }
  return response;
}

double ContactOutput::amplitude(double eta, const ContactVector& forces) const {
  const Index m = forces.size();
  const ContactReceptance at = modes.at(eta);
  const Complex by_contacts = (at.compliance.row(m).head(m) * forces).value();
  return std::abs(at.free(m) + force_sign * by_contacts);
}

std::vector<double> joined_frequencies(const std::vector<const ContactModes*>& structures,
                                       const Vector& springs) {
  Index count = 0;
  for (const ContactModes* structure : structures) count += static_cast<Index>(structure->modes().size());
  // In modal coordinates: diag(eta_k^2) + B^H diag(springs) B, where B gives the relative motions.
  ComplexMatrix relative(springs.size(), count);
  Vector squares(count);
  Index column = 0;
  for (const ContactModes* structure : structures) {
    const double sign = structure == structures.front() ? 1 : -1;
    for (const ContactMode& mode : structure->modes()) {
      relative.col(column) = sign * mode.shape;
      squares(column++) = mode.frequency * mode.frequency;
    }
  }
  ComplexMatrix stiffness = relative.adjoint() * springs.asDiagonal() * relative;
  stiffness.diagonal() += squares;
  const Vector found =
      Eigen::SelfAdjointEigenSolver<ComplexMatrix>(stiffness, Eigen::EigenvaluesOnly).eigenvalues();
  std::vector<double> frequencies;
  for (const double square : found) frequencies.push_back(std::sqrt(std::max(0.0, square)));
  return frequencies;
}

}  // namespace arcslip
