#include "arcslip/sectors/dynamic_stiffness.hpp"

#include "arcslip/dense.hpp"
#include "arcslip/structure/sector.hpp"

namespace arcslip {
namespace {

template <class Precise>
auto rounded(const Precise& values) {
  return values.unaryExpr([](const PreciseComplex& z) {
    return Complex(static_cast<double>(z.real()), static_cast<double>(z.imag()));
  });
}

}  // namespace

ComplexMatrix DynamicStiffness::at(double eta) const {
  const double w = two_pi * eta;
  return stiffness + Complex(0, w) * damping - w * w * mass;
}

ComplexVector DynamicStiffness::solve(double eta, const ComplexVector& force) const {
  return solution_of(at(eta), force);
}

ContactResponse DynamicStiffness::contact_response(double eta, Index contact_dof) const {
  const ComplexMatrix z = at(eta);
  const ComplexMatrix z_eta = Complex(0, two_pi) * damping - 2 * two_pi * two_pi * eta * mass;
  const ComplexVector e = ComplexVector::Unit(z.rows(), contact_dof);
  const ComplexVector left = solution_of(ComplexMatrix(z.transpose()), e);
  const auto solver = solver_of(z);
  const ComplexVector by_contact = solver(e);
  const ComplexVector by_load = solver(load);
  const auto along_left = [&](const ComplexVector& right) {
    return -(left.transpose() * z_eta * right).value();
  };
  return {by_contact(contact_dof), along_left(by_contact), by_load(contact_dof), along_left(by_load)};
}

DynamicStiffness dynamic_stiffness(const ReducedStructure& structure, double damping) {
  const ComplexMatrix stiffness = rounded(structure.stiffness);
  return {rounded(structure.mass), damping / two_pi * stiffness, stiffness, rounded(structure.load)};
}

}  // namespace arcslip
