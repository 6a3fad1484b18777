// Parts that are free to move, whose mean the elements alone hold: against motions in time, the limit of weak
// springs to ground, and differences.

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "arcslip/continuation/path/newton.hpp"
#include "arcslip/continuation/problem/derivative_check.hpp"
#include "arcslip/elements/idle.hpp"
#include "arcslip/elements/memoryless.hpp"
#include "arcslip/problems/response/harmonic_response.hpp"
#include "arcslip/problems/response/power_balance.hpp"
#include "branches.hpp"
#include "catch.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using continuation::Branch;
using continuation::BranchPoint;
using continuation::Guess;
using continuation::PointType;
using problems::HarmonicResponse;

namespace {

std::vector<int> up_to(int highest) {
  std::vector<int> orders{1, 0};
  for (int h = 2; h <= highest; ++h) orders.push_back(h);
  return orders;
}

/// k max(0, x - g), g < 0, from rest.
std::shared_ptr<const Element> stop(double stiffness, double gap) {
  constexpr double endless = std::numeric_limits<double>::infinity();
  return std::make_shared<MemorylessElement>(
      PiecewiseLaw({{gap, {stiffness * gap}}, {endless, {0.0, stiffness}}}, true), stiffness);
}

/// m x'' + c x' + k x under these phasors of the load, m = 1.
ContactModes mass(double stiffness, double damping, const Complex& load) {
  const double eta = std::sqrt(stiffness) / two_pi;
  return {1, {{eta, ContactVector::Constant(1, 1 / two_pi), load / two_pi}}, {.mass = damping / two_pi}};
}

/// A free mass that rubs on ground under 1.2 cos t + 1.5 cos(2t + 1).
HarmonicSystem rubbing_mass(int highest, double damping) {
  HarmonicSystem system;
  system.orders = up_to(highest);
  for (const int h : system.orders) {
    system.base.push_back(mass(0, damping, h == 1 ? 1.2 : h == 2 ? std::polar(1.5, 1.0) : 0.0));
    system.damper.emplace_back(1, std::vector<ContactMode>{}, Loss{});
  }
  system.contacts = {{0.5, 1.0}};
  return system;
}

/// Base and damper with two contacts each, on springs to ground of which the lowest modes have this
/// frequency.
HarmonicSystem pair(int highest, double held, double limit) {
  HarmonicSystem system;
  system.orders = up_to(highest);
  const auto shape = [](double a, double b) { return ContactVector(Eigen::Vector2cd(a, b) / two_pi); };
  for (const int h : system.orders) {
    const double load = h == 1 ? 1 / two_pi : 0;
    system.base.push_back(
        {2,
         {{held, shape(0.8, 0.8), load}, {0.21, shape(0.9, -0.7), 0.4 * load}, {0.6, shape(0.4, 0.5), 0}},
         {.viscous = 0.3}});
    system.damper.push_back({2, {{held, shape(1.1, 1.1), 0}, {0.35, shape(-0.6, 0.9), 0}}, {.viscous = 0.2}});
  }
  system.contacts = {{0.5, limit}, {0.4, limit}};
  system.others.push_back({1, 0, 1, stop(0.8, -0.3)});
  system.others.push_back({0, 1, 0, cubic_spring(0.3, 1)});
  return system;
}

/// The same whose damper the first contact alone holds.
HarmonicSystem loose_pair(int highest, double limit) {
  HarmonicSystem system = pair(highest, 0, limit);
  system.contacts[1] = {0, never_slips};
  system.others.pop_back();
  return system;
}

double value(const HarmonicResponse& problem, const Guess& at, const std::string& name) {
  Vector values;
  problem.observe(at.unknowns, at.parameters, at.regime, values);
  return values(index_of(continuation::observable_names(problem), name));
}

/// What the system is refused with.
template <class Make>
std::string refused(const Make& make) {
  try {
    make();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "nothing";
}

double worst_derivative(const HarmonicResponse& problem, const Guess& at) {
  return continuation::check_derivatives(problem, at.unknowns, at.parameters, at.regime).worst;
}

}  // namespace

TEST_CASE("A mass that friction alone holds drifts as it does in time", "[free]") {
  // r = -x; without harmonics left out v = 0.430633
  const std::vector<std::pair<int, double>> expected{{4, 0.4306183}, {8, 0.4306295}, {16, 0.4306321}};
  for (const auto& [highest, drift] : expected) {
    const HarmonicResponse problem(rubbing_mass(highest, 0.05));
    const Guess at = problem.guess(1 / two_pi, 1);
    CAPTURE(highest);
    CHECK(problem.drifts(at.regime));
    CHECK_THAT(value(problem, at, "drift"), WithinAbs(drift, 1e-7));
    CHECK(worst_derivative(problem, at) < 1e-6);
    CHECK(problems::power_balance(problem, at.unknowns, at.parameters, at.regime).error() < 1e-10);
  }
}

TEST_CASE("A drift begins where friction that holds alone begins to slip on one side", "[free]") {
  const HarmonicResponse problem(rubbing_mass(6, 0));
  const Branch branch = trace(problem, problem.guess(1 / two_pi, 4), over("P", 4, 0.8));
  CAPTURE(branch.explanation);
  REQUIRE(branch.complete());
  const std::vector<BranchPoint> begins = of_type(branch, PointType::regime_switch);
  REQUIRE(begins.size() == 1);
  // stuck, (k - h^2) r_h = -F_h, as far as it goes to either side of its middle
  double far = 0;
  for (int i = 0; i < 100000; ++i) {
    const double t = two_pi * i / 1e5;
    far = std::max(far, std::abs(1.2 * std::cos(t) / 0.5 + 1.5 * std::cos(2 * t + 1) / 3.5));
  }
  CHECK_THAT(begins[0].parameters(1), WithinRel(far, 1e-8));
  for (const BranchPoint& point : branch.points) {
    const Guess at{point.unknowns, point.parameters, point.regime, {}};
    CHECK((value(problem, at, "drift") != 0) == (point.parameters(1) < begins[0].parameters(1)));
    CHECK(std::abs(problem.element_force(0, at.unknowns, at.parameters, at.regime)(1)) < 1e-9);
  }
}

TEST_CASE("A free mass on a stop moves as it does in time, with its mean", "[free][numbers]") {
  // m = 1, c = 0.1, a stop k = 1 with the gap -0.8, cos(0.4 pi t); figures of an integration in time
  HarmonicSystem system;
  system.orders = up_to(16);
  for (const int h : system.orders) {
    system.base.push_back(mass(0, 0.1, h == 1 ? 1 : 0));
    system.damper.emplace_back(1, std::vector<ContactMode>{}, Loss{});
  }
  system.contacts = {{0, never_slips}};
  system.others.push_back({1, 0, 0, stop(1, -0.8)});
  const HarmonicResponse problem(system);
  const Guess at = problem.guess(0.2, 1);
  CHECK_THAT(value(problem, at, "Y"), WithinAbs(1.2990344, 1e-5));
  CHECK_THAT(value(problem, at, "Y_h0"), WithinAbs(-0.1308057, 1e-5));
  CHECK_THAT(value(problem, at, "Y_h2"), WithinAbs(0.0308236, 1e-5));
  CHECK(worst_derivative(problem, at) < 1e-6);
}

TEST_CASE("What is free to move is the limit of weak springs to ground", "[free][numbers]") {
  const HarmonicResponse free(pair(5, 0, 0.9));
  for (const double eta : {0.12, 0.2}) {
    const Guess at = free.guess(eta, 1);
    CAPTURE(eta, free.describe(at.regime));
    const auto held = [&](double frequency) {
      const HarmonicResponse problem(pair(5, frequency, 0.9));
      const continuation::Solution solved = continuation::solve(problem, at);
      REQUIRE(solved.outcome == continuation::Correction::converged);
      const Guess beside{solved.unknowns, at.parameters, at.regime, {}};
      return [=](const char* name) { return value(problem, beside, name); };
    };
    const auto weak = held(1e-3);
    const auto weaker = held(5e-4);
    for (const char* name :
         {"Y", "U", "R_contact_2", "Y_h0", "U_h0", "Y_h0_contact_2", "Y_h2", "dissipated"}) {
      const double limit = (4 * weaker(name) - weak(name)) / 3;  // stiffness goes with the frequency squared
      CHECK_THAT(value(free, at, name), WithinAbs(limit, 1e-6));
    }
    CHECK(worst_derivative(free, at) < 1e-6);
    CHECK(problems::power_balance(free, at.unknowns, at.parameters, at.regime).error() < 1e-10);
    CHECK(problems::motion_error(free, at.unknowns, at.parameters, at.regime) < 1e-10);
  }
}

TEST_CASE("Quantities of free and of drifting parts have exact gradients", "[free]") {
  for (const HarmonicSystem& system : {pair(3, 0, 0.6), loose_pair(3, 0.2)}) {
    const HarmonicResponse problem(system);
    const Guess at = problem.guess(0.2, 1);
    CAPTURE(problem.describe(at.regime));
    CHECK(worst_derivative(problem, at) < 1e-6);
    CHECK(problems::motion_error(problem, at.unknowns, at.parameters, at.regime) < 1e-9);
    const std::vector<std::string> names = continuation::observable_names(problem);
    for (const char* name : {"Y_h0", "U_h0", "U_h0_contact_2", "dissipated", "U_peak", "drift"}) {
      if (std::find(names.begin(), names.end(), name) == names.end()) continue;
      const Index which = index_of(names, name);
      continuation::Gradient gradient{Vector::Zero(problem.size()), Vector::Zero(2)};
      problem.observe(at.unknowns, at.parameters, at.regime, which, gradient);
      // along the branch over eta
      Matrix jacobian(problem.size(), problem.size());
      Matrix by(problem.size(), 2);
      continuation::Evaluation out;
      out.jacobian = &jacobian;
      out.parameter_jacobian = &by;
      REQUIRE(problem.evaluate(at.unknowns, at.parameters, at.regime, out));
      const Vector slope = -jacobian.partialPivLu().solve(by.col(0));
      const double h = 1e-6;
      double ends[2];
      for (const int side : {0, 1}) {
        Guess near = at;
        near.parameters(0) += side == 0 ? -h : h;
        near.unknowns += (side == 0 ? -h : h) * slope;
        const continuation::Solution solved = continuation::solve(problem, near);
        REQUIRE(solved.outcome == continuation::Correction::converged);
        near.unknowns = solved.unknowns;
        ends[side] = value(problem, near, name);
      }
      CAPTURE(name);
      const double rate = gradient.unknowns.dot(slope) + gradient.parameters(0);
      CHECK_THAT((ends[1] - ends[0]) / (2 * h), WithinRel(rate, 1e-4) || WithinAbs(rate, 1e-5));
    }
  }
}

TEST_CASE("Means that nothing holds are refused in one line", "[free]") {
  HarmonicSystem pushed = rubbing_mass(2, 0);
  pushed.contacts = {{0, never_slips}};
  pushed.base[1] = mass(0, 0, 0.1);
  CHECK_THAT(refused([&] { HarmonicResponse problem(pushed); }), ContainsSubstring("the mean of the load"));
  // two contacts that hold the damper together
  HarmonicSystem together = pair(3, 0, 0.05);
  together.others.pop_back();
  const std::string why = refused([&] { static_cast<void>(HarmonicResponse(together).guess(0.2, 1)); });
  CHECK_THAT(why, ContainsSubstring("elements alone hold the mean of base and damper"));
}
