#include "time/dense_leap.hpp"

#include <cmath>

namespace arcslip {
namespace {

constexpr double short_enough = 2;  // over the fastest rate: a series over that loses no digit

int doublings(double reach) {
  return std::max(0, static_cast<int>(std::ceil(std::log2(reach / short_enough))));
}

}  // namespace

bool DenseLeap::pays(const RingMotion& motion, const VaryingForces& forces, double reach, Index columns) {
  constexpr double terms = 4.5;   // of series, over their reach
  constexpr double slowness = 3;  // of their products, which are of few rows or sparse ones
  const Ring& ring = motion.ring();
  const auto size = static_cast<double>(ring.coordinates());
  const auto nodes = static_cast<double>(ring.nodes());
  const auto rows = static_cast<double>(std::ssize(forces.rows));
  const double term = slowness * (2 * rows * (nodes + 2 * size / nodes) + 4 * size) +
                      2 * size * static_cast<double>(motion.dragged().rows()) +
                      (ring.turns() ? 2 * size * size : 0);
  const auto all = static_cast<double>(columns);
  const double leap = doublings(reach) * 4 * size * size * size + all * 4 * size * size;
  return forces.are_linear() && leap + 24 * term * size < terms * reach * all * term;
}

DenseLeap::DenseLeap(const RingMotion& motion, const VaryingForces& forces, double length)
    : motion_(motion), forces_(forces), gain_(forces.gain()) {
  const Index size = motion.ring().coordinates();
  const int count = doublings(motion.fastest_rate() * length);
  const double h = std::ldexp(length, -count);
  const Index order = series_order(motion.fastest_rate() * h);
  Matrix now = Matrix::Zero(size, size);
  Matrix next = now;
  next.diagonal().setConstant(h);
  response_ = next;
  rate_ = next;                  // times h
  Matrix integral = 0.5 * next;  // over h
  for (Index m = 0; m + 2 <= order; ++m) {
    const auto up = static_cast<double>(m + 1);
    Matrix term = stiff(now) + (up / h) * damped(next);
    now.swap(next);
    next = term * (-h * h / (up * (up + 1)));
    response_ += next;
    rate_ += (up + 1) * next;
    integral += next / (up + 2);
  }
  rate_ /= h;
  const Ring& ring = motion.ring();
  const bool is_symmetric = gain_.isDiagonal() && ring.coupling.size() == 0 && !ring.turns();
  pushed_.noalias() = h * integral * forces.motion.transpose();
  pushed_velocity_.noalias() = response_ * forces.motion.transpose();
  for (int k = 0; k < count; ++k) {
    const Matrix before = pushed_;
    const Matrix before_velocity = pushed_velocity_;
    flow(pushed_, pushed_velocity_);
    pushed_ += before;
    pushed_velocity_ += before_velocity;
    const Matrix here = response_;
    const Matrix rate = rate_;
    if (is_symmetric) {  // S' S is the transpose of S S'
      const Matrix half = here * (rate + 0.5 * damped(here));
      response_ = half + half.transpose();
    } else {
      response_.noalias() = rate * here;
      response_.noalias() += here * (rate + damped(here));
    }
    rate_.noalias() = rate * rate;
    rate_.noalias() -= here * stiff(here);
  }
}

Matrix DenseLeap::stiff(const Matrix& position) const {
  const Ring& ring = motion_.ring();
  Matrix force = ring.stiffness.asDiagonal() * position;
  force.noalias() += forces_.motion.transpose() * (gain_ * (forces_.motion * position));
  if (ring.coupling.size() > 0) force -= ring.coupled(position);
  if (ring.turns()) force.noalias() += motion_.turned_stiffness() * position;
  return force;
}

Matrix DenseLeap::damped(const Matrix& velocity) const {
  Matrix force = motion_.ring().damping.asDiagonal() * velocity;
  force.noalias() += motion_.dragged().transpose() * (motion_.dragged() * velocity);
  if (motion_.ring().turns()) force.noalias() += motion_.turned_damping() * velocity;
  return force;
}

void DenseLeap::flow(Matrix& position, Matrix& velocity) const {
  const Matrix pulled = stiff(position);
  const Matrix pushed = damped(position) + velocity;
  position = Matrix(rate_ * position);
  position.noalias() += response_ * pushed;
  velocity = Matrix(rate_ * velocity);
  velocity.noalias() -= response_ * pulled;
}

void DenseLeap::take(const Matrix& constant, Matrix& position, Matrix& velocity) const {
  flow(position, velocity);
  position.noalias() -= pushed_ * constant;
  velocity.noalias() -= pushed_velocity_ * constant;
}

}  // namespace arcslip
