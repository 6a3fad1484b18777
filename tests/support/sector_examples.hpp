#pragma once

// Sectors whose matrices are known in closed form.

#include <cmath>
#include <numbers>

#include "arcslip/sectors/finite_sector.hpp"
#include "arcslip/structure/chain_elements.hpp"

namespace arcslip::testing {

inline SparseMatrix sparse(const Matrix& matrix) { return matrix.sparseView(); }

/// e^{-ja} from one sector to the next.
inline Complex forward(Index wave_number, Index sectors) {
  return std::polar(1.0,
                    -2 * std::numbers::pi * static_cast<double>(wave_number) / static_cast<double>(sectors));
}

inline std::vector<Index> count_from(Index first, Index count) {
  std::vector<Index> dofs;
  for (Index i = 0; i < count; ++i) dofs.push_back(first + i);
  return dofs;
}

/// `count` elements in a row under the travelling load, each node's first dof a contact but for the last.
inline FiniteSector chain(const ChainElement& element, Index count, const Complex& forward) {
  const Index j = element.mass.rows() / 2;
  const Index n = (count + 1) * j;
  Matrix mass = Matrix::Zero(n, n);
  Matrix stiffness = Matrix::Zero(n, n);
  FiniteSector sector;
  sector.load = ComplexVector::Zero(n);
  Complex phase = 1;
  for (Index e = 0; e < count; ++e, phase *= forward) {
    mass.block(e * j, e * j, 2 * j, 2 * j) += element.mass.cast<double>();
    stiffness.block(e * j, e * j, 2 * j, 2 * j) += element.stiffness.cast<double>();
    for (Index d = 0; d < 2 * j; ++d) {
      sector.load(e * j + d) += phase * Complex(static_cast<double>(element.load(d).real()),
                                                static_cast<double>(element.load(d).imag()));
    }
    sector.contacts.push_back(e * j);
  }
  sector.mass = sparse(mass);
  sector.stiffness = sparse(stiffness);
  sector.left = count_from(0, j);
  sector.right = count_from(n - j, j);
  return sector;
}

/// Frequencies of the bladed disk below at 0 to 6 nodal diameters [pyHarm,
/// Tutorials/Tuto_006_LumpedBladedDisk.ipynb]: Hz, printed to 8 decimals.
inline constexpr double bladed_disk_frequencies[7][3] = {
    {88.26374399, 249.31165161, 619.34330474},   {169.34412950, 335.56537939, 619.82021678},
    {189.30185260, 555.31017863, 626.20258590},  {193.04962270, 615.15017797, 810.00679680},
    {194.33310084, 616.58502200, 1044.51877441}, {194.91823247, 616.96341859, 1264.68323410},
    {195.23065575, 617.12696788, 1464.72871426}};

/// Bladed disk of 24 sectors [pyHarm, Tutorials/Tuto_006_LumpedBladedDisk; parameters after Laxalde,
/// Thouverez, Sinou and Lombard, Eur. J. Mech. A/Solids 26 (2007) 676]: dofs disk, blade, tip and the next
/// sector's disk.
inline FiniteSector bladed_disk() {
  const double ground = 6e5;
  const double root = 1e6;
  const double blade = 2e6;
  const double next = 5e7;
  FiniteSector sector;
  Matrix mass = Matrix::Zero(4, 4);
  mass.diagonal() << 1.2, 0.35, 0.25, 0;
  Matrix stiffness(4, 4);
  stiffness << ground + root + next, -root, 0, -next,  //
      -root, root + blade, -blade, 0,                  //
      0, -blade, blade, 0,                             //
      -next, 0, 0, next;
  sector.mass = sparse(mass);
  sector.stiffness = sparse(stiffness);
  sector.left = {0};
  sector.right = {3};
  sector.contacts = {0};
  sector.outputs = {2, 3};
  sector.load = ComplexVector::Zero(4);
  sector.load(1) = 1;
  return sector;
}

/// A ring of one dof a sector.
inline FiniteSector lumped_ring() {
  FiniteSector sector;
  sector.mass = sparse(Matrix(Eigen::Vector2d(0.1, 0).asDiagonal()));
  Matrix stiffness(2, 2);
  stiffness << 4e5, -4e5, -4e5, 4e5;
  sector.stiffness = sparse(stiffness);
  sector.left = {0};
  sector.right = {1};
  sector.contacts = {0};
  sector.load = ComplexVector::Zero(2);
  return sector;
}

}  // namespace arcslip::testing
