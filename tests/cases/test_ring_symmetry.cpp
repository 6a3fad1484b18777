// Symmetries of whole rings, and of the branches that lose them.

#include <Eigen/LU>
#include <map>
#include <nlohmann/json.hpp>
#include <random>

#include "arcslip/continuation/path/symmetric_branches.hpp"
#include "case_runs.hpp"
#include "case_texts.hpp"
#include "catch.hpp"
#include "mistakes.hpp"
#include "program.hpp"

using namespace arcslip;
using namespace arcslip::testing;

namespace {

/// One mass in each of N sectors, with a hardening spring to ground.
std::string hardening_ring(const TemporaryFolder& folder, int sectors, const std::string& ring) {
  folder.write("m.mtx", "%%MatrixMarket matrix coordinate real symmetric\n2 2 1\n1 1 1\n");
  folder.write("k.mtx",
               "%%MatrixMarket matrix coordinate real symmetric\n2 2 3\n1 1 1.05\n2 1 -0.05\n2 2 0.05\n");
  return fmt::format(R"([system]
model = "sector"
wave_number = 1
sectors = {}
contact_stiffness = 0.2
force = 0.02
preload = 1.0
[system.base]
mass = "m.mtx"
stiffness = "k.mtx"
mass_factor = 0.01
left = [1]
right = [2]
contact = [1]
load = {{ dof = [1], value = [1.0] }}
[[element]]
kind = "cubic"
at = "base"
coefficient = 1.0
[ring]
{}
[branch]
parameter = "eta"
from = 0.14
to = 0.3
)",
                     sectors, ring);
}

std::vector<continuation::Symmetry> symmetries(int sectors, const std::string& ring) {
  const TemporaryFolder folder;
  const Case input = read_case(folder.write("case.toml", hardening_ring(folder, sectors, ring)));
  return build(input.branches.front().problem).problem->symmetries();
}

std::vector<std::string> names(int sectors, const std::string& ring) {
  std::vector<std::string> all;
  for (const continuation::Symmetry& one : symmetries(sectors, ring)) all.push_back(one.name);
  return all;
}

}  // namespace

TEST_CASE("A ring has the symmetries that its parts and its load have in common", "[ring symmetry]") {
  using Names = std::vector<std::string>;
  CHECK(names(8, "load = \"standing\"") == Names{"shift by 4 sectors, half a period later",
                                                 "mirror at sector 1",
                                                 "mirror at sector 3, half a period later"});
  CHECK(names(3, "load = \"travelling\"") == Names{"shift by 1 sector, 0.333333 of a period later",
                                                   "shift by 2 sectors, 0.666667 of a period later"});
  CHECK(names(5, "load = \"point\"") == Names{"mirror at sector 1"});
  CHECK(names(6, "load = [1, 0, 0, 1, 0, 0]") ==
        Names{"shift by 3 sectors", "mirror at sector 1", "mirror between sectors 2 and 3"});
  CHECK(names(6, "load = [1, 0, 0, 1, 0, 0]\nmissing = [1]") == Names{"mirror at sector 1"});
  CHECK(names(6, "load = [1, 0, 0, 1, 0, 0]\npreload = { scatter = 0.1 }").empty());
  CHECK(names(6, "load = [1, 2, 0, 0, 0, 0]").empty());
}

