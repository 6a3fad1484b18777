// Disturbances of responses that are not odd, against rings of masses in the plane marched node by node in
// small steps: friction with lift-off, stops on one side and contacts under a constant normal force.

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "arcslip/dense.hpp"
#include "arcslip/problems/response/floquet_response.hpp"
#include "arcslip/structure/spectrum.hpp"
#include "case_runs.hpp"
#include "catch.hpp"
#include "monodromy.hpp"
#include "plane_masses.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using problems::FloquetResponse;

namespace {

/// All nodes in time by small steps: positions, velocities, and the places of both sliders of each node.
class March {
 public:
  March(const Masses& s, double eta, int steps) : s_(s), w_(two_pi * eta), steps_(steps) {}

  Index size() const { return 6 * s_.nodes; }

  Vector period(Vector state) const {
    const double step = two_pi / w_ / steps_;
    for (int i = 0; i < steps_; ++i) {
      const double t = i * step;
      const Vector k1 = rate(t, state);
      const Vector k2 = rate(t + step / 2, state + step / 2 * k1);
      const Vector k3 = rate(t + step / 2, state + step / 2 * k2);
      const Vector k4 = rate(t + step, state + step * k3);
      state += step / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
      slide(state);
    }
    return state;
  }

  Matrix derivative(const Vector& state) const {
    constexpr double step = 1e-5;
    Matrix all(size(), size());
    for (Index i = 0; i < size(); ++i) {
      const Vector way = step * Vector::Unit(size(), i);
      all.col(i) = (period(state + way) - period(state - way)) / (2 * step);
    }
    return all;
  }

 private:
  double limit(const Vector& state, Index node, bool jenkins) const {
    if (jenkins) return s_.limit;
    return s_.friction * std::max(0.0, s_.press + s_.normal * state(2 * node + 1));
  }
  double spring(bool jenkins) const { return jenkins ? s_.contact : s_.tangential; }
  double force(const Vector& state, Index node, bool jenkins) const {
    const double most = limit(state, node, jenkins);
    const double stuck = spring(jenkins) * (state(2 * node) - state(slider(node, jenkins)));
    return std::clamp(stuck, -most, most);
  }
  Index slider(Index node, bool jenkins) const { return 4 * s_.nodes + 2 * node + (jenkins ? 1 : 0); }

  Vector rate(double t, const Vector& state) const {
    const Index n = s_.nodes;
    Vector all = Vector::Zero(size());
    all.head(2 * n) = state.segment(2 * n, 2 * n);
    const Vector felt = state.head(2 * n) + s_.damping * state.segment(2 * n, 2 * n);
    for (Index i = 0; i < n; ++i) {
      const Eigen::Vector2d x = felt.segment<2>(2 * i);
      Eigen::Vector2d push = -s_.stiffness * x;
      if (n > 1)
        push -= s_.coupling *
                (2 * x - felt.segment<2>(2 * ((i + 1) % n)) - felt.segment<2>(2 * ((i + n - 1) % n)));
      const double lag = two_pi * static_cast<double>(s_.wave_number * i) / static_cast<double>(n);
      push += (s_.load * std::polar(1.0, w_ * t - lag)).real();
      push(0) -= force(state, i, false) + (s_.contact > 0 ? force(state, i, true) : 0);
      push(1) -= std::max(0.0, s_.press + s_.normal * state(2 * i + 1)) - std::max(0.0, s_.press);
      push(1) -= s_.stop * std::max(0.0, state(2 * i + 1) - s_.gap);
      all.segment<2>(2 * n + 2 * i) = push;
    }
    return all;
  }

  void slide(Vector& state) const {
    for (Index i = 0; i < s_.nodes; ++i) {
      for (const bool jenkins : {false, true}) {
        if (spring(jenkins) == 0) continue;
        state(slider(i, jenkins)) = state(2 * i) - force(state, i, jenkins) / spring(jenkins);
      }
    }
  }

  Masses s_;
  double w_;
  int steps_;
};

/// The first point of the branch that was asked for.
struct Balanced {
  Balanced(const Masses& s, int highest, double eta)
      : input(read_case(folder.write("case.toml", text_of(s, folder, highest, eta)))),
        traced(std::move(trace(input.branches.front()).front())),
        problem(dynamic_cast<const FloquetResponse&>(*traced.base.disturbed)),
        at(traced.branch.points.front()) {
    for (const auto& one : problem.disturbances(at.unknowns, at.parameters, at.regime))
      found.push_back((one.is_negative ? -1.0 : 1.0) * std::exp(two_pi / eta * one.exponent));
  }

  /// Where the nodes are at t = 0 and how fast, each slider with its mass.
  Vector start(const Masses& s, double eta) const {
    const std::vector<int>& orders = problem.system().orders;
    Vector state = Vector::Zero(6 * s.nodes);
    for (Index i = 0; i < s.nodes; ++i) {
      const double lag = two_pi * static_cast<double>(s.wave_number * i) / static_cast<double>(s.nodes);
      for (Index dof = 0; dof < 2; ++dof) {
        const HarmonicVector y = -problem.motion(at.unknowns, dof);
        for (std::size_t a = 0; a < orders.size(); ++a) {
          const Complex one = y(static_cast<Index>(a)) * std::polar(1.0, -orders[a] * lag);
          state(2 * i + dof) += one.real();
          state(2 * (s.nodes + i) + dof) += std::real(Complex(0, two_pi * eta * orders[a]) * one);
        }
      }
      state.segment<2>(4 * s.nodes + 2 * i).setConstant(state(2 * i));
    }
    return state;
  }

