#include "arcslip/problems/tasks/offset_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>

#include "arcslip/continuation/path/newton.hpp"
#include "arcslip/motion/swing.hpp"
#include "arcslip/problems/response/balanced_points.hpp"
#include "arcslip/problems/response/more_harmonics.hpp"

namespace arcslip::problems {
namespace {

using continuation::Guess;

constexpr Index few = 4;  // contacts, all of whose corners are visited

/// Which elements stick for ever with a force that may be another one.
std::vector<Index> sticking(const HarmonicResponse& problem, const Guess& at) {
  std::vector<Index> all;
  for (Index e = 0; e < problem.switch_count(); ++e) {
    if (!slips(at.regime, e) && problem.element(e).may_rest()) all.push_back(e);
  }
  return all;
}

/// Corners as parts of the way from the least force to the greatest, 0 or 1; NaN where the force stays.
std::vector<Vector> corners_of(Index contacts) {
  std::vector<Vector> all;
  if (contacts <= few) {
    for (int bits = 0; bits < 1 << contacts; ++bits) {
      Vector& corner = all.emplace_back(contacts);
      for (Index i = 0; i < contacts; ++i) corner(i) = (bits >> i) & 1;
    }
    return all;
  }
  for (const double side : {0.0, 1.0}) {
    all.push_back(Vector::Constant(contacts, side));
    for (Index i = 0; i < contacts; ++i) {
      Vector& corner = all.emplace_back(Vector::Constant(contacts, std::nan("")));
      corner(i) = side;
    }
  }
  return all;
}

/// The way from a response to a corner.
class OffsetPath {
 public:
  OffsetPath(const HarmonicResponse& problem, const Guess& start, const std::vector<Index>& elements)
      : problem_(problem), start_(start), elements_(elements), forces_(elements.size()) {
    const Index mean = place_of_mean(problem.system().orders);
    for (Index i = 0; i < forces_.size(); ++i)
      forces_(i) = problem
                       .element_force(elements_[static_cast<std::size_t>(i)], start.unknowns,
                                      start.parameters, start.regime)(mean)
                       .real();
  }

  /// Calls `take` with each response on the way; the reason why it ends before the corner, or "".
  template <class Take>
  std::string follow(const Vector& corner, const Take& take) const {
    constexpr int steps = 8;
    constexpr int most_rounds = 100;
    constexpr double settled = 1e-10;
    constexpr double largest = 20;  // share
    Guess guess = start_;
    Vector forces = forces_;
    std::unique_ptr<HeldResponse> held;  // not assignable itself
    for (int step = 1; step <= steps; ++step) {
      bool is_settled = false;
      Vector last;       // difference of the round before
      double share = 1;  // of it that forces change by, as two differences tell [Aitken]
      for (int round = 0; round < most_rounds && !is_settled; ++round) {
        double range = 0;
        const Vector wanted = wanted_forces(guess, corner, static_cast<double>(step) / steps, range);
        const Vector difference = wanted - forces;
        is_settled = round > 0 && difference.lpNorm<Eigen::Infinity>() <= settled * range;
        if (is_settled) break;
        if (round > 0) share *= -last.dot(difference - last) / (difference - last).squaredNorm();
        share = std::isfinite(share) ? std::clamp(share, -largest, largest) : 1;
        last = difference;
        forces += share * difference;
        HarmonicSystem system = problem_.system();
        for (Index i = 0; i < forces.size(); ++i)
          system.held[elements_[static_cast<std::size_t>(i)]] = forces(i);
        held = std::make_unique<HeldResponse>(HeldResponse{HarmonicResponse(std::move(system)), guess});
        const continuation::Solution found = continuation::solve(held->problem, guess);
        if (found.outcome != continuation::Correction::converged) return "Newton's method finds none there";
        guess.unknowns = found.unknowns;
        held->at = guess;
        if (held->problem.crossed_border(guess) >= 0)
          return "another contact begins to slip, or ceases to, on the way there";
      }
      if (!is_settled) return "the bounds of their forces do not settle";
      take(*held, step == steps);
    }
    return "";
  }

 private:
  /// So much of the way to the corner under the motion that there is.
  Vector wanted_forces(const Guess& guess, const Vector& corner, double part, double& range) const {
    Vector wanted = forces_;
    for (Index i = 0; i < wanted.size(); ++i) {
      const RestingForce bounds = problem_.resting_force(elements_[static_cast<std::size_t>(i)], guess);
      range = std::max(range, bounds.greatest - bounds.least);
      if (std::isnan(corner(i))) continue;
      const double end = corner(i) > 0.5 ? bounds.greatest : bounds.least;
      wanted(i) += part * (end - wanted(i));
    }
    return wanted;
  }

