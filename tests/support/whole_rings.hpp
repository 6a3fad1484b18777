#pragma once

// A bladed disk with a ring below it, whole and as one sector: masses 1.2, .35, .25 in a row on ground, the
// first one joined to that of the next sector; a ring of masses .12 that rubs on the first ones.

#include <fmt/format.h>

#include <memory>

#include "arcslip/assembly/harmonic_system.hpp"
#include "arcslip/assembly/sector_pair.hpp"
#include "arcslip/assembly/whole_ring.hpp"
#include "arcslip/problems/response/sector_motions.hpp"

namespace arcslip::testing {

struct Spring {
  Index from;
  Index to;  ///< -1: ground
  double stiffness;
};

inline Matrix spring_matrix(Index size, const std::vector<Spring>& springs) {
  Matrix k = Matrix::Zero(size, size);
  for (const auto& [from, to, stiffness] : springs) {
    k(from, from) += stiffness;
    if (to < 0) continue;
    k(to, to) += stiffness;
    k(from, to) -= stiffness;
    k(to, from) -= stiffness;
  }
  return k;
}

inline SectorPart sector_part(const Vector& mass, const std::vector<Spring>& springs, DampingKind kind,
                              const std::vector<Index>& outputs, Index loaded) {
  SectorPart part;
  part.sector.mass = Matrix(mass.asDiagonal()).sparseView();
  part.sector.stiffness = spring_matrix(mass.size(), springs).sparseView();
  part.sector.left = {0};
  part.sector.right = {mass.size() - 1};
  part.sector.contacts = {0};
  part.sector.outputs = outputs;
  part.sector.load = ComplexVector::Zero(mass.size());
  if (loaded >= 0) part.sector.load(loaded) = 1;
  part.sector = checked(std::move(part.sector));
  part.damping_kind = kind;
  part.reference_frequency = 550;
  return part;
}

/// Further outputs of a part behind its own, that changes are to: sums of dofs times weights.
using Ports = std::vector<std::vector<std::pair<Index, double>>>;

inline void add_ports(SectorPart& part, const Ports& ports) {
  for (const auto& port : ports) {
    SectorOutput output{fmt::format("#{}", part.combinations.size()), {}};
    for (const auto& [dof, weight] : port) {
      output.terms.push_back({std::ssize(part.sector.outputs), weight});
      part.sector.outputs.push_back(dof);
      ++part.untold;
    }
    part.combinations.push_back(output);
  }
}

/// The disk with so many sectors under n waves, its outer masses as outputs.
inline SystemParameters blisk(double preload, Index sectors = 24, Index waves = 2,
                              DampingKind kind = DampingKind::modal, const Ports& base_ports = {},
                              const Ports& damper_ports = {}, double mass_damping = 0) {
  SectorPart base = sector_part(Eigen::Vector4d(1.2, .35, .25, 0),
                                {{0, -1, 6e5}, {0, 1, 1e6}, {1, 2, 2e6}, {0, 3, 5e7}}, kind, {2}, 2);
  SectorPart ring = sector_part(Eigen::Vector2d(.12, 0), {{0, -1, 5e3}, {0, 1, 5e6}}, kind, {}, -1);
  base.fixed.mass = ring.fixed.mass = mass_damping / two_pi;  // C = mass_damping M
  add_ports(base, base_ports);
  add_ports(ring, damper_ports);
  SystemParameters system;
  system.structures = std::make_shared<const SectorPair>(base, ring, 1e-12);
  system.wave_number = waves;
  system.elements = sectors;
  system.base_damping = system.damper_damping = 1e-3;
  system.contacts = {{5e6, 1 / 5e6}};
  system.interface_stiffness = 5e6 * static_cast<double>(sectors);
  system.preload = preload;
  system.eta_low = 540;
  system.eta_high = 570;
  return system;
}

inline RingMake ring_of(const SystemParameters& one, WholeLoad::Course course) {
  return {one.elements, one.structures, one.contacts, {course, one.wave_number, {}}};
}

/// All sectors of a system of one.
inline SystemParameters whole_of(const SystemParameters& one, const RingMake& make,
                                 const RingContacts& contacts = {}) {
  SystemParameters whole = one;
  whole.contacts = contacts.of(build_wave(one).contacts, make.sectors);
  whole.structures = std::make_shared<const WholeRing>(make);
  return whole;
}

inline problems::HarmonicResponse response_of(const SystemParameters& system) {
  return problems::HarmonicResponse(build_harmonic_system(system));
}

}  // namespace arcslip::testing
