// Derivatives of formulas: against closed forms, and against differences.

#include "arcslip/formulas/tape.hpp"

#include <algorithm>
#include <cmath>

#include "arcslip/formulas/formula.hpp"
#include "catch.hpp"

using namespace arcslip;

namespace {

struct Derivatives {
  double value = 0, first = 0, second = 0;
};

/// Of a formula of x.
Derivatives at(const std::string& text, double x) {
  const Tape tape = compile({.variables = {"x"}, .results = {{"f", text}}});
  Derivatives found;
  REQUIRE(tape.evaluate(&x, &found.value, &found.first));
  const double one = 1;
  REQUIRE(tape.second(&x, &one, &one, &found.second));
  return found;
}

/// Along x + h.
Series series_at(const std::string& text, double x) {
  const Tape tape = compile({.variables = {"x"}, .results = {{"f", text}}});
  const Series along{x, 1};
  Series found{};
  REQUIRE(tape.series(&along, &found));
  return found;
}

void check_near(double value, double expected) {
  CHECK_THAT(value,
             Catch::Matchers::WithinRel(expected, 1e-13) || Catch::Matchers::WithinAbs(expected, 1e-14));
}

/// A formula of three variables that has each operation, at places where each has a value.
const FormulaSet mixed{.variables = {"x", "y", "z"},
                       .definitions = {{"s", "sin(x*y) + tanh(z)"}, {"r", "sqrt(x^2 + y^2)"}},
                       .results = {{"a", "s^2*r - atan2(y, x)/(1 + z^2)"},
                                   {"b", "r^z*exp(-s) + x^-3 + y^1.7"},
                                   {"c", "min(x*z, y)*max(s, r) + abs(s - r)*log10(r)"},
                                   {"d", "log(y)*cosh(z) + atan(s)*sinh(x) + tan(s/5) + acos(s/9)*asin(z/9)"},
                                   {"e0", "y"},
                                   {"f", "7"}}};
const std::vector<std::vector<double>> places{{0.7, 1.3, 0.4}, {-1.1, 0.6, 1.9}, {2.2, 0.3, -0.8}};

}  // namespace

TEST_CASE("Derivatives of each function are those of the textbook") {
  for (const double x : {0.3, 0.8}) {
    const double s = std::sin(x), c = std::cos(x), q = 1 - x * x;
    const std::vector<std::pair<std::string, Derivatives>> known{
        {"sin(x)", {s, c, -s}},
        {"cos(x)", {c, -s, -c}},
        {"tan(x)", {s / c, 1 / (c * c), 2 * s / (c * c * c)}},
        {"asin(x)", {std::asin(x), std::pow(q, -0.5), x * std::pow(q, -1.5)}},
        {"acos(x)", {std::acos(x), -std::pow(q, -0.5), -x * std::pow(q, -1.5)}},
        {"atan(x)", {std::atan(x), 1 / (1 + x * x), -2 * x / ((1 + x * x) * (1 + x * x))}},
        {"sinh(x)", {std::sinh(x), std::cosh(x), std::sinh(x)}},
        {"cosh(x)", {std::cosh(x), std::sinh(x), std::cosh(x)}},
        {"tanh(x)",
         {std::tanh(x), std::pow(std::cosh(x), -2), -2 * std::tanh(x) * std::pow(std::cosh(x), -2)}},
        {"exp(x)", {std::exp(x), std::exp(x), std::exp(x)}},
        {"log(x)", {std::log(x), 1 / x, -1 / (x * x)}},
        {"log10(x)", {std::log10(x), 1 / (x * std::log(10)), -1 / (x * x * std::log(10))}},
        {"sqrt(x)", {std::sqrt(x), 0.5 * std::pow(x, -0.5), -0.25 * std::pow(x, -1.5)}},
        {"abs(x)", {x, 1, 0}},
        {"abs(-x)", {x, 1, 0}},
        {"sign(x)", {1, 0, 0}},
        {"min(x, 2*x)", {x, 1, 0}},
        {"max(x, 2*x)", {2 * x, 2, 0}},
        {"x^2", {x * x, 2 * x, 2}},
        {"x^5", {std::pow(x, 5), 5 * std::pow(x, 4), 20 * std::pow(x, 3)}},
        {"x^-2", {std::pow(x, -2), -2 * std::pow(x, -3), 6 * std::pow(x, -4)}},
        {"x^2.5", {std::pow(x, 2.5), 2.5 * std::pow(x, 1.5), 3.75 * std::pow(x, 0.5)}},
        {"2^x", {std::pow(2, x), std::log(2) * std::pow(2, x), std::log(2) * std::log(2) * std::pow(2, x)}},
        {"x^x",
         {std::pow(x, x), std::pow(x, x) * (std::log(x) + 1),
          std::pow(x, x) * ((std::log(x) + 1) * (std::log(x) + 1) + 1 / x)}},
        {"1/x", {1 / x, -1 / (x * x), 2 / (x * x * x)}},
        {"x/(1 + x)", {x / (1 + x), std::pow(1 + x, -2), -2 * std::pow(1 + x, -3)}},
        {"atan2(x, 2)", {std::atan2(x, 2), 2 / (4 + x * x), -4 * x / ((4 + x * x) * (4 + x * x))}},
        {"atan2(2, x)", {std::atan2(2, x), -2 / (4 + x * x), 4 * x / ((4 + x * x) * (4 + x * x))}}};
    for (const auto& [text, expected] : known) {
      INFO(text << " at " << x);
      const Derivatives found = at(text, x);
      check_near(found.value, expected.value);
      check_near(found.first, expected.first);
      check_near(found.second, expected.second);
      const Series series = series_at(text, x);
      check_near(series[0], expected.value);
      check_near(series[1], expected.first);
      check_near(2 * series[2], expected.second);
    }
  }
}

