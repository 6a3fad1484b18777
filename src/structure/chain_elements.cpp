#include "arcslip/structure/chain_elements.hpp"

#include <array>
#include <boost/math/constants/constants.hpp>
#include <limits>

namespace arcslip {
namespace {

PreciseReal precise_pi() { return boost::math::constants::pi<PreciseReal>(); }

}  // namespace

PreciseReal propagation_constant(Index wave_number, Index elements) {
  return 2 * precise_pi() * wave_number / elements;
}

PreciseComplex travelling_moment(int power, const PreciseReal& a) {
  const PreciseReal smallest = std::numeric_limits<PreciseReal>::epsilon();
  std::array<PreciseReal, 2> parts{0, 0};  // real and imaginary
  PreciseReal size = 1;                    // a^k/k!
  for (int k = 0; size > smallest || k < a; ++k) {
    const bool is_positive = k % 4 == 0 || k % 4 == 3;  // (-j)^k = 1, -j, -1, j
    PreciseReal& part = parts.at(static_cast<std::size_t>(k % 2));
    part += (is_positive ? size : PreciseReal(-size)) / (k + power + 1);
    size *= a;
    size /= k + 1;
  }
  return {parts[0], parts[1]};
}

ChainElement rod_element(double mass_ratio, double stiffness_ratio, Index wave_number, Index elements) {
  const PreciseReal length = PreciseReal(1) / elements;
  const PreciseReal a = propagation_constant(wave_number, elements);
  const PreciseComplex s0 = travelling_moment(0, a);
  const PreciseComplex s1 = travelling_moment(1, a);

  ChainElement element;
  element.mass.resize(2, 2);
  element.mass << 2, 1, 1, 2;
  element.mass *= mass_ratio * length / 6;
  element.stiffness.resize(2, 2);
  element.stiffness << 1, -1, -1, 1;
  element.stiffness *= stiffness_ratio / length;
  element.load.resize(2);
  element.load << s0 - s1, s1;  // phi = 1 - s, s
  element.load *= PreciseComplex(length);
  return element;
}

ChainElement beam_element(double mass_ratio, double stiffness_ratio, Index wave_number, Index elements) {
  const PreciseReal l = PreciseReal(1) / elements;
  const PreciseReal a = propagation_constant(wave_number, elements);
  const PreciseComplex s0 = travelling_moment(0, a);
  const PreciseComplex s1 = travelling_moment(1, a);
  const PreciseComplex s2 = travelling_moment(2, a);
  const PreciseComplex s3 = travelling_moment(3, a);

  ChainElement element;
  element.mass.resize(4, 4);
  element.mass << 156, 22 * l, 54, -13 * l,                            //
      22 * l, 4 * l * l, 13 * l, -3 * l * l,                           //
      54, 13 * l, 156, -22 * l,                                        //
      -13 * l, -3 * l * l, -22 * l, 4 * l * l;                         //
  element.mass *= precise_pi() * precise_pi() * mass_ratio * l / 105;  // (2 pi)^2/420 of the consistent beam
  element.stiffness.resize(4, 4);
  element.stiffness << 12, 6 * l, -12, 6 * l,  //
      6 * l, 4 * l * l, -6 * l, 2 * l * l,     //
      -12, -6 * l, 12, -6 * l,                 //
      6 * l, 2 * l * l, -6 * l, 4 * l * l;     //
  element.stiffness *= stiffness_ratio / (l * l * l);
  const PreciseComplex length = l;
  const PreciseComplex two = 2;
  const PreciseComplex three = 3;
  element.load.resize(4);
  element.load << s0 - three * s2 + two * s3,  // 1 - 3 s^2 + 2 s^3
      length * (s1 - two * s2 + s3),           // L_e (s - 2 s^2 + s^3)
      three * s2 - two * s3,                   // 3 s^2 - 2 s^3
      length * (s3 - s2);                      // L_e (s^3 - s^2)
  element.load *= length;
  return element;
}

}  // namespace arcslip
