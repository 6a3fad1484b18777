#include "arcslip/continuation/cycles/multiplier_form.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "arcslip/continuation/linear/borders.hpp"
#include "arcslip/continuation/linear/complex_sparse_factors.hpp"
#include "arcslip/continuation/problem/expansion.hpp"

namespace arcslip::continuation {
namespace {

/// The equations of a cycle, or of a fixed point.
class Rounds {
 public:
  Rounds(const Problem& problem, const Guess& at)
      : cycles_(dynamic_cast<const CycleProblem*>(&problem)),
        at_(problem),
        point_(at),
        count_(problem.size() - (cycles_ != nullptr && cycles_->has_duration() ? 1 : 0)) {
    exists_ = at_.evaluate(at.unknowns, at.parameters, at.regime);
  }

  bool exists() const { return exists_; }
  Index count() const { return count_; }  ///< of unknowns but for T
  double duration() const {
    return cycles_ == nullptr ? 1 : cycles_->duration(point_.unknowns, point_.parameters);
  }

  /// K(z), of all but T; or whole, at z = 1.
  ComplexSparse matrix(Complex z, bool whole) const {
    const Index size = whole ? point_.unknowns.size() : count_;
    const SparseMatrix jacobian =
        at_.sparse() ? at_.sparse_jacobian() : SparseMatrix(at_.jacobian().sparseView());
    const Index first = cycles_ == nullptr ? 0 : cycles_->field().size();  // columns that may join rounds
    std::vector<Eigen::Triplet<Complex>> entries;
    for (Index column = 0; column < size; ++column) {
      for (SparseMatrix::InnerIterator entry(jacobian, column); entry && entry.row() < size; ++entry) {
        const Complex factor = column < first && cycles_->joins_rounds(entry.row(), column) ? z : 1;
        entries.emplace_back(static_cast<int>(entry.row()), static_cast<int>(column), factor * entry.value());
      }
      // that of a map is f' - 1
      if (cycles_ == nullptr)
        entries.emplace_back(static_cast<int>(column), static_cast<int>(column), 1.0 - z);
    }
    ComplexSparse result(size, size);
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
  }

  /// dK/dz v
  ComplexVector turned(const ComplexVector& v) const {
    if (cycles_ == nullptr) return -v;
    ComplexVector result = ComplexVector::Zero(count_);
    for (Index column = 0; column < cycles_->field().size(); ++column) {
      for (SparseMatrix::InnerIterator entry(at_.sparse_jacobian(), column); entry; ++entry) {
        if (entry.row() < count_ && cycles_->joins_rounds(entry.row(), column))
          result(entry.row()) += entry.value() * v(column);
      }
    }
    return result;
  }

  /// The root of int_0^T |v|^2 dt.
  double length(const ComplexVector& v) const {
    if (cycles_ == nullptr) return v.norm();
    return std::sqrt(duration()) * at_points(v, false).norm();
  }

  /// The same without v's part along the cycle's own velocity, which a phase condition leaves at will: where
  /// there is one.
  double length_across(const ComplexVector& v) const {
    if (cycles_ == nullptr || !cycles_->has_duration()) return length(v);
    const ComplexVector along = at_points(point_.unknowns.cast<Complex>(), true).normalized();
    const ComplexVector here = at_points(v, false);
    return std::sqrt(duration()) * (here - along.dot(here) * along).norm();
  }

  /// The coefficient of h^2 or h^3 of F along a curve: 0 in what is linear.
  bool series(Expansion& expansion, const Matrix& u, Vector& out) const {
    Matrix all;
    if (!expansion.along(u, point_.parameters, point_.regime, all)) return false;
    out = all.rightCols(1);
    return true;
  }

  const Guess& point() const { return point_; }

