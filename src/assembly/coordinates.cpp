#include "arcslip/assembly/coordinates.hpp"

#include <stdexcept>

#include "arcslip/assembly/harmonic_system.hpp"
#include "arcslip/elements/jenkins.hpp"

namespace arcslip {

Coordinates::Coordinates(const HarmonicSystem& system)
    : contacts_(std::ssize(system.contacts)), spares_base_(system.one_way) {
  for (Index i = 0; i < contacts_; ++i) {
    const SectorContact& contact = system.contacts[static_cast<std::size_t>(i)];
    all_.push_back(
        {-1, 1, i, std::make_shared<Jenkins>(contact.stiffness, contact.slip_per_preload), spares_base_});
  }
  all_.insert(all_.end(), system.others.begin(), system.others.end());
  if (size() > most_contacts) throw std::invalid_argument("Coordinates: too many elements");
}

void Coordinates::receptance(const ContactModes& base, const ContactModes& damper, double frequency,
                             ContactReceptance& joint) const {
  joint.set_zero(contacts_);
  base.add(frequency, joint);
  if (!has_others() && !spares_base_) return damper.add(frequency, joint);
  const ContactReceptance of_base = joint;
  const ContactReceptance of_damper = damper.at(frequency);
  joint.set_zero(size());
  add(of_base.compliance, true, joint.compliance);
  add(of_damper.compliance, false, joint.compliance);
  add(of_base.compliance_eta, true, joint.compliance_eta);
  add(of_damper.compliance_eta, false, joint.compliance_eta);
  for (Index i = 0; i < size(); ++i) {
    joint.free(i) = -(*this)[i].base * of_base.free((*this)[i].dof);
    joint.free_eta(i) = -(*this)[i].base * of_base.free_eta((*this)[i].dof);
  }
}

void Coordinates::add(const ContactMatrix& compliance, bool is_base, ContactMatrix& sum) const {
  for (Index j = 0; j < size(); ++j) {
    for (Index i = 0; i < size(); ++i)
      sum(i, j) +=
          (*this)[i].move(is_base) * (*this)[j].push(is_base) * compliance((*this)[i].dof, (*this)[j].dof);
  }
}

ContactVector Coordinates::forces_on(bool is_base, const std::vector<ElementForce>& forces,
                                     Index order) const {
  ContactVector sum = ContactVector::Zero(contacts_);
  for (Index i = 0; i < size(); ++i)
    sum((*this)[i].dof) -= (*this)[i].push(is_base) * forces[static_cast<std::size_t>(i)].harmonics(order);
  return sum;
}

}  // namespace arcslip