TEST_CASE("Powers have their derivatives at zero where these exist") {
  CHECK(at("x^2", 0).second == 2);
  CHECK(at("x^2", 0).first == 0);
  CHECK(at("x^3", -2).first == 12);
  CHECK(at("x^3", -2).second == -12);
  const Tape hill = compile({.variables = {"x", "n"}, .results = {{"f", "x^n"}}});
  const std::vector<double> place{0, 4};
  std::vector<double> values(1), gradient(2), second(2);
  REQUIRE(hill.evaluate(place.data(), values.data(), gradient.data()));
  CHECK(gradient == std::vector<double>{0, 0});
  const std::vector<double> w{1}, ways{1, 1};
  REQUIRE(hill.second(place.data(), w.data(), ways.data(), second.data()));
  CHECK(second == std::vector<double>{0, 0});
}

TEST_CASE("A tape has no gradient where its slope is infinite") {
  const double zero = 0;
  double value = 0, slope = 0;
  for (const char* text : {"sqrt(x)", "x^0.5", "sqrt(x)*sqrt(x)", "asin(x - 1)", "log(x)", "atan2(x, x)"}) {
    INFO(text);
    const Tape tape = compile({.variables = {"x"}, .results = {{"f", text}}});
    CHECK_FALSE(tape.evaluate(&zero, &value, &slope));
  }
}

TEST_CASE("Gradients of formulas are the limits of their differences") {
  const Tape tape = compile(mixed);
  const auto n = static_cast<std::size_t>(tape.variables()), m = static_cast<std::size_t>(tape.results());
  for (std::vector<double> x : places) {
    std::vector<double> values(m), gradients(m * n), up(m), down(m), up2(m), down2(m);
    REQUIRE(tape.evaluate(x.data(), values.data(), gradients.data()));
    for (std::size_t j = 0; j < n; ++j) {
      const double h = 1e-4, middle = x[j];
      const auto shifted = [&](double by, std::vector<double>& out) {
        x[j] = middle + by;
        REQUIRE(tape.evaluate(x.data(), out.data()));
        x[j] = middle;
      };
      shifted(h, up);
      shifted(-h, down);
      shifted(2 * h, up2);
      shifted(-2 * h, down2);
      for (std::size_t i = 0; i < m; ++i) {
        INFO(mixed.results[i].name << " by " << mixed.variables[j] << " at x = " << x[0]);
        const double difference = (8 * (up[i] - down[i]) - (up2[i] - down2[i])) / (12 * h);
        CHECK_THAT(gradients[i * n + j], Catch::Matchers::WithinRel(difference, 1e-9) ||
                                             Catch::Matchers::WithinAbs(difference, 1e-10));
      }
    }
  }
}