 private:
  /// v or its derivative by s = t/T where equations hold, times roots of weights: int_0^1 |v|^2 ds is its
  /// square.
  ComplexVector at_points(const ComplexVector& v, bool derivative) const {
    const OrbitMesh& mesh = cycles_->frame(point_.regime).mesh;
    const CollocationRule& rule = mesh.rule();
    const Index n = cycles_->field().size();
    const Index m = rule.degree();
    ComplexVector result = ComplexVector::Zero(n * m * mesh.intervals());
    for (Index j = 0; j < mesh.intervals(); ++j) {
      const double length = mesh.length(j);
      for (Index i = 0; i < m; ++i) {
        const double factor = std::sqrt(length * rule.weights()(i)) / (derivative ? length : 1);
        for (Index k = 0; k <= m; ++k) {
          const double weight = derivative ? rule.derivatives()(i, k) : rule.values()(i, k);
          result.segment((j * m + i) * n, n) += factor * weight * v.segment((j * m + k) * n, n);
        }
      }
    }
    return result;
  }

  const CycleProblem* cycles_;
  Linearization at_;
  const Guess& point_;
  Index count_;
  bool exists_ = false;
};

/// [matrix, b; c^H, 0]
ComplexSparse bordered(const ComplexSparse& matrix, const ComplexVector& b, const ComplexVector& c) {
  const Index n = matrix.rows();
  std::vector<Eigen::Triplet<Complex>> entries;
  for (Index column = 0; column < n; ++column) {
    for (ComplexSparse::InnerIterator entry(matrix, column); entry; ++entry)
      entries.emplace_back(static_cast<int>(entry.row()), static_cast<int>(column), entry.value());
    entries.emplace_back(static_cast<int>(column), static_cast<int>(n), b(column));
    entries.emplace_back(static_cast<int>(n), static_cast<int>(column), std::conj(c(column)));
  }
  ComplexSparse whole(n + 1, n + 1);
  whole.setFromTriplets(entries.begin(), entries.end());
  return whole;
}

/// The right and the left null vector of a matrix that is singular but for how well its point is located.
struct NullVectors {
  ComplexVector right;
  ComplexVector left;
};
NullVectors null_vectors(const ComplexSparse& matrix) {
  const Index n = matrix.rows();
  NullVectors found{continuation::spread(n, 1), continuation::spread(n, 2)};
  const ComplexSparseFactors all_but_singular(matrix);
  const ComplexVector left = all_but_singular.solve_adjoint(found.left).normalized();
  const ComplexVector right = all_but_singular.solve(left).normalized();
  if (right.allFinite()) return {right, all_but_singular.solve_adjoint(right).normalized()};
  ComplexVector unit = ComplexVector::Zero(n + 1);  // it is singular to the last digit
  unit(n) = 1;
  for (int i = 0; i < 2; ++i) {  // inverse iteration
    const ComplexSparseFactors factors(bordered(matrix, found.left, found.right));
    found.right = factors.solve(unit).head(n).normalized();
    found.left = factors.solve_adjoint(unit).head(n).normalized();
  }
  return found;
}

/// u + h Re v, with room for terms of higher order.
Matrix curve_of(const Guess& point, const ComplexVector& along, Index order) {
  Matrix u = Matrix::Zero(point.unknowns.size(), order + 1);
  u.col(0) = point.unknowns;
  u.col(1).head(along.size()) = along.real();
  return u;
}

/// The critical vectors, and what they lead to.
class Reduction {
 public:
  Reduction(const Rounds& rounds, Complex multiplier) : rounds_(rounds), steady_(rounds.matrix(1, true)) {
    const ComplexSparse matrix = rounds.matrix(multiplier, false);
    const NullVectors found = null_vectors(matrix);
    v_ = found.right / rounds.length(found.right);
    psi_ = found.left;
    if (multiplier.imag() == 0) v_ /= largest_entry(v_) / std::abs(largest_entry(v_));
    weight_ = multiplier * psi_.dot(rounds.turned(v_));
    if (multiplier.imag() == 0) return;
    twice_.emplace(rounds.matrix(multiplier * multiplier, false));
    // By how much the problem's multiplier is another one, over how far that is surely from a cube root of 1.
    constexpr double surely = 10;
    const double missed = std::max(std::abs(psi_.dot(ComplexVector(matrix * v_)) / weight_), rounding_);
    rounding_ = missed / std::max(std::abs(std::pow(multiplier, 3) - 1.0) - surely * missed, 0.0);
  }

  /// Of the coefficient, relative to its terms.
  double rounding() const { return rounding_; }

