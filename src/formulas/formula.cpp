#include "arcslip/formulas/formula.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <numbers>
#include <string_view>

#include "arcslip/formulas/functions.hpp"
#include "formulas/tape_builder.hpp"

namespace arcslip {

FormulaError::FormulaError(std::string place, std::string why)
    : std::invalid_argument(fmt::format("{}: {}", place, why)),
      place_(std::move(place)),
      why_(std::move(why)) {}

namespace {

constexpr int deepest = 500;          // of parentheses, signs and definitions within one another
constexpr std::size_t longest = 100;  // that messages show

const std::string& place_of(const Formula& formula) {
  return formula.place.empty() ? formula.name : formula.place;
}

bool begins_name(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_'; }
bool is_of_name(char c) { return begins_name(c) || std::isdigit(static_cast<unsigned char>(c)) != 0; }
bool is_space(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }
/// Of a character in UTF-8 all but the first.
bool continues(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

/// A text on one line.
std::string shown(std::string text) {
  for (char& c : text) {
    if (std::iscntrl(static_cast<unsigned char>(c)) != 0) c = ' ';
  }
  if (text.size() <= longest) return text;
  std::size_t end = longest;
  while (continues(text[end])) --end;
  return text.substr(0, end) + "...";
}

/// All names, or the first of very many.
std::string listed(std::vector<std::string> names) {
  constexpr std::size_t most = 30;
  const bool all = names.size() <= most;
  if (!all) names.resize(most);
  return fmt::format("{}{}", fmt::join(names, ", "), all ? "" : ", ...");
}

int number_of_function(const std::string& name) {
  const auto& all = functions();
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.name == name; });
  return found == all.end() ? -1 : static_cast<int>(found - all.begin());
}

bool is_function_of_two(const std::string& name) {
  return std::count(functions_of_two().begin(), functions_of_two().end(), name) > 0;
}

const std::map<std::string, double>& constants() {
  static const std::map<std::string, double> all{{"e", std::numbers::e}, {"pi", std::numbers::pi}};
  return all;
}

/// Where names are nodes.
class Compiler {
 public:
  explicit Compiler(const FormulaSet& set) : set_(set), builder_(set.variables.size()) {
    for (std::size_t i = 0; i < set.variables.size(); ++i) known_[set.variables[i]] = static_cast<int>(i);
  }

  Tape compile();

  /// The node that a name stands for; -1 if it is unknown.
  int find(const std::string& name);
  std::vector<std::string> names() const;  ///< but for those of hidden variables, which begin with _
  const FormulaSet& set() const { return set_; }
  TapeBuilder& builder() { return builder_; }
  int depth = 0;

 private:
  int define(const Formula& definition);

  const FormulaSet& set_;
  TapeBuilder builder_;
  std::map<std::string, int> known_;
  std::vector<std::string> open_;  // definitions that are being read
};

/// Reads one formula.
class Parser {
 public:
  Parser(Compiler& compiler, const Formula& formula)
      : compiler_(compiler), formula_(formula), text_(formula.text) {}

  int parse();

 private:
  int sum();
  int product();
  int with_sign();
  int power();
  int operand();
  int number();
  int word();
  int call(const std::string& name);

  void skip();
  bool meets(char c);
  void require(char c, const std::string& after);
  [[noreturn]] void fail(std::size_t at, const std::string& what, const std::string& more = "") const;

