// What is told of Hopf points.

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "catch.hpp"
#include "program.hpp"
#include "results/answer.hpp"

using namespace arcslip;
using namespace arcslip::testing;

TEST_CASE("Hopf points tell how cycles leave them") {
  const TemporaryFolder folder;
  const Outcome run = arcslip_program("run " + case_named("ab") + " -o " + folder.path("r"));
  REQUIRE(run.status == 0);
  const auto summary = nlohmann::ordered_json::parse(read(folder.path("r/summary.json")));
  const std::vector<std::string> answer = run_answer(summary);
  CHECK(std::find(answer.begin(), answer.end(), "Of 2 Hopf points 1 is supercritical, 1 subcritical.") !=
        answer.end());
  std::vector<double> found;
  for (const auto& point : summary["branches"][0]["special"]) {
    CHECK(point.contains("lyapunov") == (point["type"] == "hopf"));
    if (point.contains("lyapunov")) found.push_back(point["lyapunov"]);
  }
  REQUIRE(found.size() == 2);
  // By both formulas of the normal form, with the derivatives in closed form.
  CHECK_THAT(found[0], WithinRel(7.5425873845, 1e-7));
  CHECK_THAT(found[1], WithinRel(-0.4012043558, 1e-7));
}
