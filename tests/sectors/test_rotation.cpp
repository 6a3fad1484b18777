// Sectors that turn: against dense matrices, differences, and the thin ring in closed form.

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <memory>

#include "arcslip/dense.hpp"
#include "arcslip/sectors/sector_modes.hpp"
#include "arcslip/sectors/sector_solver.hpp"
#include "arcslip/time/ring_sector.hpp"
#include "catch.hpp"
#include "sectors/turning_modes.hpp"
#include "turning_sectors.hpp"

using namespace arcslip;
using namespace arcslip::testing;

namespace {

const double two_pi_ = 2 * std::numbers::pi;

/// A(a), dense.
ComplexMatrix reduced(const FiniteSector& sector, const SparseMatrix& matrix, const Complex& forward) {
  const SectorMap map = sector_map(sector);
  ComplexMatrix t = ComplexMatrix::Zero(matrix.rows(), map.size);
  for (Index dof = 0; dof < matrix.rows(); ++dof) {
    const auto i = static_cast<std::size_t>(dof);
    t(dof, map.reduced[i]) = map.is_right[i] ? forward : 1;
  }
  return t.adjoint() * Matrix(matrix) * t;
}

/// Z at eta and a speed, in revolutions.
ComplexMatrix dynamic_stiffness_of(const FiniteSector& sector, const Complex& forward, double eta,
                                   double speed, const Loss& loss = {}) {
  const double w = two_pi_ * eta;
  const double omega = two_pi_ * speed;
  const auto of = [&](const SparseMatrix& matrix) { return reduced(sector, matrix, forward); };
  return of(sector.stiffness) * Complex(1, loss.at(eta)) + omega * omega * of(sector.stiffness_speed2) +
         Complex(0, w * omega) * of(sector.gyroscopic) - w * w * of(sector.mass);
}

std::vector<double> frequencies_of(const FiniteSector& sector, const SectorWave& wave,
                                   const Rotation& rotation) {
  ModesRequest request{1e-3, 1e3, 1e-10, {}};
  request.rotations = {rotation};
  const SectorModes modes = sector_modes(sector, wave, request);
  std::vector<double> found;
  for (const ContactMode& mode : turning_modes(modes, 1, rotation).resonances())
    found.push_back(mode.frequency);
  return found;
}

double relative_norm(const ComplexMatrix& a, const ComplexMatrix& b) { return (a - b).norm() / b.norm(); }

}  // namespace

TEST_CASE("A sector that turns responds as its dense dynamic stiffness, in both directions of waves") {
  const FiniteSector sector = checked(turning_disk());
  const Loss loss{.structural = 0.01};
  for (const Index n : {-3, 0, 3, 12}) {
    const Complex step = forward(n, 24);
    SectorSolver solver(sector, step, loss);
    for (const double speed : {-20.0, 0.0, 35.0}) {
      for (const double eta : {60.0, 190.0}) {
        const ComplexMatrix inverse = dynamic_stiffness_of(sector, step, eta, speed, loss).inverse();
        const SectorResponse& response = solver.at(eta, speed);
        CAPTURE(n, speed, eta);
        CHECK(std::abs(response.compliance(0, 0) - inverse(0, 0)) < 1e-11 * std::abs(inverse(0, 0)));
        CHECK(std::abs(response.free(0) - inverse(0, 2)) < 1e-11 * inverse.col(2).norm());
        CHECK(std::abs(response.output_free(1) - inverse(5, 2)) < 1e-11 * inverse.col(2).norm());
      }
    }
  }
}

