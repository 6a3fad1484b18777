#include "arcslip/continuation/problem/problem.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "arcslip/continuation/cycles/torus_problem.hpp"
#include "arcslip/continuation/linear/nearest_eigenvalues.hpp"
#include "arcslip/continuation/points/extended_problem.hpp"
#include "arcslip/continuation/problem/directional_check.hpp"
#include "arcslip/continuation/problem/evaluation.hpp"
#include "arcslip/continuation/problem/guess.hpp"
#include "arcslip/dense.hpp"

namespace arcslip::continuation {
namespace {

bool is_dense_map(const Problem& problem) { return problem.is_map() && !problem.sparse(); }

/// dF/du of a problem that is not sparse; false where it has no value.
bool jacobian_at(const Problem& problem, const Vector& u, const Vector& p, const Regime& regime,
                 Matrix& jacobian) {
  jacobian.resize(problem.size(), problem.size());
  Evaluation out;
  out.jacobian = &jacobian;
  return continuation::evaluate(problem, u, p, regime, out) && jacobian.allFinite();
}

/// ln mu, or ln -mu where mu < 0.
Complex log_of_multiplier(const Complex& multiplier) {
  const bool flips = multiplier.imag() == 0 && multiplier.real() < 0;
  const double size = std::max(std::abs(multiplier), std::numeric_limits<double>::min());
  return {std::log(size), flips ? 0 : std::arg(multiplier)};
}

}  // namespace

void Problem::scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const {
  unknowns = u.cwiseAbs().cwiseMax(1);
  parameters = p.cwiseAbs().cwiseMax(1);
}

bool Problem::second(const Vector& /*u*/, const Vector& /*p*/, const Regime& /*regime*/, const Vector& /*w*/,
                     const Vector& /*du*/, const Vector& /*dp*/, Vector& /*out*/) const {
  return false;
}

bool Problem::eigenvalues(const Vector& u, const Vector& p, const Regime& regime,
                          ComplexVector& values) const {
  const bool returns = is_dense_map(*this);
  if (!is_equilibrium() && !returns) return false;
  if (sparse()) {
    Evaluation out;
    SparseMatrix entries(size(), size());
    out.sparse_jacobian = &entries;
    if (!continuation::evaluate(*this, u, p, regime, out)) return false;
    values = nearest_eigenvalues(entries, eigenvalues_looked_at);
    return values.size() > 0 && values.allFinite();
  }
  Matrix jacobian;
  if (!jacobian_at(*this, u, p, regime, jacobian)) return false;
  if (returns) jacobian.diagonal().array() += 1;
  values = arcslip::eigenvalues(jacobian);
  if (returns) std::transform(values.begin(), values.end(), values.begin(), log_of_multiplier);
  return values.allFinite();
}

std::vector<PointType> Problem::test_types() const {
  if (!is_dense_map(*this)) return {};
  return {PointType::period_doubling};
}

void Problem::test(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const {
  values.resize(is_dense_map(*this) ? 1 : 0);
  if (values.size() == 0) return;
  Matrix jacobian;
  const bool exists = jacobian_at(*this, u, p, regime, jacobian);
  jacobian.diagonal().array() += 2;
  values(0) = exists ? determinant_of(jacobian) : std::nan("");
}

std::unique_ptr<ExtendedProblem> Problem::special(PointType type, Index active, const Guess& at,
                                                  Vector& extras) const {
  ComplexVector logs;
  if (!is_dense_map(*this) || !eigenvalues(at.unknowns, at.parameters, at.regime, logs)) return nullptr;
  return special_of_multipliers(*this, type, active, logs, extras);
}

std::string Problem::describe(const Regime& regime) const {
  return switch_count() == 0 ? "smooth" : "states " + digits(regime);
}

int Problem::border_count(const Regime& /*regime*/) const { return 0; }

double Problem::border(const Vector& /*u*/, const Vector& /*p*/, const Regime& /*regime*/, int /*border*/,
                       Gradient* /*gradient*/) const {
  throw std::logic_error("Problem::border: this problem has no borders");
}

std::optional<Regime> Problem::regime_beyond(const Regime& /*regime*/, int /*border*/) const {
  throw std::logic_error("Problem::regime_beyond: this problem has no borders");
}

void Problem::observe(const Vector& /*u*/, const Vector& /*p*/, const Regime& /*regime*/,
                      Vector& values) const {
  values.resize(0);
}

double Problem::observe(const Vector& /*u*/, const Vector& /*p*/, const Regime& /*regime*/, Index /*which*/,
                        Gradient& /*gradient*/) const {
  throw std::logic_error("Problem::observe: this problem has no observable with a gradient");
}

std::optional<std::string> Problem::wrong_derivative(const Vector& u, const Vector& p, const Regime& regime,
                                                     Index parameter,
                                                     const std::vector<Index>& tracked) const {
  return find_wrong_derivative(*this, u, p, regime, {parameter}, tracked);
}

std::vector<double> Problem::landmarks(Index /*parameter*/, double /*from*/, double /*to*/) const {
  return {};
}

std::vector<std::string> observable_names(const Problem& problem) {
  std::vector<std::string> names;
  for (const Observable& observable : problem.observables()) names.push_back(observable.name);
  return names;
}

int crossed_border(const Problem& problem, const Vector& u, const Vector& p, const Regime& regime,
                   double tolerance) {
  for (int b = 0; b < problem.border_count(regime); ++b) {
    if (problem.border(u, p, regime, b, nullptr) > tolerance) return b;
  }
  return -1;
}

Index index_of(const std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    throw std::invalid_argument(fmt::format("there is no '{}' among {}", name, names));
  }
  return found - names.begin();
}

}  // namespace arcslip::continuation
