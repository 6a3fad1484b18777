#include "arcslip/sectors/chain_sector.hpp"

namespace arcslip {

FiniteSector chain_sector(const Matrix& mass, const Matrix& stiffness, Index node_dofs, Index count,
                          Index contact) {
  const Index step = mass.rows() - node_dofs;
  const Index size = count * step + node_dofs;
  using Triplets = std::vector<Eigen::Triplet<double>>;
  Triplets masses;
  Triplets stiffnesses;
  FiniteSector sector;
  for (Index e = 0; e < count; ++e) {
    for (Index i = 0; i < mass.rows(); ++i) {
      for (Index k = 0; k < mass.rows(); ++k) {
        const auto row = static_cast<int>(e * step + i);
        const auto column = static_cast<int>(e * step + k);
        if (mass(i, k) != 0) masses.emplace_back(row, column, mass(i, k));
        if (stiffness(i, k) != 0) stiffnesses.emplace_back(row, column, stiffness(i, k));
      }
    }
    sector.contacts.push_back(e * step + contact);
  }
  sector.mass.resize(size, size);
  sector.mass.setFromTriplets(masses.begin(), masses.end());
  sector.stiffness.resize(size, size);
  sector.stiffness.setFromTriplets(stiffnesses.begin(), stiffnesses.end());
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
