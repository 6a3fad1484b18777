#include "arcslip/problems/response/harmonic_response.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "arcslip/problems/response/contact_problem.hpp"
#include "arcslip/structure/block_circulant.hpp"
#include "harmonic_jacobian.hpp"

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

HarmonicResponse::HarmonicResponse(HarmonicSystem system, Index matrix_up_to)
    : HarmonicProblem(std::move(system), {.eta = {Place::parameters, eta},
                                          .preload = {Place::parameters, preload},
                                          .real = {Place::unknowns, 0},
                                          .imaginary = {Place::unknowns, 1}}),
      is_odd_(all_odd(system_.orders)),
      matrix_up_to_(matrix_up_to) {
  if (system_.varied) layout_.varied = {Place::parameters, further};
  quantities_ = {{"R", Measure::amplitude},
                 {"S", Measure::threshold},
                 {"R_over_S", Measure::ratio},
                 {"Y", Measure::amplitude, Body::base},
                 {"U", Measure::amplitude, Body::damper},
                 {"beta", Measure::lag, Body::base},
                 {"alpha", Measure::lag, Body::damper},
                 {"psi", Measure::lag},
                 {"dissipated", Measure::dissipated}};
  add_readings(0, "");
  system_.sectors > 1 ? add_ring() : add_further_contacts();
  for (const ContactOutput& output : system_.outputs) {
    quantities_.push_back({output.name, output.is_lag ? Measure::lag : Measure::amplitude, Body::output,
                           &output - system_.outputs.data()});
  }
  add_further_elements();
  add_drifts();
  if (harmonics() == 1) return;
  quantities_.push_back({"R_peak", Measure::greatest});
  quantities_.push_back({"Y_peak", Measure::greatest, Body::base});
  quantities_.push_back({"U_peak", Measure::greatest, Body::damper});
  add_other_harmonics();
  add_outputs_in_time();
}

/// The other harmonics of outputs, and their greatest values in time.
void HarmonicResponse::add_outputs_in_time() {
  if (system_.outputs_of_orders.empty()) return;
  for (Index i = 0; i < std::ssize(system_.outputs); ++i) {
    const ContactOutput& output = system_.outputs[at(i)];
    if (output.is_lag) continue;
    quantities_.push_back({output.name + "_peak", Measure::greatest, Body::output, i});
    for (Index a = 1; a < harmonics(); ++a) {
      const Measure measure = system_.orders[at(a)] == 0 ? Measure::mean : Measure::amplitude;
      quantities_.push_back({name_of(output.name, a), measure, Body::output, i, a});
    }
  }
}

HarmonicVector HarmonicResponse::motion(const Vector& u, Index coordinate) const {
  return HarmonicProblem::motion(u, {}, coordinate);
}

HarmonicResponse::ElementForces HarmonicResponse::element_forces(const Vector& u, const Vector& p,
                                                                 const continuation::Regime& regime) const {
  const std::vector<ElementForce>& all = forces(u, p, regime, false);
  ElementForces sum{{}, {}, 0};
  for (Index a = 0; a < harmonics(); ++a) {
    coordinates_.forces_on(true, all, a, sum.base.emplace_back());
    coordinates_.forces_on(false, all, a, sum.damper.emplace_back());
  }
  for (const ElementForce& one : all) sum.energy += one.energy;
  if (rigid_.count() == 0) return sum;
  Rest rest;
  respond_at_rest(u, p, rest);
  const ComplexVector motions = rigid_.parts() * moved_at_rest(rest, all, u, p);
  ComplexVector drifts(coordinates());
  for (Index i = 0; i < coordinates(); ++i)
    drifts(i) = HarmonicProblem::motion(u, p, i)(rigid_.order()).imag();
  sum.drag = two_pi * (rigid_.parts() * drifts).dot(drag(p) * drifts).real();
  sum.base_moved.resize(contacts());
  sum.damper_moved.resize(contacts());
  for (Index i = 0; i < contacts(); ++i) {
    const auto moved = [&](const std::vector<ContactModes>& structure, bool is_base) {
      return (rigid_.at(structure[at(rigid_.order())], is_base, i).transpose() * motions).value();
    };
    sum.base_moved(i) = moved(system_.base, true);
    sum.damper_moved(i) = moved(system_.damper, false);
  }
  return sum;
}

