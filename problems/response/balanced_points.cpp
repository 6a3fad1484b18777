#include "arcslip/problems/response/balanced_points.hpp"

#include <utility>

namespace arcslip::problems {

HarmonicResponse balanced(SystemParameters parameters, std::vector<int> orders) {
  parameters.harmonics = std::move(orders);
  return HarmonicResponse(build_harmonic_system(parameters));
}

BalancedPoints::BalancedPoints(const SystemParameters& parameters, const std::vector<int>& orders,
                               const continuation::Branch& branch)
    : problem_(balanced(parameters, orders)) {
  if (!branch.points.empty() && branch.points.front().unknowns.size() != problem_.size())
    scalar_ = std::make_unique<ForcedResponse>(build_system(parameters));
}

continuation::Guess BalancedPoints::at(const continuation::BranchPoint& point) const {
  continuation::Guess at{point.unknowns, point.parameters, point.regime};
  if (!scalar_) return at;
  const ComplexVector x = scalar_->motions(point.unknowns, point.parameters, point.regime);
  at.unknowns.resize(2 * x.size());
  for (Index i = 0; i < x.size(); ++i) at.unknowns.segment<2>(2 * i) << x(i).real(), x(i).imag();
  return at;
}

}  // namespace arcslip::problems
