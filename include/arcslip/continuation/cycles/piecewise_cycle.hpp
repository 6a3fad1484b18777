#pragma once

// Periodic orbits put together of pieces, each with a field of its own that holds up to a border, where the
// next one takes over, after a jump or without:
//
//   u_k' = T_k f_k(u_k, p),   h_k(u_k(1), p) = 0,   u_(k+1)(0) = g_k(u_k(1), p),   k = 1 .. K, then 1 again
//
// over 0 <= s <= 1: one boundary value problem for all pieces, the times T_k among its unknowns. Multipliers
// are those of the return map from border to border, by the transfers X_k of the pieces and how each border
// turns them [M. di Bernardo, C. Budd, A. Champneys, P. Kowalczyk, Piecewise-smooth Dynamical Systems,
// Springer 2008, ch. 2]:
//
//   dg_k/du (1 - f_k dh_k/du / (dh_k/du f_k)) X_k

#include "arcslip/continuation/cycles/orbit_branch.hpp"
#include "arcslip/continuation/cycles/periodic_orbit.hpp"

namespace arcslip::continuation {

/// The pieces in the order in which they follow each other. All functions are called from several threads.
class PiecewiseField {
 public:
  virtual ~PiecewiseField() = default;

  virtual Index size() const = 0;                            ///< n
  virtual Index pieces() const = 0;                          ///< K
  virtual Index told() const { return size(); }              ///< how many of the unknowns, from the first on
  virtual std::vector<std::string> names() const = 0;        ///< of the unknowns
  virtual std::vector<std::string> piece_names() const = 0;  ///< all different
  virtual std::vector<std::string> parameter_names() const = 0;  ///< in the order in which `p` holds them

  /// f_k, n; h_k, one value; g_k, n: each as the `velocity` of what is asked for. False where there is no
  /// value.
  [[nodiscard]] virtual bool velocity(Index piece, const Vector& u, const Vector& p,
                                      const FieldValues& out) const = 0;
  [[nodiscard]] virtual bool border(Index piece, const Vector& u, const Vector& p,
                                    const FieldValues& out) const = 0;
  [[nodiscard]] virtual bool jump(Index piece, const Vector& u, const Vector& p,
                                  const FieldValues& out) const = 0;

  /// Of an unknown of which values that differ by this are the same; else 0.
  virtual double turn(Index /*unknown*/) const { return 0; }

  /// The time, of a period from 0 on, at a point of the motion; 0 where equations have none in them.
  virtual double time_at(const Vector& /*u*/, const Vector& /*p*/) const { return 0; }

  virtual void scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const {
    unknowns = u.cwiseAbs().cwiseMax(1);
    parameters = p.cwiseAbs().cwiseMax(1);
  }
};

/// The same pieces twice, those of the second round with names of their own.
std::shared_ptr<const PiecewiseField> two_rounds_of(std::shared_ptr<const PiecewiseField> once);

/// Unknowns: see OrbitProblem; at each node those of all pieces, then the T_k. Observables: T; each T_k as
/// `T_` and the piece's name; the largest and the smallest value of each told unknown on all pieces, `x_max`
/// and `x_min`. A branch ends where a piece vanishes, or meets its border before it ends, and one of those
/// that are `doubled` where they come to be two rounds of one of half the period.
class PiecewiseCycle : public PeriodicOrbit {
 public:
  /// Begins with a frame for this orbit, n K + K values at the nodes.
  PiecewiseCycle(std::shared_ptr<const PiecewiseField> pieces, const OrbitMesh& mesh, const Matrix& orbit,
                 const Vector& p, bool doubled = false);

  std::shared_ptr<OrbitProblem> about(const OrbitMesh& mesh, const Matrix& orbit,
                                      const Vector& p) const override {
    return std::make_shared<PiecewiseCycle>(pieces_, mesh, orbit, p, doubled_);
  }
  bool joins_rounds(Index row, Index column) const override {
    return row >= n_ * (count_ - 1) && row < n_ * count_ && column < n_;
  }
  double period(const Vector& u, const Vector& /*p*/) const override {
    return u.segment(n_ * count_, count_).sum();
  }
  OrbitMesh mesh_of_two(const OrbitMesh& once) const override { return once; }
  Matrix two_rounds(const Matrix& once, double sign) const override;
  std::shared_ptr<OrbitProblem> doubled(const OrbitMesh& mesh, const Matrix& orbit,
                                        const Vector& p) const override;
  Index told() const override { return n_ * count_; }
  std::vector<std::string> told_names() const override;
  Matrix told_orbit(const Vector& u) const override;
  Vector times(const Vector& u, const Vector& p, const Regime& regime) const override;

  /// Of each piece: that it lasts, then that it meets its border at its end alone.
  int border_count(const Regime& /*regime*/) const override { return 2 * static_cast<int>(count_); }
  double border(const Vector& u, const Vector& p, const Regime& regime, int border,
                Gradient* gradient) const override;
  std::optional<Regime> regime_beyond(const Regime& /*regime*/, int /*border*/) const override {
    return std::nullopt;
  }
  std::string reason_of_end() const override {
    return "a piece vanishes there, or meets its border before its end";
  }

  std::vector<Observable> observables() const override;
  void observe(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const override;
  double observe(const Vector& u, const Vector& p, const Regime& regime, Index which,
                 Gradient& gradient) const override;

 protected:
  [[nodiscard]] bool end_conditions(const Vector& left, const Vector& right, const Vector& p,
                                    const EndConditions& out) const override;
  Matrix part_apart(const OrbitFrame& frame, const Eigen::Ref<const Matrix>& orbit) const override;
  double given_duration(const Vector& p, Vector* by_parameters) const override;
  ComplexVector multipliers_by(const Vector& u, const Vector& p, const Regime& regime,
                               const FactoredJacobian& jacobian) const override;
  Index most_multipliers() const override { return n_ - 1; }

 private:
  auto lasts(const Vector& u) const { return u.segment(n_ * count_, count_); }  // T_k
  double early_meeting(const Vector& u, const Vector& p, const Regime& regime, Index piece,
                       Gradient* gradient) const;

  std::shared_ptr<const PiecewiseField> pieces_;
  Index n_;
  Index count_;  // K
  bool doubled_;
  Vector winding_;  // n, the whole turns of angles in a period
};

/// The motion from `u` on, which begins with the first piece, once it has come to repeat itself: after a
/// time, by default of two hundred pieces. Throws std::invalid_argument that says why there is none.
OrbitStart settled_pieces(const std::shared_ptr<const PiecewiseField>& pieces, const Vector& u,
                          const Vector& p, std::optional<double> time, const OrbitOptions& options = {});

}  // namespace arcslip::continuation
