#include "arcslip/continuation/cycles/mesh_watch.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "arcslip/continuation/cycles/cycle_problem.hpp"
#include "arcslip/continuation/path/corrector.hpp"
#include "carrier.hpp"

namespace arcslip::continuation {

bool may_be_finer(const OrbitProblem& problem, const OrbitOptions& orbits) {
  const auto* cycles = dynamic_cast<const CycleProblem*>(&problem);
  const Index periods = cycles == nullptr ? 1 : cycles->periods();
  return 2 * problem.resolution() <=
         (problem.is_trigonometric() ? periods * orbits.most_waves : orbits.most_intervals);
}

bool MeshWatch::serves(const BranchPoint& point) {
  constexpr double grip = 0.5;
  const Vector& u = point.unknowns;  // of which orbits are the first ones, be it on a curve or not
  const double apart_grip = orbits_.note_apart(u, point.regime);
  if (point.type == PointType::branch_point) singular_ = point.arclength;
  if (point.arclength == singular_ || point.type == PointType::event) return true;  // which may be the end
  return orbits_.mesh_error(u, point.regime) <= options_.tolerance &&
         orbits_.phase_grip(u, point.regime) > grip && apart_grip > grip && !is_lopsided(point);
}

/// Whether there is a mesh with a symmetry that this one lacks.
bool MeshWatch::is_lopsided(const BranchPoint& point) const {
  if (point.type == PointType::start) return false;  // which may be a branch point
  const OrbitFrame& frame = orbits_.frame(point.regime);
  const Matrix orbit = orbits_.orbit(point.unknowns);
  return frame.mesh.is_lopsided(orbit, range_on(frame, orbit)) &&
         is_good_for(frame, orbit, new_mesh(frame, orbit, MeshSymmetry::nearly));
}

BasePoint MeshWatch::of_orbits(const CurvePoint& point) const {
  if (curve_ == nullptr) return {point.unknowns, point.parameters, point.regime, {}};
  return curve_->split(point.unknowns, point.parameters, point.regime);
}

OrbitMesh MeshWatch::new_mesh(const OrbitFrame& frame, const Matrix& orbit, MeshSymmetry symmetry) const {
  return frame.mesh.equidistributed(orbit, range_on(frame, orbit), orbits_.resolution(), symmetry);
}

bool MeshWatch::is_good_for(const OrbitFrame& frame, const Matrix& orbit, const OrbitMesh& mesh) const {
  // or the next point would ask again; a finer mesh starts all over, which takes long where it is large
  const double margin = orbits_.field().sparse() ? 0.5 : 0.3;
  const Vector errors = mesh.errors(frame.mesh.carried(orbit, mesh), range_on(frame, orbit));
  return !(errors.maxCoeff() > margin * options_.tolerance);
}

/// A frame for an orbit, and whether its mesh is good enough; none where it is not and has few intervals: it
/// may be too coarse.
std::optional<Regime> MeshWatch::renewed(const BasePoint& at, bool& is_good) const {
  constexpr Index many = 100;
  const OrbitFrame& frame = orbits_.frame(at.regime);
  const Matrix orbit = orbits_.orbit(at.unknowns);
  OrbitMesh mesh = new_mesh(frame, orbit, MeshSymmetry::nearly);
  is_good = is_good_for(frame, orbit, mesh);
  if (!is_good) {
    mesh = new_mesh(frame, orbit, MeshSymmetry::none);
    is_good = is_good_for(frame, orbit, mesh);
  }
  if (!is_good && orbits_.resolution() < many) return std::nullopt;
  return orbits_.add_frame(mesh, frame.mesh.carried(orbit, mesh), at.parameters);
}

/// Whether a point has the signs that are known of it.
bool MeshWatch::agrees(const CurvePoint& point, const Signs& signs) const {
  const auto differs = [](int known, double value) { return known * sign_of(value) < 0; };
  if (differs(signs.parameter, point.tangent(point.tangent.size() - 1))) return false;
  Vector functions(std::ssize(traced().test_types()));
  traced().test(point.unknowns, point.parameters, point.regime, functions);
  for (Index i = 0; i < functions.size(); ++i) {
    if (differs(signs.functions[static_cast<std::size_t>(i)], functions(i))) return false;
  }
  ComplexVector eigenvalues;
  return signs.unstable < 0 ||
         !traced().eigenvalues(point.unknowns, point.parameters, point.regime, eigenvalues) ||
         (eigenvalues.real().array() > 0).count() == signs.unstable;
}

/// Where both frames have multipliers far from -1 and differ in how many are below it, one of them errs: what
/// grows by decades within an interval has no sign there, and no period doubling lies in between.
void MeshWatch::take_far_signs(const CurvePoint& before, const CurvePoint& after, Signs& signs) const {
  constexpr double far = 0.5;  // of 1, which it is where all are far smaller or larger than 1
  if (curve_ != nullptr) return;
  const std::vector<PointType> types = orbits_.test_types();
  Vector old(std::ssize(types));
  Vector now(std::ssize(types));
  orbits_.test(after.unknowns, after.parameters, after.regime, now);  // whose multipliers are at hand
  orbits_.test(before.unknowns, before.parameters, before.regime, old);
  for (Index i = 0; i < now.size(); ++i) {
    const auto which = static_cast<std::size_t>(i);
    if (types[which] == PointType::period_doubling && std::min(std::abs(old(i)), std::abs(now(i))) > far)
      signs.functions[which] = sign_of(now(i));
  }
}

/// Whether a new frame can wait for one more point: signs that are all rounding would put it off for ever.
bool MeshWatch::can_wait() {
  constexpr int most = 3;
  waits_ = waits_ < most ? waits_ + 1 : 0;
  return waits_ > 0;
}

/// Chooses what belongs to a point of special orbits, there.
bool MeshWatch::adapt(const CurvePoint& point) {
  return curve_ == nullptr || curve_->adapt(of_orbits(point));
}

/// A point with its tangent in another frame, corrected where that can be done.
bool MeshWatch::carry(const Carrier& carrier, const Regime& regime, Corrector& corrector, CurvePoint& point) {
  const Vector raw = carrier(point.tangent.cwiseProduct(point.scale));
  point.unknowns = carrier(point.unknowns);
  point.regime = regime;
  corrector.set_scale(point);
  point.tangent = raw.cwiseQuotient(point.scale).normalized();
  const CurvePoint origin = point;
  if (!adapt(point) || corrector.correct(point, origin, origin.tangent, 0, true) != Correction::converged) {
    point = origin;
    return false;
  }
  corrector.set_tangent(point, origin);
  return true;
}

/// Carries a point to a frame that is good enough for its orbit; false if there is none. What intervals much
/// longer than a layer have made of this comes right on shorter ones, which then tell where they are to lie.
bool MeshWatch::settle(Corrector& corrector, CurvePoint& point) {
  constexpr int most = 4;
  bool is_good = false;
  for (int tries = 0; tries < most && !is_good; ++tries) {
    const std::optional<Regime> regime = renewed(of_orbits(point), is_good);
    if (!regime || !carry(Carrier(orbits_, point.regime, *regime), *regime, corrector, point)) return false;
  }
  return is_good;
}

bool MeshWatch::renew(Branch& branch, const TraceOptions& options) {
  Progress& progress = *branch.checkpoint->ahead;
  Corrector corrector(traced(), index_of(traced().parameter_names(), options.parameter),
                      {.tolerance = options.tolerance});
  CurvePoint here = progress.here;
  if (!settle(corrector, here)) return false;
  const Regime regime = here.regime;
  const Carrier of_here(orbits_, progress.here.regime, regime);
  Bends bends = progress.bends;
  for (Vector& bend : bends.derivatives)
    bend = of_here(bend.cwiseProduct(progress.here.scale)).cwiseQuotient(here.scale);
  if (curve_ != nullptr) progress.rescaled = 1;
  if (!agrees(here, progress.signs) && can_wait()) return adapt(progress.here);
  take_far_signs(progress.here, here, progress.signs);
  if (!start_) start_ = progress.start;
  progress.here = here;
  progress.bends = bends;
  progress.start = *start_;
  Carrier of_start(orbits_, progress.start.regime, regime);
  of_start.turn_to(progress.start.unknowns, here.unknowns);
  carry(of_start, regime, corrector, progress.start);
  progress.past.clear();
  return adapt(here);
}

void MeshWatch::give_up(Branch& branch, const std::string& parameter) const {
  if (may_be_finer(orbits_, options_)) throw TooCoarse{};
  branch.stop = Stop::no_value;
  branch.explanation = fmt::format(
      "an orbit of {} {} misses more than {:g} of what its unknowns do, at {} = {:.10g}",
      orbits_.resolution(), orbits_.is_trigonometric() ? "waves" : "intervals", options_.tolerance, parameter,
      branch.points.back().parameters(index_of(traced().parameter_names(), parameter)));
}

}  // namespace arcslip::continuation
