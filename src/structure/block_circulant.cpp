#include "arcslip/structure/block_circulant.hpp"

#include "arcslip/dense.hpp"

namespace arcslip {
namespace {

bool is_block_circulant(const ComplexMatrix& a, Index blocks) {
  if (blocks < 2 || a.rows() % blocks != 0) return false;
  const Index size = a.rows() / blocks;
  const Index rest = a.rows() - size;
  for (Index column = size; column < a.cols(); ++column) {
    const auto here = a.col(column);
    const auto before = a.col(column - size);
    if (here.tail(rest) != before.head(rest) || here.head(size) != before.tail(size)) return false;
  }
  return true;
}

}  // namespace

ComplexMatrix wave_turns(Index blocks) {
  ComplexVector one(blocks);
  for (Index q = 0; q < blocks; ++q) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(q) / static_cast<double>(blocks);
    one(q) = Complex(std::cos(angle), -std::sin(angle));
  }
  return ComplexMatrix::NullaryExpr(blocks, blocks, [&](Index m, Index i) { return one(m * i % blocks); });
}

bool invert_block_circulant(ComplexMatrix& a, Index blocks) {
  if (!is_block_circulant(a, blocks)) return false;
  const Index size = a.rows() / blocks;
  const ComplexMatrix turns = wave_turns(blocks);
  ComplexMatrix entries(size * size, blocks);  // of a block in each column
  for (Index i = 0; i < blocks; ++i)
    Eigen::Map<ComplexMatrix>(entries.col(i).data(), size, size) = a.block(i * size, 0, size, size);
  ComplexMatrix waves = entries * turns.conjugate();
  for (Index m = 0; m < blocks; ++m) {
    Eigen::Map<ComplexMatrix> wave(waves.col(m).data(), size, size);
    wave = solution_of(ComplexMatrix(wave), ComplexMatrix(ComplexMatrix::Identity(size, size)));
  }
  entries.noalias() = waves * (turns / static_cast<double>(blocks));
  for (Index j = 0; j < blocks; ++j) {
    for (Index i = 0; i < blocks; ++i) {
      a.block(i * size, j * size, size, size) =
          Eigen::Map<const ComplexMatrix>(entries.col((i - j + blocks) % blocks).data(), size, size);
    }
  }
  return true;
}

}  // namespace arcslip
