#pragma once

// Meshes that follow the orbits of a branch, or of a curve of special ones.

#include <limits>
#include <optional>
#include <string>

#include "arcslip/continuation/cycles/orbit_branch.hpp"
#include "arcslip/continuation/path/watch.hpp"
#include "arcslip/continuation/points/extended_problem.hpp"

namespace arcslip::continuation {

class Carrier;

/// Thrown where a finer mesh is needed and there may be one.
struct TooCoarse {};

bool may_be_finer(const OrbitProblem& problem, const OrbitOptions& orbits);

/// How far along a branch, or a curve, the frame of its last point serves. On a branch point it has to:
/// others cannot be corrected there.
class MeshWatch {
 public:
  /// Both are kept by reference, and so is the problem of a curve of special orbits.
  MeshWatch(const OrbitProblem& orbits, const OrbitOptions& options, ExtendedProblem* curve = nullptr)
      : orbits_(orbits), options_(options), curve_(curve) {}

  bool serves(const BranchPoint& point);

  /// Puts a branch on a mesh that fits where it stands; false if no mesh of this resolution does. It may stay
  /// on its own for a while where the other one has a special point, which lies elsewhere there, be it by
  /// 1e-8, on the other side of it: that would be told twice.
  bool renew(Branch& branch, const TraceOptions& options);

  /// Ends a branch for which no mesh is fine enough; throws TooCoarse where there may be one.
  void give_up(Branch& branch, const std::string& parameter) const;

 private:
  const Problem& traced() const { return curve_ != nullptr ? static_cast<const Problem&>(*curve_) : orbits_; }
  BasePoint of_orbits(const CurvePoint& point) const;
  bool is_lopsided(const BranchPoint& point) const;
  OrbitMesh new_mesh(const OrbitFrame& frame, const Matrix& orbit, MeshSymmetry symmetry) const;
  bool is_good_for(const OrbitFrame& frame, const Matrix& orbit, const OrbitMesh& mesh) const;
  std::optional<Regime> renewed(const BasePoint& at, bool& is_good) const;
  bool agrees(const CurvePoint& point, const Signs& signs) const;
  void take_far_signs(const CurvePoint& before, const CurvePoint& after, Signs& signs) const;
  [[nodiscard]] bool adapt(const CurvePoint& point);
  bool carry(const Carrier& carrier, const Regime& regime, Corrector& corrector, CurvePoint& point);
  [[nodiscard]] bool settle(Corrector& corrector, CurvePoint& point);
  bool can_wait();

  const OrbitProblem& orbits_;
  const OrbitOptions& options_;
  ExtendedProblem* curve_;
  double singular_ = std::numeric_limits<double>::quiet_NaN();  // where the last branch point is
  int waits_ = 0;
  std::optional<CurvePoint> start_;  // what a branch began with, on the mesh that it began on
};

}  // namespace arcslip::continuation
