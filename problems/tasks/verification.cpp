#include "arcslip/problems/tasks/verification.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include "arcslip/continuation/path/newton.hpp"
#include "arcslip/motion/swing.hpp"
#include "arcslip/problems/response/balanced_points.hpp"
#include "arcslip/problems/response/more_harmonics.hpp"
#include "arcslip/problems/response/power_balance.hpp"
#include "arcslip/time/ring_record.hpp"
#include "arcslip/time/ring_stability.hpp"

namespace arcslip::problems {
namespace {

using continuation::BranchPoint;
using continuation::Guess;
using continuation::PointType;

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// Special points and, between them, some of the others.
std::vector<std::size_t> chosen(const continuation::Branch& branch, const VerifyOptions& options) {
  std::vector<std::size_t> points;
  std::size_t special = 0;
  const std::size_t stride =
      std::max<std::size_t>(1, branch.points.size() / std::max<std::size_t>(1, options.samples));
  for (std::size_t i = 0; i < branch.points.size(); ++i) {
    const bool regular = branch.points[i].type == PointType::regular;
    if (regular ? i % stride == stride / 2 : special++ < options.most_special) points.push_back(i);
  }
  return points;
}

PowerBalance power(const HarmonicResponse& problem, const Guess& at) {
  return power_balance(problem, at.unknowns, at.parameters, at.regime);
}

double first_harmonic(const HarmonicResponse& problem, const Guess& at) {
  Vector values;
  problem.observe(at.unknowns, at.parameters, at.regime, values);
  return values(HarmonicResponse::Y);
}

/// The solution near a guess, or on the way from a high preload where Newton's method does not find one.
std::optional<Guess> solved(const HarmonicResponse& problem, Guess guess) {
  const continuation::Solution near = continuation::solve(problem, guess);
  if (near.outcome == continuation::Correction::converged) {
    guess.unknowns = near.unknowns;
    return guess;
  }
  try {
    return problem.guess(guess.parameters);
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

/// |y_1| of the ring's periodic motion nearest to the one that is given, and its largest Floquet multiplier;
/// NaN where it does not settle.
struct TimedResponse {
  double Y = none;
  double growth = none;
};

TimedResponse in_time(const Ring& ring, const HarmonicResponse& problem, const Guess& at) {
  constexpr double settled = 1e-9;
  const double eta = at.parameters(HarmonicResponse::eta);
  RingMotion motion(ring, eta, at.parameters(HarmonicResponse::preload));
  const SettledMotion found = shoot(motion, motion.travelling(contact_harmonics(problem, at)));
  if (!(found.error < settled)) return {};
  const double growth = floquet_stability(motion, found.state).growth();
  RingState state = found.state;
  HarmonicRecord record(motion, {1});
  motion.advance(state, motion.period(), &record);
  return {std::abs(record.base()(0)), growth};
}

/// The ring in full under the harmonics of its load up to a highest one, where it is one of rods or beams
/// that can be assembled.
std::optional<Ring> assembled(SystemParameters parameters, int highest) {
  parameters.harmonics = orders_up_to(highest, parameters);
  try {
    return build_ring(parameters);
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

}  // namespace

std::vector<ContactHarmonic> contact_harmonics(const HarmonicResponse& problem, const Guess& at) {
  const HarmonicResponse::ElementForces forces =
      problem.element_forces(at.unknowns, at.parameters, at.regime);
  const HarmonicVector r = problem.motion(at.unknowns, 0);
  const HarmonicVector friction = problem.element_force(0, at.unknowns, at.parameters, at.regime);
  const std::vector<int>& orders = problem.system().orders;
  std::vector<ContactHarmonic> harmonics;
  for (std::size_t a = 0; a < orders.size(); ++a)
    harmonics.push_back({orders[a], r(static_cast<Index>(a)), friction(static_cast<Index>(a)),
                         forces.base[a](0) - friction(static_cast<Index>(a)),
                         forces.damper[a](0) + friction(static_cast<Index>(a))});
  return harmonics;
}

std::optional<BalanceErrors> largest_errors(const SystemParameters& parameters,
                                            const std::vector<int>& orders,
                                            const continuation::Branch& branch,
                                            const std::function<bool()>& go_on) {
  BalanceErrors largest;
  const BalancedPoints known(parameters, orders, branch);
  for (const BranchPoint& point : branch.points) {
    if (go_on && !go_on()) return std::nullopt;
    const Guess at = known.at(point);
    const PowerBalance balance = power(known.problem(), at);
    largest.power = std::max(largest.power, balance.error());
    largest.cancellation = std::max(largest.cancellation, balance.cancellation());
    largest.motion =
        std::max(largest.motion, motion_error(known.problem(), at.unknowns, at.parameters, at.regime));
  }
  return largest;
}

std::vector<Verification> verify(const SystemParameters& parameters, const std::vector<int>& orders,
                                 const continuation::Branch& branch, const VerifyOptions& options) {
  const BalancedPoints known(parameters, orders, branch);
  const HarmonicResponse& problem = known.problem();
  const std::vector<int> wide =
      orders_up_to(std::min(2 * highest_order(orders) + 13, 2 * most_harmonics - 1), parameters);
  const int highest = highest_order(wide);
  const HarmonicResponse more = balanced(parameters, wide);
  std::optional<Ring> ring = options.in_time ? assembled(parameters, highest) : std::nullopt;
  std::vector<Verification> all;
  const std::vector<std::size_t> points = chosen(branch, options);
  for (const std::size_t i : points) {
    if (options.progress && !options.progress(all.size(), points.size())) break;
    const BranchPoint& point = branch.points[i];
    const Guess at = known.at(point);
    Verification one{i, first_harmonic(problem, at), power(problem, at).error(), highest, none, none, none};
    const std::optional<Guess> better = solved(more, carried(problem, at, more));
    if (better) one.Y_harmonics = first_harmonic(more, *better);
    if (ring && point.type != PointType::regular) {
      if (!parameters.varied.empty())
        ring = assembled(
            with_parameter(parameters, parameters.varied, point.parameters(HarmonicResponse::further)),
            highest);
      const TimedResponse timed = better ? in_time(*ring, more, *better) : in_time(*ring, problem, at);
      one.Y_time = timed.Y;
      one.growth = timed.growth;
    }
    all.push_back(one);
    if (options.found) options.found(one);
  }
  return all;
}

}  // namespace arcslip::problems