TEST_CASE(
    "The slopes of what turns, by frequency and speed, are those of differences, in both ways of solving") {
  const FiniteSector sector = checked(turning_disk());
  const SectorWave wave{3, 24};
  const Loss loss{.structural = 0.01};
  ModesRequest request{10, 1000, 1e-10, {}};
  request.rotations = {{35, 0}};
  const FullReceptance full(sector, wave, loss);
  const ModalSolves modal(std::make_shared<const SectorModes>(sector_modes(sector, wave, request)), 1, loss);
  const double eta = 187;
  for (const SectorSolves* solves :
       {static_cast<const SectorSolves*>(&full), static_cast<const SectorSolves*>(&modal)}) {
    for (const Rotation& rotation : {Rotation{35, 0}, Rotation{0, 0.2}, Rotation{-11, 0}}) {
      const auto at = [&](double by, double by_speed) {
        return solves->with_output(1, eta + by, 2, {rotation.fixed + by_speed, rotation.per_eta});
      };
      const VariedReceptance here = at(0, 0);
      const double h = 2e-3;
      const auto free_slope = [&](double by, double by_speed) {
        return ComplexVector((8 * (at(by, by_speed).free - at(-by, -by_speed).free) -
                              (at(2 * by, 2 * by_speed).free - at(-2 * by, -2 * by_speed).free)) /
                             (12 * h));
      };
      CAPTURE(rotation.fixed, rotation.per_eta);
      // Peaks are 1 wide: of the fourth order in h/1, and rounding over h.
      CHECK((free_slope(h, 0) - here.free_eta).norm() < 1e-8 * here.free_eta.norm());
      CHECK((free_slope(0, h) - here.free_rate).norm() < 1e-8 * here.free_rate.norm());
      const Complex by_force = (8.0 * (at(h, 0).compliance(1, 0) - at(-h, 0).compliance(1, 0)) -
                                (at(2 * h, 0).compliance(1, 0) - at(-2 * h, 0).compliance(1, 0))) /
                               (12 * h);
      CHECK(std::abs(by_force - here.compliance_eta(1, 0)) < 1e-8 * std::abs(by_force));
      const VariedReceptance driven = solves->with_driven_motion(eta, 2, rotation);
      const Complex lag = (solves->with_driven_motion(eta + h, 2, rotation).free(1) -
                           solves->with_driven_motion(eta - h, 2, rotation).free(1)) /
                          (2 * h);
      CHECK(std::abs(lag - driven.free_eta(1)) < 1e-4 * std::abs(lag));
    }
  }
}

TEST_CASE("Modes at rest that rotation couples give what the matrices give, damping of all kinds included") {
  const FiniteSector sector = checked(turning_disk());
  const SectorWave wave{-5, 24};
  for (const Loss& loss : {Loss{.structural = 0.02}, Loss{.viscous = 1e-4}, Loss{.mass = 0.3}}) {
    ModesRequest request{10, 1000, 1e-10, {}};
    request.loss = loss;
    request.rotations = {{20, 0}, {0, 0.25}};
    const auto modes = std::make_shared<const SectorModes>(sector_modes(sector, wave, request));
    CHECK(modes->error < 1e-9);
    const ModalSolves modal(modes, 1, loss);
    const FullReceptance full(sector, wave, loss);
    for (const double eta : {50.0, 185.0, 333.0}) {
      const VariedReceptance found = modal.with_output(0, eta, 1, {20, 0});
      const VariedReceptance expected = full.with_output(0, eta, 1, {20, 0});
      CHECK(relative_norm(found.free, expected.free) < 1e-10);
      CHECK(relative_norm(found.free_eta, expected.free_eta) < 1e-9);
      CHECK(relative_norm(found.free_rate, expected.free_rate) < 1e-9);
      const ContactVector force = ContactVector::Constant(1, Complex(0.3, 0.1));
      const CycleWork a = modal.work(eta, 1, force, {20, 0});
      const CycleWork b = full.work(eta, 1, force, {20, 0});
      CHECK_THAT(a.load, WithinRel(b.load, 1e-9));
      CHECK_THAT(a.damping, WithinRel(b.damping, 1e-9));
    }
  }
}

