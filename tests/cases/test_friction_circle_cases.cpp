// Structures that slide in a plane: against the closed form of a circular orbit, friction in one direction,
// and forces by radial return over the samples of a period.

#include <fmt/format.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "arcslip/continuation/problem/derivative_check.hpp"
#include "arcslip/problems/response/power_balance.hpp"
#include "case_runs.hpp"
#include "case_texts.hpp"
#include "draws.hpp"
#include "small_structures.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using problems::HarmonicResponse;

namespace {

/// A contact that slides along the first two dofs and closes, if it does, along the third.
struct Rubbing {
  double tangential, normal, friction, normal_force, per_preload;
  bool closes;
};

std::string circle_text(const Rubbing& e) {
  std::string text = fmt::format(
      "\n[[element]]\nkind = \"friction_2d\"\nat = \"base\"\ncontact = 1\nsecond = 2\n"
      "tangential_stiffness = {:.17g}\nmu = {:.17g}\nnormal_force = {:.17g}\nnormal_per_preload = {:.17g}\n",
      e.tangential, e.friction, e.normal_force, e.per_preload);
  if (e.closes) text += fmt::format("normal = 3\nnormal_stiffness = {:.17g}\n", e.normal);
  return text;
}

std::string from_to(double from, double to) {
  return fmt::format("\n[branch]\nparameter = \"eta\"\nfrom = {:.17g}\nto = {:.17g}\n", from, to);
}

constexpr const char* no_pairs = "\n[continuation]\nbranch_point_pairs = false\n";

/// A case of its own, read and traced.
struct SmallRun {
  SmallRun(const SmallStructure& s, const std::string& harmonics, const std::string& more) {
    write_matrices(s, folder);
    input = read_case(folder.write("case.toml", small_system_text(s, harmonics) + more));
    traced = trace(input.branches[0]);
  }
  const TracedBranch& front() const { return traced.front(); }
  const HarmonicResponse& problem() const {
    return dynamic_cast<const HarmonicResponse&>(*front().base.problem);
  }

