#include "arcslip/continuation/cycles/torus_branch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "arcslip/continuation/cycles/multiplier_form.hpp"

namespace arcslip::continuation {
namespace {

// Of the scale: how far the first torus of a branch is from its cycle, and that which sets phases.
constexpr double first_size = 1e-3;
constexpr double shape_size = 1e-2;

/// A cycle on intervals, and what turns beside it.
class Departure {
 public:
  Departure(const CycleProblem& cycles, const BranchPoint& at) : point_{{}, at.parameters} {
    cycles_ = cycles.on_intervals(at.unknowns, at.parameters, at.regime, point_.unknowns);
    turning_ = turning_vector(*cycles_, point_);
  }

  bool exists() const { return turning_.has_value(); }
  double angle() const { return turning_->angle; }
  Index size() const { return cycles_->field().size(); }

  /// A torus about the cycle, and the guess that is nearest to it.
  std::shared_ptr<const Torus> torus(int waves_1, int waves_2, Guess& guess) const {
    const Index n = cycles_->field().size();
    const Index m_1 = 2 * waves_1 + 1;
    const Index m_2 = 2 * waves_2 + 1;
    const OrbitFrame& frame = cycles_->frame({});
    const Matrix real = cycles_->orbit(turning_->vector.real());
    const Matrix imaginary = cycles_->orbit(turning_->vector.imag());
    const Matrix orbit = cycles_->orbit(point_.unknowns);
    Matrix still(n, m_1 * m_2);
    Matrix change(n, m_1 * m_2);
    Vector place;
    Vector cosine;
    Vector sine;
    for (Index i = 0; i < m_1; ++i) {
      const double s = static_cast<double>(i) / static_cast<double>(m_1);
      frame.mesh.at(orbit, s, place, nullptr);
      frame.mesh.at(real, s, cosine, nullptr);
      frame.mesh.at(imaginary, s, sine, nullptr);
      for (Index j = 0; j < m_2; ++j) {
        const double turned =
            two_pi * static_cast<double>(j) / static_cast<double>(m_2) - turning_->angle * s;
        still.col(j * m_1 + i) = place;
        change.col(j * m_1 + i) = std::cos(turned) * cosine - std::sin(turned) * sine;
      }
    }
    const Vector in_units = frame.scale.cwiseInverse();
    change /= (in_units.asDiagonal() * change).cwiseAbs().maxCoeff();
    const double rate = two_pi / cycles_->duration(point_.unknowns, point_.parameters);
    auto problem = std::make_shared<const Torus>(
        cycles_->shared_field(),
        TorusGrid{waves_1, waves_2, cycles_->periods(), cycles_->winding(), still + shape_size * change},
        rate, point_.parameters);
    guess = {Vector::Zero(problem->size()), point_.parameters, {}, Vector::Zero(problem->size() + 1)};
    guess.unknowns.head(still.size()) = (still + first_size * change).reshaped();
    if (problem->size() > still.size() + 1) guess.unknowns(still.size()) = rate;
    guess.unknowns.tail(1).setConstant(rate * turning_->angle / two_pi);
    guess.direction.head(change.size()) = change.reshaped();
    return problem;
  }

  /// With how many waves the cycle itself is held as well as `tolerance` asks for.
  int waves(double tolerance) const {
    constexpr int least = 4;
    constexpr int most = 64;
    const OrbitFrame& frame = cycles_->frame({});
    for (int waves = least; waves < most; waves = waves * 3 / 2) {
      const OrbitMesh mesh(CollocationRule::trigonometric(waves), 1);
      const Matrix carried = frame.mesh.carried(cycles_->orbit(point_.unknowns), mesh);
      if (mesh.errors(carried, frame.range)(0) < tolerance) return waves;
    }
    return most;
  }

 private:
  Guess point_;
  std::shared_ptr<const CycleProblem> cycles_;
  std::optional<TurningVector> turning_;
};

/// Why a branch ends before its range does.
enum class Ending { none, told, first_tail, second_tail, phase };

class TorusTrace {
 public:
  TorusTrace(const Departure& from, const TraceOptions& options, const OrbitOptions& orbits,
             const Observer& observer)
      : from_(from), options_(unwatched(options)), orbits_(orbits), observer_(observer), time_(options) {
    options_.branch_point_pairs = false;
    options_.symmetries.clear();
  }

  TorusBranch run() {
    int waves_1 = from_.waves(orbits_.tolerance);
    int waves_2 = 4;
    while (true) {
      TorusBranch found = on_grid(waves_1, waves_2);
      int& waves = ending_ == Ending::first_tail ? waves_1 : waves_2;
      const bool is_coarse = ending_ == Ending::first_tail || ending_ == Ending::second_tail;
      if (!is_coarse) return found;
      waves = waves * 3 / 2;
      if (unknowns(waves_1, waves_2) <= most_unknowns) continue;
      refuse(found, fmt::format("a torus of {} x {} waves misses more than {:g} of what its unknowns do",
                                found.problem->waves(0), found.problem->waves(1), orbits_.tolerance));
      return found;
    }
  }

