#include "arcslip/continuation/cycles/field.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace arcslip::continuation {
namespace {

/// Whether the first observables of a problem are its unknowns in their order.
bool observes_unknowns(const Problem& problem) {
  const Index n = problem.size();
  if (std::ssize(problem.observables()) < n) return false;
  const Vector probe = Vector::LinSpaced(n, 0.3, 0.7);
  Vector seen;
  problem.observe(probe, Vector::Ones(std::ssize(problem.parameter_names())), {}, seen);
  return seen.head(n) == probe;
}

}  // namespace

EquilibriumField::EquilibriumField(std::shared_ptr<const Problem> problem) : problem_(std::move(problem)) {
  if (!problem_->is_equilibrium() || problem_->switch_count() > 0)
    throw std::invalid_argument("cycles are followed of smooth problems u' = F(u, p) alone");
  const std::vector<std::string> observed = observable_names(*problem_);
  const bool has_names = observes_unknowns(*problem_);
  for (const Observable& one : problem_->observables()) {
    if (has_names && std::ssize(turns_) < size()) turns_.push_back(one.period);
  }
  for (Index i = 0; i < size(); ++i)
    names_.push_back(has_names ? observed[static_cast<std::size_t>(i)] : fmt::format("u{}", i + 1));
}

bool EquilibriumField::evaluate(double /*t*/, const Vector& u, const Vector& p,
                                const FieldValues& out) const {
  return problem_->evaluate(u, p, {},
                            {out.velocity, out.by_unknowns, out.by_parameters, out.sparse_by_unknowns});
}

bool EquilibriumField::second(double /*t*/, const Vector& u, const Vector& p, const Vector& w,
                              const Vector& du, const Vector& dp, Vector& out) const {
  return problem_->second(u, p, {}, w, du, dp, out);
}

}  // namespace arcslip::continuation