  TemporaryFolder folder;
  Case input;
  std::vector<TracedBranch> traced;
};

/// Forces of the contact under sampled motions of all dofs, in a period that changes them no more:
/// where it slips little they settle slowly.
Matrix radial_return(const Rubbing& e, const Matrix& x, double preload) {
  constexpr Index most_periods = 5000;
  const Index samples = x.rows();
  const double rests = e.normal_force + e.per_preload * preload;
  Vector n = Vector::Constant(samples, rests);
  if (e.closes) n += e.normal * x.col(2);
  Matrix f = Matrix::Zero(samples, x.cols());
  Complex force = 0;
  Complex before = 1e300;
  for (Index i = 1; i <= most_periods * samples; ++i) {
    const Index here = i % samples;
    const Index last = (i - 1) % samples;
    const double part = n(last) < 0 && n(here) > 0 ? n(here) / (n(here) - n(last)) : 1;
    force += e.tangential * part * Complex(x(here, 0) - x(last, 0), x(here, 1) - x(last, 1));
    const double limit = e.friction * std::max(0.0, n(here));
    if (std::abs(force) > limit) force *= limit / std::abs(force);
    f(here, 0) = force.real();
    f(here, 1) = force.imag();
    if (e.closes) f(here, 2) = std::max(0.0, n(here)) - std::max(0.0, rests);
    if (here == 0 && std::abs(force - std::exchange(before, force)) < 1e-10) break;
  }
  return f;
}

/// Motions d (orders x dofs) that the sampled forces under them would make, by second-order extrapolation.
ComplexMatrix answer(const SmallStructure& s, const Rubbing& e, const std::vector<int>& orders, double eta,
                     const ComplexMatrix& d, Index samples) {
  const auto forces = [&](Index count) {
    const ComplexMatrix turns = turns_of(orders, count);
    const Matrix x = (turns * d).real();
    return ComplexMatrix(turns.adjoint() * radial_return(e, x, s.preload) / double(count));
  };
  const ComplexMatrix f = 2 * forces(2 * samples) - forces(samples);
  ComplexMatrix out = d;
  for (Index a = 0; a < d.rows(); ++a) {
    const int h = orders[static_cast<std::size_t>(a)];
    const double w = two_pi * h * eta;
    const ComplexMatrix z = s.stiffness.cast<Complex>() + Complex(0, w) * s.damping.cast<Complex>() -
                            w * w * s.mass.cast<Complex>();
    ComplexVector push = -f.row(a).transpose() * (h == 0 ? 1.0 : 2.0);
    if (h == 1) push += s.load;
    out.row(a) = z.partialPivLu().solve(push).transpose();
  }
  return out;
}

ComplexMatrix motion_of(const HarmonicResponse& problem, const Vector& u, Index dofs) {
  ComplexMatrix d(problem.harmonics(), dofs);
  for (Index i = 0; i < dofs; ++i) d.col(i) = -problem.motion(u, i);
  return d;
}

/// Newton's method with differences for d = answer(d).
ComplexMatrix balanced(const SmallStructure& s, const Rubbing& e, const std::vector<int>& orders, double eta,
                       ComplexMatrix d, Index samples) {
  const Index size = 2 * d.size();
  const auto rest = [&](const ComplexMatrix& at) {
    const ComplexMatrix left = at - answer(s, e, orders, eta, at, samples);
    Vector v(size);
    v << left.real().reshaped(), left.imag().reshaped();
    return v;
  };
  const auto moved = [&](const ComplexMatrix& at, const Vector& by) {
    ComplexMatrix to = at;
    to.real() += by.head(d.size()).reshaped(d.rows(), d.cols());
    to.imag() += by.tail(d.size()).reshaped(d.rows(), d.cols());
    return to;
  };
  for (int round = 0; round < 5; ++round) {
    const Vector here = rest(d);
    Matrix jacobian(size, size);
    constexpr double step = 1e-5;
    for (Index k = 0; k < size; ++k)
      jacobian.col(k) = (rest(moved(d, Vector::Unit(size, k) * step)) - here) / step;
    d = moved(d, -jacobian.partialPivLu().solve(here));
  }
  return d;
}

/// How far the motion of a point is from that of the sampled forces, over its size.
double sampled_error(const SmallStructure& s, const Rubbing& e, const HarmonicResponse& problem,
                     const BranchPoint& point, Index samples) {
  const ComplexMatrix d = motion_of(problem, point.unknowns, s.load.size());
  const ComplexMatrix other = answer(s, e, problem.system().orders, point.parameters(0), d, samples);
  return (d - other).norm() / d.norm();
}

/// Whether it slips or comes apart for so long that the force by samples is that of the motion alone.
bool forgets(const TracedBranch& traced, const BranchPoint& point) {
  constexpr double samples_see = 0.02;  // of the period
  return value(traced, point, "slip_friction_2d") + value(traced, point, "apart_friction_2d") > samples_see;
}

double power_error(const HarmonicResponse& problem, const BranchPoint& point) {
  return problems::power_balance(problem, point.unknowns, point.parameters, point.regime).error();
}

/// One mass that moves alike in both directions under a load that turns.
SmallStructure turning(double load) {
  SmallStructure s;
  s.mass = s.stiffness = Matrix::Identity(2, 2);
  s.damping = 0.05 * s.mass;
  s.load.resize(2);
  s.load << load, Complex(0, -load);
  s.contact_stiffness = {0, 0};
  return s;
}

/// One that slides and may close and one that it hangs on, in both directions of other stiffnesses.
SmallStructure two_masses(RandomSystems& draw, bool closes) {
  const Index dofs = closes ? 5 : 4;
  SmallStructure s;
  s.preload = draw.uniform(0.3, 2);
  s.mass = s.stiffness = Matrix::Zero(dofs, dofs);
  s.load.resize(dofs);
  for (Index i = 0; i < dofs; ++i) {
    s.mass(i, i) = draw.uniform(0.5, 2);
    s.stiffness(i, i) = draw.uniform(0.8, 2.5);
    for (Index j = 0; j < i; ++j) s.stiffness(i, j) = s.stiffness(j, i) = draw.uniform(-0.25, 0.25);
    s.load(i) = std::polar(draw.uniform(0.1, 1), draw.uniform(-pi, pi));
  }
  s.damping = draw.uniform(0.01, 0.06) * s.stiffness;
  s.contact_stiffness.assign(static_cast<std::size_t>(dofs), 0.0);
  return s;
}

}  // namespace

