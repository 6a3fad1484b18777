// Loads that stand still, past which a ring turns: all their engine orders at once, on one sector.

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string>

#include "arcslip/problems/tasks/verification.hpp"
#include "case_runs.hpp"
#include "catch.hpp"
#include "mistakes.hpp"
#include "temporary_folder.hpp"

using namespace arcslip;
using namespace arcslip::testing;

namespace {

constexpr double at_055 = 0.0875352186901369;  // w = 0.55

/// The only landing of the only branch.
BranchPoint landing(const TracedBranch& traced) {
  CHECK(traced.branch.complete());
  const auto all = points(traced, PointType::user);
  REQUIRE(all.size() == 1);
  return all.front();
}

/// The orders of the case, as phasors.
const Complex loads[] = {0.25, 1.0, std::polar(0.8, 0.7), std::polar(0.5, -1.1)};

/// Of a mass of the case that sticks on ground, under the order m.
Complex stuck_motion(int m, double eta, const Complex& load) {
  const double w = 2 * std::numbers::pi * m * eta;
  const double wave = std::numbers::pi * m / 3;
  return load / Complex(1 + 0.6 * (1 - std::cos(wave)) + 0.5 - w * w, 0.08 * w);
}

std::string column(const std::string& name, int h) { return h == 1 ? name : fmt::format("{}_h{}", name, h); }

}  // namespace

TEST_CASE("Engine orders of a load that stands still act together as on all nodes in time", "[excitation]") {
  const Run run("engine_orders", {"system.harmonics=25", "branch.from=0.0875", "branch.to=0.0876"});
  const TracedBranch& traced = run.traced.front();
  const BranchPoint point = landing(traced);
  const double expected[] = {0.289400, 0.989064, 0.847067, 1.408117, 0.022501};
  for (int h = 0; h <= 4; ++h) {
    INFO("order " << h);
    CHECK_THAT(std::abs(value(traced, point, column("Y", h))), WithinAbs(expected[h], 7e-6));
  }
}

TEST_CASE("Where all stick each engine order moves the ring as it does alone", "[excitation]") {
  const Run run("engine_orders", {"system.preload=1e5", "system.harmonics=4"});
  const TracedBranch& traced = run.traced.front();
  REQUIRE(traced.branch.complete());
  for (const BranchPoint& point : traced.branch.points) {
    const double eta = value(traced, point, "eta");
    for (int m = 0; m <= 3; ++m) {
      INFO("order " << m << " at eta = " << eta);
      const Complex right = stuck_motion(m, eta, loads[m]);
      CHECK_THAT(std::abs(value(traced, point, column("Y", m))),
                 WithinRel(std::abs(right), 1e-11) || WithinAbs(std::abs(right), 1e-12));
      if (m == 1)
        CHECK(std::abs(std::polar(1.0, value(traced, point, column("beta", m)) + std::arg(right)) - 1.0) <
              1e-10);
    }
    CHECK(value(traced, point, "Y_h4") < 1e-12);
    double greatest = 0;
    for (int k = 0; k < 20000; ++k) {
      double y = 0;
      for (int m = 0; m <= 3; ++m)
        y +=
            std::real(stuck_motion(m, eta, loads[m]) * std::polar(1.0, 2 * std::numbers::pi * m * k / 20000));
      greatest = std::max(greatest, std::abs(y));
    }
    CHECK_THAT(value(traced, point, "Y_peak"), WithinRel(greatest, 1e-6));
  }
}

TEST_CASE("An engine order acts on the nodes as the one N further does, at its own frequency",
          "[excitation]") {
  // The order 7 of six sectors travels as the order 1.
  const auto at = [](int order, double eta) {
    const Run run(
        "engine_orders",
        {fmt::format("excitation.orders=[{}]", order), "excitation.amplitude=[1.0]", "excitation.phase=[0.4]",
         fmt::format("system.harmonics={}", 3 * order), fmt::format("branch.from={}", 0.9 * eta),
         fmt::format("branch.to={}", 1.1 * eta), fmt::format("continuation.stop_at=[{:.17g}]", eta)});
    const TracedBranch& traced = run.traced.front();
    const BranchPoint point = landing(traced);
    return std::pair(value(traced, point, column("Y", order)), value(traced, point, "Y_peak"));
  };
  const auto [first, first_peak] = at(1, 7 * at_055);
  const auto [seventh, seventh_peak] = at(7, at_055);
  CHECK_THAT(seventh, WithinRel(first, 1e-9));
  CHECK_THAT(seventh_peak, WithinRel(first_peak, 1e-9));
}

