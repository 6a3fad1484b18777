#include "sectors/turning_space.hpp"

#include <fmt/format.h>

#include <cmath>
#include <deque>

namespace arcslip {
namespace {

constexpr double lost = 1e-10;  // of a vector: what is left of one that the space has already

double norm(const ComplexSparseMatrix& mass, const ComplexVector& v) {
  const ComplexVector product = mass * v;
  return std::sqrt(std::max(0.0, v.dot(product).real()));
}

}  // namespace

/// The vectors of one rotation, in the order in which they are made, each with the one before it, both turned
/// and scaled alike.
class TurningSpace::Sequence {
 public:
  Sequence(const SectorReduction& reduction, const ComplexMatrix& forces, const Rotation& rotation,
           double eta_high)
      : mass_(reduction.mass()),
        stiffness_(reduction.stiffness()),
        by_last_(ComplexSparseMatrix(reduction.mass().rows(), reduction.mass().cols())),
        factors_(reduction.stiffness()) {
    const double w = two_pi * eta_high;  // in whose units frequencies are
    const bool follows = rotation.per_eta != 0;
    const double omega = follows ? rotation.per_eta : two_pi * rotation.fixed;
    if (follows) {
      by_last_ = w * w * reduction.mass();
      add(reduction.stiffness_speed2(), -omega * omega * w * w, by_last_);
      add(reduction.gyroscopic(), Complex(0, -omega * w * w), by_last_);
    } else {
      add(reduction.stiffness_speed2(), omega * omega, stiffness_);
      add(reduction.gyroscopic(), Complex(0, -omega * w), by_last_);
      by_one_before_ = w * w * reduction.mass();
    }
    if (!factor(eta_high))
      throw SectorError(fmt::format(
          "the stiffness K + Omega^2 K_2 is not positive definite at a speed of {:g}", rotation.fixed));
    ComplexMatrix first = forces;
    factors_.solve(first);
    for (Index i = 0; i < first.cols(); ++i) append(first.col(i), ComplexVector::Zero(first.rows()));
    width_ = vectors_.size();
  }

  /// The vectors that have not been given out; as many steps are made as there were forces.
  std::vector<ComplexVector> next() {
    for (std::size_t i = 0; i < width_ && done_ < vectors_.size(); ++i, ++done_) {
      const Pair from = vectors_[done_];
      ComplexMatrix step = by_last_ * from.last;
      if (by_one_before_.size() != 0) step += by_one_before_ * from.one_before;
      if (step.isZero(0)) {
        if (from.last.isZero(0)) continue;
        append(ComplexVector::Zero(step.rows()), from.last);
        continue;
      }
      factors_.solve(step);
      append(step.col(0), by_one_before_.size() != 0 ? from.last : ComplexVector::Zero(step.rows()));
    }
    std::vector<ComplexVector> fresh;
    std::swap(fresh, fresh_);
    return fresh;
  }

 private:
  struct Pair {
    ComplexVector last;
    ComplexVector one_before;
  };

  static void add(const ComplexSparseMatrix& matrix, const Complex& factor, ComplexSparseMatrix& sum) {
    if (matrix.size() != 0) sum = ComplexSparseMatrix(sum + factor * matrix);
  }

  /// Below zero where the stiffness is singular, as that of what is free to move.
  bool factor(double eta_high) {
    constexpr double part = 0.1;
    const double shift = std::pow(part * two_pi * eta_high, 2);
    ComplexVector any(stiffness_.rows());
    for (Index i = 0; i < any.size(); ++i) any(i) = std::polar(1.0, static_cast<double>(i * i));
    ComplexMatrix motion = mass_ * any;
    if (factors_.factor(stiffness_)) {
      const double force = motion.col(0).norm();
      factors_.solve(motion);
      const double stiffest = stiffness_.coeffs().abs().maxCoeff();
      if (motion.allFinite() && motion.col(0).norm() * stiffest * 1e-13 < force) return true;
    }
    return factors_.factor(stiffness_ + shift * mass_);
  }

  void append(ComplexVector last, ComplexVector one_before) {
    const double before = norm(mass_, last);
    for (int pass = 0; pass < 2; ++pass) {
      for (const Pair& pair : vectors_) {
        const Complex share = pair.last.dot(mass_ * last);
        last -= share * pair.last;
        one_before -= share * pair.one_before;
      }
    }
    const double after = norm(mass_, last);
    if (after > lost * before && after > 0) {
      vectors_.push_back({last / after, one_before / after});
      fresh_.push_back(vectors_.back().last);
      return;
    }
    const double size = norm(mass_, one_before);
    if (size > 0) vectors_.push_back({ComplexVector::Zero(last.size()), one_before / size});
  }

  const ComplexSparseMatrix& mass_;
  ComplexSparseMatrix stiffness_;
  ComplexSparseMatrix by_last_;
  ComplexSparseMatrix by_one_before_;
  Cholesky<Complex> factors_;
  std::deque<Pair> vectors_;
  std::vector<ComplexVector> fresh_;
  std::size_t done_ = 0;
  std::size_t width_ = 0;
};

TurningSpace::TurningSpace(const ExtendedSector& sector, const SectorReduction& reduction,
                           const ModesRequest& request)
    : reduction_(reduction), basis_(reduction.size(), 0) {
  ComplexMatrix forces(reduction_.size(), sector.contacts() + 1);
  for (Index i = 0; i < sector.contacts(); ++i) forces.col(i) = sector.contact_force(i).cast<Complex>();
  forces.rightCols<1>() = reduction_.load();
  for (const Rotation& rotation : request.rotations) {
    if (!rotation.is_none())
      sequences_.push_back(std::make_unique<Sequence>(reduction_, forces, rotation, request.eta_high));
  }
}

TurningSpace::~TurningSpace() = default;

ComplexMatrix TurningSpace::take(const ComplexMatrix& vectors) {
  const ComplexSparseMatrix& mass = reduction_.mass();
  const Index first = basis_.cols();
  for (Index i = 0; i < vectors.cols(); ++i) {
    ComplexVector v = vectors.col(i);
    const double before = norm(mass, v);
    for (int pass = 0; pass < 2; ++pass) v -= basis_ * (basis_.adjoint() * (mass * v).eval()).eval();
    const double after = norm(mass, v);
    if (!(after > lost * before)) continue;
    v /= after;
    v -= basis_ * (basis_.adjoint() * (mass * v).eval()).eval();
    basis_.conservativeResize(Eigen::NoChange, basis_.cols() + 1);
    basis_.rightCols<1>() = v / norm(mass, v);
  }
  return basis_.rightCols(basis_.cols() - first);
}

ComplexMatrix TurningSpace::next() {
  const Index first = basis_.cols();
  for (const auto& sequence : sequences_) {
    for (const ComplexVector& vector : sequence->next()) take(vector);
  }
  return basis_.rightCols(basis_.cols() - first);
}

}  // namespace arcslip
