#include "arcslip/continuation/cycles/orbit_problem.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace arcslip::continuation {
namespace {

/// Eliminates the first columns from the others, with pivots of all rows below those before.
void eliminate(Matrix& matrix, Index columns) {
  for (Index k = 0; k < columns; ++k) {
    const Index below = matrix.rows() - k - 1;
    double* const column = matrix.col(k).data() + k;
    const double* const largest = std::max_element(
        column, column + below + 1, [](double a, double b) { return std::abs(a) < std::abs(b); });
    const Index exchanged = largest - column;
    std::swap(column[0], column[exchanged]);
    for (Index j = k + 1; j < matrix.cols(); ++j) {
      double* const other = matrix.col(j).data() + k;
      std::swap(other[0], other[exchanged]);
      const double factor = other[0] / column[0];
      for (Index i = 1; i <= below; ++i) other[i] -= factor * column[i];
    }
  }
}

}  // namespace

/// What is found of the field at the points of an interval.
struct OrbitProblem::Scratch {
  Scratch(Index n, Index parameters, Index degree, const SparseMatrix* block)
      : place(n), velocity(n), by_time(n), velocities(n, degree), changes(n, degree) {
    if (block != nullptr) {
      sparse_by_unknowns.assign(static_cast<std::size_t>(degree), *block);
    } else {
      by_unknowns.assign(static_cast<std::size_t>(degree), Matrix(n, n));
    }
    by_parameters.assign(static_cast<std::size_t>(degree), Matrix(n, parameters));
  }
  Vector place;
  Vector velocity;
  Vector by_time;
  Matrix velocities;  // f
  Matrix changes;     // sum_k D_ik u_k
  std::vector<Matrix> by_unknowns;
  std::vector<Matrix> by_parameters;
  std::vector<SparseMatrix> sparse_by_unknowns;  // of a sparse field, in place of the others
  SparseMatrix of_field;
};

OrbitProblem::OrbitProblem(std::shared_ptr<const Field> field, bool has_duration)
    : field_(std::move(field)), has_duration_(has_duration) {}

void OrbitProblem::begin(const OrbitMesh& mesh, const Matrix& orbit, const Vector& p) {
  add_frame(mesh, orbit, p);
  build_block(orbit, p);
  build_pattern();
}

double OrbitProblem::duration(const Vector& u, const Vector& p, Vector* by_parameters) const {
  if (!has_duration_) return given_duration(p, by_parameters);
  if (by_parameters != nullptr) by_parameters->setZero(p.size());
  return u(u.size() - 1);
}

Vector OrbitProblem::times(const Vector& u, const Vector& p, const Regime& regime) const {
  Vector result(nodes());
  for (Index node = 0; node < result.size(); ++node) result(node) = frame(regime).mesh.place(node);
  return result * duration(u, p);
}

bool OrbitProblem::at_point(const OrbitFrame& frame, const Vector& u, const Vector& p, double duration,
                            Index interval, Index point, bool derivatives, Scratch& scratch) const {
  const CollocationRule& rule = frame.mesh.rule();
  const auto within = orbit(u).middleCols(interval * degree(), degree() + 1);
  scratch.place = within.lazyProduct(rule.values().row(point).transpose());
  scratch.changes.col(point) = within.lazyProduct(rule.derivatives().row(point).transpose());
  const double s = frame.mesh.borders()(interval) + frame.mesh.length(interval) * rule.points()(point);
  const auto i = static_cast<std::size_t>(point);
  FieldValues wanted{&scratch.velocity, nullptr, nullptr, nullptr};
  if (derivatives) {
    if (field_->sparse()) {
      wanted.sparse_by_unknowns = &scratch.of_field;
    } else {
      wanted.by_unknowns = &scratch.by_unknowns[i];
    }
    wanted.by_parameters = &scratch.by_parameters[i];
    if (field_->is_periodic()) wanted.by_time = &scratch.by_time;
  }
  if (!field_->evaluate(s * duration, scratch.place, p, wanted)) return false;
  scratch.velocities.col(point) = scratch.velocity;
  if (wanted.sparse_by_unknowns != nullptr) {
    auto entries = scratch.sparse_by_unknowns[i].coeffs();
    entries.setZero();
    for (std::size_t k = 0; k < places_.size(); ++k)
      entries(places_[k]) = scratch.of_field.valuePtr()[static_cast<Index>(k)];
  }
  if (derivatives) {  // of T f
    scratch.by_parameters[i] *= duration;
    Vector by_parameters;
    if (!has_duration_) {
      given_duration(p, &by_parameters);
      Vector change = scratch.velocity;
      if (wanted.by_time != nullptr) change += duration * s * scratch.by_time;
      scratch.by_parameters[i] += change * by_parameters.transpose();
    }
  }
  return true;
}

