// All zeros in a box, by proof: systems whose zeros are known, and functions against fifty digits.

#include <algorithm>

#include "arcslip/formulas/formula.hpp"
#include "arcslip/formulas/functions.hpp"
#include "arcslip/interval/elementary.hpp"
#include "arcslip/interval/enclosed_tape.hpp"
#include "arcslip/interval/zeros_in_box.hpp"
#include "arcslip/structure/precise.hpp"
#include "catch.hpp"
#include "random_systems.hpp"

using namespace arcslip;
using namespace arcslip::testing;

namespace {

ZerosInBox zeros_of(const std::vector<std::string>& unknowns, const std::vector<std::string>& formulas,
                    const Box& box, const BoxOptions& options = {}) {
  FormulaSet set{unknowns, {}, {}};
  for (std::size_t i = 0; i < formulas.size(); ++i)
    set.results.push_back({"F" + std::to_string(i), formulas[i]});
  const Tape tape = compile(set);
  return zeros_in_box(
      [&](const Box& u, std::vector<Interval>& values, std::vector<Interval>& jacobian) {
        enclose(tape, u.data(), std::ssize(u), values, jacobian);
      },
      box, options);
}

/// The first unknown of each zero, in rising order.
std::vector<double> first_of(const ZerosInBox& found) {
  std::vector<double> values;
  for (const Box& zero : found.zeros) values.push_back(median(zero.front()));
  std::sort(values.begin(), values.end());
  return values;
}

PreciseReal precise(const std::string& name, const PreciseReal& x) {
  if (name == "sin") return sin(x);
  if (name == "cos") return cos(x);
  if (name == "tan") return tan(x);
  if (name == "asin") return asin(x);
  if (name == "acos") return acos(x);
  if (name == "atan") return atan(x);
  if (name == "sinh") return sinh(x);
  if (name == "cosh") return cosh(x);
  if (name == "tanh") return tanh(x);
  if (name == "exp") return exp(x);
  if (name == "log") return log(x);
  if (name == "log10") return log10(x);
  if (name == "sqrt") return sqrt(x);
  if (name == "abs") return abs(x);
  return x > 0 ? 1 : -1;
}

/// Where a function has its values, but for a little at the ends.
std::pair<double, double> domain_of(const std::string& name) {
  if (name == "asin" || name == "acos") return {-0.999, 0.999};
  if (name == "log" || name == "log10" || name == "sqrt") return {1e-3, 50};
  if (name == "tan") return {-1.5, 1.5};
  if (name == "sign") return {0.1, 5};
  return {-30, 30};
}

}  // namespace

TEST_CASE("Every function of formulas has an enclosure, which holds what fifty digits give, and its slope") {
  RandomSystems draw(11);
  for (const FormulaFunction& function : functions()) {
    const EnclosedFunction* enclosed = find_enclosed(function.name);
    INFO(function.name);
    REQUIRE(enclosed != nullptr);
    const auto [least, most] = domain_of(function.name);
    for (int i = 0; i < 400; ++i) {
      const double a = draw.uniform(least, most);
      const double b = std::min(most, a + draw.log_uniform(1e-12, 3));
      const double x = i % 3 == 0 ? a : i % 3 == 1 ? b : 0.5 * (a + b);
      const Interval over(a, b);
      const PreciseReal value = precise(function.name, x);
      INFO("over " << a << " to " << b << " at " << x);
      const Interval all = enclosed->value(over);
      CHECK((PreciseReal(all.lower()) <= value && value <= PreciseReal(all.upper())));
      if (function.name != "abs" || a * b > 0) {
        const Interval slope = enclosed->slope(over);
        const double here = function.first(x, function.value(x));
        CHECK(slope.lower() <= here + 1e-13 * (1 + std::abs(here)));
        CHECK(slope.upper() >= here - 1e-13 * (1 + std::abs(here)));
      }
      // Not wider than need be: of a point it is its value.
      const Interval point = enclosed->value(Interval(x));
      CHECK(width(point) <= 1e-13 * (1 + norm(point)));
    }
  }
}

