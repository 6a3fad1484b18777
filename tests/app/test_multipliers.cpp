// What is told of the stability of cycles.

#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "program.hpp"

using namespace arcslip;
using namespace arcslip::testing;

TEST_CASE("Special points of cycles tell their multipliers, and the angle of a torus") {
  // A circle of radius 1 and T = 2 pi with the multipliers e^(-4 pi) and e^(2 pi (a +- 0.15 j))
  const TemporaryFolder folder;
  const std::string file = folder.write("case.toml", R"case([model.parameters]
a = -0.1
[model.definitions]
s = "x^2 + y^2"
[model.equations]
x = "x - y - x*s"
y = "x + y - y*s"
z = "a*z - 0.15*w + 0.1*x*z"
w = "0.15*z + a*w + 0.1*x*w"
[model.start]
x = 1
[cycles]
settle = 30
[branch]
parameter = "a"
from = -0.1
to = 0.1
)case");
  REQUIRE(arcslip_program("run " + file + " -o " + folder.path("r")).status == 0);
  const auto summary = nlohmann::json::parse(read(folder.path("r/summary.json")));
  const auto& special = summary["branches"][0]["special"];
  REQUIRE(special.size() == 3);
  for (const auto& point : special) {
    const double a = point["a"];
    const double size = std::exp(2 * pi * a);
    const auto& found = point["multipliers"];
    REQUIRE(found.size() == 3);
    for (const std::size_t i : {0, 1}) {
      CHECK_THAT(found[i][0].get<double>(), WithinAbs(size * std::cos(0.3 * pi), 1e-6));
      CHECK_THAT(found[i][1].get<double>(), WithinAbs((i == 0 ? 1 : -1) * size * std::sin(0.3 * pi), 1e-6));
    }
    CHECK_THAT(found[2][0].get<double>(), WithinRel(std::exp(-4 * pi), 1e-4));
    CHECK(point.contains("angle") == (point["type"] == "neimark_sacker"));
  }
  CHECK(special[1]["type"] == "neimark_sacker");
  CHECK_THAT(special[1]["angle"].get<double>(), WithinAbs(0.3 * pi, 1e-7));
}
