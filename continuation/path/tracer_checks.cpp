// What a branch asks of its problem: exact derivatives, and where it was left, that it is the same.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "arcslip/continuation/path/tracer.hpp"
#include "arcslip/continuation/problem/evaluation.hpp"

namespace arcslip::continuation {
namespace {

/// A singular point is located by the derivatives themselves.
bool is_singular(PointType type) {
  return is_turn(type) || type == PointType::branch_point || type == PointType::hopf;
}

[[noreturn]] void refuse(const std::string& what) { throw std::invalid_argument("resume: " + what); }

template <class Names>
void require_names(const char* what, const Names& now, const Names& then) {
  if (now != then) refuse(fmt::format("the {} are {}; those of the checkpoint are {}", what, now, then));
}

void require_count(const char* what, Index now, Index then) {
  if (now != then) refuse(fmt::format("there are {} {}; the checkpoint has {}", now, what, then));
}

/// The names of all regimes with at most one switch in a state other than 0: as many as there are switches.
std::vector<std::string> regimes_of(const Problem& problem) {
  std::vector<std::string> names{problem.describe({})};
  for (Index i = 0; i < problem.switch_count(); ++i) names.push_back(problem.describe(Regime().with(i, 1)));
  return names;
}

}  // namespace

/// In each regime a few points behind its beginning, where a trivial solution or a corner may hide what is
/// wrong.
bool Tracer::is_time_to_look(PointType type) {
  if (type == PointType::regular) return ++seen_in_regime_[stepper_.here().regime] == 3;
  return is_singular(type) && !std::exchange(singular_seen_, true);
}

void Tracer::look_at_derivatives(const Vector& u, const Vector& p, const Regime& regime) {
  if (!branch_.warning.empty()) return;
  ++corrector_.work().evaluations;
  const auto wrong = problem_.wrong_derivative(u, p, regime, parameter_, stepper_.monitors().tracked());
  if (wrong) branch_.warning = fmt::format("{}, at {} = {:.10g}", *wrong, options_.parameter, p(parameter_));
}

Branch Tracer::go_on_with(Branch begun) {
  if (!begun.checkpoint || !begun.checkpoint->ahead)
    throw std::invalid_argument("go_on_with: the branch has no checkpoint");
  if (begun.checkpoint->of) require_same(*begun.checkpoint->of);
  branch_.points = std::move(begun.points);
  branch_.warning = std::move(begun.warning);
  corrector_.work() = begun.work;
  spectra_before_ = begun.work.spectra;
  for (const BranchPoint& point : branch_.points) {
    if (point.type == PointType::regular) ++seen_in_regime_[point.regime];
    singular_seen_ = singular_seen_ || is_singular(point.type);
  }
  return run(*begun.checkpoint->ahead);
}

BranchIdentity Tracer::identity() const {
  BranchIdentity of{problem_.parameter_names(), regimes_of(problem_), {},
                    options_.parameter,         options_.extrema_of,  {}};
  for (const PointType type : problem_.test_types()) of.tests.emplace_back(to_string(type));
  for (const UserEvent& event : options_.events) of.events.push_back(event.name);
  return of;
}

void Tracer::require_same(const BranchIdentity& then) const {
  const BranchIdentity now = identity();
  require_names("parameters", now.parameters, then.parameters);
  require_names("regimes", now.regimes, then.regimes);
  require_names("points that the problem looks for", now.tests, then.tests);
  require_names("observables of extrema_of", now.extrema_of, then.extrema_of);
  require_names("events", now.events, then.events);
  if (now.parameter != then.parameter)
    refuse(fmt::format("the parameter is {}; that of the checkpoint is {}", now.parameter, then.parameter));
}

/// Throws std::invalid_argument where a branch cannot go on so, whatever its names are.
void Tracer::require_same(const Progress& progress) const {
  const Index n = corrector_.size();
  const CurvePoint& here = progress.here;
  for (const CurvePoint* point : {&here, &progress.start}) {
    require_count("unknowns", n, point->unknowns.size());
    require_count("parameters", std::ssize(problem_.parameter_names()), point->parameters.size());
    require_count("entries in the scale", n + 1, point->scale.size());
    require_count("entries in the tangent", n + 1, point->tangent.size());
    if (point->regime.size() > problem_.switch_count())
      refuse(fmt::format("there is no regime {}, which the checkpoint names", digits(point->regime)));
  }
  for (const Vector& bend : progress.bends.derivatives)
    require_count("entries in a bend", n + 1, bend.size());
  require_count("observables whose extrema are looked for", stepper_.monitors().tracked_count(),
                std::ssize(progress.signs.observables));
  require_count("ways since they turned", stepper_.monitors().tracked_count(),
                std::ssize(progress.signs.since));
  require_count("observables and borders",
                stepper_.monitors().tracked_count() + problem_.border_count(here.regime),
                std::ssize(progress.monitors));
  const auto in_pieces = std::count_if(options_.events.begin(), options_.events.end(),
                                       [](const UserEvent& event) { return event.piece != nullptr; });
  require_count("tests and events",
                std::ssize(problem_.test_types()) + std::ssize(options_.events) + in_pieces,
                std::ssize(progress.signs.functions));
  check_functions(problem_, here.unknowns, here.parameters, here.regime, stepper_.monitors().tracked());
  constexpr double nearly = 1e-6;  // far above tolerances, far below what another problem leaves
  Vector residual(n);
  const bool has_value = evaluate(problem_, here.unknowns, here.parameters, here.regime, {&residual});
  const double size = std::max(1.0, progress.residual_size);
  if (!has_value || !(residual.lpNorm<Eigen::Infinity>() <= nearly * size + 10 * here.residual))
    refuse(fmt::format("the problem is another one: where the checkpoint stands, at {} = {:.10g}, {}",
                       options_.parameter, here.parameters(parameter_),
                       has_value ? fmt::format("its residual is {:.3g}", residual.lpNorm<Eigen::Infinity>())
                                 : "it has no value"));
}

}  // namespace arcslip::continuation
