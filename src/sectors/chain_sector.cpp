#include "arcslip/sectors/chain_sector.hpp"

namespace arcslip {
namespace {

/// That of `count` elements, `step` dofs from one to the next.
SparseMatrix of_chain(const Matrix& element, Index step, Index count) {
  std::vector<Eigen::Triplet<double>> entries;
  for (Index e = 0; e < count; ++e) {
    for (Index i = 0; i < element.rows(); ++i) {
      for (Index k = 0; k < element.rows(); ++k) {
        if (element(i, k) != 0)
          entries.emplace_back(static_cast<int>(e * step + i), static_cast<int>(e * step + k), element(i, k));
      }
    }
  }
  const Index size = (count - 1) * step + element.rows();
  SparseMatrix matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace

FiniteSector chain_sector(const Matrix& mass, const Matrix& stiffness, Index node_dofs, Index count,
                          Index contact, const Matrix& gyroscopic, const Matrix& stiffness_speed2) {
  const Index step = mass.rows() - node_dofs;
  const Index size = count * step + node_dofs;
  FiniteSector sector;
  for (Index e = 0; e < count; ++e) sector.contacts.push_back(e * step + contact);
  sector.mass = of_chain(mass, step, count);
  sector.stiffness = of_chain(stiffness, step, count);
  if (gyroscopic.size() != 0) sector.gyroscopic = of_chain(gyroscopic, step, count);
  if (stiffness_speed2.size() != 0) sector.stiffness_speed2 = of_chain(stiffness_speed2, step, count);
  for (Index dof = 0; dof < node_dofs; ++dof) {
    sector.left.push_back(dof);
    sector.right.push_back(size - node_dofs + dof);
  }
  sector.outputs = sector.contacts;
  sector.load = ComplexVector::Zero(size);
  return checked(sector);
}

FiniteSector chain_sector(const ChainElement& element, Index wave_number, Index elements, Index count) {
  const Index node_dofs = element.mass.rows() / 2;
  FiniteSector sector =
      chain_sector(element.mass.cast<double>(), element.stiffness.cast<double>(), node_dofs, count, 0);
  const auto a = static_cast<double>(propagation_constant(wave_number, elements));
  for (Index e = 0; e < count; ++e) {
    const Complex phase = std::polar(1.0, -a * static_cast<double>(e));
    for (Index i = 0; i < 2 * node_dofs; ++i) {
      const PreciseComplex& force = element.load(i);
      sector.load(e * node_dofs + i) +=
          phase * Complex(static_cast<double>(force.real()), static_cast<double>(force.imag()));
    }
  }
  return sector;
}

}  // namespace arcslip
