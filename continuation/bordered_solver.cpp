#include "arcslip/continuation/bordered_solver.hpp"

namespace arcslip::continuation {

BorderedSolver::BorderedSolver(Index size, Index borders)
    : size_(size),
      matrix_(Matrix::Identity(size + borders, size + borders)),
      lu_(size + borders),
      solution_(size + borders),
      visited_(size + borders) {
  factor();
}

void BorderedSolver::solve(Vector& right_hand_side) {
  solution_.noalias() = lu_.permutationP() * right_hand_side;
  lu_.matrixLU().triangularView<Eigen::UnitLower>().solveInPlace(solution_);
  lu_.matrixLU().triangularView<Eigen::Upper>().solveInPlace(solution_);
  right_hand_side = solution_;
}

void BorderedSolver::solve_transposed(Vector& right_hand_side) {
  lu_.matrixLU().triangularView<Eigen::Upper>().transpose().solveInPlace(right_hand_side);
  lu_.matrixLU().triangularView<Eigen::UnitLower>().transpose().solveInPlace(right_hand_side);
  solution_.noalias() = lu_.permutationP().inverse() * right_hand_side;
  right_hand_side = solution_;
}

double BorderedSolver::determinant_sign() const {
  double sign = permutation_sign();
  for (Index i = 0; i < matrix_.rows(); ++i) {
    const double pivot = lu_.matrixLU()(i, i);
    sign *= static_cast<double>(pivot > 0) - static_cast<double>(pivot < 0);
  }
  return sign;
}

double BorderedSolver::permutation_sign() const {
  const auto& image = lu_.permutationP().indices();
  visited_.setZero();
  double sign = 1;
  for (Index start = 0; start < image.size(); ++start) {
    for (Index i = image(start); i != start && visited_(start) == 0; i = image(i)) {  // a cycle of length l: l - 1
      visited_(i) = 1;
      sign = -sign;
    }
  }
  return sign;
}

}  // namespace arcslip::continuation
