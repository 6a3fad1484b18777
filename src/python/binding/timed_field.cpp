#include "python/binding/timed_field.hpp"

#include <fmt/format.h>

#include "arcslip/formulas/formula.hpp"

namespace arcslip::python {
namespace {

Vector with_time(const Vector& p, double t) {
  Vector all(p.size() + 1);
  all << p, t;
  return all;
}

}  // namespace

TimedField::TimedField(std::shared_ptr<const PythonProblem> problem, const std::string& period)
    : problem_(std::move(problem)), parameters_(problem_->traits().parameters) {
  parameters_.pop_back();
  const std::vector<std::string>& given = problem_->traits().unknowns;
  for (std::size_t i = 0; std::ssize(names_) < size(); ++i)
    names_.push_back(i < given.size() ? given[i] : fmt::format("u{}", i));
  period_ = compile({parameters_, {}, {{"period", period}}});
}

bool TimedField::evaluate(double t, const Vector& u, const Vector& p,
                          const continuation::FieldValues& out) const {
  const bool by_others = out.by_parameters != nullptr || out.by_time != nullptr;
  Matrix by_all(by_others ? size() : 0, p.size() + 1);
  continuation::Evaluation wanted{out.velocity, out.by_unknowns, by_others ? &by_all : nullptr};
  if (!problem_->evaluate(u, with_time(p, t), {}, wanted)) return false;
  if (out.by_parameters != nullptr) *out.by_parameters = by_all.leftCols(p.size());
  if (out.by_time != nullptr) *out.by_time = by_all.rightCols(1);
  return true;
}

void TimedField::scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const {
  Vector all(p.size() + 1);
  problem_->scale(u, with_time(p, 0), unknowns, all);
  parameters = all.head(p.size());
}

}  // namespace arcslip::python