/// Compliance and free response of one order, with their derivatives by the further parameter.
void HarmonicResponse::set_varied(Order& order, double frequency_value, const Vector& p) const {
  const SystemParameter::At varied = variation({}, p);
  const auto& [here, rate] = varied;
  VariedReceptance base = system_.base[at(order.which)].varied(frequency_value, here.base, rate.base);
  VariedReceptance damper = system_.damper[at(order.which)].varied(frequency_value, here.damper, rate.damper);
  coordinates_.join(base, damper, order.joint);
  base.compliance.swap(base.compliance_rate);
  base.free.swap(base.free_rate);
  damper.compliance.swap(damper.compliance_rate);
  damper.free.swap(damper.free_rate);
  ContactReceptance rates;
  coordinates_.join(base, damper, rates);
  order.by_varied = rates.compliance;
  order.free_by_varied = rates.free;
  for (Index j = 0; j < coordinates_.size(); ++j)
    order.by_varied.col(j) +=
        order.joint.compliance.col(j) * log_force_rate(coordinates_.element_of(j), varied);
}

void HarmonicResponse::set_order(Index which, const Vector& p, const continuation::Regime& regime,
                                 Order& order) const {
  const double h = system_.multiple(which);
  ContactReceptance& joint = order.joint;
  order.which = which;
  if (is_varied()) {
    set_varied(order, h * p(eta), p);
  } else {
    coordinates_.receptance(system_.base[at(which)], system_.damper[at(which)], h * p(eta), order.each,
                            joint);
  }
  if (all_stick(regime) && is_odd_ && which > 0 && !coordinates_.has_others() &&
      joint.free.isZero(0)) {  // x_h = 0, also where C_h has a resonance
    joint.compliance.setZero();
    joint.compliance_eta.setZero();
    order.by_varied.setZero();
  }
  order.stiffness.resize(coordinates_.size());
  for (Index j = 0; j < coordinates_.size(); ++j) {
    const double stiffness = order.stiffness(j) = reference_stiffness(j, {}, p);
    if (is_varied()) order.by_varied.col(j) *= stiffness;
    joint.compliance.col(j) *= stiffness;
    joint.compliance_eta.col(j) *= h * stiffness;
  }
  joint.compliance.diagonal().array() += 1.0;
  joint.free_eta *= h;
  if (rigid_.count() > 0 && system_.orders[at(which)] == 0) {
    border_by_rigid(order, p);
  } else {
    order.bordered.resize(0, 0);
    order.inverse = joint.compliance;
    if (!invert_block_circulant(order.inverse, system_.sectors)) invert(order.inverse);
  }
  set_weight(order);
}

bool HarmonicResponse::evaluate(const Vector& u, const Vector& p, const continuation::Regime& regime,
                                const continuation::Evaluation& out) const {
  return evaluate(u, p, regime, 1, out);
}

/// Under `share` times the load, by which the derivative follows those by the parameters if there is a column
/// for it.
bool HarmonicResponse::evaluate(const Vector& u, const Vector& p, const continuation::Regime& regime,
                                double share, const continuation::Evaluation& out) const {
  if (!(has_value(p) && u.squaredNorm() > 0)) return false;
  for (Index e = 0; e < switch_count(); ++e) {
    const Index count = coordinates_.element(e).coordinates();
    if (slips(regime, e) &&
        u.segment(2 * coordinates_.first(e) * harmonics(), 2 * count * harmonics()).isZero(0))
      return false;
  }
  const bool derivatives =
      out.jacobian != nullptr || out.parameter_jacobian != nullptr || out.condensed_jacobian != nullptr;
  const std::vector<ElementForce>& elements = forces(u, p, regime, derivatives);
  if (derivatives && !remembers_mean(elements, p, regime)) return false;
  thread_local Rows rows;
  rows.condensed = static_cast<HarmonicJacobian*>(out.condensed_jacobian);
  fill_rows(elements, share, u, p, regime, rows, out.parameter_jacobian);
  if (out.residual != nullptr) *out.residual = rows.residual;
  if (out.jacobian != nullptr) fill_jacobian(rows, elements, u, regime, *out.jacobian);
  if (rows.condensed != nullptr) fill_condensed(rows, elements, u, regime);
  return true;
}