TEST_CASE("A mass that goes round in a circle passes the border of slip on its closed form", "[plane]") {
  const double k = 0.5, limit = 0.4;
  const Rubbing contact{k, 0, 0.5, 2 * limit, 0, false};
  for (const char* harmonics : {"1", "3"}) {
    CAPTURE(harmonics);
    const SmallRun run(turning(0.5), harmonics, circle_text(contact) + from_to(0.08, 0.3) + no_pairs);
    INFO(run.front().branch.explanation);
    REQUIRE(run.front().branch.complete());
    int slips = 0;
    for (const BranchPoint& point : run.front().branch.points) {
      const double w = two_pi * point.parameters(0);
      const ComplexMatrix d = motion_of(run.problem(), point.unknowns, 2);
      const double R = std::abs(d(0, 0));
      const double x = std::min(1.0, limit / (k * R));
      const Complex phi(x * x, x * std::sqrt((1 - x) * (1 + x)));
      slips += x < 1;
      CAPTURE(point.parameters(0), x);
      // beside the border phi is as exact as the root of what the radius is exact to
      const double exact = x < 1 && 1 - x < 1e-9 ? 1e-5 : 1e-9;
      CHECK_THAT(R * std::abs(Complex(1 - w * w, 0.05 * w) + k * phi), WithinRel(0.5, exact));
      CHECK(std::abs(d(0, 1) / d(0, 0) - Complex(0, -1)) < 1e-6);
    }
    CHECK(slips > 10);
    const auto switches = points(run.front(), PointType::regime_switch);
    CHECK(switches.size() == 2);
    for (const BranchPoint& point : switches) {
      CHECK_THAT(std::abs(motion_of(run.problem(), point.unknowns, 2)(0, 0)), WithinRel(limit / k, 1e-9));
      CHECK(point.residual < 1e-9);
    }
  }
}

TEST_CASE("The case of a mass that goes round on a rough plane is the balance of sampled forces", "[plane]") {
  const Run run("friction_circle");
  const TracedBranch& curve = run.traced.front();
  REQUIRE(curve.branch.complete());
  const auto& problem = dynamic_cast<const HarmonicResponse&>(*curve.base.problem);
  SmallStructure s;
  s.mass = Matrix::Identity(3, 3);
  s.stiffness.resize(3, 3);
  s.stiffness << 1, 0.1, 0.2, 0.1, 1.3, 0.1, 0.2, 0.1, 2;
  s.damping = 0.03 * s.stiffness;
  s.load.resize(3);
  s.load << 1, Complex(0, -0.8), 0.3;
  const Rubbing contact{0.6, 0.8, 0.5, 0, 1, true};
  CHECK(points(curve, PointType::regime_switch).size() == 1);
  std::vector<BranchPoint> slipping;
  for (const BranchPoint& point : curve.branch.points) {
    CHECK(point.residual < 1e-9);
    if (point.parameters(0) > 0.11) slipping.push_back(point);
  }
  const std::size_t count = slipping.size();
  REQUIRE(count > 20);
  double apart = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    const BranchPoint& point = slipping[i * (count - 1) / 5];
    CAPTURE(point.parameters(0));
    apart = std::max(apart, value(curve, point, "apart_friction_2d"));
    CHECK(power_error(problem, point) < 1e-8);
    if (forgets(curve, point)) CHECK(sampled_error(s, contact, problem, point, 1 << 11) < 2e-5);
  }
  CHECK(apart > 0.05);
  const BranchPoint& middle = slipping[count / 2];
  const ComplexMatrix d = motion_of(problem, middle.unknowns, 3);
  const ComplexMatrix other =
      balanced(s, contact, problem.system().orders, middle.parameters(0), 1.02 * d, 1 << 9);
  CHECK((d - other).norm() < 1e-4 * d.norm());
}

TEST_CASE("Random masses that slide in a plane balance at every point of their branches", "[plane]") {
  int slips = 0;
  constexpr int next = sanitized ? 3 : 1;  // one that closes after one that does not
  for (int i = 0; i < 5; i += next) {
    RandomSystems draw(static_cast<unsigned>(200 + i));
    const bool closes = i >= 3;
    const SmallStructure s = two_masses(draw, closes);
    const Rubbing contact{draw.uniform(0.3, 1.5), closes ? draw.uniform(0.2, 1.2) : 0,
                          draw.uniform(0.2, 0.8), draw.uniform(0, 0.5),
                          draw.uniform(0.3, 1),   closes};
    const SmallRun run(s, std::array{"1", "3", "7"}[i % 3],
                       circle_text(contact) + from_to(0.05, 0.25) + no_pairs);
    INFO("system " << i << ": " << run.front().branch.explanation);
    CHECK(run.front().branch.complete());
    const std::vector<BranchPoint>& all = run.front().branch.points;
    for (const BranchPoint& point : all) {
      CHECK(point.residual < 1e-9);
      CHECK(power_error(run.problem(), point) < 1e-8);
    }
    for (std::size_t k = 0; k < 5; ++k) {
      const BranchPoint& point = all[(2 * k + 1) * (all.size() - 1) / 10];
      if (!forgets(run.front(), point)) continue;
      CAPTURE(point.parameters(0));
      ++slips;
      CHECK(sampled_error(s, contact, run.problem(), point, 1 << 11) < 1e-5);
    }
  }
  CHECK(slips > 10 / next);
}

