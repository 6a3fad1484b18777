#pragma once

// The two structures of the paper and their interface: what a case file's [system] describes, and the reduced
// model built from it.

#include <string>

#include "arcslip/modal_model.hpp"

namespace arcslip {

enum class StructureModel { rods, beams };

std::string to_string(StructureModel model);

/// [system] of a case file, nondimensional throughout.
struct SystemParameters {
  StructureModel model = StructureModel::beams;
  Index wave_number = 1;           ///< n >= 1
  Index elements = 30;             ///< N > 2n
  double mass_ratio = 1;           ///< M* = m_B/m_D > 0
  double frequency_ratio = 1;      ///< gamma = sqrt(K*/M*) > 0
  double interface_stiffness = 1;  ///< K_FD = k_F/k_D > 0
  double base_damping = 1e-4;      ///< zeta_B
  double damper_damping = 1e-4;    ///< zeta_D
  double force = 1;                ///< F = f_0/k_B > 0
  double preload = 1;              ///< P = mu p_0/k_B > 0

  double stiffness_ratio() const { return frequency_ratio * frequency_ratio * mass_ratio; }  ///< K*
};

/// Shear estimate of the interface stiffness, K_FD = 12 (L/h_D)^4/(1 + nu) [paper, footnote 4].
double shear_interface_stiffness(double slenderness, double poisson_ratio);

/// Base, damper and interface at one contact point, as the response equation needs them.
struct FrictionSystem {
  ModalModel base;           ///< with the travelling load
  ModalModel damper;         ///< without load
  double contact_stiffness;  ///< k = K_FD/N [paper (7)]
  double slip_per_preload;   ///< S/P = K*/K_FD [paper (13)]
};

/// Reduced base and damper of `parameters`, before they are turned into modes.
struct ReducedPair {
  ReducedStructure base;
  ReducedStructure damper;
};

ReducedPair reduce(const SystemParameters& parameters);

/// Damping factors beta of C = (beta/2 pi) K: 2 zeta_B/gamma and 2 zeta_D [paper, footnote 3].
double base_damping_factor(const SystemParameters& parameters);
double damper_damping_factor(const SystemParameters& parameters);

/// The whole model; its cost does not depend on N.
FrictionSystem build_system(const SystemParameters& parameters);

}  // namespace arcslip
