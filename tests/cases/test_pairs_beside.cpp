// Curves in two parameters of Hopf points on which another pair of eigenvalues comes near the one that is on
// the axis, in closed form.

#include "cycle_cases.hpp"

namespace {

using namespace arcslip;
using namespace arcslip::testing;

// Of x + i y and z + i w: eigenvalues i omega where p = a k/(a^2 + d^2), omega = 1 + k d/(a^2 + d^2) with k =
// 0.04 and d = q - (omega - 1). The other pair is 2 a - that one about, a little beside the axis.
const std::string two_oscillators = R"case(
[model.parameters]
p = -1
q = 0.5
a = 0.05
h = 0.2
g = 0.2
[model.equations]
x = "p*x - y + h*z - x*(x^2 + y^2)"
y = "x + p*y + h*w - y*(x^2 + y^2)"
z = "a*z - (1 + q)*w + g*x"
w = "(1 + q)*z + a*w + g*y"
[branch]
curve = "hopf"
parameters = ["p", "q"]
window = [-1, 1]
from = -1
to = 1
)case";

}  // namespace

TEST_CASE("Curves of Hopf points pass where another pair is near", "[cycles]") {
  constexpr double a = 0.05;
  constexpr double k = 0.04;
  const auto frequency = [](double d) { return 1 + k * d / (a * a + d * d); };
  // q is extreme where (a^2 + d^2)^2 = k (d^2 - a^2)
  const double root = std::sqrt(k * k - 8 * k * a * a);
  const double far = std::sqrt((k + root) / 2 - a * a);
  const double near = std::sqrt((k - root) / 2 - a * a);
  const auto q_at = [&](double d) { return d + frequency(d) - 1; };
  for (const std::string step : {"0.5", "0.1", "0.02"}) {
    INFO(step);
    const auto all = traced_of(two_oscillators, {"continuation.max_step=" + step});
    REQUIRE(all.size() == 1);
    const TracedBranch& curve = all.front();
    CHECK(curve.branch.complete());
    CHECK(count(curve, PointType::fold) == 4);
    check_values(values_at(curve, PointType::fold, "q"), {-q_at(far), -q_at(near), q_at(near), q_at(far)},
                 1e-9);
    check_values(values_at(curve, PointType::peak, "p"), {k / a}, 1e-9);
    for (const BranchPoint& point : curve.branch.points) {
      const double q = value(curve, point, "q");
      const double omega = value(curve, point, "omega");
      const double d = q - (omega - 1);
      CHECK(omega == Approx(frequency(d)).epsilon(1e-7));
      CHECK(value(curve, point, "p") == Approx(a * k / (a * a + d * d)).epsilon(1e-6));
    }
  }
}