  /// c T, and the size of its terms
  bool real(Expansion& expansion, Vector& found) const {
    Matrix u = curve_of(rounds_.point(), v_, 3);
    Vector term;
    Vector direct;
    if (!rounds_.series(expansion, u, direct)) return false;
    if (!rounds_.series(expansion, u.leftCols(3), term)) return false;
    u.col(2) = -steady_.solve(term.cast<Complex>()).real();
    if (!rounds_.series(expansion, u, term)) return false;
    found = told(term.cast<Complex>(), direct.cast<Complex>());
    return true;
  }

  /// Re d T, and the size of its terms
  bool complex(Expansion& expansion, Vector& found) const {
    ComplexVector steady = ComplexVector::Zero(rounds_.point().unknowns.size());
    ComplexVector turning = steady;
    Vector term;
    constexpr int lines = 3;
    for (int k = 0; k < lines; ++k) {
      const Complex way = std::polar(1.0, pi * k / lines);
      if (!rounds_.series(expansion, curve_of(rounds_.point(), 2.0 * way * v_, 2), term)) return false;
      steady += term / lines;
      turning += std::pow(std::conj(way), 2) / static_cast<double>(lines) * term;
    }
    const Vector mean = -steady_.solve(steady).real();
    const ComplexVector twice = -twice_->solve(turning.head(rounds_.count()));
    constexpr int further = 4;
    ComplexVector third = ComplexVector::Zero(steady.size());
    ComplexVector direct = third;
    for (int k = 0; k < further; ++k) {
      const Complex way = std::polar(1.0, pi * k / further);
      Matrix u = curve_of(rounds_.point(), 2.0 * way * v_, 3);
      if (!rounds_.series(expansion, u, term)) return false;
      direct += std::conj(way) / static_cast<double>(further) * term;
      u.col(2) = mean;
      u.col(2).head(twice.size()) += 2 * (way * way * twice).real();
      if (!rounds_.series(expansion, u, term)) return false;
      third += std::conj(way) / static_cast<double>(further) * term;
    }
    found = told(third, direct);
    return true;
  }

 private:
  /// The coefficient and the size of what is direct and of what is by other orders.
  Vector told(const ComplexVector& whole, const ComplexVector& direct) const {
    return Eigen::Vector2d(cubic(whole).real(),
                           std::abs(cubic(direct)) + std::abs(cubic(ComplexVector(whole - direct))));
  }
  Complex cubic(const ComplexVector& term) const { return -psi_.dot(term.head(psi_.size())) / weight_; }

