#include "arcslip/structure/contact_modes.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace arcslip {
namespace {

constexpr Index few_rows = 32;  // of matrices inverted in place
constexpr Index few = 16;       // contacts, of which products by entries are faster than calls

/// Whether nothing holds a mode: at rest no force is met by a rigid motion.
bool drifts(const ContactMode& mode, double eta) { return eta == 0 && mode.is_rigid(); }

}  // namespace

ContactModes::ContactModes(Index contacts, std::vector<ContactMode> modes, const Loss& loss)
    : contacts_(contacts), modes_(std::move(modes)), loss_(loss) {
  if (contacts < 1)
    throw std::invalid_argument(fmt::format("ContactModes: 1 contact or more, not {}", contacts));
  for (const ContactMode& mode : modes_) {
    if (mode.shape.size() != contacts)
      throw std::invalid_argument("ContactModes: every shape needs one entry for each contact");
  }
  if (contacts <= few) return;
  shapes_.resize(contacts, std::ssize(modes_));
  for (Index k = 0; k < shapes_.cols(); ++k) shapes_.col(k) = modes_[static_cast<std::size_t>(k)].shape;
}

ContactModes ContactModes::solved_by(Receptance receptance, double load, ReceptanceWork work) const {
  SpeedWork of_any_speed;
  if (work) {
    of_any_speed = [work = std::move(work)](double eta, double factor, const ContactVector& forces, double) {
      return work(eta, factor, forces);
    };
  }
  const auto answer = [respond = std::move(receptance)](double eta, double factor, double) {
    VariedReceptance response;
    static_cast<ContactReceptance&>(response) = respond(eta, factor);
    response.compliance_rate.setZero(response.free.size(), response.free.size());
    response.free_rate.setZero(response.free.size());
    return response;
  };
  return solved_at_speeds(answer, load, std::move(of_any_speed));
}

ContactModes ContactModes::turning(ModesAtSpeed modes) const {
  ContactModes turning = *this;
  if (receptance_) {
    turning.modes_ = modes(speed_)->resonances();
    for (ContactMode& mode : turning.modes_) mode.load *= receptance_load_;
  }
  turning.turning_ = std::move(modes);
  return turning;
}

ContactModes ContactModes::solved_at_speeds(SpeedReceptance receptance, double load, SpeedWork work) const {
  ContactModes solved = *this;
  solved.receptance_ = std::move(receptance);
  solved.receptance_work_ = std::move(work);
  solved.receptance_load_ = load;
  return solved;
}

ContactModes ContactModes::with_driven_motion() const {
  std::vector<ContactMode> driven = modes_;
  for (ContactMode& mode : driven) {
    mode.shape.conservativeResize(contacts_ + 1);
    mode.shape(contacts_) = std::conj(mode.load);
  }
  return {contacts_ + 1, std::move(driven), loss_};
}

ContactModes ContactModes::turned(const Complex& turn) const {
  ContactModes other = *this;
  for (ContactMode& mode : other.modes_) mode.load *= turn;
  if (!receptance_) return other;
  other.receptance_ = [answer = receptance_, turn](double eta, double load, double speed) {
    VariedReceptance response = answer(eta, load, speed);
    response.free *= turn;
    response.free_eta *= turn;
    response.free_rate *= turn;
    return response;
  };
  if (receptance_work_) {
    other.receptance_work_ = [work = receptance_work_, turn](double eta, double load,
                                                             const ContactVector& forces, double speed) {
      return work(eta, load, std::conj(turn) * forces, speed);
    };
  }
  return other;
}

