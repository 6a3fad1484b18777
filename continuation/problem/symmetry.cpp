#include "arcslip/continuation/problem/symmetry.hpp"

namespace arcslip::continuation {

std::vector<bool> kept_symmetries(const std::vector<Symmetry>& symmetries, const Vector& u,
                                  const Vector& scale, double tolerance) {
  std::vector<bool> kept;
  for (const Symmetry& symmetry : symmetries) {
    const Vector change = symmetry.map * u - u;
    kept.push_back(change.cwiseQuotient(scale).lpNorm<Eigen::Infinity>() <= tolerance);
  }
  return kept;
}

}  // namespace arcslip::continuation