TEST_CASE("All sectors of a whole ring feel engine orders as one sector does", "[excitation][ring]") {
  const Settings near{"system.harmonics=5", "branch.from=0.086", "branch.to=0.089"};
  Settings whole = near;
  whole.push_back("ring.load=\"travelling\"");
  const Run one("engine_orders", near);
  const Run all("engine_orders", whole);
  const BranchPoint alone = landing(one.traced.front());
  const BranchPoint together = landing(all.traced.front());
  for (const char* name : {"Y", "Y_h0", "Y_h2", "Y_h3", "Y_h4", "Y_h5", "Y_peak", "beta", "dissipated"}) {
    INFO(name);
    CHECK_THAT(value(all.traced.front(), together, name),
               WithinRel(value(one.traced.front(), alone, name), 1e-9));
  }
  CHECK_THAT(value(all.traced.front(), together, "Y_min"),
             WithinRel(value(all.traced.front(), together, "Y_max"), 1e-9));
}

TEST_CASE("A ring that turns past a jet is the ring in time, and power comes to nothing",
          "[excitation][numbers]") {
  const std::string jet =
      GENERATE("kind=\"jet\"", "kind=\"jet\"\nwidth=0.3", "kind=\"table\"\nvalues=[1,0.6,-0.2,0.1,0.3]");
  std::string text = fmt::format(
      "[system]\nmodel = \"sector\"\nwave_number = 1\nsectors = 6\ncontact_stiffness = 0.5\npreload = 0.5\n"
      "harmonics = 31\n[system.base]\nmass = \"{0}/mass.mtx\"\nstiffness = \"{0}/stiffness.mtx\"\n"
      "mass_factor = 0.08\nleft = [1]\nright = [2]\ncontact = [1]\nload = {{ dof = [1], value = [1.0] }}\n"
      "[excitation]\n{1}\n[branch]\nparameter = \"eta\"\nfrom = 0.08\nto = 0.2\n",
      source_folder() + "/problems/engine_orders", jet);
  const TemporaryFolder folder;
  const Case input = read_case(folder.write("case.toml", text));
  const auto all = trace(input.branches.front());
  const TracedBranch& traced = all.front();
  CHECK(traced.branch.complete());
  problems::VerifyOptions options;
  options.most_special = 5;
  options.samples = 0;
  int timed = 0;
  for (const problems::Verification& one :
       problems::verify(traced.request->problem.system, traced.base.harmonics, traced.branch, options)) {
    INFO(jet << ", point " << one.point);
    CHECK(one.power_error < 1e-9);
    if (std::isnan(one.Y_time)) continue;
    ++timed;
    CHECK_THAT(one.Y_time, WithinRel(one.Y_harmonics, 1e-5));
  }
  CHECK(timed >= 3);
}

TEST_CASE("The load of engine orders, a jet and a table is what they say", "[excitation]") {
  const auto load_at = [](const Excitation& load, double theta, int highest) {
    double sum = load.share(0).real();
    for (int h = 1; h <= highest; ++h) sum += std::real(load.share(h) * std::polar(1.0, h * theta));
    return sum;
  };
  const Excitation table{find_excitation_kind("table"), {}, {{1, 0.6, -0.2, 0.1, 0.3, -2}}};
  for (int k = 0; k < 6; ++k)
    CHECK_THAT(load_at(table, 2 * std::numbers::pi * k / 6, 9),
               WithinAbs(table.lists[0][static_cast<std::size_t>(k)], 1e-14));
  CHECK_FALSE(table.is_odd());
  CHECK(Excitation{find_excitation_kind("table"), {}, {{1, 0.6, -0.2, -1, -0.6, 0.2}}}.is_odd());

  const double width = 0.23;
  const Excitation jet{find_excitation_kind("jet"), {width}};
  double square = 0;  // of a pulse of height 1/(2 w) over the part w: sum |p_h|^2/2 + p_0^2
  for (int h = 1; h < 20000; ++h) square += 0.5 * std::norm(jet.share(h));
  CHECK_THAT(square + std::norm(jet.share(0)), WithinRel(1 / (4 * width), 1e-4));
  CHECK(Excitation{find_excitation_kind("jet"), {0}}.share(50) == 1.0);

  const Excitation three{find_excitation_kind("orders"), {}, {{1, 3}, {2, -1}, {0.5, 0}}};
  CHECK(three.is_odd());
  CHECK(std::abs(three.share(1) - std::polar(2.0, 0.5)) < 1e-15);
  CHECK(three.share(3) == -1.0);
  CHECK(three.share(2) == 0.0);
}

