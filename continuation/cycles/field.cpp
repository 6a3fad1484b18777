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

bool Field::evaluate_columns(const Vector& times, const Matrix& u, const Vector& p,
                             const FieldColumns& out) const {
  const Index n = size();
  Vector place;
  Vector velocity(n);
  Vector by_time(n);
  Matrix by_unknowns(n, n);
  Matrix by_parameters(n, p.size());
  FieldValues wanted{&velocity};
  if (out.by_unknowns != nullptr) wanted.by_unknowns = &by_unknowns;
  if (out.by_parameters != nullptr) wanted.by_parameters = &by_parameters;
  if (out.by_time != nullptr) wanted.by_time = &by_time;
  for (Index k = 0; k < u.cols(); ++k) {
    place = u.col(k);
    if (!evaluate(times(k), place, p, wanted)) return false;
    out.velocity->col(k) = velocity;
    if (out.by_unknowns != nullptr) out.by_unknowns->middleCols(k * n, n) = by_unknowns;
    if (out.by_parameters != nullptr) out.by_parameters->middleCols(k * p.size(), p.size()) = by_parameters;
    if (out.by_time != nullptr) out.by_time->col(k) = by_time;
  }
  return true;
}

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

bool EquilibriumField::evaluate_columns(const Vector& times, const Matrix& u, const Vector& p,
                                        const FieldColumns& out) const {
  return problem_->evaluate_columns(u, p, out.velocity, out.by_unknowns, out.by_parameters) ||
         Field::evaluate_columns(times, u, p, out);
}

bool EquilibriumField::second(double /*t*/, const Vector& u, const Vector& p, const Vector& w,
                              const Vector& du, const Vector& dp, Vector& out) const {
  return problem_->second(u, p, {}, w, du, dp, out);
}

}  // namespace arcslip::continuation
