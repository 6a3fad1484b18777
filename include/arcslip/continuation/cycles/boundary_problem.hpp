#pragma once

// Boundary value problems
//
//   u' = f(s, u, p),  0 <= s <= 1,    g(u(0), u(1), p) = 0
//
// with n unknowns u and n conditions g. What is put otherwise is brought to this form by further unknowns: a
// parameter that a condition more sets free is an unknown with q' = 0, an integral that a condition sets one
// with v' = h(s, u, p) and v(0) = 0 [U. Ascher, R. D. Russell, SIAM Rev. 23 (1981) 238].

#include <functional>
#include <utility>

#include "arcslip/continuation/cycles/orbit_branch.hpp"

namespace arcslip::continuation {

/// What there is to solve.
class BoundaryField : public Field {
 public:
  /// g and its derivatives. False where it has no value.
  [[nodiscard]] virtual bool end_conditions(const Vector& left, const Vector& right, const Vector& p,
                                            const EndConditions& out) const = 0;

  /// What s runs over: its name in tables and, at s = 0 and 1, its values for unknowns u there.
  virtual std::string place_name() const { return "s"; }
  virtual std::pair<double, double> interval(const Vector& /*u*/, const Vector& /*p*/) const {
    return {0, 1};
  }

  /// How many unknowns, from the first on, are told; and how many after these are parameters that are free.
  virtual Index told() const { return size(); }
  virtual Index free() const { return 0; }
};

/// Unknowns: see OrbitProblem. Observables: the free parameters; those of orbits; the values of each unknown
/// at both ends, `x_left` and `x_right`.
class BoundaryProblem : public OrbitProblem {
 public:
  /// Begins with a frame for this orbit, all of the field's unknowns at the nodes of the mesh.
  BoundaryProblem(std::shared_ptr<const BoundaryField> field, const OrbitMesh& mesh, const Matrix& orbit,
                  const Vector& p);

  std::shared_ptr<OrbitProblem> about(const OrbitMesh& mesh, const Matrix& orbit,
                                      const Vector& p) const override {
    return std::make_shared<BoundaryProblem>(boundary_, mesh, orbit, p);
  }
  Vector times(const Vector& u, const Vector& p, const Regime& regime) const override;
  std::string time_name() const override { return boundary_->place_name(); }
  Index told() const override { return boundary_->told(); }
  bool may_rest() const override { return true; }

  std::vector<Observable> observables() const override;
  void observe(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const override;
  double observe(const Vector& u, const Vector& p, const Regime& regime, Index which,
                 Gradient& gradient) const override;

 protected:
  [[nodiscard]] bool end_conditions(const Vector& left, const Vector& right, const Vector& p,
                                    const EndConditions& out) const override {
    return boundary_->end_conditions(left, right, p, out);
  }
  Matrix part_apart(const OrbitFrame& /*frame*/, const Eigen::Ref<const Matrix>& /*orbit*/) const override {
    return {};
  }
  double given_duration(const Vector& p, Vector* by_parameters) const override;

 private:
  Index place_of(Index unknown, bool right) const;

  std::shared_ptr<const BoundaryField> boundary_;
};

/// One close to values of the unknowns at places s.
OrbitStart boundary_start(const std::shared_ptr<const BoundaryField>& field,
                          const std::function<Vector(double s)>& guess, const Vector& p,
                          const OrbitOptions& options = {});

}  // namespace arcslip::continuation
