#include "harmonic_jacobian.hpp"

#include <algorithm>

#include "arcslip/structure/block_circulant.hpp"
#include "harmonic_preconditioner.hpp"

namespace arcslip::problems {
namespace {

Complex pair_at(const Vector& x, Index place) { return {x(place), x(place + 1)}; }

}  // namespace

HarmonicJacobian::HarmonicJacobian(Index harmonics, std::vector<Index> sectors)
    : harmonics_(harmonics), sectors_(std::move(sectors)), stuck_(static_cast<std::size_t>(harmonics)) {
  weight_.setOnes(2 * harmonics_ * count());
  column_.setZero(weight_.size());
  row_.setZero(weight_.size());
  members_.resize(static_cast<std::size_t>(*std::max_element(sectors_.begin(), sectors_.end()) + 1));
  for (Index i = 0; i < count(); ++i)
    members_[static_cast<std::size_t>(sectors_[static_cast<std::size_t>(i)])].push_back(i);
}

void HarmonicJacobian::set_order(Index order, const ContactMatrix& inverse, double weight) {
  ContactMatrix& stuck = stuck_[static_cast<std::size_t>(order)];
  stuck = -inverse;
  stuck.diagonal().array() += 1.0;
  for (Index i = 0; i < count(); ++i) weight_.segment<2>(place(i, order)).setConstant(weight);
}

void HarmonicJacobian::clear_elements() {
  blocks_.clear();
  active_.clear();
}

Matrix& HarmonicJacobian::add_element(Index first, Index coordinates) {
  const Index size = 2 * harmonics_ * coordinates;
  for (Index i = 0; i < size; ++i) active_.push_back(place(first, 0) + i);
  return blocks_.emplace_back(Block{first, coordinates, Matrix::Zero(size, size)}).change;
}

void HarmonicJacobian::set_size(const Vector& residual, const Vector& u) {
  column_ = residual;
  row_ = u / u.squaredNorm();
}

void HarmonicJacobian::couple(const Vector& x, Vector& out) const {
  out.setZero(x.size());
  ContactVector sum(count());
  Vector changes = Vector::Zero(x.size());
  ContactVector of_order(count());
  const bool is_dense = 2 * std::ssize(active_) > x.size();
  for (const Block& block : blocks_) {
    const Index at = place(block.first, 0);
    changes.segment(at, block.change.rows()).noalias() = block.change * x.segment(at, block.change.cols());
  }
  for (Index a = 0; a < harmonics_; ++a) {
    const ContactMatrix& stuck = stuck_[static_cast<std::size_t>(a)];
    if (is_dense) {
      for (Index i = 0; i < count(); ++i) of_order(i) = pair_at(changes, place(i, a));
      sum.noalias() = stuck * of_order;
    } else {
      sum.setZero();
    }
    for (const Block& block : blocks_) {
      for (Index j = block.first; !is_dense && j < block.first + block.coordinates; ++j) {
        sum += pair_at(changes, place(j, a)) * stuck.col(j);
      }
    }
    for (Index i = 0; i < count(); ++i) {
      out(place(i, a)) = sum(i).real();
      out(place(i, a) + 1) = sum(i).imag();
    }
  }
}

void HarmonicJacobian::couple_transposed(const Vector& x, Vector& out) const {
  out.setZero(x.size());
  Vector back(x.size());
  ContactVector of_order(count());
  for (Index a = 0; a < harmonics_; ++a) {
    const ContactMatrix& stuck = stuck_[static_cast<std::size_t>(a)];
    for (Index i = 0; i < count(); ++i) of_order(i) = pair_at(x, place(i, a));
    for (const Block& block : blocks_) {
      for (Index j = block.first; j < block.first + block.coordinates; ++j) {
        const Complex sum = stuck.col(j).dot(of_order);
        back(place(j, a)) = sum.real();
        back(place(j, a) + 1) = sum.imag();
      }
    }
  }
  for (const Block& block : blocks_) {
    const Index at = place(block.first, 0);
    out.segment(at, block.change.cols()).noalias() =
        block.change.transpose() * back.segment(at, block.change.rows());
  }
}

void HarmonicJacobian::couple_absolute(const Vector& x, Vector& out) const {
  out.setZero(x.size());
  Vector sum(count());
  for (Index a = 0; a < harmonics_; ++a) {
    sum.setZero();
    for (const Block& block : blocks_) {
      const auto own = x.segment(place(block.first, 0), block.change.cols()).cwiseAbs();
      for (Index j = 0; j < block.coordinates; ++j) {
        const Index row = 2 * (j * harmonics_ + a);
        const double change = (block.change.middleRows<2>(row).cwiseAbs() * own).sum();
        sum += change * stuck_[static_cast<std::size_t>(a)].col(block.first + j).cwiseAbs();
      }
    }
    for (Index i = 0; i < count(); ++i) out.segment<2>(place(i, a)).setConstant(sum(i));
  }
}

/// s(m) of each harmonic, of the mean of all sectors.
std::vector<ComplexMatrix> HarmonicJacobian::waves() const {
  const Index n = std::ssize(members_);
  const Index each = std::ssize(members_.front());
  const ComplexMatrix turns = wave_turns(n);
  std::vector<ComplexMatrix> all;
  for (const ContactMatrix& stuck : stuck_) {
    ComplexMatrix lags = ComplexMatrix::Zero(each * each, n);
    for (Index from = 0; from < n; ++from) {
      for (Index to = 0; to < n; ++to) {
        const auto& rows = members_[static_cast<std::size_t>(to)];
        const auto& columns = members_[static_cast<std::size_t>(from)];
        for (Index j = 0; j < each; ++j) {
          for (Index i = 0; i < each; ++i)
            lags(j * each + i, (to - from + n) % n) +=
                stuck(rows[static_cast<std::size_t>(i)], columns[static_cast<std::size_t>(j)]) /
                static_cast<double>(n);
        }
      }
    }
    const ComplexMatrix of_waves = lags * turns.conjugate();
    all.emplace_back(Eigen::Map<const ComplexMatrix>(of_waves.data(), each, each * n));
  }
  return all;
}

std::unique_ptr<continuation::Preconditioner> HarmonicJacobian::precondition() const {
  for (const auto& members : members_) {
    if (members.size() != members_.front().size()) return nullptr;
  }
  std::vector<Index> position(sectors_.size());  // in its sector
  for (const auto& members : members_) {
    for (std::size_t k = 0; k < members.size(); ++k)
      position[static_cast<std::size_t>(members[k])] = static_cast<Index>(k);
  }
  std::vector<HarmonicPreconditioner::Place> places;
  std::vector<Index> sizes(members_.size(), 0);
  for (const Index unknown : active_) {
    const Index coordinate = unknown / 2 / harmonics_;
    const Index sector = sectors_[static_cast<std::size_t>(coordinate)];
    places.push_back(
        {sector, position[static_cast<std::size_t>(coordinate)], unknown / 2 % harmonics_, unknown % 2});
    ++sizes[static_cast<std::size_t>(sector)];
  }
  std::vector<Matrix> changes;
  for (const Index size : sizes) changes.push_back(Matrix::Zero(size, size));
  std::vector<Index> filled(members_.size(), 0);
  for (const Block& block : blocks_) {
    const auto sector = static_cast<std::size_t>(sectors_[static_cast<std::size_t>(block.first)]);
    const Index size = block.change.rows();
    changes[sector].block(filled[sector], filled[sector], size, size) = block.change;
    filled[sector] += size;
  }
  return std::make_unique<HarmonicPreconditioner>(std::ssize(members_), waves(), std::move(places), changes);
}

/// Block by block, in the order of `active`.
void HarmonicJacobian::fill(Matrix& k) const {
  Index column = 0;
  for (const Block& from : blocks_) {
    const Index size = from.change.cols();
    Index row = 0;
    for (const Block& to : blocks_) {
      auto own = k.block(row, column, to.change.rows(), size);
      own.setZero();
      for (Index i = 0; i < to.coordinates; ++i) {
        for (Index j = 0; j < from.coordinates; ++j) {
          for (Index a = 0; a < harmonics_; ++a) {
            const Complex s = stuck_[static_cast<std::size_t>(a)](to.first + i, from.first + j);
            const auto real = from.change.row(2 * (j * harmonics_ + a));
            const auto imaginary = from.change.row(2 * (j * harmonics_ + a) + 1);
            own.row(2 * (i * harmonics_ + a)) += s.real() * real - s.imag() * imaginary;
            own.row(2 * (i * harmonics_ + a) + 1) += s.imag() * real + s.real() * imaginary;
          }
        }
      }
      row += to.change.rows();
    }
    column += size;
  }
}

}  // namespace arcslip::problems