TEST_CASE("Sines over long intervals hold their extrema") {
  CHECK(sine({0, 3}).upper() == 1);
  CHECK(sine({-2, 2}).lower() == -1);
  CHECK(cosine({-1, 1}).upper() == 1);
  CHECK(cosine({3, 4}).lower() == -1);
  CHECK(sine({0, 1}).upper() < 0.85);
  CHECK(cosine({-100, 100}).lower() == -1);
}

TEST_CASE("Zeros of known number are all found, and proven to be all") {
  CHECK(first_of(zeros_of({"x"}, {"x^3 - x"}, {{-5, 5.1}})).size() == 3);
  // Brown's almost linear function of five unknowns: a^4 (6 - 5 a) = 1 has three
  const ZerosInBox brown =
      zeros_of({"a", "b", "c", "d", "e"},
               {"2*a+b+c+d+e-6", "a+2*b+c+d+e-6", "a+b+2*c+d+e-6", "a+b+c+2*d+e-6", "a*b*c*d*e-1"},
               Box(5, Interval(-10, 10)));
  CHECK(brown.proven());
  const std::vector<double> firsts = first_of(brown);
  REQUIRE(firsts.size() == 3);
  for (const double a : firsts) CHECK(std::abs(std::pow(a, 4) * (6 - 5 * a) - 1) < 1e-12);
  // A stirred tank with three steady states: one is not enough.
  const ZerosInBox tank =
      zeros_of({"x", "y"}, {"-x + 0.04*(1-x)*exp(y)", "-y + 8*0.04*(1-x)*exp(y)"}, {{0, 1}, {0, 10}});
  CHECK(tank.proven());
  CHECK(tank.zeros.size() == 3);
  // sin x = x/10 has seven roots.
  CHECK(zeros_of({"x"}, {"sin(x) - x/10"}, {{-20, 20.5}}).zeros.size() == 7);
}

TEST_CASE("Zeros on the border of the box, or of its halves, are found once") {
  for (const double reach : {1.0, 2.0, 4.0}) {
    const ZerosInBox found = zeros_of({"x"}, {"x^3 - x"}, {{-reach, reach}});
    CHECK(found.proven());
    CHECK(found.zeros.size() == 3);
  }
  CHECK(zeros_of({"x"}, {"x^2 - 1"}, {{-1, 0.5}}).zeros.size() == 1);
  CHECK(zeros_of({"x"}, {"x^2 + 1"}, {{-1, 1}}).proven());
}

TEST_CASE("Two zeros 1e-6 apart are two") {
  BoxOptions options;
  options.narrowest = 1e-9;
  const ZerosInBox found = zeros_of({"x", "y"}, {"x^2 - 2.5e-13", "y - x"}, {{-5, 5.1}, {-5, 5.1}}, options);
  CHECK(found.proven());
  const std::vector<double> firsts = first_of(found);
  REQUIRE(firsts.size() == 2);
  CHECK(std::abs(firsts[1] - firsts[0] - 1e-6) < 1e-12);
}

TEST_CASE("Where zeros coincide nothing is proven, but that there are none elsewhere") {
  for (const char* formula : {"(x - 0.3)^2*(x - 2)", "(x - 0.3)^3*(x - 2)"}) {
    const ZerosInBox found = zeros_of({"x"}, {formula}, {{-5, 5.1}});
    CHECK(found.finished);
    CHECK_FALSE(found.proven());
    CHECK(first_of(found).size() == 1);
    REQUIRE(found.undecided.size() == 1);
    CHECK(in(0.3, found.undecided.front().front()));
    CHECK(width(found.undecided.front().front()) < 1e-5);
  }
  // a whole line of them
  CHECK_FALSE(zeros_of({"x", "y"}, {"x - y", "x*y - y^2"}, {{-1, 1}, {-1, 1}}).finished);
}

TEST_CASE("Where a function has no value it has no zero") {
  const ZerosInBox found = zeros_of({"x"}, {"log(x) + x - 1"}, {{-3, 5.1}});
  REQUIRE(found.zeros.size() == 1);
  CHECK(in(1.0, found.zeros.front().front()));
}
