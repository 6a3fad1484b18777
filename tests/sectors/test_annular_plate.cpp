#include "arcslip/sectors/annular_plate.hpp"

#include "annular_plate_modes.hpp"
#include "arcslip/dense.hpp"
#include "arcslip/sectors/matrix_market.hpp"
#include "arcslip/sectors/sector_reduction.hpp"
#include "catch.hpp"
#include "sector_examples.hpp"
#include "sector_frequencies.hpp"

using namespace arcslip;
using testing::exact_wave_number;
using testing::forward;

namespace {

/// Clamped inside, free outside [code_aster, V2.03.004, case SDLS04].
AnnularPlate disk(Index sectors, Index radial_elements, Index angular_elements) {
  return {.inner_radius = 0.1,
          .outer_radius = 0.2,
          .thickness = 1e-3,
          .youngs_modulus = 2e11,
          .poisson_ratio = 0.3,
          .density = 7800,
          .inner_edge = EdgeSupport::clamped,
          .outer_edge = EdgeSupport::free,
          .sectors = sectors,
          .radial_elements = radial_elements,
          .angular_elements = angular_elements};
}

/// w R_e^2 sqrt(rho h/D) of one of the modes with these nodal diameters.
double frequency(const AnnularPlate& plate, Index diameters, Index mode = 0) {
  const double square =
      testing::squared_frequencies(annular_plate_sector(plate), diameters, plate.sectors)(mode);
  const double bending = plate.youngs_modulus * std::pow(plate.thickness, 3) /
                         (12 * (1 - plate.poisson_ratio * plate.poisson_ratio));
  return std::sqrt(square * plate.density * plate.thickness / bending) * std::pow(plate.outer_radius, 2);
}

/// The Bessel solution beside a frequency that is known to 5 %.
double exact(const AnnularPlate& plate, int diameters, double about) {
  const double k = std::sqrt(about);
  return std::pow(exact_wave_number(plate, diameters, k * 0.97, k * 1.03), 2);
}

/// Bessel solution of the clamped and free disk, digits as published with a check [SDLS04, recomputed].
constexpr double published_plate[] = {13.024257, 13.289781, 14.703812, 18.561989};

/// Calls `add` with radii of a plate and what of r dr is theirs, by Gauss's rule of two points on 400 pieces.
template <class Add>
void over_radius(const AnnularPlate& plate, const Add& add) {
  constexpr int pieces = 400;
  const double length = plate.outer_radius - plate.inner_radius;
  for (int i = 0; i < pieces; ++i) {
    for (const double s : {-1 / std::sqrt(3.0), 1 / std::sqrt(3.0)}) {
      const double r = plate.inner_radius + length * (i + 0.5 + 0.5 * s) / pieces;
      add(r, 0.5 * length / pieces * r);
    }
  }
}

/// A plate stretched by its rotation at one radian: u, a sum of polynomials that its clamped edges hold, by
/// least energy, int E/(1 - nu^2) (u_r^2 + 2 nu u_r u/r + u^2/r^2)/2 - rho r u.
class Stretched {
 public:
  explicit Stretched(const AnnularPlate& plate) : plate_(plate) {
    const double nu = plate.poisson_ratio;
    Eigen::Matrix<double, count, count> energy = Eigen::Matrix<double, count, count>::Zero();
    Terms load = Terms::Zero();
    over_radius(plate, [&](double r, double area) {
      const auto [value, slope] = terms(r);
      energy += area * (slope * slope.transpose() + value * value.transpose() / (r * r) +
                        nu / r * (slope * value.transpose() + value * slope.transpose()));
      load += area * (1 - nu * nu) * plate.density * r * value;  // over E
    });
    motion_ = solution_of(Matrix(energy), Vector(load));
  }

  /// Along the radius and round it.
  std::pair<double, double> stresses(double r) const {
    const double nu = plate_.poisson_ratio;
    const auto [value, slope] = terms(r);
    const double stretch = slope.dot(motion_) / (1 - nu * nu);
    const double round = value.dot(motion_) / r / (1 - nu * nu);
    return {stretch + nu * round, round + nu * stretch};
  }

 private:
  static constexpr int count = 12;
  using Terms = Eigen::Matrix<double, count, 1>;

  /// The polynomials and their slopes.
  std::pair<Terms, Terms> terms(double r) const {
    const double length = plate_.outer_radius - plate_.inner_radius;
    const bool inner = plate_.inner_edge == EdgeSupport::clamped;
    const bool outer = plate_.outer_edge == EdgeSupport::clamped;
    const double x = (2 * r - plate_.inner_radius - plate_.outer_radius) / length;
    const double p = inner ? 1 + x : 1;
    const double q = outer ? 1 - x : 1;
    const double slope = (inner ? q : 0) - (outer ? p : 0);
    std::pair<Terms, Terms> found;
    for (int k = 0; k < count; ++k) {
      const double power = std::pow(x, k);
      found.first(k) = p * q * power;
      found.second(k) = (slope * power + (k > 0 ? p * q * k * std::pow(x, k - 1) : 0)) * 2 / length;
    }
    return found;
  }

