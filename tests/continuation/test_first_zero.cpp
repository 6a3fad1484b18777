// First zeros of functions: how many looks they take, and that pairs of zeros are told however near they lie.

#include <array>
#include <cmath>
#include <random>

#include "arcslip/continuation/events/first_zero.hpp"
#include "catch.hpp"

namespace arcslip::continuation {
namespace {

struct Looked {
  FirstZero found;
  int looks = 0;
};

/// Between 0 and 1, of a function that gives value and slope.
template <class Function>
Looked look(const Function& f) {
  Looked result;
  const auto at = [&](double s) -> std::optional<Node> {
    ++result.looks;
    const auto [value, slope] = f(s);
    return Node{s, value, slope};
  };
  const auto node = [&](double s) { return *at(s); };
  result.found = first_zero(node(0), node(1), at, 1e-9);
  result.looks -= 2;
  return result;
}

TEST_CASE("A function that fades by orders of magnitude is seen not to vanish at a few looks", "[zeros]") {
  for (const double rate : {1.0, 5.0, 20.0}) {
    for (const double sign : {1.0, -1.0}) {
      CAPTURE(rate, sign);
      const Looked fading = look([&](double s) {
        const double value = sign * std::exp(-rate * s);
        return std::pair(value, -rate * value);
      });
      CHECK(fading.found.kind == FirstZero::Kind::none);
      CHECK(fading.looks <= 1);
    }
  }
}

TEST_CASE("A jump between values of one sign is no zero, and is not looked into to the last bit", "[zeros]") {
  for (const double place : {1e-4, 0.0371, 0.5, 0.73, 0.9999}) {
    CAPTURE(place);
    const Looked jumping = look([&](double s) {
      const double value = s < place ? 1 - s : 0.5 * (1.2 - s);
      return std::pair(value, s < place ? -1.0 : -0.5);
    });
    CHECK(jumping.found.kind == FirstZero::Kind::none);
    CHECK(jumping.looks <= 12);
  }
}

TEST_CASE("A change of sign is found before a zero that is only touched behind it", "[zeros]") {
  for (const double place : {0.05, 0.2, 0.31, 0.437, 0.499}) {
    CAPTURE(place);
    const Looked both = look([&](double s) {
      const double way = s - 0.5;
      return std::pair((s - place) * way * way, way * way + 2 * (s - place) * way);
    });
    CHECK(both.found.kind == FirstZero::Kind::change);
    CHECK(both.found.before.s <= place);
    CHECK(both.found.behind.s >= place);
  }
}

TEST_CASE("Two zeros that lie near together are found beside a factor that fades", "[zeros]") {
  for (const double apart : {0.3, 0.03, 1e-3, 1e-5, 1e-7}) {
    for (const double rate : {0.0, 5.0, -5.0}) {
      for (const double middle : {0.2, 0.437, 0.61}) {
        CAPTURE(apart, rate, middle);
        const Looked pair = look([&](double s) {
          const double fade = std::exp(-rate * s);
          const double way = s - middle;
          const double value = fade * (way * way - 0.25 * apart * apart);
          return std::pair(value, 2 * fade * way - rate * value);
        });
        CHECK(pair.found.kind != FirstZero::Kind::none);
        if (apart < 1e-6) continue;  // what is between them is rounding: they may be told as one that touches
        CHECK(pair.found.kind == FirstZero::Kind::change);
        CHECK(pair.found.before.s <= middle - 0.5 * apart);
        CHECK(pair.found.behind.s >= middle - 0.5 * apart);
      }
    }
  }
}

TEST_CASE("Values before a step tell whether a function may vanish twice in it, or its logarithm fall") {
  std::mt19937 numbers(1);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(numbers);
  };
  int beyond = 0;
  for (int i = 0; i < 20000; ++i) {
    std::array<double, 5> places{1, 0};  // the end of the step, its beginning, and before
    for (std::size_t k = 2; k < places.size(); ++k) places[k] = places[k - 1] - uniform(0.5, 1.5);
    const double a = uniform(0.001, 0.999);
    const double b = i % 2 == 0 ? uniform(0.001, 0.999) : a;
    const double rate = uniform(-20, 20);
    std::array<double, 5> values{};
    std::array<double, 5> logs{};
    std::array<double, 5> fading{};
    for (std::size_t k = 0; k < places.size(); ++k) {
      values[k] = (places[k] - a) * (places[k] - b);
      logs[k] = std::log(values[k]) + rate * places[k];
      fading[k] = std::exp(rate * places[k]);
    }
    const bool fades = std::abs(rate) > 5;
    INFO(a << " " << b << " " << places[2]);
    CHECK(may_vanish_twice(places, values));
    CHECK(logarithm_may_fall(places, logs));
    for (std::size_t k = 0; k < places.size(); ++k) logs[k] = rate * places[k];
    CHECK_FALSE(logarithm_may_fall(places, logs));
    if (fades) beyond += may_vanish_twice(places, fading) ? 1 : 0;
  }
  CHECK(beyond > 10000);  // which the values alone take for a pair
  CHECK(may_vanish_twice(std::array{1.0, 0.0, -1.0}, std::array{1.0, 1.0, 1.0}));  // too few to tell
  CHECK(logarithm_may_fall(std::array{1.0, 0.0, -1.0}, std::array{0.0, 0.0, 0.0}));
}

}  // namespace
}  // namespace arcslip::continuation
