// Gradients of a tape's results, as operations of their own: what the adjoints dF/dv_a += dF/dv_i df_i/dv_a
// come to where zeros, ones and what several of them need are taken once, when the tape is made.

#include "formulas/operation.hpp"
#include "formulas/tape_builder.hpp"

namespace arcslip {
namespace {

class GradientBuilder {
 public:
  /// Its variables are the places of `values`, then two slopes of each operation that is `curved`.
  GradientBuilder(const OperationList& values, const std::vector<int>& curved)
      : values_(values),
        slopes_(values.operations.size(), -1),
        builder_(values.slots() + 2 * curved.size()),
        zero_(builder_.constant(0)),
        one_(builder_.constant(1)) {
    for (std::size_t k = 0; k < curved.size(); ++k)
      slopes_[static_cast<std::size_t>(curved[k])] = static_cast<int>(values.slots() + 2 * k);
  }

  OperationList run() {
    std::vector<int> gradients;
    for (const int result : values_.results) {
      adjoint_.assign(values_.slots(), zero_);
      adjoint(result) = one_;
      for (auto i = static_cast<int>(values_.operations.size()); i-- > 0;) go_back(i);
      gradients.insert(gradients.end(), adjoint_.begin(), adjoint_.begin() + values_.variables);
    }
    return builder_.lists(gradients);
  }

 private:
  int& adjoint(int place) { return adjoint_[static_cast<std::size_t>(place)]; }

  /// A place of `values`.
  int node(int place) {
    const Index behind = place - values_.variables;
    const bool is_constant = behind >= 0 && static_cast<std::size_t>(place) < values_.first();
    return is_constant ? builder_.constant(values_.constants[static_cast<std::size_t>(behind)]) : place;
  }

  int product(int a, int b) {
    if (a == zero_ || b == zero_) return zero_;
    if (a == one_) return b;
    return b == one_ ? a : builder_.apply(Operator::multiply, a, b);
  }

  void add(int place, int term) {
    int& sum = adjoint(place);
    if (term != zero_) sum = sum == zero_ ? term : builder_.apply(Operator::add, sum, term);
  }
  void subtract(int place, int term) {
    int& sum = adjoint(place);
    if (term == zero_) return;
    sum = sum == zero_ ? builder_.negate(term) : builder_.apply(Operator::subtract, sum, term);
  }

  /// From an operation to its operands.
  void go_back(int i) {
    const Operation& one = values_.operations[static_cast<std::size_t>(i)];
    const int own_place = static_cast<int>(values_.first()) + i;
    const int own = adjoint(own_place);
    if (own == zero_) return;
    const int slopes = slopes_[static_cast<std::size_t>(i)];
    if (slopes >= 0) {
      add(one.left, product(own, slopes));
      if (has_two(one.kind)) add(one.right, product(own, slopes + 1));
      return;
    }
    const int a = node(one.left);
    switch (one.kind) {
      case Operator::add: add(one.left, own); return add(one.right, own);
      case Operator::subtract: add(one.left, own); return subtract(one.right, own);
      case Operator::multiply:
        add(one.left, product(own, node(one.right)));
        return add(one.right, product(own, a));
      case Operator::divide: {
        const int b = node(one.right);
        add(one.left, product(own, builder_.apply(Operator::divide, one_, b)));
        return subtract(one.right, product(own, builder_.apply(Operator::divide, own_place, b)));
      }
      default: {  // integer_power
        const int power = builder_.raise(a, builder_.constant(one.right - 1));
        return add(one.left, product(own, product(builder_.constant(one.right), power)));
      }
    }
  }

  const OperationList& values_;
  std::vector<int> slopes_;  // of each operation, where they are; or -1
  TapeBuilder builder_;
  int zero_;
  int one_;
  std::vector<int> adjoint_;
};

}  // namespace

void Tape::find_gradient() {
  for (std::size_t i = 0; i < values_.operations.size(); ++i) {
    if (!is_differentiated(values_.operations[i].kind)) curved_.push_back(static_cast<int>(i));
  }
  gradient_ = GradientBuilder(values_, curved_).run();
}

}  // namespace arcslip
