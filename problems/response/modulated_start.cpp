// How a modulated response begins.

#include <algorithm>
#include <cmath>
#include <limits>

#include "arcslip/assembly/structures.hpp"
#include "arcslip/dense.hpp"
#include "arcslip/motion/swing.hpp"
#include "arcslip/problems/response/floquet_response.hpp"
#include "arcslip/problems/response/modulated_response.hpp"

namespace arcslip::problems {

using continuation::Evaluation;
using continuation::Guess;

Vector ModulatedResponse::unmodulated(const ComplexMatrix& motion, double nu) const {
  Vector u = Vector::Zero(size());
  for (Index i = 0; i < u.size() / 2; ++i) {
    const auto [k, l] = line(i);
    const auto order = std::find(system_.orders.begin(), system_.orders.end(), k);
    if (l != 0 || order == system_.orders.end()) continue;
    const Complex value = motion(order - system_.orders.begin(), i / count());
    u(2 * i) = value.real();
    u(2 * i + 1) = value.imag();
  }
  u(u.size() - 1) = nu;
  return u;
}

Vector ModulatedResponse::disturbance(const ComplexMatrix& motion, const Vector& p, double nu) const {
  Vector found = Vector::Zero(size());
  Matrix jacobian(size(), size());
  Evaluation out;
  out.jacobian = &jacobian;
  if (!evaluate(unmodulated(motion, nu), p, {}, out)) return found;
  std::vector<Index> rows;
  for (Index i = 0; i < size() - 1; ++i) {
    if (std::abs(line(i / 2).l) == 1) rows.push_back(i);
  }
  const Vector least = least_moved(Matrix(jacobian(rows, rows)));
  for (std::size_t i = 0; i < rows.size(); ++i) found(rows[i]) = least(static_cast<Index>(i));
  return found;
}

void ModulatedResponse::set_reference(const Vector& modulated, double size) {
  reference_ = modulated;
  size_ = size;
}

std::optional<Guess> ModulatedResponse::modulated(const Guess& near, Index parameter, double share) const {
  constexpr int most = 40;
  constexpr double furthest = 0.02;  // of the parameter, relative to it, and nu, relative to eta, at once
  constexpr double astray = 0.1;     // of the parameter, in all
  const Index n = size();
  Guess at = near;
  Vector residual(n);
  Matrix jacobian(n, n);
  Matrix by_parameters(n, 2);
  Matrix bordered(n + 1, n + 1);
  Vector right(n + 1);
  for (int round = 0; round < most; ++round) {
    if (!evaluate(at.unknowns, at.parameters, {}, {&residual, &jacobian, &by_parameters})) return {};
    bordered << jacobian, by_parameters.col(parameter), reference_.transpose() / size_, 0;
    right << residual, reference_.dot(at.unknowns) / size_ - share;
    const Vector step = solution_of(bordered, right);
    if (!step.allFinite()) return {};
    const double far = std::max(std::abs(step(n - 1)) / at.parameters(eta),
                                std::abs(step(n)) / std::abs(at.parameters(parameter)));
    const double part = std::min(1.0, furthest / far);
    at.unknowns -= part * step.head(n);
    at.parameters(parameter) -= part * step(n);
    if (!(std::abs(at.parameters(parameter) / near.parameters(parameter) - 1) < astray)) return {};
    if (part == 1 && step.head(n - 1).norm() < 1e-9 * size_ && far < 1e-9) {
      at.direction = Vector::Zero(n + 1);
      at.direction.head(n) = reference_;
      return at;
    }
  }
  return {};
}

std::optional<ModulatedStart> modulated_response(const SystemParameters& parameters,
                                                 const HarmonicProblem& response, const Guess& at,
                                                 Index parameter) {
  const auto* known = dynamic_cast<const Floquet*>(&response);
  if (known == nullptr)
    throw std::invalid_argument("a modulated response leaves one that knows its stability");
  if (response.system().sectors > 1)
    throw std::invalid_argument("in a whole ring no node need do what another one does");
  const auto all = known->disturbances(at.unknowns, at.parameters, at.regime);
  const RingDisturbances::Disturbance* nearest = nullptr;
  for (const auto& one : all) {
    if (one.exponent.imag() == 0) continue;
    if (nearest == nullptr || std::abs(one.exponent.real()) < std::abs(nearest->exponent.real()))
      nearest = &one;
  }
  if (nearest == nullptr) return {};

  constexpr int highest = 5;  // l
  SystemParameters modal = parameters;
  if (auto in_modes = structures_of(parameters).in_modes()) modal.structures = std::move(in_modes);
  const HarmonicSystem system = build_harmonic_system(modal);
  const RingWaves waves = ring_waves(modal, 2 * highest_order(system.orders) + 2);
  ComplexMatrix motion(std::ssize(system.orders), response.coordinates());
  for (Index i = 0; i < motion.cols(); ++i) motion.col(i) = response.motion(at.unknowns, at.parameters, i);
  const Vector p = at.parameters.head(2);
  // With nu goes nu + m eta on m n more waves: the least is taken. Of an odd response disturbances have odd
  // harmonics, between which m is even, or even ones, which are odd for odd m: that is meant whose modulated
  // response is nearer.
  std::optional<ModulatedStart> found;
  double nearest_start = std::numeric_limits<double>::infinity();
  const bool odd = all_odd(system.orders);
  const double first = nearest->exponent.imag() / p(ModulatedResponse::eta);
  for (int parity = 0; parity < (odd ? 2 : 1); ++parity) {
    const auto more =
        static_cast<int>(odd ? parity - 2 * std::round((first + parity) / 2) : -std::round(first));
    const double nu = (first + more) * p(ModulatedResponse::eta);
    const Index wave = waves.within(nearest->wave + more * waves.wave_number());
    auto problem = std::make_shared<ModulatedResponse>(system, waves, wave, highest);
    const Vector disturbance = problem->disturbance(motion, p, nu);
    const Vector plain = problem->unmodulated(motion, nu);
    const double size = plain.head(plain.size() - 1).norm();
    problem->set_reference(disturbance, size);
    for (const double share : {0.02, 0.05, 0.1, 0.2}) {
      Guess near{plain, p, {}, {}};
      near.unknowns.head(plain.size() - 1) += share * size * disturbance.head(plain.size() - 1);
      std::optional<Guess> start = problem->modulated(near, parameter, share);
      if (!start) continue;
      const double distance = std::abs(start->parameters(parameter) / p(parameter) - 1);
      if (distance < nearest_start) found = {problem, std::move(*start)};
      nearest_start = std::min(nearest_start, distance);
      break;
    }
  }
  return found;
}

}  // namespace arcslip::problems