TEST_CASE(
    "Of a structure that turns the modes are those of its dense dynamic stiffness, at a speed and on a "
    "line") {
  const FiniteSector sector = checked(turning_disk());
  const auto rotation = GENERATE(Rotation{30, 0}, Rotation{-30, 0}, Rotation{0, 0.5}, Rotation{0, 1.0 / 7});
  const Index n = GENERATE(2, -2, 12);
  const Complex step = forward(n, 24);
  const SectorWave wave{n, 24};
  ModesRequest request{1, 3000, 1e-10, {}};
  request.rotations = {rotation};
  const TurningModes turning = turning_modes(sector_modes(sector, wave, request), 1, rotation);
  int checked_modes = 0;
  for (const ContactMode& mode : turning.resonances()) {
    const double eta = mode.frequency;
    const ComplexMatrix z = dynamic_stiffness_of(sector, step, eta, rotation.at(eta));
    const Vector sizes = singular_axes(z).sizes;
    CAPTURE(n, rotation.fixed, rotation.per_eta, eta);
    // The least singular value over the largest, of which rounding leaves 1e-16 times some 10.
    CHECK(sizes.minCoeff() < 1e-13 * sizes.maxCoeff());
    ++checked_modes;
  }
  CHECK(checked_modes >= (rotation.per_eta > 0.2 ? 1 : 6));  // the highest order meets all of them
  // The sum over all of them, of frequencies below zero and above, is the undamped response.
  for (const double eta : {43.0, 251.0}) {
    const ComplexMatrix inverse = dynamic_stiffness_of(sector, step, eta, rotation.at(eta)).inverse();
    Complex sum = 0;
    Complex load = 0;
    for (const TurningModes::Mode& mode : turning.modes) {
      const double d = 1 - mode.inverse * std::pow(eta, turning.power);
      sum += mode.shape(0) * std::conj(mode.shape(0)) / d;
      load += mode.shape(0) * mode.load / d;
    }
    CHECK(std::abs(sum - inverse(0, 0)) < 1e-9 * std::abs(inverse(0, 0)));
    CHECK(std::abs(load - inverse(0, 2)) < 1e-9 * inverse.col(2).norm());
  }
}

TEST_CASE("A thin ring that turns splits waves as its rotation carries them, whatever its tension") {
  // Over the speed, in radians as the frequencies: 4 n/(n^2 + 1), the rest the stretch of the ring (h/R)^2.
  struct Known {
    double thickness;
    Index n;
    double split, product;
  };
  const auto known = GENERATE(values<Known>({{0.02, 2, 1.600154, 0.8003},
                                             {0.02, 3, 1.200462, 5.401},
                                             {0.005, 2, 1.600010, 0.8},
                                             {0.005, 3, 1.200029, 5.4}}));
  const FiniteSector sector = checked(polygon_ring(192, known.thickness));
  const auto lowest = [&](Index n, double omega) {
    return two_pi_ * frequencies_of(sector, {n, 192}, {omega / two_pi_, 0}).front();
  };
  const auto n = static_cast<double>(known.n);
  CAPTURE(known.thickness, known.n);
  const double at_rest = lowest(known.n, 0);
  CHECK_THAT(at_rest, WithinRel(n * (n * n - 1) / std::sqrt(n * n + 1), 1e-3));
  for (const double omega : {0.2, 0.5}) {
    const double with = lowest(known.n, omega);
    const double against = lowest(-known.n, omega);
    CHECK(with < against);
    CHECK_THAT((against - with) / omega, WithinAbs(known.split, 1e-5));  // of (h/R)^2 omega^2
    CHECK_THAT((against - with) / omega, WithinRel(4 * n / (n * n + 1), 1e-3));
    CHECK_THAT((against * with - at_rest * at_rest) / (omega * omega), WithinAbs(known.product, 2.5e-3));
    CHECK_THAT(lowest(known.n, -omega), WithinRel(against, 1e-10));  // the other way round
    // Softening alone, without the tension that holds the ring, leaves the split as it is.
    FiniteSector loose = sector;
    loose.stiffness_speed2 = -loose.mass;
    const auto bare = [&](Index m) {
      return two_pi_ * frequencies_of(loose, {m, 192}, {omega / two_pi_, 0}).front();
    };
    CHECK_THAT((bare(-known.n) - bare(known.n)) / omega, WithinAbs(known.split, 1e-4));
  }
}

