"""Branches as numpy arrays."""

import json
import operator
import os

import numpy as np

from . import _core


class _Columns:
    """Columns by name."""

    def __getitem__(self, name):
        try:
            return self._column(name)
        except KeyError:
            raise KeyError(f"'{name}': expected one of {', '.join(self.columns)}") from None

    def __contains__(self, name):
        return name in self.columns

    def __iter__(self):
        return iter(self.columns)

    def keys(self):
        """The names of the columns."""
        return list(self.columns)


class Branch(_Columns):
    """A traced branch, or a curve of special points in two parameters.

    `branch[name]` is a column of branches.csv, an array with one entry for each point, in the case's units: "eta",
    "P", "Y", "R_over_S", ..., "arclength", "iterations", "residual", "unstable" (-1 where stability is not told),
    "type" and "regime"; of a system in SI units also "frequency_Hz" and so on. Of a problem written in Python: its
    parameters, its unknowns and its observables. The arrays of numbers are views of what the engine holds, which
    they keep alive; they cannot be written to.

    Attributes
    ----------
    parameter : str
        The one that is continued.
    values : dict
        What `for_each` of the case sets on it.
    stop : str
        Why it ended: "reached_end", "closed_loop", "own_image", "left_range", "max_points", "interrupted", "no_start", ...
    explanation : str
        The same as a sentence. Of a part before the start `summary` has both, as "first_stop" and "first_explanation".
    warning : str
        What makes its special points doubtful, or "".
    complete : bool
        Whether it was traced to its end; of a branch that begins within its range, at either side of the start. A border
        that nothing lies beyond is an end as well.
    seconds : float
        What it took, s; of branches that were traced together the mean.
    derivatives : dict
        Of a problem written in Python: where "jacobian" and "parameter_jacobian" come from, "given", "complex step"
        or "central differences".
    verification : dict of numpy.ndarray or None
        With `run(..., verify=True)`: the points that were solved anew, the columns of verify.csv.
    """

    def __init__(self, core, number=0, derivatives=None, verification=None):
        self._core = core
        self._number = number
        self._made = {}
        self._names = None
        self.parameter = core.parameter
        self.values = json.loads(core.values)
        self.stop = core.stop
        self.explanation = core.explanation
        self.warning = core.warning
        self.complete = not core.why_not_whole
        self.seconds = core.seconds
        self.derivatives = derivatives or {}
        self.verification = verification

    def __len__(self):
        return len(self._core)

    def __repr__(self):
        return f"<arcslip.Branch over {self.parameter}: {len(self)} points, {self.stop}>"

    @property
    def columns(self):
        """The names of the columns, as branches.csv has them."""
        if self._names is None:
            self._names = ["type", "regime", *self._core.names()]
        return self._names

    def _column(self, name):
        if name not in self._made:
            if name not in self.columns:
                raise KeyError(name)
            self._made[name] = self._make(name)
        return self._made[name]

    def _make(self, name):
        if name == "type":
            return np.array(self._core.types(), dtype=str)
        if name == "regime":
            return np.array(self._core.regimes(), dtype=str)
        column = self._core.column(self.columns.index(name) - 2)
        return column.astype(int) if name in ("unstable", "iterations") else column

    @property
    def unknowns(self):
        """The unknowns u, shape (points, n), in the problem's units."""
        return self._core.unknowns()

    @property
    def parameters(self):
        """All parameters, shape (points, number of parameters), in the order of `parameter_names`."""
        return self._core.parameters()

    @property
    def parameter_names(self):
        """The names of the problem's parameters; of a curve without that which it solves for."""
        return self._core.parameter_names()

    @property
    def tangents(self):
        """d(u, parameter)/d arclength behind each point, shape (points, n + 1)."""
        return self._core.tangents()

    @property
    def eigenvalues(self):
        """The eigenvalues that tell stability, a list with a complex array for each point, empty where untold."""
        return self._core.eigenvalues()

    @property
    def special(self):
        """The special points, a list of dicts: "point" (its row), "type", "label" (of events), and all columns."""
        types, labels = self["type"], self._core.labels()
        return [
            {"point": i, "label": labels[i], **{name: self[name][i] for name in self.columns}}
            for i in range(len(self))
            if types[i] != "regular"
        ]

    @property
    def summary(self):
        """What summary.json says of the branch, as a dict."""
        if "summary" not in self._made:
            self._made["summary"] = json.loads(self._core.summary(self._number))
        return self._made["summary"]

    @property
    def certificate(self):
        """With `run(..., certify=True)` what interval arithmetic proves, as summary.json has it; else None."""
        return self.summary.get("certificate")

    @property
    def work(self):
        """What it took: evaluations, factorizations, iterations, rejected_steps."""
        return self._core.work()

    @property
    def checkpoint(self):
        """From where the branch goes on, as text for `trace(checkpoint=...)`; None if there is nothing further."""
        return self._core.checkpoint

    def orbit(self, point):
        """The orbit at a point: one period of a cycle, or the solution of a boundary value problem.

        Of a branch, or of a curve in two parameters.

        Parameters
        ----------
        point : int or dict
            Its row, or one of `special`.

        Returns
        -------
        dict of numpy.ndarray
            "t" from 0 to T, or what the interval is of, and the unknowns by name, at the nodes of the mesh.
        """
        time, times, values, names = _core.orbit_of(self._core, self._row(point))
        return {time: times, **{name: values[:, i] for i, name in enumerate(names)}}

    def multipliers(self, point):
        """The Floquet multipliers of a cycle, without that of its own velocity, complex, shape (n - 1,) or (n,).

        Parameters
        ----------
        point : int or dict
            Its row, or one of `special`.
        """
        return np.exp(_core.log_multipliers_of(self._core, self._row(point)))

    def sample(self, n=1000):
        """Points at equal distances of arclength, between those of the branch.

        Parameters
        ----------
        n : int
            How many, at least 2.

        Returns
        -------
        Sample
            Solutions to the engine's tolerance. Where none is found next to the curve through the branch's points, the
            sample is the curve's, with its estimated error; the error of the others is 0.
        """
        return Sample(self._core.sample(n))

    def where(self, value):
        """The points, solved for likewise, at which the parameter has a value, in the order of the branch.

        Parameters
        ----------
        value : float
            In the unit of the parameter.

        Returns
        -------
        Sample
        """
        return Sample(self._core.where(value))

    def curve(self):
        """The columns as they are drawn, dense where the branch bends: those of curves.csv, a dict of arrays."""
        return self._core.drawn()

    def plot(self, ax=None, x=None, y=None, **style):
        """Draw the branch with matplotlib: stable parts solid, unstable ones dashed, special points marked.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            To draw in, as it is; if not given new ones, logarithmic where values span more than two decades.
        x, y : str, optional
            Columns; the parameter, and "Y" or the first that is no parameter.
        **style
            For `ax.plot`.

        Returns
        -------
        matplotlib.axes.Axes
        """
        from . import _plot

        own = ax is None
        ax = _plot.plot(self, _plot.new_axes() if own else ax, x, y, style)
        if own:
            _plot.settle(ax)
        return ax

    def to_csv(self, folder):
        """Write branch.csv, the columns with 17 digits, and summary.json.

        Parameters
        ----------
        folder : path
            Where to; made if it is not there.
        """
        os.makedirs(folder, exist_ok=True)
        with open(os.path.join(folder, "branch.csv"), "w", encoding="utf-8") as file:
            file.write("point," + ",".join(self.columns) + "\n")
            columns = [self[name] for name in self.columns]
            for i in range(len(self)):
                row = [f"{c[i]:.17g}" if c.dtype.kind == "f" else str(c[i]) for c in columns]
                file.write(f"{i}," + ",".join(row) + "\n")
        with open(os.path.join(folder, "summary.json"), "w", encoding="utf-8") as file:
            json.dump(self.summary, file, indent=2)

    def _further(self, core):
        return Branch(core, derivatives=self.derivatives)

    def start_from(self, point, forward=True, *, progress=None, **options):
        """Trace anew from a stored point.

        Parameters
        ----------
        point : int
            Its row.
        forward : bool
            Whether to set out as the branch went on there, or against it.
        progress, **options
            As `trace` takes them, in place of those of this branch. Another `parameter` with its `range` starts over
            that one, from the first value of the two that the point has, towards `range[1]`.

        Returns
        -------
        Branch
        """
        (core,) = _core.start_from(self._core, self._row(point), forward, options, progress)
        return self._further(core)

    def switch(self, point, *, window=None, progress=None, **options):
        """Trace the other branches that leave a branch point, a switch or a corner, the cycles that leave a Hopf
        point or a period doubling, of a map as points of twice its `iterate`; of a curve in two parameters the other
        curves that meet it at a point of codimension two, or begin there.

        Parameters
        ----------
        point : int
            Its row.
        window : (float, float), optional
            Of curves: of the first parameter, which is an unknown.
        progress, **options
            As `trace` takes them, in place of those of this branch.

        Returns
        -------
        list of Branch
            One for each way; empty where nothing else leaves.
        """
        found = _core.switch_at(self._core, self._row(point), window, options, progress)
        return [self._further(core) for core in found]

    def continue_in_two(self, point, parameter, range, *, window=None, observable="", progress=None, **options):
        """Follow a special point in two parameters: a fold, branch point, Hopf point, peak, trough or switch.

        Parameters
        ----------
        point : int
            Its row.
        parameter : str
            The second parameter, over which the curve is traced.
        range : (float, float)
            Of the second parameter.
        window : (float, float), optional
            Of the branch's own parameter, which becomes an unknown.
        observable : str
            Of peaks and troughs, whose they are.
        progress, **options
            As `trace` takes them.

        Returns
        -------
        Branch
            The curve, traced both ways, with cusps and other points of its own; its unknowns are (u, the branch's
            parameter, ...).
        """
        options = {"parameter": parameter, "range": range, **options}
        return self._further(
            _core.curve_through(self._core, self._row(point), observable, window, options, progress)
        )

    def resume(self, *, progress=None, **options):
        """Go on with a branch that was interrupted, or ended by `max_points`, `max_seconds` or its range.

        Parameters
        ----------
        progress, **options
            As `trace` takes them: limits and `range` may differ.

        Returns
        -------
        Branch
            The whole of it, as if it had never been left.
        """
        return self._further(_core.resume(self._core, options, progress))

    def _row(self, point):
        try:
            row = operator.index(point["point"] if isinstance(point, dict) else point)
        except TypeError:
            raise TypeError(f"point: expected a row, an integer, or one of special, got {point!r}") from None
        if not -len(self) <= row < len(self):
            raise IndexError(f"point: {row} of a branch of {len(self)} points")
        return row % len(self)


class Sample(_Columns):
    """Points between those of a branch. `sample[name]` is a column, as `Branch` has them.

    Attributes
    ----------
    unknowns : numpy.ndarray
        Shape (samples, n).
    error : numpy.ndarray
        Estimated absolute error of (u, parameter), shape (samples, n + 1), in their units.
    """

    def __init__(self, made):
        self._made = made["columns"]
        for name in ("unstable", "iterations", "residual"):  # which only points have
            self._made.pop(name)
        self.columns = list(self._made)
        self.unknowns = made["unknowns"]
        self.error = made["error"]

    def _column(self, name):
        return self._made[name]

    def __len__(self):
        return len(self.error)
