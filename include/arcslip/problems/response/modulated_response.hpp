#pragma once

// The modulated travelling wave that branches off a forced response where a pair of its disturbances, of q
// waves, lies on the imaginary axis [Neimark-Sacker]: every node moves with the load's frequency eta and a
// second one nu that is not known,
//
//   x_i(t) = x(theta_1 - (i - 1) 2 pi n/N, theta_2 - (i - 1) 2 pi q/N),   theta_1 = w t,   theta_2 = s t,
//
// so that one sector is enough: the line (k, l) has the frequency k eta + l nu and travels on k n + l q
// waves,
//
//   x_kl + C_kl K f_kl(x) = x0_k delta_l0,   C_kl at (k eta + l nu, k n + l q).
//
// Solved is f + (1 + C K)^{-1} (x - f - x0) = 0 as in harmonic_response.hpp, with f over K, and a phase of
// theta_2. It is told how far the motion would be from that in twice as many lines.
//
// Unknowns: Re x_kl, Im x_kl of all lines of the first coordinate, then of the next, then nu. Parameters:
// eta, P. The branch ends where the modulation has died out.

#include <optional>

#include "arcslip/assembly/system.hpp"
#include "arcslip/elements/two_phases.hpp"
#include "arcslip/problems/response/harmonic_problem.hpp"
#include "arcslip/time/ring_waves.hpp"

namespace arcslip::problems {

/// The equations above.
class ModulatedResponse : public continuation::Problem {
 public:
  enum Parameter : Index { eta, preload };
  /// Of the first contact: R, Y, U of the line (1, 0) and the greatest values in time; |nu|; q for it; of the
  /// relative motion in the coordinates the part that is modulated, the norm of the lines with l != 0 over
  /// that of all; and by how much of that norm, or of eta, twice as many lines would move the nearest point
  /// of the branch, to the first order.
  enum Quantity : Index {
    R,
    Y,
    U,
    R_peak,
    Y_peak,
    U_peak,
    frequency_2,
    wave_2,
    modulation,
    modulation_error
  };

  /// Under disturbances of `wave` waves, with lines up to l = `highest`. Throws std::invalid_argument with
  /// the reason where the motion cannot be followed.
  ModulatedResponse(HarmonicSystem system, const RingWaves& waves, Index wave, int highest);

  Index size() const override { return 2 * coordinates_.size() * count() + 1; }
  std::vector<std::string> parameter_names() const override { return {"eta", "P"}; }
  [[nodiscard]] bool evaluate(const Vector& u, const Vector& p, const continuation::Regime& regime,
                              const continuation::Evaluation& out) const override;
  void scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const override;
  int border_count(const continuation::Regime& /*regime*/) const override { return 1; }
  double border(const Vector& u, const Vector& p, const continuation::Regime& regime, int border,
                continuation::Gradient* gradient) const override;
  std::optional<continuation::Regime> regime_beyond(const continuation::Regime& /*regime*/,
                                                    int /*border*/) const override {
    return {};
  }
  std::string reason_of_end() const override { return "where the modulation has died out"; }
  std::vector<continuation::Observable> observables() const override;
  void observe(const Vector& u, const Vector& p, const continuation::Regime& regime,
               Vector& values) const override;

  void observe_quickly(const Vector& u, const Vector& p, const continuation::Regime& regime,
                       Vector& values) const override;

  /// The lines, and in these r, y and u of the first contact.
  const std::vector<Line>& lines() const { return balance_.phases.lines(); }
  ComplexMatrix first_contact(const Vector& u, const Vector& p) const;

  /// The disturbance of a response, whose motions x_h in its orders are the lines (h, 0), that leaves least
  /// of the balance at this nu: of norm 1, 0 where there is no balance.
  Vector disturbance(const ComplexMatrix& motion, const Vector& p, double nu) const;

  /// The lines of such a motion.
  Vector unmodulated(const ComplexMatrix& motion, double nu) const;

  /// Fixes the phase of theta_2 by that of such a disturbance, and the size of motions.
  void set_reference(const Vector& modulated, double size);

  /// A solution whose modulation along the disturbance is this share of `size`, and where the parameter has
  /// to lie for it; none if Newton's method finds none nearby.
  std::optional<continuation::Guess> modulated(const continuation::Guess& near, Index parameter,
                                               double share) const;

 private:
  /// Structures and forces of so many lines.
  struct Balance {
    TwoPhases phases;
    std::vector<ContactModes> base;
    std::vector<ContactModes> damper;
  };
  /// R_kl of all coordinates and their derivatives by unknowns, nu, eta and P.
  struct Rows {
    ComplexVector residual;  // coordinates x lines, those of the first coordinate first
    ComplexMatrix by_motion;
    ComplexVector by_nu, by_eta, by_preload;
    ComplexVector force;  // f over K
    Vector weight;        // of each line
  };
  Balance balance(int highest_k, int highest_l) const;
  struct Forces;
  Forces forces(const Balance& at, const ComplexMatrix& x, double nu, const Vector& p,
                bool derivatives) const;
  void fill(const Balance& at, const ComplexMatrix& x, double nu, const Vector& p, bool derivatives,
            Rows& rows) const;
  void fill_line(const Line& line, Index a, const ComplexMatrix& x, const Forces& forces,
                 const ContactReceptance& joint, double nu, const Vector& p, bool derivatives,
                 Rows& rows) const;

  /// That of the line at this position.
  static double frequency(const Balance& at, Index a, double nu, const Vector& p) {
    const auto [k, l] = at.phases.lines()[static_cast<std::size_t>(a)];
    return k * p(eta) + l * nu;
  }
  Index count() const { return std::ssize(lines()); }

  /// That of a coefficient, by its place among those of all coordinates.
  const Line& line(Index coefficient) const {
    return lines()[static_cast<std::size_t>(coefficient % count())];
  }
  ComplexMatrix motion(const Vector& u) const;
  double error(const Vector& u, const Vector& p) const;
  double load(const Vector& p) const { return p(preload) + system_.preload_growth * p(eta) * p(eta); }

  HarmonicSystem system_;
  RingWaves waves_;
  Coordinates coordinates_;
  Index wave_;
  Vector stiffness_;  // K of each coordinate
  Balance balance_;
  Balance finer_;
  Vector reference_;
  double size_ = 1;
};

/// A modulated response with a first guess.
struct ModulatedStart {
  std::shared_ptr<const ModulatedResponse> problem;
  continuation::Guess guess;
};

/// That which leaves a response of these parameters, whose problem knows its stability, at a Neimark-Sacker
/// point as this parameter changes; none where none is found. Throws std::invalid_argument with the reason
/// where it cannot be followed.
std::optional<ModulatedStart> modulated_response(const SystemParameters& parameters,
                                                 const HarmonicProblem& response,
                                                 const continuation::Guess& at, Index parameter);

}  // namespace arcslip::problems
