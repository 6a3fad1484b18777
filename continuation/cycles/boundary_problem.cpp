#include "arcslip/continuation/cycles/boundary_problem.hpp"

#include "arcslip/continuation/cycles/orbit_observables.hpp"

namespace arcslip::continuation {

BoundaryProblem::BoundaryProblem(std::shared_ptr<const BoundaryField> field, const OrbitMesh& mesh,
                                 const Matrix& orbit, const Vector& p)
    : OrbitProblem(field, false), boundary_(std::move(field)) {
  begin(mesh, orbit, p);
}

double BoundaryProblem::given_duration(const Vector& p, Vector* by_parameters) const {
  if (by_parameters != nullptr) by_parameters->setZero(p.size());
  return 1;
}

Vector BoundaryProblem::times(const Vector& u, const Vector& p, const Regime& regime) const {
  const auto [first, last] = boundary_->interval(u.head(field().size()), p);
  return first + (last - first) * OrbitProblem::times(u, p, regime).array();
}

std::vector<Observable> BoundaryProblem::observables() const {
  std::vector<Observable> all;
  const std::vector<std::string> names = field().names();
  for (Index i = 0; i < boundary_->free(); ++i)
    all.push_back({names[static_cast<std::size_t>(told() + i)], true});
  for (const Observable& one : orbit_observables(*this)) all.push_back(one);
  for (Index i = 0; i < told(); ++i) {
    const std::string& name = names[static_cast<std::size_t>(i)];
    all.push_back({name + "_left", true});
    all.push_back({name + "_right", true});
  }
  return all;
}

/// Where among u the value of an unknown is at the left end, or at the right one.
Index BoundaryProblem::place_of(Index unknown, bool right) const {
  return unknown + (right ? field().size() * (nodes() - 1) : 0);
}

void BoundaryProblem::observe(const Vector& u, const Vector& /*p*/, const Regime& regime,
                              Vector& values) const {
  const Vector on_orbit = observed_on_orbit(*this, u, regime);
  const Index ends = boundary_->free() + on_orbit.size();
  values.resize(ends + 2 * told());
  values.head(ends) << u.segment(told(), boundary_->free()), on_orbit;
  for (Index i = 0; i < 2 * told(); ++i) values(ends + i) = u(place_of(i / 2, i % 2 == 1));
}

double BoundaryProblem::observe(const Vector& u, const Vector& /*p*/, const Regime& regime, Index which,
                                Gradient& gradient) const {
  gradient.unknowns.setZero();
  gradient.parameters.setZero();
  const Index on_orbit = which - boundary_->free();
  const Index at_end = on_orbit - (2 * told() + 1);
  if (on_orbit >= 0 && at_end < 0) return observed_on_orbit(*this, u, regime, on_orbit, gradient);
  const Index place = on_orbit < 0 ? told() + which : place_of(at_end / 2, at_end % 2 == 1);
  gradient.unknowns(place) = 1;
  return u(place);
}

OrbitStart boundary_start(const std::shared_ptr<const BoundaryField>& field,
                          const std::function<Vector(double s)>& guess, const Vector& p,
                          const OrbitOptions& options) {
  const OrbitMesh mesh(CollocationRule(options.degree), options.intervals);
  Matrix orbit(field->size(), mesh.nodes());
  for (Index node = 0; node < mesh.nodes(); ++node) orbit.col(node) = guess(mesh.place(node));
  return start_from(std::make_shared<BoundaryProblem>(field, mesh, orbit, p), orbit, 1, p);
}

}  // namespace arcslip::continuation
