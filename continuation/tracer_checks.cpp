// What a branch that was left asks of the problem that it goes on with: that it is the same.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "arcslip/continuation/evaluation.hpp"
#include "arcslip/continuation/tracer.hpp"

namespace arcslip::continuation {
namespace {

[[noreturn]] void refuse(const std::string& what) { throw std::invalid_argument("resume: " + what); }

template <class Names>
void require_names(const char* what, const Names& now, const Names& then) {
  if (now != then) refuse(fmt::format("the {} are {}; those of the checkpoint are {}", what, now, then));
}

void require_count(const char* what, Index now, Index then) {
  if (now != then) refuse(fmt::format("there are {} {}; the checkpoint has {}", now, what, then));
}

}  // namespace

BranchIdentity Tracer::identity() const {
  BranchIdentity of{problem_.parameter_names(), problem_.regime_names(), {},
                    options_.parameter,         options_.extrema_of,     {}};
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
    if (point->regime < 0 || point->regime >= std::ssize(problem_.regime_names()))
      refuse(fmt::format("there is no regime {}, which the checkpoint names", point->regime));
  }
  require_count("entries in the bend", n + 1, progress.bend.size());
  require_count("observables whose extrema are looked for", stepper_.tracked_count(),
                std::ssize(progress.signs.observables));
  require_count("observables and borders", stepper_.tracked_count() + problem_.border_count(here.regime),
                std::ssize(progress.monitors));
  require_count("tests and events", std::ssize(problem_.test_types()) + std::ssize(options_.events),
                std::ssize(progress.signs.functions));
  check_functions(problem_, here.unknowns, here.parameters, here.regime, stepper_.tracked());
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
