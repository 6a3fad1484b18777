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
  std::vector<Observable> all = orbit_observables(*this);
  const std::vector<std::string> names = field().names();
  for (Index i = 0; i < told(); ++i) {
    const std::string& name = names[static_cast<std::size_t>(i)];
    all.push_back({name + "_left", true});
    all.push_back({name + "_right", true});
  }
  for (Index i = told(); i < told() + boundary_->free(); ++i)
    all.push_back({names[static_cast<std::size_t>(i)], true});
  return all;
}

/// Among u: that of an observable which is one of its entries, counted from the first such one.
Index BoundaryProblem::place_of(Index which) const {
  if (which >= 2 * told()) return which - told();
  return which / 2 + (which % 2 == 0 ? 0 : field().size() * (nodes() - 1));
}

void BoundaryProblem::observe(const Vector& u, const Vector& /*p*/, const Regime& regime,
                              Vector& values) const {
  const Vector on_orbit = observed_on_orbit(*this, u, regime);
  const Index entries = 2 * told() + boundary_->free();
  values.resize(on_orbit.size() + entries);
  values.head(on_orbit.size()) = on_orbit;
  for (Index i = 0; i < entries; ++i) values(on_orbit.size() + i) = u(place_of(i));
}

double BoundaryProblem::observe(const Vector& u, const Vector& /*p*/, const Regime& regime, Index which,
                                Gradient& gradient) const {
  gradient.unknowns.setZero();
  gradient.parameters.setZero();
  const Index on_orbit = 2 * told() + 1;
  if (which < on_orbit) return observed_on_orbit(*this, u, regime, which, gradient.unknowns);
  const Index place = place_of(which - on_orbit);
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
