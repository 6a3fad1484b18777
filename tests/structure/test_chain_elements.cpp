#include <boost/math/constants/constants.hpp>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <numbers>

#include "arcslip/assembly/reduced_pair.hpp"
#include "arcslip/structure/chain_elements.hpp"
#include "arcslip/structure/sector.hpp"
#include "catch.hpp"

using namespace arcslip;

namespace {

double real(const PreciseComplex& z) { return static_cast<double>(z.real()); }
double imag(const PreciseComplex& z) { return static_cast<double>(z.imag()); }
double pi_squared() { return std::numbers::pi * std::numbers::pi; }

/// int_0^1 e^{-jas} phi(s) ds by quadrature.
template <class Shape>
Complex travelling_integral(double a, Shape shape) {
  using boost::math::quadrature::gauss_kronrod;
  const auto integrate = [](auto f) { return gauss_kronrod<double, 61>::integrate(f, 0.0, 1.0, 5, 1e-15); };
  return {integrate([&](double s) { return std::cos(a * s) * shape(s); }),
          integrate([&](double s) { return -std::sin(a * s) * shape(s); })};
}

}  // namespace

TEST_CASE("Moments of the travelling wave agree with their closed form where that does not cancel") {
  for (const double a : {0.7, 2.0, 3.1}) {
    const PreciseComplex zeroth = travelling_moment(0, PreciseReal(a));
    CHECK_THAT(real(zeroth), WithinAbs(std::sin(a) / a, 1e-15));
    CHECK_THAT(imag(zeroth), WithinAbs((std::cos(a) - 1) / a, 1e-15));
    const PreciseComplex first = travelling_moment(1, PreciseReal(a));
    CHECK_THAT(real(first), WithinAbs((std::cos(a) + a * std::sin(a) - 1) / (a * a), 1e-15));
    CHECK_THAT(imag(first), WithinAbs(-(std::sin(a) - a * std::cos(a)) / (a * a), 1e-15));
  }
  for (int power = 0; power < 4; ++power) CHECK(real(travelling_moment(power, 0)) == 1.0 / (power + 1));
}

TEST_CASE("Rods of any N reduce to the scalars (22)-(24) of the paper") {
  // Tolerance: a few roundings of the closed forms themselves.
  const auto [n, elements] =
      GENERATE(table<Index, Index>({{1, 4}, {1, 30}, {3, 7}, {2, 1000}, {1, 1000000}}));
  SystemParameters parameters;
  parameters.model = StructureModel::rods;
  parameters.wave_number = n;
  parameters.elements = elements;
  parameters.mass_ratio = 5;
  parameters.frequency_ratio = 4;
  parameters.force = 2;
  const double stiffness_ratio = 80;
  const auto count = static_cast<double>(elements);
  const double half = std::numbers::pi * static_cast<double>(n) / count;
  const double sine = std::sin(half);
  const ReducedPair pair = reduce(parameters);

  const double mass = 5 / (6 * count) * (2 + 4 * std::cos(half) * std::cos(half));
  CHECK_THAT(real(pair.base.mass(0, 0)), WithinRel(mass, 1e-15));
  CHECK_THAT(real(pair.base.stiffness(0, 0)), WithinRel(4 * stiffness_ratio * count * sine * sine, 1e-15));
  const auto nn = static_cast<double>(n * n);
  CHECK_THAT(real(pair.base.load(0)),
             WithinRel(2 * stiffness_ratio * count / (pi_squared() * nn) * sine * sine, 1e-15));
  CHECK_THAT(imag(pair.base.load(0)), WithinAbs(0, 1e-15 * real(pair.base.load(0))));
  CHECK_THAT(real(pair.damper.mass(0, 0)), WithinRel(mass / 5, 1e-15));                      // (25)
  CHECK_THAT(real(pair.damper.stiffness(0, 0)), WithinRel(4 * count * sine * sine, 1e-15));  // (25)
}

TEST_CASE("The element loads are the integrals of the shape functions under the wave") {
  const Index elements = GENERATE(3, 30, 500);
  const double length = 1.0 / static_cast<double>(elements);
  const double a = 2 * std::numbers::pi * length;
  const auto check = [&](const PreciseComplex& load, Complex integral, double scale) {
    CHECK_THAT(real(load), WithinAbs(scale * integral.real(), 1e-14 * scale));
    CHECK_THAT(imag(load), WithinAbs(scale * integral.imag(), 1e-14 * scale));
  };
  const PreciseComplexVector rod = rod_element(1, 1, 1, elements).load;
  check(rod(0), travelling_integral(a, [](double s) { return 1 - s; }), length);
  check(rod(1), travelling_integral(a, [](double s) { return s; }), length);
  const PreciseComplexVector beam = beam_element(1, 1, 1, elements).load;
  check(beam(0), travelling_integral(a, [](double s) { return 1 - 3 * s * s + 2 * s * s * s; }), length);
  check(beam(1), travelling_integral(a, [](double s) { return s - 2 * s * s + s * s * s; }), length * length);
  check(beam(2), travelling_integral(a, [](double s) { return 3 * s * s - 2 * s * s * s; }), length);
  check(beam(3), travelling_integral(a, [](double s) { return s * s * s - s * s; }), length * length);
}

TEST_CASE("Element matrices are symmetric, carry the right mass and let rigid motions pass without force") {
  const PreciseReal quarter = PreciseReal(1) / 4;
  const ChainElement rod = rod_element(3, 2, 1, 4);
  const ChainElement beam = beam_element(3, 2, 1, 4);
  CHECK(rod.stiffness.isApprox(rod.stiffness.transpose()));
  CHECK(beam.stiffness.isApprox(beam.stiffness.transpose()));
  CHECK(beam.mass.isApprox(beam.mass.transpose()));
  CHECK_THAT(static_cast<double>(rod.mass.sum()), WithinRel(3 / 4.0, 1e-15));
  PreciseMatrix shift(4, 1);
  shift << 1, 0, 1, 0;
  PreciseMatrix turn(4, 1);
  turn << 0, 1, quarter, 1;
  const double beam_mass = static_cast<double>((shift.transpose() * beam.mass * shift).value());
  CHECK_THAT(beam_mass, WithinRel(4 * pi_squared() * 3 / 4.0, 1e-15));  // (2 pi)^2 M* L_e
  CHECK(static_cast<double>((beam.stiffness * shift).norm()) < 1e-40);
  CHECK(static_cast<double>((beam.stiffness * turn).norm()) < 1e-40);
}