  const Rounds& rounds_;
  ComplexSparseFactors steady_;                // at z = 1
  std::optional<ComplexSparseFactors> twice_;  // at the square of a multiplier that is not real
  ComplexVector v_;
  ComplexVector psi_;
  Complex weight_;
  double rounding_ = std::numeric_limits<double>::epsilon();
};

/// b T: of the whole matrix, in which T changes with w as well.
bool at_fold(const Rounds& rounds, Expansion& expansion, Vector& coefficient) {
  const NullVectors found = null_vectors(rounds.matrix(1, true));
  ComplexVector v = found.right;
  v /= largest_entry(v);
  v /= rounds.length_across(v.head(rounds.count()));
  Matrix u = Matrix::Zero(v.size(), 3);
  u.col(0) = rounds.point().unknowns;
  u.col(1) = v.real();
  Vector term;
  if (!rounds.series(expansion, u, term)) return false;
  const ComplexVector psi = found.left;
  const Complex weight = psi.head(rounds.count()).dot(rounds.turned(v.head(rounds.count())));
  coefficient = Vector::Constant(2, std::abs(psi.dot(term.cast<Complex>()) / weight));
  return true;
}

/// ln mu/T of all multipliers, with ln -mu of those below 0; empty where they are not known.
ComplexVector rates_at(const Problem& problem, const Guess& at) {
  ComplexVector rates;
  return problem.eigenvalues(at.unknowns, at.parameters, at.regime, rates) ? rates : ComplexVector();
}

/// That of the pair nearest to the unit circle; 0 without one.
Complex torus_multiplier(const ComplexVector& rates, double duration) {
  Complex nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (const Complex& rate : rates) {
    if (!(rate.imag() > 0) || !(std::abs(rate.real()) < least)) continue;
    least = std::abs(rate.real());
    nearest = std::polar(1.0, rate.imag() * duration);
  }
  return nearest;
}

/// Whether another multiplier is there as well: there is no coefficient then.
bool is_double(const ComplexVector& rates, Complex multiplier, double duration) {
  constexpr double same = 1e-6;  // of ln mu: as well as the point is located, and far above rounding
  const double angle = multiplier.imag() == 0 ? 0 : std::arg(multiplier);  // rates are those of -mu below 0
  return ((rates.array() * duration - Complex(0, angle)).abs() < same).count() > 1;
}

}  // namespace

bool has_critical_multiplier(PointType type, const ComplexVector& log_multipliers) {
  constexpr double near = 0.1;
  const auto misses_by = [&](const Complex& log) {
    if (type == PointType::neimark_sacker) return std::abs(log.real());
    return std::abs(log - Complex(0, type == PointType::period_doubling ? pi : 0));
  };
  return std::any_of(log_multipliers.begin(), log_multipliers.end(),
                     [&](const Complex& log) { return misses_by(log) < near; });
}

std::optional<MultiplierForm> multiplier_form(const Problem& problem, PointType type, const Guess& at,
                                              double angle) {
  const auto* cycles = dynamic_cast<const CycleProblem*>(&problem);
  if (cycles != nullptr && cycles->is_trigonometric()) {
    Guess there{{}, at.parameters};
    const auto same = cycles->on_intervals(at.unknowns, at.parameters, at.regime, there.unknowns);
    return multiplier_form(*same, type, there, angle);
  }
  const bool is_cycle = cycles != nullptr;
  const bool is_known =
      type == PointType::period_doubling || type == PointType::neimark_sacker || type == PointType::fold;
  if (!is_known || (!is_cycle && (!problem.is_map() || problem.sparse()))) return std::nullopt;
  if (is_cycle &&
      !has_critical_multiplier(type, cycles->log_multipliers(at.unknowns, at.parameters, at.regime)))
    return std::nullopt;
  const Rounds rounds(problem, at);
  if (!rounds.exists()) return std::nullopt;
  const ComplexVector rates = type == PointType::fold ? ComplexVector() : rates_at(problem, at);
  Complex multiplier = type == PointType::period_doubling ? -1 : 1;
  if (type == PointType::neimark_sacker)
    multiplier = angle > 0 ? std::polar(1.0, angle) : torus_multiplier(rates, rounds.duration());
  if (multiplier == 0.0 || is_double(rates, multiplier, rounds.duration())) return std::nullopt;
  std::optional<Reduction> reduction;
  if (type != PointType::fold) reduction.emplace(rounds, multiplier);
  Vector numbers;
  const Estimated found = with_best_reach(problem, numbers, [&](Expansion& expansion, Vector& out) {
    if (type == PointType::fold) return at_fold(rounds, expansion, out);
    return type == PointType::period_doubling ? reduction->real(expansion, out)
                                              : reduction->complex(expansion, out);
  });
  if (!found.exists) return std::nullopt;
  Vector scale(problem.size());
  Vector parameter_scale(at.parameters.size());
  problem.scale(at.unknowns, at.parameters, scale, parameter_scale);
  const double usual = 1 / (scale.head(rounds.count()).cwiseAbs2().maxCoeff() * rounds.duration());
  const double terms = (numbers(1) + usual) / rounds.duration();
  return MultiplierForm{numbers(0) / rounds.duration(), found.error / rounds.duration(), terms,
                        reduction ? reduction->rounding() * terms : 0};
}

std::optional<TurningVector> turning_vector(const CycleProblem& cycles, const Guess& at) {
  const Rounds rounds(cycles, at);
  if (!rounds.exists()) return std::nullopt;
  const Complex multiplier = torus_multiplier(rates_at(cycles, at), rounds.duration());
  if (multiplier == 0.0) return std::nullopt;
  return TurningVector{null_vectors(rounds.matrix(multiplier, false)).right, std::arg(multiplier)};
}

}  // namespace arcslip::continuation
