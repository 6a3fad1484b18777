#include "arcslip/problems/formulas/formula_boundary.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "field_values.hpp"

namespace arcslip::problems {
namespace {

using Words = std::vector<std::string>;

// Where formulas have the place s; users' formulas are read once without it, so that none has it.
const char* const scaled_place = "_s";

Words with(Words first, const Words& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

Words with_ending(const Words& names, const char* ending) {
  Words all;
  for (const std::string& name : names) all.push_back(name + ending);
  return all;
}

/// Refuses ends that are numbers, and one.
void check_ends(const FormulaInterval& interval) {
  for (const Formula* end : {&interval.from, &interval.to}) {
    try {
      compile({{}, {}, {*end}});
    } catch (const FormulaError&) {
      return;  // it has parameters
    }
  }
  double ends[2] = {0, 0};
  const bool known = compile({{}, {}, {interval.from, interval.to}}).evaluate(nullptr, ends);
  if (!known || ends[0] == ends[1])
    throw FormulaError(interval.place, fmt::format("expected two different ends, got {} and {}",
                                                   interval.from.text, interval.to.text));
}

/// Of the unknowns at both ends and parameters.
Tape compiled_ends(const FormulaSystem& system, const Words& unknowns, const Words& parameters) {
  FormulaSet set{with(with(with_ending(unknowns, "_left"), with_ending(unknowns, "_right")), parameters),
                 {},
                 system.conditions};
  for (const std::string& name : unknowns)
    set.refused[name] = fmt::format("is not one value; expected {0}_left or {0}_right", name);
  for (const Formula& definition : system.definitions)
    set.refused[definition.name] = "is a definition, which equations and integrals alone have";
  set.refused[system.interval->variable] = "is no number here; conditions have values at the ends";
  return compile(set);
}

std::string counted(std::size_t count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

void check_count(const FormulaSystem& system) {
  const std::size_t wanted = system.equations.size() + system.free.size();
  if (system.conditions.size() + system.integrals.size() == wanted) return;
  const std::string first = system.conditions.empty() ? "conditions" : system.conditions.front().place;
  throw FormulaError(
      first.substr(0, first.rfind('[')),
      fmt::format("expected {} conditions and integrals, one for each of {} and {}, got {} and {}", wanted,
                  counted(system.equations.size(), "unknown"), counted(system.free.size(), "free parameter"),
                  counted(system.conditions.size(), "condition"),
                  counted(system.integrals.size(), "integral")));
}

}  // namespace

std::vector<FormulaParameter> free_ones_last(const FormulaSystem& system) {
  std::vector<FormulaParameter> ordered = system.parameters;
  std::stable_partition(ordered.begin(), ordered.end(), [&](const FormulaParameter& one) {
    return std::find(system.free.begin(), system.free.end(), one.name) == system.free.end();
  });
  return ordered;
}

FormulaBoundary::FormulaBoundary(const FormulaSystem& system)
    : told_(std::ssize(system.equations)),
      free_(std::ssize(system.free)),
      variable_(system.interval->variable) {
  check_names(system);
  check_count(system);
  const std::vector<FormulaParameter> ordered = free_ones_last(system);
  for (const Formula& equation : system.equations) names_.push_back(equation.name);
  const Words unknowns = names_;
  for (const FormulaParameter& one : ordered) parameters_.push_back(one.name);
  const Words free(parameters_.end() - free_, parameters_.end());
  parameters_.resize(parameters_.size() - free.size());
  const Words all_parameters = with(free, parameters_);

  const std::vector<Formula> own{system.interval->from, system.interval->to};
  interval_ = compile({all_parameters, {}, own});
  ends_ = compiled_ends(system, unknowns, all_parameters);
  std::vector<Formula> rates = system.equations;
  rates.insert(rates.end(), system.integrals.begin(), system.integrals.end());
  compile({with({variable_}, with(unknowns, all_parameters)), system.definitions, rates});
  compile({with({variable_}, all_parameters), {}, system.start});
  check_ends(*system.interval);

  const std::string length = fmt::format("(({}) - ({}))", own[1].text, own[0].text);
  const Formula place{variable_, fmt::format("({}) + {} * {}", own[0].text, scaled_place, length)};
  std::vector<Formula> start;
  for (const std::string& name : unknowns) {
    const auto given = std::find_if(system.start.begin(), system.start.end(),
                                    [&](const Formula& one) { return one.name == name; });
    start.push_back(given != system.start.end() ? *given : Formula{name, "0"});
  }
  start_ = compile({with({scaled_place}, all_parameters), {place}, start});

  names_.insert(names_.end(), free.begin(), free.end());
  for (Formula& rate : rates) rate.text = fmt::format("({}) * {}", rate.text, length);
  rates.insert(rates.begin() + told_, free.size(), Formula{"free", "0"});
  for (std::size_t i = 0; i < system.integrals.size(); ++i)
    names_.push_back(fmt::format("integral {}", i + 1));
  scale_ = FormulaScale(system, names_, parameters_);
  std::vector<Formula> definitions = system.definitions;
  definitions.push_back(place);
  rates_ = compile({with(with({scaled_place}, names_), parameters_), definitions, rates});
}

std::pair<double, double> FormulaBoundary::interval(const Vector& u, const Vector& p) const {
  Numbers at(u.begin() + told_, u.begin() + told_ + free_);
  at.insert(at.end(), p.begin(), p.end());
  double ends[2] = {std::nan(""), std::nan("")};
  static_cast<void>(interval_.evaluate(at.data(), ends));
  return {ends[0], ends[1]};
}

bool FormulaBoundary::evaluate(double s, const Vector& u, const Vector& p,
                               const continuation::FieldValues& out) const {
  return evaluate_field(rates_, s, u, p, out);
}

bool FormulaBoundary::end_conditions(const Vector& left, const Vector& right, const Vector& p,
                                     const continuation::EndConditions& out) const {
  const Index count = ends_.results();
  Numbers at(left.begin(), left.begin() + told_);
  at.insert(at.end(), right.begin(), right.begin() + told_);
  at.insert(at.end(), left.begin() + told_, left.begin() + told_ + free_);
  at.insert(at.end(), p.begin(), p.end());
  Numbers values = room(count);
  Numbers gradients = room(count * std::ssize(at));
  if (!ends_.evaluate(at.data(), values.data(), gradients.data())) return false;
  const Eigen::Map<const Rows> rows(gradients.data(), count, std::ssize(at));
  const Index so_far = told_ + free_;
  if (out.values != nullptr) {
    out.values->head(count) = Eigen::Map<const Vector>(values.data(), count);
    out.values->segment(count, integrals()) = left.tail(integrals());
    out.values->tail(integrals()) = right.tail(integrals());
  }
  if (out.by_left != nullptr) {
    out.by_left->setZero();
    out.by_left->topLeftCorner(count, told_) = rows.leftCols(told_);
    out.by_left->block(0, told_, count, free_) = rows.middleCols(2 * told_, free_);
    out.by_left->block(count, so_far, integrals(), integrals()).setIdentity();
  }
  if (out.by_right != nullptr) {
    out.by_right->setZero();
    out.by_right->topLeftCorner(count, told_) = rows.middleCols(told_, told_);
    out.by_right->bottomRightCorner(integrals(), integrals()).setIdentity();
  }
  if (out.by_parameters != nullptr) {
    out.by_parameters->setZero();
    out.by_parameters->topRows(count) = rows.rightCols(p.size());
  }
  return true;
}

bool FormulaBoundary::guess(double s, const Vector& free, const Vector& p, Vector& u) const {
  Numbers at{s};
  at.insert(at.end(), free.begin(), free.end());
  at.insert(at.end(), p.begin(), p.end());
  u.setZero(size());
  u.segment(told_, free_) = free;
  return start_.evaluate(at.data(), u.data());
}

}  // namespace arcslip::problems
