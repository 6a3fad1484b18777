// Meshes of orbits, each with what belongs to it while a stretch of a branch is traced.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "arcslip/continuation/cycles/orbit_problem.hpp"

namespace arcslip::continuation {
namespace {

/// Of the integral of (u/scale) . (du_0/ds/scale), over that of the square of the latter.
Vector phase_weights(const OrbitMesh& mesh, const Eigen::Ref<const Matrix>& orbit, const Vector& scale) {
  const CollocationRule& rule = mesh.rule();
  const Index n = orbit.rows();
  Vector weights = Vector::Zero(orbit.size());
  const double* const derivatives = rule.derivatives().data();
  const double* const shares = rule.values().data();
  const Vector inverse = scale.cwiseInverse();
  double square = 0;
  with_degree(rule.degree(), [&](auto degree) {
    for (Index j = 0; j < mesh.intervals(); ++j) {
      const double* const values = orbit.col(j * degree).data();
      double* const own = weights.data() + j * degree * n;
      double changes = 0;
      for (Index r = 0; r < n; ++r) {
        for (Index i = 0; i < degree; ++i) {
          double change = 0;  // over the interval
          for (Index k = 0; k <= degree; ++k) change += values[k * n + r] * derivatives[k * degree + i];
          change *= inverse(r);
          const double weighted = rule.weights()(i) * change;
          changes += weighted * change;
          for (Index k = 0; k <= degree; ++k)
            own[k * n + r] += weighted * inverse(r) * shares[k * degree + i];
        }
      }
      square += changes / mesh.length(j);
    }
  });
  return weights / square;
}

/// The integral of (a/scale) . (b/scale), values at the Gauss points of the frame's mesh.
double product(const OrbitFrame& frame, const Matrix& a, const Matrix& b) {
  const Vector& weights = frame.mesh.rule().weights();
  const double* of_a = a.data();
  const double* of_b = b.data();
  double sum = 0;
  for (Index j = 0; j < a.cols() / weights.size(); ++j) {
    for (const double weight : weights) {
      double square = 0;
      for (const double unit : frame.in_units) square += unit * unit * *of_a++ * *of_b++;
      sum += weight * frame.mesh.length(j) * square;
    }
  }
  return sum;
}

double size_of(const OrbitFrame& frame, const Matrix& a) { return std::sqrt(product(frame, a, a)); }

/// Whether what keeps an orbit apart is little beside how far it goes.
bool is_little(const OrbitFrame& frame, double apart, const Eigen::Ref<const Matrix>& orbit) {
  constexpr double little = 0.1;  // 0.35 of a sine
  return apart < little * ranges(orbit, frame.scale).cwiseQuotient(frame.scale).norm();
}

}  // namespace

Vector range_on(const OrbitFrame& frame, const Eigen::Ref<const Matrix>& orbit) {
  constexpr double much_smaller = 1e-3;
  return frame.range.cwiseMax(much_smaller * ranges(orbit, frame.scale));
}

CollocationRule rule_for(const Field& field, int degree) {
  return CollocationRule(degree, field.sparse() ? CollocationPoints::radau : CollocationPoints::gauss);
}

const std::shared_ptr<const OrbitFrame>& OrbitProblem::shared_frame(const Regime& regime) const {
  std::size_t number = 0;
  for (Index digit = frame_digits; digit-- > 0;)
    number = number * Regime::states + static_cast<std::size_t>(regime[digit]);
  return frames_.at(number);
}

const OrbitFrame& OrbitProblem::frame(const Regime& regime) const { return *shared_frame(regime); }

Regime OrbitProblem::last_frame() const {
  Regime regime;
  auto rest = static_cast<int>(frames_.size() - 1);
  for (Index digit = 0; digit < frame_digits; ++digit, rest /= Regime::states)
    regime = regime.with(digit, rest % Regime::states);
  return regime;
}

Regime OrbitProblem::add_frame(const OrbitMesh& mesh, const Matrix& orbit, const Vector& p) const {
  constexpr double hardly = 1e-4;  // of how far the unknowns go: what keeps an orbit apart is more
  Vector scale(orbit.rows());
  Vector unused(p.size());
  field_->scale(orbit.cwiseAbs().rowwise().maxCoeff(), p, scale, unused);
  OrbitFrame frame{mesh, scale, scale.cwiseInverse(), {}, ranges(orbit, scale), {}, 0, {}, {}, {}, 0};
  const Vector s = mesh.gauss_points();
  frame.points = mesh.find(s);
  frame.opposite = mesh.find((s.array() < 0.5).select(s.array() + 0.5, s.array() - 0.5));
  frame.ends = end_scale(frame, orbit, p);
  if (has_duration_) frame.phase = phase_weights(mesh, orbit, scale);
  if (has_duration_) frame.phase_value = frame.phase.dot(orbit.reshaped());
  frame.apart = part_apart(frame, orbit);
  frame.size_apart = size_of(frame, frame.apart);
  most_apart_ = std::max(most_apart_, frame.size_apart);
  if (!(most_apart_ > hardly * frame.range.cwiseQuotient(scale).norm())) frame.apart.resize(0, 0);
  frames_.push_back(std::make_shared<const OrbitFrame>(std::move(frame)));
  return last_frame();
}

Vector OrbitProblem::end_scale(const OrbitFrame& frame, const Matrix& orbit, const Vector& p) const {
  const Index n = field_->size();
  if (field_->sparse()) return frame.scale;
  Vector values(n);
  Matrix by_left(n, n);
  Matrix by_right(n, n);
  if (!end_conditions(orbit.col(0), orbit.rightCols(1), p, {&values, &by_left, &by_right, nullptr}))
    return Vector::Ones(n);
  const Vector change = by_left.cwiseAbs()
                            .cwiseMax(by_right.cwiseAbs())
                            .cwiseProduct(frame.scale.transpose().replicate(n, 1))
                            .rowwise()
                            .maxCoeff();
  return (change.array() > 0).select(change, 1);
}

const OrbitProblem::Apart& OrbitProblem::apart_at(const Vector& u, const Regime& regime) const {
  thread_local Apart last;
  const std::shared_ptr<const OrbitFrame>& at = shared_frame(regime);
  if (last.frame == at && last.unknowns.size() == u.size() && last.unknowns == u) return last;
  const Matrix part = part_apart(*at, orbit(u));
  last = {at, u, size_of(*at, part), 0};
  if (at->apart.size() > 0) last.along = product(*at, part, at->apart);
  return last;
}

double OrbitProblem::apart(const Vector& u, const Regime& regime) const {
  if (frame(regime).apart.size() == 0) return 1;
  const Apart& here = apart_at(u, regime);
  return std::copysign(here.size, here.along) / most_apart_;
}

double OrbitProblem::note_apart(const Vector& u, const Regime& regime) const {
  const OrbitFrame& at = frame(regime);
  if (at.apart.size() == 0) return 1;
  const Apart& here = apart_at(u, regime);
  if (is_little(at, here.size, orbit(u))) most_apart_ = std::max(most_apart_, here.size);
  return here.along / (here.size * at.size_apart);
}

bool OrbitProblem::is_nearly_simpler(const Vector& u, const Regime& regime) const {
  return is_little(frame(regime), apart_at(u, regime).size, orbit(u));
}

double OrbitProblem::rounding_apart(const Vector& u, const Regime& regime) const {
  const double size = (frame(regime).in_units.asDiagonal() * orbit(u)).cwiseAbs().maxCoeff();
  return std::numeric_limits<double>::epsilon() * size / apart_at(u, regime).size;
}

std::string OrbitProblem::describe(const Regime& regime) const {
  return fmt::format("mesh {}", digits(regime));
}

double OrbitProblem::mesh_error(const Vector& u, const Regime& regime) const {
  const OrbitFrame& at = frame(regime);
  const auto values = orbit(u);
  return at.mesh.errors(values, range_on(at, values)).maxCoeff();
}

double OrbitProblem::phase_grip(const Vector& u, const Regime& regime) const {
  const OrbitFrame& at = frame(regime);
  if (at.phase.size() == 0) return 1;
  constexpr double still = 1e-6;
  const auto values = orbit(u);
  double moves = 0;
  for (Index r = 0; r < values.rows(); ++r)
    moves = std::max(moves, (values.row(r).maxCoeff() - values.row(r).minCoeff()) / at.range(r));
  if (moves < still) return 1;
  const Vector own = phase_weights(at.mesh, values, at.scale);
  return std::abs(own.dot(at.phase)) / (own.norm() * at.phase.norm());
}

}  // namespace arcslip::continuation
