// Curves of Hopf points where a real eigenvalue vanishes as well: there the first Lyapunov coefficient has a
// pole, or equilibria cross.

#include <fmt/format.h>

#include "cycle_cases.hpp"

namespace {

using namespace arcslip;
using namespace arcslip::testing;

std::string hopf_curve(const std::string& model, const std::string& window, double max_step,
                       const std::string& more = "") {
  return model + "[branch]\ncurve = \"hopf\"\nparameters = [\"a\", \"b\"]\nwindow = " + window +
         fmt::format("\nfrom = -1\nto = 1\n{}[continuation]\nmax_step = {}\n", more, max_step);
}

}  // namespace

TEST_CASE("A degenerate Hopf point is found however near the pole at a zero-Hopf point", "[cases]") {
  // a = -x^2, b = -x; of z = u + j v the coefficient is 1 - s/(2 x), which vanishes at x = s/2
  for (const double s : {0.6, 0.02, -0.02, 2e-4}) {
    for (const double max_step : {0.3, 0.1, 0.05, 0.02}) {
      const auto all = traced_of(hopf_curve(
          fmt::format("[model.parameters]\na = -0.49\nb = -0.9\n[model.equations]\nx = \"a + x^2 + "
                      "{}*(u^2 + v^2)\"\nu = \"(b + x)*u - 1.3*v + u*(u^2 + v^2)\"\nv = \"1.3*u + (b + x)*v "
                      "+ v*(u^2 + v^2)\"\n[model.start]\nx = -0.7\n",
                      s),
          "[-2, 2]", max_step));
      CAPTURE(s, max_step);
      check_values(all_values_at(all, PointType::generalized_hopf, "b"), {-0.5 * s}, 1e-9);
      check_values(all_values_at(all, PointType::zero_hopf, "b"), {0}, 1e-9);
    }
  }
}

TEST_CASE("Where equilibria cross on a curve of Hopf points there is a zero-Hopf point", "[cases]") {
  // of x = 0, which crosses x = b + 0.3 a where that vanishes
  for (const double max_step : {0.02, 0.03, 0.05, 0.07, 0.1, 0.13, 0.2}) {
    const auto all = traced_of(hopf_curve(
        "[model.parameters]\na = -1\nb = -0.73\n[model.equations]\nx = \"x*(b + 0.3*a - x) + 0.3*(u^2 + "
        "v^2)*x\"\nu = \"(a + 0.4*x)*u - v - u*(u^2 + v^2)\"\nv = \"u + (a + 0.4*x)*v - v*(u^2 + v^2)\"\n",
        "[-2, 2]", max_step, "switching = true\n"));
    CAPTURE(max_step);
    REQUIRE(all.size() >= 2);  // the curve on which they cross follows
    CHECK(count(all[0], PointType::branch_point) == 0);
    check_values(values_at(all[0], PointType::zero_hopf, "b"), {0}, 1e-9);
    for (const BranchPoint& point : all[1].branch.points)
      CHECK_THAT(value(all[1], point, "b"), WithinAbs(-0.3 * value(all[1], point, "a"), 1e-9));
  }
}
