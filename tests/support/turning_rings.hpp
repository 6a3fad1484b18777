#pragma once

// A bladed disk that turns with a ring below it, whole and as one sector, and the matrices of all its dofs.

#include "turning_sectors.hpp"
#include "whole_rings.hpp"

namespace arcslip::testing {

constexpr double ring_chord = 0.3;  // of the link between masses of two sectors, to the circumference
constexpr double ring_link = 4e5;

/// A lumped ring in its plane, masses .12 on soft ground, each held to the next one along the chord.
inline FiniteSector turning_ring() {
  Matrix mass = Matrix::Zero(4, 4);
  mass(0, 0) = mass(1, 1) = .12;
  Matrix gyroscopic = Matrix::Zero(4, 4);
  gyroscopic(0, 1) = -.24;
  gyroscopic(1, 0) = .24;
  Vector next(4);
  next << -std::sin(ring_chord), std::cos(ring_chord), -std::sin(ring_chord), -std::cos(ring_chord);
  Matrix stiffness = ring_link * next * next.transpose();
  stiffness.diagonal().head(2).array() += 4e4;
  FiniteSector sector;
  sector.mass = sparse(mass);
  sector.stiffness = sparse(stiffness);
  sector.gyroscopic = sparse(gyroscopic);
  sector.stiffness_speed2 = sparse(Matrix(-mass));
  sector.left = {0, 1};
  sector.right = {2, 3};
  sector.outputs = {1};
  sector.load = ComplexVector::Zero(4);
  return sector;
}

inline SectorPart turning_part(FiniteSector sector, DampingKind kind, const Ports& ports) {
  SectorPart part;
  sector.contacts = {0, 1};
  part.sector = checked(std::move(sector));
  part.damping_kind = kind;
  part.reference_frequency = 150;
  add_ports(part, ports);
  return part;
}

/// The springs of the tip along the circumference and, of the ring, both ends of a link.
inline const Ports tip_spring{{{3, 1}, {5, -1}}};
inline const Ports link_ends{{{0, -std::sin(ring_chord)}, {1, std::cos(ring_chord)}},
                             {{0, -std::sin(ring_chord)}, {1, -std::cos(ring_chord)}}};

/// The turning disk over such a ring.
inline SystemParameters turning_blisk(Index sectors, Index waves, const Rotation& rotation,
                                      DampingKind kind = DampingKind::viscous,
                                      SectorPath path = SectorPath::reduced, bool has_ports = false) {
  SectorPart base = turning_part(turning_disk(), kind, has_ports ? tip_spring : Ports{});
  SectorPart ring = turning_part(turning_ring(), kind, has_ports ? link_ends : Ports{});
  if (path == SectorPath::full) base.sector.outputs = ring.sector.outputs = {};
  SystemParameters system;
  system.structures = std::make_shared<const SectorPair>(base, ring, 1e-11, path);
  system.wave_number = waves;
  system.elements = sectors;
  system.base_damping = system.damper_damping = 3e-3;
  system.contacts = {{3e5, 1 / 3e5}, {2e5, 1 / 2e5}};
  system.interface_stiffness = 3e5 * static_cast<double>(sectors);
  system.eta_low = 100;
  system.eta_high = 330;
  system.rotation = rotation;
  return system;
}

inline double factor_of(Index i, int which) {
  return std::sin(1.7 * static_cast<double>(i) + 2.9 * which + .3);
}

/// With a split ring, tips that differ by the part and contacts that differ more.
inline SystemParameters unlike_turning(const SystemParameters& one, WholeLoad::Course course,
                                       double part = .1) {
  RingMake make = ring_of(one, course);
  const Index n = make.sectors;
  make.base_ports = 1;
  make.damper_ports = 2;
  RingContacts contacts;
  for (Index i = 0; i < n; ++i) {
    if (course == WholeLoad::Course::given)
      make.load.sectors.push_back(std::polar(1 + .3 * factor_of(i, 4), 3 * factor_of(i, 5)));
    make.changes.push_back({true, {{{i, 0, 1}}}, Matrix::Constant(1, 1, 1.4e6 * part * factor_of(i, 1))});
    for (const int k : {0, 1}) {
      contacts.stiffness.push_back(1 + part * factor_of(i, 2 + k));
      contacts.limit.push_back(1 + 3 * part * factor_of(i, 6 + k));
      contacts.missing.push_back(i == 1 && k == 1);
    }
  }
  make.changes.push_back({false, {{{n - 1, 0, 1}, {0, 1, 1}}}, Matrix::Constant(1, 1, -ring_link)});
  return whole_of(one, make, contacts);
}

/// A matrix of all sectors, of which that on the right is on the left of the next one.
inline Matrix of_all(const SparseMatrix& one, Index sectors) {
  const Index own = one.rows() - 2;
  Matrix all = Matrix::Zero(own * sectors, own * sectors);
  const Matrix dense(one);
  for (Index i = 0; i < sectors; ++i) {
    const auto at = [&](Index dof) {
      return dof < own ? own * i + dof : own * ((i + 1) % sectors) + dof - own;
    };
    for (Index a = 0; a < one.rows(); ++a) {
      for (Index b = 0; b < one.rows(); ++b) all(at(a), at(b)) += dense(a, b);
    }
  }
  return all;
}

/// Disk and ring as one matrix, 6 N and 2 N dofs.
inline Matrix of_both(SparseMatrix FiniteSector::*which, Index sectors) {
  Matrix both = Matrix::Zero(8 * sectors, 8 * sectors);
  both.topLeftCorner(6 * sectors, 6 * sectors) = of_all(turning_disk().*which, sectors);
  both.bottomRightCorner(2 * sectors, 2 * sectors) = of_all(turning_ring().*which, sectors);
  return both;
}

/// K of both as `unlike_turning` changes it.
inline Matrix changed_stiffness(Index sectors, double part) {
  Matrix k = of_both(&FiniteSector::stiffness, sectors);
  std::vector<Spring> tips;
  for (Index i = 0; i < sectors; ++i) tips.push_back({6 * i + 3, 6 * i + 5, 1.4e6 * part * factor_of(i, 1)});
  k.topLeftCorner(6 * sectors, 6 * sectors) += spring_matrix(6 * sectors, tips);
  Vector cut = Vector::Zero(8 * sectors);
  const Index last = 8 * sectors - 2;
  cut(last) = cut(6 * sectors) = -std::sin(ring_chord);
  cut(last + 1) = std::cos(ring_chord);
  cut(6 * sectors + 1) = -std::cos(ring_chord);
  return k - ring_link * cut * cut.transpose();
}

/// Z(eta, speed) of that, with the loss factor of the stiffness.
inline ComplexMatrix dense_z(Index sectors, double part, double eta, double speed, double loss) {
  const double w = two_pi * eta;
  const double turn = two_pi * speed;
  ComplexMatrix z = Complex(1, loss) * changed_stiffness(sectors, part).cast<Complex>();
  z += turn * turn * of_both(&FiniteSector::stiffness_speed2, sectors).cast<Complex>();
  z += Complex(0, w * turn) * of_both(&FiniteSector::gyroscopic, sectors).cast<Complex>();
  return z - w * w * of_both(&FiniteSector::mass, sectors).cast<Complex>();
}

}  // namespace arcslip::testing
