#include "arcslip/continuation/path/symmetric_branches.hpp"

#include <algorithm>

#include "arcslip/continuation/problem/evaluation.hpp"
#include "arcslip/dense.hpp"

namespace arcslip::continuation {
namespace {

constexpr double same_line =
    1e-5;  // of a direction's greatest entry, in the scale: as null vectors are found

/// The typical magnitudes of the unknowns.
Vector scale_at(const Problem& problem, const Vector& unknowns, const Vector& parameters) {
  Vector scale(unknowns.size());
  Vector parameter_scale(parameters.size());
  problem.scale(unknowns, parameters, scale, parameter_scale);
  return scale;
}

}  // namespace

SymmetricBranches::SymmetricBranches(const Problem& problem, const Tolerances& tolerances)
    : problem_(problem), tolerances_(tolerances) {
  if (problem.sparse()) return;
  std::vector<Symmetry> symmetries = problem.symmetries();
  if (!symmetries.empty()) group_ = std::make_shared<const SymmetryGroup>(std::move(symmetries));
}

const SymmetricProblem* SymmetricBranches::around(const Vector& unknowns, const Vector& parameters,
                                                  const Vector& direction) {
  if (group_ == nullptr) return nullptr;
  const Vector scale = scale_at(problem_, unknowns, parameters);
  Subgroup kept = group_->kept(unknowns, scale, tolerances_.same_solution);
  if (direction.size() > 0) {
    const auto way = direction.head(unknowns.size());
    const double size = way.cwiseQuotient(scale).lpNorm<Eigen::Infinity>();
    if (size > 0) kept = SymmetryGroup::common(kept, group_->kept(way / size, scale, same_line));
  }
  return with(kept, scale.maxCoeff());
}

const SymmetricProblem* SymmetricBranches::with(const Subgroup& kept, double size) {
  if (kept.size() <= 1) return nullptr;
  std::unique_ptr<SymmetricProblem>& problem = known_[kept];
  if (problem == nullptr)
    problem = std::make_unique<SymmetricProblem>(problem_, group_, kept, size, tolerances_.same_solution);
  return problem.get();
}

const Problem& SymmetricBranches::of(Guess& guess) {
  const SymmetricProblem* problem = around(guess.unknowns, guess.parameters, guess.direction);
  if (problem == nullptr) return problem_;
  const Index n = guess.unknowns.size();
  guess.unknowns = problem->symmetric(guess.unknowns);
  if (guess.direction.size() > 0) guess.direction.head(n) = problem->symmetric(guess.direction.head(n));
  return *problem;
}

std::vector<const Problem*> SymmetricBranches::leaving(const BranchPoint& point) {
  const SymmetricProblem* own = around(point.unknowns, point.parameters, point.tangent);
  if (own == nullptr) return {&problem_};
  std::vector<const Problem*> found;
  const double size = scale_at(problem_, point.unknowns, point.parameters).maxCoeff();
  for (const std::size_t i :
       own->broken(point.unknowns, point.parameters, point.regime, tolerances_.zero_eigenvalue)) {
    for (const Subgroup& kept : own->breakings()[i].kept) {
      const SymmetricProblem* problem = with(kept, size);
      found.push_back(problem == nullptr ? &problem_ : problem);
    }
  }
  if (found.empty()) found.push_back(own);
  return found;
}

LostSymmetries lost_symmetries(const Problem& problem, const SymmetryGroup& group, const BranchPoint& point,
                               const Tolerances& tolerances) {
  LostSymmetries lost;
  const Vector scale = scale_at(problem, point.unknowns, point.parameters);
  Matrix jacobian(problem.size(), problem.size());
  if (!continuation::evaluate(problem, point.unknowns, point.parameters, point.regime, {nullptr, &jacobian}))
    return lost;
  jacobian *= scale.asDiagonal();
  const bool vanishes = !(jacobian.cwiseAbs().maxCoeff() > tolerances.zero_eigenvalue);
  const Matrix null = vanishes ? Matrix::Identity(scale.size(), scale.size())
                               : kernel_of(jacobian, tolerances.zero_eigenvalue);
  lost.null_vectors = null.cols();
  if (null.cols() == 0) return lost;
  std::vector<bool> kept(group.order(), true);
  const Subgroup here = group.kept(point.unknowns, scale, tolerances.same_solution);
  for (Index j = 0; j < null.cols(); ++j) {
    const Vector way = null.col(j) / null.col(j).lpNorm<Eigen::Infinity>();
    const Subgroup has = group.kept(scale.cwiseProduct(way), scale, same_line);
    for (std::size_t i = 0; i < kept.size(); ++i)
      kept[i] = kept[i] && std::binary_search(has.begin(), has.end(), i);
  }
  for (const std::size_t i : here) {
    if (!kept[i]) lost.names.push_back(group.symmetries()[i - 1].name);
  }
  return lost;
}

}  // namespace arcslip::continuation
