#pragma once

// Base and damper in SI units: what two rings of solid rectangular section are in the paper's nondimensional
// groups [paper (19), footnotes 4 and 5], and the way back from nondimensional results.
//
//   m = rho w h L,   k = E w h/L (rods) or E w h^3/(12 L^3) (beams),   K* = k_B/k_D
//   M* = m_B/m_D,   gamma = sqrt(K*/M*),   F = f_0/k_B,   P = mu p_0/k_B
//
// The interface gives way as the inner half of the damper does in shear, k_F = G w_D L/(h_D/2) with
// G = E_D/(2 (1 + nu_D)):
//
//   K_FD = k_F/k_D = (L/h_D)^2/(1 + nu_D) (rods)   or   12 (L/h_D)^4/(1 + nu_D) (beams)
//
// The units of the nondimensional model are L of displacement, k_D L of force, k_D L^2 of energy, and of
// frequency Omega_D = 2 pi sqrt(k_D/m_D) (rods) or (2 pi)^2 sqrt(k_D/m_D) (beams).

#include "arcslip/assembly/system.hpp"

namespace arcslip {

/// A ring of solid rectangular section. Transverse waves bend it in the direction of its height.
struct RectangularRing {
  double elastic_modulus = 0;  ///< E > 0, Pa
  double density = 0;          ///< rho > 0, kg/m^3
  double poisson_ratio = 0.3;  ///< nu > -1 and <= 1/2; that of the base has no influence
  double width = 0;            ///< w > 0, m
  double height = 0;           ///< h > 0, m

  double mass(double circumference) const;  ///< m, kg
  /// k of a rod or a beam as long as the circumference, N/m.
  double stiffness(StructureModel model, double circumference) const;
};

/// Base, damper and what acts on them, in SI units.
struct Geometry {
  RectangularRing base;             ///< pressed against the damper
  RectangularRing damper;           ///< of the same circumference
  double circumference = 0;         ///< L > 0 of both, m
  double friction_coefficient = 0;  ///< mu > 0
  double preload_per_length = 0;    ///< p_0 >= 0, N/m
  double force_per_length = 0;      ///< f_0 > 0, amplitude, N/m
};

/// Sets M*, gamma, K_FD by the shear estimate, F and P; the model is the one that `system` has. They are not
/// finite and positive where the sizes are beyond what a double holds.
void set_groups(const Geometry& geometry, SystemParameters& system);

/// From the quantities of the model to SI units.
class PhysicalScale {
 public:
  /// Of a model whose matrices are in kg and N/m, eta in so many Hz, preloads those of a contact in N. Of
  /// `system` K_FD counts.
  PhysicalScale(double hertz, const SystemParameters& system)
      : interface_stiffness_(system.interface_stiffness), frequency_(hertz), per_length_(false) {}

  /// Of `system` the model and K_FD count.
  PhysicalScale(const Geometry& geometry, const SystemParameters& system);

  double frequency(double eta) const { return eta * frequency_; }                     ///< Hz
  double displacement(double amplitude) const { return amplitude * circumference_; }  ///< of Y, U, R, S; m
  double preload(double preload) const { return preload * preload_; }  ///< p_0, in `preload_unit`
  /// As columns have it: "N_per_m", or "N" of a contact.
  const char* preload_unit() const { return per_length_ ? "N_per_m" : "N"; }
  double force_per_length(double force) const { return force * base_stiffness_; }  ///< f_0, N/m
  double energy(double energy) const { return energy * energy_; }                  ///< J
  double force(double force) const { return force * energy_ / circumference_; }    ///< of a contact, N

  /// Energy lost to friction per cycle by the whole ring, J. `dissipated` is that of one contact over k S^2,
  /// as in branches.csv, and N k S^2 = K_FD S^2.
  double dissipated(double dissipated, double slip_threshold) const {
    return energy(dissipated * interface_stiffness_ * slip_threshold * slip_threshold);
  }

 private:
  double circumference_ = 1;
  double base_stiffness_ = 1;   ///< k_B, N/m
  double interface_stiffness_;  ///< K_FD
  double frequency_;            ///< Omega_D/(2 pi), Hz
  double preload_ = 1;          ///< k_B/mu, N/m
  double energy_ = 1;           ///< k_D L^2, J
  bool per_length_ = true;      ///< whether preloads are those of a length
};

}  // namespace arcslip
