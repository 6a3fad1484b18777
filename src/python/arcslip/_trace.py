"""Problems written in Python, traced."""

import warnings

import numpy as np

from . import _core
from ._branch import Branch
from ._problem import Prepared, Problem, driven

_LIMITS = {"max_points", "max_seconds", "interrupted"}
_INSTEAD = {"forced": "trace_cycles", "piecewise": "trace_cycles", "boundary": "trace_boundary"}


def trace(
    problem,
    u0=None,
    p0=None,
    parameter=None,
    range=(0.0, 1.0),
    *,
    regime=0,
    check=True,
    checkpoint=None,
    progress=None,
    stop_at=(),
    extrema_of=(),
    events=None,
    stop_after=None,
    tolerance=1e-10,
    max_step=0.1,
    min_step=1e-10,
    max_points=100000,
    max_seconds=float("inf"),
    bound=1e12,
    **functions,
):
    """Trace the branch of F(u, p) = 0 that lies next to a guess.

    Parameters
    ----------
    problem : callable or Problem
        f(u, p) -> array of shape (n,), or a `Problem`.
    u0 : array of shape (n,), or a number
        A guess of the unknowns at p0. Only a `Model` has one of its own.
    p0 : float, dict or array
        The parameters' values; functions get them in the same form. Of a `Model` those that are not its own.
    parameter : str
        The one to continue; needed where there are several and none is "lambda".
    range : (float, float)
        Its first and last value. The branch starts at p0: at one end of the range towards the other, inside both ways.
    regime : int or tuple
        Of a problem that is smooth in pieces, that in which u0 lies.
    check : bool
        Compare derivatives that are given with differences, at the start.
    checkpoint : str, optional
        Of a branch of this problem that was left; the branch has the points that follow.
    progress : callable, optional
        Called up to twenty times a second with four numbers: 0, 1, points so far, arclength.
    stop_at : sequence of float
        Values of the parameter that is continued, to put a point on.
    extrema_of : sequence of str
        Observables, or unknowns by name, whose extrema become peaks and troughs.
    events : dict, optional
        Functions (u, p) -> number by name, whose zeros along the branch become points of type "event".
    stop_after : dict, optional
        {"fold": 2} ends the branch at its second fold; names of types or of events.
    tolerance : float
        On the largest entry of F and on the correction that is left.
    max_step, min_step : float
        Of a step, in scaled arclength.
    max_points : int
    max_seconds : float
        Wall clock, s.
    bound : float
        The largest |unknown| before the branch is given up.
    **functions
        Parts of a `Problem` beside f: `jacobian`, `parameter_jacobian`, `observables`, `equilibrium`, ...

    Returns
    -------
    Branch
        With what was traced, also after Ctrl-C; its `stop` says why it ended.

    Raises
    ------
    ValueError
        f or what belongs to it gives a wrong shape, nan at the start, or a derivative that is not that of f.
    Exception
        Whatever the functions raise, with its traceback.
    """
    options = {
        "stop_at": stop_at,
        "extrema_of": extrema_of,
        "events": events or {},
        "stop_after": stop_after or {},
        "tolerance": tolerance,
        "max_step": max_step,
        "min_step": min_step,
        "max_points": max_points,
        "max_seconds": max_seconds,
        "bound": bound,
    }
    problem = _of_points(problem, functions)
    range = _ends(range)
    u0, p0 = problem._begin(u0, p0, parameter, range[0])
    prepared = Prepared(problem, u0, p0, parameter, regime, range)
    options["parameter"] = prepared.parameter
    how, options["range"] = _way(prepared, range)
    if checkpoint is not None:
        core = _core.trace_on(prepared.core, checkpoint, options, progress)
    else:
        (core,) = _traced(prepared, how, None, check, options, progress)
    return _told(Branch(core, derivatives=prepared.derivatives))


