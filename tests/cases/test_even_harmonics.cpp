// Elements that are not odd, which call for the mean and even harmonics: against closed forms, the odd
// balance and forces marched over 2^16 samples of a period.

#include <fmt/format.h>
#include <fmt/ranges.h>

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
#include "random_systems.hpp"
#include "small_structures.hpp"
#include "temporary_folder.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using problems::HarmonicResponse;

namespace {

struct Placed {
  std::string kind;
  Index dof;
  Index normal;
  bool backwards;
  double tangential, normal_stiffness, friction, normal_force, gap;  // of a stop k = tangential
};

std::string case_text(const SmallStructure& s, const std::vector<Placed>& elements,
                      const std::string& harmonics, double from, double to) {
  std::string text = small_system_text(s, harmonics);
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const Placed& e = elements[i];
    text += fmt::format("\n[[element]]\nkind = \"{}\"\nname = \"e{}\"\nat = \"base\"\ncontact = {}\n", e.kind,
                        i, e.dof + 1);
    if (e.kind != "cubic") text += fmt::format("closes = \"{}\"\n", e.backwards ? "backwards" : "forwards");
    if (e.kind == "friction")
      text += fmt::format(
          "normal = {}\ntangential_stiffness = {:.17g}\nnormal_stiffness = {:.17g}\nmu = {:.17g}\n"
          "normal_force = {:.17g}\n",
          e.normal + 1, e.tangential, e.normal_stiffness, e.friction, e.normal_force);
    if (e.kind == "unilateral")
      text += fmt::format("stiffness = {:.17g}\ngap = {:.17g}\n", e.tangential, e.gap);
    if (e.kind == "cubic") text += fmt::format("coefficient = {:.17g}\n", e.tangential);
  }
  return text + fmt::format("\n[branch]\nparameter = \"eta\"\nfrom = {:.17g}\nto = {:.17g}\n", from, to);
}

/// The case of a structure with its elements, read and traced.
struct Traced {
  Traced(const SmallStructure& s, const std::vector<Placed>& elements, const std::string& harmonics,
         double from, double to) {
    write_matrices(s, folder);
    input = read_case(folder.write("case.toml", case_text(s, elements, harmonics, from, to)));
    traced = trace(input.branches[0]);
  }
  const HarmonicResponse& problem() const {
    return dynamic_cast<const HarmonicResponse&>(*traced.front().base.problem);
  }
  const continuation::Branch& branch() const { return traced.front().branch; }

  TemporaryFolder folder;
  Case input;
  std::vector<TracedBranch> traced;
};

/// The motion of a dof over a period.
Vector passed(const HarmonicResponse& problem, const Vector& u, Index dof, const ComplexMatrix& turns) {
  const HarmonicVector y = -problem.motion(u, dof);
  return (turns * y).real();
}

/// Friction against r under the normal force n, where that is positive, in the second period from rest.
Vector friction_march(const Vector& r, const Vector& n, double k, double mu) {
  const Index samples = r.size();
  Vector f(samples);
  double force = std::clamp(k * r(0), -mu * std::max(0.0, n(0)), mu * std::max(0.0, n(0)));
  for (Index i = 1; i <= 2 * samples; ++i) {
    const Index here = i % samples;
    const Index last = (i - 1) % samples;
    const double press = std::max(0.0, n(here));
    const double part = n(last) < 0 && n(here) > 0 ? n(here) / (n(here) - n(last)) : 1;
    force = std::clamp(force + k * part * (r(here) - r(last)), -mu * press, mu * press);
    f(here) = force;
  }
  return f;
}