  Compiler& compiler_;
  const Formula& formula_;
  std::string_view text_;
  std::size_t at_ = 0;
};

void Parser::fail(std::size_t at, const std::string& what, const std::string& more) const {
  const auto column = 1 + std::count_if(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(at),
                                        [](char c) { return !continues(c); });
  throw FormulaError(place_of(formula_), fmt::format("{} at column {} of \"{}\"{}", what, column,
                                                     shown(std::string(text_)), more));
}

void Parser::skip() {
  while (at_ < text_.size() && is_space(text_[at_])) ++at_;
}

bool Parser::meets(char c) {
  skip();
  if (at_ >= text_.size() || text_[at_] != c) return false;
  ++at_;
  return true;
}

void Parser::require(char c, const std::string& after) {
  if (!meets(c)) fail(at_, fmt::format("expected \"{}\" {}", c, after));
}

int Parser::parse() {
  const int node = sum();
  skip();
  if (at_ < text_.size()) fail(at_, "expected one of + - * / ^ or the end");
  return node;
}

int Parser::sum() {
  int node = product();
  while (true) {
    if (meets('+')) {
      node = compiler_.builder().apply(Operator::add, node, product());
    } else if (meets('-')) {
      node = compiler_.builder().apply(Operator::subtract, node, product());
    } else {
      return node;
    }
  }
}

int Parser::product() {
  int node = with_sign();
  while (true) {
    if (meets('*')) {
      node = compiler_.builder().apply(Operator::multiply, node, with_sign());
    } else if (meets('/')) {
      node = compiler_.builder().apply(Operator::divide, node, with_sign());
    } else {
      return node;
    }
  }
}

int Parser::with_sign() {
  if (++compiler_.depth > deepest) fail(at_, fmt::format("nested more than {} deep", deepest));
  int node = 0;
  if (meets('-')) {
    node = compiler_.builder().negate(with_sign());
  } else {
    node = meets('+') ? with_sign() : power();
  }
  --compiler_.depth;
  return node;
}

int Parser::power() {
  const int base = operand();
  return meets('^') ? compiler_.builder().raise(base, with_sign()) : base;
}

int Parser::operand() {
  skip();
  const char c = at_ < text_.size() ? text_[at_] : '\0';
  if (begins_name(c)) return word();
  if (c == '.' || std::isdigit(static_cast<unsigned char>(c)) != 0) return number();
  if (!meets('(')) fail(at_, "expected a number, a name or \"(\"");
  const int node = sum();
  require(')', "or one of + - * / ^");
  return node;
}

int Parser::number() {
  double value = 0;
  const char* const begin = text_.data() + at_;
  const auto [end, error] = std::from_chars(begin, text_.data() + text_.size(), value);
  if (error != std::errc()) fail(at_, "expected a number that is neither too large nor too small");
  at_ += static_cast<std::size_t>(end - begin);
  return compiler_.builder().constant(value);
}

int Parser::word() {
  const std::size_t begin = at_;
  while (at_ < text_.size() && is_of_name(text_[at_])) ++at_;
  const std::string name(text_.substr(begin, at_ - begin));
  if (const int node = compiler_.find(name); node >= 0) return node;
  if (const auto constant = constants().find(name); constant != constants().end())
    return compiler_.builder().constant(constant->second);
  const auto& refused = compiler_.set().refused;
  if (const auto found = refused.find(name); found != refused.end())
    fail(begin, fmt::format("\"{}\"", name), " " + found->second);
  if (number_of_function(name) >= 0 || is_function_of_two(name)) return call(name);
  if (!meets('('))
    fail(begin, fmt::format("unknown name \"{}\"", shown(name)), "; there are " + listed(compiler_.names()));
  std::vector<std::string> names = functions_of_two();
  for (const FormulaFunction& one : functions()) names.push_back(one.name);
  fail(begin, fmt::format("unknown function \"{}\"", shown(name)), "; there are " + listed(names));
}

int Parser::call(const std::string& name) {
  require('(', fmt::format("after {}", name));
  const int first = sum();
  if (const int number = number_of_function(name); number >= 0) {
    require(')', fmt::format("after the one number of {}", name));
    return compiler_.builder().function(number, first);
  }
  require(',', fmt::format("and a second number of {}", name));
  const int second = sum();
  require(')', fmt::format("after the two numbers of {}", name));
  if (name == "pow") return compiler_.builder().raise(first, second);
  const Operator kind = name == "atan2" ? Operator::atan2
                        : name == "min" ? Operator::minimum
                                        : Operator::maximum;
  return compiler_.builder().apply(kind, first, second);
}

int Compiler::find(const std::string& name) {
  if (const auto known = known_.find(name); known != known_.end()) return known->second;
  for (const Formula& definition : set_.definitions) {
    if (definition.name == name) return define(definition);
  }
  return -1;
}

int Compiler::define(const Formula& definition) {
  const auto first = std::find(open_.begin(), open_.end(), definition.name);
  if (first != open_.end()) {
    const std::vector<std::string> circle(first, open_.end());
    throw FormulaError(place_of(definition), fmt::format("is defined by itself: {} -> {}",
                                                         fmt::join(circle, " -> "), definition.name));
  }
  open_.push_back(definition.name);
  const int node = Parser(*this, definition).parse();
  open_.pop_back();
  known_[definition.name] = node;
  return node;
}

std::vector<std::string> Compiler::names() const {
  std::vector<std::string> all = set_.variables;
  for (const Formula& definition : set_.definitions) all.push_back(definition.name);
  std::erase_if(all, [](const std::string& name) { return name.front() == '_'; });
  return all;
}

Tape Compiler::compile() {
  std::vector<int> results;
  for (int i = 0; i < set_.iterations; ++i) {
    for (std::size_t k = 0; k < results.size(); ++k) known_[set_.results[k].name] = results[k];
    for (const Formula& definition : set_.definitions) {
      if (i > 0) known_.erase(definition.name);
    }
    for (const Formula& definition : set_.definitions) find(definition.name);
    results.clear();
    for (const Formula& result : set_.results) results.push_back(Parser(*this, result).parse());
  }
  return builder_.finish(results);
}

}  // namespace

Tape compile(const FormulaSet& set) { return Compiler(set).compile(); }

std::string why_no_name(const std::string& name) {
  if (name.empty() || !begins_name(name[0]) || !std::all_of(name.begin(), name.end(), is_of_name))
    return "expected a name of letters, digits and _ that begins with a letter or _";
  if (number_of_function(name) >= 0 || is_function_of_two(name))
    return fmt::format("{} is a function; expected another name", name);
  if (constants().contains(name)) return fmt::format("{} is a constant; expected another name", name);
  if (name == time_name) return "t is the time; expected another name";
  return "";
}

}  // namespace arcslip