def trace_all(
    problem, u0=None, p0=None, parameter=None, range=(0.0, 1.0), *, follow="connected", box=None, regime=0,
    check=True, progress=None, functions=None, **options
):
    """Trace several branches of F(u, p) = 0.

    Parameters
    ----------
    problem, u0, p0, parameter, range, regime, check, progress
        As `trace` takes them.
    follow : {"connected", "deflation", "all"}
        The branch next to u0 and all that it meets, through branch points and corners; the branches through all
        solutions at p0 that deflation finds; or both, these and all that they meet. Within `range` branches begin both
        ways.
    box : (array, array), optional
        Lowest and highest unknowns, shape (n,): where deflation looks beside u0.
    functions : dict, optional
        Parts of a `Problem` beside f.
    **options
        Limits and what is looked for, as `trace` takes them, and `max_branches`, 50 if not given: how many are
        followed at most.

    Returns
    -------
    list of Branch
        In the order found.
    """
    if follow not in ("connected", "deflation", "all"):
        raise ValueError(f'follow: expected "connected", "deflation" or "all", got {follow!r}')
    problem = _of_points(problem, functions or {})
    range = _ends(range)
    u0, p0 = problem._begin(u0, p0, parameter, range[0])
    prepared = Prepared(problem, u0, p0, parameter, regime, range)
    options["parameter"] = prepared.parameter
    options["range"] = range
    if follow == "connected":
        how, options["range"] = _way(prepared, range)
        follow = "connected both" if how == "both" else "connected"
    cores = _traced(prepared, follow, box, check, options, progress)
    return [_told(Branch(core, i, prepared.derivatives)) for i, core in enumerate(cores)]


def trace_cycles(
    problem, u0=None, p0=None, parameter=None, range=(0.0, 1.0), *, settle=None, period=None, follow=True,
    discretisation="collocation", harmonics=8, intervals=20, degree=5, orbit_tolerance=1e-6, doublings=3,
    max_branches=50, progress=None, functions=None, **options
):
    """Trace cycles of u' = f(u, p), by collocation on meshes that follow them or by harmonic balance.

    Without `settle` those that leave the Hopf points of the branch of equilibria next to u0, each once. A Model of kind
    "forced", and a function f(t, u, p) with a `period`, has no equilibria: its cycles have the period of the load. A
    Model of kind "piecewise" has none either: its cycle is the one that the motion from its `start` comes to.

    Parameters
    ----------
    problem, u0, p0, parameter, range, progress, functions
        As `trace` takes them; f is the right-hand side of u' = f.
    settle : float, optional
        Begin with the cycle that the motion from u0 has come to after this time. Of what is forced fifty periods if it
        is not given, of pieces two hundred of them.
    period : str or number, optional
        Of a function f(t, u, p) its period in the time t, as a formula of the parameters: "2*pi/W".
    follow : bool
        Follow what is met at branch points and period doublings as well.
    discretisation : {"collocation", "balance"}
        By polynomials on intervals, or by harmonics.
    harmonics : int
        Of a balance to begin with, twice as many where `orbit_tolerance` asks for it.
    intervals, degree : int
        On how many intervals orbits are held to begin with, twice as many where `orbit_tolerance` asks for it, and by
        polynomials of which degree, 2 to 7.
    orbit_tolerance : float
        Of orbits between the ends of intervals, relative to how far unknowns go.
    doublings, max_branches : int
        How often a doubled period is followed, and how many branches.
    **options
        Limits and what is looked for, as `trace` takes them.

    Returns
    -------
    list of Branch
        With the columns "T", and "x_max", "x_min" of each unknown x; see `Branch.orbit`, `Branch.multipliers`.

    Warns
    -----
    RuntimeWarning
        The branch of equilibria ends before its range does, and cycles that leave Hopf points further on are missing; or
        of any branch what `trace` warns of.
    """
    is_driven = period is not None
    if is_driven:
        problem, p0 = driven(problem, p0, parameter, functions or {})
        functions = None
    elif not isinstance(problem, Problem):
        functions = {"equilibrium": True, **(functions or {})}
    problem = _problem(problem, functions or {})
    if settle is not None and not float(settle) > 0:
        raise ValueError(f"settle: expected a number > 0, got {settle!r}")
    if discretisation not in ("collocation", "balance"):
        raise ValueError(f'discretisation: expected "collocation" or "balance", got {discretisation!r}')
    if not 2 <= int(harmonics) <= 128:
        raise ValueError(f"harmonics: expected an integer >= 2 and <= 128, got {harmonics!r}")
    held = _held(intervals, degree, orbit_tolerance, doublings, max_branches)
    held |= {"balance": discretisation == "balance", "harmonics": int(harmonics)}
    if getattr(problem, "kind", "") == "piecewise":
        if u0 is not None:
            raise ValueError(f"u0: a motion through pieces begins at the start of its Model, got {u0!r}")
        if discretisation == "balance":
            raise ValueError('discretisation: only "collocation" for what is made of pieces, got "balance"')
        return _orbits(problem, p0, parameter, range, settle, follow, held, options, progress)
    range = _ends(range)
    u0, p0 = problem._begin(u0, p0, parameter, range[0])
    prepared = Prepared(problem, u0, p0, parameter or _first_but_time(p0, is_driven), 0, range)
    options["parameter"] = prepared.parameter
    how, options["range"] = _way(prepared, range)
    forced = getattr(problem, "kind", "") == "forced"
    if not (forced or is_driven or problem.equilibrium):
        raise ValueError("problem: expected one of a flow, with equilibrium=True or of kind \"flow\"")
    formulas = prepared.formulas if forced else None
    cores, doubt = _core.trace_cycles(
        prepared.core, formulas, prepared.u0, prepared.p0, settle, None if period is None else str(period), bool(follow),
        how, options, held, progress
    )
    if doubt:
        warnings.warn(f"the equilibria whose Hopf points cycles leave: {doubt}", RuntimeWarning, stacklevel=2)
    return [_told(Branch(core, i, prepared.derivatives)) for i, core in enumerate(cores)]


