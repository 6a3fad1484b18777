#include "arcslip/time/ring_sector.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "arcslip/sectors/chain_sector.hpp"
#include "structure/shape_functions.hpp"

namespace arcslip {
namespace {

constexpr Index node_dofs = 3;     // of either motion
constexpr Index element_dofs = 9;  // left node, three of the interior, right node
using Shapes = Eigen::Matrix<double, element_dofs, 1>;

/// A field with cubic shapes, among the element's dofs.
Shapes cubic(const Eigen::Vector4d& shapes) {
  Shapes all = Shapes::Zero();
  all.segment<2>(0) = shapes.head<2>();
  all.segment<2>(6) = shapes.tail<2>();
  return all;
}

/// A field with quartic shapes, among the element's dofs.
Shapes quartic(const Quartic::Values& shapes) {
  Shapes all = Shapes::Zero();
  all.segment<4>(2) = shapes.head<4>();
  all(8) = shapes(4);
  return all;
}

/// What two strains weigh in the energy of deformation, and two fields in that of motion; per length.
struct Section {
  double first_stiffness;
  double second_stiffness;
  double first_mass;
  double second_mass;
};

Section section(const SolidRing& ring) {
  const double area = ring.width * ring.height;
  const double about_axis = ring.width * std::pow(ring.height, 3) / 12;
  const double about_radius = ring.height * std::pow(ring.width, 3) / 12;
  const double e = ring.youngs_modulus;
  const double g = e / (2 * (1 + ring.poisson_ratio));
  const double mass = ring.density * area;
  if (ring.motion() == SolidRingMotion::in_plane) return {e * area, e * about_axis, mass, mass};
  return {e * about_radius, g * torsion_constant(ring.width, ring.height), mass,
          ring.density * (about_axis + about_radius)};
}

struct Strains {
  Shapes first;
  Shapes second;
};

Strains strains(const SolidRing& ring, const Hermite& cubics, const Quartic& quartics) {
  const double r = ring.radius;
  if (ring.motion() == SolidRingMotion::in_plane) {
    return {(cubic(cubics.value) + quartic(quartics.first)) / r,
            (quartic(quartics.first) - cubic(cubics.second)) / (r * r)};
  }
  return {quartic(quartics.value) / r - cubic(cubics.second) / (r * r),
          quartic(quartics.first) / r + cubic(cubics.first) / (r * r)};
}

void check(const SolidRing& ring) {
  const bool shape = ring.radius > 0 && ring.width > 0 && ring.height > 0 && ring.height < 2 * ring.radius;
  const bool material =
      ring.youngs_modulus > 0 && ring.density > 0 && ring.poisson_ratio > -1 && ring.poisson_ratio < 0.5;
  if (!shape || !material || ring.sectors < 1 || ring.elements < 1) {
    throw std::invalid_argument("ring_sector: a quantity of the ring is out of its range");
  }
}

}  // namespace

double torsion_constant(double width, double height) {
  const double a = std::min(width, height);
  const double b = std::max(width, height);
  // tanh(x) = 1 - 2/(e^{2x} + 1): the sum over the ones is 31 zeta(5)/32.
  double sum = 31.0 / 32.0 * 1.0369277551433699263;
  for (int k = 1; k < 60; k += 2) sum -= 2 / (std::exp(k * pi * b / a) + 1) / std::pow(k, 5);
  return a * a * a * b * (1 - 192 / std::pow(pi, 5) * a / b * sum) / 3;
}

FiniteSector ring_sector(const SolidRing& ring) {
  check(ring);
  const double angle = two_pi / static_cast<double>(ring.sectors * ring.elements);
  const Section weights = section(ring);
  Matrix mass = Matrix::Zero(element_dofs, element_dofs);
  Matrix stiffness = mass;
  Matrix gyroscopic = mass;
  Matrix stretched = mass;
  Matrix slid = mass;
  for (const auto& [s, weight] : gauss_points()) {
    const Hermite cubics(s, angle);
    const Quartic quartics(s, angle);
    const Strains strain = strains(ring, cubics, quartics);
    const Shapes first = cubic(cubics.value);
    const Shapes second = quartic(quartics.value);
    const double length = weight * angle * ring.radius;
    stiffness += length * weights.first_stiffness * strain.first * strain.first.transpose() +
                 length * weights.second_stiffness * strain.second * strain.second.transpose();
    mass += length * weights.first_mass * first * first.transpose() +
            length * weights.second_mass * second * second.transpose();
    const Shapes turn = (cubic(cubics.first) - second) / ring.radius;
    const Shapes slope = cubic(cubics.first) / ring.radius;
    const double tension = weights.first_mass * ring.radius * ring.radius;
    gyroscopic += 2 * length * weights.first_mass * (second * first.transpose() - first * second.transpose());
    slid += length * tension * slope * slope.transpose();
    stretched += length * tension * (strain.first * strain.first.transpose() + turn * turn.transpose());
  }
  const Index contact = ring.contact == RingDirection::tangential ? 2 : 0;
  if (!ring.turns) return chain_sector(mass, stiffness, node_dofs, ring.elements, contact);
  if (ring.motion() == SolidRingMotion::out_of_plane)
    return chain_sector(mass, stiffness, node_dofs, ring.elements, contact, {}, slid);
  return chain_sector(mass, stiffness, node_dofs, ring.elements, contact, gyroscopic, stretched - mass);
}

}  // namespace arcslip
