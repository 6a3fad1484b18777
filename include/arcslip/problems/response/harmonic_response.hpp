#pragma once

// Forced response of base and damper in several harmonics, with elements in the coordinates x of their
// interface, see coordinates.hpp: in each x_i the force K_i f_i(x), K_i the element's reference stiffness:
//
//   x_h + C_h(eta) K f_h(x) = x0_h,   C_h at (h eta, h a),   K = diag(K_i).
//
// Where an element or the load is not odd under half a period, even harmonics are among them, and the mean h
// = 0, the static state: C_0 is the static compliance, and x_0 has an imaginary part that the equation makes
// 0; what is free to move is held by the elements alone, see rigid_motions.hpp. Solved is f_h + (1 + C_h
// K)^{-1} (x_h - f_h - x0_h) = 0 relative to |x| and to sqrt(1 + |(1 + C_h K)^{-1}|^2): where the contacts
// stick, the error of x itself, however much larger C_h K is for their common motion than for their
// differences. The first coordinates are the relative motions r = u - y of m contacts: u_h from the forces on
// the damper, y_h = u_h - r_h.
//
// Unknowns: Re x_1, Im x_1, Re x_3, ... in the order of the system's of the first coordinate, then of the
// next. Parameters: eta, P. Regimes: which contacts slip, bit i for contact i; borders: the amplitude A_i =
// max |r_i(t)| is S_i. That a slipping contact slips once more in a period, or once less, is no border: the
// engine crosses such a corner as it finds it.

#include "arcslip/continuation/path/trace.hpp"
#include "arcslip/problems/response/harmonic_problem.hpp"

namespace arcslip::problems {

class HarmonicJacobian;

/// The equations above.
class HarmonicResponse : public HarmonicProblem {
 public:
  /// Positions of eta, P and, if it may be continued, a further parameter of the system.
  enum Parameter : Index { eta, preload, further };
  /// Observables in this order: those of the first contact in the first harmonic but for `dissipated`, which
  /// is the energy of all, over k S^2, and T_max and slip of friction: the greatest force in a period and the
  /// part of it in which it slips; R_contact_2, R_over_S_contact_2, Y_contact_2, U_contact_2,
  /// dissipated_contact_2, ... of each further contact; the outputs; what elements tell; then, of the first
  /// contact, the greatest values in time R_peak, Y_peak, U_peak and the amplitudes R_h3, Y_h3, U_h3, ...
  enum Quantity : Index { R, S, R_over_S, Y, U, beta, alpha, psi, dissipated, T_max, slip };

  /// Of up to so many unknowns the Jacobian is a matrix, of more of a whole ring it is condensed. Throws
  /// std::invalid_argument where base, damper and contacts differ in number.
  explicit HarmonicResponse(HarmonicSystem system, Index matrix_up_to = 100);

  std::vector<std::string> parameter_names() const override { return names_with_varied({"eta", "P"}); }
  [[nodiscard]] bool evaluate(const Vector& u, const Vector& p, const continuation::Regime& regime,
                              const continuation::Evaluation& out) const override;
  std::unique_ptr<continuation::CondensedJacobian> condensed_jacobian() const override;
  /// The loops' second derivatives are exact, one-sided where a slip begins; what else F consists of is
  /// smooth and differentiated by differences.
  [[nodiscard]] bool second(const Vector& u, const Vector& p, const continuation::Regime& regime,
                            const Vector& w, const Vector& du, const Vector& dp, Vector& out) const override;
  void scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const override;

  /// Resonances of base, damper and the stuck whole, and the stuck damper's antiresonances, in each harmonic.
  std::vector<double> landmarks(Index parameter, double from, double to) const override;

  /// Of a whole ring: shifts round it and mirrors, each with the time by which its load is then later.
  std::vector<continuation::Symmetry> symmetries() const override;

  /// The solution at (eta, P) on the branch that begins where all contacts stick: under a high preload or,
  /// where other elements act, under a small force. Throws std::invalid_argument where that cannot be traced,
  /// Unfinished where max_seconds or go_on of the limits end it.
  continuation::Guess guess(const Vector& parameters, const continuation::TraceOptions& limits = {}) const;

  /// At the system's own value of its further parameter, if it has one.
  continuation::Guess guess(double eta_value, double preload_value,
                            const continuation::TraceOptions& limits = {}) const;

  /// The system at these parameters; `varied` holds it where it is not the problem's own.
  const HarmonicSystem& system_at(const Vector& p, std::optional<HarmonicSystem>& varied) const {
    return is_varied() ? varied.emplace(at_value(system_, p(further))) : system_;
  }

  /// x_h of a coordinate, of the unknowns.
  HarmonicVector motion(const Vector& u, Index coordinate) const;

  /// S of a contact.
  double slip_threshold(Index contact, const Vector& p) const {
    return HarmonicProblem::slip_threshold(contact, {}, p);
  }

  /// f_h of an element.
  HarmonicVector element_force(Index element, const Vector& u, const Vector& p,
                               const continuation::Regime& regime) const {
    return forces(u, p, regime, false)[at(element)].harmonics;
  }

  /// What the elements do to base and damper.
  struct ElementForces {
    std::vector<ContactVector> base;    ///< of each harmonic, the forces on its contact dofs
    std::vector<ContactVector> damper;  ///< the same
    double energy;                      ///< lost per cycle in all elements
    ContactVector base_moved = {};      ///< its contact dofs by rigid motions, in the mean; empty without
    ContactVector damper_moved = {};    ///< the same
    double drag = 0;                    ///< lost per cycle as drifts meet the damping of masses
  };
  /// At a solution.
  ElementForces element_forces(const Vector& u, const Vector& p, const continuation::Regime& regime) const;