void invert(ContactMatrix& a) {
  const Index m = a.rows();
  if (m > few_rows) {
    a = ContactMatrix(a.partialPivLu().inverse());
    return;
  }
  std::array<Index, few_rows> rows;
  for (Index k = 0; k < m; ++k) {
    Index& best = rows[static_cast<std::size_t>(k)] = k;
    for (Index i = k + 1; i < m; ++i) {
      if (std::norm(a(i, k)) > std::norm(a(best, k))) best = i;
    }
    if (best != k) a.row(k).swap(a.row(best));
    const Complex pivot = std::conj(a(k, k)) / std::norm(a(k, k));
    a(k, k) = 0;
    for (Index j = 0; j < m; ++j) {
      if (j == k) continue;
      const Complex factor = a(k, j) * pivot;
      a.col(j) -= factor * a.col(k);
      a(k, j) = factor;
    }
    a.col(k) *= -pivot;
    a(k, k) = pivot;
  }
  for (Index k = m; k-- > 0;) {
    if (rows[static_cast<std::size_t>(k)] != k) a.col(k).swap(a.col(rows[static_cast<std::size_t>(k)]));
  }
}

void ContactReceptance::set_zero(Index contacts) {
  compliance.setZero(contacts, contacts);
  compliance_eta.setZero(contacts, contacts);
  free.setZero(contacts);
  free_eta.setZero(contacts);
}

ContactReceptance ContactModes::at(double eta) const {
  ContactReceptance response;
  response.set_zero(contacts_);
  add(eta, response);
  return response;
}

void ContactModes::add(double eta, ContactReceptance& sum) const {
  if (receptance_) {
    const ContactReceptance response = receptance_(eta, receptance_load_, speed_);
    sum.compliance += response.compliance;
    sum.compliance_eta += response.compliance_eta;
    sum.free += response.free;
    sum.free_eta += response.free_eta;
    return;
  }
  if (shapes_.size() > 0) return add_many(eta, sum);
  for (const ContactMode& mode : modes_) {
    if (drifts(mode, eta)) continue;
    const ModalDenominator d(eta, mode.frequency, loss_, mode.influence);
    const Complex inverse = std::conj(d.value) / std::norm(d.value);
    const Complex slope = -inverse * inverse * d.by_eta;
    for (Index j = 0; j < contacts_; ++j) {  // faster than products of such small matrices
      const Complex column = inverse * std::conj(mode.shape(j));
      const Complex column_eta = slope * std::conj(mode.shape(j));
      sum.compliance.col(j) += column * mode.shape;
      sum.compliance_eta.col(j) += column_eta * mode.shape;
    }
    sum.free += (mode.load * inverse) * mode.shape;
    sum.free_eta += (mode.load * slope) * mode.shape;
  }
}

void ContactModes::add_many(double eta, ContactReceptance& sum) const {
  ComplexVector inverse = ComplexVector::Zero(shapes_.cols());
  ComplexVector slope = ComplexVector::Zero(shapes_.cols());
  ComplexVector load = ComplexVector::Zero(shapes_.cols());
  for (Index k = 0; k < shapes_.cols(); ++k) {
    const ContactMode& mode = modes_[static_cast<std::size_t>(k)];
    if (drifts(mode, eta)) continue;
    const ModalDenominator d(eta, mode.frequency, loss_, mode.influence);
    inverse(k) = std::conj(d.value) / std::norm(d.value);
    slope(k) = -inverse(k) * inverse(k) * d.by_eta;
    load(k) = mode.load;
  }
  sum.compliance.noalias() += shapes_ * inverse.asDiagonal() * shapes_.adjoint();
  sum.compliance_eta.noalias() += shapes_ * slope.asDiagonal() * shapes_.adjoint();
  sum.free.noalias() += shapes_ * inverse.cwiseProduct(load);
  sum.free_eta.noalias() += shapes_ * slope.cwiseProduct(load);
}

CycleWork ContactModes::work(double eta, const ContactVector& forces) const {
  if (receptance_) return receptance_work_(eta, receptance_load_, forces, speed_);
  CycleWork sum;
  for (const ContactMode& mode : modes_) {
    if (drifts(mode, eta)) continue;
    const Complex d = ModalDenominator(eta, mode.frequency, loss_, mode.influence).value;
    const Complex by_contacts = mode.shape.dot(forces);
    const Complex motion = (mode.load + by_contacts) / d;
    sum.load += pi * std::imag(mode.load * std::conj(motion));
    sum.damping += pi * std::norm(motion) * d.imag();
    sum.magnitude += pi * (std::abs(mode.load) + std::abs(by_contacts)) * std::abs(motion);
  }
  return sum;
}

