// What leaves a response where its half periods come to differ or its period doubles, against motions in
// time: Duffing's oscillator by a Runge-Kutta method of its own, rings and contacts by that of all nodes.

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include "arcslip/problems/response/harmonic_response.hpp"
#include "arcslip/problems/tasks/verification.hpp"
#include "case_runs.hpp"
#include "case_texts.hpp"

namespace arcslip::testing::departures {

using problems::HarmonicResponse;

namespace {

/// x'' + 0.2 x' + x + x^3 = F cos 1.4 t; the contact sticks, half of the spring.
std::string duffing(const std::string& harmonics, double from, double to, const std::string& branch) {
  return fmt::format(
      "[system]\nmodel = \"spring_mass\"\nbase = {{ mass = [1.0], stiffness = [0.5] }}\n"
      "contact_stiffness = 0.5\ndamping = {{ base = {:.17g} }}\npreload = 1e6\n{}\n"
      "[[element]]\nkind = \"cubic\"\nat = \"base\"\ncoefficient = 1.0\n"
      "[branch]\nparameter = \"F\"\neta = 1.4\nfrom = {}\nto = {}\n{}\n",
      0.1 / std::sqrt(0.5), harmonics, from, to, branch);
}

/// Position, velocity and the fundamental matrix.
using Motion = std::array<double, 6>;

Motion rate(double t, const Motion& y, double force) {
  const double k = 1 + 3 * y[0] * y[0];
  return {y[1],
          force * std::cos(1.4 * t) - 0.2 * y[1] - y[0] - y[0] * y[0] * y[0],
          y[4],
          y[5],
          -k * y[2] - 0.2 * y[4],
          -k * y[3] - 0.2 * y[5]};
}

Motion after(Motion y, double force, int periods) {
  constexpr int steps = 1000;
  const double step = two_pi / 1.4 / steps;
  const auto moved = [](const Motion& from, double by, const Motion& along) {
    Motion sum = from;
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += by * along[i];
    return sum;
  };
  for (int i = 0; i < steps * periods; ++i) {
    const double t = i * step;
    const Motion a = rate(t, y, force);
    const Motion b = rate(t + step / 2, moved(y, step / 2, a), force);
    const Motion c = rate(t + step / 2, moved(y, step / 2, b), force);
    const Motion d = rate(t + step, moved(y, step, c), force);
    for (std::size_t k = 0; k < y.size(); ++k) y[k] += step / 6 * (a[k] + 2 * b[k] + 2 * c[k] + d[k]);
  }
  return y;
}

/// Position and velocity of the mass at t = 0: x = -r.
Motion begun(const TracedBranch& traced, const BranchPoint& point) {
  const auto& problem = dynamic_cast<const HarmonicResponse&>(*traced.base.problem);
  const HarmonicVector r = problem.motion(point.unknowns, 0);
  Motion y{0, 0, 1, 0, 0, 1};
  for (Index a = 0; a < r.size(); ++a) {
    y[0] -= r(a).real();
    y[1] += 1.4 * problem.system().multiple(a) * r(a).imag();
  }
  return y;
}

double force_of(const BranchPoint& point) { return point.parameters(HarmonicResponse::further); }

/// From there the motion that closes after so many periods, by Newton's method.
Motion closed(Motion y, double force, int periods) {
  for (int round = 0; round < 6; ++round) {
    const Motion end = after(y, force, periods);
    const double a = end[2] - 1, b = end[3], c = end[4], d = end[5] - 1;
    const double x = end[0] - y[0], v = end[1] - y[1];
    const double determinant = a * d - b * c;
    y[0] -= (d * x - b * v) / determinant;
    y[1] -= (a * v - c * x) / determinant;
  }
  return y;
}

/// How far two states are from each other, over the size of one.
double distance(const Motion& a, const Motion& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1]) / std::hypot(a[0], a[1]);
}

