"""Problems written in Python, made ready for the engine."""

import warnings

import numpy as np

from . import _core

_MOST_NAMED = 20  # unknowns that are columns without having been named
_OF_RESULTS = {"point", "type", "label", "regime", "unstable", "arclength", "iterations", "residual"}


class Problem:
    """F(u, p) = 0 with n unknowns u and named parameters p, given as functions or as a subclass.

    Functions get copies of u, shape (n,), and of p in the form in which `p0` is given: a number, a dict by name, or
    an array; of a problem that is smooth in pieces the regime as well. Where F has no value they return nan, which
    shortens the step. What is None is left out. Of a subclass the same names are methods and attributes.

    Parameters
    ----------
    residual : callable
        f(u, p) -> array of shape (n,), scaled such that 1 is large.
    jacobian : callable, optional
        dF/du, shape (n, n). Without it: complex steps, which are exact, if f takes complex numbers, else central
        differences, which have no value within 6e-6 of where f has none, relative to what is changed.
    parameter_jacobian : callable, optional
        dF/dp, shape (n, number of parameters), or (n,) of one. Without it likewise.
    observables : callable or dict, optional
        (u, p) -> dict of numbers by name, or a dict of functions (u, p) -> number: further columns.
    eigenvalues : callable, optional
        (u, p) -> complex numbers that tell stability, by the signs of their real parts.
    sparse : bool
        Whether `jacobian` returns a sparse matrix, as scipy's, or (data, indices, indptr) of compressed columns, always
        with the same pattern. With more than 200 unknowns the 20 eigenvalues nearest to 0 tell stability.
    equilibrium : bool
        Whether F is the right-hand side of u' = F, so that the Jacobian's eigenvalues tell stability.
    unknowns : sequence of str
        Names of the unknowns, which are columns then; u0, u1, ... of up to twenty if not given.
    parameters : sequence of str
        Names of the parameters where `p0` is an array.
    borders : callable, optional
        (u, p, regime) -> numbers, negative inside the regime, which ends where one of them is 0. All functions take
        the regime then: the state of the switch from 0 to 15, or a tuple of those of several.
    beyond : callable, optional
        (regime, border) -> the regime across it; None where a branch ends on it.
    switches : int
        How many, if there are borders.
    unknown_scale, parameter_scale : float or array
        Typical magnitudes, > 0: steps and errors are measured in the value itself, or in these where they are larger.
        1 if not given; of a parameter that is continued below 0.01 its largest value.
    """

    parameters = ()
    unknowns = ()
    equilibrium = False
    sparse = False
    switches = 1
    unknown_scale = 1.0
    parameter_scale = None
    jacobian = None
    parameter_jacobian = None
    observables = None
    eigenvalues = None
    borders = None
    beyond = None
    _active = ()  # parameters by which derivatives are taken beside the one that is continued

    def __init__(self, residual=None, **given):
        if residual is not None:
            self.residual = residual
        for name, value in given.items():
            if name.startswith("_") or not hasattr(Problem, name):
                raise TypeError(f"'{name}' is no part of a Problem")
            setattr(self, name, value)

    def residual(self, u, p):
        """F(u, p), shape (n,)."""
        raise NotImplementedError("residual: a Problem needs it, as a function or a method")

    def _begin(self, u0, p0, parameter, first):
        """Guess and parameters of the start, where they are given; a Model has its own."""
        for name, given in (("u0", u0), ("p0", p0)):
            if given is None:
                raise TypeError(f"{name}: missing; only a Model has a start of its own")
        return u0, p0


