#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "arcslip/continuation/cycles/cycle_branch.hpp"
#include "arcslip/problems/formulas/formula_boundary.hpp"
#include "arcslip/problems/formulas/formula_field.hpp"
#include "arcslip/problems/formulas/formula_pieces.hpp"
#include "arcslip/problems/library/model.hpp"

namespace arcslip::problems {
namespace {

/// What tables and summaries of branches have under these names.
const std::vector<std::string> columns{"branch",    "point",       "type",       "regime", "unstable",
                                       "arclength", "iterations",  "residual",   "state",  "omega",
                                       "lyapunov",  "normal_form", "coefficient"};

/// Keeps the names that were seen.
class Names {
 public:
  template <class Named>
  void add(const std::vector<Named>& all) {
    for (const Named& one : all) add(one.name, one.place.empty() ? one.name : one.place);
  }

  /// The place and, of each unknown, its values at both ends.
  void add(const FormulaInterval& interval, const std::vector<Formula>& unknowns) {
    const std::string& place = interval.place.empty() ? interval.variable : interval.place;
    add(interval.variable, place, interval.variable == time_name ? "" : why_no_name(interval.variable));
    for (const Formula& unknown : unknowns) {
      for (const char* end : {"_left", "_right"}) add(unknown.name + end, unknown.name + end, "");
    }
  }

 private:
  void add(const std::string& name, const std::string& place) { add(name, place, why_no_name(name)); }

  void add(const std::string& name, const std::string& place, std::string why) {
    if (why.empty() && std::count(columns.begin(), columns.end(), name) > 0)
      why = fmt::format("results have {} already; expected another name", name);
    const auto [known, is_new] = places_.try_emplace(name, place);
    if (why.empty() && !is_new) why = fmt::format("{} has this name already", known->second);
    if (!why.empty()) throw FormulaError(place, why);
  }