  AnnularPlate plate_;
  Terms motion_;
};

}  // namespace

TEST_CASE("The plate clamped inside and free outside has the published frequencies") {
  for (int n = 0; n <= 3; ++n) {
    CHECK_THAT(exact(disk(18, 1, 1), n, published_plate[n]), WithinAbs(published_plate[n], 5e-7));
    // Through 10 degrees (n angle)^4/1440 is the error of a beam under such a wave, 5e-5 at most.
    CHECK_THAT(frequency(disk(18, 8, 2), n), WithinRel(published_plate[n], 5e-5));
  }
}

TEST_CASE("Frequencies of the plate converge as the fourth power of the element's length, from above") {
  struct Example {
    EdgeSupport inner;
    EdgeSupport outer;
    int diameters;
  };
  const Example example = GENERATE(values<Example>({{EdgeSupport::clamped, EdgeSupport::free, 0},
                                                    {EdgeSupport::clamped, EdgeSupport::free, 3},
                                                    {EdgeSupport::free, EdgeSupport::free, 2},
                                                    {EdgeSupport::supported, EdgeSupport::free, 2},
                                                    {EdgeSupport::free, EdgeSupport::supported, 1},
                                                    {EdgeSupport::supported, EdgeSupport::clamped, 1}}));
  const auto plate = [&](Index elements) {
    AnnularPlate result = disk(9, elements, elements);
    result.inner_edge = example.inner;
    result.outer_edge = example.outer;
    return result;
  };
  const double coarse = frequency(plate(3), example.diameters);
  const double fine = frequency(plate(6), example.diameters);
  const double limit = exact(plate(1), example.diameters, fine);
  CAPTURE(example.diameters, coarse, fine, limit);
  CHECK(fine > limit);
  CHECK_THAT(std::log2((coarse - limit) / (fine - limit)), WithinAbs(4, 0.5));  // not yet asymptotic
}

TEST_CASE("A free plate with a small hole has the frequencies of the full one but for the hole") {
  // w R^2 sqrt(rho h/D) of the full plate, nu = 0.33 [Leissa 1969, recomputed], modes (n, circles). The hole
  // has a hundredth of the radius and lowers them by about (b/R)^2.
  struct Example {
    int diameters;
    int circles;
    double full;
  };
  const Example example = GENERATE(values<Example>({{2, 0, 5.262037},
                                                    {0, 1, 9.068899},
                                                    {3, 0, 12.243894},
                                                    {1, 1, 20.513087},
                                                    {4, 0, 21.527217},
                                                    {2, 1, 35.242521}}));
  AnnularPlate plate = disk(16, 12, 4);
  plate.inner_radius = 0.01 * plate.outer_radius;
  plate.poisson_ratio = 0.33;
  plate.inner_edge = EdgeSupport::free;
  const double holed = exact(plate, example.diameters, example.full);
  CHECK_THAT(holed, WithinRel(example.full, 5e-4));
  const Index mode = example.circles;  // where n < 2 the motion without circles is rigid
  // Elements of equal length, wider than the hole, show little of what it does to the plate.
  CHECK_THAT(frequency(plate, example.diameters, mode), WithinRel(holed, 1.5e-4));
}

TEST_CASE("The same mesh cut into other sectors has the same frequencies, through Matrix Market too") {
  const double expected = frequency(disk(24, 2, 1), 2);
  CHECK_THAT(frequency(disk(6, 2, 4), 2), WithinRel(expected, 1e-10));
  const FiniteSector sector = annular_plate_sector(disk(24, 2, 1));
  const SparseMatrix again =
      read_matrix_market(write_matrix_market(sector.stiffness, MatrixSymmetry::symmetric), "stiffness.mtx");
  CHECK((again - sector.stiffness).norm() == 0);
}

TEST_CASE("A free plate resists no rigid motion: w = 1, and w = r cos theta but for the elements' error") {
  AnnularPlate plate = disk(12, 3, 1);
  plate.inner_edge = EdgeSupport::free;
  SectorReduction reduction(annular_plate_sector(plate));
  ComplexVector lift = ComplexVector::Zero(reduction.size());
  ComplexVector tilt = lift;
  for (Index i = 0; i < 4; ++i) {
    const double r = 0.1 + 0.1 * static_cast<double>(i) / 3;
    lift(4 * i) = 1;
    tilt.segment<4>(4 * i) << r, 1, Complex(0, -r), Complex(0, -1);  // r e^{-j theta} at theta = 0
  }
  const double size = ComplexMatrix(reduction.stiffness()).diagonal().norm();
  CHECK((reduction.stiffness() * lift).norm() < 1e-12 * size);
  // Of the energy of a cubic interpolant of e^{-j theta} angle^4/720 is error, angle = 30 degrees.
  reduction.set_forward(forward(1, 12));
  const Vector diagonal = ComplexMatrix(reduction.stiffness()).diagonal().real();
  const double energy = tilt.dot(reduction.stiffness() * tilt).real();
  CHECK(energy < std::pow(std::numbers::pi / 6, 4) / 720 * tilt.cwiseAbs2().dot(diagonal));
}

