#pragma once

// Forced response of base and damper in m contact dofs of a sector and one harmonic. Each contact has a
// spring k_i and its own slider; forces k_i phi_i r_i pull base and damper together, so that the relative
// displacements r = u - y obey
//
//   (1 + C K) r = -y_0,   K = diag(k_i phi(R_i/S_i)),   R_i = |r_i|,   S_i = s_i P,   C = C_B + C_D.
//
// Solved is r + (1 + C K)^{-1} y_0 = 0 relative to |r|, the error of r itself. Then u = -C_D K r and
// y = u - r. With one contact this is ForcedResponse.
//
// Unknowns: Re r_1, Im r_1, Re r_2, ... Parameters: eta, P. Regimes: which contacts slip, bit i for contact
// i; borders: R_i = S_i, for which (R^2 - S^2)/(R^2 + S^2) = tanh ln(R/S) stands, smooth where R = 0.

#include "arcslip/contact_modes.hpp"
#include "arcslip/continuation/problem.hpp"
#include "arcslip/continuation/trace.hpp"

namespace arcslip::problems {

class MultiContactResponse : public continuation::Problem {
 public:
  enum Parameter : Index { eta, preload };
  /// Observables in this order, those of the first contact; then for each further contact R_contact_2,
  /// R_over_S_contact_2, Y_contact_2, U_contact_2, dissipated_contact_2; then the amplitudes of the system's
  /// outputs.
  enum Quantity : Index { R, S, R_over_S, Y, U, beta, alpha, psi, dissipated };

  /// Throws std::invalid_argument where the three differ in the number of contacts or have no load.
  explicit MultiContactResponse(ContactSystem system);

  Index size() const override { return 2 * contacts(); }
  std::vector<std::string> parameter_names() const override { return {"eta", "P"}; }
  bool evaluate(const Vector& u, const Vector& p, int regime,
                const continuation::Evaluation& out) const override;
  void scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const override;

  /// "stick", "slip", or "slip 1 3" where only these contacts slip.
  std::vector<std::string> regime_names() const override;
  int border_count(int /*regime*/) const override { return static_cast<int>(contacts()); }
  double border(const Vector& u, const Vector& p, int regime, int border,
                continuation::Gradient* gradient) const override;
  int regime_beyond(int regime, int border) const override { return regime ^ (1 << border); }

  /// Of them Y has a gradient.
  std::vector<continuation::Observable> observables() const override;
  void observe(const Vector& u, const Vector& p, int regime, Vector& values) const override;
  double observe(const Vector& u, const Vector& p, int regime, Index which,
                 continuation::Gradient& gradient) const override;

  /// Resonances of base, damper and the stuck whole, and the stuck damper's antiresonances, in eta.
  std::vector<double> landmarks(Index parameter, double from, double to) const override;

  /// The solution at (eta, P) on the branch that begins where all contacts stick, under a high preload.
  /// Throws std::invalid_argument where that cannot be traced.
  continuation::Guess guess(double eta_value, double preload_value) const;

  Index contacts() const { return std::ssize(system_.contacts); }

 private:
  /// k phi of a contact, and its derivative in ln R.
  struct Law {
    Complex spring;
    Complex spring_log;
  };
  Law law(Complex r, Index contact, double load, int regime) const;
  double threshold(Index contact, double load) const {
    return system_.contacts[static_cast<std::size_t>(contact)].slip_per_preload * load;
  }

  ContactSystem system_;
};

}  // namespace arcslip::problems
