#pragma once

// A reduced structure seen at its contact dof, as a sum over its modes.
//
// With damping proportional to stiffness, viscous as C = (beta/2 pi) K or structural as a complex stiffness
// K (1 + j delta), and w* = 2 pi eta, the modes of (K, M) diagonalise the dynamic stiffness
// Z(eta) = K (1 + j delta) + j w* C - w*^2 M for every eta at once:
//
//   c(eta)   = e^T Z^{-1} e = sum_k a_k/d_k,      a_k = |e^T v_k|^2/(2 pi)^2
//   y_0(eta) = e^T Z^{-1} F = sum_k b_k/d_k,      b_k = (e^T v_k)(v_k^H F)/(2 pi)^2
//   d_k(eta) = (eta_k - eta)(eta_k + eta) + j (beta eta + delta) eta_k^2 + j (2 zeta eta_k + mu) eta
//
// where mu belongs to C = 2 pi mu M, and zeta is that of modal damping, the same for every mode.
//
// A flow round the structure adds -A_k + j g_k eta to d_k, see ModeInfluence.
//
// The difference eta_k - eta is exact, so that the sums are accurate to rounding on the sharpest peak.

#include <numbers>
#include <utility>
#include <vector>

#include "arcslip/types.hpp"

namespace arcslip {

struct ReducedStructure;

/// Response at the contact dof for a given eta, with its derivatives in eta.
struct ContactResponse {
  Complex compliance;      ///< c = e^T Z^{-1} e
  Complex compliance_eta;  ///< dc/deta
  Complex free;            ///< y_0 = e^T Z^{-1} F, the response without contact
  Complex free_eta;        ///< dy_0/deta
};

/// Second derivatives in eta of a ContactResponse.
struct ContactCurvature {
  Complex compliance;  ///< d2c/deta2
  Complex free;        ///< d2y_0/deta2
};

/// Damping that the undamped modes diagonalise; negative where it feeds energy in.
struct Loss {
  double viscous = 0;     ///< beta of C = (beta/2 pi) K
  double structural = 0;  ///< delta of K (1 + j delta)
  double modal = 0;       ///< 2 zeta, zeta the damping ratio of every mode
  double mass = 0;        ///< mu of C = 2 pi mu M

  /// Loss factor of what is proportional to stiffness; at rest nothing is lost.
  double at(double eta) const { return eta == 0 ? 0 : viscous * eta + structural; }

  /// Im d_k of a mode, with its derivative in eta.
  double part(double eta, double frequency) const {
    return at(eta) * frequency * frequency + (modal * frequency + mass) * eta;
  }
  double part_eta(double frequency) const {
    return viscous * frequency * frequency + modal * frequency + mass;
  }

  /// Of both together, and of so many times one.
  friend Loss operator+(const Loss& a, const Loss& b) {
    return {a.viscous + b.viscous, a.structural + b.structural, a.modal + b.modal, a.mass + b.mass};
  }
  friend Loss operator*(double factor, const Loss& loss) {
    return {factor * loss.viscous, factor * loss.structural, factor * loss.modal, factor * loss.mass};
  }
};

/// Z(eta) = k K + m M of a structure with this damping but for its modal part, which no matrix has.
template <class Real>
struct MatrixFactors {
  /// At eta.
  MatrixFactors(double eta, const Loss& loss) {
    const Real w = 2 * std::numbers::pi_v<Real> * eta;
    k = {1, loss.at(eta)};
    m = {-w * w, 2 * std::numbers::pi_v<Real> * loss.mass * w};
  }

  std::complex<Real> k;  ///< of K
  std::complex<Real> m;  ///< of M
};

/// What acts on a mode as it moves beside its own structure, as a flow does: the force stiffness q -
/// damping q', over its modal mass. An imaginary part of the stiffness is one of a wave, which neighbours lag
/// behind, and where it is positive feeds energy in.
struct ModeInfluence {
  Complex stiffness = 0;  ///< A_k, in units of eta^2
  double damping = 0;     ///< g_k, in units of eta

