// Formulas: what they mean, and what is said of those that cannot be read.

#include "arcslip/formulas/formula.hpp"

#include <cmath>
#include <numbers>

#include "catch.hpp"

using namespace arcslip;

namespace {

Tape tape_of(const std::string& text) { return compile({.variables = {"x", "y"}, .results = {{"f", text}}}); }

/// At x = -3, y = 2.
double value(const std::string& text) {
  const std::vector<double> at{-3, 2};
  std::vector<double> values(1);
  return tape_of(text).evaluate(at.data(), values.data()) ? values[0] : std::nan("");
}

std::string message(const FormulaSet& set) {
  try {
    compile(set);
  } catch (const FormulaError& error) {
    return error.what();
  }
  return "";
}

std::string message_of(const std::string& text) {
  return message({.variables = {"x", "y"}, .results = {{"f", text, "model.equations.f"}}});
}

}  // namespace

TEST_CASE("Operators bind as they do in mathematics") {
  CHECK(value("1 + 2*3 - 4/8") == 6.5);
  CHECK(value("-x^2") == -9);
  CHECK(value("(-x)^2") == 9);
  CHECK(value("2^-y") == 0.25);
  CHECK(value("2^3^2") == 512);
  CHECK(value("(2^3)^2") == 64);
  CHECK(value("8/4/2") == 1);
  CHECK(value("8/4*2") == 4);
  CHECK(value("8 - 4 - 2") == 2);
  CHECK(value("--x") == -3);
  CHECK(value("2*-x") == 6);
  CHECK(value("-2^-2^0") == -0.5);
  CHECK(value("+x") == -3);
  CHECK(value("1.5e1 + .5 + 2.") == 17.5);
  CHECK(value("  x\n +\ty ") == -1);
  CHECK(value("2*pi") == 2 * std::numbers::pi);
  CHECK(value("e^y") == std::pow(std::numbers::e, 2));
}

TEST_CASE("Whole powers are exact at negative bases, others have no value there") {
  CHECK(value("x^2") == 9);
  CHECK(value("x^3") == -27);
  CHECK(value("x^4") == 81);
  CHECK(value("x^2.0") == 9);
  CHECK(value("x^(1 + 1)") == 9);
  CHECK(value("x^-1") == -1.0 / 3);
  CHECK(value("x^-3") == Approx(-1.0 / 27).epsilon(1e-15));
  CHECK(value("x^0") == 1);
  CHECK(value("(x - x)^0") == 1);
  CHECK(value("x^1") == -3);
  CHECK(value("pow(x, 3)") == -27);
  CHECK(std::isnan(value("x^0.5")));
  CHECK(std::isnan(value("x^y")));  // y may be 2.1 next
  CHECK(value("y^x") == 0.125);
  CHECK(std::isnan(value("sqrt(x)")));
  CHECK(std::isnan(value("log(x)")));
  CHECK(std::isnan(value("1/(x + 3)")));
  CHECK(std::isnan(value("0/(x + 3)")));
  CHECK(std::isnan(value("exp(1000)*y")));
}

TEST_CASE("Each function of formulas is the one of its name") {
  for (const auto& [text, expected] :
       std::vector<std::pair<std::string, double>>{{"sin(y)", std::sin(2)},
                                                   {"cos(y)", std::cos(2)},
                                                   {"tan(y)", std::tan(2)},
                                                   {"asin(y/4)", std::asin(0.5)},
                                                   {"acos(y/4)", std::acos(0.5)},
                                                   {"atan(x)", std::atan(-3)},
                                                   {"sinh(x)", std::sinh(-3)},
                                                   {"cosh(x)", std::cosh(-3)},
                                                   {"tanh(x)", std::tanh(-3)},
                                                   {"exp(x)", std::exp(-3)},
                                                   {"log(y)", std::log(2)},
                                                   {"log10(y)", std::log10(2)},
                                                   {"sqrt(y)", std::sqrt(2)},
                                                   {"abs(x)", 3},
                                                   {"sign(x)", -1},
                                                   {"sign(x + 3)", 0},
                                                   {"min(x, y)", -3},
                                                   {"max(x, y)", 2},
                                                   {"atan2(x, y)", std::atan2(-3, 2)}}) {
    INFO(text);
    CHECK(value(text) == expected);
  }
  CHECK(std::isnan(value("min(sqrt(x), y)")));
  CHECK(std::isnan(value("max(y, sqrt(x))")));
}

TEST_CASE("What two formulas share is evaluated once, and what none needs not at all") {
  const FormulaSet set{.variables = {"x", "y"},
                       .definitions = {{"rate", "k*exp(-y)"}, {"k", "x*y"}, {"idle", "sin(cos(x))"}},
                       .results = {{"a", "rate - x"}, {"b", "y*x*exp(-y) + rate"}}};
  const Tape tape = compile(set);  // x y, -y, exp, rate, rate - x, rate + rate
  CHECK(tape.operations() == 6);
  const std::vector<double> at{3, 0.5};
  std::vector<double> values(2);
  REQUIRE(tape.evaluate(at.data(), values.data()));
  CHECK(values[0] == 1.5 * std::exp(-0.5) - 3);
  CHECK(values[1] == 2 * (1.5 * std::exp(-0.5)));
  CHECK(tape_of("2*(3 + 4)").operations() == 0);
  CHECK(tape.uses(1));
  CHECK_FALSE(tape_of("x^2").uses(1));
}