TEST_CASE("Several points at once have the values and gradients of one by one, or none where one has none") {
  const Tape tape = compile({.variables = {"x", "y"},
                             .results = {{"f", "x*sin(y) - min(x, y)/y"}, {"g", "y^1.5 + 2*x - x^3 + 4"}}});
  constexpr Index points = 19;  // two lots of eight, and three
  Matrix x(2, points);
  x.row(0).setLinSpaced(-2, 3);
  x.row(1).setLinSpaced(0.5, 4);
  Matrix values(2, points);
  Matrix gradients(4, points);
  REQUIRE(tape.evaluate(x.data(), points, values.data(), gradients.data()));
  for (Index k = 0; k < points; ++k) {
    Vector value(2);
    Vector gradient(4);
    REQUIRE(tape.evaluate(x.col(k).data(), value.data(), gradient.data()));
    CHECK(value == values.col(k));
    CHECK(gradient == gradients.col(k));
  }
  Matrix alone(2, points);
  REQUIRE(tape.evaluate(x.data(), points, alone.data(), nullptr));
  CHECK(alone == values);
  for (const Index bad : {0, 12, 18}) {
    Matrix there = x;
    there(1, bad) = -1;  // no y^1.5
    CHECK_FALSE(tape.evaluate(there.data(), points, values.data(), gradients.data()));
  }
}

TEST_CASE("Second derivatives of formulas are the limits of differences of gradients") {
  const Tape tape = compile(mixed);
  const auto n = static_cast<std::size_t>(tape.variables()), m = static_cast<std::size_t>(tape.results());
  const std::vector<double> w{0.3, -1.2, 0.7, 2.1, 1.4, -0.6}, way{0.9, -0.4, 1.3};
  for (const std::vector<double>& x : places) {
    std::vector<double> exact(n), values(m), gradients(m * n), difference(n, 0.0);
    REQUIRE(tape.second(x.data(), w.data(), way.data(), exact.data()));
    const double h = 1e-4;
    for (const auto& [steps, weight] :
         std::vector<std::pair<int, double>>{{1, 8}, {-1, -8}, {2, -1}, {-2, 1}}) {
      std::vector<double> shifted = x;
      for (std::size_t j = 0; j < n; ++j) shifted[j] += steps * h * way[j];
      REQUIRE(tape.evaluate(shifted.data(), values.data(), gradients.data()));
      for (std::size_t j = 0; j < n; ++j) {
        for (std::size_t i = 0; i < m; ++i) difference[j] += weight * w[i] * gradients[i * n + j] / (12 * h);
      }
    }
    for (std::size_t j = 0; j < n; ++j) {
      INFO(mixed.variables[j] << " at x = " << x[0]);
      CHECK_THAT(exact[j], Catch::Matchers::WithinRel(difference[j], 1e-8));
    }
  }
}

TEST_CASE("Series of formulas are off by the sixth power of the way") {
  const Tape tape = compile(mixed);
  for (const std::vector<double>& x : places) {
    const std::vector<Series> along{
        {x[0], 0.9, -0.3, 0.2, 0.5, -0.1}, {x[1], -0.4, 0.6, 0, -0.2, 0.3}, {x[2], 1.3, 0.1, -0.4, 0.2, 0.7}};
    std::vector<Series> found(static_cast<std::size_t>(tape.results()));
    REQUIRE(tape.series(along.data(), found.data()));
    const auto sum = [](const Series& one, double h) {
      double value = 0;
      for (std::size_t k = one.size(); k-- > 0;) value = value * h + one[k];
      return value;
    };
    std::vector<std::vector<double>> errors;
    for (const double h : {0.02, 0.01}) {
      std::vector<double> at, values(found.size());
      for (const Series& one : along) at.push_back(sum(one, h));
      REQUIRE(tape.evaluate(at.data(), values.data()));
      for (std::size_t i = 0; i < found.size(); ++i) values[i] = std::abs(values[i] - sum(found[i], h));
      errors.push_back(values);
    }
    for (std::size_t i = 0; i < found.size(); ++i) {
      INFO(mixed.results[i].name << " at x = " << x[0]);
      CHECK(errors[1][i] <= errors[0][i] / 50 + 1e-14 * (1 + std::abs(found[i][0])));
    }
  }
}

TEST_CASE("A formula has a series at zero where its derivatives exist") {
  CHECK(series_at("x^3", 0) == Series{0, 0, 0, 1, 0, 0});
  CHECK_THAT(series_at("tanh(x)^2", 0)[4], Catch::Matchers::WithinRel(-2.0 / 3, 1e-14));
  const Tape hill = compile({.variables = {"x", "n"}, .results = {{"f", "x^n"}}});
  const std::vector<Series> along{{0, 1}, {4}};
  Series found{};
  REQUIRE(hill.series(along.data(), &found));
  CHECK(found == Series{0, 0, 0, 0, 1, 0});
  for (const char* text : {"sqrt(x)", "abs(x)", "log(x)", "x^2.5", "atan2(x, x)"}) {
    INFO(text);
    const Tape tape = compile({.variables = {"x"}, .results = {{"f", text}}});
    const Series zero{0, 1};
    CHECK_FALSE(tape.series(&zero, &found));
  }
}
