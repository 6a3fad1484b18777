#include "harmonic_preconditioner.hpp"

#include <algorithm>
#include <cmath>

#include "arcslip/dense.hpp"
#include "arcslip/structure/block_circulant.hpp"

namespace arcslip::problems {
namespace {

/// Of Re and Im each by itself, entry by entry.
ComplexMatrix median(const ComplexMatrix& blocks, Index size) {
  const Index count = blocks.cols() / size;
  ComplexMatrix middle(size, size);
  std::vector<double> values(static_cast<std::size_t>(count));
  const auto of = [&](Index i, Index j, auto part) {
    for (Index m = 0; m < count; ++m) values[static_cast<std::size_t>(m)] = part(blocks(i, m * size + j));
    const auto half = values.begin() + count / 2;
    std::nth_element(values.begin(), half, values.end());
    return *half;
  };
  for (Index j = 0; j < size; ++j) {
    for (Index i = 0; i < size; ++i)
      middle(i, j) = {of(i, j, [](Complex z) { return z.real(); }),
                      of(i, j, [](Complex z) { return z.imag(); })};
  }
  return middle;
}

/// A real matrix of pairs (Re, Im) as x -> l x + c conj(x).
struct Pair {
  Complex linear;
  Complex conjugate;
};
Pair pair_of(const Eigen::Matrix2d& a) {
  return {Complex(a(0, 0) + a(1, 1), a(1, 0) - a(0, 1)) / 2.0,
          Complex(a(0, 0) - a(1, 1), a(1, 0) + a(0, 1)) / 2.0};
}

}  // namespace

HarmonicPreconditioner::HarmonicPreconditioner(Index sectors, std::vector<ComplexMatrix> waves,
                                               std::vector<Place> places, const std::vector<Matrix>& changes)
    : count_(sectors),
      each_(waves.front().rows()),
      harmonics_(static_cast<Index>(waves.size())),
      places_(std::move(places)),
      sectors_(static_cast<std::size_t>(sectors)),
      phases_(wave_turns(sectors) / std::sqrt(static_cast<double>(sectors))) {
  std::vector<ComplexMatrix> common;
  keep(waves, common);
  set_sectors(changes, common);
  if (!kept_.empty()) set_between();
}

/// The strongest parts, as many as make the matrix between them half as large as that of the active unknowns.
void HarmonicPreconditioner::keep(const std::vector<ComplexMatrix>& waves,
                                  std::vector<ComplexMatrix>& common) {
  constexpr double weak = 0.2;  // beside 1
  for (Index a = 0; a < harmonics_; ++a) {
    const ComplexMatrix& all = waves[static_cast<std::size_t>(a)];
    common.push_back(median(all, each_));
    for (Index m = 0; m < count_; ++m) {
      const ComplexMatrix rest = all.middleCols(m * each_, each_) - common.back();
      const SingularAxes<ComplexMatrix> parts = singular_axes(rest);
      for (Index k = 0; k < each_; ++k) {
        const double size = parts.sizes(k);
        if (size > weak) kept_.push_back({m, a, size, parts.directions.col(k), parts.from.col(k)});
      }
    }
  }
  const std::size_t most = places_.size() / 4;
  if (kept_.size() <= most) return;
  const auto end = kept_.begin() + static_cast<std::ptrdiff_t>(most);
  std::nth_element(kept_.begin(), end, kept_.end(),
                   [](const Kept& a, const Kept& b) { return a.size > b.size; });
  kept_.erase(end, kept_.end());
}

void HarmonicPreconditioner::set_sectors(const std::vector<Matrix>& changes,
                                         const std::vector<ComplexMatrix>& common) {
  for (std::size_t i = 0; i < places_.size(); ++i)
    sectors_[static_cast<std::size_t>(places_[i].sector)].places.push_back(static_cast<Index>(i));
  for (std::size_t s = 0; s < sectors_.size(); ++s) {
    Sector& sector = sectors_[s];
    const Index size = std::ssize(sector.places);
    sector.change = changes[s];
    Matrix acts = Matrix::Zero(size, size);  // L between the unknowns
    for (Index j = 0; j < size; ++j) {
      const Place& from = places_[static_cast<std::size_t>(sector.places[static_cast<std::size_t>(j)])];
      for (Index i = 0; i < size; ++i) {
        const Place& to = places_[static_cast<std::size_t>(sector.places[static_cast<std::size_t>(i)])];
        if (from.order != to.order) continue;
        const Complex value = common[static_cast<std::size_t>(to.order)](to.coordinate, from.coordinate);
        const Complex moved = from.part == 0 ? value : value * Complex(0, 1);
        acts(i, j) = to.part == 0 ? moved.real() : moved.imag();
      }
    }
    if (size > 0) sector.local = factored(Matrix::Identity(size, size) + acts * sector.change);
  }
}

/// A matrix's factors, whose determinant's sign is taken.
HarmonicPreconditioner::Factors HarmonicPreconditioner::factored(const Matrix& matrix) {
  auto factors = std::make_unique<continuation::DenseBorderedSolver>(matrix.rows(), 0);
  factors->set_jacobian(matrix, Vector::Ones(matrix.rows()));
  sign_ *= factors->factor();
  return factors;
}

std::vector<ComplexMatrix> HarmonicPreconditioner::blank() const {
  return {static_cast<std::size_t>(harmonics_), ComplexMatrix::Zero(each_, count_)};
}

void HarmonicPreconditioner::take(const Sector& sector, Index index, const Vector& values,
                                  std::vector<ComplexMatrix>& motions) const {
  for (Index i = 0; i < values.size(); ++i) {
    const Place& at = places_[static_cast<std::size_t>(sector.places[static_cast<std::size_t>(i)])];
    motions[static_cast<std::size_t>(at.order)](at.coordinate, index) +=
        at.part == 0 ? Complex(values(i), 0) : Complex(0, values(i));
  }
}

Vector HarmonicPreconditioner::give(const Sector& sector, Index index,
                                    const std::vector<ComplexMatrix>& motions) const {
  Vector values(std::ssize(sector.places));
  for (Index i = 0; i < values.size(); ++i) {
    const Place& at = places_[static_cast<std::size_t>(sector.places[static_cast<std::size_t>(i)])];
    const Complex motion = motions[static_cast<std::size_t>(at.order)](at.coordinate, index);
    values(i) = at.part == 0 ? motion.real() : motion.imag();
  }
  return values;
}

/// Sigma V^H of motions of all sectors, or U^H, by Re and Im.
Vector HarmonicPreconditioner::project(const std::vector<ComplexMatrix>& motions, bool left) const {
  std::vector<ComplexMatrix> waves;
  for (const ComplexMatrix& of_order : motions) waves.push_back(of_order * phases_.conjugate());
  Vector amounts(2 * std::ssize(kept_));
  for (std::size_t t = 0; t < kept_.size(); ++t) {
    const Kept& one = kept_[t];
    const auto wave = waves[static_cast<std::size_t>(one.order)].col(one.wave);
    const Complex amount = left ? one.left.dot(wave) : one.size * one.right.dot(wave);
    amounts.segment<2>(2 * static_cast<Index>(t)) << amount.real(), amount.imag();
  }
  return amounts;
}

/// U times amounts, or V Sigma.
std::vector<ComplexMatrix> HarmonicPreconditioner::combine(const Vector& amounts, bool left) const {
  std::vector<ComplexMatrix> waves = blank();
  for (std::size_t t = 0; t < kept_.size(); ++t) {
    const Kept& one = kept_[t];
    const Complex amount(amounts(2 * static_cast<Index>(t)), amounts(2 * static_cast<Index>(t) + 1));
    auto wave = waves[static_cast<std::size_t>(one.order)].col(one.wave);
    if (left) {
      wave += amount * one.left;
    } else {
      wave += amount * one.size * one.right;
    }
  }
  for (ComplexMatrix& of_order : waves) of_order = of_order * phases_.transpose();
  return waves;
}

/// W, from what E B^{-1} does to a wave: it couples m' to m by the part of it that goes round m - m' times,
/// and to m + m' by the part that turns motions into their conjugates.
void HarmonicPreconditioner::set_between() {
  const Index size = each_ * harmonics_;
  ComplexMatrix linear = ComplexMatrix::Zero(size * size, count_);  // a column for each sector
  ComplexMatrix conjugate = linear;
  const auto row_of = [&](const Place& at) { return at.order * each_ + at.coordinate; };
  for (Index s = 0; s < count_; ++s) {
    const Sector& sector = sectors_[static_cast<std::size_t>(s)];
    if (sector.places.empty()) continue;
    Matrix through(sector.change.rows(), sector.change.cols());  // E B^{-1}
    for (Index i = 0; i < through.rows(); ++i) {
      Vector row = sector.change.row(i).transpose();
      sector.local->solve_transposed(row);
      through.row(i) = row.transpose();
    }
    for (Index j = 0; j < through.cols(); j += 2) {  // pairs of Re and Im follow one another
      const Place& from = places_[static_cast<std::size_t>(sector.places[static_cast<std::size_t>(j)])];
      for (Index i = 0; i < through.rows(); i += 2) {
        const Place& to = places_[static_cast<std::size_t>(sector.places[static_cast<std::size_t>(i)])];
        const Pair pair = pair_of(through.block<2, 2>(i, j));
        linear(row_of(from) * size + row_of(to), s) = pair.linear;
        conjugate(row_of(from) * size + row_of(to), s) = pair.conjugate;
      }
    }
  }
  const double part = 1 / std::sqrt(static_cast<double>(count_));
  const ComplexMatrix by_waves = part * (linear * phases_.conjugate());  // sum_s g_s e^{j a_q s}/N
  const ComplexMatrix back_by_waves = part * (conjugate * phases_.conjugate());
  const Index kept = std::ssize(kept_);
  Matrix between = Matrix::Identity(2 * kept, 2 * kept);
  for (Index k = 0; k < kept; ++k) {
    const Kept& from = kept_[static_cast<std::size_t>(k)];
    for (Index t = 0; t < kept; ++t) {
      const Kept& to = kept_[static_cast<std::size_t>(t)];
      const Index start = from.order * each_ * size + to.order * each_;
      const auto product = [&](const ComplexMatrix& all, Index wave, const ComplexVector& right) {
        const Eigen::Map<const ComplexMatrix, 0, Eigen::OuterStride<>> block(
            all.col(wave).data() + start, each_, each_, Eigen::OuterStride<>(size));
        Complex sum = 0;
        for (Index j = 0; j < each_; ++j) sum += to.right.dot(block.col(j)) * right(j);
        return to.size * sum;
      };
      const Complex l = product(by_waves, (to.wave - from.wave + count_) % count_, from.left);
      const Complex c = product(back_by_waves, (to.wave + from.wave) % count_, from.left.conjugate());
      between(2 * t, 2 * k) += l.real() + c.real();
      between(2 * t + 1, 2 * k) += l.imag() + c.imag();
      between(2 * t, 2 * k + 1) += -l.imag() + c.imag();
      between(2 * t + 1, 2 * k + 1) += l.real() - c.real();
    }
  }
  between_ = factored(between);
}

void HarmonicPreconditioner::multiply_determinant(continuation::LogProduct& product) const {
  for (const Sector& sector : sectors_) {
    if (sector.local != nullptr) sector.local->multiply_determinant(product);
  }
  if (between_ != nullptr) between_->multiply_determinant(product);
}

/// x -> B^{-1} (x - U W^{-1} Sigma V^H E B^{-1} x), or the same transposed.
void HarmonicPreconditioner::solve(Vector& x, bool transposed) {
  const auto solve_by = [&](const Factors& factors, Vector& right) {
    transposed ? factors->solve_transposed(right) : factors->solve(right);
  };
  std::vector<ComplexMatrix> motions = blank();
  std::vector<Vector> own(sectors_.size());
  for (std::size_t s = 0; s < sectors_.size(); ++s) {
    const Sector& sector = sectors_[s];
    if (sector.places.empty()) continue;
    own[s] = x(sector.places);
    solve_by(sector.local, own[s]);
    take(sector, static_cast<Index>(s), transposed ? own[s] : Vector(sector.change * own[s]), motions);
  }
  std::vector<ComplexMatrix> moved;
  if (between_ != nullptr) {
    Vector amounts = project(motions, transposed);
    solve_by(between_, amounts);
    moved = combine(amounts, !transposed);
  }
  for (std::size_t s = 0; s < sectors_.size(); ++s) {
    const Sector& sector = sectors_[s];
    if (sector.places.empty()) continue;
    if (between_ != nullptr) {
      Vector back = give(sector, static_cast<Index>(s), moved);
      if (transposed) back = Vector(sector.change.transpose() * back);
      solve_by(sector.local, back);
      own[s] -= back;
    }
    x(sector.places) = own[s];
  }
}

}  // namespace arcslip::problems