TEST_CASE("Formulas that are iterated take the place of their variables") {
  const Tape tape = compile({.variables = {"x", "y", "r"},
                             .definitions = {{"left", "1 - x"}},
                             .results = {{"x", "r*x*left"}, {"y", "x"}},
                             .iterations = 3});
  double x = 0.3, y = 0;
  for (int i = 0; i < 3; ++i) {
    y = x;
    x = 3.5 * x * (1 - x);
  }
  const std::vector<double> at{0.3, 0, 3.5};
  std::vector<double> values(2);
  REQUIRE(tape.evaluate(at.data(), values.data()));
  CHECK(values[0] == x);
  CHECK(values[1] == y);
}

TEST_CASE("A formula that cannot be read is told with the place of the mistake") {
  const std::string at = "model.equations.f: ";
  const std::vector<std::pair<std::string, std::string>> mistakes{
      {"x - z", "unknown name \"z\" at column 5 of \"x - z\"; there are x, y"},
      {"x -", "expected a number, a name or \"(\" at column 4 of \"x -\""},
      {"", "expected a number, a name or \"(\" at column 1 of \"\""},
      {"2 x", "expected one of + - * / ^ or the end at column 3 of \"2 x\""},
      {"x < y", "expected one of + - * / ^ or the end at column 3 of \"x < y\""},
      {"x) + y", "expected one of + - * / ^ or the end at column 2 of \"x) + y\""},
      {"(x + y", "expected \")\" or one of + - * / ^ at column 7 of \"(x + y\""},
      {"x * * y", "expected a number, a name or \"(\" at column 5 of \"x * * y\""},
      {"sin x", "expected \"(\" after sin at column 5 of \"sin x\""},
      {"sin(x, y)", "expected \")\" after the one number of sin at column 6 of \"sin(x, y)\""},
      {"min(x)", "expected \",\" and a second number of min at column 6 of \"min(x)\""},
      {"max(x, y, x)", "expected \")\" after the two numbers of max at column 9 of \"max(x, y, x)\""},
      {"1e999", "expected a number that is neither too large nor too small at column 1 of \"1e999\""},
      {"x + \n\xc3\xa4 + z", "expected a number, a name or \"(\" at column 6 of \"x +  \xc3\xa4 + z\""},
      {"\xc3\xa4", "expected a number, a name or \"(\" at column 1 of \"\xc3\xa4\""},
      {"x[1]", "expected one of + - * / ^ or the end at column 2 of \"x[1]\""}};
  for (const auto& [text, expected] : mistakes) CHECK(message_of(text) == at + expected);
  CHECK(message_of("sen(x)").starts_with(at +
                                         "unknown function \"sen\" at column 1 of \"sen(x)\"; there are "));
  CHECK(message_of(std::string(5000, '(')).starts_with(at + "nested more than 500 deep at column 501"));
  CHECK(message_of(std::string(5000, '-') + "x").starts_with(at + "nested more than 500 deep"));
  CHECK(message_of("x" + std::string(4000, ' ') + "z").size() < 250);
  CHECK(message({.variables = {"x"}, .results = {{"f", "x - t"}}, .refused = {{"t", "is the time"}}}) ==
        "f: \"t\" at column 5 of \"x - t\" is the time");
}

TEST_CASE("Definitions may stand in any order but not go in a circle") {
  CHECK(message({.variables = {"x"}, .definitions = {{"a", "b"}, {"b", "x"}}, .results = {{"f", "a"}}})
            .empty());
  CHECK(message({.variables = {"x"},
                 .definitions = {{"a", "b + 1"}, {"b", "x*c"}, {"c", "2*b"}},
                 .results = {{"f", "x"}}}) == "b: is defined by itself: b -> c -> b");
  CHECK(message({.variables = {"x"}, .definitions = {{"a", "z", "model.definitions.a"}}, .results = {}}) ==
        "model.definitions.a: unknown name \"z\" at column 1 of \"z\"; there are x, a");
  FormulaSet chain{.variables = {"x"}, .results = {{"f", "d0"}}};
  for (int i = 0; i < 100; ++i)
    chain.definitions.push_back({"d" + std::to_string(i), i < 99 ? "d" + std::to_string(i + 1) : "x"});
  CHECK(message(chain).empty());
}

TEST_CASE("Names that formulas could not tell apart are refused") {
  for (const char* name : {"x", "_", "K_FD", "x1", "E", "sine"}) CHECK(why_no_name(name).empty());
  for (const char* name : {"", "1x", "a-b", "a.b", "a b", "\xc3\xa4", "sin", "min", "pi", "e", "t"})
    CHECK_FALSE(why_no_name(name).empty());
}
