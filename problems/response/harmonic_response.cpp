#include "arcslip/problems/response/harmonic_response.hpp"

#include <algorithm>
#include <cmath>

#include "arcslip/problems/response/contact_problem.hpp"

namespace arcslip::problems {
namespace {

/// Puts values of the contacts into the rows of one of n harmonics.
template <class Column>
void store(const ContactVector& values, Index which, Index n, Column&& column) {
  for (Index i = 0; i < values.size(); ++i) {
    column(2 * (i * n + which)) = values(i).real();
    column(2 * (i * n + which) + 1) = values(i).imag();
  }
}

}  // namespace

/// Forces of all elements with what they were found for: work space of a thread.
struct HarmonicResponse::Forces {
  std::vector<int> orders;
  Vector unknowns;
  int regime = 0;
  std::vector<ElementForce> of_elements;
};

HarmonicResponse::Forces& HarmonicResponse::last_forces() {
  thread_local Forces last;
  return last;
}

HarmonicVector HarmonicResponse::motion(const Vector& u, Index coordinate) const {
  HarmonicVector r(harmonics());
  for (Index a = 0; a < harmonics(); ++a) {
    const Index place = 2 * (coordinate * harmonics() + a);
    r(a) = {u(place), u(place + 1)};
  }
  return r;
}

double HarmonicResponse::slip_threshold(Index contact, const Vector& p) const {
  return coordinates_.element(contact).slip_threshold(load(p));
}

const std::vector<ElementForce>& HarmonicResponse::forces(const Vector& u, const Vector& p, int regime,
                                                          bool derivatives) const {
  Forces& last = last_forces();
  last.orders = system_.orders;
  last.unknowns = u;
  last.regime = regime;
  last.of_elements.resize(at(coordinates_.size()));
  for (Index i = 0; i < coordinates_.size(); ++i) {
    coordinates_.element(i).force(system_.orders, motion(u, i), load(p), slips(regime, i), derivatives,
                                  last.of_elements[at(i)]);
  }
  return last.of_elements;
}

/// max |r| of a contact: known where the forces were last found, as at each point that a corrector ends on.
OddMotion::Maximum HarmonicResponse::maximum(const Vector& u, Index contact) const {
  const Forces& last = last_forces();
  if (slips(last.regime, contact) && last.orders == system_.orders && last.unknowns == u)
    return last.of_elements[at(contact)].maximum;
  const HarmonicVector r = motion(u, contact);
  return OddMotion(system_.orders, r).maximum();
}

HarmonicResponse::ElementForces HarmonicResponse::element_forces(const Vector& u, const Vector& p,
                                                                 int regime) const {
  const std::vector<ElementForce>& all = forces(u, p, regime, false);
  ElementForces sum{{}, {}, 0};
  for (Index a = 0; a < harmonics(); ++a) {
    sum.base.push_back(coordinates_.forces_on(&Coordinate::base, all, a));
    sum.damper.push_back(coordinates_.forces_on(&Coordinate::damper, all, a));
  }
  for (const ElementForce& one : all) sum.energy += one.energy;
  return sum;
}

void HarmonicResponse::set_order(Index which, double eta_value, int regime, Order& order) const {
  const double h = system_.orders[at(which)];
  ContactReceptance& joint = order.joint;
  order.which = which;
  coordinates_.receptance(system_.base[at(which)], system_.damper[at(which)], h * eta_value, joint);
  if (regime == 0 && which > 0 && !coordinates_.has_others()) {  // x_h = 0, also where C_h has a resonance
    joint.compliance.setZero();
    joint.compliance_eta.setZero();
  }
  for (Index j = 0; j < coordinates_.size(); ++j) {
    const double stiffness = coordinates_.element(j).reference_stiffness();
    joint.compliance.col(j) *= stiffness;
    joint.compliance_eta.col(j) *= h * stiffness;
  }
  joint.compliance.diagonal().array() += 1.0;
  joint.free_eta *= h;
  order.inverse = joint.compliance;
  invert(order.inverse);
  order.weight = 1 / std::sqrt(1 + order.inverse.squaredNorm());
}

/// Work space of a thread: F and what its derivatives by the unknowns consist of.
struct HarmonicResponse::Rows {
  Order order;
  Vector residual;
  Vector weight;      // of each order, over |r|
  ComplexMatrix own;  // derivative by f: orders x pairs of contacts, that of the column first
  ComplexVector sum;  // of f by Re r_h and Im r_h
  ComplexVector difference;
};

bool HarmonicResponse::evaluate(const Vector& u, const Vector& p, int regime,
                                const continuation::Evaluation& out) const {
  return evaluate(u, p, regime, 1, out);
}

/// Under `share` times the load, by which the derivative follows those by the parameters if there is a column
/// for it.
bool HarmonicResponse::evaluate(const Vector& u, const Vector& p, int regime, double share,
                                const continuation::Evaluation& out) const {
  if (!(p(eta) > 0 && p(preload) > 0 && load(p) > 0 && u.squaredNorm() > 0)) return false;
  for (Index i = 0; i < contacts(); ++i) {
    if (slips(regime, i) && u.segment(2 * i * harmonics(), 2 * harmonics()).isZero(0)) return false;
  }
  const bool derivatives = out.jacobian != nullptr || out.parameter_jacobian != nullptr;
  const std::vector<ElementForce>& elements = forces(u, p, regime, derivatives);
  thread_local Rows rows;
  fill_rows(elements, share, u, p, regime, rows, out.parameter_jacobian);
  if (out.residual != nullptr) *out.residual = rows.residual;
  if (out.jacobian != nullptr) fill_jacobian(rows, elements, u, regime, *out.jacobian);
  return true;
}

void HarmonicResponse::fill_rows(const std::vector<ElementForce>& elements, double share, const Vector& u,
                                 const Vector& p, int regime, Rows& rows, Matrix* parameter_jacobian) const {
  rows.residual.resize(size());
  rows.weight.resize(harmonics());
  rows.own.resize(harmonics(), coordinates_.size() * coordinates_.size());
  for (Index a = 0; a < harmonics(); ++a) {
    set_order(a, p(eta), regime, rows.order);
    fill_order(rows.order, elements, share, u, p, rows, parameter_jacobian);
  }
}

void HarmonicResponse::fill(const std::vector<ElementForce>& elements, const Vector& u, const Vector& p,
                            int regime, Matrix& jacobian, Matrix& parameter_jacobian) const {
  Rows rows;
  fill_rows(elements, 1, u, p, regime, rows, &parameter_jacobian);
  fill_jacobian(rows, elements, u, regime, jacobian);
}

/// The rows of one harmonic but for their derivatives by the unknowns.
void HarmonicResponse::fill_order(Order& order, const std::vector<ElementForce>& elements, double share,
                                  const Vector& u, const Vector& p, Rows& rows,
                                  Matrix* parameter_jacobian) const {
  const Index m = coordinates_.size();
  const Index which = order.which;
  for (ContactVector* vector : {&order.f, &order.gap, &order.held, &order.residual}) vector->resize(m);
  for (Index j = 0; j < m; ++j) {
    const Index row = 2 * (j * harmonics() + which);
    order.f(j) = elements[at(j)].harmonics(which) / coordinates_.element(j).reference_stiffness();
    order.gap(j) = Complex(u(row), u(row + 1)) - order.f(j) + share * order.joint.free(j);
  }
  order.held.noalias() = order.inverse * order.gap;
  order.gap.noalias() -= order.joint.compliance * order.held;
  order.held.noalias() += order.inverse * order.gap;  // as exact as by factors
  const double weight = order.weight / u.norm();
  order.residual = weight * (order.f + order.held);
  store(order.residual, which, harmonics(), rows.residual);
  rows.weight(which) = weight;
  for (Index j = 0; j < m; ++j) {
    for (Index i = 0; i < m; ++i)
      rows.own(which, j * m + i) = weight * ((i == j ? 1.0 : 0.0) - order.inverse(i, j));
  }
  if (parameter_jacobian == nullptr) return;
  ContactVector& column = order.gap;
  Complex slope = 0;  // of the weight's logarithm, over its square
  for (Index j = 0; j < m; ++j) {
    order.f.noalias() = order.joint.compliance_eta * order.inverse.col(j);
    column.noalias() = order.inverse * order.f;
    slope += order.inverse.col(j).dot(column);
  }
  for (Index j = 0; j < m; ++j)
    order.f(j) = elements[at(j)].by_log_load(which) / coordinates_.element(j).reference_stiffness();
  column = order.f;
  column.noalias() -= order.inverse * order.f;  // by the logarithm of the load
  column *= weight / load(p);
  store(column, which, harmonics(), parameter_jacobian->col(preload));
  order.f = share * order.joint.free_eta;
  order.f.noalias() -= order.joint.compliance_eta * order.held;
  column *= 2 * system_.preload_growth * p(eta);
  column += (order.weight * order.weight * slope.real()) * order.residual;
  column.noalias() += weight * (order.inverse * order.f);
  store(column, which, harmonics(), parameter_jacobian->col(eta));
  if (parameter_jacobian->cols() == 2) return;
  column.noalias() = weight * (order.inverse * order.joint.free);
  store(column, which, harmonics(), parameter_jacobian->col(2));
}

/// Column by column, in which the harmonics of a coordinate's rows follow one another.
void HarmonicResponse::fill_jacobian(Rows& rows, const std::vector<ElementForce>& elements, const Vector& u,
                                     int regime, Matrix& jacobian) const {
  const Index n = harmonics();
  const Index m = coordinates_.size();
  jacobian.noalias() = (-1 / u.squaredNorm() * rows.residual) * u.transpose();
  for (Index column = 0; column < m * n; ++column) {
    const Index from = column / n;
    const Index order = column % n;
    jacobian(2 * column, 2 * column) += rows.weight(order);
    jacobian(2 * column + 1, 2 * column + 1) += rows.weight(order);
    if (is_linear(regime, from)) continue;  // f = x
    const ElementForce& element = elements[at(from)];
    const double per_k = 1 / coordinates_.element(from).reference_stiffness();
    rows.sum = (element.linear.col(order) + element.conjugate.col(order)) * per_k;
    rows.difference = (element.linear.col(order) - element.conjugate.col(order)) * Complex(0, per_k);
    rows.sum(order) -= 1;
    rows.difference(order) -= Complex(0, 1);
    for (Index i = 0; i < m; ++i) {
      const auto part = [&](Index real_column) {
        return Eigen::Map<Eigen::ArrayXcd>(
            reinterpret_cast<Complex*>(jacobian.col(real_column).data() + 2 * i * n), n);
      };
      const auto own = rows.own.col(from * m + i).array();
      part(2 * column) += own * rows.sum.array();
      part(2 * column + 1) += own * rows.difference.array();
    }
  }
}

void HarmonicResponse::scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const {
  unknowns.setConstant(u.norm());
  parameters = p;
}

double HarmonicResponse::border(const Vector& u, const Vector& p, int regime, int border,
                                continuation::Gradient* gradient) const {
  const StateBorder at_border =
      coordinates_.element(border).border(system_.orders, maximum(u, border), load(p), slips(regime, border));
  if (gradient != nullptr) {
    gradient->unknowns.setZero();
    for (Index a = 0; a < harmonics(); ++a) {
      const Index place = 2 * (border * harmonics() + a);
      gradient->unknowns(place) = at_border.by_motion(a).real();
      gradient->unknowns(place + 1) = at_border.by_motion(a).imag();
    }
    const double by_load = at_border.by_log_load / load(p);
    gradient->parameters << 2 * system_.preload_growth * p(eta) * by_load, by_load;
  }
  return at_border.value;
}

std::vector<continuation::Observable> HarmonicResponse::observables() const {
  std::vector<continuation::Observable> all = {{"R"},    {"S"},     {"R_over_S"}, {"Y", true},   {"U"},
                                               {"beta"}, {"alpha"}, {"psi"},      {"dissipated"}};
  add_further_contacts(all);
  for (const ContactOutput& output : system_.outputs) all.push_back({output.name});
  if (harmonics() == 1) return all;
  for (const char* name : {"R_peak", "Y_peak", "U_peak"}) all.push_back({name});
  add_higher_harmonics(all);
  return all;
}

void HarmonicResponse::observe(const Vector& u, const Vector& p, int regime, Vector& values) const {
  const Index m = contacts();
  const Index n = harmonics();
  const std::vector<ElementForce>& elements = forces(u, p, regime, false);
  values.resize(9 + 5 * (m - 1) + std::ssize(system_.outputs) + (n > 1 ? 3 * n : 0));
  Index place = 9 + 5 * (m - 1) + std::ssize(system_.outputs) + 3;
  HarmonicVector base(n), damper(n);  // of the first contact
  const HarmonicVector first = motion(u, 0);
  for (Index a = 0; a < n; ++a) {
    const ContactVector on_damper = coordinates_.forces_on(&Coordinate::damper, elements, a);
    const ContactVector moved =
        system_.damper[at(a)].at(system_.orders[at(a)] * p(eta)).compliance * on_damper;
    damper(a) = moved(0);
    base(a) = moved(0) - first(a);
    if (a > 0) {
      for (const Complex value : {first(a), base(a), damper(a)}) values(place++) = std::abs(value);
      continue;
    }
    for (Index i = 0; i < m; ++i) {
      const Complex r = motion(u, i)(0);
      const double amplitude = std::abs(r);
      const double threshold = slip_threshold(i, p);
      const double ratio = amplitude / threshold;
      const double energy =
          elements[at(i)].energy / (system_.contacts[at(i)].stiffness * threshold * threshold);
      if (i > 0) {
        values.segment<5>(9 + 5 * (i - 1)) << amplitude, ratio, std::abs(moved(i) - r), std::abs(moved(i)),
            energy;
      } else {
        values.head<9>() << amplitude, threshold, ratio, std::abs(base(0)), std::abs(damper(0)), lag(base(0)),
            lag(damper(0)), lag(r), energy;
      }
    }
    const ContactVector on_base = coordinates_.forces_on(&Coordinate::base, elements, a);
    for (std::size_t i = 0; i < system_.outputs.size(); ++i) {
      const ContactOutput& output = system_.outputs[i];
      values(9 + 5 * (m - 1) + static_cast<Index>(i)) =
          output.amplitude(p(eta), output.on_base ? on_base : on_damper);
    }
  }
  if (n == 1) return;
  const auto peak = [&](const HarmonicVector& motion) {
    return OddMotion(system_.orders, motion).maximum().value;
  };
  values.segment<3>(9 + 5 * (m - 1) + std::ssize(system_.outputs)) << peak(first), peak(base), peak(damper);
}

double HarmonicResponse::observe(const Vector& u, const Vector& p, int regime, Index /*which*/,
                                 continuation::Gradient& gradient) const {
  const std::vector<ElementForce>& elements = forces(u, p, regime, true);
  const ContactReceptance damper = system_.damper[0].at(p(eta));
  const auto per_force = [&](Index j) {
    return -coordinates_[j].damper * damper.compliance(0, coordinates_[j].dof);
  };
  Complex y = -Complex(u(0), u(1));
  Complex by_eta = 0;
  Complex by_log_load = 0;
  for (Index j = 0; j < coordinates_.size(); ++j) {
    y += per_force(j) * elements[at(j)].harmonics(0);
    by_eta -=
        coordinates_[j].damper * damper.compliance_eta(0, coordinates_[j].dof) * elements[at(j)].harmonics(0);
    by_log_load += per_force(j) * elements[at(j)].by_log_load(0);
  }
  const double amplitude = std::abs(y);
  const Complex direction = std::conj(y) / amplitude;
  for (Index j = 0; j < coordinates_.size(); ++j) {
    for (Index b = 0; b < harmonics(); ++b) {
      const Index place = 2 * (j * harmonics() + b);
      const Complex linear = per_force(j) * elements[at(j)].linear(0, b) - (place == 0 ? 1.0 : 0.0);
      const Complex conjugate = per_force(j) * elements[at(j)].conjugate(0, b);
      gradient.unknowns(place) = std::real(direction * (linear + conjugate));
      gradient.unknowns(place + 1) = -std::imag(direction * (linear - conjugate));
    }
  }
  const double by_load = std::real(direction * by_log_load) / load(p);
  gradient.parameters << std::real(direction * by_eta) + 2 * system_.preload_growth * p(eta) * by_load,
      by_load;
  return amplitude;
}

std::vector<double> HarmonicResponse::landmarks(Index parameter, double from, double to) const {
  if (parameter != eta) return {};
  Vector springs(contacts());
  for (Index i = 0; i < contacts(); ++i) springs(i) = system_.contacts[at(i)].stiffness;
  std::vector<double> values;
  for (Index a = 0; a < harmonics(); ++a) {
    const ContactModes* base = &system_.base[at(a)];
    const ContactModes* damper = &system_.damper[at(a)];
    std::vector<double> found;
    for (const JoinedMode& mode : joined_modes({base, damper}, springs)) found.push_back(mode.frequency);
    for (const JoinedMode& mode : joined_modes({damper}, springs)) found.push_back(mode.frequency);
    for (const ContactModes* structure : {base, damper}) {
      for (const ContactMode& mode : structure->modes()) found.push_back(mode.frequency);
    }
    for (const double value : found) values.push_back(value / system_.orders[at(a)]);
  }
  std::erase_if(values, [&](double value) { return !(value > from && value < to); });
  return values;
}

}  // namespace arcslip::problems