class Prepared:
    """A problem at its start: what the engine traces, and the start as it takes it."""

    def __init__(self, problem, u0, p0, parameter, regime, range=None):
        self.problem = problem
        self.u0 = _unknowns(u0)
        self.form, self.names, self.p0, self.parameter = _parameters(problem, p0, parameter)
        self.active = [self.parameter, *problem._active]
        self.regime = regime
        self.formulas = getattr(problem, "_formulas", None)
        self.range = range
        if self.formulas is not None and range is not None:
            first, last = range
            self.formulas = self.formulas.within(self.parameter, first, last)
        self._check_start()
        self._prepare_observables()
        self.derivatives = {
            "jacobian": self._source(problem.jacobian, lambda z: self._residual(z, self.p0), self.u0),
            "parameter_jacobian": self._source(
                problem.parameter_jacobian, self._residual_of_parameter, self._active_values()
            ),
        }
        self.core = _core.Problem(
            {
                "residual": problem.residual,
                "jacobian": problem.jacobian,
                "parameter_jacobian": problem.parameter_jacobian,
                "observables": self.observables,
                "eigenvalues": problem.eigenvalues,
                "borders": problem.borders,
                "beyond": problem.beyond,
            },
            self._traits(),
            self.u0,
            self.p0,
        )

    def _traits(self):
        problem = self.problem
        if problem.sparse and problem.jacobian is None:
            raise ValueError("jacobian: missing; a sparse problem needs it")
        if problem.borders is not None and problem.beyond is None:
            raise ValueError("beyond: missing; a problem with borders needs it")
        return {
            "size": len(self.u0),
            "parameters": self.names,
            "form": self.form,
            "unknowns": self.unknowns,
            "observables": self.observed,
            "active": self.active,
            "sparse": bool(problem.sparse),
            "equilibrium": bool(problem.equilibrium),
            "switches": int(problem.switches) if problem.borders is not None else 0,
            "unknown_scale": _scale(problem.unknown_scale, len(self.u0), "unknown_scale"),
            "parameter_scale": self._parameter_scale(),
            "scales_by_ranges": problem.parameter_scale is None,
            "jacobian": self.derivatives["jacobian"],
            "parameter_jacobian": self.derivatives["parameter_jacobian"],
            "of_observables": self._source_of_both(self._observe) if self.observed else "central differences",
            "of_borders": "central differences" if problem.borders is None else self._source_of_both(self._borders),
            "formulas": self.formulas,
        }

    def _parameter_scale(self):
        given = self.problem.parameter_scale
        scale = _scale(1.0 if given is None else given, len(self.names), "parameter_scale")
        if given is None and self.range is not None:
            first, last = self.range
            scale[self.names.index(self.parameter)] = _core.magnitude_within(first, last)
        return scale

    def _in_form(self, p):
        if self.form == "number":
            return p[0].item()
        if self.form == "array":
            return np.array(p)
        return {name: value.item() for name, value in zip(self.names, p)}

    def _call(self, function, u, p):
        arguments = (np.array(u), self._in_form(p))
        return function(*arguments) if self.problem.borders is None else function(*arguments, self.regime)

    def _residual(self, u, p):
        return np.atleast_1d(self._call(self.problem.residual, u, p))

    def _residual_of_parameter(self, value):
        return self._residual(self.u0, self._with(value))

    def _active_values(self):
        return self.p0[[self.names.index(name) for name in self.active]]

    def _with(self, values):
        p = self.p0.astype(np.result_type(values))
        for name, value in zip(self.active, values):
            p[self.names.index(name)] = value
        return p

    def _observe(self, u, p):
        observed = self._call(self.observables, u, p)
        return np.array([observed[name] for name in self.observed])

    def _borders(self, u, p):
        return np.atleast_1d(self._call(self.problem.borders, u, p))

    def _check_start(self):
        values = np.asarray(self._call(self.problem.residual, self.u0, self.p0))
        n = len(self.u0)
        if values.shape != (n,) and not (n == 1 and values.shape == ()):
            raise ValueError(f"f: expected an array of shape ({n},), as u0 has it, got shape {values.shape}")
        if values.dtype.kind not in "fiub":
            raise ValueError(f"f: expected real numbers, got {values.dtype}")
        wrong = np.flatnonzero(~np.isfinite(np.atleast_1d(values)))
        if len(wrong):
            at = ", ".join(f"{name} = {value:g}" for name, value in zip(self.names, self.p0))
            raise ValueError(f"f: entry {wrong[0]} is {np.atleast_1d(values)[wrong[0]]} at the start, u0 and {at}")

    def _prepare_observables(self):
        problem, n = self.problem, len(self.u0)
        self.unknowns = [str(name) for name in problem.unknowns]
        if len(self.unknowns) > n:
            raise ValueError(f"unknowns: {len(self.unknowns)} names of {n} unknowns")
        if not self.unknowns and n <= _MOST_NAMED:
            self.unknowns = [f"u{i}" for i in range(n)]
        self.observables = problem.observables
        if isinstance(self.observables, dict):
            functions = dict(self.observables)
            self.observables = lambda *arguments: {name: f(*arguments) for name, f in functions.items()}
        if self.observables is None and not self.unknowns:
            self.observables = lambda u, *_: {"norm": np.sqrt(u @ u / len(u))}
        self.observed = [] if self.observables is None else self._names_observed()
        all_names = [*self.names, *self.unknowns, *self.observed]
        own = [name for name in all_names if name in _OF_RESULTS]
        if own:
            raise ValueError(f"'{own[0]}': results have a column of this name; expected another name")
        twice = {name for name in all_names if all_names.count(name) > 1}
        if twice:
            raise ValueError(f"'{sorted(twice)[0]}': two columns have this name")

    def _names_observed(self):
        observed = self._call(self.observables, self.u0, self.p0)
        if not isinstance(observed, dict) or not all(isinstance(name, str) for name in observed):
            raise ValueError(f"observables: expected a dict of numbers by name, got {observed!r}")
        return list(observed)

    def _source(self, given, function, z):
        if given is not None:
            return "given"
        return "complex step" if _takes_complex(function, z) else "central differences"

    def _source_of_both(self, function):
        both = _takes_complex(lambda z: function(z, self.p0), self.u0) and _takes_complex(
            lambda values: function(self.u0, self._with(values)), self._active_values(), or_real=True
        )
        return "complex step" if both else "central differences"