TEST_CASE("On the line of an engine order a wave resonates where its frequency at that speed is m times it") {
  const FiniteSector sector = checked(polygon_ring(24, 0.1));
  for (const Index m : {3, 21}) {
    const Index n = m == 3 ? -3 : 3;  // of 24 sectors: 21 = 24 - 3
    const Rotation line{0, 1 / static_cast<double>(m)};
    for (const double eta : frequencies_of(sector, {n, 24}, line)) {
      if (eta > 5) continue;
      const std::vector<double> there = frequencies_of(sector, {n, 24}, {eta / static_cast<double>(m), 0});
      const auto nearest = std::min_element(there.begin(), there.end(), [&](double a, double b) {
        return std::abs(a - eta) < std::abs(b - eta);
      });
      CAPTURE(m, eta);
      CHECK_THAT(*nearest, WithinRel(eta, 1e-9));
    }
  }
}

TEST_CASE("Large sectors keep as many modes as their response at all speeds needs") {
  // A polygon of 40 elements a sector, 120 dofs, more than all are kept of.
  const Index count = 40;
  const Index sectors = 6;
  const FiniteSector one = polygon_ring(count * sectors, 0.05);
  const Index size = 3 * (count + 1);
  FiniteSector sector;
  const auto assembled = [&](const SparseMatrix& matrix) {
    Matrix all = Matrix::Zero(size, size);
    for (Index e = 0; e < count; ++e) all.block(3 * e, 3 * e, 6, 6) += Matrix(matrix);
    return sparse(all);
  };
  sector.mass = assembled(one.mass);
  sector.stiffness = assembled(one.stiffness);
  sector.gyroscopic = assembled(one.gyroscopic);
  sector.stiffness_speed2 = assembled(one.stiffness_speed2);
  sector.left = {0, 1, 2};
  sector.right = {size - 3, size - 2, size - 1};
  sector.contacts = {90};
  sector.outputs = {31};
  sector.load = ComplexVector::Unit(size, 40);
  const FiniteSector whole = checked(sector);
  ModesRequest request{0.5, 20, 1e-10, {}};
  request.loss = {.structural = 2e-3};
  request.tolerance = 1e-8;
  request.rotations = GENERATE(std::vector<Rotation>{{0.3, 0}}, std::vector<Rotation>{{0, 0.1}},
                               std::vector<Rotation>{{-0.2, 0}, {0.1, 0}, {0.4, 0}});
  const SectorModes modes = sector_modes(whole, {2, sectors}, request);
  CHECK(std::ssize(modes.frequencies) < 115);
  CHECK(modes.error < 1e-6);  // of full solves in double, whose matrices' entries cancel to 1e-9
  SectorSolver solver(whole, forward(2, sectors), request.loss);
  // At speeds between those that were asked for, too.
  for (const double speed : {0.05, 0.17}) {
    const double at = request.rotations.size() > 1 ? speed : request.rotations[0].at(3.3);
    const SectorMotions found = modal_motions(modes, 1, request.loss, 3.3, at);
    const SectorResponse& expected = solver.at(3.3, at);
    CHECK(std::abs(found.compliance(0, 0) - expected.compliance(0, 0)) <
          1e-6 * std::abs(expected.compliance(0, 0)));
    CHECK(std::abs(found.output_free(0) - expected.output_free(0)) <
          1e-6 * std::abs(expected.output_free(0)));
  }
}

