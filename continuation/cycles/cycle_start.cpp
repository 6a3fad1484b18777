// Where branches of cycles begin.

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "arcslip/continuation/cycles/cycle_branch.hpp"
#include "arcslip/continuation/cycles/doubling_problem.hpp"
#include "arcslip/continuation/linear/nearest_eigenvalues.hpp"
#include "arcslip/continuation/path/switching.hpp"
#include "arcslip/continuation/points/normal_form.hpp"
#include "arcslip/dense.hpp"

namespace arcslip::continuation {
namespace {

// Of the scale: how far that orbit is from what a branch leaves which sets its first frame.
constexpr double shape = 1e-2;

// How far from the imaginary axis, relative to the largest eigenvalue, one is at a Hopf point.
constexpr double located = 1e-8;

/// A change of an orbit, as large as the scale.
Matrix in_units(const Matrix& change, const Vector& scale) {
  return change / change.cwiseQuotient(scale.replicate(1, change.cols())).cwiseAbs().maxCoeff();
}

/// A pair of eigenvalues, by one of the two, and its vectors of length 1.
struct Pair {
  Complex value;
  double beside;  ///< how large the largest eigenvalue is
  ComplexVector right;
  ComplexVector left;
};

/// The scale, raised for unknowns that vanish at rest, as velocities do: they have no size of their own, and
/// are given what they move by when none of the others that take part in the motion moves by more than its
/// size at rest.
Vector scale_in_motion(const Vector& scale, const Vector& at_rest, const Pair& pair) {
  constexpr double vanishing = 1e-8;  // of the scale
  constexpr double much = 0.1;        // of the largest share
  const Vector size = pair.right.cwiseAbs();
  const Vector share = size.cwiseProduct(pair.left.cwiseAbs());
  double far = HUGE_VAL;
  for (Index i = 0; i < size.size(); ++i) {
    const double own = std::abs(at_rest(i));
    if (own > vanishing * scale(i) && share(i) > much * share.maxCoeff()) far = std::min(far, own / size(i));
  }
  return std::isfinite(far) ? scale.cwiseMax(far * size) : scale;
}

/// The cycle that leaves an equilibrium with the motion of an eigenvector q; w q + its conjugate, if a size
/// |w| is given, but by no more than part of the scale.
SmallCycle small_cycle(const std::shared_ptr<const Field>& field, const Guess& hopf, const Pair& pair,
                       const std::optional<double>& size, const CycleOptions& options) {
  constexpr double farthest = 0.3;  // of the scale
  const Index n = field->size();
  Vector scale(n);
  Vector unused(hopf.parameters.size());
  field->scale(hopf.unknowns, hopf.parameters, scale, unused);
  scale = scale_in_motion(scale, hopf.unknowns, pair);
  const ComplexVector& q = pair.right;
  const OrbitMesh mesh = options.mesh(*field);
  Matrix motion(n, mesh.nodes());
  for (Index node = 0; node < mesh.nodes(); ++node)
    motion.col(node) = (q * std::polar(1.0, two_pi * mesh.place(node))).real();
  motion.rightCols(1) = motion.col(0);
  motion = in_units(motion, scale);
  const double of_unit = 2 * q.cwiseAbs().cwiseQuotient(scale).maxCoeff() / q.norm();
  const double far = size ? std::min(*size * of_unit, farthest) : first_departure;
  const Matrix still = hopf.unknowns.replicate(1, mesh.nodes());
  CycleStart start = cycle_from_orbit(field, mesh, still + std::max(shape, 2 * far) * motion,
                                      two_pi / pair.value.imag(), hopf.parameters);
  start.guess.unknowns.head(still.size()) = (still + far * motion).reshaped();
  start.guess.direction.setZero(start.guess.unknowns.size() + 1);
  start.guess.direction.head(motion.size()) = motion.reshaped();
  return {std::move(start), far / of_unit};
}

}  // namespace

CycleStart cycle_from_orbit(std::shared_ptr<const Field> field, const OrbitMesh& mesh, const Matrix& orbit,
                            double duration, const Vector& p, int periods) {
  const auto problem = std::make_shared<CycleProblem>(std::move(field), mesh, orbit, p, periods);
  return {problem, start_from(problem, orbit, duration, p).guess};
}

namespace {

/// The pairs of eigenvalues of an equilibrium, each by the one with a positive imaginary part.
std::vector<Pair> pairs_at(const Field& field, const Guess& hopf) {
  const Index n = field.size();
  const bool is_sparse = field.sparse();
  Matrix jacobian(is_sparse ? 0 : n, n);
  SparseMatrix sparse_jacobian;
  FieldValues wanted;
  if (is_sparse) {
    wanted.sparse_by_unknowns = &sparse_jacobian;
  } else {
    wanted.by_unknowns = &jacobian;
  }
  if (field.is_periodic() || !field.evaluate(0, hopf.unknowns, hopf.parameters, wanted))
    throw std::invalid_argument("cycles_from_hopf: no equilibrium");
  ComplexMatrix right;
  ComplexMatrix left;
  const auto values_of = [&](bool transposed, ComplexMatrix& vectors) {
    if (is_sparse) {
      const SparseMatrix matrix = transposed ? SparseMatrix(sparse_jacobian.transpose()) : sparse_jacobian;
      return nearest_eigenvalues(matrix, eigenvalues_looked_at, &vectors);
    }
    return eigenvalues(transposed ? Matrix(jacobian.transpose()) : jacobian, &vectors);
  };
  const ComplexVector values = values_of(false, right);
  const ComplexVector again = values_of(true, left);
  std::vector<Pair> pairs;
  for (Index i = 0; i < values.size(); ++i) {
    if (!(values(i).imag() > 0)) continue;
    Pair& pair =
        pairs.emplace_back(values(i), values.cwiseAbs().maxCoeff(), right.col(i), ComplexVector::Zero(n));
    Index same = 0;
    if (again.size() == 0) continue;  // not converged
    (again.array() - values(i)).abs().minCoeff(&same);
    pair.left = left.col(same);
  }
  if (pairs.empty()) throw std::invalid_argument("cycles_from_hopf: no pair of eigenvalues is complex");
  return pairs;
}

}  // namespace

std::vector<CycleStart> cycles_from_hopf(const std::shared_ptr<const Field>& field, const Guess& hopf,
                                         const CycleOptions& options) {
  std::vector<Pair> pairs = pairs_at(*field, hopf);
  const auto off_axis = [](const Pair& pair) { return std::abs(pair.value.real()); };
  std::ranges::stable_sort(pairs, {}, off_axis);
  const double on_axis = off_axis(pairs.front()) + located * pairs.front().beside;
  std::vector<CycleStart> starts;
  for (const Pair& pair : pairs) {
    if (off_axis(pair) <= on_axis) starts.push_back(small_cycle(field, hopf, pair, {}, options).start);
  }
  return starts;
}

SmallCycle cycle_of_pair(const std::shared_ptr<const Field>& field, const Guess& hopf, double omega,
                         const std::optional<double>& size, const CycleOptions& options) {
  const std::vector<Pair> pairs = pairs_at(*field, hopf);
  const auto away = [&](const Pair& pair) { return std::abs(pair.value - Complex(0, omega)); };
  return small_cycle(field, hopf, *std::ranges::min_element(pairs, {}, away), size, options);
}

std::optional<OrbitStart> orbit_from_doubling(const PeriodicOrbit& problem, Index parameter,
                                              const BranchPoint& doubling, double far) {
  if (problem.is_trigonometric()) {
    BranchPoint there = doubling;
    there.regime = {};
    const auto same = dynamic_cast<const CycleProblem&>(problem).on_intervals(
        doubling.unknowns, doubling.parameters, doubling.regime, there.unknowns);
    const auto start = orbit_from_doubling(*same, parameter, there, far);
    if (!start) return std::nullopt;
    const OrbitMesh mesh(CollocationRule::trigonometric(static_cast<int>(2 * problem.resolution())), 1);
    return refined(*start, [&](const Matrix& /*orbit*/) { return mesh; });
  }
  DoublingProblem conditions(problem, parameter);
  const BasePoint guess{doubling.unknowns, doubling.parameters, doubling.regime, {}};
  const auto located = locate(conditions, guess);
  if (!located || !conditions.adapt(located->point)) return std::nullopt;
  const BasePoint& at = located->point;
  const OrbitFrame& frame = problem.frame(at.regime);
  const Matrix once = in_units(problem.orbit(conditions.right_null()), frame.scale);
  const Matrix change = problem.two_rounds(once, -1);
  const Matrix both = problem.two_rounds(problem.orbit(at.unknowns), 1);
  OrbitStart start = start_from(problem.doubled(problem.mesh_of_two(frame.mesh),
                                                both + std::max(shape, 2 * far) * change, at.parameters),
                                both, 2 * problem.duration(at.unknowns, at.parameters), at.parameters);
  start.guess.unknowns.head(both.size()) = (both + far * change).reshaped();
  start.guess.direction.setZero(start.guess.unknowns.size() + 1);
  start.guess.direction.head(change.size()) = change.reshaped();
  return start;
}

std::optional<OrbitStart> orbit_from_branch_point(const OrbitProblem& problem, const std::string& parameter,
                                                  const BranchPoint& point, const Tolerances& tolerances) {
  const std::vector<Guess> ways = other_ways(problem, parameter, point, tolerances);
  if (ways.empty()) return std::nullopt;
  const Guess& way = ways.front();
  OrbitStart start =
      start_from(about(problem, way.unknowns, way.parameters, point.regime), problem.orbit(way.unknowns),
                 problem.duration(way.unknowns, way.parameters), way.parameters);
  start.guess.direction = way.direction;
  start.both_ways = true;
  return start;
}

OrbitStart refined(const OrbitStart& start, Index resolution) {
  const OrbitFrame& frame = start.problem->frame(start.guess.regime);
  return refined(
      start, [&](const Matrix& orbit) { return frame.mesh.equidistributed(orbit, frame.range, resolution); });
}

OrbitStart refined(const OrbitStart& start, const std::function<OrbitMesh(const Matrix&)>& mesh_for) {
  const OrbitProblem& from = *start.problem;
  const OrbitFrame& frame = from.frame(start.guess.regime);
  const Matrix orbit = from.orbit(start.guess.unknowns);
  const bool has_direction = start.guess.direction.size() > 0;
  const auto carried = [&](const OrbitMesh& mesh, const Vector& all) {
    Vector result(from.field().size() * mesh.nodes() + all.size() - orbit.size());
    result << frame.mesh.carried(from.orbit(all), mesh).reshaped(), all.tail(all.size() - orbit.size());
    return result;
  };
  Matrix reference =
      orbit;  // of the frame: more of the direction than the guess has, which is close to others
  if (has_direction) {
    const Matrix along = from.orbit(start.guess.direction);
    reference += shape * in_units(along, frame.scale);
  }
  const OrbitMesh mesh = mesh_for(reference);
  OrbitStart result{from.about(mesh, frame.mesh.carried(reference, mesh), start.guess.parameters),
                    start.guess, start.both_ways};
  result.guess.unknowns = carried(mesh, start.guess.unknowns);
  if (has_direction) result.guess.direction = carried(mesh, start.guess.direction);
  result.guess.regime = {};
  return result;
}

}  // namespace arcslip::continuation