def driven(function, p0, parameter, functions):
    """A field f(t, u, p) as a Problem with the time for its last parameter, and its p0."""
    if not callable(function) or isinstance(function, Problem):
        raise TypeError(f"period: only of a function f(t, u, p), as a Model has its own; got {function!r}")
    if "parameter_jacobian" in functions:
        raise TypeError("parameter_jacobian: not of a function of time, whose derivatives by time would be missing")
    form, names, values, _ = _parameters(Problem(**{"parameters": functions.get("parameters", ())}), p0, parameter)
    if "t" in names:
        raise ValueError("p0: t is the time; expected another name")

    def of_time(given):
        def called(u, p):
            own = {name: p[name] for name in names}
            numbers = list(own.values())
            return given(p["t"], u, own if form == "dict" else numbers[0] if form == "number" else np.array(numbers))

        return called

    parts = {name: of_time(part) if name == "jacobian" else part for name, part in functions.items()}
    problem = Problem(of_time(function), **parts)
    problem._active = ("t",)
    ordinary = 0.3  # where derivatives are tried out: at 0 those of loads may vanish
    return problem, {**dict(zip(names, values.tolist())), "t": ordinary}


def _takes_complex(function, z, or_real=False):
    """Whether complex steps give the derivative that differences have."""
    direction = np.cos(1.0 + np.arange(len(z))) * np.maximum(np.abs(z), 1.0)
    tiny, h = 1e-50, 6e-6
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            values = np.asarray(function(z + 1j * tiny * direction))
        if values.dtype.kind != "c":
            return or_real
        difference = (function(z + h * direction) - function(z - h * direction)) / (2 * h)
        size = max(np.max(np.abs(difference)), 1e-300)
        return bool(np.max(np.abs(values.imag / tiny - difference)) <= 1e-4 * size)
    except Exception:
        return False


def _unknowns(u0):
    try:
        u0 = np.atleast_1d(np.array(u0, dtype=float))
    except (TypeError, ValueError) as error:
        raise ValueError(f"u0: expected numbers, got {u0!r}") from error
    if u0.ndim != 1 or len(u0) == 0:
        raise ValueError(f"u0: expected one row of numbers, got an array of shape {u0.shape}")
    if not np.isfinite(u0).all():
        raise ValueError(f"u0: entry {np.flatnonzero(~np.isfinite(u0))[0]} is not finite")
    return u0


def _parameters(problem, p0, parameter):
    """Form, names and values, and the parameter that is continued."""
    named = [str(name) for name in problem.parameters]
    if isinstance(p0, dict):
        form, names, values = "dict", [str(name) for name in p0], list(p0.values())
    elif np.ndim(p0) == 0:
        form, values = "number", [p0]
        names = named or [parameter or "lambda"]
    else:
        form, names, values = "array", named, list(p0)
    if len(names) != len(values) or not names:
        raise ValueError(f"p0: {len(values)} numbers of {len(names)} parameters ({', '.join(names) or 'none named'})")
    try:
        values = np.array(values, dtype=float)
    except (TypeError, ValueError) as error:
        raise ValueError(f"p0: expected numbers, got {p0!r}") from error
    if not np.isfinite(values).all():
        raise ValueError(f"p0: {names[np.flatnonzero(~np.isfinite(values))[0]]} is not finite")
    if parameter is None and len(names) == 1:
        parameter = names[0]
    if parameter is None and "lambda" in names:
        parameter = "lambda"
    if parameter not in names:
        raise ValueError(f"parameter: expected one of {', '.join(names)}, got {parameter!r}")
    return form, names, values, parameter


def _scale(given, n, name):
    scale = np.broadcast_to(np.asarray(given, dtype=float), (n,)).copy()
    if not (np.isfinite(scale) & (scale > 0)).all():
        raise ValueError(f"{name}: expected numbers > 0, got {given!r}")
    return scale