TEST_CASE("Friction in a plane of which one direction never moves is friction in one", "[plane]") {
  RandomSystems draw(4);
  SmallStructure s = random_structure(draw);
  for (Matrix* a : {&s.mass, &s.stiffness}) {
    a->row(1).setZero();
    a->col(1).setZero();
    (*a)(1, 1) = 1;
  }
  s.damping = 0.02 * (s.mass + s.stiffness);
  s.load(1) = 0;
  const Rubbing contact{0.8, 0.7, 0.5, 0.2, 0.6, true};
  const std::string one =
      replaced(replaced(circle_text(contact), "friction_2d", "friction"), "second = 2\n", "");
  const SmallRun plane(s, "3", circle_text(contact) + from_to(0.05, 0.5));
  const SmallRun line(s, "3", one + from_to(0.05, 0.5));
  REQUIRE((plane.front().branch.complete() && line.front().branch.complete()));
  for (const PointType type : {PointType::peak, PointType::regime_switch}) {
    const auto expected = points(line.front(), type);
    const auto found = points(plane.front(), type);
    REQUIRE(found.size() == expected.size());
    for (std::size_t k = 0; k < found.size(); ++k) {
      CHECK_THAT(found[k].parameters(0), WithinRel(expected[k].parameters(0), 1e-8));
      CHECK_THAT(value(plane.front(), found[k], "Y"), WithinRel(value(line.front(), expected[k], "Y"), 1e-8));
    }
  }
}

TEST_CASE("Elements with friction begin at preloads that let everything slip, where sweeps over P arrive",
          "[cases]") {
  const std::string name = GENERATE("lift_off", "friction_circle");
  const double eta = GENERATE(0.06, 0.1);
  for (const double preload : {1e-2, 3e-4, 1e-6}) {
    CAPTURE(name, eta, preload);
    const Run begun(name, {preload_of(preload), fmt::format("branch.from={}", eta),
                           fmt::format("branch.to={}", 1.001 * eta)});
    const Run swept(name, {"branch.parameter=\"P\"", fmt::format("branch.eta={}", eta), "branch.from=30.0",
                           fmt::format("branch.to={}", preload)});
    const continuation::Branch& over_eta = begun.traced.at(0).branch;
    const continuation::Branch& over_preload = swept.traced.at(0).branch;
    REQUIRE(over_eta.stop == Stop::reached_end);
    REQUIRE(over_preload.stop == Stop::reached_end);
    for (const char* of : {"Y", "R", "T_max_friction"}) {
      const std::string known = std::string(of) + (of[0] == 'T' && name != "lift_off" ? "_2d" : "");
      CHECK_THAT(value(begun.traced[0], over_eta.points.front(), known),
                 WithinRel(value(swept.traced[0], over_preload.points.back(), known), 1e-7));
    }
  }
}

TEST_CASE("What friction in a plane is not made for is refused in one line", "[plane]") {
  RandomSystems draw(1);
  const SmallStructure s = random_structure(draw);
  const TemporaryFolder folder;
  write_matrices(s, folder);
  const std::string text =
      small_system_text(s, "3") + circle_text({1, 0.5, 0.3, 1, 0, true}) + from_to(0.1, 0.2);
  using Edit = std::array<const char*, 3>;
  for (const auto& [from, to, says] :
       {Edit{"second = 2", "", "element[0].second"},
        Edit{"second = 2", "second = 1", "element[0].second: expected a contact from 1 to 3 other than 1"},
        Edit{"normal = 3", "normal = 2",
             "element[0].normal: expected a contact from 1 to 3 other than 1 and 2"},
        Edit{"normal = 3\n", "", "element[0].normal_stiffness: needs normal"},
        Edit{"mu = 0.29999999999999999", "mu = 0.0", "element[0].mu: expected"},
        Edit{"harmonics = 3", "harmonics = 42", "at most 42"},
        Edit{"normal = 3\nnormal_stiffness = 0.5", "closes = \"backwards\"",
             "element[0].closes: without normal"}})
    CHECK_THAT(
        error_of([&, edited = replaced(text, from, to)] { read_case(folder.write("case.toml", edited)); }),
        ContainsSubstring(says));
}
