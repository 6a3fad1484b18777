#include "arcslip/problems/tasks/verification.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

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

/// The solution in more harmonics near a point, or on the way from a high preload where that is not found.
std::optional<Guess> solved_in_more(const HarmonicResponse& more, const HarmonicResponse& problem,
                                    const Guess& at) {
  if (auto near = solved_in(more, problem, at)) return near;
  try {
    return more.guess(at.parameters);
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

/// |y_1| of the ring's periodic motion nearest to the one that is given, and its largest Floquet multiplier.
struct TimedResponse {
  double Y = none;
  double growth = none;
};

/// Throws std::runtime_error where it is not found.
TimedResponse in_time(const Ring& ring, const HarmonicResponse& problem, const Guess& at) {
  constexpr double settled = 1e-9;
  constexpr double sought = 1e-11;
  const double eta = at.parameters(HarmonicResponse::eta);
  RingMotion motion(ring, eta, at.parameters(HarmonicResponse::preload));
  const SettledMotion found = shoot(motion, motion.travelling(ring_harmonics(problem, at)), sought);
  if (!(found.error < settled)) throw std::runtime_error("the motion does not settle");
  const double growth = floquet_stability(motion, found.state).growth();
  HarmonicRecord record(motion, {ring.periods}, true);
  next_state(motion, found.state, &record);
  return {std::abs(record.base()(0)), growth};
}

/// The ring in full under the harmonics of its load up to a highest one, or the reason why it has none or
/// some of its motions were not found.
class AllNodes {
 public:
  AllNodes(const SystemParameters& parameters, int highest) : parameters_(parameters) {
    parameters_.harmonics = orders_up_to(highest, parameters);
    if (parameters.varied.empty()) assemble(parameters_);
  }

  const std::string& reason() const { return reason_; }

  /// Y_1 and growth from a response on; NaN where there is no ring or it is not found.
  TimedResponse at(const HarmonicResponse& problem, const Guess& at) {
    if (problem.drifts(at.regime)) {
      reason_ = "a part that drifts has no periodic motion in time";
      return {};
    }
    if (!parameters_.varied.empty())
      assemble(with_parameter(parameters_, parameters_.varied, at.parameters(HarmonicResponse::further)));
    if (!ring_) return {};
    try {
      return in_time(*ring_, problem, at);
    } catch (const std::runtime_error& error) {
      reason_ = error.what();
      return {};
    }
  }

 private:
  void assemble(const SystemParameters& parameters) {
    ring_.reset();
    try {
      ring_ = build_ring(parameters);
    } catch (const std::invalid_argument& error) {
      reason_ = error.what();
    }
  }

  SystemParameters parameters_;
  std::optional<Ring> ring_;
  std::string reason_;
};

}  // namespace

std::vector<RingHarmonic> ring_harmonics(const HarmonicResponse& problem, const Guess& at) {
  const Index coordinates = problem.coordinates();
  const Index orders = problem.harmonics();
  std::vector<RingHarmonic> harmonics;
  for (const int order : problem.system().orders)
    harmonics.push_back({order, ComplexVector(coordinates), ComplexVector(coordinates)});
  Index c = 0;
  for (Index element = 0; c < coordinates; ++element) {
    const HarmonicVector force = problem.element_force(element, at.unknowns, at.parameters, at.regime);
    for (Index part = 0; part * orders < force.size(); ++part, ++c) {
      const HarmonicVector x = problem.motion(at.unknowns, c);
      for (Index a = 0; a < orders; ++a) {
        harmonics[static_cast<std::size_t>(a)].motion(c) = x(a);
        harmonics[static_cast<std::size_t>(a)].force(c) = force(part * orders + a);
      }
    }
  }
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
  std::optional<AllNodes> ring;
  if (options.in_time) ring.emplace(parameters, highest);
  std::vector<Verification> all;
  const std::vector<std::size_t> points = chosen(branch, options);
  for (const std::size_t i : points) {
    if (options.progress && !options.progress(all.size(), points.size())) break;
    const BranchPoint& point = branch.points[i];
    const Guess at = known.at(point);
    Verification one{i,
                     first_harmonic(problem, at),
                     power(problem, at).error(),
                     highest / parameters.periods(),
                     none,
                     none,
                     none};
    const std::optional<Guess> better = solved_in_more(more, problem, at);
    if (better) one.Y_harmonics = first_harmonic(more, *better);
    if (ring && point.type != PointType::regular) {
      const TimedResponse timed = better ? ring->at(more, *better) : ring->at(problem, at);
      one.Y_time = timed.Y;
      one.growth = timed.growth;
    }
    one.offsets = offset_bounds(parameters, problem, at);
    all.push_back(one);
    if (options.found) options.found(one);
  }
  if (ring && !ring->reason().empty() && options.refused) options.refused(ring->reason());
  return all;
}

}  // namespace arcslip::problems