  const HarmonicResponse& problem_;
  const Guess& start_;
  const std::vector<Index>& elements_;
  Vector forces_;
};

/// Whether a column is a motion's.
bool is_motion(const std::string& name) {
  const bool is_of_one = name.size() == 1 || name[1] == '_';
  return is_of_one && (name[0] == 'R' || name[0] == 'Y' || name[0] == 'U') &&
         name.find("_over_") == name.npos;
}

std::vector<QuantityBounds> quantities_of(const HarmonicResponse& problem, const Guess& at) {
  Vector values;
  problem.observe(at.unknowns, at.parameters, at.regime, values);
  const auto names = problem.observables();
  std::vector<QuantityBounds> all;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double value = values(static_cast<Index>(i));
    if (is_motion(names[i].name)) all.push_back({names[i].name, value, value, value});
  }
  return all;
}

OffsetBounds unknown(std::vector<QuantityBounds> quantities, std::string reason) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  for (QuantityBounds& one : quantities) one.least = one.greatest = none;
  return {std::move(quantities), std::move(reason)};
}

/// Whether all but these are linear or forget the mean of their motion.
bool others_forget(const HarmonicResponse& problem, const Guess& at, const std::vector<Index>& held) {
  for (Index e = 0; e < problem.elements(); ++e) {
    const bool beyond = e < problem.switch_count() && slips(at.regime, e);
    const Element& element = problem.element(e);
    if (std::find(held.begin(), held.end(), e) == held.end() && !element.forgets_mean() &&
        !element.is_linear(beyond))
      return false;
  }
  return true;
}

}  // namespace

std::string follow_offsets(const HarmonicResponse& problem, const Guess& at,
                           const std::function<void(const HeldResponse&, bool is_corner)>& take) {
  const std::vector<Index> held = sticking(problem, at);
  const OffsetPath path(problem, at, held);
  std::string reason;
  for (const Vector& corner : corners_of(std::ssize(held))) {
    std::string why = path.follow(corner, take);
    if (reason.empty()) reason = std::move(why);
  }
  return reason;
}

std::optional<OffsetBounds> offset_bounds(const SystemParameters& parameters, const HarmonicResponse& problem,
                                          const Guess& at) {
  const std::vector<Index> held = sticking(problem, at);
  if (held.empty()) return std::nullopt;
  const std::vector<int>& orders = problem.system().orders;
  std::vector<QuantityBounds> told = quantities_of(problem, at);
  if (all_odd(orders) && others_forget(problem, at, held)) return OffsetBounds{std::move(told)};
  for (const Index e : held) {
    if (!problem.element(e).resting_force(orders, problem.element_motion(at.unknowns, at.parameters, e), 1))
      return unknown(told, "a contact that slides along two dofs may rest anywhere in a part of a plane");
  }
  try {
    std::optional<HarmonicSystem> varied;
    Guess here = at;
    here.parameters.conservativeResize(2);
    HarmonicSystem system = problem.system_at(at.parameters, varied);
    if (all_odd(orders)) {
      SystemParameters with_mean = parameters;
      with_mean.harmonics = orders_up_to(highest_order(orders), parameters.periods(), false);
      system = build_harmonic_system(with_mean);
      if (system.varied) system = at_value(system, at.parameters(HarmonicResponse::further));
    }
    const HarmonicResponse whole(std::move(system));
    if (whole.is_free_to_move())
      return unknown(told,
                     "friction alone holds the mean of a part, which no other force may be held against");
    const std::optional<Guess> start = solved_in(whole, problem, here);
    if (!start || start->regime != here.regime)
      return unknown(told, "the response is not found with the mean and even harmonics");
    told = quantities_of(whole, *start);
    const auto take = [&](const HeldResponse& response, bool /*is_corner*/) {
      const std::vector<QuantityBounds> there = quantities_of(response.problem, response.at);
      for (std::size_t i = 0; i < told.size(); ++i) {
        told[i].least = std::min(told[i].least, there[i].value);
        told[i].greatest = std::max(told[i].greatest, there[i].value);
      }
    };
    std::string reason = follow_offsets(whole, *start, take);
    return reason.empty() ? OffsetBounds{std::move(told)} : unknown(std::move(told), std::move(reason));
  } catch (const std::invalid_argument& error) {
    return unknown(std::move(told), error.what());
  }
}

}  // namespace arcslip::problems
