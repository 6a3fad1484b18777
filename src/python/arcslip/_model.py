"""Systems of one's own, given by formulas."""

import numpy as np

from . import _core
from ._problem import Problem

_KINDS = ("flow", "forced", "map", "algebraic", "boundary", "piecewise")


class Model(Problem):
    """u' = f(u, p), u' = f(t, u, p), u -> f(u, p), f(u, p) = 0, a boundary value problem or a flow made of pieces, with
    f as formulas, like `[model]` of case files.

    It stands where a `Problem` may. Derivatives, the second ones too, are exact, and nothing is called in Python while
    a branch is traced. `trace` needs neither u0 nor p0 then: a branch begins at the first value of its range, with the
    other parameters as they are given here and the unknowns of `start`.

    Parameters
    ----------
    equations : dict
        f as a formula for each unknown, by its name: {"x": "mu*x - x^3"}.
    parameters : dict
        A number for each name.
    start : dict, optional
        A guess of unknowns, as numbers or formulas of the parameters; 0 of those that are left out.
    scale : dict, optional
        Typical magnitudes of unknowns and parameters that are far below 1, by their names. A parameter that is continued
        below 0.01 has its largest value if it is not given.
    definitions : dict, optional
        Formulas by names that equations and observables may use, in any order.
    observables : dict, optional
        Formulas by names: further columns.
    kind : {"flow", "forced", "map", "algebraic", "boundary", "piecewise"}
        A flow has equilibria, Hopf points and cycles, one that is forced or made of pieces cycles alone, a map fixed
        points and period doublings. A boundary value problem is for `trace_boundary`.
    period : str or number, optional
        Of what is forced, and of pieces with the time t in them: the period of f in t, as a formula of the parameters.
    angles : sequence of str
        Unknowns of which whole turns, 2 pi, do not matter: cycles of a flow may go round.
    iterate : int
        Of a map: the points that are fixed after so many steps, at most 100.
    interval : dict, optional
        Of a boundary value problem what f may depend on, with both its ends, numbers or formulas of the parameters:
        {"x": (0, 1)}. `start` may depend on it as well.
    conditions, integrals : sequence of str
        Formulas that vanish: of the parameters and of `u_left` and `u_right` of each unknown u; and those whose
        integral over the interval vanishes. As many as there are unknowns and free parameters.
    free : sequence of str
        Parameters that these conditions set, from guesses in `parameters`.
    pieces : dict, optional
        Of kind "piecewise" a dict for each piece by its name, in the order in which they follow each other: `until`, a
        formula that vanishes where it ends, and as it needs them `equations` that differ there and `reset`, where
        unknowns jump to at its end.
    cycle : sequence of str
        The pieces as they follow each other in one period, where this is not each once.

    Attributes
    ----------
    values : dict
        The numbers of `parameters`, by name.

    Raises
    ------
    ValueError
        A formula cannot be read: which one, where, and what was expected.
    """

    def __init__(self, equations, parameters, start=None, definitions=None, observables=None, *, kind="flow", iterate=1, period=None, angles=(), interval=None, conditions=(), integrals=(), free=(), pieces=None, cycle=(), scale=None):
        if kind not in _KINDS:
            raise ValueError(f"kind: expected one of {', '.join(_KINDS)}, got {kind!r}")
        if iterate != int(iterate) or not 1 <= iterate <= 100 or (iterate > 1 and kind != "map"):
            raise ValueError(f"iterate: expected an integer from 1 to 100, and more than 1 only of maps, got {iterate!r}")
        if kind != "piecewise" and (period is None) == (kind == "forced"):
            raise ValueError(f'period: expected a formula or a number of kind "forced", one or none of "piecewise", and of no other, got {period!r}')
        if not equations:
            raise ValueError("equations: expected a formula for each unknown, got none")
        wrong = [name for name in angles if name not in equations]
        if wrong:
            raise ValueError(f"angles: there is no '{wrong[0]}' among {', '.join(equations)}")
        self.values = {str(name): _number(f"parameters.{name}", value) for name, value in parameters.items()}
        scale = {str(name): _number(f"scale.{name}", value) for name, value in (scale or {}).items()}
        wrong = [name for name, value in scale.items() if value <= 0]
        if wrong:
            raise ValueError(f"scale.{wrong[0]}: expected a number > 0, got {scale[wrong[0]]!r}")
        self._formulas = _core.Formulas(
            kind,
            int(iterate),
            list(self.values.items()),
            list(scale.items()),
            _texts("definitions", definitions),
            _texts("equations", equations),
            _texts("observables", observables),
            _texts("start", start),
            None if period is None else _texts("model", {"period": period})[0][1],
            list(angles),
            _conditions(kind, self.values, interval, conditions, integrals, free),
            _pieces(kind, pieces, cycle),
        )
        self.kind = kind
        self.iterate = int(iterate)
        self.parameters = tuple(self.values)
        self.unknowns = tuple(str(name) for name in equations)
        self.unknown_scale = [scale.get(name, 1.0) for name in self.unknowns]
        self.parameter_scale = [scale.get(name, 1.0) for name in self.parameters]
        self.equilibrium = kind == "flow"
        self._observed = [str(name) for name in observables or {}]
        if not self._observed:
            self.observables = None

    def __repr__(self):
        return f"<arcslip.Model, {self.kind} of {', '.join(self.unknowns)}>"

    def residual(self, u, p):
        """f(u, p), of maps f(u, p) - u, shape (n,)."""
        return self._formulas.residual(u, self._in_order(p))

    def jacobian(self, u, p):
        """Its derivatives by the unknowns, shape (n, n)."""
        return self._formulas.jacobian(u, self._in_order(p))

    def parameter_jacobian(self, u, p):
        """Its derivatives by the parameters, shape (n, number of parameters)."""
        return self._formulas.parameter_jacobian(u, self._in_order(p))

    def observables(self, u, p):
        """The further columns by name."""
        return dict(zip(self._observed, self._formulas.observed(u, self._in_order(p)).tolist()))

    def _in_order(self, p):
        return [p[name] for name in self.values] if isinstance(p, dict) else np.atleast_1d(p)

    def _begin(self, u0, p0, parameter, first):
        given = dict(p0) if isinstance(p0, dict) else {} if p0 is None else dict(zip(self.values, np.atleast_1d(p0)))
        unknown = [name for name in given if name not in self.values]
        if unknown:
            raise ValueError(f"p0: there is no '{unknown[0]}' among {', '.join(self.values)}")
        if parameter is None and len(self.values) == 1:
            parameter = next(iter(self.values))
        p = {**self.values, **given}
        if first is not None and parameter in p and parameter not in given:
            p[parameter] = float(first)
        return (self._formulas.start([float(value) for value in p.values()]) if u0 is None else u0), p