 private:
  static constexpr Index most_unknowns = 2500;  // their equations are solved as a full matrix
  static constexpr const char* name = "end of tori";

  Index unknowns(int waves_1, int waves_2) const {
    return from_.size() * (2 * waves_1 + 1) * (2 * waves_2 + 1);
  }

  TorusBranch on_grid(int waves_1, int waves_2) {
    constexpr double nothing = 0.03;  // of u_0; the first torus has a tenth
    Guess guess;
    const std::shared_ptr<const Torus> problem = from_.torus(waves_1, waves_2, guess);
    TraceOptions options = options_;
    options.max_seconds = time_.rest().max_seconds;
    options.events.push_back(
        {name, [problem](const Vector& u, const Vector& /*p*/, const Regime& /*regime*/) {
           return problem->apart(u) - nothing;
         }});
    options.stop_after.push_back({PointType::event, 1, name});
    ending_ = Ending::none;
    const Observer watching = [&](const BranchPoint& point) {
      ending_ = ending(*problem, point);
      return ending_ == Ending::none;
    };
    TorusBranch found{problem, trace_one_way(*problem, guess, true, options, watching)};
    if (ending_ == Ending::phase)
      refuse(found, "the phases of the torus are no longer told by those that it began with");
    if (found.branch.stop == Stop::requested && found.branch.points.back().label == name) shrink(found);
    return found;
  }

  Ending ending(const Torus& problem, const BranchPoint& point) const {
    constexpr double grip = 0.2;
    const double first_tail = problem.tail(point.unknowns, 0);
    const double second_tail = problem.tail(point.unknowns, 1);
    if (std::max(first_tail, second_tail) > orbits_.tolerance)
      return first_tail > second_tail ? Ending::first_tail : Ending::second_tail;
    if (problem.phase_grip(point.unknowns) < grip) return Ending::phase;
    return observer_ && !observer_(point) ? Ending::told : Ending::none;
  }

  std::string place(const TorusBranch& found) const {
    const BranchPoint& last = found.branch.points.back();
    return fmt::format(", at {} = {:.10g}", options_.parameter,
                       last.parameters(index_of(found.problem->parameter_names(), options_.parameter)));
  }

  void refuse(TorusBranch& found, const std::string& why) const {
    found.branch.stop = Stop::no_value;
    found.branch.explanation = why + place(found);
    found.branch.checkpoint.reset();
  }

  void shrink(TorusBranch& found) const {
    BranchPoint& last = found.branch.points.back();
    last.type = PointType::end;
    last.label.clear();
    found.branch.stop = Stop::left_regime;
    found.branch.explanation = "the torus shrinks onto a cycle" + place(found);
    found.branch.checkpoint.reset();
  }

  const Departure& from_;
  TraceOptions options_;
  const OrbitOptions& orbits_;
  const Observer& observer_;
  TimeBudget time_;
  Ending ending_ = Ending::none;
};

/// Whether a branch of tori has ended on this cycle.
bool ends_on(const TorusBranch& torus, const BranchPoint& cycle, double angle) {
  constexpr double near = 1e-3;  // they end short of it by the square of their size
  if (torus.branch.stop != Stop::left_regime) return false;
  const BranchPoint& end = torus.branch.points.back();
  const double turned =
      two_pi * torus.problem->omega_2(end.unknowns) / torus.problem->omega_1(end.unknowns, end.parameters);
  const Vector size = cycle.parameters.cwiseAbs().cwiseMax(near);
  return std::abs(std::cos(turned) - std::cos(angle)) < near &&
         (end.parameters - cycle.parameters).cwiseQuotient(size).lpNorm<Eigen::Infinity>() < near;
}

}  // namespace

std::optional<TorusBranch> trace_torus(const CycleProblem& cycles, const BranchPoint& leaving,
                                       const TraceOptions& options, const OrbitOptions& orbits,
                                       const Observer& observer) {
  const Departure from(cycles, leaving);
  if (!from.exists()) return std::nullopt;
  return TorusTrace(from, options, orbits, observer).run();
}

std::vector<TorusBranch> trace_tori_leaving(const std::vector<CycleBranch>& cycles,
                                            const TraceOptions& options, const OrbitOptions& orbits,
                                            const Observer& observer) {
  const TimeBudget time(options);
  std::vector<TorusBranch> found;
  for (const CycleBranch& one : cycles) {
    for (const BranchPoint& point : one.branch.points) {
      if (point.type != PointType::neimark_sacker) continue;
      if (!found.empty() && is_unfinished(found.back().branch.stop)) return found;
      const Departure from(*one.problem, point);
      const auto is_end = [&](const TorusBranch& torus) { return ends_on(torus, point, from.angle()); };
      if (!from.exists() || std::any_of(found.begin(), found.end(), is_end)) continue;
      found.push_back(TorusTrace(from, time.rest(), orbits, observer).run());
    }
  }
  return found;
}

}  // namespace arcslip::continuation
