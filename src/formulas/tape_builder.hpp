#pragma once

// A tape as it grows, with each expression once.

#include <map>
#include <tuple>

#include "arcslip/formulas/tape.hpp"

namespace arcslip {

class TapeBuilder {
 public:
  /// The first nodes are the variables.
  explicit TapeBuilder(std::size_t variables);

  int constant(double value);
  int apply(Operator kind, int left, int right);
  int function(int number, int argument) { return apply(Operator::function, argument, number); }
  int raise(int base, int exponent);
  int negate(int node) { return apply(Operator::multiply, constant(-1), node); }

  /// What these nodes need, with them for results.
  OperationList lists(const std::vector<int>& results) const;
  Tape finish(const std::vector<int>& results) const { return Tape(lists(results)); }

 private:
  struct Node {
    enum class Kind { variable, constant, operation } kind;
    double value = 0;
    Operation operation{};
  };
  const Node& node(int place) const { return nodes_[static_cast<std::size_t>(place)]; }
  int add(const Node& node);

  std::vector<Node> nodes_;
  std::map<std::uint64_t, int> constants_;  // by their bits
  std::map<std::tuple<Operator, int, int>, int> operations_;
};

}  // namespace arcslip