def trace_boundary(
    problem, p0=None, parameter=None, range=(0.0, 1.0), *, follow=False, intervals=20, degree=5, orbit_tolerance=1e-6,
    max_branches=50, progress=None, **options
):
    """Trace solutions of a boundary value problem, by collocation on meshes that follow them.

    Parameters
    ----------
    problem : Model
        Of kind "boundary".
    p0, parameter, range, progress
        As `trace` takes them.
    follow : bool
        Follow what is met at branch points as well.
    intervals, degree, orbit_tolerance, max_branches
        As `trace_cycles` takes them.
    **options
        Limits and what is looked for, as `trace` takes them.

    Returns
    -------
    list of Branch
        With the columns "u_max", "u_min", "u_left" and "u_right" of each unknown u, "norm", and the parameters that are
        free; see `Branch.orbit`.
    """
    if getattr(problem, "kind", "") != "boundary":
        raise ValueError(f'problem: expected a Model of kind "boundary", got {problem!r}')
    held = _held(intervals, degree, orbit_tolerance, 0, max_branches)
    return _orbits(problem, p0, parameter, range, None, follow, held, options, progress)


def _orbits(problem, p0, parameter, range, settle, follow, held, options, progress):
    """Branches of a Model that has orbits alone, without equilibria."""
    range = _ends(range)
    u0, p0 = problem._begin(None, p0, parameter, range[0])
    prepared = Prepared(problem, u0, p0, parameter, 0, range)
    options["parameter"] = prepared.parameter
    how, options["range"] = _way(prepared, range)
    cores = _core.trace_orbit(
        prepared.core, prepared.formulas, prepared.p0, settle, bool(follow), how, options, held, progress
    )
    return [_told(Branch(core, i, prepared.derivatives)) for i, core in enumerate(cores)]


def _held(intervals, degree, tolerance, doublings, max_branches):
    return {
        "intervals": int(intervals),
        "degree": int(degree),
        "tolerance": float(tolerance),
        "doublings": int(doublings),
        "max_branches": int(max_branches),
    }


def _first_but_time(p0, is_driven):
    return next(iter(p0)) if is_driven and len(p0) == 2 else None


class Solutions(list):
    """Solutions at fixed parameters, and what is known of their list.

    Attributes
    ----------
    complete : bool or None
        True where interval arithmetic has proven that the box holds no other, which takes formulas; False where there must
        be more; None where nothing is known.
    reason : str
        Why, or what the search tells by itself.
    """

    def __init__(self, found, complete, reason):
        super().__init__(found)
        self.complete = complete
        self.reason = reason

    def __repr__(self):
        return f"Solutions({super().__repr__()}, complete={self.complete!r}, reason={self.reason!r})"