TEST_CASE("Branches that lose symmetries of a ring are followed once, and their images are solutions",
          "[ring symmetry]") {
  const TemporaryFolder folder;
  std::string text = hardening_ring(folder, 4, "load = \"standing\"") + "switching = true\n";
  text = replaced(text, "contact_stiffness = 0.2", "contact_stiffness = 0.0");
  const std::string path = folder.write("case.toml", text);
  const Case input = read_case(path);
  const std::vector<TracedBranch> traced = trace(input.branches.front());
  REQUIRE(traced.size() >= 2);
  const continuation::Problem& problem = traced.front().problem();
  const std::vector<continuation::Symmetry> all = problem.symmetries();
  REQUIRE(all.size() == 3);
  int lost = 0;
  for (const TracedBranch& one : traced) {
    const BranchPoint& point = one.branch.points[one.branch.points.size() / 12];
    for (const continuation::Symmetry& symmetry : all) {
      const Vector image = symmetry.map * point.unknowns;
      if ((image - point.unknowns).norm() > 1e-6 * image.norm()) ++lost;
      Vector residual(problem.size());
      REQUIRE(problem.evaluate(image, point.parameters, point.regime, {&residual}));
      CHECK(residual.norm() < 1e-9);
      // No other branch is the image.
      for (const TracedBranch& other : traced) {
        if (&other == &one) continue;
        for (const BranchPoint& there : other.branch.points) {
          if (there.type == PointType::branch_point || there.type == PointType::start) continue;
          CHECK((there.parameters != point.parameters || (there.unknowns - image).norm() > 1e-6));
        }
      }
    }
  }
  CHECK(lost > 0);
  arcslip_program("run " + path + " -o " + folder.path("results") + " --quiet");
  const auto summary = nlohmann::json::parse(read(folder.path("results/summary.json")));
  CHECK(summary.at("branches")[0].at("images") == 1);
  CHECK(summary.at("branches")[1].at("images") == 2);
  CHECK(summary.at("branches")[1].at("symmetries").size() == 1);
}

TEST_CASE("Branches without symmetry end where they have one again, however near to a fold",
          "[ring symmetry]") {
  const TemporaryFolder folder;
  std::string text =
      hardening_ring(folder, 8, "load = \"standing\"") + "switching = true\nextrema_of = [\"Y_max\"]\n";
  text = replaced(text, "contact_stiffness = 0.2", "contact_stiffness = 0.0");
  const std::vector<TracedBranch> traced = trace(read_case(folder.write("case.toml", text)).branches.front());
  REQUIRE(traced.size() > 10);
  const continuation::Problem& problem = traced.front().problem();
  const std::vector<continuation::Symmetry> all = problem.symmetries();
  const auto kept = [&](const BranchPoint& point) {
    Vector scale(problem.size());
    Vector parameter_scale(point.parameters.size());
    problem.scale(point.unknowns, point.parameters, scale, parameter_scale);
    const std::vector<bool> has = continuation::kept_symmetries(all, point.unknowns, scale, 1e-5);
    return std::count(has.begin(), has.end(), true);
  };
  int own_images = 0;
  for (const TracedBranch& one : traced) {
    CAPTURE(one.branch.explanation);
    CHECK(continuation::is_end(one.branch.stop));
    if (one.branch.stop != continuation::Stop::own_image) continue;
    ++own_images;
    const std::vector<BranchPoint>& points = one.branch.points;
    CHECK(kept(points.back()) > kept(points[points.size() / 2]));
  }
  CHECK(own_images > 8);
  // No branch is part of another, or of one of its images.
  for (const TracedBranch& one : traced) {
    for (const TracedBranch& other : traced) {
      if (&one == &other) continue;
      for (const BranchPoint& fold : of_type(one.branch, PointType::fold)) {
        for (const BranchPoint& there : of_type(other.branch, PointType::fold))
          CHECK((fold.unknowns - there.unknowns).norm() + (fold.parameters - there.parameters).norm() > 1e-7);
      }
    }
  }
}

