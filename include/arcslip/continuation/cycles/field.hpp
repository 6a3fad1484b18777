#pragma once

// What moves along an orbit:
//
//   u' = f(t, u, p)
//
// with n unknowns u and named parameters p.

#include <memory>
#include <string>
#include <vector>

#include "arcslip/continuation/problem/problem.hpp"

namespace arcslip::continuation {

/// What `Field::evaluate` is asked for; a null is not wanted. Every target comes with its size.
struct FieldValues {
  Vector* velocity = nullptr;                  ///< f, n
  Matrix* by_unknowns = nullptr;               ///< df/du, n x n
  Matrix* by_parameters = nullptr;             ///< df/dp, n x (number of parameters)
  Vector* by_time = nullptr;                   ///< df/dt, n; asked of fields with a period alone
  SparseMatrix* sparse_by_unknowns = nullptr;  ///< df/du of a sparse field, compressed, always of one pattern
};

/// The same at several places, side by side.
struct FieldColumns {
  Matrix* velocity = nullptr;       ///< n x places
  Matrix* by_unknowns = nullptr;    ///< n x (n places)
  Matrix* by_parameters = nullptr;  ///< n x (number of parameters times places)
  Matrix* by_time = nullptr;        ///< n x places
};

/// All functions are called from several threads and must not change the field.
class Field {
 public:
  virtual ~Field() = default;

  virtual Index size() const = 0;                                ///< n
  virtual std::vector<std::string> names() const = 0;            ///< of the unknowns
  virtual std::vector<std::string> parameter_names() const = 0;  ///< in the order in which `p` holds them

  /// Fills what is asked for, with exact derivatives. False where the field has no value.
  [[nodiscard]] virtual bool evaluate(double t, const Vector& u, const Vector& p,
                                      const FieldValues& out) const = 0;

  /// The same at several times and places, the columns of u, of a field that is not sparse: one after the
  /// other, unless there is a faster way.
  [[nodiscard]] virtual bool evaluate_columns(const Vector& times, const Matrix& u, const Vector& p,
                                              const FieldColumns& out) const;

  /// w^T d/dh [df/du  df/dp](u + h du, p + h dp) at h = 0, n + number of parameters entries. False where the
  /// field does not give it: then differences take its place.
  [[nodiscard]] virtual bool second(double /*t*/, const Vector& /*u*/, const Vector& /*p*/,
                                    const Vector& /*w*/, const Vector& /*du*/, const Vector& /*dp*/,
                                    Vector& /*out*/) const {
    return false;
  }

  /// f along a curve at fixed time and parameters, as Problem::series has it.
  [[nodiscard]] virtual bool series(double /*t*/, const Matrix& /*u*/, const Vector& /*p*/,
                                    Matrix& /*out*/) const {
    return false;
  }

  /// Of an unknown of which values that differ by this are the same, as of an angle; else 0.
  virtual double turn(Index /*unknown*/) const { return 0; }

  /// Whether `evaluate` fills `sparse_by_unknowns` in place of `by_unknowns`.
  virtual bool sparse() const { return false; }

  /// Whether it depends on time, with a period.
  virtual bool is_periodic() const { return false; }
  /// This period, and where that is not null its derivatives by the parameters.
  virtual double period(const Vector& /*p*/, Vector* /*by_parameters*/) const { return 0; }

  /// Typical magnitudes, as Problem::scale has them.
  virtual void scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const {
    unknowns = u.cwiseAbs().cwiseMax(1);
    parameters = p.cwiseAbs().cwiseMax(1);
  }
};

/// The field of which a problem's solutions are the equilibria. The observables of the problem that are
/// its unknowns in their order name these and tell which are angles; else they are u1, u2, ...
class EquilibriumField : public Field {
 public:
  /// Throws std::invalid_argument of a problem that has no equilibria or has several regimes.
  explicit EquilibriumField(std::shared_ptr<const Problem> problem);

  const Problem& problem() const { return *problem_; }

  Index size() const override { return problem_->size(); }
  std::vector<std::string> names() const override { return names_; }
  std::vector<std::string> parameter_names() const override { return problem_->parameter_names(); }
  bool sparse() const override { return problem_->sparse(); }
  double turn(Index unknown) const override {
    return turns_.empty() ? 0 : turns_[static_cast<std::size_t>(unknown)];
  }
  [[nodiscard]] bool evaluate(double t, const Vector& u, const Vector& p,
                              const FieldValues& out) const override;
  [[nodiscard]] bool evaluate_columns(const Vector& times, const Matrix& u, const Vector& p,
                                      const FieldColumns& out) const override;
  [[nodiscard]] bool series(double /*t*/, const Matrix& u, const Vector& p, Matrix& out) const override {
    return problem_->series(u, p, {}, out);
  }
  [[nodiscard]] bool second(double t, const Vector& u, const Vector& p, const Vector& w, const Vector& du,
                            const Vector& dp, Vector& out) const override;
  void scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const override {
    problem_->scale(u, p, unknowns, parameters);
  }

 private:
  std::shared_ptr<const Problem> problem_;
  std::vector<std::string> names_;
  std::vector<double> turns_;
};

}  // namespace arcslip::continuation
