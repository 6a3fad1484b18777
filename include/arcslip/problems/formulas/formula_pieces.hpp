#pragma once

// A system of one's own that is put together of pieces:
//
//   u' = f_k(u, p) until h_k(u, p) = 0, then u = g_k(u, p) and the next piece
//
// With a period T(p) formulas have the time t: then t/T is an unknown more, of which whole turns do not
// matter.

#include "arcslip/continuation/cycles/piecewise_cycle.hpp"
#include "arcslip/problems/formulas/formula_field.hpp"

namespace arcslip::problems {

/// The equations above.
class FormulaPieces : public continuation::PiecewiseField {
 public:
  /// Of kind `piecewise`. Throws FormulaError.
  explicit FormulaPieces(const FormulaSystem& system);

  Index size() const override { return std::ssize(names_); }
  Index told() const override { return told_; }
  Index pieces() const override { return std::ssize(pieces_); }
  std::vector<std::string> names() const override { return names_; }
  std::vector<std::string> piece_names() const override { return piece_names_; }
  std::vector<std::string> parameter_names() const override { return parameters_; }
  [[nodiscard]] bool velocity(Index piece, const Vector& u, const Vector& p,
                              const continuation::FieldValues& out) const override;
  [[nodiscard]] bool border(Index piece, const Vector& u, const Vector& p,
                            const continuation::FieldValues& out) const override;
  [[nodiscard]] bool jump(Index piece, const Vector& u, const Vector& p,
                          const continuation::FieldValues& out) const override;
  void scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const override {
    scale_(u, p, unknowns, parameters);
  }
  double turn(Index unknown) const override { return turns_[static_cast<std::size_t>(unknown)]; }
  double time_at(const Vector& u, const Vector& p) const override;
  /// See problems::require_period; without one nothing is required.
  void require_period(const Vector& p) const {
    if (period_) problems::require_period(*period_, p);
  }

 private:
  struct Piece {
    Tape rates;  // of 0, u, p, as the others
    Tape until;
    Tape reset;
  };
  const Piece& piece(Index i) const { return pieces_[static_cast<std::size_t>(i)]; }

  Index told_;
  std::vector<std::string> names_;
  std::vector<double> turns_;
  std::vector<std::string> parameters_;
  FormulaScale scale_;
  std::optional<Tape> period_;  // of p
  std::vector<std::string> piece_names_;
  std::vector<Piece> pieces_;
};

}  // namespace arcslip::problems
