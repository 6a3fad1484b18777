#include "arcslip/interval/enclosed_tape.hpp"

#include <algorithm>

#include "arcslip/formulas/functions.hpp"
#include "arcslip/interval/elementary.hpp"

namespace arcslip {
namespace {

const EnclosedFunction& function_of(const Operation& one) {
  return *find_enclosed(functions()[static_cast<std::size_t>(one.right)].name);
}

/// f(a, b), df/da and df/db.
struct Enclosed {
  Interval value, left, right;
};

Enclosed extremum(const Interval& a, const Interval& b, bool least) {
  const Interval& low = least ? a : b;
  const Interval& high = least ? b : a;
  const Interval value = least ? min(a, b) : max(a, b);
  if (low.upper() < high.lower()) return {value, 1, 0};
  if (low.lower() > high.upper()) return {value, 0, 1};
  return {value, {0, 1}, {0, 1}};
}

Enclosed enclosed(const Operation& one, const Interval& a, const Interval& b) {
  switch (one.kind) {
    case Operator::add: return {a + b, 1, 1};
    case Operator::subtract: return {a - b, 1, -1};
    case Operator::multiply: return {one.left == one.right ? square(a) : a * b, b, a};
    case Operator::divide: {
      const Interval inverted = inverse(b);
      return {a * inverted, inverted, -a * square(inverted)};
    }
    case Operator::integer_power:
      return {power(a, one.right), Interval(one.right) * power(a, one.right - 1), 0};
    case Operator::power:
    case Operator::fixed_power: {
      const Interval value = power(a, b);
      return {value, b * power(a, b - Interval(1)), one.kind == Operator::power ? value * logarithm(a) : 0};
    }
    case Operator::function: return {function_of(one).value(a), function_of(one).slope(a), 0};
    case Operator::minimum:
    case Operator::maximum: return extremum(a, b, one.kind == Operator::minimum);
    case Operator::atan2: break;
  }
  throw NoEnclosure("atan2");
}

}  // namespace

std::optional<std::string> not_enclosed(const Tape& tape) {
  for (const Operation& one : tape.steps()) {
    if (one.kind == Operator::atan2) return "atan2";
    if (one.kind != Operator::function) continue;
    const std::string& name = functions()[static_cast<std::size_t>(one.right)].name;
    if (find_enclosed(name) == nullptr) return name;
  }
  return std::nullopt;
}

void enclose(const Tape& tape, const Interval* x, Index by, std::vector<Interval>& values,
             std::vector<Interval>& gradients) {
  const auto columns = static_cast<std::size_t>(by);
  const auto variables = static_cast<std::size_t>(tape.variables());
  const std::size_t first = variables + tape.constants().size();
  std::vector<Interval> at(x, x + variables);
  at.insert(at.end(), tape.constants().begin(), tape.constants().end());
  at.resize(first + tape.steps().size());
  std::vector<Interval> rates(at.size() * columns, Interval(0));
  for (std::size_t k = 0; k < columns; ++k) rates[k * columns + k] = 1;
  for (std::size_t i = 0; i < tape.steps().size(); ++i) {
    const Operation& one = tape.steps()[i];
    const auto a = static_cast<std::size_t>(one.left);
    const auto b = has_two(one.kind) ? static_cast<std::size_t>(one.right) : a;
    const Enclosed here = enclosed(one, at[a], at[b]);
    at[first + i] = here.value;
    for (std::size_t k = 0; k < columns; ++k) {
      Interval& rate = rates[(first + i) * columns + k];
      if (a >= first || a < columns) rate += here.left * rates[a * columns + k];
      if (has_two(one.kind) && (b >= first || b < columns)) rate += here.right * rates[b * columns + k];
    }
  }
  values.clear();
  gradients.clear();
  for (const int place : tape.places()) {
    const auto k = static_cast<std::size_t>(place);
    values.push_back(at[k]);
    gradients.insert(gradients.end(), rates.begin() + static_cast<std::ptrdiff_t>(k * columns),
                     rates.begin() + static_cast<std::ptrdiff_t>((k + 1) * columns));
  }
}

}  // namespace arcslip