/// That of the multipliers over a period which is nearest to `at`.
std::complex<double> multiplier(const TracedBranch& traced, const BranchPoint& point, int periods,
                                double at) {
  const Motion end = after(begun(traced, point), force_of(point), periods);
  const double half = 0.5 * (end[2] + end[5]);
  const std::complex<double> root =
      std::sqrt(std::complex<double>(half * half - end[2] * end[5] + end[3] * end[4]));
  return std::abs(half + root - at) < std::abs(half - root - at) ? half + root : half - root;
}

/// The largest deviation of Y in time, at points that are not regular, and of powers.
double difference_in_time(const TracedBranch& traced, std::size_t most = 6) {
  problems::VerifyOptions options;
  options.samples = 0;
  options.most_special = most;
  double largest = 0;
  for (const auto& one :
       problems::verify(traced.request->problem.system, traced.base.harmonics, traced.branch, options)) {
    if (traced.branch.points[one.point].type == PointType::regular) continue;
    CAPTURE(one.point, one.Y, one.Y_time);
    CHECK(std::isfinite(one.Y_time));
    largest = std::max({largest, std::abs(one.Y_time / one.Y - 1), one.power_error});
  }
  return largest;
}

const std::string stop = "[[element]]\nkind = \"unilateral\"\nat = \"base\"\nstiffness = 8.0\ngap = 0.2\n";

/// Masses round a ring, which rub and meet a stop on one side.
Case ring_case(const TemporaryFolder& folder, Index sectors, Index wave, int highest,
               const std::string& more) {
  const std::string head = "%%MatrixMarket matrix coordinate real symmetric\n";
  folder.write("m.mtx", head + "2 2 1\n1 1 1\n");
  folder.write("k.mtx", head + "2 2 3\n1 1 0.82\n2 1 -0.02\n2 2 0.02\n");
  return read_case(folder.write(
      "case.toml",
      fmt::format("[system]\nmodel = \"sector\"\nsectors = {}\nwave_number = {}\ncontact_stiffness = 0.2\n"
                  "preload = 0.05\nforce = 1.0\ndamping = {{ base = 0.03 }}\nreduction_window = [0.02, 3.0]\n"
                  "harmonics = {}\n{}[system.base]\nmass = \"m.mtx\"\nstiffness = \"k.mtx\"\nleft = [1]\n"
                  "right = [2]\ncontact = [1]\nload = {{ dof = [1], value = [1.0] }}\n"
                  "damping_kind = \"modal\"\n{}[branch]\nparameter = \"eta\"\nfrom = 0.4\nto = 0.37\n"
                  "switching = true\n",
                  sectors, wave, highest, more, stop)));
}

/// That what leaves the first branch has half of the load's frequency, and all are as in time.
void check_doubled(const std::vector<TracedBranch>& all, double tolerance) {
  CHECK(difference_in_time(all[0]) < tolerance);
  for (std::size_t i = 1; i < all.size(); i += 2) {
    CAPTURE(i);
    const BranchPoint& last = all[i].branch.points.back();
    CHECK(value(all[i], last, "Y_h1/2") > 0.02);
    CHECK_THAT(value(all[i + 1], all[i + 1].branch.points.back(), "Y_h1/2"),
               WithinRel(value(all[i], last, "Y_h1/2"), 1e-7));
    CHECK(difference_in_time(all[i], 3) < tolerance);
  }
}

}  // namespace

