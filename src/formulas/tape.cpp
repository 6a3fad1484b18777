#include "arcslip/formulas/tape.hpp"

#include <algorithm>
#include <boost/container/small_vector.hpp>
#include <cmath>

#include "formulas/operation.hpp"

namespace arcslip {
namespace {

/// On the stack up to 16 kB.
class Scratch {
 public:
  explicit Scratch(std::size_t size) : numbers_(size, boost::container::default_init) {}

  /// The next ones, of any value or zero.
  double* take(std::size_t count) {
    taken_ += count;
    return numbers_.data() + taken_ - count;
  }
  double* zeros(std::size_t count) {
    double* const first = take(count);
    std::fill_n(first, count, 0.0);
    return first;
  }

 private:
  boost::container::small_vector<double, 2048> numbers_;
  std::size_t taken_ = 0;
};

/// The place of b, or of a where there is none.
std::size_t right_of(const Operation& one) {
  return static_cast<std::size_t>(has_two(one.kind) ? one.right : one.left);
}

/// Four sums at once, as each waits for its last addition: 0, or nan from what is not finite on.
bool are_finite(const double* numbers, std::size_t count) {
  double sums[4] = {0, 0, 0, 0};
  std::size_t i = 0;
  for (; i + 4 <= count; i += 4) {
    for (std::size_t k = 0; k < 4; ++k) sums[k] += 0 * numbers[i + k];
  }
  for (; i < count; ++i) sums[0] += 0 * numbers[i];
  return sums[0] + sums[1] + sums[2] + sums[3] == 0;
}

/// Numbers of several points, side by side.
template <std::size_t lanes>
class Lanes {
 public:
  explicit Lanes(double* first) : first_(first) {}
  template <class Place>
  double* operator[](Place place) const {
    return first_ + lanes * static_cast<std::size_t>(place);
  }

  template <class Number>
  void set(std::size_t place, Number number) const {
    double* __restrict const out = (*this)[place];
    for (std::size_t k = 0; k < lanes; ++k) out[k] = number(k);
  }

  void set_value(std::size_t place, const Operation& one) const {
    const double* const a = (*this)[one.left];
    const double* const b = (*this)[right_of(one)];
    switch (one.kind) {
      case Operator::add: return set(place, [=](std::size_t k) { return a[k] + b[k]; });
      case Operator::subtract: return set(place, [=](std::size_t k) { return a[k] - b[k]; });
      case Operator::multiply: return set(place, [=](std::size_t k) { return a[k] * b[k]; });
      case Operator::divide: return set(place, [=](std::size_t k) { return a[k] / b[k]; });
      case Operator::integer_power:
        if (one.right == 2) return set(place, [=](std::size_t k) { return a[k] * a[k]; });
        [[fallthrough]];
      default: return set(place, [=, &one](std::size_t k) { return value_of(one, a[k], b[k]); });
    }
  }

  void set_slopes(std::size_t left, std::size_t place, const Operation& one) const {
    const double* const a = (*this)[one.left];
    const double* const b = (*this)[right_of(one)];
    for (std::size_t k = 0; k < lanes; ++k) {
      const Slopes slopes = slopes_of(one, a[k], b[k], (*this)[place][k], false);
      (*this)[left][k] = slopes.left;
      (*this)[left + 1][k] = slopes.right;
    }
  }

  /// Constants from a place on, then operations.
  void set_all(std::size_t place, const OperationList& list) const {
    for (const double constant : list.constants) set(place++, [=](std::size_t) { return constant; });
    for (const Operation& one : list.operations) set_value(place++, one);
  }