def solve_all(problem, u0=None, p0=None, *, box=None, starts=100, regime=0, parameter=None, **functions):
    """All solutions at fixed parameters that deflated Newton iterations find.

    Parameters
    ----------
    problem, p0, regime, parameter
        As `trace` takes them; the last one only names a single number p0.
    u0 : array of shape (n,), or a list of such
        Guesses.
    box : (array, array), optional
        Lowest and highest unknowns, shape (n,), between which `starts` further guesses are taken.
    starts : int
        How many.
    **functions
        Parts of a `Problem` beside f.

    Returns
    -------
    Solutions
        A list of arrays of shape (n,), in the order found, with `complete` and `reason`.
    """
    problem = _of_points(problem, functions)
    u0, p0 = problem._begin(u0, p0, parameter, None)
    guesses = u0 if isinstance(u0, list) and u0 and not _is_number(u0[0]) else [u0]
    names = list(p0) if isinstance(p0, dict) else list(problem.parameters)
    prepared = Prepared(problem, guesses[0], p0, parameter or (names[0] if names else None), regime)
    lower, upper = _corners(box)
    formulas = getattr(problem, "_formulas", None)
    found, complete, reason = _core.solve_all(
        prepared.core, formulas, guesses, prepared.p0, regime, lower, upper, starts
    )
    return Solutions(found, complete, reason)


def _is_number(value):
    return isinstance(value, (int, float))


def _of_points(problem, functions):
    """One whose solutions are points: not a Model that has orbits alone."""
    problem = _problem(problem, functions)
    kind = getattr(problem, "kind", "")
    if kind in _INSTEAD:
        raise ValueError(f'problem: a Model of kind "{kind}" has no equilibria; it is for arcslip.{_INSTEAD[kind]}')
    return problem


def _problem(problem, functions):
    if isinstance(problem, Problem):
        if functions:
            raise TypeError(f"'{next(iter(functions))}': a Problem has its own, or the option is unknown")
        return problem
    if not callable(problem):
        raise TypeError(f"problem: expected a function f(u, p) or a Problem, got {problem!r}")
    return Problem(problem, **functions)


def _pair(name, given, what):
    try:
        first, last = given
    except (TypeError, ValueError):
        raise ValueError(f"{name}: expected {what}, got {given!r}") from None
    return first, last


def _ends(given):
    """Of a range, as numbers."""
    first, last = _pair("range", given, "its first and last value")
    try:
        return float(first), float(last)
    except (TypeError, ValueError):
        raise ValueError(f"range: expected two numbers, got {given!r}") from None


def _corners(box):
    """The lowest and the highest unknowns, or None twice."""
    if box is None:
        return None, None
    lower, upper = (np.atleast_1d(corner) for corner in _pair("box", box, "lowest and highest unknowns"))
    if not (lower.size and upper.size):
        raise ValueError(f"box: expected lowest and highest unknowns, got {box!r}")
    return lower, upper


def _way(prepared, given):
    first, last = given
    value = prepared.p0[prepared.names.index(prepared.parameter)]
    if value == first:
        return "one", (first, last)
    if value == last:
        return "one", (last, first)
    if min(first, last) < value < max(first, last):
        return "both", (first, last)
    raise ValueError(f"p0: {prepared.parameter} = {value:g}; expected a value from {first:g} to {last:g}, as range says")


def _traced(prepared, how, box, check, options, progress):
    lower, upper = _corners(box)
    return _core.trace(
        prepared.core, prepared.u0, prepared.p0, prepared.regime, how, lower, upper, check, options, progress
    )


def _told(branch):
    if branch.stop == "interrupted":
        warnings.warn("interrupted: what was traced is returned", RuntimeWarning, stacklevel=3)
    elif branch.warning or not (branch.complete or branch.stop in _LIMITS):
        told = branch._core.why_not_whole or f"{branch.stop}: {branch.explanation}"
        warnings.warn(told, RuntimeWarning, stacklevel=3)
    return branch