/// Forces of all elements on the dofs, samples x dofs.
Matrix element_forces(const SmallStructure& s, const std::vector<Placed>& elements, const Matrix& x) {
  Matrix f = Matrix::Zero(x.rows(), x.cols());
  for (std::size_t i = 0; i < s.contact_stiffness.size(); ++i) {
    const double k = s.contact_stiffness[i];
    const auto dof = static_cast<Index>(i);
    if (k > 0) f.col(dof) += friction_march(x.col(dof), Vector::Constant(x.rows(), s.preload), k, 1);
  }
  for (const Placed& e : elements) {
    const double side = e.backwards ? -1 : 1;
    if (e.kind == "friction") {
      const Vector n = e.normal_force + e.normal_stiffness * side * x.col(e.normal).array();
      f.col(e.dof) += friction_march(x.col(e.dof), n, e.tangential, e.friction);
      f.col(e.normal).array() += side * (n.array().max(0.0) - std::max(0.0, e.normal_force));
    } else if (e.kind == "unilateral") {
      f.col(e.dof).array() +=
          side * e.tangential * ((side * x.col(e.dof).array() - e.gap).max(0.0) - std::max(0.0, -e.gap));
    } else {
      f.col(e.dof).array() += e.tangential * x.col(e.dof).array().cube();
    }
  }
  return f;
}

/// How far the motion is from that which the sampled forces under it would make, over its size.
double sampled_error(const SmallStructure& s, const std::vector<Placed>& elements,
                     const HarmonicResponse& problem, const continuation::BranchPoint& point, Index samples) {
  const std::vector<int>& orders = problem.system().orders;
  const ComplexMatrix turns = turns_of(orders, samples);
  Matrix x(samples, s.load.size());
  for (Index i = 0; i < x.cols(); ++i) x.col(i) = passed(problem, point.unknowns, i, turns);
  const ComplexMatrix f = turns.adjoint() * element_forces(s, elements, x);
  double error = 0, size = 0;
  for (std::size_t a = 0; a < orders.size(); ++a) {
    const int h = orders[a];
    const double w = two_pi * h * point.parameters(0);
    const ComplexMatrix z = s.stiffness.cast<Complex>() + Complex(0, w) * s.damping.cast<Complex>() -
                            w * w * s.mass.cast<Complex>();
    ComplexVector push = -f.row(static_cast<Index>(a)).transpose() * ((h == 0 ? 1.0 : 2.0) / double(samples));
    if (h == 1) push += s.load;
    const ComplexVector d = z.partialPivLu().solve(push);
    for (Index i = 0; i < d.size(); ++i) {
      const Complex y = -problem.motion(point.unknowns, i)(static_cast<Index>(a));
      error = std::max(error, std::abs(d(i) - y));
      size = std::max(size, std::abs(y));
    }
  }
  return error / size;
}

Placed random_element(RandomSystems& draw, const std::string& kind) {
  const Index dof = draw.integer(0, 2);
  return {kind,
          dof,
          (dof + draw.integer(1, 2)) % 3,
          draw.integer(0, 1) == 1,
          draw.uniform(0.2, 1.5),
          draw.uniform(0, 1.5),
          draw.uniform(0.1, 0.8),
          draw.uniform(-0.5, 2),
          draw.uniform(-1, 1.5)};
}

constexpr double lowest_eta = 0.05;
constexpr double highest_eta = 0.5;

}  // namespace

TEST_CASE("Random structures with elements that are not odd balance at every point", "[even]") {
  RandomSystems draw(17);
  const std::vector<std::string> kinds{"friction", "unilateral", "friction", "cubic"};
  for (int i = 0; i < draws(8); ++i) {
    SmallStructure s = random_structure(draw);
    std::vector<Placed> elements{random_element(draw, kinds[static_cast<std::size_t>(i % 2)])};
    for (Index more = draw.integer(0, 2); more > 0; --more)
      elements.push_back(random_element(draw, kinds[static_cast<std::size_t>(draw.integer(0, 3))]));
    if (draw.integer(0, 2) == 0) s.contact_stiffness[1] = draw.uniform(0.2, 1.5);
    s.preload = draw.uniform(0.3, 3);
    const int H = std::vector{1, 3, 4, 2}[static_cast<std::size_t>(i % 4)];
    const Traced run(s, elements, std::to_string(H), lowest_eta, highest_eta);
    INFO("system " << i << ", H = " << H << "\n" << case_text(s, elements, std::to_string(H), 0, 0));
    CHECK(run.branch().complete());
    const std::size_t count = run.branch().points.size();
    REQUIRE(count > 5);
    for (std::size_t k = 0; k < 5; ++k) {
      const BranchPoint& point = run.branch().points[k * (count - 1) / 4];
      CHECK(problems::power_balance(run.problem(), point.unknowns, point.parameters, point.regime).error() <
            1e-10);
      CHECK(sampled_error(s, elements, run.problem(), point, 1 << 13) < 1e-5);
    }
  }
}