void HarmonicResponse::fill_rows(const std::vector<ElementForce>& elements, double share, const Vector& u,
                                 const Vector& p, const continuation::Regime& regime, Rows& rows,
                                 Matrix* parameter_jacobian) const {
  rows.residual.resize(size());
  rows.weight.resize(harmonics());
  if (rows.condensed == nullptr) rows.own.resize(harmonics(), coordinates_.size() * coordinates_.size());
  rows.drifts = onto_drifts(regime);
  for (Index a = 0; a < harmonics(); ++a) {
    set_order(a, p, regime, rows.order);
    fill_order(rows.order, elements, share, u, p, rows, parameter_jacobian);
  }
  if (rows.drifts.size() > 0) set_drifts(u, rows, nullptr);
}

/// The rows of one harmonic but for their derivatives by the unknowns.
void HarmonicResponse::fill_order(Order& order, const std::vector<ElementForce>& elements, double share,
                                  const Vector& u, const Vector& p, Rows& rows,
                                  Matrix* parameter_jacobian) const {
  const Index m = coordinates_.size();
  const Index which = order.which;
  order.f.resize(m);
  order.gap.setZero(order.joint.free.size());
  for (Index j = 0; j < m; ++j) {
    const Index row = 2 * (j * harmonics() + which);
    order.f(j) = elements[at(coordinates_.element_of(j))].harmonics(place(j, which)) / order.stiffness(j);
    order.gap(j) = Complex(u(row), u(row + 1)) - order.f(j) + share * order.joint.free(j);
  }
  const Index rigid = order.gap.size() - m;
  order.gap.tail(rigid) = share * order.joint.free.tail(rigid);
  if (rigid > 0 && rows.drifts.size() > 0) take_drifts(order, u, p, rows);
  order.held.noalias() = order.solver() * order.gap;
  order.gap.noalias() -= order.joint.compliance * order.held;
  order.held.noalias() += order.solver() * order.gap;  // as exact as by factors
  const double weight = order.weight / u.norm();
  order.residual = weight * (order.f + order.held.head(m));
  store(order.residual, which, harmonics(), rows.residual);
  rows.weight(which) = weight;
  if (rows.condensed != nullptr) {
    rows.condensed->set_order(which, order.inverse, weight);
  } else {
    for (Index j = 0; j < m; ++j) {
      for (Index i = 0; i < m; ++i)
        rows.own(which, j * m + i) = weight * ((i == j ? 1.0 : 0.0) - order.inverse(i, j));
    }
  }
  if (parameter_jacobian != nullptr) fill_by_parameters(order, elements, share, p, rows, *parameter_jacobian);
}

