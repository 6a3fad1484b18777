// What comes out of a case does not hang on the length of its steps, nor on how far it goes.

#include "cycle_cases.hpp"

namespace {

using namespace arcslip;
using namespace arcslip::testing;

std::string with_steps(double longest) { return fmt::format("[continuation]\nmax_step = {}\n", longest); }

}  // namespace

TEST_CASE("Each end of a canard explosion has its fold", "[cycles]") {
  for (const double step : {0.01, 0.1, 0.3}) {
    INFO(step);
    const auto all = traced_of(R"case([model.parameters]
I = 0
[model.equations]
v = "v - v^3/3 - w + I"
w = "0.08*(v + 0.7 - 0.8*w)"
[model.start]
v = -1.2
w = -0.6
[branch]
parameter = "I"
from = 0
to = 2
switching = true
)case" + with_steps(step));
    REQUIRE(all.size() == 2);
    // by multiple shooting in 60 parts to 1e-13, and its image about I = 0.875
    check_values(values_at(all[1], PointType::fold, "I"), {0.3241785225037, 1.4258214774963}, 1e-8);
  }
}

TEST_CASE("A pitchfork of cycles sheds its branch wherever steps end", "[cycles]") {
  for (const double step : {0.03, 0.0908, 0.1}) {
    INFO(step);
    const auto all = traced_of(R"case([model]
kind = "forced"
period = "2*pi/W"
[model.parameters]
g = 0.2
W = 0.6666666666666666
[model.equations]
th = "v"
v = "-v/2 - sin(th) + g*cos(W*t)"
[branch]
parameter = "g"
from = 0.2
to = 1.2
switching = true
[cycles]
doublings = 0
)case" + with_steps(step));
    REQUIRE(all.size() >= 2);
    check_values(values_at(all[0], PointType::branch_point, "g"), {1.00431948}, 1e-7);
    const std::vector<double> doublings = values_at(all[1], PointType::period_doubling, "g");
    REQUIRE(!doublings.empty());
    CHECK_THAT(doublings[0], WithinAbs(1.06637286, 1e-7));  // by shooting to 1e-12
  }
}

TEST_CASE("A start that leads to a solution is kept, whatever lies about it", "[boundary]") {
  for (const double step : {0.01, 0.1, 0.3}) {
    for (const double to : {6, 10}) {
      const auto all = traced_of(
          R"case([model]
kind = "boundary"
interval = { x = [0, 1] }
parameters = { n = 0.5 }
equations = { y = "z", z = "n*sinh(n*y)" }
conditions = ["y_left", "y_right - 1"]
[model.start]
y = "x"
z = 1
[branch]
parameter = "n"
from = 0.5
)case" + fmt::format("to = {}\n", to) +
          with_steps(step));
      REQUIRE(all.size() == 1);
      CHECK(all[0].branch.complete());
      CHECK_THAT(values_at(all[0], PointType::start, "z_left").at(0), WithinRel(0.9590437954132, 1e-6));
    }
  }
}