void OrbitProblem::fill_interval(const OrbitFrame& frame, double duration, Index interval,
                                 const Scratch& scratch, const Evaluation& out) const {
  const Index n = field_->size();
  const Index m = degree();
  const CollocationRule& rule = frame.mesh.rule();
  const double h = frame.mesh.length(interval);
  const Vector in_units = frame.scale.cwiseInverse();
  const bool is_sparse = field_->sparse();
  for (Index i = 0; i < m; ++i) {
    const Index first = (interval * m + i + 1) * n;
    const auto at = static_cast<std::size_t>(i);
    if (out.residual != nullptr) {
      out.residual->segment(first, n) =
          (scratch.changes.col(i) - h * duration * scratch.velocities.col(i)).cwiseProduct(in_units);
    }
    if (out.parameter_jacobian != nullptr) {
      out.parameter_jacobian->middleRows(first, n) = -h * in_units.asDiagonal() * scratch.by_parameters[at];
    }
    if (out.sparse_jacobian == nullptr) continue;
    double* values = out.sparse_jacobian->valuePtr();
    const int* starts = out.sparse_jacobian->outerIndexPtr();
    const double* by_unknowns =
        is_sparse ? scratch.sparse_by_unknowns[at].valuePtr() : scratch.by_unknowns[at].data();
    for (Index k = 0; k <= m; ++k) {
      const Index node = interval * m + k;
      const bool is_end = node == 0 || node + 1 == nodes();
      const Index conditions = is_end ? end_entries() : 0;
      const Index blocks = i + (k == 0 && interval > 0 ? m : 0);  // those of the interval before come first
      const double weight = -h * duration * rule.values()(i, k);
      for (Index c = 0; c < n; ++c) {
        const Index begin = block_.outerIndexPtr()[c];
        const Index count = block_.outerIndexPtr()[c + 1] - begin;
        const int* const rows = block_.innerIndexPtr() + begin;
        double* block = values + starts[node * n + c] + conditions + blocks * count;
        for (Index entry = 0; entry < count; ++entry)
          block[entry] = weight * by_unknowns[begin + entry] * in_units(rows[entry]);
        block[diagonal_[static_cast<std::size_t>(c)]] += rule.derivatives()(i, k) * in_units(c);
      }
    }
    if (!has_duration_) continue;
    double* block = values + starts[size() - 1] + first - n;
    for (Index row = 0; row < n; ++row) block[row] = -h * scratch.velocities(row, i) * in_units(row);
  }
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
  Scratch scratch(field_->size(), p.size(), degree(), field_->sparse() ? &block_ : nullptr);
  for (Index j = 0; j < intervals(); ++j) {
    for (Index i = 0; i < degree(); ++i) {
      if (!at_point(at, u, p, length, j, i, derivatives, scratch)) return false;
    }
    fill_interval(at, length, j, scratch, out);
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
  Scratch scratch(n, p.size(), m, nullptr);
  Vector row(n + p.size());
  Vector direction(n);
  Vector weight(n);
  out.setZero(size() + p.size());
  for (Index j = 0; j < intervals(); ++j) {
    for (Index i = 0; i < m; ++i) {
      if (!at_point(at, u, p, 1, j, i, true, scratch)) return false;
      const auto point = static_cast<std::size_t>(i);
      const Matrix& by_unknowns = scratch.by_unknowns[point];
      const Matrix& by_parameters = scratch.by_parameters[point];
      direction.noalias() = orbit(du).middleCols(j * m, m + 1) * rule.values().row(i).transpose();
      weight = w.segment((j * m + i + 1) * n, n).cwiseQuotient(at.scale) * -at.mesh.length(j);
      if (!field_->second(0, scratch.place, p, weight, direction, dp, row)) return false;
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

bool OrbitProblem::transfers(const Vector& u, const Vector& p, const Regime& regime,
                             std::vector<Matrix>& out) const {
  const OrbitFrame& at = frame(regime);
  const CollocationRule& rule = at.mesh.rule();
  const Index n = field_->size();
  const Index m = degree();
  const double length = duration(u, p);
  Scratch scratch(n, p.size(), m, nullptr);
  Matrix all(n * m, n * (m + 1));  // of the inner nodes, then of the left end and of the right one
  out.resize(static_cast<std::size_t>(intervals()));
  for (Index j = 0; j < intervals(); ++j) {
    for (Index i = 0; i < m; ++i) {
      if (!at_point(at, u, p, length, j, i, true, scratch)) return false;
      const Matrix& by_unknowns = scratch.by_unknowns[static_cast<std::size_t>(i)];
      for (Index k = 0; k <= m; ++k) {
        const Index place = k < m ? (k + m - 1) % m : m;
        auto block = all.block(i * n, place * n, n, n);
        block = -at.mesh.length(j) * length * rule.values()(i, k) * by_unknowns;
        block.diagonal().array() += rule.derivatives()(i, k);
      }
    }
    eliminate(all, n * (m - 1));
    const auto left = all.middleCols(n * (m - 1), n).bottomRows(n);
    out[static_cast<std::size_t>(j)] = -all.rightCols(n).bottomRows(n).partialPivLu().solve(left);
  }
  return true;
}

}  // namespace arcslip::continuation
