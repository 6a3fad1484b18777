#include "arcslip/problems/response/modulated_response.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "arcslip/dense.hpp"
#include "arcslip/motion/swing.hpp"

namespace arcslip::problems {
namespace {

using continuation::Evaluation;
using continuation::Gradient;
using continuation::Observable;
using continuation::Regime;

constexpr double least_modulation = 5e-3;  // at which a branch ends

constexpr double fastest = 4;  // nu over eta, of which another is meant by the same lines

/// All lines up to these k and l.
std::vector<Line> lines_up_to(bool odd, int k_most, int l_most) {
  std::vector<Line> all;
  for (int k = odd ? 1 : 0; k <= k_most; k += odd ? 2 : 1) {
    for (int l = k == 0 ? 0 : -l_most; l <= l_most; ++l) all.push_back({k, l});
  }
  return all;
}

void check_followed(const HarmonicSystem& system, const Coordinates& coordinates) {
  const auto refuse = [](const std::string& reason) {
    throw std::invalid_argument("it is not followed " + reason);
  };
  if (system.periods() > 1) refuse("of a response over several periods of the load");
  if (system.varied) refuse("beside a further parameter of the system");
  if (system.one_way) refuse("where friction does not act back on the base");
  if (RigidMotions(system, coordinates).count() > 0) refuse("of parts that elements alone hold");
  for (const std::vector<ContactModes>* structures : {&system.base, &system.damper}) {
    for (const ContactModes& one : *structures) {
      if (one.is_solved() || one.loss().structural != 0)
        refuse("with damping that is neither viscous nor modal");
    }
  }
  const TwoPhases one({{1, 0}}, 1);
  LineForce force;
  for (Index e = 0; e < coordinates.elements(); ++e) {
    if (!coordinates.element(e).in_two_phases(one, 1, ComplexVector::Zero(1), 0, false, force))
      refuse(fmt::format("beside the element \"{}\", only beside contacts, smooth springs and dashpots",
                         coordinates[coordinates.first(e)].name));
  }
}

}  // namespace

ModulatedResponse::ModulatedResponse(HarmonicSystem system, const RingWaves& waves, Index wave, int highest)
    : system_(std::move(system)),
      waves_(waves),
      coordinates_(system_),
      wave_(wave),
      stiffness_(coordinates_.size()),
      balance_((check_followed(system_, coordinates_), balance(highest_order(system_.orders), highest))),
      finer_(balance(2 * highest_order(system_.orders) + 1, 2 * highest)) {
  for (Index i = 0; i < coordinates_.size(); ++i) {
    const Coordinate& first = coordinates_[coordinates_.first(coordinates_.element_of(i))];
    stiffness_(i) = first.element->reference_stiffness(coordinates_[i].part) * first.factor;
  }
  reference_ = Vector::Zero(size());
}

ModulatedResponse::Balance ModulatedResponse::balance(int highest_k, int highest_l) const {
  constexpr Index places = 16;  // of theta_2 in a period of the highest l, and as many more
  Balance made{
      TwoPhases(lines_up_to(all_odd(system_.orders), highest_k, highest_l), places * (highest_l + 1)),
      {},
      {}};
  std::map<Index, RingWaves::Structures> known;
  for (const Line& line : made.phases.lines()) {
    const auto order = std::find(system_.orders.begin(), system_.orders.end(), line.k);
    if (line.l == 0 && order != system_.orders.end()) {
      const auto a = static_cast<std::size_t>(order - system_.orders.begin());
      made.base.push_back(system_.base[a]);
      made.damper.push_back(system_.damper[a]);
      continue;
    }
    const Index wave = waves_.within(line.k * waves_.wave_number() + line.l * wave_);
    auto found = known.find(wave);
    if (found == known.end()) found = known.emplace(wave, waves_.structures(wave)).first;
    made.base.push_back(found->second.base);
    made.damper.push_back(found->second.damper);
  }
  return made;
}

/// Lines x coordinates.
ComplexMatrix ModulatedResponse::motion(const Vector& u) const {
  ComplexMatrix x(count(), coordinates_.size());
  for (Index i = 0; i < x.size(); ++i) x(i) = Complex(u(2 * i), u(2 * i + 1));
  return x;
}

/// Over K, of all lines of all coordinates.
struct ModulatedResponse::Forces {
  ComplexVector value;
  ComplexMatrix by_motion;  // by Re and Im of each x_kl; of no size without derivatives
  ComplexVector by_log_load;
  ComplexVector by_ratio;  // by nu/eta
  ComplexVector viscous;   // by the frequency
};

ModulatedResponse::Forces ModulatedResponse::forces(const Balance& at, const ComplexMatrix& x, double nu,
                                                    const Vector& p, bool derivatives) const {
  const Index n = x.rows();
  const Index all = x.size();
  Forces sum{ComplexVector(all), ComplexMatrix::Zero(derivatives ? all : 0, 2 * all), ComplexVector(all),
             ComplexVector(all), ComplexVector::Zero(all)};
  LineForce found;
  for (Index e = 0; e < coordinates_.elements(); ++e) {
    const Element& element = coordinates_.element(e);
    const Index first = coordinates_.first(e);
    const Index row = first * n;
    if (!element.in_two_phases(at.phases, load(p), x.col(first), nu / p(eta), derivatives, found))
      throw std::logic_error("ModulatedResponse: an element that has no force under two frequencies");
    const double over = coordinates_[first].factor / stiffness_(first);
    const Complex rate(0, two_pi * element.damping().value * over);
    sum.value.segment(row, n) = over * found.force;
    if (derivatives) {
      sum.by_log_load.segment(row, n) = over * found.by_log_load;
      sum.by_ratio.segment(row, n) = over * found.by_ratio;
    }
    sum.viscous.segment(row, n) = rate * x.col(first);
    for (Index a = 0; a < n; ++a) {
      const Complex damping = frequency(at, a, nu, p) * rate;
      sum.value(row + a) += damping * x(a, first);
      if (!derivatives) continue;
      auto by_real = sum.by_motion.col(2 * (row + a)).segment(row, n);
      auto by_imaginary = sum.by_motion.col(2 * (row + a) + 1).segment(row, n);
      by_real = over * (found.linear.col(a) + found.conjugate.col(a));
      by_imaginary = Complex(0, over) * (found.linear.col(a) - found.conjugate.col(a));
      by_real(a) += damping;
      by_imaginary(a) += damping * Complex(0, 1);
    }
  }
  return sum;
}

void ModulatedResponse::fill(const Balance& at, const ComplexMatrix& x, double nu, const Vector& p,
                             bool derivatives, Rows& rows) const {
  const Index n = x.rows();
  const Forces forces = this->forces(at, x, nu, p, derivatives);
  rows.force = forces.value;
  rows.residual.resize(x.size());
  rows.weight.resize(n);
  if (derivatives) {
    rows.by_motion.resize(x.size(), 2 * x.size());
    for (ComplexVector* one : {&rows.by_nu, &rows.by_eta, &rows.by_preload}) one->resize(x.size());
  }
  Coordinates::Each each;
  ContactReceptance joint;
  for (Index a = 0; a < n; ++a) {
    const auto which = static_cast<std::size_t>(a);
    coordinates_.receptance(at.base[which], at.damper[which], frequency(at, a, nu, p), each, joint);
    if (at.phases.lines()[which].l != 0) {
      joint.free.setZero();
      joint.free_eta.setZero();
    }
    fill_line(at.phases.lines()[which], a, x, forces, joint, nu, p, derivatives, rows);
  }
}

/// R = f + (1 + C K)^{-1} (x - f - x0) of one line of all coordinates.
void ModulatedResponse::fill_line(const Line& line, Index a, const ComplexMatrix& x, const Forces& forces,
                                  const ContactReceptance& joint, double nu, const Vector& p,
                                  bool derivatives, Rows& rows) const {
  const Index n = x.rows();
  const Index m = x.cols();
  const auto of = [&](const ComplexVector& all) {
    ComplexVector own(m);
    for (Index i = 0; i < m; ++i) own(i) = all(i * n + a);
    return own;
  };
  ContactMatrix inverse = joint.compliance * stiffness_.asDiagonal();
  inverse.diagonal().array() += 1;
  invert(inverse);
  const ComplexVector f = of(forces.value);
  const ComplexVector held = inverse * (x.row(a).transpose() - f + joint.free);
  for (Index i = 0; i < m; ++i) rows.residual(i * n + a) = f(i) + held(i);
  rows.weight(a) = 1 / std::sqrt(1 + inverse.squaredNorm());
  if (!derivatives) return;
  const ContactMatrix other = ContactMatrix::Identity(m, m) - inverse;  // by f
  const ComplexVector by_load = other * of(forces.by_log_load) / load(p);
  const ComplexVector by_ratio = other * of(forces.by_ratio) / p(eta);
  const ComplexVector by_frequency =
      other * of(forces.viscous) +
      inverse * (joint.free_eta - joint.compliance_eta * ComplexVector(stiffness_.asDiagonal() * held));
  for (Index i = 0; i < m; ++i) {
    const Index row = i * n + a;
    rows.by_motion.row(row).setZero();
    for (Index j = 0; j < m; ++j) {
      rows.by_motion.row(row) += other(i, j) * forces.by_motion.row(j * n + a);
      rows.by_motion(row, 2 * (j * n + a)) += inverse(i, j);
      rows.by_motion(row, 2 * (j * n + a) + 1) += Complex(0, 1) * inverse(i, j);
    }
    rows.by_nu(row) = static_cast<double>(line.l) * by_frequency(i) + by_ratio(i);
    rows.by_eta(row) = static_cast<double>(line.k) * by_frequency(i) - nu / p(eta) * by_ratio(i) +
                       2 * system_.preload_growth * p(eta) * by_load(i);
    rows.by_preload(row) = by_load(i);
  }
}

bool ModulatedResponse::evaluate(const Vector& u, const Vector& p, const Regime& /*regime*/,
                                 const Evaluation& out) const {
  const Index last = size() - 1;
  if (!(p(eta) > 0 && load(p) > 0 && std::abs(u(last)) < fastest * p(eta))) return false;
  Rows rows;
  const bool derivatives = out.jacobian != nullptr || out.parameter_jacobian != nullptr;
  const ComplexMatrix x = motion(u);
  fill(balance_, x, u(last), p, derivatives, rows);
  const Index n = count();
  if (out.jacobian) out.jacobian->setZero();
  if (out.parameter_jacobian) out.parameter_jacobian->setZero();
  for (Index row = 0; row < rows.residual.size(); ++row) {
    const double weight = rows.weight(row % n) / size_;
    const bool is_mean = line(row) == Line{0, 0};
    const auto put = [&](const auto& values, auto&& real, auto&& imaginary) {
      real = weight * values.real();
      imaginary = weight * values.imag();
    };
    if (out.residual) put(rows.residual(row), (*out.residual)(2 * row), (*out.residual)(2 * row + 1));
    if (out.jacobian) {
      put(rows.by_motion.row(row), out.jacobian->row(2 * row).head(last),
          out.jacobian->row(2 * row + 1).head(last));
      put(rows.by_nu(row), (*out.jacobian)(2 * row, last), (*out.jacobian)(2 * row + 1, last));
    }
    if (out.parameter_jacobian) {
      Matrix& by = *out.parameter_jacobian;
      put(rows.by_eta(row), by(2 * row, eta), by(2 * row + 1, eta));
      put(rows.by_preload(row), by(2 * row, preload), by(2 * row + 1, preload));
    }
    if (!is_mean) continue;  // a real coefficient
    if (out.residual) (*out.residual)(2 * row + 1) = u(2 * row + 1) / size_;
    if (out.jacobian) {
      out.jacobian->row(2 * row + 1).setZero();
      (*out.jacobian)(2 * row + 1, 2 * row + 1) = 1 / size_;
    }
  }
  Vector phase = Vector::Zero(last);  // sum l Im(conj(reference) x)
  for (Index i = 0; i < last / 2; ++i) {
    const int l = line(i).l;
    phase(2 * i) = -l * reference_(2 * i + 1) / size_;
    phase(2 * i + 1) = l * reference_(2 * i) / size_;
  }
  if (out.residual) (*out.residual)(last) = phase.dot(u.head(last));
  if (out.jacobian) out.jacobian->row(last).head(last) = phase.transpose();
  return true;
}

void ModulatedResponse::scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const {
  unknowns.setConstant(u.size(), size_);
  unknowns(u.size() - 1) = p(eta);
  parameters = p.cwiseAbs();
}

double ModulatedResponse::border(const Vector& u, const Vector& p, const Regime& /*regime*/, int /*border*/,
                                 Gradient* gradient) const {
  Vector modulated = u;
  modulated(u.size() - 1) = 0;
  const double all = modulated.squaredNorm();
  for (Index i = 0; i < u.size() / 2; ++i) {
    if (line(i).l == 0) modulated.segment<2>(2 * i).setZero();
  }
  const double part = modulated.squaredNorm() / all;
  if (gradient) {
    gradient->unknowns = 2 / all * (part * u - modulated);
    gradient->unknowns(u.size() - 1) = 0;
    gradient->parameters.setZero(p.size());
  }
  return least_modulation * least_modulation - part;
}

std::vector<Observable> ModulatedResponse::observables() const {
  std::vector<Observable> all;
  for (const char* name : {"R", "Y", "U", "R_peak", "Y_peak", "U_peak", "frequency_2", "wave_2", "modulation",
                           "modulation_error"})
    all.push_back({name});
  return all;
}

ComplexMatrix ModulatedResponse::first_contact(const Vector& u, const Vector& p) const {
  const double nu = u(size() - 1);
  const Index n = count();
  const ComplexMatrix x = motion(u);
  Rows rows;
  fill(balance_, x, nu, p, false, rows);
  ComplexMatrix moved(n, 3);
  moved.col(0) = x.col(0);
  for (Index a = 0; a < n; ++a) {
    const auto which = static_cast<std::size_t>(a);
    const Line& line = lines()[which];
    const auto of = [&](const ContactModes& structure, bool is_base) {
      const ContactReceptance at = structure.at(frequency(balance_, a, nu, p));
      Complex sum = is_base && line.l == 0 ? at.free(0) : 0;
      for (Index i = 0; i < coordinates_.size(); ++i) {
        const Coordinate& one = coordinates_[i];
        sum -= at.compliance(0, one.dof) * one.push(is_base) * stiffness_(i) * rows.force(i * n + a);
      }
      return sum;
    };
    moved(a, 1) = of(balance_.base[which], true);
    moved(a, 2) = of(balance_.damper[which], false);
  }
  return moved;
}

void ModulatedResponse::observe(const Vector& u, const Vector& p, const Regime& regime,
                                Vector& values) const {
  observe_quickly(u, p, regime, values);
  values(modulation_error) = error(u, p);
}

void ModulatedResponse::observe_quickly(const Vector& u, const Vector& p, const Regime& regime,
                                        Vector& values) const {
  const ComplexMatrix moved = first_contact(u, p);
  const auto first = std::find(lines().begin(), lines().end(), Line{1, 0}) - lines().begin();
  values.resize(modulation_error + 1);
  for (Index i = 0; i < 3; ++i) {
    values(R + i) = std::abs(moved(first, i));
    values(R_peak + i) = balance_.phases.greatest(moved.col(i));
  }
  const double nu = u(size() - 1);
  values(frequency_2) = std::abs(nu);
  values(wave_2) = static_cast<double>(waves_.within(nu < 0 ? -wave_ : wave_));
  values(modulation) = std::sqrt(least_modulation * least_modulation - border(u, p, regime, 0, nullptr));
  values(modulation_error) = std::numeric_limits<double>::quiet_NaN();
}

/// In lines that it has by the balance's own derivatives, in others as the force there moves it.
double ModulatedResponse::error(const Vector& u, const Vector& p) const {
  const Index last = size() - 1;
  const Index n = count();
  const Index m = coordinates_.size();
  const std::vector<Line>& fine = finer_.phases.lines();
  const auto own = [&](const Line& line) {
    const auto& all = lines();
    const auto found = std::find(all.begin(), all.end(), line);
    return found == all.end() ? Index{-1} : static_cast<Index>(found - all.begin());
  };
  const ComplexMatrix x = motion(u);
  ComplexMatrix wide = ComplexMatrix::Zero(std::ssize(fine), m);
  for (Index a = 0; a < wide.rows(); ++a) {
    if (const Index known = own(fine[static_cast<std::size_t>(a)]); known >= 0) wide.row(a) = x.row(known);
  }
  Rows rows;
  fill(finer_, wide, u(last), p, false, rows);
  Vector left = Vector::Zero(size());
  double others = 0;
  for (Index row = 0; row < rows.residual.size(); ++row) {
    const Index a = row % wide.rows();
    const Index known = own(fine[static_cast<std::size_t>(a)]);
    if (known < 0) {
      others += std::norm(rows.residual(row));
      continue;
    }
    const Complex value = rows.residual(row) * rows.weight(a) / size_;
    const Index place = 2 * (row / wide.rows() * n + known);
    left(place) = value.real();
    left(place + 1) = value.imag();
  }
  Matrix jacobian(size(), size());
  Matrix by_parameters(size(), 2);
  if (!evaluate(u, p, {}, {nullptr, &jacobian, &by_parameters}))
    return std::numeric_limits<double>::quiet_NaN();
  const double amplitude = u.head(last).norm();
  Matrix rates(size(), size() + 1);  // by what is measured in its own size
  rates << jacobian.leftCols(last) * amplitude, jacobian.col(last) * p(eta), by_parameters.col(eta) * p(eta);
  const Vector moved = shortest(rates, left);
  return std::sqrt(others / (amplitude * amplitude) + moved.squaredNorm());
}

}  // namespace arcslip::problems
