#pragma once

// A system of one's own, given by formulas of unknowns u and parameters p:
//
//   flow       u' = f(u, p)      equilibria f = 0, stable where all eigenvalues of df/du have Re < 0
//   forced     u' = f(t, u, p)   cycles, see formula_field.hpp; here f at t = 0
//   map        u -> f(u, p)      f(f(... u)) - u = 0, stable where all multipliers have |mu| < 1
//   algebraic  f(u, p) = 0       without stability
//   boundary   u' = f(x, u, p)   with conditions, see formula_boundary.hpp
//   piecewise  u' = f_k(u, p)    up to a border, then k + 1, see formula_pieces.hpp
//
// Derivatives, the second ones too, are exact.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "arcslip/formulas/formula.hpp"
#include "arcslip/problems/library/library.hpp"

namespace arcslip::problems {

/// What the formulas are the right-hand side of.
enum class FormulaKind { flow, forced, map, algebraic, boundary, piecewise };

/// A number that formulas have by its name.
struct FormulaParameter {
  std::string name;        ///< a word
  double value = 0;        ///< finite
  std::string place = {};  ///< what messages call it; empty: its name
};

/// What a boundary value problem is on: its ends are formulas of parameters.
struct FormulaInterval {
  std::string variable;    ///< x
  Formula from;            ///< a
  Formula to;              ///< b
  std::string place = {};  ///< what messages call it; empty: the variable
};

/// A piece of what is piecewise.
struct FormulaPiece {
  std::string name;                     ///< a word
  std::vector<Formula> equations = {};  ///< those that it has of its own
  Formula until = {};                   ///< what vanishes at its end
  std::vector<Formula> reset = {};      ///< where unknowns jump to there
  std::string place = {};               ///< what messages call it; empty: its name
};

/// The system as it is written.
struct FormulaSystem {
  FormulaKind kind = FormulaKind::flow;           ///< of the equations
  int iterate = 1;                                ///< k of a map: the points that are fixed after k steps
  std::vector<FormulaParameter> parameters = {};  ///< in their order
  std::vector<Formula> equations = {};            ///< f by the names of the unknowns, in their order
  std::vector<Formula> definitions = {};          ///< of names that equations and observables use
  std::vector<Formula> observables = {};          ///< what is told beside the unknowns
  std::optional<Formula> period = {};             ///< of what depends on t, by parameters
  std::vector<std::string> angles = {};           ///< unknowns of which whole turns, 2 pi, do not matter
  std::vector<Formula> start = {};  ///< of unknowns, by parameters; 0 of those that are left out
  /// Typical magnitudes of unknowns and parameters, by their names; 1 of those that are left out.
  std::vector<FormulaParameter> scale = {};

  // of boundary value problems; start may have x here
  std::optional<FormulaInterval> interval = {};
  std::vector<Formula> conditions = {};  ///< g, by `u_left` and `u_right` of each unknown u and parameters
  std::vector<Formula> integrals = {};   ///< h
  std::vector<std::string> free = {};    ///< parameters that conditions set

  std::vector<FormulaPiece> pieces = {};
  std::vector<std::string> cycle = {};  ///< their names as they follow each other; empty: in their order
};

/// What a parameter that is continued from one value to the other is measured against, beside its own size:
/// as far as it goes where that is within a tenth of the longest step, else 1.
double magnitude_within(double from, double to);

/// Gives a parameter that is continued so its scale, if it has none.
void scale_within(FormulaSystem& system, const std::string& parameter, double from, double to);

/// Refuses names that mean two things. Throws FormulaError.
void check_names(const FormulaSystem& system);

/// Problem::scale of these unknowns and parameters: magnitudes, the typical ones where those are larger.
class FormulaScale {
 public:
  FormulaScale() = default;
  FormulaScale(const FormulaSystem& system, const std::vector<std::string>& unknowns,
               const std::vector<std::string>& parameters);

  void operator()(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const {
    unknowns = u.cwiseAbs().cwiseMax(unknowns_);
    parameters = p.cwiseAbs().cwiseMax(parameters_);
  }

 private:
  Vector unknowns_;
  Vector parameters_;
};

/// f alone, of the time t, the unknowns and the parameters, in this order: here formulas may have t. Throws
/// FormulaError.
Tape right_hand_side(const FormulaSystem& system);

/// The greatest `iterate`.
inline constexpr int most_iterates = 100;

/// The equations above. The unknowns are observables, then those that are given.
class FormulaProblem : public continuation::Problem {
 public:
  /// Throws FormulaError.
  explicit FormulaProblem(const FormulaSystem& system);

  Index size() const override { return equations_.results(); }
  std::vector<std::string> parameter_names() const override { return parameters_; }
  [[nodiscard]] bool evaluate(const Vector& u, const Vector& p, const continuation::Regime& regime,
                              const continuation::Evaluation& out) const override;
  [[nodiscard]] bool evaluate_columns(const Matrix& u, const Vector& p, Matrix* values, Matrix* by_unknowns,
                                      Matrix* by_parameters) const override;
  [[nodiscard]] bool second(const Vector& u, const Vector& p, const continuation::Regime& regime,
                            const Vector& w, const Vector& du, const Vector& dp, Vector& out) const override;
  [[nodiscard]] bool series(const Matrix& u, const Vector& p, const continuation::Regime& regime,
                            Matrix& out) const override;
  void scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const override {
    scale_(u, p, unknowns, parameters);
  }
  bool is_equilibrium() const override { return kind_ == FormulaKind::flow; }
  bool is_map() const override { return kind_ == FormulaKind::map; }
  std::vector<continuation::Observable> observables() const override;
  void observe(const Vector& u, const Vector& p, const continuation::Regime& regime,
               Vector& values) const override;
  double observe(const Vector& u, const Vector& p, const continuation::Regime& regime, Index which,
                 continuation::Gradient& gradient) const override;

  const FormulaSystem& system() const { return *system_; }

  /// Of a map: the points that are fixed after twice as many steps. Throws std::invalid_argument where these
  /// are more than `most_iterates`.
  FormulaProblem twice() const;

  /// F and dF/du at p over boxes of the unknowns; null where a formula has no enclosure.
  EnclosedMap enclosed(const Vector& p) const;

 private:
  std::shared_ptr<const FormulaSystem> system_;
  FormulaKind kind_;
  std::vector<std::string> unknowns_;
  std::vector<std::string> parameters_;
  std::vector<std::string> observables_;
  std::vector<std::string> angles_;
  FormulaScale scale_;
  Tape equations_;              // of u, p
  std::vector<Tape> observed_;  // of u, p, each by itself: one may have no value where others do
};

/// The guess of each unknown, by the parameters. Throws FormulaError.
Tape start_of(const FormulaSystem& system);

/// The system as a model like those of the library: its parameters are settings, its guess is `start`.
/// Throws FormulaError.
LibraryModel model_of(const FormulaSystem& system);

}  // namespace arcslip::problems