TEST_CASE("Rotation's matrices are checked: skew, symmetric, of the sector's size") {
  const auto refusal_of = [](const FiniteSector& sector) -> std::string {
    try {
      static_cast<void>(checked(sector));
    } catch (const SectorError& error) {
      return error.what();
    }
    return "";
  };
  FiniteSector sector = turning_disk();
  CHECK(refusal_of(sector).empty());
  sector.gyroscopic.coeffRef(0, 1) *= 1 + 1e-7;
  CHECK_THAT(refusal_of(sector), ContainsSubstring("the gyroscopic matrix is not skew-symmetric"));
  sector = turning_disk();
  sector.gyroscopic.coeffRef(0, 1) *= 1 + 1e-9;
  sector.gyroscopic.coeffRef(0, 0) = 1e-12;  // rounding of what writes it
  const FiniteSector mean = checked(sector);
  CHECK((Matrix(mean.gyroscopic) + Matrix(mean.gyroscopic).transpose()).norm() == 0);
  sector = turning_disk();
  sector.stiffness_speed2.coeffRef(3, 5) *= 1.01;
  CHECK_THAT(refusal_of(sector), ContainsSubstring("the stiffness_speed2 matrix is not symmetric"));
  sector = turning_disk();
  sector.gyroscopic = SparseMatrix(3, 3);
  CHECK_THAT(refusal_of(sector), ContainsSubstring("the gyroscopic matrix has 3 rows"));
}

TEST_CASE("A stiffness that rotation takes away has no modes, and says at which speed") {
  const FiniteSector sector = checked(turning_disk());
  ModesRequest request{1, 1000, 1e-10, {}};
  request.rotations = {{20, 0}};
  const SectorModes modes = sector_modes(sector, {3, 24}, request);
  CHECK_THROWS_WITH(turning_modes(modes, 1, {1e4, 0}),
                    ContainsSubstring("not positive definite at a speed of 10000"));
}

TEST_CASE("Built-in rings in their plane split as they turn, by hardly more than slender ones") {
  SolidRing ring{.radius = 0.2,
                 .width = 0.01,
                 .height = 0.002,
                 .youngs_modulus = 2e11,
                 .poisson_ratio = 0.3,
                 .density = 7800,
                 .contact = RingDirection::radial,
                 .sectors = 12,
                 .elements = 6,
                 .turns = true};
  const FiniteSector sector = ring_sector(ring);
  for (const Index n : {2, 3, 4}) {
    const auto m = static_cast<double>(n);
    const double speed = 2;
    const auto lowest = [&](Index wave, double at) {
      return frequencies_of(sector, {wave, 12}, {at, 0}).front();
    };
    const double with = lowest(n, speed);
    const double against = lowest(-n, speed);
    const double rest = lowest(n, 0);
    CAPTURE(n);
    // Of (h/R)^2 = 1e-4 and n^2, and what is left of differences of frequencies found to 1e-12.
    CHECK_THAT((against - with) / speed, WithinRel(4 * m / (m * m + 1), 1e-3));
    CHECK_THAT((against * with - rest * rest) / (speed * speed),
               WithinRel(m * m * (m * m - 3) / (m * m + 1), 5e-3));
  }
}

TEST_CASE("Out of its plane the tension of a ring that turns adds (n Omega)^2, in both directions alike") {
  const SolidRing ring{.radius = 0.2,
                       .width = 0.002,
                       .height = 0.002,
                       .youngs_modulus = 2e11,
                       .poisson_ratio = 0.3,
                       .density = 7800,
                       .contact = RingDirection::axial,
                       .sectors = 12,
                       .elements = 6,
                       .turns = true};
  const FiniteSector sector = ring_sector(ring);
  CHECK(sector.gyroscopic.size() == 0);
  const double speed = 30;
  for (const Index n : {1, 2, 3, 4}) {
    const auto lowest = [&](Index wave, double at) {
      return frequencies_of(sector, {wave, 12}, {at, 0}).front();
    };
    CAPTURE(n);
    const double rest = n == 1 ? 0 : lowest(n, 0);
    const double turning = lowest(n, speed);
    // n = 1 leans as a whole, and stays where it is in space. Twist takes part by n^4 (h/R)^2/6.
    CHECK_THAT((turning * turning - rest * rest) / (speed * speed),
               WithinRel(static_cast<double>(n * n), 2e-3));
    CHECK_THAT(lowest(-n, speed), WithinRel(turning, 1e-12));
  }
}