 private:
  double* first_;
};

}  // namespace

bool Tape::uses(Index variable) const {
  const auto place = static_cast<int>(variable);
  return std::count(values_.results.begin(), values_.results.end(), place) > 0 ||
         std::any_of(values_.operations.begin(), values_.operations.end(), [&](const Operation& one) {
           return one.left == place || static_cast<int>(right_of(one)) == place;
         });
}

/// Of several points side by side.
template <std::size_t lanes>
bool Tape::evaluate_lanes(const double* x, double* values, double* gradients) const {
  const auto variables = static_cast<std::size_t>(values_.variables);
  const std::size_t results = values_.results.size();
  const std::size_t slopes = values_.slots();
  const std::size_t size = lanes * (gradients == nullptr ? slopes : gradient_.slots());
  Scratch scratch(size);
  const Lanes<lanes> at(scratch.take(size));
  for (std::size_t i = 0; i < variables; ++i) at.set(i, [&](std::size_t k) { return x[k * variables + i]; });
  at.set_all(variables, values_);
  for (std::size_t r = 0; r < results; ++r) {
    for (std::size_t k = 0; k < lanes; ++k) values[k * results + r] = at[values_.results[r]][k];
  }
  if (!are_finite(values, lanes * results)) return false;
  if (gradients == nullptr) return true;
  for (std::size_t k = 0; k < curved_.size(); ++k) {
    const auto which = static_cast<std::size_t>(curved_[k]);
    at.set_slopes(slopes + 2 * k, values_.first() + which, values_.operations[which]);
  }
  at.set_all(static_cast<std::size_t>(gradient_.variables), gradient_);
  const std::size_t count = gradient_.results.size();
  for (std::size_t i = 0; i < count; ++i) {
    const double* const entry = at[gradient_.results[i]];
    for (std::size_t k = 0; k < lanes; ++k) gradients[k * count + i] = entry[k];
  }
  return are_finite(gradients, lanes * count);
}

bool Tape::evaluate(const double* x, double* values) const { return evaluate_lanes<1>(x, values, nullptr); }

bool Tape::evaluate(const double* x, double* values, double* gradients) const {
  return evaluate_lanes<1>(x, values, gradients);
}

bool Tape::evaluate(const double* x, Index points, double* values, double* gradients) const {
  constexpr Index lanes = 8;
  const Index size = results();
  for (Index k = 0; k < points;) {
    const bool many = points >= lanes;
    if (many) k = std::min(k, points - lanes);  // the last ones again
    double* const value = values + k * size;
    double* const gradient = gradients == nullptr ? nullptr : gradients + k * size * values_.variables;
    if (!(many ? evaluate_lanes<lanes>(x + k * values_.variables, value, gradient)
               : evaluate_lanes<1>(x + k * values_.variables, value, gradient)))
      return false;
    k += many ? lanes : 1;
  }
  return true;
}

bool Tape::second(const double* x, const double* w, const double* dx, double* out) const {
  const std::size_t count = values_.operations.size();
  Scratch scratch(4 * values_.slots() + 4 * count);
  double* const at = scratch.take(values_.slots());
  double* const rate = scratch.zeros(values_.slots());
  double* const left = scratch.take(count);
  double* const right = scratch.take(count);
  double* const left_rate = scratch.take(count);
  double* const right_rate = scratch.take(count);
  double* const adjoint = scratch.zeros(values_.slots());
  double* const adjoint_rate = scratch.zeros(values_.slots());
  std::copy_n(x, values_.variables, at);
  Lanes<1>(at).set_all(static_cast<std::size_t>(values_.variables), values_);
  std::copy_n(dx, values_.variables, rate);
  for (std::size_t i = 0; i < count; ++i) {
    const Operation& one = values_.operations[i];
    const std::size_t b = right_of(one);
    const Slopes slopes = slopes_of(one, at[one.left], at[b], at[values_.first() + i], true);
    const double da = rate[one.left];
    const double db = has_two(one.kind) ? rate[b] : 0;
    left[i] = slopes.left;
    right[i] = slopes.right;
    left_rate[i] = slopes.left_left * da + slopes.left_right * db;
    right_rate[i] = slopes.left_right * da + slopes.right_right * db;
    rate[values_.first() + i] = slopes.left * da + slopes.right * db;
  }
  for (std::size_t r = 0; r < values_.results.size(); ++r) adjoint[values_.results[r]] += w[r];
  for (std::size_t i = count; i-- > 0;) {
    const Operation& one = values_.operations[i];
    const double here = adjoint[values_.first() + i];
    const double here_rate = adjoint_rate[values_.first() + i];
    adjoint[one.left] += left[i] * here;
    adjoint_rate[one.left] += left_rate[i] * here + left[i] * here_rate;
    if (!has_two(one.kind)) continue;
    adjoint[one.right] += right[i] * here;
    adjoint_rate[one.right] += right_rate[i] * here + right[i] * here_rate;
  }
  std::copy_n(adjoint_rate, values_.variables, out);
  return are_finite(out, static_cast<std::size_t>(values_.variables));
}

bool Tape::series(const Series* x, Series* values) const {
  std::vector<Series> slots;
  slots.reserve(values_.slots());
  slots.assign(x, x + values_.variables);
  for (const double constant : values_.constants) slots.push_back({constant});
  for (const Operation& one : values_.operations)
    slots.push_back(series_of(one, slots[static_cast<std::size_t>(one.left)], slots[right_of(one)]));
  for (std::size_t i = 0; i < values_.results.size(); ++i)
    values[i] = slots[static_cast<std::size_t>(values_.results[i])];
  return std::all_of(values, values + values_.results.size(),
                     [](const Series& one) { return are_finite(one.data(), one.size()); });
}

}  // namespace arcslip
