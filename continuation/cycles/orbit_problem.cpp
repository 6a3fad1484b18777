#include "arcslip/continuation/cycles/orbit_problem.hpp"

#include <algorithm>
#include <cmath>

#include "orbit_scratch.hpp"

namespace arcslip::continuation {
namespace {

/// out = a b, entry by entry.
inline void multiply(const double* __restrict a, const double* __restrict b, Index count,
                     double* __restrict out) {
  for (Index i = 0; i < count; ++i) out[i] = a[i] * b[i];
}

}  // namespace

OrbitProblem::OrbitProblem(std::shared_ptr<const Field> field, bool has_duration)
    : field_(std::move(field)), has_duration_(has_duration) {}

void OrbitProblem::begin(const OrbitMesh& mesh, const Matrix& orbit, const Vector& p) {
  add_frame(mesh, orbit, p);
  build_block(orbit, p);
  build_weights(mesh.rule());
  build_pattern();
}

double OrbitProblem::duration(const Vector& u, const Vector& p, Vector* by_parameters) const {
  if (!has_duration_) return given_duration(p, by_parameters);
  if (by_parameters != nullptr) by_parameters->setZero(p.size());
  return u(u.size() - 1);
}

Vector OrbitProblem::times(const Vector& u, const Vector& p, const Regime& regime) const {
  return frame(regime).mesh.places() * duration(u, p);
}

/// Of each interval and unknown four points at a time, by the weights of each node for these.
void OrbitProblem::find_places(const OrbitFrame& frame, const Vector& u, double duration, Index first,
                               Scratch& scratch) const {
  const Index n = field_->size();
  const Index m = degree();
  const CollocationRule& rule = frame.mesh.rule();
  for (Index q = 0; q < scratch.times.size(); q += m) {
    const Index interval = std::min(first + q / m, intervals() - 1);
    const double border = frame.mesh.borders()(interval);
    const double length = frame.mesh.length(interval);
    for (Index i = 0; i < m; ++i) scratch.times(q + i) = (border + length * rule.points()(i)) * duration;
    for (Index i = 0; i < m; i += fours) {
      const double* const values = padded_values_.data() + i;
      const double* const slopes = padded_slopes_.data() + i;
      const Index count = std::min(fours, m - i);
      const double* node = u.data() + interval * m * n;
      for (Index r = 0; r < n; ++r, ++node) {
        double place[fours] = {};
        double change[fours] = {};
        for (Index k = 0; k <= m; ++k) {
          const double value = node[k * n];
          const Index from = k * padded_values_.rows();
          for (Index l = 0; l < fours; ++l) place[l] += values[from + l] * value;
          for (Index l = 0; l < fours; ++l) change[l] += slopes[from + l] * value;
        }
        for (Index l = 0; l < count; ++l) scratch.places(r, q + i + l) = place[l];
        for (Index l = 0; l < count; ++l) scratch.changes(r, q + i + l) = change[l];
      }
    }
  }
}

bool OrbitProblem::at_points(const OrbitFrame& frame, const Vector& u, const Vector& p, double duration,
                             Index first, bool derivatives, Scratch& scratch) const {
  find_places(frame, u, duration, first, scratch);
  if (field_->sparse()) return at_sparse_points(p, derivatives, scratch);
  FieldColumns wanted{&scratch.velocities};
  if (derivatives) {
    wanted.by_unknowns = &scratch.by_unknowns;
    wanted.by_parameters = &scratch.by_parameters;
    if (field_->is_periodic()) wanted.by_time = &scratch.by_time;
  }
  return field_->evaluate_columns(scratch.times, scratch.places, p, wanted);
}

bool OrbitProblem::at_sparse_points(const Vector& p, bool derivatives, Scratch& scratch) const {
  SparseMatrix of_field;
  Vector place;
  Vector velocity(field_->size());
  Matrix by_parameters(field_->size(), p.size());
  FieldValues wanted{&velocity};
  if (derivatives) {
    wanted.by_parameters = &by_parameters;
    wanted.sparse_by_unknowns = &of_field;
  }
  for (Index q = 0; q < scratch.times.size(); ++q) {
    place = scratch.places.col(q);
    if (!field_->evaluate(scratch.times(q), place, p, wanted)) return false;
    scratch.velocities.col(q) = velocity;
    if (!derivatives) continue;
    scratch.by_parameters.middleCols(q * p.size(), p.size()) = by_parameters;
    auto entries = scratch.sparse_by_unknowns[static_cast<std::size_t>(q)].coeffs();
    entries.setZero();
    for (std::size_t k = 0; k < places_.size(); ++k)
      entries(places_[k]) = of_field.valuePtr()[static_cast<Index>(k)];
  }
  return true;
}

/// Of T f.
void OrbitProblem::change_with_parameters(double duration, const Vector& p, Scratch& scratch) const {
  scratch.by_parameters *= duration;
  if (has_duration_) return;
  Vector by_parameters;
  given_duration(p, &by_parameters);
  for (Index q = 0; q < scratch.times.size(); ++q) {
    Vector change = scratch.velocities.col(q);
    if (scratch.by_time.size() > 0) change += scratch.times(q) * scratch.by_time.col(q);
    scratch.by_parameters.middleCols(q * p.size(), p.size()) += change * by_parameters.transpose();
  }
}

/// What stands together of its points is filled in at once.
void OrbitProblem::fill_interval(const OrbitFrame& frame, double duration, Index interval, Index from,
                                 Scratch& scratch, const Evaluation& out) const {
  const Index n = field_->size();
  const Index count = n * degree();
  const Index first = interval * count + n;
  const double h = frame.mesh.length(interval);
  const double* const in_units = scratch.in_units.data();
  const double* const velocity = scratch.velocities.col(from).data();
  if (out.residual != nullptr) {
    const double factor = h * duration;
    const double* const change = scratch.changes.col(from).data();
    double* __restrict const residual = out.residual->data() + first;
    for (Index i = 0; i < count; ++i) residual[i] = (change[i] - factor * velocity[i]) * in_units[i];
  }
  if (out.parameter_jacobian != nullptr) {
    const Index parameters = out.parameter_jacobian->cols();
    for (Index c = 0; c < parameters; ++c) {
      double* __restrict to = out.parameter_jacobian->col(c).data() + first;
      for (Index i = 0; i < degree(); ++i) {
        const double* const entries = scratch.by_parameters.col((from + i) * parameters + c).data();
        for (Index r = 0; r < n; ++r) *to++ = -h * entries[r] * in_units[r];
      }
    }
  }
  if (out.sparse_jacobian == nullptr) return;
  SparseMatrix& jacobian = *out.sparse_jacobian;
  if (has_duration_) {
    double* __restrict const column = jacobian.valuePtr() + jacobian.outerIndexPtr()[size() - 1] + first - n;
    for (Index i = 0; i < count; ++i) column[i] = -h * velocity[i] * in_units[i];
  }
  fill_blocks(frame, -h * duration, interval, from, scratch, jacobian);
}

/// Each node's columns hold multiples of all points' blocks, one below the other, and the diagonal's of
/// these.
void OrbitProblem::fill_blocks(const OrbitFrame& frame, double factor, Index interval, Index from,
                               Scratch& scratch, SparseMatrix& out) const {
  const Index n = field_->size();
  const CollocationRule& rule = frame.mesh.rule();
  const int* const begins = block_.outerIndexPtr();
  const int* const rows = block_.innerIndexPtr();
  const double* const units = frame.in_units.data();
  const Index* const diagonals = diagonal_.data();
  with_degree(degree(), [&](auto m) {
    double* __restrict to = scratch.blocks.data();
    for (Index c = 0; c < n; ++c) {
      for (Index i = 0; i < m; ++i) {
        const double* const entries = scratch.entries(from + i);
        for (int entry = begins[c]; entry < begins[c + 1]; ++entry)
          *to++ = factor * entries[entry] * units[rows[entry]];
      }
    }
    for (Index k = 0; k <= m; ++k) {
      const Index node = interval * m + k;
      const bool is_end = node == 0 || node + 1 == nodes();
      const bool is_second = k == 0 && interval > 0;  // those of the interval before come first
      const int* const starts = out.outerIndexPtr() + node * n;
      double* const begin = out.valuePtr() + (is_end ? end_entries() : 0);
      const double* const slopes = rule.derivatives().col(k).data();
      const double* blocks = scratch.blocks.data();
      const double* weights = weights_.col(k).data();
      for (Index c = 0; c < n; ++c) {
        const Index count = begins[c + 1] - begins[c];
        double* __restrict const column = begin + starts[c] + (is_second ? m * count : 0);
        multiply(weights, blocks, m * count, column);
        const double unit = units[c];
        double* __restrict const diagonal = column + diagonals[c];
        for (Index i = 0; i < m; ++i) diagonal[i * count] += slopes[i] * unit;
        blocks += m * count;
        weights += m * count;
      }
    }
  });
}

bool OrbitProblem::fill_conditions(const OrbitFrame& frame, const Vector& u, const Vector& p,
                                   const Evaluation& out) const {
  const Index n = field_->size();
  const Index last = n * (nodes() - 1);
  Vector values(n);
  const bool is_sparse = field_->sparse();
  Matrix by_left(is_sparse ? 0 : n, n);
  Matrix by_right(is_sparse ? 0 : n, n);
  Matrix by_parameters(n, p.size());
  const bool derivatives = out.sparse_jacobian != nullptr || out.parameter_jacobian != nullptr;
  const bool dense = derivatives && !is_sparse;
  const EndConditions wanted{&values, dense ? &by_left : nullptr, dense ? &by_right : nullptr,
                             derivatives ? &by_parameters : nullptr};
  if (!end_conditions(u.head(n), u.segment(last, n), p, wanted)) return false;
  const auto in_units = frame.ends.cwiseInverse().asDiagonal();
  if (out.residual != nullptr) {
    out.residual->head(n) = in_units * values;
    if (has_duration_) (*out.residual)(size() - 1) = frame.phase.dot(u.head(n * nodes())) - frame.phase_value;
  }
  if (out.parameter_jacobian != nullptr) {
    out.parameter_jacobian->topRows(n) = in_units * by_parameters;
    if (has_duration_) out.parameter_jacobian->row(size() - 1).setZero();
  }
  if (out.sparse_jacobian == nullptr) return true;
  double* entries = out.sparse_jacobian->valuePtr();
  const int* starts = out.sparse_jacobian->outerIndexPtr();
  for (Index c = 0; c < n && is_sparse; ++c) {
    entries[starts[c]] = -1 / frame.ends(c);
    entries[starts[last + c]] = 1 / frame.ends(c);
  }
  for (Index c = 0; c < n && !is_sparse; ++c) {
    Eigen::Map<Vector>(entries + starts[c], n) = in_units * by_left.col(c);
    Eigen::Map<Vector>(entries + starts[last + c], n) = in_units * by_right.col(c);
  }
  for (Index column = 0; column < n * nodes() && has_duration_; ++column)
    entries[starts[column + 1] - 1] = frame.phase(column);
  return true;
}

bool OrbitProblem::evaluate(const Vector& u, const Vector& p, const Regime& regime,
                            const Evaluation& out) const {
  if (out.jacobian != nullptr) {  // of a single interval: all but full
    SparseMatrix entries;
    if (!evaluate(u, p, regime, {out.residual, nullptr, out.parameter_jacobian, &entries})) return false;
    *out.jacobian = entries;
    return true;
  }
  const OrbitFrame& at = frame(regime);
  const double length = duration(u, p);
  if (out.sparse_jacobian != nullptr && out.sparse_jacobian->nonZeros() != pattern_.nonZeros())
    *out.sparse_jacobian = pattern_;
  const bool derivatives = out.sparse_jacobian != nullptr || out.parameter_jacobian != nullptr;
  Scratch& scratch = Scratch::of(*this, p.size());
  scratch.in_units = at.in_units.replicate(degree(), 1);
  for (Index first = 0; first < intervals(); first += scratch.together) {
    if (!at_points(at, u, p, length, first, derivatives, scratch)) return false;
    if (out.parameter_jacobian != nullptr) change_with_parameters(length, p, scratch);
    for (Index j = first; j < std::min(first + scratch.together, intervals()); ++j)
      fill_interval(at, length, j, (j - first) * degree(), scratch, out);
  }
  return fill_conditions(at, u, p, out);
}

/// Conditions at the ends count only as far as they are linear: those that derive from this say so.
bool OrbitProblem::second(const Vector& u, const Vector& p, const Regime& regime, const Vector& w,
                          const Vector& du, const Vector& dp, Vector& out) const {
  if (!has_duration_ || field_->sparse()) return false;
  const OrbitFrame& at = frame(regime);
  const CollocationRule& rule = at.mesh.rule();
  const Index n = field_->size();
  const Index m = degree();
  Scratch& scratch = Scratch::of(*this, p.size());
  Vector place;
  Vector row(n + p.size());
  Vector direction(n);
  Vector weight(n);
  out.setZero(size() + p.size());
  for (Index j = 0; j < intervals(); ++j) {
    if (j % scratch.together == 0 && !at_points(at, u, p, 1, j, true, scratch)) return false;
    for (Index i = 0; i < m; ++i) {
      const Index point = j % scratch.together * m + i;
      const auto by_unknowns = scratch.by_unknowns_at(point);
      const auto by_parameters = scratch.by_parameters_at(point);
      place = scratch.places.col(point);
      direction.noalias() = orbit(du).middleCols(j * m, m + 1) * rule.values().row(i).transpose();
      weight = w.segment((j * m + i + 1) * n, n).cwiseQuotient(at.scale) * -at.mesh.length(j);
      if (!field_->second(0, place, p, weight, direction, dp, row)) return false;
      row *= duration(u, p);
      row.head(n).noalias() += du(size() - 1) * (by_unknowns.transpose() * weight);
      row.tail(p.size()).noalias() += du(size() - 1) * (by_parameters.transpose() * weight);
      for (Index k = 0; k <= m; ++k) out.segment((j * m + k) * n, n) += rule.values()(i, k) * row.head(n);
      out(size() - 1) += weight.dot(by_unknowns * direction + by_parameters * dp);
      out.tail(p.size()) += row.tail(p.size());
    }
  }
  return true;
}

void OrbitProblem::scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const {
  const Index n = field_->size();
  Vector sizes(n);
  field_->scale(orbit(u).cwiseAbs().rowwise().maxCoeff(), p, sizes, parameters);
  unknowns.head(n * nodes()).reshaped(n, nodes()).colwise() = sizes;
  if (has_duration_) unknowns(size() - 1) = std::abs(duration(u, p));
}

}  // namespace arcslip::continuation
