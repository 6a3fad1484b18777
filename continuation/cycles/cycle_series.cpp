// Series of the equations of a cycle along a curve of its unknowns.

#include "arcslip/continuation/cycles/cycle_problem.hpp"

namespace arcslip::continuation {

bool CycleProblem::series(const Matrix& u, const Vector& p, const Regime& regime, Matrix& out) const {
  const OrbitFrame& at = frame(regime);
  const CollocationRule& rule = at.mesh.rule();
  const Index n = field().size();
  const Index m = degree();
  const Index last = n * (nodes() - 1);
  const auto in_units = at.scale.cwiseInverse().asDiagonal();
  Vector durations = Vector::Zero(u.cols());
  durations(0) = duration(u.col(0), p);
  if (has_duration()) durations = u.bottomRows(1).transpose();
  out.setZero(u.rows(), u.cols());
  Matrix here(n, u.cols());
  Matrix velocity;
  for (Index j = 0; j < intervals(); ++j) {
    for (Index i = 0; i < m; ++i) {
      auto rows = out.middleRows((j * m + i + 1) * n, n);
      here.setZero();
      for (Index k = 0; k <= m; ++k) {
        here += rule.values()(i, k) * u.middleRows((j * m + k) * n, n);
        rows += rule.derivatives()(i, k) * u.middleRows((j * m + k) * n, n);
      }
      const double s = at.mesh.borders()(j) + at.mesh.length(j) * rule.points()(i);
      if (!field().series(s * durations(0), here, p, velocity)) return false;
      for (Index order = 0; order < u.cols(); ++order) {
        for (Index k = 0; k <= order; ++k)
          rows.col(order) -= at.mesh.length(j) * durations(k) * velocity.col(order - k);
      }
      rows = in_units * rows;
    }
  }
  auto ends = out.topRows(n);
  ends = u.middleRows(last, n) - u.topRows(n);
  ends.col(0) -= winding();
  ends = at.ends.cwiseInverse().asDiagonal() * ends;
  if (!has_duration()) return true;
  out.bottomRows(1) = at.phase.transpose() * u.topRows(n * nodes());
  out(u.rows() - 1, 0) -= at.phase_value;
  return true;
}

}  // namespace arcslip::continuation