TEST_CASE("A load is read from a file as from a list, and told in the resolved case", "[excitation]") {
  const TemporaryFolder folder;
  const auto read = [&](const std::string& values) {
    return read_case(
        folder.write("case.toml",
                     "[system]\nmodel = \"rods\"\nwave_number = 1\nelements = 12\nmass_ratio = "
                     "5.0\nfrequency_ratio = 4.0\n"
                     "interface_stiffness = 1000.0\nforce = 1.0\npreload = 1.0\nharmonics = 5\n[excitation]\n"
                     "kind = \"table\"\nvalues = " +
                         values + "\n[branch]\nparameter = \"eta\"\nfrom = 0.5\nto = 6.0\n"));
  };
  folder.write("load.csv", "# of one turn\n1.0, 0.6\n-0.25,-1, -0.6, 0.25\n");
  const Case from_file = read("\"load.csv\"");
  CHECK(from_file.resolved == read("[1.0, 0.6, -0.25, -1.0, -0.6, 0.25]").resolved);
  CHECK(from_file.branches.front().problem.system.harmonics == std::vector<int>{1, 3, 5});
  folder.write("load.csv", "1.0\n0.6\nx\n");
  CHECK_THAT(error_of([&] { read("\"load.csv\""); }),
             ContainsSubstring("load.csv:3: expected finite numbers"));
}

TEST_CASE("Derivatives under engine orders are those of differences", "[excitation]") {
  const Run run("engine_orders", {"system.harmonics=5"});
  REQUIRE(run.traced.front().branch.complete());
  check_derivatives_along(run.traced.front(), 3, 15);
}

TEST_CASE("One harmonic alone takes its order with its phase", "[excitation]") {
  const auto beta = [](double phase) {
    const Run run("engine_orders", {"excitation.orders=[1]", "excitation.amplitude=[0.8]",
                                    fmt::format("excitation.phase=[{}]", phase), "system.harmonics=1",
                                    "branch.extrema_of=[\"Y\"]"});
    const TracedBranch& traced = run.traced.front();
    const BranchPoint point = landing(traced);
    return std::pair(value(traced, point, "Y"), value(traced, point, "beta"));
  };
  const auto [straight_Y, straight] = beta(0);
  const auto [turned_Y, turned] = beta(0.3);
  CHECK_THAT(turned_Y, WithinRel(straight_Y, 1e-12));
  CHECK_THAT(turned, WithinAbs(straight - 0.3, 1e-11));
}

TEST_CASE("Loads of engine orders that are none are refused", "[excitation]") {
  const TemporaryFolder folder;
  const std::string text =
      "[system]\nmodel = \"rods\"\nwave_number = 1\nelements = 12\nmass_ratio = 5.0\nfrequency_ratio = 4.0\n"
      "interface_stiffness = 1000.0\nforce = 1.0\npreload = 1.0\nharmonics = 5\n[excitation]\n"
      "kind = \"orders\"\norders = [1, 3, 5]\namplitude = [1.0, 0.5, 0.2]\n[branch]\nparameter = \"eta\"\n"
      "from = 0.5\nto = 6.0\n";
  const Mistake mistakes[] = {
      {"orders = [1, 3, 5]", "orders = [3, 1, 5]", ":13", "excitation.orders", "ascend", ""},
      {"orders = [1, 3, 5]", "orders = [1, 3]", ":14", "excitation.amplitude", "as many as orders, got 3",
       ""},
      {"orders = [1, 3, 5]", "orders = [1, 3, 7]", ":13", "excitation.orders",
       "order 7 is not among the harmonics", ""},
      {"orders = [1, 3, 5]", "orders = [1, 2.5, 5]", ":13", "excitation.orders", "whole", "2.5"},
      {"orders = [1, 3, 5]\n", "", "", "excitation.orders", "expected one order or more", ""},
      {"\"orders\"\norders = [1, 3, 5]\namplitude", "\"table\"\nvalues = [1.0, 1.0, 1.0]\namplitude", ":14",
       "excitation.amplitude", "unknown key", ""},
      {"\"orders\"\norders = [1, 3, 5]\namplitude = [1.0, 0.5, 0.2]", "\"table\"\nvalues = [1.0, 1.0, 1.0]",
       ":13", "excitation.values", "differ", ""},
      {"\"orders\"\norders = [1, 3, 5]\namplitude = [1.0, 0.5, 0.2]", "\"table\"\nvalues = \"none.csv\"",
       ":13", "excitation.values", "none.csv", ""}};
  for (const Mistake& mistake : mistakes) {
    const std::string path = folder.write("case.toml", replaced(text, mistake.from, mistake.to));
    check_message(error_of([&] { read_case(path); }), mistake);
  }
}