  std::map<std::string, std::string> places_;
};

std::string title_of(const FormulaSystem& system) {
  std::vector<std::string> unknowns;
  for (const Formula& equation : system.equations) unknowns.push_back(equation.name);
  std::string names = fmt::format("{}", fmt::join(unknowns, ", "));
  switch (system.kind) {
    case FormulaKind::flow: return fmt::format("a flow of {}", names);
    case FormulaKind::forced: return fmt::format("a forced flow of {}", names);
    case FormulaKind::boundary: return fmt::format("a boundary value problem of {}", names);
    case FormulaKind::piecewise: return fmt::format("a piecewise flow of {}", names);
    case FormulaKind::algebraic: return fmt::format("equations in {}", names);
    case FormulaKind::map:
      return fmt::format("a map of {}{}", names,
                         system.iterate > 1 ? fmt::format(", {} times", system.iterate) : "");
  }
  return names;
}

/// Problem and guess of cycles: as long as nothing is known of them, of orbits that stay where they start.
void add_cycles(const std::shared_ptr<const FormulaField>& field, const Tape& start, LibraryModel& model) {
  const auto resting = [field, start](const LibraryModel::Values& values) {
    const continuation::CycleOptions options;
    const Vector p = parameters_of(values, std::ssize(values));
    Vector u(field->size());
    if (!start.evaluate(p.data(), u.data()))
      throw std::invalid_argument("the guess of the start has no value at the parameters of the start");
    const continuation::OrbitMesh mesh(continuation::CollocationRule(options.degree), options.intervals);
    return continuation::cycle_from_orbit(field, mesh, u.replicate(1, mesh.nodes()), 0, p);
  };
  model.build = [resting](const LibraryModel::Values& values) {
    return std::make_unique<continuation::CycleProblem>(*resting(values).problem);
  };
  model.guess = [field, resting](const continuation::Problem& /*problem*/,
                                 const LibraryModel::Values& values) {
    field->require_period(parameters_of(values, std::ssize(values)));
    return resting(values).guess;
  };
}

/// Its problem, guess and what it sets out from.
void add_boundary(const std::shared_ptr<const FormulaBoundary>& field, LibraryModel& model) {
  model.orbit = [field](const LibraryModel::Values& values, const continuation::OrbitOptions& options,
                        std::optional<double> /*settle*/) {
    const Index count = std::ssize(field->parameter_names());
    const Vector all = parameters_of(values, count + field->free());
    const Vector p = all.head(count);
    const auto guess = [&](double s) {
      Vector u;
      if (!field->guess(s, all.tail(field->free()), p, u))
        throw std::invalid_argument("the guess of the start has no value at the parameters of the start");
      return u;
    };
    return continuation::boundary_start(field, guess, p, options);
  };
  model.build = [field](const LibraryModel::Values& values) {  // its guess may have no value yet
    const continuation::OrbitOptions options;
    const continuation::OrbitMesh mesh(continuation::CollocationRule(options.degree), options.intervals);
    return std::make_unique<continuation::BoundaryProblem>(
        field, mesh, Matrix::Zero(field->size(), mesh.nodes()),
        parameters_of(values, std::ssize(field->parameter_names())));
  };
  model.guess = [start = model.orbit](const continuation::Problem& /*problem*/,
                                      const LibraryModel::Values& values) {
    return start(values, {}, std::nullopt).guess;
  };
}

/// Its problem, guess and what it sets out from.
void add_pieces(const std::shared_ptr<const FormulaPieces>& field, const Tape& start, LibraryModel& model) {
  model.is_piecewise = true;
  model.orbit = [field, start](const LibraryModel::Values& values, const continuation::OrbitOptions& options,
                               std::optional<double> settle) {
    const Vector p = parameters_of(values, std::ssize(values));
    field->require_period(p);
    Vector u = Vector::Zero(field->size());
    if (!start.evaluate(p.data(), u.data()))
      throw std::invalid_argument("the guess of the start has no value at the parameters of the start");
    return continuation::settled_pieces(field, u, p, settle, options);
  };
  model.build = [field](const LibraryModel::Values& values) {
    const continuation::OrbitOptions options;
    const continuation::OrbitMesh mesh(continuation::CollocationRule(options.degree), options.intervals);
    return std::make_unique<continuation::PiecewiseCycle>(
        field, mesh, Matrix::Ones((field->size() + 1) * field->pieces(), mesh.nodes()),
        parameters_of(values, std::ssize(values)));
  };
  model.guess = [](const continuation::Problem& problem, const LibraryModel::Values& values) {
    return continuation::Guess{Vector::Ones(problem.size()), parameters_of(values, std::ssize(values))};
  };
}

}  // namespace

void check_names(const FormulaSystem& system) {
  Names names;
  names.add(system.parameters);
  names.add(system.equations);
  names.add(system.definitions);
  names.add(system.observables);
  names.add(system.pieces);
  if (system.interval) names.add(*system.interval, system.equations);
  const auto has = [](const auto& all, const std::string& name) {
    return std::any_of(all.begin(), all.end(), [&](const auto& one) { return one.name == name; });
  };
  const auto require = [](bool known, const auto& one, const char* why) {
    if (!known) throw FormulaError(one.place.empty() ? one.name : one.place, why);
  };
  for (const Formula& start : system.start)
    require(has(system.equations, start.name), start, "there is no equation of this name");
  for (const FormulaParameter& one : system.scale)
    require(has(system.equations, one.name) || has(system.parameters, one.name), one,
            "there is no unknown or parameter of this name");
}

double magnitude_within(double from, double to) {
  constexpr double little = 0.01;
  const double largest = std::max(std::abs(from), std::abs(to));
  return largest > 0 && largest < little ? largest : 1;
}

void scale_within(FormulaSystem& system, const std::string& parameter, double from, double to) {
  const double magnitude = magnitude_within(from, to);
  const auto is_it = [&](const FormulaParameter& one) { return one.name == parameter; };
  if (magnitude < 1 && std::any_of(system.parameters.begin(), system.parameters.end(), is_it) &&
      std::none_of(system.scale.begin(), system.scale.end(), is_it))
    system.scale.push_back({parameter, magnitude});
}

FormulaScale::FormulaScale(const FormulaSystem& system, const std::vector<std::string>& unknowns,
                           const std::vector<std::string>& parameters)
    : unknowns_(Vector::Ones(std::ssize(unknowns))), parameters_(Vector::Ones(std::ssize(parameters))) {
  for (const FormulaParameter& one : system.scale) {
    for (const auto& [names, magnitudes] :
         {std::pair(&unknowns, &unknowns_), std::pair(&parameters, &parameters_)}) {
      const auto place = std::find(names->begin(), names->end(), one.name);
      if (place != names->end()) (*magnitudes)(place - names->begin()) = one.value;
    }
  }
}

Tape start_of(const FormulaSystem& system) {
  FormulaSet set;
  for (const FormulaParameter& parameter : system.parameters) set.variables.push_back(parameter.name);
  if (system.interval) set.definitions.push_back({system.interval->variable, system.interval->from.text});
  for (const Formula& equation : system.equations) {
    const auto given = std::find_if(system.start.begin(), system.start.end(),
                                    [&](const Formula& one) { return one.name == equation.name; });
    set.results.push_back(given != system.start.end() ? *given : Formula{equation.name, "0"});
  }
  return compile(set);
}

LibraryModel model_of(const FormulaSystem& system) {
  LibraryModel model{"[model]", title_of(system), {}, {}, {}};
  for (const FormulaParameter& parameter : free_ones_last(system))
    model.settings.push_back(any_value(parameter.name, parameter.value, ""));
  check_names(system);
  if (system.kind == FormulaKind::boundary) {
    add_boundary(std::make_shared<const FormulaBoundary>(system), model);
    return model;
  }
  const Tape start = start_of(system);
  if (system.kind == FormulaKind::piecewise) {
    add_pieces(std::make_shared<const FormulaPieces>(system), start, model);
    return model;
  }
  if (system.kind == FormulaKind::forced) {
    model.is_driven = true;
    add_cycles(std::make_shared<const FormulaField>(system), start, model);
    return model;
  }
  model.build = [problem = FormulaProblem(system)](const LibraryModel::Values& /*values*/) {
    return std::make_unique<FormulaProblem>(problem);
  };
  model.enclosed = [problem = FormulaProblem(system)](const LibraryModel::Values& values) {
    return problem.enclosed(parameters_of(values, std::ssize(values)));
  };
  model.guess = guess_at([start](const continuation::Problem& problem, const Vector& p) {
    Vector u(problem.size());
    if (!start.evaluate(p.data(), u.data()))
      throw std::invalid_argument("the guess of the start has no value at the parameters of the start");
    return u;
  });
  return model;
}

}  // namespace arcslip::problems