TEST_CASE("Mean and even harmonics leave a contact under constant preload what it is", "[even]") {
  RandomSystems draw(3);
  for (int i = 0; i < 2; ++i) {
    SmallStructure s = random_structure(draw);
    s.contact_stiffness = {0.8, 0, 1.1};
    s.preload = draw.uniform(0.1, 1);
    Placed cubic = random_element(draw, "cubic");
    const Traced odd(s, {cubic}, "[1, 3, 5]", lowest_eta, highest_eta);
    const Traced all(s, {cubic}, "[0, 1, 2, 3, 4, 5]", lowest_eta, highest_eta);
    // the same contacts as pressed ones whose normal force does not change
    SmallStructure bare = s;
    bare.contact_stiffness = {0, 0, 0};
    const Placed first{"friction", 0, 1, false, 0.8, 0, 0.5, 2 * s.preload, 0};
    const Placed second{"friction", 2, 1, true, 1.1, 0, 1, s.preload, 0};
    const Traced pressed(bare, {cubic, first, second}, "5", lowest_eta, highest_eta);
    for (const Traced* other : {&all, &pressed}) {
      CHECK(other->branch().complete());
      for (const PointType type : {PointType::peak, PointType::trough, PointType::regime_switch}) {
        const auto expected = points(odd.traced.front(), type);
        const auto found = points(other->traced.front(), type);
        REQUIRE(found.size() == expected.size());
        for (std::size_t k = 0; k < found.size(); ++k) {
          CHECK_THAT(found[k].parameters(0), WithinRel(expected[k].parameters(0), 1e-8));
          CHECK_THAT(value(other->traced.front(), found[k], "Y"),
                     WithinRel(value(odd.traced.front(), expected[k], "Y"), 1e-8));
          CHECK(std::abs(value(other->traced.front(), found[k], "Y_h0")) < 1e-10);
        }
      }
    }
  }
}

TEST_CASE("A mass that lifts off moves as it does in time, with its mean", "[even]") {
  // K = [1 .2; .2 1.5], C = .05 K, w = 1.1; figures of an integration in time, to 5e-6
  SmallStructure s;
  s.mass = Matrix::Identity(2, 2);
  s.stiffness.resize(2, 2);
  s.stiffness << 1, 0.2, 0.2, 1.5;
  s.damping = 0.05 * s.stiffness;
  s.load.resize(2);
  s.load << 1, std::polar(0.6, 0.5);
  s.contact_stiffness = {0, 0};
  const Placed contact{"friction", 0, 1, false, 0.6, 0.8, 0.5, 1, 0};
  const Traced run(s, {contact}, "16", 0.15, 1.1 / two_pi);
  REQUIRE(run.branch().complete());
  const BranchPoint& end = run.branch().points.back();
  const auto at = [&](const char* name) { return value(run.traced.front(), end, name); };
  CHECK_THAT(at("Y_h0"), WithinAbs(0.211893, 1e-5));
  CHECK_THAT(at("Y"), WithinAbs(4.305776, 1e-5));
  CHECK_THAT(at("Y_h2"), WithinAbs(0.086827, 1e-5));
  CHECK_THAT(at("Y_h0_contact_2"), WithinAbs(-0.021505, 1e-5));
  CHECK_THAT(at("Y_contact_2"), WithinAbs(1.335933, 1e-5));
  CHECK((at("N_min_e0") == 0 && at("apart_e0") > 0.1 && at("slip_e0") + at("apart_e0") < 1));
}

