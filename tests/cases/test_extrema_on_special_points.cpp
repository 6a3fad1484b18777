// Observables that are extremal exactly where a branch has a special point, at which both are told.

#include <random>

#include "case_runs.hpp"
#include "cycle_cases.hpp"

namespace {

using namespace arcslip;
using namespace arcslip::testing;

/// A branch over lam along which `floor` + (x - c)^2 is least at x = c alone.
struct Branched {
  std::string equation;
  double c;
  double from, start;  // lam and x
  double to;
  double value;                    // of lam at c
  std::vector<double> folds = {};  // of lam, ascending
  std::size_t branch_points = 0;
};

void check(const Branched& one, double floor, double step) {
  INFO(one.equation << ", " << floor << ", step " << step);
  const auto all =
      traced_of(fmt::format(R"case([model]
kind = "algebraic"
parameters = {{ lam = {:.17g} }}
equations = {{ x = "{}" }}
observables = {{ q = "{} + (x - ({:.17g}))^2" }}
start = {{ x = {:.17g} }}
[branch]
parameter = "lam"
from = {:.17g}
to = {:.17g}
extrema_of = ["q"]
[continuation]
max_step = {}
)case",
                            one.from, one.equation, floor, one.c, one.start, one.from, one.to, step));
  REQUIRE(all.size() == 1);
  INFO(all[0].branch.explanation);
  CHECK((all[0].branch.stop == Stop::reached_end || all[0].branch.stop == Stop::left_range));
  check_values(values_at(all[0], PointType::trough, "lam"), {one.value}, 1e-9);
  CHECK(values_at(all[0], PointType::peak, "lam").empty());
  check_values(all_values_at(all, PointType::fold, "lam"), one.folds, 1e-9);
  check_values(values_at(all[0], PointType::branch_point, "lam"),
               std::vector<double>(one.branch_points, one.value), 1e-9);
}

}  // namespace

TEST_CASE("What is extremal on a fold or a branch point loses neither, be it zero there or not") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 12; ++i) {
    const double c = 2 * unit(random) - 1;
    const double at = 2 * unit(random) - 1;
    const double a = 0.3 + 2 * unit(random);
    const double d = (i % 2 == 0 ? 1 : -1) * (0.05 + 0.5 * unit(random));
    const std::string linear = fmt::format("(lam - ({:.17g}))*(x - ({:.17g})) - {:.17g}", at, c, a);
    const Branched pitchfork{
        fmt::format("{}*(x - ({:.17g}))^3", linear, c), c, at + 1, c - 1 / std::sqrt(a), at - 0.5, at, {}, 1};
    const Branched transcritical{
        fmt::format("{}*(x - ({:.17g}))^2", linear, c), c, at - 1, c - 1 / a, at + 1, at, {}, 1};
    const auto lam = [&](double x) { return x * x * x / 3 - (2 * c + d) * x * x / 2 + c * (c + d) * x; };
    const Branched folds{fmt::format("lam - (x^3/3 - ({:.17g})*x^2/2 + ({:.17g})*x)", 2 * c + d, c * (c + d)),
                         c,
                         lam(-3),
                         -3,
                         lam(3),
                         lam(c),
                         {std::min(lam(c), lam(c + d)), std::max(lam(c), lam(c + d))}};
    for (const double step : {0.02, 0.1, 0.3}) {
      for (const double floor : {0.0, 1.0}) {
        for (const Branched* one : {&pitchfork, &transcritical, &folds}) check(*one, floor, step);
      }
    }
  }
}
