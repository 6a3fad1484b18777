#include "arcslip/sectors/lowest_frequency.hpp"

#include <cmath>

#include "arcslip/sectors/sector_modes.hpp"
#include "arcslip/sectors/sector_reduction.hpp"
#include "sectors/cholesky.hpp"

namespace arcslip {
namespace {

using Triplets = std::vector<Eigen::Triplet<double>>;

void append(const SparseMatrix& matrix, Index shift, Triplets& entries) {
  for (Index j = 0; j < matrix.outerSize(); ++j) {
    for (SparseMatrix::InnerIterator entry(matrix, j); entry; ++entry) {
      entries.emplace_back(static_cast<int>(shift + entry.row()), static_cast<int>(shift + j), entry.value());
    }
  }
}

void append(const std::vector<Index>& dofs, Index shift, std::vector<Index>& all) {
  for (const Index dof : dofs) all.push_back(shift + dof);
}

SparseMatrix sparse(const Triplets& entries, Index size) {
  SparseMatrix matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace

double lowest_frequency(const FiniteSector& sector, Index wave_number, Index sectors) {
  constexpr int most = 500;
  SectorReduction reduction(sector);
  reduction.set_forward(SectorWave{wave_number, sectors}.forward());
  // Of what a double leaves of the largest w^2 nothing below this is more than rounding.
  double shift = 1e-15 * largest_square(reduction);
  Cholesky<Complex> factors(reduction.stiffness());
  while (!factors.factor(reduction.stiffness() + shift * reduction.mass())) {
    shift *= 10;
    if (!(shift < largest_square(reduction)))
      throw SectorError("the stiffness matrix is not positive semidefinite under this wave");
  }
  ComplexVector x(reduction.size());
  for (Index i = 0; i < x.size(); ++i) x(i) = std::polar(1.0, static_cast<double>(i * i));  // no symmetry
  double square = 0;
  for (int i = 0; i < most; ++i) {
    const ComplexVector force = reduction.mass() * x;
    ComplexMatrix solved = force;
    factors.solve(solved);
    const ComplexVector next = solved.col(0);
    const double previous = square;
    // x^H M next/next^H M next is Rayleigh's quotient of next, without the cancellation of K.
    square = next.dot(force).real() / next.dot(reduction.mass() * next).real();
    x = next / next.norm();
    if (std::abs(square - previous) <= 1e-10 * square) break;
  }
  return square <= 2 * shift ? 0 : std::sqrt(square - shift) / (two_pi);
}

FiniteSector joined(const FiniteSector& base, const FiniteSector& damper, double contact_stiffness) {
  const Index shift = base.mass.rows();
  const Index size = shift + damper.mass.rows();
  Triplets mass;
  Triplets stiffness;
  append(base.mass, 0, mass);
  append(damper.mass, shift, mass);
  append(base.stiffness, 0, stiffness);
  append(damper.stiffness, shift, stiffness);
  for (std::size_t i = 0; i < base.contacts.size(); ++i) {
    const auto a = static_cast<int>(base.contacts[i]);
    const auto b = static_cast<int>(shift + damper.contacts[i]);
    stiffness.emplace_back(a, a, contact_stiffness);
    stiffness.emplace_back(b, b, contact_stiffness);
    stiffness.emplace_back(a, b, -contact_stiffness);
    stiffness.emplace_back(b, a, -contact_stiffness);
  }
  FiniteSector sector;
  sector.mass = sparse(mass, size);
  sector.stiffness = sparse(stiffness, size);
  sector.load = ComplexVector::Zero(size);
  sector.left = base.left;
  sector.right = base.right;
  append(damper.left, shift, sector.left);
  append(damper.right, shift, sector.right);
  return checked(sector);
}

}  // namespace arcslip
