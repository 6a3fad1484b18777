#include "arcslip/continuation/problem/problem.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "arcslip/continuation/linear/eigenvalues.hpp"
#include "arcslip/continuation/linear/nearest_eigenvalues.hpp"
#include "arcslip/continuation/points/extended_problem.hpp"
#include "arcslip/continuation/problem/directional_check.hpp"
#include "arcslip/continuation/problem/evaluation.hpp"

namespace arcslip::continuation {

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
  if (!is_equilibrium()) return false;
  Evaluation out;
  if (sparse()) {
    SparseMatrix entries(size(), size());
    out.sparse_jacobian = &entries;
    if (!continuation::evaluate(*this, u, p, regime, out)) return false;
    values = nearest_eigenvalues(entries, eigenvalues_looked_at);
    return values.size() > 0 && values.allFinite();
  }
  Matrix jacobian(size(), size());
  out.jacobian = &jacobian;
  if (!continuation::evaluate(*this, u, p, regime, out) || !jacobian.allFinite()) return false;
  values = continuation::eigenvalues(jacobian);
  return values.allFinite();
}

void Problem::test(const Vector& /*u*/, const Vector& /*p*/, const Regime& /*regime*/, Vector& values) const {
  values.resize(0);
}

std::unique_ptr<ExtendedProblem> Problem::special(PointType /*type*/, Index /*active*/, const Guess& /*at*/,
                                                  Vector& /*extras*/) const {
  return nullptr;
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
