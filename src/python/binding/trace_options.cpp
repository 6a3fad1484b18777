#include "python/binding/trace_options.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <functional>
#include <map>

namespace arcslip::python {
namespace {

using continuation::PointType;
using continuation::TraceOptions;
using Problem = std::shared_ptr<PythonProblem>;
using Setter = std::function<void(const py::handle&, const Problem&, TraceOptions&)>;

PointType type_named(const std::string& name) {
  const auto type = continuation::point_type(name);
  if (!type) throw py::value_error(fmt::format("stop_after: '{}' is no type of points", name));
  return *type;
}

void set_stop_after(const py::handle& given, TraceOptions& options) {
  options.stop_after.clear();
  for (const auto& [name, count] : given.cast<std::map<std::string, long>>()) {
    const bool is_event = std::any_of(options.events.begin(), options.events.end(),
                                      [&, label = name](const auto& event) { return event.name == label; });
    options.stop_after.push_back(is_event ? continuation::StopAfter{PointType::event, count, name}
                                          : continuation::StopAfter{type_named(name), count, {}});
  }
}

void set_events(const py::handle& given, const Problem& problem, TraceOptions& options) {
  options.events.clear();
  const auto functions = given.cast<std::map<std::string, py::object>>();
  if (!problem && !functions.empty())
    throw py::value_error("events: only of problems that are written in Python");
  for (const auto& [name, function] : functions) {
    options.events.push_back(
        {name, [problem, function = function, what = fmt::format("events['{}']", name)](
                   const Vector& u, const Vector& p, const continuation::Regime& regime) {
           return problem->call_for_number(function, what, u, p, regime);
         }});
  }
}

void set_stop_at(const py::handle& given, TraceOptions& options) {
  try {
    options.stop_at = given.cast<std::vector<double>>();
  } catch (const py::cast_error&) {
    throw py::value_error(fmt::format("stop_at: expected values of {} alone, which is continued, got {}",
                                      options.parameter, py::repr(given).cast<std::string>()));
  }
}

template <class Value>
Setter plain(Value TraceOptions::*member) {
  return [member](const py::handle& given, const Problem&, TraceOptions& options) {
    options.*member = given.cast<Value>();
  };
}

/// In the order in which they are set: events before those that are counted.
const std::vector<std::pair<std::string, Setter>>& setters() {
  static const std::vector<std::pair<std::string, Setter>> all = {
      {"parameter", plain(&TraceOptions::parameter)},
      {"range",
       [](const py::handle& given, const Problem&, TraceOptions& options) {
         std::tie(options.from, options.to) = given.cast<std::pair<double, double>>();
       }},
      {"stop_at",
       [](const py::handle& given, const Problem&, TraceOptions& options) { set_stop_at(given, options); }},
      {"extrema_of", plain(&TraceOptions::extrema_of)},
      {"events", [](const py::handle& given, const Problem& problem,
                    TraceOptions& options) { set_events(given, problem, options); }},
      {"stop_after", [](const py::handle& given, const Problem&,
                        TraceOptions& options) { set_stop_after(given, options); }},
      {"tolerance", plain(&TraceOptions::tolerance)},
      {"max_step", plain(&TraceOptions::max_step)},
      {"min_step", plain(&TraceOptions::min_step)},
      {"max_points", plain(&TraceOptions::max_points)},
      {"max_branches", plain(&TraceOptions::max_branches)},
      {"max_seconds", plain(&TraceOptions::max_seconds)},
      {"bound", plain(&TraceOptions::bound)}};
  return all;
}

}  // namespace

void set_options(const py::dict& given, const std::shared_ptr<PythonProblem>& problem,
                 TraceOptions& options) {
  for (const auto& [name, set] : setters()) {
    if (!given.contains(name)) continue;
    try {
      set(given[name.c_str()], problem, options);
    } catch (const py::cast_error&) {
      throw py::value_error(
          fmt::format("{}: {} is none", name, py::repr(given[name.c_str()]).cast<std::string>()));
    }
  }
  const auto unknown = [&](const py::handle& key) {
    return std::none_of(setters().begin(), setters().end(),
                        [&](const auto& setter) { return setter.first == key.cast<std::string>(); });
  };
  for (const auto& item : given) {
    if (unknown(item.first))
      throw py::type_error(fmt::format("'{}' is no option of a trace", item.first.cast<std::string>()));
  }
}

}  // namespace arcslip::python