TEST_CASE("Where a contact begins to lift off is a point", "[even]") {
  SmallStructure s;
  s.mass = Matrix::Identity(2, 2);
  s.stiffness.resize(2, 2);
  s.stiffness << 1, 0.2, 0.2, 1.5;
  s.damping = 0.05 * s.stiffness;
  s.load.resize(2);
  s.load << 1, std::polar(0.6, 0.5);
  s.contact_stiffness = {0, 0};
  const Placed contact{"friction", 0, 1, false, 0.6, 0.8, 0.5, 1, 0};
  const Traced run(s, {contact}, "7", 0.1, 0.3);
  REQUIRE(run.branch().complete());
  const auto at = [&](const BranchPoint& point, const char* name) {
    return value(run.traced.front(), point, name);
  };
  int begins = 0;
  for (std::size_t i = 1; i + 1 < run.branch().points.size(); ++i) {
    const BranchPoint& point = run.branch().points[i];
    CHECK(at(point, "energy_e0") >= -1e-12);
    if (point.label != "lift_off_e0") continue;
    ++begins;
    CHECK(point.type_name() == "lift_off_e0");
    CHECK_THAT(at(point, "N_min_e0"), WithinAbs(0, 1e-7));
    const double before = at(*(&point - 1), "apart_e0");
    const double behind = at(*(&point + 1), "apart_e0");
    CHECK((before == 0) != (behind == 0));
  }
  CHECK(begins == 2);
}

TEST_CASE("A stop on one side is a spring where never left, and nothing where never met", "[even]") {
  RandomSystems draw(5);
  for (int i = 0; i < 4; ++i) {
    SmallStructure s = random_structure(draw);
    s.damping = 0.02 * s.mass;
    Placed stop = random_element(draw, "unilateral");
    const auto highest_peak = [&](const Traced& run) {
      double most = 0;
      for (const BranchPoint& point : points(run.traced.front(), PointType::peak))
        most = std::max(most, value(run.traced.front(), point, "Y"));
      return most;
    };
    SmallStructure stiffer = s;
    stiffer.stiffness(stop.dof, stop.dof) += stop.tangential;
    stop.gap = -1e3;
    Placed nothing = stop;
    nothing.gap = 1e3;
    const double pressed = highest_peak(Traced(s, {stop}, "3", lowest_eta, highest_eta));
    const double open = highest_peak(Traced(s, {nothing}, "3", lowest_eta, highest_eta));
    CHECK_THAT(highest_peak(Traced(stiffer, {nothing}, "1", lowest_eta, highest_eta)),
               WithinRel(pressed, 1e-9));
    Placed cubic = nothing;
    cubic.kind = "cubic";
    cubic.tangential = 0;
    CHECK_THAT(highest_peak(Traced(s, {cubic}, "3", lowest_eta, highest_eta)), WithinRel(open, 1e-9));
  }
}

