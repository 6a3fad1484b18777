#include "arcslip/continuation/cycles/end_of_kind.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace arcslip::continuation {
namespace {

constexpr const char* end_of_kind_name = "end of a kind of orbits";

}  // namespace

void end_with_kind(const OrbitProblem& orbits, TraceOptions& options, double begins, bool of_folds) {
  if (orbits.frame({}).apart.size() == 0) return;
  const double most = std::max(1.0, begins);
  // Of what there was: nearer to it orbits are hard to tell from others.
  constexpr double nothing = 1e-3;
  // Growth rates of cycles of size r, and rounding in them, go with r^2, and so does the way of a fold.
  constexpr double placed = 1e-4;  // of that way: by how much rounding may move a fold
  const auto least = [=, &orbits](const Vector& u, const Regime& regime) {
    const double rounding = of_folds ? orbits.rounding_apart(u, regime) : 0;
    return std::max(nothing, std::pow(rounding / placed, 0.25));
  };
  options.events.push_back(
      {end_of_kind_name, [=, &orbits](const Vector& u, const Vector& /*p*/, const Regime& regime) {
         // More than there was becomes the most from the next point on, whose value it then is.
         return std::min(orbits.apart(u, regime), most) - most * least(u, regime);
       }});
  options.stop_after.push_back({PointType::event, 1, end_of_kind_name});
}

bool tell_end_of_kind(const OrbitProblem& orbits, const Problem& traced, const std::string& parameter,
                      Branch& branch) {
  const auto found = std::find_if(branch.points.rbegin(), branch.points.rend(),
                                  [](const BranchPoint& point) { return point.label == end_of_kind_name; });
  if (branch.stop != Stop::requested || found == branch.points.rend()) return false;
  branch.points.erase(found.base(), branch.points.end());  // what was told at the same place
  BranchPoint& last = branch.points.back();
  last.type = PointType::end;
  last.label.clear();
  branch.stop = Stop::left_regime;
  branch.explanation = fmt::format("{}, at {} = {:.10g}", orbits.end_of_kind(last.unknowns, last.regime),
                                   parameter, last.parameters(index_of(traced.parameter_names(), parameter)));
  branch.checkpoint.reset();
  return true;
}

}  // namespace arcslip::continuation