TEST_CASE("A free disk that turns has the frequencies of Lamb and Southwell's membrane") {
  // (w/Omega)^2 = ((n + 2 s)(n + 2 s + 2)(3 + nu) - n^2 (1 + 3 nu))/8 of n diameters and s circles, without a
  // hole.
  AnnularPlate plate = disk(16, 12, 4);
  plate.inner_radius = 0.01 * plate.outer_radius;
  plate.inner_edge = EdgeSupport::free;
  plate.turns = true;
  FiniteSector sector = annular_plate_sector(plate);
  sector.stiffness = sector.stiffness_speed2;
  const double nu = plate.poisson_ratio;
  struct Example {
    int n, circles;
  };
  for (const auto& [n, circles] :
       {Example{0, 1}, Example{1, 0}, Example{1, 1}, Example{2, 0}, Example{3, 0}}) {
    const double m = n + 2 * circles;
    const double expected = (m * (m + 2) * (3 + nu) - n * n * (1 + 3 * nu)) / 8;
    CAPTURE(n, circles);
    CHECK_THAT(testing::squared_frequencies(sector, n, 16)(circles), WithinRel(expected, 1e-3));
  }
}

TEST_CASE("A free plate that turns and leans stays where it is in space, whatever its hole") {
  AnnularPlate plate = disk(12, 3, 2);
  plate.inner_edge = EdgeSupport::free;
  plate.turns = true;
  FiniteSector sector = annular_plate_sector(plate);
  CHECK(sector.gyroscopic.size() == 0);
  const double omega = 2000;
  sector.stiffness += omega * omega * sector.stiffness_speed2;
  // Of the plate's own stiffness the elements' error in r cos theta is left.
  CHECK_THAT(std::sqrt(testing::squared_frequencies(sector, 1, 12)(0)), WithinRel(omega, 1e-4));
}

TEST_CASE("The stresses of a plate that turns are those of least energy, with each support of its edges") {
  AnnularPlate plate = disk(90, 2, 1);
  plate.inner_edge = GENERATE(EdgeSupport::clamped, EdgeSupport::supported);
  plate.outer_edge = GENERATE(EdgeSupport::free, EdgeSupport::clamped);
  plate.turns = true;
  // Their work on a wave of n = 3 that rises to 1 halfway and falls again, a cubic on each half.
  const int n = 3;
  const Stretched stretched(plate);
  double work = 0;
  over_radius(plate, [&](double r, double area) {
    const auto [radial, hoop] = stretched.stresses(r);
    const double half = 0.5 * (plate.outer_radius - plate.inner_radius);
    const double s = std::min(r - plate.inner_radius, plate.outer_radius - r) / half;
    const double w = s * s * (3 - 2 * s);
    const double w_r = 6 * s * (1 - s) / half;
    work += area * plate.thickness * (radial * w_r * w_r + hoop * n * n * w * w / (r * r));
  });
  FiniteSector sector = annular_plate_sector(plate);
  sector.stiffness = sector.stiffness_speed2;
  SectorReduction reduction(sector);
  reduction.set_forward(forward(n, plate.sectors));
  ComplexVector wave = ComplexVector::Zero(reduction.size());
  const Index node = plate.inner_edge == EdgeSupport::clamped ? 0 : 2;  // a supported edge has slopes
  wave(node) = 1;
  wave(node + 2) = Complex(0, -n);
  // (n angle)^4/720 is the error of the cubics round a sector.
  CHECK_THAT(wave.dot(reduction.stiffness() * wave).real(),
             WithinRel(two_pi / static_cast<double>(plate.sectors) * work, 1e-5));
}

TEST_CASE("Supports of a plate hold the dofs of their edge and no others") {
  AnnularPlate plate = disk(12, 3, 2);
  const FiniteSector sector = annular_plate_sector(plate);
  CHECK(sector.mass.rows() == 3 * 3 * 4);
  CHECK(sector.contacts == std::vector<Index>{8, 20});  // w of the third node that moves, on two lines
  plate.inner_edge = EdgeSupport::supported;
  CHECK(annular_plate_sector(plate).mass.rows() == 3 * (3 * 4 + 2));
  plate.outer_edge = EdgeSupport::clamped;
  CHECK(annular_plate_sector(plate).mass.rows() == 3 * (2 * 4 + 2));
  CHECK(annular_plate_sector(plate).contacts.empty());
  plate.inner_radius = 0;
  CHECK_THROWS_AS(annular_plate_sector(plate), std::invalid_argument);
}
