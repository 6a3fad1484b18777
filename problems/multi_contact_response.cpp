#include "arcslip/problems/multi_contact_response.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "arcslip/contact.hpp"
#include "arcslip/problems/contact_problem.hpp"

namespace arcslip::problems {
namespace {

bool slips(int regime, Index contact) { return (regime >> contact & 1) != 0; }

/// The relative displacements of the real unknowns.
ContactVector complex_of(const Vector& u) {
  ContactVector r(u.size() / 2);
  for (Index i = 0; i < r.size(); ++i) r(i) = {u(2 * i), u(2 * i + 1)};
  return r;
}

}  // namespace

MultiContactResponse::MultiContactResponse(ContactSystem system) : system_(std::move(system)) {
  if (system_.base.contacts() != contacts() || system_.damper.contacts() != contacts())
    throw std::invalid_argument("MultiContactResponse: base, damper and contacts must be as many");
  for (const SectorContact& contact : system_.contacts) {
    if (!(contact.stiffness > 0 && contact.slip_per_preload > 0))
      throw std::invalid_argument("MultiContactResponse: stiffness and slip threshold must be positive");
  }
}

MultiContactResponse::Law MultiContactResponse::law(Complex r, Index contact, double load, int regime) const {
  const double k = system_.contacts[static_cast<std::size_t>(contact)].stiffness;
  if (!slips(regime, contact)) return {k, 0};
  const HarmonicCoefficient phi = slip_coefficient(std::log(std::abs(r) / threshold(contact, load)));
  return {k * phi.phi, k * phi.phi_log};
}

bool MultiContactResponse::evaluate(const Vector& u, const Vector& p, int regime,
                                    const continuation::Evaluation& out) const {
  if (!(p(eta) > 0 && p(preload) > 0)) return false;
  const Index m = contacts();
  const ContactVector r = complex_of(u);
  ContactVector springs(m);
  ContactVector springs_log(m);
  for (Index i = 0; i < m; ++i) {
    if (slips(regime, i) && r(i) == Complex(0)) return false;
    const Law at = law(r(i), i, p(preload), regime);
    springs(i) = at.spring;
    springs_log(i) = at.spring_log;
  }
  const ContactReceptance base = system_.base.at(p(eta));
  const ContactReceptance damper = system_.damper.at(p(eta));
  const ContactMatrix c = base.compliance + damper.compliance;
  ContactMatrix closed = c * springs.asDiagonal();
  closed.diagonal().array() += 1.0;
  const Eigen::PartialPivLU<ContactMatrix> factors(closed);
  const ContactVector motion = -factors.solve(base.free);  // what r should be
  const double size = u.norm();
  const double per_size = 1 / size;

  const auto store = [m](const ContactVector& from, auto&& column) {
    for (Index i = 0; i < m; ++i) {
      column(2 * i) = from(i).real();
      column(2 * i + 1) = from(i).imag();
    }
  };
  if (out.residual != nullptr) store((r - motion) * per_size, *out.residual);
  if (out.jacobian == nullptr && out.parameter_jacobian == nullptr) return true;
  // d motion/d ln R_j is the j-th column of this, d motion/d ln P minus the sum of all
  const ContactMatrix by_log_R = -factors.solve(c * (springs_log.cwiseProduct(motion)).asDiagonal());
  if (out.jacobian != nullptr) {
    for (Index j = 0; j < m; ++j) {
      const double square = std::norm(r(j));
      for (const Index part : {0, 1}) {
        const double share = slips(regime, j) ? u(2 * j + part) / square : 0;  // of d ln R_j
        ContactVector column = (share * per_size) * -by_log_R.col(j);
        column(j) += part == 0 ? Complex(per_size, 0) : Complex(0, per_size);
        column -= (r - motion) * (u(2 * j + part) * per_size * per_size * per_size);
        store(column, out.jacobian->col(2 * j + part));
      }
    }
  }
  if (out.parameter_jacobian != nullptr) {
    const ContactMatrix c_eta = base.compliance_eta + damper.compliance_eta;
    const ContactVector by_eta = factors.solve(base.free_eta + c_eta * springs.cwiseProduct(motion));
    store(by_eta * per_size, out.parameter_jacobian->col(eta));
    store(by_log_R.rowwise().sum() * (per_size / p(preload)), out.parameter_jacobian->col(preload));
  }
  return true;
}

void MultiContactResponse::scale(const Vector& u, const Vector& p, Vector& unknowns,
                                 Vector& parameters) const {
  unknowns.setConstant(u.norm());
  parameters = p;
}

std::vector<std::string> MultiContactResponse::regime_names() const {
  std::vector<std::string> names = {"stick"};
  const int all = 1 << contacts();
  for (int regime = 1; regime < all; ++regime) {
    std::string name = "slip";
    for (Index i = 0; regime < all - 1 && i < contacts(); ++i) {
      if (slips(regime, i)) name += fmt::format(" {}", i + 1);
    }
    names.push_back(name);
  }
  return names;
}

double MultiContactResponse::border(const Vector& u, const Vector& p, int regime, int border,
                                    continuation::Gradient* gradient) const {
  const double sign = slips(regime, border) ? -1 : 1;
  const Complex r(u(2 * border), u(2 * border + 1));
  const double limit = threshold(border, p(preload));
  const double square = std::norm(r);
  const double sum = square + limit * limit;
  if (gradient != nullptr) {
    const double slope = sign * 4 * limit * limit / (sum * sum);  // over R^2/2
    gradient->unknowns.setZero();
    gradient->unknowns(2 * border) = slope * r.real();
    gradient->unknowns(2 * border + 1) = slope * r.imag();
    gradient->parameters << 0, -slope * square / p(preload);
  }
  return sign * (square - limit * limit) / sum;
}

std::vector<continuation::Observable> MultiContactResponse::observables() const {
  std::vector<continuation::Observable> all = {{"R"},    {"S"},     {"R_over_S"}, {"Y", true},   {"U"},
                                               {"beta"}, {"alpha"}, {"psi"},      {"dissipated"}};
  for (Index i = 1; i < contacts(); ++i) {
    for (const char* name : {"R", "R_over_S", "Y", "U", "dissipated"})
      all.push_back({fmt::format("{}_contact_{}", name, i + 1)});
  }
  for (const ContactOutput& output : system_.outputs) all.push_back({output.name});
  return all;
}

void MultiContactResponse::observe(const Vector& u, const Vector& p, int regime, Vector& values) const {
  const Index m = contacts();
  const ContactVector r = complex_of(u);
  ContactVector f(m);
  for (Index i = 0; i < m; ++i) f(i) = law(r(i), i, p(preload), regime).spring * r(i);
  const ContactVector damper = -(system_.damper.at(p(eta)).compliance * f);
  const ContactVector base = damper - r;
  values.resize(9 + 5 * (m - 1) + std::ssize(system_.outputs));
  for (std::size_t i = 0; i < system_.outputs.size(); ++i)
    values(9 + 5 * (m - 1) + static_cast<Index>(i)) = system_.outputs[i].amplitude(p(eta), f);
  values(S) = threshold(0, p(preload));
  values(beta) = lag(base(0));
  values(alpha) = lag(damper(0));
  values(psi) = lag(r(0));
  for (Index i = 0; i < m; ++i) {
    const double ratio = std::abs(r(i)) / threshold(i, p(preload));
    const double energy = slips(regime, i) ? dissipated_energy(std::log(ratio)) : 0;
    if (i == 0) {
      values(R) = std::abs(r(0));
      values(R_over_S) = ratio;
      values(Y) = std::abs(base(0));
      values(U) = std::abs(damper(0));
      values(dissipated) = energy;
    } else {
      values.segment<5>(9 + 5 * (i - 1)) << std::abs(r(i)), ratio, std::abs(base(i)), std::abs(damper(i)),
          energy;
    }
  }
}

double MultiContactResponse::observe(const Vector& u, const Vector& p, int regime, Index /*which*/,
                                     continuation::Gradient& gradient) const {
  const ContactReceptance damper = system_.damper.at(p(eta));
  const ContactVector r = complex_of(u);
  std::array<Law, most_contacts> laws;
  Complex y = -r(0);
  Complex by_eta = 0;
  for (Index j = 0; j < contacts(); ++j) {
    const Law& at = laws[static_cast<std::size_t>(j)] = law(r(j), j, p(preload), regime);
    y -= damper.compliance(0, j) * at.spring * r(j);
    by_eta -= damper.compliance_eta(0, j) * at.spring * r(j);
  }
  const double amplitude = std::abs(y);
  const Complex direction = std::conj(y) / amplitude;
  gradient.parameters << std::real(direction * by_eta), 0;
  for (Index j = 0; j < contacts(); ++j) {
    const Law& at = laws[static_cast<std::size_t>(j)];
    const Complex by_r = direction * (-damper.compliance(0, j) * at.spring - (j == 0 ? 1.0 : 0.0));
    const double by_log_R = -std::real(direction * damper.compliance(0, j) * at.spring_log * r(j));
    const double square = slips(regime, j) ? std::norm(r(j)) : 1;
    gradient.unknowns(2 * j) = by_r.real() + by_log_R * r(j).real() / square;
    gradient.unknowns(2 * j + 1) = -by_r.imag() + by_log_R * r(j).imag() / square;
    gradient.parameters(preload) -= by_log_R / p(preload);
  }
  return amplitude;
}

std::vector<double> MultiContactResponse::landmarks(Index parameter, double from, double to) const {
  if (parameter != eta) return {};
  Vector springs(contacts());
  for (Index i = 0; i < contacts(); ++i) springs(i) = system_.contacts[static_cast<std::size_t>(i)].stiffness;
  std::vector<double> values = joined_frequencies({&system_.base, &system_.damper}, springs);
  for (const double value : joined_frequencies({&system_.damper}, springs)) values.push_back(value);
  for (const ContactModes* structure : {&system_.base, &system_.damper}) {
    for (const ContactMode& mode : structure->modes()) values.push_back(mode.frequency);
  }
  std::erase_if(values, [&](double value) { return !(value > from && value < to); });
  return values;
}

continuation::Guess MultiContactResponse::guess(double eta_value, double preload_value) const {
  if (!(eta_value > 0 && preload_value > 0))
    throw std::invalid_argument("MultiContactResponse: eta and the preload must be positive");
  const Index m = contacts();
  const ContactReceptance base = system_.base.at(eta_value);
  ContactMatrix stuck = base.compliance + system_.damper.at(eta_value).compliance;
  for (Index j = 0; j < m; ++j) stuck.col(j) *= system_.contacts[static_cast<std::size_t>(j)].stiffness;
  stuck.diagonal().array() += 1;
  const ContactVector r = -(stuck.partialPivLu().solve(base.free));
  continuation::Guess guess{Vector(2 * m), Vector(2), 0};
  double holding = 0;  // the preload that lets nothing slip
  for (Index i = 0; i < m; ++i) {
    guess.unknowns(2 * i) = r(i).real();
    guess.unknowns(2 * i + 1) = r(i).imag();
    holding = std::max(holding, std::abs(r(i)) / threshold(i, 1));
  }
  guess.parameters << eta_value, preload_value;
  if (preload_value >= holding) return guess;

  continuation::TraceOptions options;
  options.parameter = "P";
  options.from = 1.5 * holding;
  options.to = preload_value;
  const continuation::Branch branch = trace(*this, guess, options);
  if (!branch.complete())
    throw std::invalid_argument("MultiContactResponse: no way from a high preload: " + branch.explanation);
  const continuation::BranchPoint& end = branch.points.back();
  return {end.unknowns, end.parameters, end.regime};
}

}  // namespace arcslip::problems
