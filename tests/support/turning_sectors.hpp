#pragma once

// Sectors that feel rotation.

#include <cmath>
#include <numbers>
#include <utility>

#include "sector_examples.hpp"

namespace arcslip::testing {

/// Straight Euler-Bernoulli element of length L along x, dofs u, v and turn at each end, of unit mass a
/// length: M, K of the axial and bending stiffness, G = 2 int N^T (e_z x) N and the stiffness of a tension 1.
struct PlaneElement {
  Matrix mass = Matrix::Zero(6, 6);
  Matrix stiffness = Matrix::Zero(6, 6);
  Matrix gyroscopic = Matrix::Zero(6, 6);
  Matrix tension = Matrix::Zero(6, 6);

  PlaneElement(double length, double axial, double bending) {
    // Gauss's rule of four points, exact for the products of cubics.
    const double inner = std::sqrt(3.0 / 7 - 2.0 / 7 * std::sqrt(1.2));
    const double outer = std::sqrt(3.0 / 7 + 2.0 / 7 * std::sqrt(1.2));
    const double inner_weight = (18 + std::sqrt(30)) / 72;
    for (const auto& [place, weight] :
         {std::pair(-outer, 0.5 - inner_weight), std::pair(-inner, inner_weight),
          std::pair(inner, inner_weight), std::pair(outer, 0.5 - inner_weight)}) {
      const double s = 0.5 * (1 + place);
      const double l = length;
      Vector along(6);
      Vector stretch(6);
      Vector across(6);
      Vector turn(6);
      Vector bend(6);
      along << 1 - s, 0, 0, s, 0, 0;
      stretch << -1 / l, 0, 0, 1 / l, 0, 0;
      across << 0, 1 - 3 * s * s + 2 * s * s * s, l * s * (1 - s) * (1 - s), 0, s * s * (3 - 2 * s),
          l * s * s * (s - 1);
      turn << 0, 6 * s * (s - 1) / l, (1 - s) * (1 - 3 * s), 0, 6 * s * (1 - s) / l, s * (3 * s - 2);
      bend << 0, (12 * s - 6) / (l * l), (6 * s - 4) / l, 0, (6 - 12 * s) / (l * l), (6 * s - 2) / l;
      const double part = weight * l;
      mass += part * (along * along.transpose() + across * across.transpose());
      stiffness += part * (axial * stretch * stretch.transpose() + bending * bend * bend.transpose());
      gyroscopic += 2 * part * (across * along.transpose() - along * across.transpose());
      tension += part * turn * turn.transpose();
    }
  }
};

/// Thin ring of radius 1, mass 1 a length and bending stiffness 1, whose hoop tension alone holds it as it
/// turns: a polygon of `elements`, one a sector, with the dofs of a node radially, along the circumference
/// and its turn. `thickness` is h/R of a rectangular section, which its axial stiffness follows from.
inline FiniteSector polygon_ring(Index elements, double thickness) {
  const double half = std::numbers::pi / static_cast<double>(elements);
  const PlaneElement element(2 * std::sin(half), 12 / (thickness * thickness), 1);
  // The element's x axis leads from one node to the next, turned by `half` against the circumference at each;
  // its y axis points inwards.
  Matrix turned = Matrix::Zero(6, 6);
  for (const Index end : {0, 1}) {
    const double angle = end == 0 ? half : -half;
    turned(3 * end, 3 * end) = -std::sin(angle);
    turned(3 * end, 3 * end + 1) = std::cos(angle);
    turned(3 * end + 1, 3 * end) = -std::cos(angle);
    turned(3 * end + 1, 3 * end + 1) = -std::sin(angle);
    turned(3 * end + 2, 3 * end + 2) = 1;
  }
  const auto in_place = [&](const Matrix& matrix) { return sparse(turned.transpose() * matrix * turned); };
  FiniteSector sector;
  sector.mass = in_place(element.mass);
  sector.stiffness = in_place(element.stiffness);
  sector.gyroscopic = in_place(element.gyroscopic);
  sector.stiffness_speed2 = in_place(element.tension - element.mass);
  sector.left = {0, 1, 2};
  sector.right = {3, 4, 5};
  sector.contacts = {0};
  sector.load = ComplexVector::Unit(6, 0);
  return sector;
}

/// A lumped bladed disk, masses of disk, blade and tip radially (x) and along the circumference (y), the
/// blade softer along y, the disk held to the next one along the chord between them: waves that run either
/// way differ as it turns.
inline FiniteSector turning_disk() {
  constexpr double chord = 0.3;  // angle to the circumference, that of fewer sectors than it is used with
  const Vector masses = (Vector(3) << 1.2, 0.35, 0.25).finished();
  Matrix mass = Matrix::Zero(8, 8);
  Matrix stiffness = mass;
  Matrix gyroscopic = mass;
  Matrix stress = mass;
  const auto spring = [](Matrix& matrix, Index a, Index b, double k) {
    matrix(a, a) += k;
    matrix(b, b) += k;
    matrix(a, b) -= k;
    matrix(b, a) -= k;
  };
  for (Index i = 0; i < 3; ++i) {
    mass(2 * i, 2 * i) = mass(2 * i + 1, 2 * i + 1) = masses(i);
    gyroscopic(2 * i, 2 * i + 1) = -2 * masses(i);  // 2 m e_z x of the velocity
    gyroscopic(2 * i + 1, 2 * i) = 2 * masses(i);
  }
  stiffness(0, 0) = stiffness(1, 1) = 6e5;
  for (Index j = 0; j < 2; ++j) {
    const double softer = j == 0 ? 1 : 0.7;
    spring(stiffness, j, 2 + j, softer * 1e6);
    spring(stiffness, 2 + j, 4 + j, softer * 2e6);
  }
  Vector next = Vector::Zero(8);
  next << -std::sin(chord), std::cos(chord), 0, 0, 0, 0, -std::sin(chord), -std::cos(chord);
  stiffness += 5e6 * next * next.transpose();
  spring(stress, 3, 5, 0.9);
  FiniteSector sector;
  sector.mass = sparse(mass);
  sector.stiffness = sparse(stiffness);
  sector.gyroscopic = sparse(gyroscopic);
  sector.stiffness_speed2 = sparse(Matrix(stress - mass));
  sector.left = {0, 1};
  sector.right = {6, 7};
  sector.contacts = {0};
  sector.outputs = {4, 5};
  sector.load = ComplexVector::Zero(8);
  sector.load(2) = 1;
  return sector;
}

}  // namespace arcslip::testing