/// The columns of a harmonic whose rows are filled.
void HarmonicResponse::fill_by_parameters(Order& order, const std::vector<ElementForce>& elements,
                                          double share, const Vector& p, const Rows& rows,
                                          Matrix& parameter_jacobian) const {
  const Index m = coordinates_.size();
  const Index which = order.which;
  const Index rigid = order.gap.size() - m;
  const double weight = rows.weight(which);
  ContactVector& column = order.gap;
  const auto by_loads = [&](const auto& rate, double factor) {  // at such rates of their logarithms
    order.f.resize(m);
    for (Index j = 0; j < m; ++j) {
      const Index e = coordinates_.element_of(j);
      order.f(j) = elements[at(e)].by_log_load(place(j, which)) / order.stiffness(j) * rate(e);
    }
    column = order.f;
    column.noalias() -= order.inverse * order.f;
    column *= factor;
  };
  by_loads([](Index) { return 1.0; }, weight / pressing({}, p));
  store(column, which, harmonics(), parameter_jacobian.col(preload));
  column *= 2 * growth({}, p) * p(eta);
  const auto add_forces = [&](HarmonicVector ElementForce::*rates) {
    order.f.resize(m);
    for (Index j = 0; j < m; ++j) {
      const HarmonicVector& rate = elements[at(coordinates_.element_of(j))].*rates;
      order.f(j) = rate.size() > 0 ? rate(place(j, which)) / order.stiffness(j) : 0;
    }
    column += weight * order.f;
    column.noalias() -= weight * (order.inverse * order.f);
  };
  add_forces(&ElementForce::by_eta);
  if (rigid > 0 && rows.drifts.size() > 0)
    column += weight / p(eta) * (order.bordered.topRightCorner(m, rigid) * rows.drag);
  add_linear_part(order, order.joint.compliance_eta, order.joint.free_eta, share, weight);
  store(column, which, harmonics(), parameter_jacobian.col(eta));
  if (is_varied()) {
    by_loads([&](Index e) { return log_load_rate(e, {}, p); }, weight);
    add_forces(&ElementForce::by_setting);
    add_linear_part(order, order.by_varied, order.free_by_varied, share, weight);
    store(column, which, harmonics(), parameter_jacobian.col(further));
  }
  const Index by_share = is_varied() ? further + 1 : further;
  if (parameter_jacobian.cols() == by_share) return;
  column.noalias() = weight * (order.solver().topRows(m) * order.joint.free);
  store(column, which, harmonics(), parameter_jacobian.col(by_share));
}

/// Adds to the column in `gap` what changes of 1 + C_h K and of -x0 do, and of the weight by them.
void HarmonicResponse::add_linear_part(Order& order, const ContactMatrix& compliance,
                                       const ContactVector& free, double share, double weight) const {
  const Index m = order.inverse.rows();
  const double slope = weight_slope(order, compliance, free);
  order.f = share * free;
  order.f.noalias() -= compliance * order.held;
  order.gap += (order.weight * order.weight * slope) * order.residual;
  order.gap.noalias() += weight * (order.solver().topRows(m) * order.f);
}

void HarmonicResponse::scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const {
  unknowns.setConstant(u.norm());
  parameters = p;
  if (is_varied()) parameters(further) = varied_scale(u, p);
}

std::vector<double> HarmonicResponse::ring_landmarks(double from, double to) const {
  std::vector<double> values;
  for (Index a = 0; a < harmonics(); ++a) {
    for (const double found : system_.landmarks[at(a)]) {
      const double value = found / system_.multiple(a);
      if (system_.orders[at(a)] != 0 && value > from && value < to) values.push_back(value);
    }
  }
  return values;
}

std::vector<double> HarmonicResponse::landmarks(Index parameter, double from, double to) const {
  if (parameter != eta) return {};
  if (!system_.landmarks.empty()) return ring_landmarks(from, to);
  const Vector springs = contact_springs(system_.contacts);
  std::vector<double> values;
  for (Index a = 0; a < harmonics(); ++a) {
    if (system_.orders[at(a)] == 0) continue;
    const ContactModes* base = &system_.base[at(a)];
    const ContactModes* damper = &system_.damper[at(a)];
    std::vector<double> found;
    for (const JoinedMode& mode : joined_modes({base, damper}, springs)) found.push_back(mode.frequency);
    for (const JoinedMode& mode : joined_modes({damper}, springs)) found.push_back(mode.frequency);
    for (const ContactModes* structure : {base, damper}) {
      for (const ContactMode& mode : structure->modes()) found.push_back(mode.frequency);
    }
    for (const double value : found) values.push_back(value / system_.multiple(a));
  }
  std::erase_if(values, [&](double value) { return !(value > from && value < to); });
  return values;
}

}  // namespace arcslip::problems
