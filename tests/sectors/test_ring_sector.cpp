#include "arcslip/time/ring_sector.hpp"

#include "arcslip/sectors/chain_sector.hpp"
#include "catch.hpp"
#include "sector_examples.hpp"
#include "sector_frequencies.hpp"

using namespace arcslip;
using testing::squared_frequencies;

namespace {

/// Free ring [code_aster, V2.03.109, case SDLS109].
SolidRing free_ring(RingDirection contact, Index elements) {
  return {.radius = 0.369,
          .width = 0.05,
          .height = 0.048,
          .youngs_modulus = 185e9,
          .poisson_ratio = 0.3,
          .density = 7800,
          .contact = contact,
          .sectors = 9,
          .elements = elements};
}

double lowest(const SolidRing& ring, Index n) {
  return std::sqrt(squared_frequencies(ring_sector(ring), n, ring.sectors)(0)) / (2 * pi);
}

/// Of the differential equations under u = cos n theta, v = sin n theta, and w, R p = cos n theta.
double exact(const SolidRing& ring, Index wave_number) {
  const auto n = static_cast<double>(wave_number);
  const double r = ring.radius;
  const double area = ring.width * ring.height;
  const double e = ring.youngs_modulus;
  const double in_plane = e * ring.width * std::pow(ring.height, 3) / 12;
  const double out_of_plane = e * ring.height * std::pow(ring.width, 3) / 12;
  const double torsion = e / (2 * (1 + ring.poisson_ratio)) * torsion_constant(ring.width, ring.height);
  Eigen::Matrix2d stiffness;
  Eigen::Matrix2d mass;
  if (ring.motion() == SolidRingMotion::in_plane) {
    const double alpha = in_plane / (e * area * r * r);
    stiffness << 1 + alpha * std::pow(n, 4), n + alpha * std::pow(n, 3),  //
        n + alpha * std::pow(n, 3), n * n * (1 + alpha);
    stiffness *= e * area / (r * r);
    mass = ring.density * area * Eigen::Matrix2d::Identity();
  } else {
    stiffness << out_of_plane * std::pow(n, 4) + torsion * n * n, n * n * (out_of_plane + torsion),  //
        n * n * (out_of_plane + torsion), out_of_plane + torsion * n * n;
    stiffness /= std::pow(r, 4);
    mass = ring.density * area * Eigen::Matrix2d::Identity();
    mass(1, 1) = ring.density * (in_plane + out_of_plane) / e / (r * r);
  }
  return std::sqrt(squared_frequencies(stiffness, mass)(0)) / (2 * pi);
}

}  // namespace

TEST_CASE("A thin free ring has the published frequencies in its plane") {
  // n (n^2 - 1)/(2 pi R^2) sqrt(E I/(m (n^2 + 1))) for a ring that does not stretch [SDLS109, recomputed].
  // At a hundredth of the height stretching changes a frequency, which falls with the height, by 3e-7.
  constexpr double published[] = {211.652218, 598.642875, 1147.845316};
  SolidRing thin = free_ring(RingDirection::radial, 4);
  thin.height *= 1e-2;
  for (Index n = 2; n <= 4; ++n) {
    const double expected = published[n - 2];
    // (n angle)^4/1440, with angles of 10 degrees, is the error of a straight beam with cubic shapes. That of
    // a ring, of which u + u_tt bends it and not u_tt alone, is a few times as large.
    const double error = 4 * std::pow(static_cast<double>(n) * pi / 18, 4) / 1440;
    CHECK_THAT(100 * lowest(thin, n), WithinRel(expected, error));
    // At its own height it stretches: alpha (2 n^2/(n^2 + 1))^2/2 off the frequency, alpha = h^2/(12 R^2).
    const double alpha = std::pow(0.048 / 0.369, 2) / 12;
    const double n2 = static_cast<double>(n * n);
    const double stretched = expected * (1 - alpha * std::pow(2 * n2 / (n2 + 1), 2) / 2);
    CHECK_THAT(lowest(free_ring(RingDirection::radial, 4), n),
               WithinRel(stretched, error + 4 * alpha * alpha * n2));
  }
}

