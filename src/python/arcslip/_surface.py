"""Surfaces of solutions over two parameters."""

import warnings

import numpy as np

from . import _core
from ._problem import Prepared
from ._trace import _is_number, _of_points


class Surface:
    """All solutions over two parameters that hang together with the starts, as triangles of charts.

    Attributes
    ----------
    parameters : (str, str)
        The names of both.
    parameter_names, unknown_names : list of str
    charts : numpy.ndarray of shape (charts, n)
        The unknowns of each.
    values : numpy.ndarray of shape (charts, number of parameters)
        The parameters of each.
    faces : numpy.ndarray of int, of shape (faces, 3)
        The charts at the corners of each triangle.
    radius, component, determinant, unstable : numpy.ndarray of shape (charts,)
        Of each chart; the sign of det dF/du, and how many eigenvalues have a positive real part, -1 where there are
        none.
    folds, fold_values : numpy.ndarray of shape (folds, n), and (folds, number of parameters)
        Unknowns and parameters of the points on edges at which dF/du is singular.
    fold_curve, fold_type : numpy.ndarray of shape (folds,)
        Number of the curve along which they follow each other; "fold", "cusp" or "branch_point", or where the curve
        turns in one parameter "isola_centre" (a closed branch over the other one shrinks to a point) or
        "simple_bifurcation" (two of these branches meet).
    fold_turns : numpy.ndarray of str, of shape (folds,)
        The parameter in which it turns there, else empty.
    ridges, ridge_values : numpy.ndarray of shape (ridge points, n), and (ridge points, number of parameters)
        Unknowns and parameters of the points on edges at which an observable is extremal over the first parameter.
    ridge_curve, ridge_observable, ridge_type : numpy.ndarray of shape (ridge points,)
        Number of the ridge, its observable; "peak", "trough", or "fold" where these meet, and as of folds.
    components : list of dict
        "charts", "faces", "euler" (Euler number) and "closed" of each.
    complete : bool
        Whether the surface is covered as far as the box goes.
    stop, reason : str
        Why the work ended, and why the surface is not complete.
    """

    def __init__(self, told, names, unknowns, parameters):
        self.parameters, self.parameter_names, self.unknown_names = parameters, names, unknowns
        self.charts, self.values, self.faces = told["unknowns"], told["parameters"], told["faces"]
        self.radius = told["radius"]
        self.component, self.determinant, self.unstable = (
            told[name].astype(int) for name in ("component", "determinant", "unstable")
        )
        self.folds, self.fold_values = told["fold_unknowns"], told["fold_parameters"]
        self.fold_curve, self.fold_type = told["fold_curve"].astype(int), np.array(told["fold_type"], dtype=str)
        turns = told["fold_turns"].astype(int)
        self.fold_turns = np.array(["", *parameters])[turns + 1]
        self.ridges, self.ridge_values = told["ridge_unknowns"], told["ridge_parameters"]
        self.ridge_curve = told["ridge_curve"].astype(int)
        self.ridge_type, self.ridge_observable = (
            np.array(told[name], dtype=str) for name in ("ridge_type", "ridge_observable")
        )
        self.components, self.stop, self.reason = told["components"], told["stop"], told["reason"]
        self.complete = self.stop == "reached_end"

    def __getitem__(self, name):
        """An unknown or a parameter of all charts, by name."""
        if name in self.parameter_names:
            return self.values[:, self.parameter_names.index(name)]
        if name in self.unknown_names:
            return self.charts[:, self.unknown_names.index(name)]
        raise KeyError(f"{name}: there are {', '.join([*self.parameter_names, *self.unknown_names])}")

    def __repr__(self):
        state = "complete" if self.complete else self.stop
        return f"<Surface of {len(self.charts)} charts over {self.parameters[0]} and {self.parameters[1]}, {state}>"


def surface(
    problem, u0=None, p0=None, parameters=None, ranges=None, *, max_radius=0.1, max_turn=0.2, max_charts=10000,
    max_seconds=float("inf"), extrema_of=(), **functions
):
    """All solutions of F(u, p) = 0 over two parameters, as a surface covered by charts.

    Parameters
    ----------
    problem, p0
        As `trace` takes them, with two parameters or more, by name.
    u0 : array of shape (n,), or a list of such
        Guesses at p0. Each begins a component, unless it lies on one that is covered already.
    parameters : (str, str)
        Those over which the surface lies; the first two if not given.
    ranges : ((float, float), (float, float))
        The box: first and last value of each. p0 lies within.
    max_radius : float
        Of a chart, in widths of the box, up to 0.5.
    max_turn : float
        Of the tangent plane over a chart's radius, in radians.
    max_charts : int
    max_seconds : float
        Wall clock, s.
    extrema_of : sequence of str
        Observables of which the ridges are told: where they are extremal over the first parameter.
    **functions
        Parts of a `Problem` beside f.

    Returns
    -------
    Surface
        Its `complete` says whether it is covered whole.

    Raises
    ------
    ValueError
        What is given is wrong.
    """
    problem = _of_points(problem, functions)
    u0, p0 = problem._begin(u0, p0, None if parameters is None else parameters[0], None)
    guesses = u0 if isinstance(u0, list) and u0 and not _is_number(u0[0]) else [u0]
    names = list(p0) if isinstance(p0, dict) else list(problem.parameters)
    first, second = parameters or names[:2]
    if ranges is None or np.shape(ranges) != (2, 2):
        raise ValueError(f"ranges: expected two numbers for each of two parameters, got {ranges!r}")
    prepared = Prepared(problem, guesses[0], p0, first, 0)
    options = {
        "max_radius": float(max_radius),
        "max_turn": float(max_turn),
        "max_charts": int(max_charts),
        "max_seconds": float(max_seconds),
        "extrema_of": list(extrema_of),
    }
    pairs = [(float(low), float(high)) for low, high in ranges]
    told = _core.cover(prepared.core, guesses, prepared.p0, [first, second], pairs, options)
    result = Surface(told, prepared.names, prepared.unknowns, (first, second))
    if not result.complete:
        warnings.warn(f"{result.stop}: {result.reason}", RuntimeWarning, stacklevel=2)
    return result
