#include "arcslip/problems/harmonic_response.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "arcslip/hysteresis_loop.hpp"
#include "arcslip/problems/contact_problem.hpp"

namespace arcslip::problems {
namespace {

bool slips(int regime, Index contact) { return (regime >> contact & 1) != 0; }

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

}  // namespace

HarmonicResponse::HarmonicResponse(HarmonicSystem system) : system_(std::move(system)) {
  if (harmonics() < 1 || harmonics() > most_harmonics || std::ssize(system_.base) != harmonics() ||
      std::ssize(system_.damper) != harmonics())
    throw std::invalid_argument("HarmonicResponse: base and damper must be given in every harmonic");
  for (Index a = 0; a < harmonics(); ++a) {
    if (system_.base[at(a)].contacts() != contacts() || system_.damper[at(a)].contacts() != contacts())
      throw std::invalid_argument("HarmonicResponse: base, damper and contacts must be as many");
  }
  for (const SectorContact& contact : system_.contacts) {
    if (!(contact.stiffness > 0 && contact.slip_per_preload > 0))
      throw std::invalid_argument("HarmonicResponse: stiffness and slip threshold must be positive");
  }
}

HarmonicVector HarmonicResponse::motion(const Vector& u, Index contact) const {
  HarmonicVector r(harmonics());
  for (Index a = 0; a < harmonics(); ++a) {
    const Index place = 2 * (contact * harmonics() + a);
    r(a) = {u(place), u(place + 1)};
  }
  return r;
}

double HarmonicResponse::load(const Vector& p) const {
  return p(preload) + system_.preload_growth * p(eta) * p(eta);
}

double HarmonicResponse::threshold(Index contact, const Vector& p) const {
  return system_.contacts[at(contact)].slip_per_preload * load(p);
}

const std::vector<HarmonicResponse::Force>& HarmonicResponse::forces(const Vector& u, const Vector& p,
                                                                     int regime, bool derivatives) const {
  thread_local std::vector<Force> all;
  all.resize(at(contacts()));
  for (Index i = 0; i < contacts(); ++i) {
    Force& force = all[at(i)];
    const double k = system_.contacts[at(i)].stiffness;
    const HarmonicVector r = motion(u, i);
    if (!slips(regime, i)) {
      force.harmonics = k * r;
      force.energy = 0;
      if (!derivatives) continue;
      force.linear.setZero(harmonics(), harmonics());
      force.linear.diagonal().setConstant(k);
      force.conjugate.setZero(harmonics(), harmonics());
      force.by_log_threshold.setZero(harmonics());
      continue;
    }
    const double limit = threshold(i, p);
    const OddMotion motion(system_.orders, r);
    const HysteresisLoop loop(motion, limit);
    loop.force(force.harmonics);
    force.harmonics *= k;
    force.energy = loop.energy() / (limit * limit);
    if (!derivatives) continue;
    loop.derivative(force.linear, force.conjugate);
    force.linear *= k;
    force.conjugate *= k;
    force.by_log_threshold = force.harmonics;
    force.by_log_threshold.noalias() -= force.linear * r;
    force.by_log_threshold.noalias() -= force.conjugate * r.conjugate();
  }
  return all;
}

bool HarmonicResponse::evaluate(const Vector& u, const Vector& p, int regime,
                                const continuation::Evaluation& out) const {
  const double size = u.norm();
  if (!(p(eta) > 0 && p(preload) > 0 && load(p) > 0 && size > 0)) return false;
  for (Index i = 0; i < contacts(); ++i) {
    if (slips(regime, i) && motion(u, i).isZero(0)) return false;
  }
  const bool derivatives = out.jacobian != nullptr || out.parameter_jacobian != nullptr;
  const std::vector<Force>& friction = forces(u, p, regime, derivatives);
  const double by_eta = 2 * system_.preload_growth * p(eta) / load(p);  // d ln S/deta
  const Index m = contacts();
  const Index n = harmonics();
  for (Index a = 0; a < n; ++a) {
    const double h = system_.orders[at(a)];
    const ContactReceptance base = system_.base[at(a)].at(h * p(eta));
    const ContactReceptance damper = system_.damper[at(a)].at(h * p(eta));
    const ContactMatrix c = base.compliance + damper.compliance;
    const ContactMatrix c_eta = h * (base.compliance_eta + damper.compliance_eta);
    double norm = 1;
    double norm_eta = 0;
    for (Index j = 0; j < m; ++j) {
      const double k = system_.contacts[at(j)].stiffness;
      norm += k * k * c.col(j).squaredNorm();
      norm_eta += 2 * k * k * std::real(c.col(j).dot(c_eta.col(j)));
    }
    const double weight = 1 / (std::sqrt(norm) * size);
    for (Index i = 0; i < m; ++i) {
      const Index row = 2 * (i * n + a);
      Complex residual = Complex(u(row), u(row + 1)) + (a == 0 ? base.free(i) : 0.0);
      Complex slope = a == 0 ? base.free_eta(i) : 0.0;
      Complex by_log_S = 0;
      for (Index j = 0; j < m; ++j) {
        residual += c(i, j) * friction[at(j)].harmonics(a);
        slope += c_eta(i, j) * friction[at(j)].harmonics(a);
        if (derivatives) by_log_S += c(i, j) * friction[at(j)].by_log_threshold(a);
      }
      const auto store = [&](Complex value, auto&& column) {
        column(row) = value.real();
        column(row + 1) = value.imag();
      };
      if (out.residual != nullptr) store(weight * residual, *out.residual);
      if (out.parameter_jacobian != nullptr) {
        store(weight * (slope + by_log_S * by_eta - residual * (0.5 * norm_eta / norm)),
              out.parameter_jacobian->col(eta));
        store(weight / load(p) * by_log_S, out.parameter_jacobian->col(preload));
      }
      if (out.jacobian == nullptr) continue;
      for (Index j = 0; j < m; ++j) {
        for (Index b = 0; b < n; ++b) {
          const Index column = 2 * (j * n + b);
          const Complex linear = c(i, j) * friction[at(j)].linear(a, b) + (row == column ? 1.0 : 0.0);
          const Complex conjugate = c(i, j) * friction[at(j)].conjugate(a, b);
          const Complex shrink = residual / (size * size);
          store(weight * (linear + conjugate - shrink * u(column)), out.jacobian->col(column));
          store(weight * (Complex(0, 1) * (linear - conjugate) - shrink * u(column + 1)),
                out.jacobian->col(column + 1));
        }
      }
    }
  }
  return true;
}

void HarmonicResponse::scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const {
  unknowns.setConstant(u.norm());
  parameters = p;
}

std::vector<std::string> HarmonicResponse::regime_names() const {
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

double HarmonicResponse::border(const Vector& u, const Vector& p, int regime, int border,
                                continuation::Gradient* gradient) const {
  const double sign = slips(regime, border) ? -1 : 1;
  const double limit = threshold(border, p);
  const HarmonicVector r = motion(u, border);
  const OddMotion::Maximum top = OddMotion(system_.orders, r).maximum();
  const double square = top.value * top.value;
  const double sum = square + limit * limit;
  if (gradient != nullptr) {
    const double slope = sign * 4 * limit * limit / (sum * sum);  // over A^2/2
    gradient->unknowns.setZero();
    for (Index a = 0; a < harmonics(); ++a) {
      const Complex turn = std::polar(slope * top.value, system_.orders[at(a)] * top.angle);
      const Index place = 2 * (border * harmonics() + a);
      gradient->unknowns(place) = turn.real();
      gradient->unknowns(place + 1) = -turn.imag();
    }
    const double by_load = -slope * square / load(p);
    gradient->parameters << 2 * system_.preload_growth * p(eta) * by_load, by_load;
  }
  return sign * (square - limit * limit) / sum;
}

std::vector<continuation::Observable> HarmonicResponse::observables() const {
  std::vector<continuation::Observable> all = {{"R"},    {"S"},     {"R_over_S"}, {"Y", true},   {"U"},
                                               {"beta"}, {"alpha"}, {"psi"},      {"dissipated"}};
  for (Index i = 1; i < contacts(); ++i) {
    for (const char* name : {"R", "R_over_S", "Y", "U", "dissipated"})
      all.push_back({fmt::format("{}_contact_{}", name, i + 1)});
  }
  for (const ContactOutput& output : system_.outputs) all.push_back({output.name});
  for (const char* name : {"R_peak", "Y_peak", "U_peak"}) all.push_back({name});
  for (Index a = 1; a < harmonics(); ++a) {
    for (const char* name : {"R", "Y", "U"})
      all.push_back({fmt::format("{}_h{}", name, system_.orders[at(a)])});
  }
  return all;
}

void HarmonicResponse::observe(const Vector& u, const Vector& p, int regime, Vector& values) const {
  const Index m = contacts();
  const Index n = harmonics();
  const std::vector<Force>& friction = forces(u, p, regime, false);
  values.resize(std::ssize(observables()));
  Index place = 9 + 5 * (m - 1) + std::ssize(system_.outputs) + 3;
  HarmonicVector base(n);  // of the first contact
  HarmonicVector damper(n);
  ContactVector f(m);
  const HarmonicVector first = motion(u, 0);
  for (Index a = 0; a < n; ++a) {
    for (Index j = 0; j < m; ++j) f(j) = friction[at(j)].harmonics(a);
    const ContactVector moved = -(system_.damper[at(a)].at(system_.orders[at(a)] * p(eta)).compliance * f);
    damper(a) = moved(0);
    base(a) = moved(0) - first(a);
    if (a > 0) {
      for (const Complex value : {first(a), base(a), damper(a)}) values(place++) = std::abs(value);
      continue;
    }
    for (Index i = 0; i < m; ++i) {
      const Complex r = motion(u, i)(0);
      const double amplitude = std::abs(r);
      const double ratio = amplitude / threshold(i, p);
      const double energy = friction[at(i)].energy;
      if (i > 0) {
        values.segment<5>(9 + 5 * (i - 1)) << amplitude, ratio, std::abs(moved(i) - r), std::abs(moved(i)), energy;
      } else {
        values.head<9>() << amplitude, threshold(0, p), ratio, std::abs(base(0)), std::abs(damper(0)),
            lag(base(0)), lag(damper(0)), lag(r), energy;
      }
    }
    for (std::size_t i = 0; i < system_.outputs.size(); ++i)
      values(9 + 5 * (m - 1) + static_cast<Index>(i)) = system_.outputs[i].amplitude(p(eta), f);
  }
  const auto peak = [&](const HarmonicVector& motion) { return OddMotion(system_.orders, motion).maximum().value; };
  values.segment<3>(9 + 5 * (m - 1) + std::ssize(system_.outputs)) << peak(first), peak(base), peak(damper);
}

double HarmonicResponse::observe(const Vector& u, const Vector& p, int regime, Index /*which*/,
                                 continuation::Gradient& gradient) const {
  const std::vector<Force>& friction = forces(u, p, regime, true);
  const ContactReceptance damper = system_.damper[0].at(p(eta));
  Complex y = -Complex(u(0), u(1));
  Complex by_eta = 0;
  Complex by_log_S = 0;
  for (Index j = 0; j < contacts(); ++j) {
    y -= damper.compliance(0, j) * friction[at(j)].harmonics(0);
    by_eta -= damper.compliance_eta(0, j) * friction[at(j)].harmonics(0);
    by_log_S -= damper.compliance(0, j) * friction[at(j)].by_log_threshold(0);
  }
  const double amplitude = std::abs(y);
  const Complex direction = std::conj(y) / amplitude;
  for (Index j = 0; j < contacts(); ++j) {
    for (Index b = 0; b < harmonics(); ++b) {
      const Index place = 2 * (j * harmonics() + b);
      const Complex linear =
          -damper.compliance(0, j) * friction[at(j)].linear(0, b) - (place == 0 ? 1.0 : 0.0);
      const Complex conjugate = -damper.compliance(0, j) * friction[at(j)].conjugate(0, b);
      gradient.unknowns(place) = std::real(direction * (linear + conjugate));
      gradient.unknowns(place + 1) = -std::imag(direction * (linear - conjugate));
    }
  }
  const double by_load = std::real(direction * by_log_S) / load(p);
  gradient.parameters << std::real(direction * by_eta) + 2 * system_.preload_growth * p(eta) * by_load, by_load;
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
    std::vector<double> found = joined_frequencies({base, damper}, springs);
    for (const double value : joined_frequencies({damper}, springs)) found.push_back(value);
    for (const ContactModes* structure : {base, damper}) {
      for (const ContactMode& mode : structure->modes()) found.push_back(mode.frequency);
    }
    for (const double value : found) values.push_back(value / system_.orders[at(a)]);
  }
  std::erase_if(values, [&](double value) { return !(value > from && value < to); });
  return values;
}

continuation::Guess HarmonicResponse::guess(double eta_value, double preload_value) const {
  continuation::Guess guess{Vector::Zero(size()), Vector(2), 0};
  guess.parameters << eta_value, preload_value;
  if (!(eta_value > 0 && preload_value > 0 && load(guess.parameters) > 0))
    throw std::invalid_argument("HarmonicResponse: eta and the preload must be positive");
  const ContactReceptance base = system_.base[0].at(eta_value);
  ContactMatrix stuck = base.compliance + system_.damper[0].at(eta_value).compliance;
  for (Index j = 0; j < contacts(); ++j) stuck.col(j) *= system_.contacts[at(j)].stiffness;
  stuck.diagonal().array() += 1;
  const ContactVector r = -(stuck.partialPivLu().solve(base.free));
  double holding = 0;  // load over that which lets nothing slip
  for (Index i = 0; i < contacts(); ++i) {
    guess.unknowns(2 * i * harmonics()) = r(i).real();
    guess.unknowns(2 * i * harmonics() + 1) = r(i).imag();
    holding = std::max(holding, std::abs(r(i)) / threshold(i, guess.parameters));
  }
  if (holding <= 1) return guess;

  continuation::TraceOptions options;
  options.parameter = "P";
  options.from = 1.5 * holding * load(guess.parameters) - load(guess.parameters) + preload_value;
  options.to = preload_value;
  const continuation::Branch branch = trace(*this, guess, options);
  if (!branch.complete())
    throw std::invalid_argument("HarmonicResponse: no way from a high preload: " + branch.explanation);
  const continuation::BranchPoint& end = branch.points.back();
  return {end.unknowns, end.parameters, end.regime};
}

}  // namespace arcslip::problems