 private:
  class LoadPath;
  [[nodiscard]] bool evaluate(const Vector& u, const Vector& p, const continuation::Regime& regime,
                              double share, const continuation::Evaluation& out) const;
  std::optional<continuation::Guess> reached(const continuation::Problem& path,
                                             const continuation::Guess& start, Index parameter, double to,
                                             const continuation::TraceOptions& limits) const;
  std::optional<continuation::Guess> under_load(const continuation::Guess& guess, double part,
                                                const continuation::TraceOptions& limits, double& stuck,
                                                std::string& why) const;
  double take_small(continuation::Guess& stuck, double share) const;

  /// One harmonic of F, weight (f + (1 + C_h K)^{-1} (x - f - x0)) but for |x|.
  struct Order {
    Index which;
    Vector stiffness;         // K
    ContactReceptance joint;  // 1 + C_h K in place of C_h, and -x0, 0 above the first
    ContactMatrix by_varied;  // derivatives of 1 + C_h K and -x0 by the further parameter
    ContactVector free_by_varied;
    ContactMatrix inverse;   // (1 + C_h K)^{-1}, at rest its limit as rigid motions meet no stiffness
    ContactMatrix bordered;  // by rigid motions: [1 + C_0 K, S; S^H K, 0]^{-1}, whose first block it is
    double weight;           // 1/sqrt(1 + |inverse|^2), of a whole ring see set_weight
    ContactVector driven;    // of a whole ring inverse -x0
    Coordinates::Each each;  // work space
    ContactVector f, gap, held, residual;
    ContactMatrix product, turned;

    /// What is solved with.
    const ContactMatrix& solver() const { return bordered.size() > 0 ? bordered : inverse; }
  };
  void set_order(Index which, const Vector& p, const continuation::Regime& regime, Order& order) const;
  void set_weight(Order& order) const;
  double weight_slope(Order& order, const ContactMatrix& compliance, const ContactVector& free) const;
  void set_varied(Order& order, double frequency_value, const Vector& p) const;
  void border_by_rigid(Order& order, const Vector& p) const;
  [[nodiscard]] bool remembers_mean(const std::vector<ElementForce>& elements, const Vector& p,
                                    const continuation::Regime& regime) const;
  ComplexMatrix drag(const Vector& p) const;
  /// Work space of a thread: F and what its derivatives by the unknowns consist of.
  struct Rows {
    Order order;
    Vector residual;
    Vector weight;      // of each order, over |r|
    ComplexMatrix own;  // derivative by f: orders x pairs of coordinates, that of the column first
    ComplexVector sum;  // of the f of a coordinate by Re x_h and Im x_h of one
    ComplexVector difference;
    Matrix drifts;                          // onto those that go on; of size 0 where nothing is free to move
    ComplexVector drag;                     // on each rigid motion, of what damps masses
    Matrix by_drag;                         // of the mean's rows by the drifts of coordinates, through that
    HarmonicJacobian* condensed = nullptr;  // which is filled in place of `own`, if there is one
  };
  void take_drifts(Order& order, const Vector& u, const Vector& p, Rows& rows) const;
  void set_drifts(const Vector& u, Rows& rows, Matrix* jacobian) const;
  void fill_rows(const std::vector<ElementForce>& elements, double share, const Vector& u, const Vector& p,
                 const continuation::Regime& regime, Rows& rows, Matrix* parameter_jacobian) const;
  void fill_order(Order& order, const std::vector<ElementForce>& elements, double share, const Vector& u,
                  const Vector& p, Rows& rows, Matrix* parameter_jacobian) const;
  void fill_by_parameters(Order& order, const std::vector<ElementForce>& elements, double share,
                          const Vector& p, const Rows& rows, Matrix& parameter_jacobian) const;
  void add_linear_part(Order& order, const ContactMatrix& compliance, const ContactVector& free, double share,
                       double weight) const;
  void set_change(const ElementForce& element, Index from, Index to, Index order, Rows& rows) const;
  void fill_condensed(Rows& rows, const std::vector<ElementForce>& elements, const Vector& u,
                      const continuation::Regime& regime) const;
  void fill_jacobian(Rows& rows, const std::vector<ElementForce>& elements, const Vector& u,
                     const continuation::Regime& regime, Matrix& jacobian) const;

  /// Whether the force in a coordinate is K x, be it under small motions alone.
  bool is_linear(const continuation::Regime& regime, Index coordinate) const {
    const Index e = coordinates_.element_of(coordinate);
    return coordinates_.element(e).is_linear(slips(regime, e));
  }
  void add_outputs_in_time();
  std::optional<SparseMatrix> image_map(const std::function<Index(Index)>& image, double turns) const;
  [[nodiscard]] bool goes_with(const SparseMatrix& map) const;
  std::vector<double> ring_landmarks(double from, double to) const;
  bool is_odd_;         ///< whether all harmonics are odd
  Index matrix_up_to_;  ///< unknowns

  /// Whether there is a response at these parameters.
  bool has_value(const Vector& p) const {
    return p(eta) > 0 && p(preload) > 0 && (!is_varied() || system_.varied->allows(p(further))) &&
           pressing({}, p) > 0;
  }
};

}  // namespace arcslip::problems