TEST_CASE("Elements that are not odd have exact derivatives, also by what is continued", "[even]") {
  RandomSystems draw(29);
  for (int i = 0; i < 6; ++i) {
    SmallStructure s = random_structure(draw);
    s.contact_stiffness[1] = i % 2 == 0 ? 0 : 0.7;
    const std::vector<Placed> elements{random_element(draw, "friction"), random_element(draw, "unilateral")};
    const TemporaryFolder folder;
    write_matrices(s, folder);
    const Placed& friction = elements[0];
    const Placed& stop = elements[1];
    const auto [name, here] = std::vector<std::pair<const char*, double>>{
        {"e0.mu", friction.friction},
        {"e0.tangential_stiffness", friction.tangential},
        {"e0.normal_stiffness", friction.normal_stiffness},
        {"e0.normal_force", friction.normal_force},
        {"e1.gap", stop.gap},
        {"e1.stiffness", stop.tangential}}[static_cast<std::size_t>(i)];
    const std::string whole = case_text(s, elements, sanitized ? "1" : "3", 0, 0);
    std::string text = whole.substr(0, whole.find("[branch]"));
    text += fmt::format("[branch]\nparameter = \"{}\"\nfrom = {:.17g}\nto = {:.17g}\neta = {}\n", name, here,
                        1.2 * here, draw.uniform(0.1, 0.3));
    const Case input = read_case(folder.write("case.toml", text));
    const std::vector<TracedBranch> traced = trace(input.branches[0]);
    REQUIRE(traced.front().branch.complete());
    const continuation::Problem& problem = *traced.front().base.problem;
    int near = 0;
    const std::vector<BranchPoint>& all = traced.front().branch.points;
    for (const BranchPoint& point : {all.front(), all[all.size() / 2], all.back()}) {
      const continuation::DerivativeReport report =
          continuation::check_derivatives(problem, point.unknowns, point.parameters, point.regime);
      if (report.worst > 1e-6) ++near;  // beside a transition
    }
    CHECK(near <= 1);
  }
}

TEST_CASE("What even harmonics are not made for is refused in one line", "[even]") {
  RandomSystems draw(1);
  const SmallStructure s = random_structure(draw);
  const TemporaryFolder folder;
  write_matrices(s, folder);
  const std::string text = case_text(s, {random_element(draw, "friction")}, "3", lowest_eta, highest_eta);
  const auto error_of_text = [&](const std::string& from, const std::string& to) {
    const std::string path = folder.write("case.toml", replaced(text, from, to));
    return error_of([&] { read_case(path); });
  };
  const std::string several = replaced(replaced(text, "harmonics = 3\n", ""), "[branch]\n",
                                       "[branch]\nfor_each = { harmonics = [1, 4] }\n");
  const Case listed = read_case(folder.write("case.toml", several));
  CHECK(listed.branches[0].problem.system.harmonics == std::vector<int>{1, 0});
  CHECK(listed.branches[1].problem.system.harmonics == std::vector<int>{1, 0, 2, 3, 4});
  using Edit = std::array<const char*, 3>;
  for (const auto& [from, to, says] :
       {Edit{"harmonics = 3", "harmonics = [1, 3]", "system.harmonics: expected 0 among them"},
        Edit{"harmonics = 3", "harmonics = 101", "at most 64"},
        Edit{"normal = ", "normal = 7 #", "element[0].normal: expected a contact from 1 to 3 other than"},
        Edit{"closes = \"", "closes = \"x", "element[0].closes: expected"}})
    CHECK_THAT(error_of_text(from, to), ContainsSubstring(says));
}

TEST_CASE("Responses begin where over the load a branch folds back to less than a thousandth of it",
          "[even]") {
  const double damping = GENERATE(5e-4, 2e-3);
  const double eta = GENERATE(1.19, 1.23);  // a stop makes the mass resonate there under a small load as well
  CAPTURE(damping, eta);
  const TemporaryFolder folder;
  const Case input = read_case(folder.write(
      "case.toml",
      fmt::format("[system]\nmodel = \"spring_mass\"\nbase = {{ mass = [1.4846], stiffness = [2.0434], load "
                  "= [0.5] }}\n"
                  "contact_stiffness = 1e-6\npreload = 1.0\ndamping = {{ base = {} }}\nharmonics = 3\n"
                  "[[element]]\nkind = \"unilateral\"\nat = \"base\"\nstiffness = 2.637\ngap = 0.02\n"
                  "[branch]\nparameter = \"eta\"\nfrom = {}\nto = 2.0\n",
                  damping, eta)));
  const auto all = trace(input.branches.front());
  REQUIRE(all.front().branch.complete());
  CHECK(all.front().branch.points.size() > 20);
}