TEST_CASE("Frequencies of the ring converge as the fourth power of the element's length, from above") {
  const RingDirection contact = GENERATE(RingDirection::tangential, RingDirection::axial);
  const Index n = GENERATE(2, 3, 4);
  const double thickness = GENERATE(1.0, 1e-2);  // slender rings do not lock
  const auto ring = [&](Index elements) {
    SolidRing result = free_ring(contact, elements);
    result.height *= thickness;
    result.width *= thickness;
    return result;
  };
  const double limit = exact(ring(1), n);
  const double coarse = lowest(ring(1), n) - limit;
  const double fine = lowest(ring(2), n) - limit;
  CAPTURE(limit, coarse, fine);
  CHECK(fine > 0);
  CHECK_THAT(std::log2(coarse / fine), WithinAbs(4, 0.5));  // not yet asymptotic
  CHECK_THAT(fine / limit, WithinAbs(0, 4 * std::pow(static_cast<double>(n) * pi / 9, 4) / 1440));
}

TEST_CASE("The torsion constant of a rectangle is that of the tables") {
  // J/(a^3 b) for b/a = 1, 2, 10 [Timoshenko and Goodier, article 109, table 7], and 1/3 of a strip.
  CHECK_THAT(torsion_constant(2, 2) / 16, WithinAbs(0.1406, 5e-5));
  CHECK_THAT(torsion_constant(4, 2) / 32, WithinAbs(0.229, 5e-4));
  CHECK_THAT(torsion_constant(2, 20) / 160, WithinAbs(0.312, 5e-4));
  CHECK_THAT(torsion_constant(1, 1000) / 1000, WithinRel((1 - 0.63025e-3) / 3, 1e-8));
}

TEST_CASE("The same ring cut into other sectors has the same frequencies, and moves freely as a body") {
  for (const RingDirection contact : {RingDirection::radial, RingDirection::axial}) {
    SolidRing ring = free_ring(contact, 2);
    const double expected = lowest(ring, 3);
    ring.sectors = 18;
    ring.elements = 1;
    CHECK_THAT(lowest(ring, 3), WithinRel(expected, 1e-10));
    // u = cos theta, v = -sin theta and w = R cos theta, p = -cos theta: (angle)^4/720 is the error of
    // cubics.
    CHECK(lowest(ring, 1) < std::pow(pi / 9, 2) / std::sqrt(720) * expected);
    CHECK(std::abs(squared_frequencies(ring_sector(ring), 0, 18)(0)) < 1e-8 * expected * expected);
  }
}

TEST_CASE("A ring's dofs, and what is out of range") {
  SolidRing ring = free_ring(RingDirection::tangential, 2);
  const FiniteSector sector = ring_sector(ring);
  CHECK(sector.mass.rows() == 15);
  CHECK(sector.contacts == std::vector<Index>{2, 8});
  CHECK(sector.right == std::vector<Index>{12, 13, 14});
  ring.contact = RingDirection::axial;
  CHECK(ring_sector(ring).contacts == std::vector<Index>{0, 6});
  ring.height = 0.8;
  CHECK_THROWS_AS(ring_sector(ring), std::invalid_argument);
}

TEST_CASE("Rods and beams of several elements are those of one, in one sector and in their load") {
  constexpr Index n = 2;
  constexpr Index count = 5;
  const bool rods = GENERATE(true, false);
  const ChainElement element = rods ? rod_element(5, 80, n, 30) : beam_element(5, 80, n, 30);
  const FiniteSector sector = chain_sector(element, n, 30, count);
  const FiniteSector expected = testing::chain(element, count, testing::forward(n, 30));
  CHECK((sector.mass - expected.mass).norm() == 0);
  CHECK((sector.stiffness - expected.stiffness).norm() == 0);
  CHECK((sector.load - expected.load).norm() < 1e-15 * expected.load.norm());
  CHECK(sector.contacts == expected.contacts);
  CHECK(sector.left == expected.left);
  CHECK(sector.right == expected.right);
}
