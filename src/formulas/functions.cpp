#include "arcslip/formulas/functions.hpp"

#include <cmath>
#include <numbers>

namespace arcslip {
namespace {

double square(double x) { return x * x; }
double sign(double x) { return x > 0 ? 1 : x < 0 ? -1 : x; }
double flat(double /*x*/, double /*y*/) { return 0; }

}  // namespace

// Hyperbolic ones by cosh, as 1 - tanh^2 has no digits left where tanh is nearly 1.
const std::vector<FormulaFunction>& functions() {
  using D = double;
  static const std::vector<FormulaFunction> all{
      {"sin", [](D x) { return std::sin(x); }, [](D x, D) { return std::cos(x); }, [](D, D y) { return -y; },
       taylor::sin},
      {"cos", [](D x) { return std::cos(x); }, [](D x, D) { return -std::sin(x); }, [](D, D y) { return -y; },
       taylor::cos},
      {"tan", [](D x) { return std::tan(x); }, [](D, D y) { return 1 + y * y; },
       [](D, D y) { return 2 * y * (1 + y * y); }, taylor::tan},
      {"asin", [](D x) { return std::asin(x); }, [](D x, D) { return 1 / std::sqrt((1 - x) * (1 + x)); },
       [](D x, D) { return x * std::pow((1 - x) * (1 + x), -1.5); }, taylor::asin},
      {"acos", [](D x) { return std::acos(x); }, [](D x, D) { return -1 / std::sqrt((1 - x) * (1 + x)); },
       [](D x, D) { return -x * std::pow((1 - x) * (1 + x), -1.5); }, taylor::acos},
      {"atan", [](D x) { return std::atan(x); }, [](D x, D) { return 1 / (1 + x * x); },
       [](D x, D) { return -2 * x / square(1 + x * x); }, taylor::atan},
      {"sinh", [](D x) { return std::sinh(x); }, [](D x, D) { return std::cosh(x); },
       [](D, D y) { return y; }, taylor::sinh},
      {"cosh", [](D x) { return std::cosh(x); }, [](D x, D) { return std::sinh(x); },
       [](D, D y) { return y; }, taylor::cosh},
      {"tanh", [](D x) { return std::tanh(x); }, [](D x, D) { return square(1 / std::cosh(x)); },
       [](D x, D y) { return -2 * y * square(1 / std::cosh(x)); }, taylor::tanh},
      {"exp", [](D x) { return std::exp(x); }, [](D, D y) { return y; }, [](D, D y) { return y; },
       taylor::exp},
      {"log", [](D x) { return std::log(x); }, [](D x, D) { return 1 / x; },
       [](D x, D) { return -1 / (x * x); }, taylor::log},
      {"log10", [](D x) { return std::log10(x); }, [](D x, D) { return std::numbers::log10e / x; },
       [](D x, D) { return -std::numbers::log10e / (x * x); }, taylor::log10},
      {"sqrt", [](D x) { return std::sqrt(x); }, [](D, D y) { return 0.5 / y; },
       [](D, D y) { return -0.25 / (y * y * y); }, taylor::sqrt},
      {"abs", [](D x) { return std::abs(x); }, [](D x, D) { return sign(x); }, flat, taylor::abs},
      {"sign", sign, flat, flat, taylor::sign}};
  return all;
}

const std::vector<std::string>& functions_of_two() {
  static const std::vector<std::string> all{"pow", "atan2", "min", "max"};
  return all;
}

}  // namespace arcslip
