// Curves in two parameters on which special points lie close to each other, or another pair of eigenvalues
// comes near the one that is on the axis, in closed form.

#include <fmt/format.h>

#include "cycle_cases.hpp"

namespace {

using namespace arcslip;
using namespace arcslip::testing;

/// A curve over p, from -p to p, and a second parameter.
std::string curve_over(const std::string& type, const std::string& second, double p, double from, double to) {
  return fmt::format(
      "[branch]\ncurve = \"{}\"\nparameters = [\"p\", \"{}\"]\nwindow = [{}, {}]\nfrom = {}\nto = {}\n", type,
      second, -p, p, from, to);
}

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
)case" + curve_over("hopf", "q", 1, -1, 1);

// z -> (1 + p + (th - thc) |z|^2) e^(i th) z: a Neimark-Sacker point at p = 0, with the coefficient th - thc
// but at the resonance th = 2 pi/3, where it is not defined.
const std::string resonant_map = R"case(
[model]
kind = "map"
[model.parameters]
p = -0.5
th = 1.9
thc = 2
[model.definitions]
X = "cos(th)*x - sin(th)*y"
Y = "sin(th)*x + cos(th)*y"
c = "(th - thc)*(x^2 + y^2)"
[model.equations]
x = "(1 + p)*X + c*X"
y = "(1 + p)*Y + c*Y"
)case" + curve_over("neimark_sacker", "th", 0.5, 1.5, 2.9);

// The period doubling's coefficient vanishes at q = del, where y has a multiplier 1 at q = 0.
const std::string doublings_beside_one = R"case(
[model]
kind = "map"
[model.parameters]
p = -0.5
q = 0.5
del = 0.02
[model.equations]
x = "-(1 + p)*x + (q - del)*x^3"
y = "(1 + q)*y + y^3"
)case" + curve_over("period_doubling", "q", 0.5, -1, 1);

// A Hopf point at p = 0 whose coefficient vanishes at q = del; another pair of the same frequency is on the
// axis at q = 0.
const std::string equal_frequencies = R"case(
[model.parameters]
p = -0.5
q = 0.5
del = 0.02
[model.equations]
x = "p*x - y + (q - del)*x*(x^2 + y^2)"
y = "x + p*y + (q - del)*y*(x^2 + y^2)"
z = "q*z - w - z^3"
w = "z + q*w"
)case" + curve_over("hopf", "q", 0.5, -1, 1);

// Along the doublings at p = 0 the coefficient is 1 + g/q, as y = x^2/q follows: it vanishes at q = -g,
// beside its pole at the fold-flip point q = 0.
const std::string doublings_beside_pole = R"case(
[model]
kind = "map"
[model.parameters]
p = -0.5
q = 0.5
g = 0.01
[model.equations]
x = "-(1 + p)*x + g*x*y + x^3"
y = "(1 - q)*y + x^2 - y^2"
)case" + curve_over("period_doubling", "q", 0.5, -0.5, 1);

// The same of Neimark-Sacker points.
const std::string turning_beside_pole = R"case(
[model]
kind = "map"
[model.parameters]
p = -0.5
q = 0.5
g = 0.01
[model.equations]
x = "(1 + p)*(1 + g*z + x^2 + y^2)*(cos(1)*x - sin(1)*y)"
y = "(1 + p)*(1 + g*z + x^2 + y^2)*(sin(1)*x + cos(1)*y)"
z = "(1 - q)*z + x^2 + y^2 - z^2"
)case" + curve_over("neimark_sacker", "q", 0.5, -0.5, 1);

/// That a curve tells one point of this type, at this value.
void check_one(const std::string& system, const std::string& set, PointType type,
               const std::string& parameter, double expected) {
  for (const std::string step : {"0.3", "0.1", "0.03"}) {
    INFO(set << ", step " << step);
    const auto all = traced_of(system, {"model.parameters." + set, "continuation.max_step=" + step});
    REQUIRE(!all.empty());
    check_values(values_at(all.front(), type, parameter), {expected}, 1e-7);
  }
}

}  // namespace