TEST_CASE("A Duffing oscillator's symmetry breaks and its period doubles where they do in time",
          "[numbers]") {
  const Case input =
      case_texts::read_text(duffing("harmonics = 13\nperiods = 2", 6, 21, "switching = true\n"));
  const std::vector<TracedBranch> all = trace(input.branches.front());
  // The symmetric response, both images of the other one, and of what leaves these.
  REQUIRE(all.size() == 7);
  const auto at_branch_point = [&](std::size_t i) {
    const auto found = points(all[i], PointType::branch_point);
    REQUIRE(found.size() == 1);
    return found.front();
  };
  CHECK(std::abs(multiplier(all[0], at_branch_point(0), 1, 1) - 1.0) < 2e-3);
  for (const std::size_t i : {1, 2})
    CHECK(std::abs(multiplier(all[i], at_branch_point(i), 1, -1) + 1.0) < 0.05);
  for (const TracedBranch& one : all) {
    const std::vector<BranchPoint>& path = one.branch.points;
    for (const std::size_t i : {path.size() / 2, path.size() - 1}) {
      CAPTURE(&one - all.data(), i, force_of(path[i]));
      const int periods = &one - all.data() > 2 ? 2 : 1;
      const Motion in_time = closed(begun(one, path[i]), force_of(path[i]), periods);
      CHECK(distance(in_time, begun(one, path[i])) < 6e-3);
      CHECK(distance(in_time, after(in_time, force_of(path[i]), periods)) < 1e-6);
      if (periods == 2) CHECK(distance(in_time, after(in_time, force_of(path[i]), 1)) > 0.01);
    }
    CHECK(one.branch.complete());
  }
  // Images of each other have the same amplitudes, half a period or one later.
  for (const auto& [a, b] : {std::pair(1, 2), std::pair(3, 4), std::pair(5, 6)}) {
    const auto& first = all[static_cast<std::size_t>(a)];
    const auto& second = all[static_cast<std::size_t>(b)];
    CHECK_THAT(value(second, second.branch.points.back(), "Y_h1/2"),
               WithinRel(value(first, first.branch.points.back(), "Y_h1/2"), 1e-7) || WithinAbs(0, 1e-9));
    CHECK_THAT(std::abs(value(second, second.branch.points.back(), "Y_h0")),
               WithinRel(std::abs(value(first, first.branch.points.back(), "Y_h0")), 1e-7));
  }
}

TEST_CASE("Switching beside stability goes on in the harmonics in which branches leave") {
  const auto traced = [](const std::string& harmonics, const std::string& more) {
    return trace(
        case_texts::read_text(duffing(harmonics, 6, 7.5, "switching = true\n" + more)).branches.front());
  };
  const std::vector<TracedBranch> all = traced("harmonics = 7", "stability = true\n");
  REQUIRE(all.size() == 2);  // one of two images
  const auto broken = points(all[0], PointType::symmetry_breaking);
  REQUIRE(broken.size() == 1);
  CHECK(all_odd(all[0].base.harmonics));
  // By hand it is one balance from the first.
  const std::vector<TracedBranch> by_hand = traced("harmonics = 7\neven_harmonics = true", "");
  REQUIRE(by_hand.size() == 3);
  CHECK(all[1].base.harmonics == by_hand[1].base.harmonics);
  const std::vector<BranchPoint>& left = all[1].branch.points;
  CHECK_THAT(force_of(left.front()), WithinRel(force_of(broken[0]), 5e-3));  // where 7 harmonics have it
  for (const std::size_t i : {1, 2}) {
    const std::vector<BranchPoint>& other = by_hand[i].branch.points;
    CHECK_THAT(force_of(left.front()), WithinRel(force_of(other.front()), 1e-9));
    CHECK_THAT(left.back().unknowns.norm(), WithinRel(other.back().unknowns.norm(), 1e-8));
  }
  CHECK(traced("harmonics = 7\neven_harmonics = true", "stability = true\n").size() == 3);  // no more
}

TEST_CASE("An impacting oscillator that rubs doubles its period as it does in time") {
  const Case input = case_texts::read_text(
      "[system]\nmodel = \"spring_mass\"\nbase = { mass = [1.0], stiffness = [0.8] }\ncontact_stiffness = "
      "0.2\n"
      "preload = 0.05\ndamping = { base = 0.03 }\nharmonics = 4\nperiods = 2\n" +
      stop + "[branch]\nparameter = \"eta\"\nfrom = 2.6\nto = 1.9\nswitching = true\n");
  const std::vector<TracedBranch> all = trace(input.branches.front());
  REQUIRE(all.size() == 5);
  check_doubled(all, 1e-3);
}

TEST_CASE("A ring's doubled response travels on half as many waves, or half a turn more") {
  const TemporaryFolder folder;
  for (const Index wave : {1, 4}) {
    CAPTURE(wave);
    const Case input = ring_case(folder, 6, 2, 4, fmt::format("periods = 2\nsubharmonic_wave = {}\n", wave));
    const std::vector<TracedBranch> all = trace(input.branches.front());
    REQUIRE(all.size() == 3);
    check_doubled(all, 1e-3);
  }
}

