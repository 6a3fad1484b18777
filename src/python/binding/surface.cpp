#include "python/binding/surface.hpp"

#include "arcslip/continuation/atlas/atlas.hpp"
#include "python/binding/tracing.hpp"

namespace arcslip::python {
namespace {

using continuation::Atlas;

/// One row for each, of what `value` takes from it.
template <class All, class Value>
py::array rows_of(const All& all, const Value& value) {
  Matrix columns(all.empty() ? 0 : value(all.front()).size(), std::ssize(all));
  for (std::size_t i = 0; i < all.size(); ++i) columns.col(static_cast<Index>(i)) = value(all[i]);
  return give(std::move(columns));
}

/// A number of each.
template <class All, class Value>
py::array_t<double> numbers_of(const All& all, const Value& value) {
  py::array_t<double> numbers(std::ssize(all));
  for (std::size_t i = 0; i < all.size(); ++i) numbers.mutable_at(i) = static_cast<double>(value(all[i]));
  return numbers;
}

/// A text of each.
template <class All, class Value>
py::list texts_of(const All& all, const Value& value) {
  py::list texts;
  for (const auto& one : all) texts.append(std::string(value(one)));
  return texts;
}

py::dict told(const Atlas& atlas) {
  py::dict told;
  const auto unknowns = [](const auto& one) -> const Vector& { return one.unknowns; };
  const auto parameters = [](const auto& one) -> const Vector& { return one.parameters; };
  told["unknowns"] = rows_of(atlas.charts, unknowns);
  told["parameters"] = rows_of(atlas.charts, parameters);
  told["radius"] = numbers_of(atlas.charts, [](const auto& chart) { return chart.radius; });
  told["component"] = numbers_of(atlas.charts, [](const auto& chart) { return chart.component; });
  told["determinant"] = numbers_of(atlas.charts, [](const auto& chart) { return chart.determinant; });
  told["unstable"] = numbers_of(atlas.charts, [](const auto& chart) { return chart.unstable; });
  py::array_t<int> faces({std::ssize(atlas.faces), py::ssize_t{3}});
  for (std::size_t i = 0; i < atlas.faces.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) faces.mutable_at(i, k) = atlas.faces[i][k];
  }
  told["faces"] = faces;
  told["fold_type"] = texts_of(atlas.folds, [](const auto& fold) { return to_string(fold.type); });
  told["fold_turns"] = numbers_of(atlas.folds, [](const auto& fold) { return fold.turns; });
  told["fold_curve"] = numbers_of(atlas.folds, [](const auto& fold) { return fold.curve; });
  told["fold_unknowns"] = rows_of(atlas.folds, unknowns);
  told["fold_parameters"] = rows_of(atlas.folds, parameters);
  told["ridge_type"] = texts_of(atlas.ridges, [](const auto& ridge) { return to_string(ridge.type); });
  told["ridge_observable"] = texts_of(atlas.ridges, [](const auto& ridge) { return ridge.observable; });
  told["ridge_curve"] = numbers_of(atlas.ridges, [](const auto& ridge) { return ridge.curve; });
  told["ridge_unknowns"] = rows_of(atlas.ridges, unknowns);
  told["ridge_parameters"] = rows_of(atlas.ridges, parameters);
  py::list components;
  for (const continuation::AtlasComponent& one : atlas.components)
    components.append(py::dict(py::arg("charts") = one.charts, py::arg("faces") = one.faces,
                               py::arg("euler") = one.euler, py::arg("closed") = one.closed));
  told["components"] = components;
  told["stop"] = std::string(to_string(atlas.stop));
  told["reason"] = atlas.reason;
  return told;
}

py::dict cover(const std::shared_ptr<PythonProblem>& problem, const std::vector<py::object>& starts,
               const py::handle& p, const std::array<std::string, 2>& parameters,
               const std::array<std::pair<double, double>, 2>& ranges, const py::dict& given) {
  std::vector<continuation::Guess> guesses;
  for (const py::object& start : starts) guesses.push_back(guess_of(*problem, start, p, py::int_(0)));
  problem->activate(parameters[0]);
  problem->activate(parameters[1]);
  continuation::AtlasOptions options;
  options.parameters = parameters;
  for (std::size_t k = 0; k < 2; ++k) {
    options.from[k] = ranges[k].first;
    options.to[k] = ranges[k].second;
  }
  options.max_radius = given["max_radius"].cast<double>();
  options.max_turn = given["max_turn"].cast<double>();
  options.extrema_of = given["extrema_of"].cast<std::vector<std::string>>();
  options.most_charts = given["max_charts"].cast<long>();
  options.max_seconds = given["max_seconds"].cast<double>();
  continuation::TraceOptions trace;
  return told(in_engine(trace, py::none(), [&](const auto&) {
    options.go_on = trace.go_on;
    return continuation::cover(*traced_problem(problem), guesses, options);
  }));
}

}  // namespace

void bind_surface(py::module_& module) { module.def("cover", cover); }

}  // namespace arcslip::python
