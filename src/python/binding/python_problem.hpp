#pragma once

// A problem whose functions are written in Python. They are called with copies of u and p, with the
// interpreter's lock, from whichever thread the engine runs in. What they raise never passes through the
// engine: the problem has no value from then on, and it is raised again where the work was asked for.

#include <pybind11/pybind11.h>

#include <map>
#include <string>
#include <vector>

#include "arcslip/continuation/problem/problem.hpp"
#include "python/binding/interruption.hpp"

namespace arcslip::python {

/// How a derivative comes about that the user has not given.
enum class Step {
  none,     ///< it is given
  complex,  ///< Im f(u + ih)/h, exact to rounding
  central   ///< (f(u + h) - f(u - h))/2h, known to about ten digits
};

/// The functions take (u, p), and of a problem with switches (u, p, regime).
struct PythonFunctions {
  py::object residual;            ///< F, (n,)
  py::object jacobian;            ///< dF/du, (n, n), or None
  py::object parameter_jacobian;  ///< dF/dp, (n, number of parameters), or None
  py::object observables;         ///< a dict of numbers, or None
  py::object eigenvalues;         ///< complex numbers, or None
  py::object borders;             ///< one number for each border of the regime, or None
  py::object beyond;              ///< of (regime, border): the regime there, or None where there is none
};

/// What is said of it beside its functions.
struct PythonTraits {
  Index size = 0;
  std::vector<std::string> parameters;
  std::string form = "dict";             ///< how functions get p: "dict", "number" or "array"
  std::vector<std::string> unknowns;     ///< names of the first unknowns, which are observables then
  std::vector<std::string> observables;  ///< names of those that the function gives
  std::vector<std::string> active;       ///< parameters by which derivatives are taken that are not given
  bool sparse = false;                   ///< whether the Jacobian is, which is given then
  bool is_equilibrium = false;           ///< whether F is the right-hand side of u' = F
  Index switches = 0;
  Vector unknown_scale;           ///< n, typical magnitudes, > 0
  Vector parameter_scale;         ///< of the parameters
  bool scales_by_ranges = false;  ///< whether these are of the ranges that parameters are continued over
  Step by_unknowns = Step::none;
  Step by_parameters = Step::none;
  Step of_observables = Step::central;
  Step of_borders = Step::central;
  std::shared_ptr<const continuation::Problem> formulas = {};  ///< what the functions stand for, if they do
};

class PythonProblem : public continuation::Problem {
 public:
  /// `u` and `p` are those of the start.
  PythonProblem(PythonFunctions functions, PythonTraits traits, Vector u, Vector p)
      : functions_(std::move(functions)),
        traits_(std::move(traits)),
        last_u_(std::move(u)),
        last_p_(std::move(p)) {}

  /// Who is told of what functions raise in this thread, while it lives.
  class Listener {
   public:
    explicit Listener(Interruption& interruption) : before_(listener_) { listener_ = &interruption; }
    ~Listener() { listener_ = before_; }
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;
    Listener(Listener&&) = delete;
    Listener& operator=(Listener&&) = delete;

   private:
    Interruption* before_;
  };

  const PythonTraits& traits() const { return traits_; }
  /// From now on derivatives by this parameter are taken as well.
  void activate(const std::string& parameter);
  /// And it is measured against how far it is continued, where no scale is given.
  void scale_within(const std::string& parameter, double from, double to);

  /// Of a user's function of (u, p), or (u, p, regime): its value. For events.
  double call_for_number(const py::object& function, const std::string& what, const Vector& u,
                         const Vector& p, const continuation::Regime& regime) const;

  /// A regime as functions get it and give it: a number, or of several switches a tuple.
  py::object to_python(const continuation::Regime& regime) const;
  continuation::Regime to_regime(const py::handle& given) const;

  Index size() const override { return traits_.size; }
  std::vector<std::string> parameter_names() const override { return traits_.parameters; }
  [[nodiscard]] bool evaluate(const Vector& u, const Vector& p, const continuation::Regime& regime,
                              const continuation::Evaluation& out) const override;
  bool sparse() const override { return traits_.sparse; }
  bool is_equilibrium() const override { return traits_.is_equilibrium; }
  [[nodiscard]] bool eigenvalues(const Vector& u, const Vector& p, const continuation::Regime& regime,
                                 ComplexVector& values) const override;
  void scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const override;
  Index switch_count() const override { return traits_.switches; }
  int border_count(const continuation::Regime& regime) const override;
  double border(const Vector& u, const Vector& p, const continuation::Regime& regime, int border,
                continuation::Gradient* gradient) const override;
  std::optional<continuation::Regime> regime_beyond(const continuation::Regime& regime,
                                                    int border) const override;
  std::vector<continuation::Observable> observables() const override;
  void observe(const Vector& u, const Vector& p, const continuation::Regime& regime,
               Vector& values) const override;
  double observe(const Vector& u, const Vector& p, const continuation::Regime& regime, Index which,
                 continuation::Gradient& gradient) const override;
  std::optional<std::string> wrong_derivative(const Vector& u, const Vector& p,
                                              const continuation::Regime& regime, Index parameter,
                                              const std::vector<Index>& tracked) const override;

 private:
  template <class Work>
  bool guarded(const Work& work) const;
  py::object parameters_as(const Vector& p) const;
  py::object parameters_as(const ComplexVector& p) const;
  template <class U, class P>
  py::object call(const py::object& function, const U& u, const P& p,
                  const continuation::Regime& regime) const;
  template <class Out, class U, class P>
  Out residual_at(const U& u, const P& p, const continuation::Regime& regime) const;
  template <class Out, class U, class P>
  Out observed_at(const U& u, const P& p, const continuation::Regime& regime) const;
  template <class Out, class U, class P>
  Out borders_at(const U& u, const P& p, const continuation::Regime& regime) const;
  void fill(const Vector& u, const Vector& p, const continuation::Regime& regime,
            const continuation::Evaluation& out) const;
  void fill_jacobian(const Vector& u, const Vector& p, const continuation::Regime& regime, Matrix& out) const;
  void require_numbers(const Vector& p, const continuation::Evaluation& out, bool& has_value) const;
  void fill_parameter_jacobian(const Vector& u, const Vector& p, const continuation::Regime& regime,
                               Matrix& out) const;
  std::string place(const Vector& p) const;

  PythonFunctions functions_;
  PythonTraits traits_;
  static thread_local Interruption* listener_;
  // Where F was last evaluated, so that the borders of a regime can be counted; used with the lock held.
  mutable std::map<continuation::Regime, int> border_counts_;
  mutable ComplexVector last_eigenvalues_;
  mutable Vector last_u_;
  mutable Vector last_p_;
};

/// What the engine traces: where the functions stand for formulas the problem of these itself, which has more
/// than functions can say.
inline std::shared_ptr<const continuation::Problem> traced_problem(
    const std::shared_ptr<const PythonProblem>& problem) {
  return problem->traits().formulas != nullptr ? problem->traits().formulas : problem;
}

}  // namespace arcslip::python