def _conditions(kind, parameters, interval, conditions, integrals, free):
    """What conditions are on, and they; None of kinds that have none."""
    given = {"interval": interval, "conditions": conditions, "integrals": integrals, "free": free}
    if kind != "boundary":
        for name, value in given.items():
            if value:
                raise ValueError(f'{name}: only of kind "boundary", got {value!r}')
        return None
    if not isinstance(interval, dict) or len(interval) != 1 or len(next(iter(interval.values()))) != 2:
        raise ValueError(f'interval: expected one name with both its ends, as {{"x": (0, 1)}}, got {interval!r}')
    ((variable, ends),) = interval.items()
    for i, name in enumerate(free):
        if name not in parameters or name in free[:i]:
            raise ValueError(f"free[{i}]: expected each parameter once, of {', '.join(parameters)}, got {name!r}")
    texts = [[text for _, text in _texts(name, dict(enumerate(given[name])))] for name in ("conditions", "integrals")]
    ends = [text for _, text in _texts(f"interval.{variable}", dict(enumerate(ends)))]
    return ((str(variable), *ends), *texts, list(free))


def _pieces(kind, pieces, cycle):
    """How they follow each other; None of kinds that have none."""
    if kind != "piecewise":
        for name, value in {"pieces": pieces, "cycle": cycle}.items():
            if value:
                raise ValueError(f'{name}: only of kind "piecewise", got {value!r}')
        return None
    if not pieces or not isinstance(pieces, dict):
        raise ValueError(f"pieces: expected a dict for each piece, by its name, got {pieces!r}")
    made = []
    for name, piece in pieces.items():
        unknown = [key for key in piece if key not in ("equations", "until", "reset")]
        if unknown or "until" not in piece:
            raise ValueError(f"pieces.{name}: expected until, and equations and reset where they are needed, got {', '.join(piece)}")
        texts = [_texts(f"pieces.{name}.{key}", piece.get(key)) for key in ("equations", "reset")]
        made.append((str(name), texts[0], _texts(f"pieces.{name}", {"until": piece["until"]})[0][1], texts[1]))
    wrong = [name for name in cycle if name not in pieces]
    if wrong:
        raise ValueError(f"cycle: there is no '{wrong[0]}' among {', '.join(pieces)}")
    return made, list(cycle)


def _number(name, value):
    try:
        number = float(value)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{name}: expected a number, got {value!r}") from error
    if not np.isfinite(number):
        raise ValueError(f"{name}: expected a finite number, got {value!r}")
    return number


def _texts(name, given):
    texts = []
    for key, value in (given or {}).items():
        if not isinstance(value, (str, int, float, np.integer, np.floating)) or isinstance(value, bool):
            raise ValueError(f"{name}.{key}: expected a formula as a string, or a number, got {value!r}")
        texts.append((str(key), value if isinstance(value, str) else repr(float(value))))
    return texts
