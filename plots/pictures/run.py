"""What a run of `arcslip run` holds: its branches as curves of any two columns."""

import os

import numpy as np

from . import style, words
from .curves import Curve
from .tables import Table, drawn_table

# At these the count of unstable eigenvalues may be either: that of the next point counts.
BETWEEN = {"start", "fold", "corner_fold", "hopf", "branch_point", "neimark_sacker", "period_doubling", "symmetry_breaking"}


def followed(phase):
    """A phase over pi, by whole turns from its start, so that it does not jump at the ends of (-pi, pi]."""
    known = np.isfinite(phase)
    if not known.any():
        return phase
    values = np.full(len(phase), np.nan)
    turned = np.unwrap(phase[known])
    values[known] = (turned + (2 * np.pi if turned[0] < -np.pi / 2 else 0)) / np.pi
    return values


class RunData:
    """The tables of a run. Refuses what is none; an error of lookup is a summary that is none."""

    def __init__(self, folder, summary):
        branches = summary["branches"]
        self.case = summary["case"]
        formulas = "model" in self.case
        self.system = self.case["model"]["parameters"] if formulas else self.case["system"]
        self.branch = self.case["branch"]
        Table(os.path.join(folder, "branches.csv"), ["branch", "point", "type", "regime"], "points")
        self.table = Table(drawn_table(folder), ["branch", "point", "type", "regime"], "points")
        self.table.require(self.branch.get("parameters") or [self.branch["parameter"]])
        self.is_friction = not formulas and (self.table.has("R_over_S") or "wave_number" in self.system)
        self.is_requested = bool(self.case["continuation"]["stop_at"])
        self._values = [branch["values"] for branch in branches]
        self._columns = {}
        self._name_branches()
        number, types, regimes = self.columns("branch", "type", "regime")
        starts = np.r_[0, np.flatnonzero(np.diff(number)) + 1]
        self.parts = [slice(a, b) for a, b in zip(starts, np.r_[starts[1:], len(number)])]
        self.numbers = number[starts].astype(int)
        self.slips = np.array(["slip" in str(regime) for regime in regimes], dtype=bool)
        self.types = np.asarray(types, dtype=object)

    def columns(self, *names):
        missing = [name for name in names if name not in self._columns]
        if missing:
            self._columns.update(zip(missing, self.table.read(missing)))
        return [self._columns[name] for name in names]

    def _name_branches(self):
        """Those that one request led to have the same look and name; of a single request each has its own look."""
        first = self._values[0]
        differ = [key for key in first if any(values[key] != first[key] for values in self._values)]
        names = [words.label(values, differ, self.is_friction) for values in self._values]
        groups = list(dict.fromkeys(names)) if differ else list(range(len(names)))
        self.names = names if differ else [""] * len(names)
        count = len(groups)
        self.looks = [style.Look(groups.index(name) if differ else i, count) for i, name in enumerate(names)]

    def unstable(self):
        (counts,) = self.columns("unstable")
        counts = counts.astype(float).copy()
        counts[np.isin(self.types, list(BETWEEN))] = np.nan
        later = np.where(np.isfinite(counts), np.arange(len(counts)), len(counts) - 1)
        later = np.minimum.accumulate(later[::-1])[::-1]
        return np.nan_to_num(counts[later]) > 0

    def curves(self, x, quantity, mode, unmarked=()):
        """The curves of a column over another.

        Parameters
        ----------
        x : str
        quantity : str or (names, function)
            A column, or of some columns a function, which is given those of one branch.
        mode : str
            See `draw_curves`.
        unmarked : sequence of str
            The kinds of special points that are no matter here.
        """
        names, function = ((quantity,), lambda y: y) if isinstance(quantity, str) else quantity
        (xs,) = self.columns(x)
        ends = self.ends_of(names)
        has_values = not ends or self.table.has(*names)
        columns = self.columns(*names) if has_values else ends
        told = self.unstable() if mode == "stability" else self.slips
        marked = [kind for kind in dict.fromkeys(self.types) if kind in style.KINDS and kind not in unmarked]
        all_curves = []
        for number, part in zip(self.numbers, self.parts):
            special = {kind: np.flatnonzero(self.types[part] == kind) for kind in marked}
            special = {kind: rows for kind, rows in special.items() if len(rows)}
            i = min(number, len(self.looks) - 1)
            look = {"linestyle": style.UNTOLD} if mode == "stability" and self.is_untold(part) else {}
            drawn = columns
            if ends and not (has_values and np.isfinite(columns[0][part].astype(float)).any()):
                drawn = ends  # orbits: both ends of what the unknown runs through
            for column in drawn if drawn is ends else [drawn]:
                values = [column[part]] if drawn is ends else [one[part] for one in column]
                all_curves.append(Curve(xs[part], function(*values), told[part], special, self.looks[i],
                                        self.names[i], style=look))
        return all_curves

    def ends_of(self, names):
        """The columns of the largest and the smallest value of an unknown along orbits, or nothing."""
        both = [f"{names[0]}_max", f"{names[0]}_min"]
        return self.columns(*both) if len(names) == 1 and all(map(self.table.has, both)) else []

    def is_untold(self, part):
        """Whether nothing tells of the stability of a branch."""
        (counts,) = self.columns("unstable")
        return (counts[part].astype(float) < 0).all()

    def ends(self, x):
        """The range of x where branches start and end."""
        (xs,) = self.columns(x)
        values = xs[np.isin(self.types, ["start", "end"])]
        return (values.min(), values.max()) if len(values) else (np.inf, -np.inf)
