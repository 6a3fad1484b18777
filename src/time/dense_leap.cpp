#include "time/dense_leap.hpp"

#include <cmath>

namespace arcslip {
namespace {

struct Equation {
  Matrix stiffness;  ///< D x D
  Matrix damping;    ///< D x D
  Matrix push;       ///< D x forces
};

Equation equation_of(const RingMotion& motion, const VaryingForces& forces) {
  const Ring& ring = motion.ring();
  Equation all{ring.stiffness.asDiagonal(), ring.damping.asDiagonal(), -forces.motion.transpose()};
  all.stiffness.noalias() += forces.motion.transpose() * (forces.gain() * forces.motion);
  all.damping.noalias() += motion.dragged().transpose() * motion.dragged();
  if (ring.turns()) {
    all.stiffness += motion.turned_stiffness();
    all.damping += motion.turned_damping();
  }
  if (ring.coupling.size() == 0) return all;
  for (Index c = 0; c < ring.coordinates(); ++c)
    all.stiffness(c, ring.beside[static_cast<std::size_t>(c)]) -= ring.coupling(c);
  return all;
}

}  // namespace

bool DenseLeap::pays(const Ring& ring, const VaryingForces& forces, double reach) {
  constexpr double long_enough = 2;
  return ring.nodes() == 1 && forces.are_linear() && reach > long_enough;
}

DenseLeap::DenseLeap(const RingMotion& motion, const VaryingForces& forces, double length) {
  const Equation equation = equation_of(motion, forces);
  const Index size = motion.ring().coordinates();
  const int doublings = std::max(0, static_cast<int>(std::ceil(std::log2(motion.fastest_rate() * length))));
  const double h = std::ldexp(length, -doublings);
  const Index order = series_order(motion.fastest_rate() * h);
  const Index count = equation.push.cols();
  Matrix now = Matrix::Zero(size, 2 * size + count);
  Matrix next = now;
  now.leftCols(size).setIdentity();
  next.middleCols(size, size).diagonal().setConstant(h);
  Matrix position = now + next;
  Matrix rate = next;  // h times the velocity
  for (Index m = 0; m + 2 <= order; ++m) {
    const auto up = static_cast<double>(m + 1);
    Matrix force = -equation.stiffness * now;
    force.noalias() -= (up / h) * (equation.damping * next);
    if (m == 0) force.rightCols(count) += equation.push;
    now = next;
    next = force * (h * h / (up * (up + 1)));
    position += next;
    rate += (up + 1) * next;
  }
  by_state_.resize(2 * size, 2 * size);
  by_state_ << position.leftCols(2 * size), rate.leftCols(2 * size) / h;
  by_force_.resize(2 * size, count);
  by_force_ << position.rightCols(count), rate.rightCols(count) / h;
  for (int k = 0; k < doublings; ++k) {
    const Matrix once = by_force_;
    by_force_.noalias() += by_state_ * once;
    by_state_ = Matrix(by_state_ * by_state_);
  }
}

void DenseLeap::take(const Matrix& constant, Matrix& position, Matrix& velocity) const {
  const Index size = position.rows();
  Matrix state(2 * size, position.cols());
  state << position, velocity;
  position.noalias() = by_state_.topRows(size) * state;
  position.noalias() += by_force_.topRows(size) * constant;
  velocity.noalias() = by_state_.bottomRows(size) * state;
  velocity.noalias() += by_force_.bottomRows(size) * constant;
}

}  // namespace arcslip
