#pragma once

// A finite-element sector under one travelling wave as a sum over modes, by the Rayleigh-Ritz method:
//
//   V^H K(a) V x = lambda V^H M(a) V x,   v_k = V x_k,   eta_k = sqrt(lambda_k)/(2 pi)
//
// Small sectors have V = I. Of larger ones V spans the responses to forces on the contacts and to the load at
// one shift, x_1 = (K - sigma M)^{-1} [e F], and what shift-invert Lanczos makes of them, (K - sigma M)^{-1}
// M x_1 and so on [Ericsson and Ruhe, Math. Comp. 35 (1980) 1251], with full reorthogonalisation in M, until
// the response no longer changes. The shift is sigma = 0, so that the static response is exact, or below it
// where K(a) is singular. One factorisation serves all of them.
//
// Of a sector that turns V spans responses at its speeds as well, and its modes at rest, which G and K_2
// couple, stand for it in a response that is solved for: the products V^H G V and V^H K_2 V go with them.
//
// The products V^H A V are sums in long double of the sector's own matrices, for those of K(a) cancel: the
// error of an eigenvalue is that of the given numbers and the square of that of V. The full response that
// this is compared with is solved for in the same arithmetic, by the factors at hand.

#include <vector>

#include "arcslip/sectors/finite_sector.hpp"
#include "arcslip/structure/modal_model.hpp"
#include "arcslip/structure/rotation.hpp"

namespace arcslip {

/// A travelling wave of n waves around N sectors: a = 2 pi n/N.
struct SectorWave {
  Index wave_number = 0;  ///< n
  Index sectors = 1;      ///< N

  Complex forward() const;  ///< e^{-ja}
};

/// Where the modes must give the response, and how exactly.
struct ModesRequest {
  double eta_low = 0;                    ///< >= 0
  double eta_high = 0;                   ///< >= eta_low
  double tolerance = 1e-10;              ///< relative
  Loss loss;                             ///< with which the response is measured
  Index all_modes = 100;                 ///< most reduced dofs of a sector that keeps all its modes
  bool compared = true;                  ///< with the full solve
  std::vector<Rotation> rotations = {};  ///< at which the response must be as exact; none: at rest
};

/// The modes v_k as contacts, outputs and load see them.
struct SectorModes {
  std::vector<double> frequencies;   ///< eta_k, ascending; 0 of motions that meet no stiffness
  std::vector<double> free_squares;  ///< of these: what the matrices, by their rounding, have for eta_k^2
  ComplexMatrix shapes;              ///< v_k/(2 pi), a column each, at the contacts and then at the outputs
  ComplexVector loads;               ///< v_k^H F/(2 pi)
  Index dofs = 0;                    ///< of the reduced sector
  double error = 0;                ///< largest relative difference of c, y_0 and outputs from the full solve
  double error_eta = 0;            ///< where
  std::vector<double> check_etas;  ///< where the two were compared, at modes and between them
  int factorisations = 0;          ///< of the shift, by which the comparison solves as well
  ComplexMatrix gyroscopic = {};   ///< v_i^H G v_k, skew-Hermitian, of a request with rotations; 0 x 0: none
  ComplexMatrix stiffness_speed2 = {};  ///< v_i^H K_2 v_k, the same
};

/// The modes as the first contact sees them, under `force` times the load.
ModalModel modal_model(const SectorModes& found, double force, const Loss& loss);

/// `sector` is checked and has a contact. Throws SectorError where the reduced mass is not positive
/// definite, where the stiffness is not positive semidefinite, and where the modes fail to give the response.
SectorModes sector_modes(const FiniteSector& sector, const SectorWave& wave, const ModesRequest& request);

}  // namespace arcslip
