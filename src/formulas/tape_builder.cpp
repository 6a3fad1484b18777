#include "formulas/tape_builder.hpp"

#include <bit>
#include <cmath>
#include <limits>

#include "formulas/operation.hpp"

namespace arcslip {
namespace {

bool is_commutative(Operator kind) { return kind == Operator::add || kind == Operator::multiply; }

bool is_int(double value) {
  return value == std::floor(value) && std::abs(value) < std::numeric_limits<int>::max();
}

}  // namespace

TapeBuilder::TapeBuilder(std::size_t variables) : nodes_(variables, {Node::Kind::variable}) {}

int TapeBuilder::add(const Node& node) {
  nodes_.push_back(node);
  return static_cast<int>(nodes_.size()) - 1;
}

int TapeBuilder::constant(double value) {
  const auto [known, is_new] = constants_.try_emplace(std::bit_cast<std::uint64_t>(value), 0);
  if (is_new) known->second = add({Node::Kind::constant, value});
  return known->second;
}

int TapeBuilder::apply(Operator kind, int left, int right) {
  if (is_commutative(kind) && right < left) std::swap(left, right);
  const Operation operation{kind, left, right};
  const auto is_constant = [&](int place) { return node(place).kind == Node::Kind::constant; };
  if (is_constant(left) && (!has_two(kind) || is_constant(right))) {
    const double b = has_two(kind) ? node(right).value : 0;
    return constant(value_of(operation, node(left).value, b));
  }
  const auto [known, is_new] = operations_.try_emplace({kind, left, right}, 0);
  if (is_new) known->second = add({Node::Kind::operation, 0, operation});
  return known->second;
}

int TapeBuilder::raise(int base, int exponent) {
  if (node(exponent).kind != Node::Kind::constant) return apply(Operator::power, base, exponent);
  const double value = node(exponent).value;
  if (value == 0) return constant(1);
  if (value == 1) return base;
  if (is_int(value)) return apply(Operator::integer_power, base, static_cast<int>(value));
  return apply(Operator::fixed_power, base, exponent);
}

OperationList TapeBuilder::lists(const std::vector<int>& results) const {
  std::vector<bool> is_needed(nodes_.size(), false);
  for (const int result : results) is_needed[static_cast<std::size_t>(result)] = true;
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    if (!is_needed[i] || nodes_[i].kind != Node::Kind::operation) continue;
    const Operation& one = nodes_[i].operation;
    is_needed[static_cast<std::size_t>(one.left)] = true;
    if (has_two(one.kind)) is_needed[static_cast<std::size_t>(one.right)] = true;
  }
  std::vector<int> place(nodes_.size(), 0);
  int next = 0;
  Index variables = 0;
  std::vector<double> constants;
  std::vector<Operation> operations;
  for (const auto kind : {Node::Kind::variable, Node::Kind::constant, Node::Kind::operation}) {
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (nodes_[i].kind != kind || (!is_needed[i] && kind != Node::Kind::variable)) continue;
      place[i] = next++;
      if (kind == Node::Kind::variable) ++variables;
      if (kind == Node::Kind::constant) constants.push_back(nodes_[i].value);
      if (kind != Node::Kind::operation) continue;
      Operation one = nodes_[i].operation;
      one.left = place[static_cast<std::size_t>(one.left)];
      if (has_two(one.kind)) one.right = place[static_cast<std::size_t>(one.right)];
      operations.push_back(one);
    }
  }
  std::vector<int> places;
  places.reserve(results.size());
  for (const int result : results) places.push_back(place[static_cast<std::size_t>(result)]);
  return {variables, std::move(constants), std::move(operations), std::move(places)};
}

}  // namespace arcslip