VariedReceptance ContactModes::varied(double eta, const Variation& at, const Variation& rate) const {
  VariedReceptance sum;
  sum.set_zero(contacts_);
  sum.compliance_rate.setZero(contacts_, contacts_);
  sum.free_rate.setZero(contacts_);
  if (receptance_) {
    sum = receptance_(eta, receptance_load_, speed_ + at.speed);
    sum.compliance_rate *= rate.speed;
    sum.free_rate *= at.load * rate.speed;
    sum.free_rate += rate.load * sum.free;
    sum.free *= at.load;
    sum.free_eta *= at.load;
    return sum;
  }
  const double stretch = std::sqrt(at.stiffness / at.mass);
  const double stretch_rate = 0.5 * (rate.stiffness / at.stiffness - rate.mass / at.mass);
  for (const ContactMode& mode : modes_) {
    if (drifts(mode, eta)) continue;
    const double frequency = stretch * mode.frequency;
    const ModalDenominator d(eta, frequency, at.loss, at.influence * mode.influence);
    const Complex by_frequency(2 * frequency, 2 * frequency * at.loss.at(eta) + at.loss.modal * eta);
    const Complex d_rate = by_frequency * (frequency * stretch_rate) +
                           Complex(0, rate.loss.part(eta, frequency)) +
                           rate.influence * mode.influence.part(eta);
    const Complex inverse = std::conj(d.value) / std::norm(d.value);
    const Complex over_mass = inverse / at.mass;
    const Complex by_eta = -over_mass * inverse * d.by_eta;
    const Complex by_rate = -over_mass * (inverse * d_rate + rate.mass / at.mass);
    for (Index j = 0; j < contacts_; ++j) {
      const Complex shape = std::conj(mode.shape(j));
      sum.compliance.col(j) += (over_mass * shape) * mode.shape;
      sum.compliance_eta.col(j) += (by_eta * shape) * mode.shape;
      sum.compliance_rate.col(j) += (by_rate * shape) * mode.shape;
    }
    sum.free += (at.load * mode.load * over_mass) * mode.shape;
    sum.free_eta += (at.load * mode.load * by_eta) * mode.shape;
    sum.free_rate += (mode.load * (at.load * by_rate + rate.load * over_mass)) * mode.shape;
  }
  return sum;
}

ContactModes ContactModes::varied(const Variation& at) const {
  std::vector<ContactMode> modes = modes_;
  const double smaller = 1 / std::sqrt(at.mass);
  for (ContactMode& mode : modes) {
    mode.frequency *= std::sqrt(at.stiffness) * smaller;
    mode.shape *= smaller;
    mode.load *= at.load * smaller;
    mode.influence = at.influence * mode.influence;
  }
  ContactModes structure(contacts_, std::move(modes), at.loss);
  structure.turning_ = turning_;
  structure.speed_ = speed_ + at.speed;
  if (!receptance_) return structure;
  structure.loss_ = loss_;
  const ContactModes solved =
      structure.solved_at_speeds(receptance_, at.load * receptance_load_, receptance_work_);
  return turning_ ? solved.turning(turning_) : solved;
}

Vector contact_springs(const std::vector<SectorContact>& contacts) {
  Vector springs(std::ssize(contacts));
  std::transform(contacts.begin(), contacts.end(), springs.begin(),
                 [](const SectorContact& contact) { return contact.stiffness; });
  return springs;
}

ContactOutput driven_motion(ContactModes base) { return {"lag", std::move(base), true, true}; }

Complex ContactOutput::motion(double eta, const ContactVector& forces) const {
  const Index m = forces.size();
  const ContactReceptance at = modes.at(eta);
  const Complex by_contacts = (at.compliance.row(m).head(m) * forces).value();
  return at.free(m) + by_contacts;
}

}  // namespace arcslip
