// Branch points, which the step itself looks for: see crossing.cpp.

#include <cmath>

#include "arcslip/continuation/events/step_search.hpp"

namespace arcslip::continuation {
namespace {

void search_branch_point(StepSearch& step) {
  const auto& crossing = step.stepper.step().crossing;
  if (crossing) step.note({&branch_points, PointType::branch_point, 0, crossing->s});
}

/// An eigenvalue only touches zero where the branch turns.
void pass_branch_point(const Event& event, const Passage& passage) {
  passage.behind.parameter = sign_of(passage.stepper.step().crossing->rate_behind);
  if (event.told && passage.behind.parameter == passage.before.parameter)
    passage.behind.unstable += passage.real_crossings();
  // A test that has no value where branches of other symmetry meet may have any sign behind.
  for (std::size_t i = 0; i < passage.behind.functions.size(); ++i) {
    if (passage.watch.type(i) == PointType::branch_point && std::isnan(passage.watch.functions()[i]))
      passage.behind.functions[i] = 0;
  }
}

}  // namespace

/// Where Hopf points meet a zero eigenvalue, or at a cusp, curves of them may cross.
const EventKind branch_points{
    search_branch_point,
    pass_branch_point,
    {PointType::cusp, PointType::bogdanov_takens, PointType::zero_hopf, PointType::hopf_hopf}};

}  // namespace arcslip::continuation
