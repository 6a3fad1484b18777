#pragma once

// A number that a part of a model takes from a case file, as the part itself says it.

#include <limits>
#include <string>
#include <utility>

namespace arcslip {

/// A key with a number: a parameter of a problem or an element, or a size.
struct Setting {
  std::string name;          ///< of the key
  double value;              ///< the default; nan of one that must be given
  double low;                ///< smallest value allowed
  double high;               ///< largest
  bool is_integer = false;   ///< whether it is a whole number
  std::string meaning = {};  ///< one line
  bool may_be_low = true;    ///< whether `low` itself is allowed
};

/// A real setting without limits.
inline Setting any_value(std::string name, double value, std::string meaning) {
  constexpr double most = std::numeric_limits<double>::max();
  return {std::move(name), value, -most, most, false, std::move(meaning)};
}

/// A real setting that is not negative.
inline Setting not_negative(std::string name, double value, std::string meaning) {
  return {std::move(name), value, 0, std::numeric_limits<double>::max(), false, std::move(meaning)};
}

/// A real setting above zero.
inline Setting positive(std::string name, double value, std::string meaning) {
  return {std::move(name), value, 0, std::numeric_limits<double>::max(), false, std::move(meaning), false};
}

/// A real setting above zero that must be given.
inline Setting given_positive(std::string name, std::string meaning) {
  return positive(std::move(name), std::numeric_limits<double>::quiet_NaN(), std::move(meaning));
}

}  // namespace arcslip