TEST_CASE("Waves that become critical together break the symmetry of a ring in phase", "[ring symmetry]") {
  constexpr int sectors = 6;
  const TemporaryFolder folder;
  std::string text = hardening_ring(folder, sectors, "load = [1, 1, 1, 1, 1, 1]") + "switching = true\n";
  text = replaced(text, "contact_stiffness = 0.2", "contact_stiffness = 0.0");
  const std::vector<TracedBranch> traced = trace(read_case(folder.write("case.toml", text)).branches.front());
  const continuation::Problem& problem = traced.front().problem();
  const continuation::SymmetryGroup group(problem.symmetries());
  CHECK(group.order() == 12);
  // (z_m + 2 c |a|^2) b_m + c a^2 conj(b_-m) = 0 with z_m = k_m - w^2 + j w d, c = 3/4, k_m of wave m.
  const auto linear = [](int m, double eta) {
    const double w = two_pi * eta;
    return Complex(1 + 0.1 * (1 - std::cos(two_pi * m / sectors)) - w * w, 0.01 * w);
  };
  const auto determinant = [&](int m, double eta, double square) {
    return std::norm(linear(m, eta) + 1.5 * square) - 0.5625 * square * square;
  };
  const auto balance = [&](double eta, double square) {
    return std::norm(linear(0, eta) + 0.75 * square) * square - 4e-4;
  };
  std::map<int, int> found;
  for (const BranchPoint& point : of_type(traced.front().branch, PointType::branch_point)) {
    const double eta = point.parameters(0);
    const double square = point.unknowns.head(2).squaredNorm();
    CHECK_THAT(balance(eta, square), WithinAbs(0, 1e-12));
    int critical = 0;
    for (int m = 1; m <= sectors / 2; ++m) {
      if (std::abs(determinant(m, eta, square)) < std::abs(determinant(critical, eta, square)) ||
          critical == 0)
        critical = m;
    }
    ++found[critical];
    // Both equations by Newton's method, with differences, from aside.
    Eigen::Vector2d x(eta * 1.00001, square * 0.9999);
    for (int i = 0; i < 12; ++i) {
      const auto f = [&](double a, double b) {
        return Eigen::Vector2d(balance(a, b), determinant(critical, a, b));
      };
      constexpr double h = 1e-7;
      Eigen::Matrix2d jacobian;
      jacobian << (f(x(0) + h, x(1)) - f(x(0) - h, x(1))) / (2 * h),
          (f(x(0), x(1) + h) - f(x(0), x(1) - h)) / (2 * h);
      x -= jacobian.inverse() * f(x(0), x(1));
    }
    CHECK_THAT(eta, WithinRel(x(0), 1e-8));
    CHECK_THAT(square, WithinRel(x(1), 1e-7));
    const auto lost = continuation::lost_symmetries(problem, group, point);
    CHECK(lost.null_vectors == (2 * critical == sectors ? 1 : 2));
    CHECK(!lost.names.empty());
  }
  CHECK(found == std::map<int, int>{{1, 2}, {2, 2}});
  REQUIRE(traced.size() > 6);
  double localised = 0;
  for (const TracedBranch& one : traced) {
    CAPTURE(one.branch.explanation);
    CHECK(continuation::is_end(one.branch.stop));
    for (const BranchPoint& point : one.branch.points) {
      // The masses' own equations.
      double largest = 0;
      double mean = 0;
      for (int i = 0; i < sectors; ++i) {
        const auto a = [&](int k) {
          const Index at = 2 * ((k + sectors) % sectors);
          return Complex(point.unknowns(at), point.unknowns(at + 1));
        };
        const Complex rest = (linear(0, point.parameters(0)) + 0.1 + 0.75 * std::norm(a(i))) * a(i) -
                             0.05 * (a(i - 1) + a(i + 1));
        CHECK_THAT(std::abs(rest), WithinRel(0.02, 1e-8));
        largest = std::max(largest, std::abs(a(i)));
        mean += std::abs(a(i)) / sectors;
      }
      localised = std::max(localised, largest / mean);
    }
  }
  CHECK(localised > 2.5);
}

TEST_CASE("Stability of mistuned sectors needs damping that is one of matrices", "[ring section][messages]") {
  const TemporaryFolder folder;
  std::string text = hardening_ring(folder, 4,
                                    "load = \"standing\"\n[[ring.mistuning]]\npart = \"base\"\ndofs = [1]\n"
                                    "mass = 0.1\nfactors = [1, 1, 1, 1.5]") +
                     "stability = true\n";
  text = replaced(text, "preload = 1.0\n", "preload = 1.0\ndamping = { base = 1e-3 }\n");
  text = replaced(text, "contact = [1]\n", "contact = [1]\ndamping_kind = \"modal\"\n");
  const auto read = [&](const std::string& one) { read_case(folder.write("case.toml", one)); };
  const std::string error = error_of([&] { read(text); });
  CHECK(error.find('\n') == std::string::npos);
  CHECK_THAT(error, ContainsSubstring("branch.stability"));
  CHECK_THAT(error, ContainsSubstring("modal damping is that of equal sectors"));
  CHECK_NOTHROW(read(replaced(text, "\"modal\"", "\"viscous\"\nreference_frequency = 0.16")));
}