  /// What d_k has more.
  Complex part(double eta) const { return {-stiffness.real(), damping * eta - stiffness.imag()}; }
  Complex part_eta() const { return {0, damping}; }  ///< its derivative in eta

  /// The square of the frequency of a mode that moves under it, without damping; no less than 0.
  double square(double frequency) const {
    const double moved = frequency * frequency - stiffness.real();
    return moved > 0 ? moved : 0;
  }

  /// Under the wave that runs the other way.
  ModeInfluence conjugate() const { return {std::conj(stiffness), damping}; }
  friend ModeInfluence operator*(double factor, const ModeInfluence& one) {
    return {factor * one.stiffness, factor * one.damping};
  }
  friend bool operator==(const ModeInfluence& a, const ModeInfluence& b) {
    return a.stiffness == b.stiffness && a.damping == b.damping;
  }
};

/// d_k of a mode of frequency eta_k, with its derivative in eta.
struct ModalDenominator {
  /// At eta.
  ModalDenominator(double eta, double frequency, const Loss& loss, const ModeInfluence& influence = {})
      : value(Complex((frequency - eta) * (frequency + eta), loss.part(eta, frequency)) +
              influence.part(eta)),
        by_eta(Complex(-2 * eta, loss.part_eta(frequency)) + influence.part_eta()) {}

  Complex value;   ///< d_k
  Complex by_eta;  ///< dd_k/deta
};

/// Compliance c for a loss fixed + zeta * per_zeta, with its derivatives.
struct DampedCompliance {
  Complex value;    ///< c
  Complex by_eta;   ///< dc/deta
  Complex by_zeta;  ///< dc/dzeta
};

/// One mode; frequencies are in units of eta.
struct Mode {
  double frequency;              ///< eta_k
  double residue;                ///< a_k >= 0
  Complex load_residue;          ///< b_k
  ModeInfluence influence = {};  ///< of a flow
};

/// The modes of a structure, in ascending order of frequency.
class ModalModel {
 public:
  /// A structure that is held and cannot move: no modes, c = 0, y_0 = 0.
  ModalModel() = default;

  /// Throws std::invalid_argument where the mass is not positive definite.
  ModalModel(const ReducedStructure& structure, Index contact_dof, const Loss& loss);

  /// `damping` is beta: C = (beta/2 pi) K, that is 2 zeta_D for the damper and 2 zeta_B/gamma for the base.
  ModalModel(const ReducedStructure& structure, Index contact_dof, double damping)
      : ModalModel(structure, contact_dof, Loss{damping, 0}) {}

  /// Modes that are known.
  ModalModel(std::vector<Mode> modes, const Loss& loss) : modes_(std::move(modes)), loss_(loss) {}

  /// The same modes with another damping.
  ModalModel damped(const Loss& loss) const { return {modes_, loss}; }

  /// The same under a load that is turned in phase by this factor of modulus 1.
  ModalModel turned(const Complex& turn) const;

  /// The same structure where nothing but its own load moves it: c = 0.
  ModalModel unyielding() const;

  /// Compliance and free response at eta, O(J) operations.
  ContactResponse at(double eta) const;

  /// Their second derivatives, O(J) operations.
  ContactCurvature curvature(double eta) const;

  /// Compliance of the same modes where the loss is fixed + zeta * per_zeta.
  DampedCompliance compliance(double eta, double zeta, const Loss& per_zeta, const Loss& fixed = {}) const;

  /// What the sums are over.
  const std::vector<Mode>& modes() const { return modes_; }
  const Loss& loss() const { return loss_; }

 private:
  std::vector<Mode> modes_;
  Loss loss_;
};

/// The undamped frequencies at which 1 + k c = 0, c the sum of the compliances of `models`: the resonances of
/// these structures joined at the contact dof through springs of stiffness k. In ascending order.
std::vector<double> joined_frequencies(const std::vector<const ModalModel*>& models, double k);

}  // namespace arcslip