TEST_CASE("A ring's response over two periods is refused where it does not travel") {
  const TemporaryFolder folder;
  const auto error = [&](Index sectors, Index wave, const std::string& more) {
    return testing::error_of([&] { ring_case(folder, sectors, wave, 4, more); });
  };
  CHECK_THAT(
      error(6, 1, "periods = 2\n"),
      ContainsSubstring("system.periods: a response over 2 periods does not travel as the load does: no "
                        "whole number m of waves has 2 m = 1 modulo 6"));
  CHECK(error(5, 1, "periods = 2\n") == "no error");  // m = 3
  CHECK(error(6, 3, "periods = 3\n") == "no error");
  CHECK_THAT(error(6, 2, "periods = 2\nsubharmonic_wave = 3\n"),
             ContainsSubstring("system.subharmonic_wave: expected 1 or 4, got 3"));
  CHECK_THAT(error(6, 2, "subharmonic_wave = 1\n"),
             ContainsSubstring("system.subharmonic_wave: only beside periods > 1"));
  CHECK_THAT(error(6, 2, "periods = 13\n"),
             ContainsSubstring("system.periods: expected an integer >= 1 and <= 12, got 13"));
  const std::string over_two = duffing("periods = 2", 6, 7, "");
  CHECK_THAT(case_texts::error_of(over_two.substr(0, over_two.find("[branch]")) +
                                  "[branch]\ncurve = \"switch\"\nparameters = [\"eta\", \"P\"]\n"
                                  "window = [0.3, 4.0]\nfrom = 1e6\nto = 2e6\n"),
             ContainsSubstring("branch.curve: not of switches of responses over several periods"));
}

namespace {

/// Of the derivatives of F, contacts in slip, at some motion.
double derivative_error(const Case& input, const Vector& parameters, const std::vector<int>& orders) {
  const Built built = build(input.branches.front().problem);
  const auto& problem = dynamic_cast<const HarmonicResponse&>(*built.problem);
  CHECK(problem.system().orders == orders);
  Vector u(problem.size());
  for (Index i = 0; i < u.size(); ++i)
    u(i) = std::sin(1.7 * static_cast<double>(i)) / (1 + 0.2 * static_cast<double>(i));
  Matrix exact(problem.size(), problem.size());
  Matrix by_parameters(problem.size(), parameters.size());
  REQUIRE(problem.evaluate(u, parameters, 1, {nullptr, &exact, &by_parameters}));
  exact.conservativeResize(Eigen::NoChange, u.size() + parameters.size());
  exact.rightCols(parameters.size()) = by_parameters;
  double worst = 0;
  for (Index k = 0; k < exact.cols(); ++k) {
    constexpr double step = 1e-5;
    Vector difference = Vector::Zero(problem.size());
    for (const double way : {1.0, -1.0}) {
      Vector moved(exact.cols());
      moved << u, parameters;
      moved(k) += way * step;
      Vector residual(problem.size());
      REQUIRE(problem.evaluate(moved.head(u.size()), moved.tail(parameters.size()), 1, {&residual}));
      difference += way / (2 * step) * residual;
    }
    worst = std::max(worst, (difference - exact.col(k)).lpNorm<Eigen::Infinity>());
  }
  return worst;
}

}  // namespace

TEST_CASE("Derivatives of a response over three periods are those of differences") {
  const TemporaryFolder folder;
  const Case ring = ring_case(folder, 5, 2, 2, "periods = 3\npreload_growth = 0.01\n");
  CHECK(derivative_error(ring, Eigen::Vector2d(0.35, 0.05), {3, 0, 1, 2, 4, 5, 6}) < 1e-5);
  const Case odd = case_texts::read_text(duffing("harmonics = 3\nperiods = 3", 6, 7, ""));
  CHECK(derivative_error(odd, Eigen::Vector3d(1.4, 0.1, 6), {3, 1, 5, 7, 9}) < 1e-6);
}

}  // namespace arcslip::testing::departures
