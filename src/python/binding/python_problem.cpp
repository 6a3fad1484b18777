#include "python/binding/python_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "arcslip/problems/formulas/formula_problem.hpp"
#include "python/binding/arrays.hpp"
#include "python/binding/differences.hpp"

namespace arcslip::python {

using continuation::Evaluation;
using continuation::Gradient;
using continuation::Observable;
using continuation::Regime;

thread_local Interruption* PythonProblem::listener_ = nullptr;

/// Whether `work` came to its end; with the interpreter's lock.
template <class Work>
bool PythonProblem::guarded(const Work& work) const {
  if (listener_ != nullptr && listener_->is_stopped()) return false;
  const py::gil_scoped_acquire lock;
  Interruption nobody;
  Interruption& listener = listener_ != nullptr ? *listener_ : nobody;
  try {
    work();
  } catch (py::error_already_set& raised) {
    note_raised(listener, raised);
  } catch (const std::exception&) {
    listener.fail(std::current_exception());
  }
  return !listener.is_stopped();
}

void PythonProblem::activate(const std::string& parameter) {
  continuation::index_of(traits_.parameters, parameter);
  traits_.active.push_back(parameter);
}

void PythonProblem::scale_within(const std::string& parameter, double from, double to) {
  if (traits_.scales_by_ranges)
    traits_.parameter_scale(continuation::index_of(traits_.parameters, parameter)) =
        problems::magnitude_within(from, to);
}

namespace {

/// Only what is moved off the real axis is complex.
py::object number_of(double value) { return py::float_(value); }
py::object number_of(const Complex& value) {
  return value.imag() != 0 ? py::cast(value) : py::object(py::float_(value.real()));
}

template <class Numbers>
py::object parameters_in_form(const std::string& form, const std::vector<std::string>& names,
                              const Numbers& p) {
  if (form == "number") return number_of(p(0));
  if (form == "array") return give(p);
  py::dict named;
  for (std::size_t i = 0; i < names.size(); ++i)
    named[names[i].c_str()] = number_of(p(static_cast<Index>(i)));
  return named;
}

}  // namespace

py::object PythonProblem::parameters_as(const Vector& p) const {
  return parameters_in_form(traits_.form, traits_.parameters, p);
}

py::object PythonProblem::parameters_as(const ComplexVector& p) const {
  return parameters_in_form(traits_.form, traits_.parameters, p);
}

py::object PythonProblem::to_python(const Regime& regime) const {
  if (traits_.switches == 1) return py::int_(regime[0]);
  py::tuple states(traits_.switches);
  for (Index i = 0; i < traits_.switches; ++i) states[static_cast<std::size_t>(i)] = regime[i];
  return states;
}

Regime PythonProblem::to_regime(const py::handle& given) const {
  if (py::isinstance<py::int_>(given)) return {given.cast<int>()};
  const auto states = given.cast<std::vector<int>>();
  if (std::ssize(states) != traits_.switches)
    throw py::value_error(
        fmt::format("regime: expected the states of {} switches, got {}", traits_.switches, states.size()));
  Regime regime;
  for (std::size_t i = 0; i < states.size(); ++i) regime = regime.with(static_cast<Index>(i), states[i]);
  return regime;
}

template <class U, class P>
py::object PythonProblem::call(const py::object& function, const U& u, const P& p,
                               const Regime& regime) const {
  if (traits_.switches == 0) return function(give(u), parameters_as(p));
  return function(give(u), parameters_as(p), to_python(regime));
}

template <class Out, class U, class P>
Out PythonProblem::residual_at(const U& u, const P& p, const Regime& regime) const {
  Out values(traits_.size);
  take(call(functions_.residual, u, p, regime), "f", values);
  return values;
}

template <class Out, class U, class P>
Out PythonProblem::observed_at(const U& u, const P& p, const Regime& regime) const {
  const py::object given = call(functions_.observables, u, p, regime);
  if (!py::isinstance<py::dict>(given)) throw py::type_error("observables: expected a dict of numbers");
  Out values(std::ssize(traits_.observables));
  for (Index i = 0; i < values.size(); ++i) {
    const std::string& name = traits_.observables[static_cast<std::size_t>(i)];
    if (!given.contains(name)) throw py::value_error(fmt::format("observables: '{}' is missing", name));
    Out one(1);
    take(given[name.c_str()], fmt::format("observables['{}']", name), one);
    values(i) = one(0);
  }
  return values;
}

template <class Out, class U, class P>
Out PythonProblem::borders_at(const U& u, const P& p, const Regime& regime) const {
  const py::object given = call(functions_.borders, u, p, regime);
  Out values;
  if constexpr (std::is_same_v<Out, Vector>) {
    values = take_all(given, "borders");
  } else {
    values = take_all_complex(given, "borders");
  }
  const auto [place, is_new] = border_counts_.try_emplace(regime, static_cast<int>(values.size()));
  if (!is_new && place->second != values.size())
    throw py::value_error(
        fmt::format("borders: {} numbers of a regime that had {}", values.size(), place->second));
  return values;
}

double PythonProblem::call_for_number(const py::object& function, const std::string& what, const Vector& u,
                                      const Vector& p, const Regime& regime) const {
  Vector value = Vector::Zero(1);
  const bool done = guarded([&] { take(call(function, u, p, regime), what, value); });
  return done ? value(0) : 0;
}

std::string PythonProblem::place(const Vector& p) const {
  std::string text;
  for (std::size_t i = 0; i < traits_.parameters.size(); ++i)
    text += fmt::format("{}{} = {:.10g}", text.empty() ? "" : ", ", traits_.parameters[i],
                        p(static_cast<Index>(i)));
  return text;
}

void PythonProblem::fill_jacobian(const Vector& u, const Vector& p, const Regime& regime, Matrix& out) const {
  if (traits_.by_unknowns == Step::none) {
    take(call(functions_.jacobian, u, p, regime), "jacobian", out);
    return;
  }
  by_each_unknown(traits_.by_unknowns, u, traits_.unknown_scale, out,
                  [&]<class Out>(const auto& at, Out*) { return residual_at<Out>(at, p, regime); });
}

void PythonProblem::fill_parameter_jacobian(const Vector& u, const Vector& p, const Regime& regime,
                                            Matrix& out) const {
  if (traits_.by_parameters == Step::none) {
    take(call(functions_.parameter_jacobian, u, p, regime), "parameter_jacobian", out);
    return;
  }
  by_each_parameter(traits_.by_parameters, p, traits_, out,
                    [&]<class Out>(const auto& at, Out*) { return residual_at<Out>(u, at, regime); });
}

void PythonProblem::fill(const Vector& u, const Vector& p, const Regime& regime,
                         const Evaluation& out) const {
  if (out.residual != nullptr) *out.residual = residual_at<Vector>(u, p, regime);
  if (out.sparse_jacobian != nullptr)
    take(call(functions_.jacobian, u, p, regime), "jacobian", traits_.size, *out.sparse_jacobian);
  if (out.jacobian != nullptr) fill_jacobian(u, p, regime, *out.jacobian);
  if (out.parameter_jacobian != nullptr) fill_parameter_jacobian(u, p, regime, *out.parameter_jacobian);
}

namespace {

/// The row and the column of the first entry that is nan, if one is.
std::optional<std::pair<Index, Index>> first_nan(const Matrix& matrix) {
  for (Index j = 0; j < matrix.cols(); ++j) {
    for (Index i = 0; i < matrix.rows(); ++i) {
      if (std::isnan(matrix(i, j))) return {{i, j}};
    }
  }
  return {};
}

std::optional<std::pair<Index, Index>> first_nan(const SparseMatrix& matrix) {
  for (Index j = 0; j < matrix.cols(); ++j) {
    for (SparseMatrix::InnerIterator entry(matrix, j); entry; ++entry) {
      if (std::isnan(entry.value())) return {{entry.row(), j}};
    }
  }
  return {};
}

/// A sum takes less time than to look at each, and is finite but for those that overflow.
bool all_finite(const Matrix& matrix) { return std::isfinite(matrix.sum()) || matrix.allFinite(); }
bool all_finite(const SparseMatrix& matrix) { return matrix.coeffs().allFinite(); }

}  // namespace

/// Derivatives that are not finite are no value; nan where F is finite is named, except of differences, which
/// have F at the point's neighbours, and these may lie across an edge of its domain.
void PythonProblem::require_numbers(const Vector& p, const Evaluation& out, bool& has_value) const {
  const bool finite = out.residual != nullptr && out.residual->allFinite();
  const auto check = [&](const auto* matrix, Step step, const char* name) {
    if (matrix == nullptr || all_finite(*matrix)) return;
    has_value = false;
    const auto at = first_nan(*matrix);
    if (finite && at && step != Step::central)
      throw py::value_error(fmt::format("{}: entry ({}, {}) is nan at {}, where f is finite", name, at->first,
                                        at->second, place(p)));
  };
  check(out.jacobian, traits_.by_unknowns, "jacobian");
  check(out.sparse_jacobian, traits_.by_unknowns, "jacobian");
  check(out.parameter_jacobian, traits_.by_parameters, "parameter_jacobian");
}

bool PythonProblem::evaluate(const Vector& u, const Vector& p, const Regime& regime,
                             const Evaluation& out) const {
  bool has_value = true;
  const bool done = guarded([&] {
    if (!functions_.borders.is_none()) {
      last_u_ = u;
      last_p_ = p;
    }
    fill(u, p, regime, out);
    require_numbers(p, out, has_value);
  });
  return done && has_value;
}

bool PythonProblem::eigenvalues(const Vector& u, const Vector& p, const Regime& regime,
                                ComplexVector& values) const {
  if (functions_.eigenvalues.is_none()) return Problem::eigenvalues(u, p, regime, values);
  const bool done = guarded([&] {
    values = take_all_complex(call(functions_.eigenvalues, u, p, regime), "eigenvalues");
    if (!values.allFinite())
      throw py::value_error(fmt::format("eigenvalues: one is not finite at {}", place(p)));
    last_eigenvalues_ = values;
  });
  if (!done) values = last_eigenvalues_;  // the branch ends; until then there are as many as before
  return done || values.size() > 0;
}

void PythonProblem::scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const {
  unknowns = u.cwiseAbs().cwiseMax(traits_.unknown_scale);
  parameters = p.cwiseAbs().cwiseMax(traits_.parameter_scale);
}

int PythonProblem::border_count(const Regime& regime) const {
  if (functions_.borders.is_none()) return 0;
  const py::gil_scoped_acquire lock;
  if (const auto known = border_counts_.find(regime); known != border_counts_.end()) return known->second;
  int count = 0;
  guarded([&] { count = static_cast<int>(borders_at<Vector>(last_u_, last_p_, regime).size()); });
  return count;
}

double PythonProblem::border(const Vector& u, const Vector& p, const Regime& regime, int border,
                             Gradient* gradient) const {
  double value = -1;
  if (gradient != nullptr) *gradient = {Vector::Zero(u.size()), Vector::Zero(p.size())};
  guarded([&] {
    value = borders_at<Vector>(u, p, regime)(border);
    if (gradient == nullptr) return;
    const auto one = [&]<class Out>(const auto& at_u, const auto& at_p, Out*) -> Out {
      return Out::Constant(1, borders_at<Out>(at_u, at_p, regime)(border));
    };
    fill_gradient(traits_.of_borders, u, p, traits_, *gradient, one);
  });
  return value;
}

std::optional<Regime> PythonProblem::regime_beyond(const Regime& regime, int border) const {
  std::optional<Regime> beyond;
  guarded([&] {
    const py::object given = functions_.beyond(to_python(regime), border);
    if (!given.is_none()) beyond = to_regime(given);
  });
  return beyond;
}

std::vector<Observable> PythonProblem::observables() const {
  std::vector<Observable> all;
  for (const std::string& name : traits_.unknowns) all.push_back({name, true});
  for (const std::string& name : traits_.observables) all.push_back({name, true});
  return all;
}

void PythonProblem::observe(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const {
  const Index named = std::ssize(traits_.unknowns);
  values = Vector::Constant(named + std::ssize(traits_.observables), std::nan(""));
  values.head(named) = u.head(named);
  if (traits_.observables.empty()) return;
  guarded([&] { values.tail(values.size() - named) = observed_at<Vector>(u, p, regime); });
}

double PythonProblem::observe(const Vector& u, const Vector& p, const Regime& regime, Index which,
                              Gradient& gradient) const {
  gradient = {Vector::Zero(u.size()), Vector::Zero(p.size())};
  const Index own = which - std::ssize(traits_.unknowns);
  if (own < 0) {
    gradient.unknowns(which) = 1;
    return u(which);
  }
  double value = 0;
  guarded([&] {
    value = observed_at<Vector>(u, p, regime)(own);
    const auto one = [&]<class Out>(const auto& at_u, const auto& at_p, Out*) -> Out {
      return Out::Constant(1, observed_at<Out>(at_u, at_p, regime)(own));
    };
    fill_gradient(traits_.of_observables, u, p, traits_, gradient, one);
  });
  return value;
}

std::optional<std::string> PythonProblem::wrong_derivative(const Vector& u, const Vector& p,
                                                           const Regime& regime, Index parameter,
                                                           const std::vector<Index>& tracked) const {
  const bool given = traits_.by_unknowns == Step::none || traits_.by_parameters == Step::none;
  return given ? Problem::wrong_derivative(u, p, regime, parameter, tracked) : std::nullopt;
}

}  // namespace arcslip::python