  TemporaryFolder folder;
  Case input;
  TracedBranch traced;
  const FloquetResponse& problem;
  BranchPoint at;
  std::vector<Complex> found;
};

struct Compared {
  double motion;       ///< how far the marched motion is from the balanced one
  double multipliers;  ///< how far the worst one of `found` is from one of all nodes in time
  double growth;
  Index count;
};

Compared compared(const Masses& s, int highest, double eta, int steps, int rounds) {
  const Balanced balanced(s, highest, eta);
  const March march(s, eta, steps);
  Vector state = march.period(march.period(balanced.start(s, eta)));
  Matrix derivative;
  for (int round = 0; round < rounds; ++round) {
    derivative = march.derivative(state);
    const Vector error = march.period(state) - state;
    const Matrix away = Matrix::Identity(state.size(), state.size()) - derivative;
    state += shortest(away, error);
  }
  const Vector start = balanced.start(s, eta);
  const ComplexVector expected = spectrum(derivative);
  const ComplexVector found = larger_than(balanced.found, 1e-2);
  return {(state - start).head(4 * s.nodes).norm() / start.norm(), worst_match(found, expected),
          found.cwiseAbs().maxCoeff(), found.size()};
}

}  // namespace

TEST_CASE("Disturbances of a mass that lifts off are those of its motion in time", "[stability][whole]") {
  const double eta = GENERATE(0.13, 0.1598, 1.1 / two_pi);
  const Compared found = compared(Masses{}, 13, eta, 2000, 3);
  CAPTURE(eta, found.growth);
  CHECK(found.motion < 1e-3);
  CHECK(found.multipliers < 5e-3);  // of first order in the step of the march
  CHECK(found.count == 4);          // sliders forget themselves
}

TEST_CASE("So they are beside stops and contacts, in every wave round rings", "[stability][whole]") {
  struct Row {
    Index nodes, wave_number;
    int steps;
  };
  // Each kind of class: alone, of waves that are their own conjugates, and half a wave aside.
  const Row row = GENERATE(values<Row>({{1, 0, 2000}, {2, 0, 500}, {2, 1, 500}, {3, 1, 400}, {4, 2, 200}}));
  Masses s;
  s.nodes = row.nodes;
  s.wave_number = row.wave_number;
  s.coupling = row.nodes > 1 ? 0.15 : 0;
  s.stop = 0.7;
  s.contact = 0.4;
  const Compared found = compared(s, 11, 0.2, row.steps, 4);
  CAPTURE(row.nodes, row.wave_number, found.growth);
  CHECK(found.motion < 3e-3);
  CHECK(found.multipliers < 1e-2);
  CHECK(found.count == 4 * row.nodes);
}

TEST_CASE("A contact under a constant normal force has the exponents of one that is taken as odd",
          "[stability][whole]") {
  Masses s;
  s.stiffness(0, 1) = s.stiffness(1, 0) = 0;  // nothing closes
  s.load(1) = 0;
  s.normal = 0;
  const double eta = 0.15;
  const Balanced whole(s, 13, eta);
  const TemporaryFolder folder;
  std::string text = text_of(s, folder, 13, eta);
  const auto replace = [&](const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    text.replace(at, from.size(), to);
  };
  replace("contact_stiffness = [0, 0.0]", "contact_stiffness = [0.6, 0.0]");
  replace("limit_per_preload = [0.3, 1.0]", "limit_per_preload = [0.5, 1.0]");
  const std::size_t first = text.find("[[element]]");
  text.erase(first, text.find("[branch]") - first);
  const Case input = read_case(folder.write("odd.toml", text));
  const TracedBranch traced = std::move(trace(input.branches.front()).front());
  const BranchPoint& at = traced.branch.points.front();
  REQUIRE(traced.base.problem->describe(at.regime) != "stick");
  std::vector<Complex> odd;
  for (const auto& one : traced.base.disturbed->disturbances(at.unknowns, at.parameters, at.regime))
    odd.push_back(std::exp(two_pi / eta * one.exponent));
  const ComplexVector found = larger_than(whole.found, 1e-8);
  CHECK(found.size() >= 4);
  CHECK(worst_match(found, larger_than(odd, 1e-8)) < 1e-8);
}

TEST_CASE("Where a mass on a stop doubles its period a multiplier is -1 in time", "[stability][whole]") {
  Masses s;
  s.stiffness << 1, 0, 0, 1;
  s.damping = 0.02;
  s.load << 1, 1;
  s.normal = 0;  // what slides does so by itself
  s.stop = 4;
  s.gap = 0.1;
  const TemporaryFolder folder;
  std::string text = text_of(s, folder, 15, 0.34);
  text.replace(text.find("to = "), std::string::npos, "to = 0.36\nstability = true\n");
  const Case input = read_case(folder.write("case.toml", text));
  const TracedBranch traced = std::move(trace(input.branches.front()).front());
  const auto doubled = points(traced, PointType::period_doubling);
  REQUIRE(doubled.size() == 1);
  const double eta = doubled[0].parameters(0);
  CHECK(traced.branch.points.front().unstable == 0);
  CHECK(traced.branch.points.back().unstable == 1);
  const Balanced at(s, 15, eta);
  const March march(s, eta, 2000);
  const Vector state = march.period(march.period(at.start(s, eta)));
  const ComplexVector all = spectrum(march.derivative(state));
  CHECK((all.array() + 1.0).abs().minCoeff() < 2e-3);  // of the stop in 15 harmonics
  CHECK((larger_than(at.found, 0.1).array() + 1.0).abs().minCoeff() < 1e-6);
}