TEST_CASE("Coefficients that vanish right behind a special point are told", "[cycles]") {
  constexpr double third = 2 * pi / 3;
  for (const double aside : {-0.1, -0.003, 0.0005, 0.02, 0.1}) {
    check_one(resonant_map, fmt::format("thc={}", third + aside), PointType::chenciner, "th", third + aside);
    const std::string del = fmt::format("del={}", aside);
    check_one(doublings_beside_one, del, PointType::generalized_period_doubling, "q", aside);
    check_one(equal_frequencies, del, PointType::generalized_hopf, "q", aside);
  }
}

TEST_CASE("Coefficients that vanish beside a pole of theirs are told", "[cycles]") {
  for (const double aside : {-0.05, -0.01, -0.0003, 0.0007, 0.02, 0.06}) {
    const std::string g = fmt::format("g={}", -aside);
    check_one(doublings_beside_pole, g, PointType::generalized_period_doubling, "q", aside);
    check_one(turning_beside_pole, g, PointType::chenciner, "q", aside);
    check_one(doublings_beside_pole, g, PointType::fold_flip, "q", 0);
    check_one(turning_beside_pole, g, PointType::fold_neimark_sacker, "q", 0);
  }
}

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

TEST_CASE("Where two multipliers meet at -1 no pair of others is told", "[cycles]") {
  // In turned coordinates, where rounding parts them by its root; the third one stays where it is.
  for (const char* third : {"-0.75", "-0.4", "0.3", "0.6", "0.85"}) {
    for (const char* step : {"0.1", "0.03"}) {
      CAPTURE(third, step);
      const auto all = traced_of(fmt::format(R"case(
[model]
kind = "map"
[model.parameters]
trace = -1.5
det = 0.5
[model.definitions]
p = "0.28*y + 0.96*z"
a = "0.8*x + 0.6*p"
b = "0.8*p - 0.6*x"
c = "0.28*z - 0.96*y"
next_a = "b - 0.1*a^3"
next_b = "trace*b - det*a"
next_c = "{}*c + 0.5*a - 0.3*b"
next_p = "0.6*next_a + 0.8*next_b"
[model.equations]
x = "0.8*next_a - 0.6*next_b"
y = "0.28*next_p - 0.96*next_c"
z = "0.96*next_p + 0.28*next_c"
[branch]
curve = "period_doubling"
parameters = ["trace", "det"]
window = [-2.6, -1.2]
from = 0.3
to = 1.5
[continuation]
max_step = {}
)case",
                                             third, step));
      REQUIRE(all.size() == 1);
      CHECK(all[0].branch.complete());
      CHECK(count(all[0], PointType::flip_neimark_sacker) == 0);
      check_values(values_at(all[0], PointType::resonance_1_2, "trace"), {-2}, 1e-9);
    }
  }
}

TEST_CASE("Rounding beside a strong resonance is no degenerate Neimark-Sacker point", "[cycles]") {
  // the coefficient has its pole at a = 0.0292; it vanishes twice elsewhere
  const std::string map = R"case([model]
kind = "map"
[model.parameters]
a = 0
b = 0
[model.equations]
x = "-0.123*x + 0.016*y - 1.463*z - 0.172*a + 0.224*b - 0.378*b*y + 0.324*b*z + 0.059*x*y - 0.031*x*z + 0.439*y^2 + 0.084*z^2 - 0.3*x^3"
y = "-2.968*x + 0.225*y - 0.243*z + 0.013*a + 0.029*a*x + 0.843*b + 0.458*x*y - 0.101*y^2 - 0.968*y*z + 0.246*z^2 - 0.3*y^3"
z = "1.303*x + 0.491*y + 0.534*z - 0.768*a - 0.555*a*x + 0.957*a*y + 0.013*a*z - 0.024*b + 0.288*b*y - 0.348*b*z - 0.084*x^2 - 0.441*x*y - 0.652*x*z + 0.127*y^2 + 0.145*y*z - 0.55*z^2 - 0.3*z^3"
[branch]
curve = "neimark_sacker"
parameters = ["a", "b"]
window = [-1, 1]
from = -1
to = 1
)case";
  for (const char* max_step : {"0.7", "0.5", "0.1"}) {
    const auto all = traced_of(map, {fmt::format("continuation.max_step={}", max_step)});
    CAPTURE(max_step);
    check_values(all_values_at(all, PointType::chenciner, "a"), {-0.00706894456, 0.025268127771}, 1e-8);
    check_values(all_values_at(all, PointType::resonance_1_3, "a"), {0.029203030747}, 1e-8);
  }
}
