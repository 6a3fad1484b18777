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
      default: return set(place, [=, &one](std::size_t k) { return value_of(one, a[k], b[k]); });
    }
  }

  void set_slopes(std::size_t place, const Operation& one, double* left, double* right) const {
    const double* const a = (*this)[one.left];
    const double* const b = (*this)[right_of(one)];
    if (one.kind == Operator::multiply) {
      std::copy_n(b, lanes, left);
      std::copy_n(a, lanes, right);
      return;
    }
    if (one.kind == Operator::add || one.kind == Operator::subtract) {
      std::fill_n(left, lanes, 1.0);
      std::fill_n(right, lanes, one.kind == Operator::add ? 1.0 : -1.0);
      return;
    }
    for (std::size_t k = 0; k < lanes; ++k) {
      const Slopes slopes = slopes_of(one, a[k], b[k], (*this)[place][k], false);
      left[k] = slopes.left;
      right[k] = slopes.right;
    }
  }

  void add_product(int place, const double* __restrict a, const double* __restrict b) const {
    double* __restrict const out = (*this)[place];
    for (std::size_t k = 0; k < lanes; ++k) out[k] += a[k] * b[k];
  }

 private:
  double* first_;
};

}  // namespace

Tape::Tape(Index variables, std::vector<double> constants, std::vector<Operation> operations,
           std::vector<int> results)
    : variables_(variables),
      constants_(std::move(constants)),
      operations_(std::move(operations)),
      results_(std::move(results)),
      first_(static_cast<std::size_t>(variables) + constants_.size()) {
  for (const int result : results_) {
    std::vector<bool> is_needed(slots(), false);
    is_needed[static_cast<std::size_t>(result)] = true;
    for (std::size_t i = operations_.size(); i-- > 0;) {
      if (!is_needed[first_ + i]) continue;
      is_needed[static_cast<std::size_t>(operations_[i].left)] = true;
      is_needed[right_of(operations_[i])] = true;
    }
    for (std::size_t i = 0; i < operations_.size(); ++i) {
      if (is_needed[first_ + i]) needed_.push_back(static_cast<int>(i));
    }
    needed_to_.push_back(needed_.size());
  }
}

bool Tape::uses(Index variable) const {
  const auto place = static_cast<int>(variable);
  return std::count(results_.begin(), results_.end(), place) > 0 ||
         std::any_of(operations_.begin(), operations_.end(), [&](const Operation& one) {
           return one.left == place || static_cast<int>(right_of(one)) == place;
         });
}

void Tape::go_forward(const double* x, double* slots) const {
  std::copy(constants_.begin(), constants_.end(), std::copy_n(x, variables_, slots));
  double* value = slots + first_;
  for (const Operation& one : operations_) *value++ = value_of(one, slots[one.left], slots[right_of(one)]);
}

bool Tape::take_values(const double* slots, double* values) const {
  for (std::size_t i = 0; i < results_.size(); ++i) values[i] = slots[results_[i]];
  return are_finite(values, results_.size());
}

bool Tape::evaluate(const double* x, double* values) const {
  Scratch scratch(slots());
  double* const at = scratch.take(slots());
  go_forward(x, at);
  return take_values(at, values);
}

