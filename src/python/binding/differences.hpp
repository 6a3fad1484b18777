#pragma once

// Derivatives that a user has not given, by complex steps or central differences of the function.
//
// The functions are called as function(at, static_cast<Out*>(nullptr)) and give an Out: Vector, or
// ComplexVector of complex arguments.

#include <algorithm>
#include <cmath>

#include "python/binding/python_problem.hpp"

namespace arcslip::python {

/// One column of a derivative, by `z(k)`.
template <class Function, class Column>
void by_one(Step step, const Vector& z, Index k, double scale, Column column, const Function& function) {
  if (step == Step::complex) {
    constexpr double h = 1e-50;  // its square is lost beside any number
    ComplexVector at = z.cast<Complex>();
    at(k) += Complex(0, h);
    column = function(at, static_cast<ComplexVector*>(nullptr)).imag() / h;
    return;
  }
  const double size = std::max(std::abs(z(k)), scale);
  constexpr double h = 6e-6;  // the third root of rounding
  Vector ahead = z;
  Vector behind = z;
  ahead(k) += h * size;
  behind(k) -= h * size;
  column =
      (function(ahead, static_cast<Vector*>(nullptr)) - function(behind, static_cast<Vector*>(nullptr))) /
      (ahead(k) - behind(k));
}

template <class Function>
void by_each_unknown(Step step, const Vector& u, const Vector& scale, Matrix& out, const Function& function) {
  for (Index k = 0; k < u.size(); ++k) by_one(step, u, k, scale(k), out.col(k), function);
}

/// By the active ones; the others are not asked for.
template <class Function>
void by_each_parameter(Step step, const Vector& p, const PythonTraits& traits, Matrix& out,
                       const Function& function) {
  out.setZero();
  for (Index k = 0; k < p.size(); ++k) {
    const std::string& name = traits.parameters[static_cast<std::size_t>(k)];
    if (std::find(traits.active.begin(), traits.active.end(), name) == traits.active.end()) continue;
    by_one(step, p, k, traits.parameter_scale(k), out.col(k), function);
  }
}

/// Of a scalar function(u, p, Out*).
template <class Function>
void fill_gradient(Step step, const Vector& u, const Vector& p, const PythonTraits& traits,
                   continuation::Gradient& gradient, const Function& function) {
  Matrix row(1, u.size());
  by_each_unknown(step, u, traits.unknown_scale, row,
                  [&]<class Out>(const auto& at, Out* out) { return function(at, p, out); });
  gradient.unknowns = row.transpose();
  Matrix by_parameters(1, p.size());
  by_each_parameter(step, p, traits, by_parameters,
                    [&]<class Out>(const auto& at, Out* out) { return function(u, at, out); });
  gradient.parameters = by_parameters.transpose();
}

}  // namespace arcslip::python
