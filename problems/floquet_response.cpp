#include "arcslip/problems/floquet_response.hpp"

namespace arcslip::problems {

FloquetResponse::FloquetResponse(const HarmonicSystem& system, const HarmonicSystem& even)
    : HarmonicResponse(system), odd_(system, system.orders), even_(even, system.orders) {}

bool FloquetResponse::eigenvalues(const Vector& u, const Vector& p, int regime, ComplexVector& values) const {
  std::vector<DisturbanceFlow::Contact> all;
  for (Index i = 0; i < contacts(); ++i)
    all.push_back({motion(u, i), slip_threshold(i, p), slips(regime, i)});
  const ComplexVector odd = odd_.exponents(p(eta), all);
  const ComplexVector even = even_.exponents(p(eta), all);
  values.resize(odd.size() + even.size());
  values << odd, even;
  return true;
}

std::vector<int> even_orders(const SystemParameters& parameters) {
  std::vector<int> orders;
  for (int h = 0; h <= parameters.harmonics.back() + 1; h += 2) orders.push_back(h);
  return orders;
}

HarmonicSystem build_even_system(const SystemParameters& parameters) {
  SystemParameters between = parameters;
  between.harmonics = even_orders(parameters);
  return build_harmonic_system(between);
}

}  // namespace arcslip::problems