/// Of several points side by side.
template <std::size_t lanes>
bool Tape::evaluate_lanes(const double* x, double* values, double* gradients) const {
  const auto variables = static_cast<std::size_t>(variables_);
  const std::size_t results = results_.size();
  const std::size_t count = operations_.size();
  Scratch scratch(lanes * (2 * slots() + 2 * count));
  const Lanes<lanes> at(scratch.take(lanes * slots()));
  for (std::size_t i = 0; i < variables; ++i) at.set(i, [&](std::size_t k) { return x[k * variables + i]; });
  for (std::size_t i = 0; i < constants_.size(); ++i)
    at.set(variables + i, [&](std::size_t) { return constants_[i]; });
  for (std::size_t i = 0; i < count; ++i) at.set_value(first_ + i, operations_[i]);
  for (std::size_t r = 0; r < results; ++r) {
    for (std::size_t k = 0; k < lanes; ++k) values[k * results + r] = at[results_[r]][k];
  }
  if (!are_finite(values, lanes * results)) return false;
  if (gradients == nullptr) return true;
  const Lanes<lanes> left(scratch.take(lanes * count));
  const Lanes<lanes> right(scratch.take(lanes * count));
  for (std::size_t i = 0; i < count; ++i) at.set_slopes(first_ + i, operations_[i], left[i], right[i]);
  const Lanes<lanes> adjoint(scratch.take(lanes * slots()));
  std::size_t begin = 0;
  for (std::size_t r = 0; r < results; ++r) {
    std::fill_n(adjoint[0], lanes * variables, 0.0);
    for (std::size_t k = begin; k < needed_to_[r]; ++k)
      std::fill_n(adjoint[first_ + static_cast<std::size_t>(needed_[k])], lanes, 0.0);
    std::fill_n(adjoint[results_[r]], lanes, 1.0);
    for (std::size_t k = needed_to_[r]; k-- > begin;) {
      const auto i = static_cast<std::size_t>(needed_[k]);
      adjoint.add_product(operations_[i].left, left[i], adjoint[first_ + i]);
      if (has_two(operations_[i].kind))
        adjoint.add_product(operations_[i].right, right[i], adjoint[first_ + i]);
    }
    for (std::size_t k = 0; k < lanes; ++k) {
      double* const gradient = gradients + (k * results + r) * variables;
      for (std::size_t i = 0; i < variables; ++i) gradient[i] = adjoint[i][k];
    }
    begin = needed_to_[r];
  }
  return are_finite(gradients, lanes * results * variables);
}

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
    double* const gradient = gradients == nullptr ? nullptr : gradients + k * size * variables_;
    if (!(many ? evaluate_lanes<lanes>(x + k * variables_, value, gradient)
               : evaluate_lanes<1>(x + k * variables_, value, gradient)))
      return false;
    k += many ? lanes : 1;
  }
  return true;
}

bool Tape::second(const double* x, const double* w, const double* dx, double* out) const {
  const std::size_t count = operations_.size();
  Scratch scratch(4 * slots() + 4 * count);
  double* const at = scratch.take(slots());
  double* const rate = scratch.zeros(slots());
  double* const left = scratch.take(count);
  double* const right = scratch.take(count);
  double* const left_rate = scratch.take(count);
  double* const right_rate = scratch.take(count);
  double* const adjoint = scratch.zeros(slots());
  double* const adjoint_rate = scratch.zeros(slots());
  go_forward(x, at);
  std::copy_n(dx, variables_, rate);
  for (std::size_t i = 0; i < count; ++i) {
    const Operation& one = operations_[i];
    const std::size_t b = right_of(one);
    const Slopes slopes = slopes_of(one, at[one.left], at[b], at[first_ + i], true);
    const double da = rate[one.left];
    const double db = has_two(one.kind) ? rate[b] : 0;
    left[i] = slopes.left;
    right[i] = slopes.right;
    left_rate[i] = slopes.left_left * da + slopes.left_right * db;
    right_rate[i] = slopes.left_right * da + slopes.right_right * db;
    rate[first_ + i] = slopes.left * da + slopes.right * db;
  }
  for (std::size_t r = 0; r < results_.size(); ++r) adjoint[results_[r]] += w[r];
  for (std::size_t i = count; i-- > 0;) {
    const Operation& one = operations_[i];
    const double here = adjoint[first_ + i];
    const double here_rate = adjoint_rate[first_ + i];
    adjoint[one.left] += left[i] * here;
    adjoint_rate[one.left] += left_rate[i] * here + left[i] * here_rate;
    if (!has_two(one.kind)) continue;
    adjoint[one.right] += right[i] * here;
    adjoint_rate[one.right] += right_rate[i] * here + right[i] * here_rate;
  }
  std::copy_n(adjoint_rate, variables_, out);
  return are_finite(out, static_cast<std::size_t>(variables_));
}

bool Tape::series(const Series* x, Series* values) const {
  std::vector<Series> slots;
  slots.reserve(this->slots());
  slots.assign(x, x + variables_);
  for (const double constant : constants_) slots.push_back({constant});
  for (const Operation& one : operations_)
    slots.push_back(series_of(one, slots[static_cast<std::size_t>(one.left)], slots[right_of(one)]));
  for (std::size_t i = 0; i < results_.size(); ++i) values[i] = slots[static_cast<std::size_t>(results_[i])];
  return std::all_of(values, values + results_.size(),
                     [](const Series& one) { return are_finite(one.data(), one.size()); });
}

}  // namespace arcslip
