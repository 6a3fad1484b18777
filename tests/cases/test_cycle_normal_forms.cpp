// What is told of the normal forms of points of codimension two.

#include "arcslip/results/results.hpp"
#include "cycle_cases.hpp"
#include "results/answer.hpp"

namespace {

using namespace arcslip;
using namespace arcslip::testing;

}  // namespace

TEST_CASE("Points of codimension two have their normal forms in summaries", "[cycles]") {
  const Run run("lorenz84_fold_curve", {"branch.switching=true", "continuation.max_branches=3"});
  const nlohmann::ordered_json summary = summarize(run.input, run.traced, 0);
  int takens = 0, bautin = 0, double_hopf = 0;
  for (const auto& branch : summary["branches"]) {
    for (const auto& point : branch["special"]) {
      const std::string type = point["type"];
      const bool has_form = type == "bogdanov_takens" || type == "zero_hopf" || type == "hopf_hopf" ||
                            type == "generalized_hopf" || type == "cusp";
      REQUIRE(point.contains("normal_form") == has_form);
      if (!has_form) continue;
      const auto of = [&](const char* name) { return point["normal_form"][name].get<double>(); };
      if (type == "bogdanov_takens") {  // BifurcationKit.jl, lorenz84.jl
        ++takens;
        CHECK_THAT(of("a"), WithinRel(0.2144233509273467, 1e-10));
        CHECK_THAT(of("b"), WithinRel(0.6065145518280868, 1e-10));
      }
      if (type == "generalized_hopf") {  // there Re G32/12, of a point that is met by steps
        ++bautin;
        CHECK_THAT(of("l2") * of("omega"), WithinRel(1.8694569030805148 / 12, 2e-4));
      }
      if (type == "hopf_hopf") ++double_hopf;  // the same from both curves
      if (type == "hopf_hopf") CHECK_THAT(of("theta"), WithinRel(-3.64855116318, 1e-9));
      if (type == "zero_hopf") CHECK_THAT(of("theta"), WithinRel(0.74303, 1e-5));
      CHECK(of("error") < 1e-9);
    }
  }
  CHECK(takens == 2);
  CHECK(bautin == 1);
  CHECK(double_hopf == 2);
  const std::vector<std::string> answer = run_answer(summary);
  for (const char* sentence :
       {"At the generalised Hopf point l2 is positive: the outer one of the two cycles is unstable.",
        "Of 2 Bogdanov-Takens points 0 have negative a b: there the cycle beside it is stable."}) {
    INFO(sentence);
    CHECK(std::find(answer.begin(), answer.end(), sentence) != answer.end());
  }
}

TEST_CASE("A cusp where folds meet the trivial state of a symmetric system is told", "[cycles]") {
  const auto traced = traced_of(R"case(
[model.parameters]
mu = -0.2
a = 1
[model.equations]
x = "mu*x + a*x^3 - x^5"
[model.start]
x = 1.17
[branch]
curve = "fold"
parameters = ["mu", "a"]
window = [0.5, -0.5]
from = -0.5
to = 1.5
)case");
  int told = 0;
  for (const TracedBranch& one : traced) {
    const auto summary = summarize(0, one);
    for (const auto& point : summary["special"]) {
      INFO(point.dump());
      if (point["type"] != "cusp") continue;
      CHECK_FALSE(point["normal_form"]["regular"].get<bool>());
      ++told;
    }
  }
  CHECK(told > 0);
}
