#include "python/binding/formulas.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "python/binding/arrays.hpp"

namespace arcslip::python {
namespace {

using problems::FormulaKind;
using problems::FormulaSystem;
using Texts = std::vector<std::pair<std::string, std::string>>;

std::vector<Formula> formulas_of(const std::string& name, const Texts& texts) {
  std::vector<Formula> formulas;
  for (const auto& [key, text] : texts) formulas.push_back({key, text, name + "." + key});
  return formulas;
}

FormulaKind kind_named(const std::string& name) {
  if (name == "forced") return FormulaKind::forced;
  if (name == "boundary") return FormulaKind::boundary;
  if (name == "piecewise") return FormulaKind::piecewise;
  return name == "map" ? FormulaKind::map : name == "flow" ? FormulaKind::flow : FormulaKind::algebraic;
}

/// What conditions are on, as Model gives it: (variable, from, to), conditions, integrals, free parameters.
using Ends = std::tuple<std::string, std::string, std::string>;
using Conditions =
    std::tuple<Ends, std::vector<std::string>, std::vector<std::string>, std::vector<std::string>>;

std::vector<Formula> listed(const std::string& name, const std::vector<std::string>& texts) {
  std::vector<Formula> formulas;
  for (const std::string& text : texts) {
    const std::string place = fmt::format("{}[{}]", name, formulas.size());
    formulas.push_back({place, text, place});
  }
  return formulas;
}

void set_conditions(const Conditions& given, FormulaSystem& system) {
  const auto& [ends, conditions, integrals, free] = given;
  const auto& [variable, from, to] = ends;
  const std::string place = "interval." + variable;
  system.interval = {variable, {variable, from, place + "[0]"}, {variable, to, place + "[1]"}, place};
  system.conditions = listed("conditions", conditions);
  system.integrals = listed("integrals", integrals);
  system.free = free;
}

/// How pieces follow each other, as Model gives it: (name, equations, until, reset) of each, names in order.
using Piece = std::tuple<std::string, Texts, std::string, Texts>;
using Pieces = std::pair<std::vector<Piece>, std::vector<std::string>>;

void set_pieces(const Pieces& given, FormulaSystem& system) {
  for (const auto& [name, equations, until, reset] : given.first) {
    const std::string place = "pieces." + name;
    system.pieces.push_back({.name = name,
                             .equations = formulas_of(place + ".equations", equations),
                             .until = {"until", until, place + ".until"},
                             .reset = formulas_of(place + ".reset", reset),
                             .place = place});
  }
  system.cycle = given.second;
}

Formulas compiled(const FormulaSystem& system) {
  std::shared_ptr<const problems::FormulaField> forced;
  if (system.kind == FormulaKind::forced) forced = std::make_shared<const problems::FormulaField>(system);
  std::optional<problems::LibraryModel> orbits;
  if (system.kind == FormulaKind::boundary || system.kind == FormulaKind::piecewise)
    orbits = problems::model_of(system);
  return {std::make_shared<const problems::FormulaProblem>(system), forced, problems::start_of(system),
          orbits};
}

Formulas made(const std::string& kind, int iterate,
              const std::vector<std::pair<std::string, double>>& numbers,
              const std::vector<std::pair<std::string, double>>& scale, const Texts& definitions,
              const Texts& equations, const Texts& observables, const Texts& start,
              const std::optional<std::string>& period, const std::vector<std::string>& angles,
              const std::optional<Conditions>& conditions, const std::optional<Pieces>& pieces) {
  FormulaSystem system{.kind = kind_named(kind), .iterate = iterate};
  system.angles = angles;
  if (period) system.period = Formula{"period", *period};
  for (const auto& [name, value] : numbers) system.parameters.push_back({name, value, "parameters." + name});
  for (const auto& [name, value] : scale) system.scale.push_back({name, value, "scale." + name});
  system.definitions = formulas_of("definitions", definitions);
  system.equations = formulas_of("equations", equations);
  system.observables = formulas_of("observables", observables);
  system.start = formulas_of("start", start);
  if (conditions) set_conditions(*conditions, system);
  if (pieces) set_pieces(*pieces, system);
  return compiled(system);
}

/// With a parameter in the scale of the range that it is continued over.
Formulas within(const Formulas& formulas, const std::string& parameter, double from, double to) {
  FormulaSystem system = formulas.problem->system();
  problems::scale_within(system, parameter, from, to);
  return compiled(system);
}

/// What it is called with, as the problem takes it.
struct Place {
  Place(const Formulas& formulas, const py::handle& unknowns, const py::handle& parameters)
      : u(formulas.problem->size()), p(std::ssize(formulas.problem->parameter_names())) {
    take(unknowns, "u", u);
    take(parameters, "p", p);
  }
  Vector u, p;
};

/// F or one of its derivatives; nan where there is no value.
template <class Target>
py::array evaluated(const Formulas& formulas, const Place& at, Target* continuation::Evaluation::*which,
                    Target values) {
  continuation::Evaluation out;
  out.*which = &values;
  if (!formulas.problem->evaluate(at.u, at.p, {}, out)) values.setConstant(std::nan(""));
  if constexpr (std::is_same_v<Target, Matrix>) return give(Matrix(values.transpose()));
  return give(values);
}

}  // namespace

void bind_formulas(py::module_& module) {
  using continuation::Evaluation;
  module.def("magnitude_within", problems::magnitude_within);
  py::class_<Formulas>(module, "Formulas")
      .def(py::init(&made))
      .def("within", within)
      .def("residual",
           [](const Formulas& self, const py::handle& u, const py::handle& p) {
             const Place at(self, u, p);
             return evaluated(self, at, &Evaluation::residual, Vector(at.u.size()));
           })
      .def("jacobian",
           [](const Formulas& self, const py::handle& u, const py::handle& p) {
             const Place at(self, u, p);
             return evaluated(self, at, &Evaluation::jacobian, Matrix(at.u.size(), at.u.size()));
           })
      .def("parameter_jacobian",
           [](const Formulas& self, const py::handle& u, const py::handle& p) {
             const Place at(self, u, p);
             return evaluated(self, at, &Evaluation::parameter_jacobian, Matrix(at.u.size(), at.p.size()));
           })
      .def("observed",
           [](const Formulas& self, const py::handle& u, const py::handle& p) {
             const Place at(self, u, p);
             Vector values;
             self.problem->observe(at.u, at.p, {}, values);
             return give(Vector(values.tail(values.size() - at.u.size())));
           })
      .def("start", [](const Formulas& self, const std::vector<double>& p) {
        Vector u(self.problem->size());
        if (!self.start.evaluate(p.data(), u.data()))
          throw py::value_error("start: it has no value at these parameters");
        return give(u);
      });
}

}  // namespace arcslip::python
