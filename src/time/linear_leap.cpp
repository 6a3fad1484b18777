#include "time/linear_leap.hpp"

#include <cmath>

#include "arcslip/structure/dense.hpp"

namespace arcslip {
namespace {

/// p and v of a mode by p and v before.
struct ModeFlow {
  ModeFlow(double stiffness, double damping, double t) {
    const double rest = stiffness - damping * damping / 4;
    const double w = std::sqrt(std::abs(rest));
    const double fade = std::exp(-damping * t / 2);
    const bool is_slow = w * std::abs(t) < 1e-8;
    const double sine = is_slow ? t : rest > 0 ? std::sin(w * t) / w : std::sinh(w * t) / w;
    const double cosine = is_slow ? 1 : rest > 0 ? std::cos(w * t) : std::cosh(w * t);
    p_by_v = fade * sine;
    v_by_v = fade * (cosine - damping / 2 * sine);
    p_by_p = v_by_v + damping * p_by_v;
    v_by_p = -stiffness * p_by_v;
  }

  double p_by_p;
  double p_by_v;
  double v_by_p;
  double v_by_v;
};

/// Chebyshev points of [0, 1] with the integrals of the polynomial through values there up to each of them.
struct Collocation {
  explicit Collocation(Index n) : points(n + 1), integral(n + 1, n + 1) {
    Matrix values(n + 1, n + 1);
    Matrix integrals(n + 1, n + 1);
    for (Index i = 0; i <= n; ++i) {
      const double angle = pi * static_cast<double>(n - i) / static_cast<double>(n);
      points(i) = 0.5 * (1 + std::cos(angle));
      const auto part = [&](Index k) {
        return (std::cos(static_cast<double>(k) * angle) - (k % 2 == 0 ? 1 : -1));
      };
      for (Index k = 0; k <= n; ++k) {
        const auto order = static_cast<double>(k);
        values(i, k) = std::cos(order * angle);
        integrals(i, k) = k == 0   ? part(1)
                          : k == 1 ? part(2) / 4
                                   : 0.5 * (part(k + 1) / (order + 1) - part(k - 1) / (order - 1));
      }
    }
    integral = 0.5 * solution_of(Matrix(values.transpose()), Matrix(integrals.transpose())).transpose();
  }

  Vector points;
  Matrix integral;
};

}  // namespace

bool LinearLeap::pays(const Ring& ring, const VaryingForces& forces, double length) {
  constexpr double fading = 5;
  return forces.are_linear() && ring.coupling.size() == 0 && !ring.turns() &&
         10 * std::ssize(forces.rows) <= ring.coordinates() &&
         ring.damping.cwiseAbs().maxCoeff() * length < fading;
}

LinearLeap::LinearLeap(const Ring& ring, const VaryingForces& forces, double rate, double length) {
  const Index all = ring.coordinates();
  const Index count = std::ssize(forces.rows);
  const Collocation at(16 + static_cast<Index>(std::ceil(rate * length)));
  const Index points = at.points.size();
  gain_ = forces.gain();
  free_.resize(count * points, 2 * all);
  pushed_.resize(2 * all, count * points);
  Matrix back(2 * all, count * points);
  end_.resize(all, 4);
  for (Index c = 0; c < all; ++c) {
    const auto flow = [&](double t) { return ModeFlow(ring.stiffness(c), ring.damping(c), t); };
    const auto shape = forces.motion.col(c);
    for (Index i = 0; i < points; ++i) {
      const double t = length * at.points(i);
      const ModeFlow here = flow(t);
      free_.col(c).segment(i * count, count) = here.p_by_p * shape;
      free_.col(all + c).segment(i * count, count) = here.p_by_v * shape;
      const ModeFlow before = flow(-t);
      back.row(c).segment(i * count, count) = before.p_by_v * shape;
      back.row(all + c).segment(i * count, count) = before.v_by_v * shape;
      const ModeFlow rest = flow(length - t);
      const double weight = length * at.integral(points - 1, i);
      pushed_.row(c).segment(i * count, count) = weight * rest.p_by_v * shape;
      pushed_.row(all + c).segment(i * count, count) = weight * rest.v_by_v * shape;
    }
    const ModeFlow whole = flow(length);
    end_.row(c) << whole.p_by_p, whole.p_by_v, whole.v_by_p, whole.v_by_v;
  }
  if (count == 0) return;
  Matrix integral = free_ * back;  // by forces at all points
  for (Index i = 0; i < points; ++i) {
    for (Index j = 0; j < points; ++j)
      integral.block(i * count, j * count, count, count) *= length * at.integral(i, j);
  }
  by_force_ = integral;
  history_ = Matrix::Identity(integral.rows(), integral.cols());
  for (Index j = 0; j < points; ++j)
    history_.middleCols(j * count, count) += integral.middleCols(j * count, count) * gain_;
}

void LinearLeap::take(const Matrix& constant, Matrix& position, Matrix& velocity) const {
  const Index all = position.rows();
  const Index count = gain_.rows();
  Matrix state(2 * all, position.cols());
  state << position, velocity;
  Matrix forces(free_.rows(), position.cols());
  if (count > 0) {
    const Index points = free_.rows() / count;
    Matrix pushes(free_.rows(), position.cols());
    for (Index i = 0; i < points; ++i) pushes.middleRows(i * count, count) = constant;
    Matrix x = free_ * state;
    x.noalias() -= by_force_ * pushes;
    x = solution_of(history_, x);
    for (Index i = 0; i < points; ++i)
      forces.middleRows(i * count, count) = gain_ * x.middleRows(i * count, count) + constant;
  }
  position = end_.col(0).asDiagonal() * state.topRows(all);
  position += end_.col(1).asDiagonal() * state.bottomRows(all);
  velocity = end_.col(2).asDiagonal() * state.topRows(all);
  velocity += end_.col(3).asDiagonal() * state.bottomRows(all);
  if (count == 0) return;
  position.noalias() -= pushed_.topRows(all) * forces;
  velocity.noalias() -= pushed_.bottomRows(all) * forces;
}

}  // namespace arcslip
