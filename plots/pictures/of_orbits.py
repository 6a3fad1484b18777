"""The pictures of orbits that special points have: cycles and tori in the plane of their unknowns, others over their interval."""

import os

import numpy as np

from . import style, words
from .axes import spread, with_room
from .curves import Curve
from .draw import Quantity, Sheet
from .tables import Refused, Table

MOST = 6  # orbits in one picture, and three unknowns


def _closed(lines):
    """Closed lines of trigonometric polynomials, as smooth as these are, by their values at equal distances; with gaps between."""
    finer = 4
    count = lines.shape[1]
    smooth = finer * np.fft.irfft(np.fft.rfft(lines, axis=1), n=finer * count, axis=1)
    return np.column_stack([smooth, smooth[:, :1], np.full(len(lines), np.nan)])


class PicturesOfOrbits:
    """Decides, and draws, what there is to see of `orbits.csv` and `tori.csv` beside a run."""

    def __init__(self, folder, data, options, measure):
        self.folder, self.data, self.options, self.measure = folder, data, options, measure

    def pictures(self):
        return {name: lambda table=table, draw=draw: draw(table)
                for name, draw in (("orbits", self._orbits), ("tori", self._tori)) for table in [self._table(name)] if table}

    def custom(self):
        return {}

    def nothing(self):
        return Refused(f"{self.folder}: holds no orbits")

    def _table(self, name):
        path = os.path.join(self.folder, f"{name}.csv")
        return Table(path, ["branch", "point", "type"], name) if os.path.exists(path) else None

    def _solutions(self, table, columns):
        """Of each special point what it is called, and its columns; ends only where there is nothing else."""
        branch, point, kind, *values = table.read(["branch", "point", "type", *columns])
        begins = np.r_[0, np.flatnonzero(np.diff(branch) + np.diff(point)) + 1, len(branch)]
        parts = [slice(a, b) for a, b in zip(begins[:-1], begins[1:])]
        telling = [part for part in parts if kind[part.start] not in ("start", "end")]
        if len(telling) < 2:
            telling = parts
        if len(telling) > MOST:
            telling = [telling[i * (len(telling) - 1) // (MOST - 1)] for i in range(MOST)]
        return [(self._name(branch[part.start], point[part.start], kind[part.start]), [column[part] for column in values])
                for part in telling]

    def _name(self, branch, point, kind):
        parameter = self.data.branch["parameter"]
        branches, points, values = self._values or self._read_values(parameter)
        here = np.flatnonzero((branches == branch) & (points == point))
        told = style.KINDS.get(kind, (kind,))[0]
        return f"{told}, {words.symbol(parameter, False)} = {words.number_text(values[here[0]])}" if len(here) else told

    _values = None

    def _read_values(self, parameter):
        table = Table(os.path.join(self.folder, "branches.csv"), ["branch", "point", parameter], "points")
        self._values = table.read(["branch", "point", parameter])
        return self._values

    def _orbits(self, table):
        """Over the first unknown where they close, over their interval where they are none of a time, or a single one is."""
        time, *unknowns = table.columns[3:]
        closes = time == "t" and len(unknowns) > 1
        across, *up = (unknowns if closes else [time, *unknowns])[:4]
        return self._drawn(across, up[:3], self._solutions(table, [across, *up]))

    def _tori(self, table):
        """The last of them, as a net of lines along both of its angles."""
        first, second, *unknowns = table.columns[3:]
        turning = self.data.case.get("model", {}).get("angles", [])
        across, *up = [name for name in unknowns if name not in turning][:4] or unknowns[:1]
        if not up:
            across, up = first, [across]
        name, (theta, _, *values) = self._solutions(table, [first, second, across, *up])[-1]
        count = len(np.unique(theta))
        grids = [column.reshape(-1, count) for column in values]
        net = [np.concatenate([_closed(lines).ravel() for lines in (grid, grid.T)]) for grid in grids]
        return self._drawn(across, up[:3], [(name, net)], style.THIN)

    def _drawn(self, across, up, solutions, width=None):
        looks = [style.Look(i, len(solutions)) for i in range(len(solutions))]
        quantities = []
        for i, column in enumerate(up):
            curves = []
            for look, (name, values) in zip(looks, solutions):
                of_line = {"linewidth": width} if width else {}
                curves.append(Curve(values[0], values[1 + i], np.ones(len(values[0]), dtype=bool), {}, look, name, style=of_line))
            quantities.append(Quantity(curves, "plain", words.axis_title(column, False), is_linear=True))
        low, high = spread(np.concatenate([values[0] for _, values in solutions])) or (0.0, 1.0)
        low, high = with_room(low, high, 0.04, 0.04, False)
        return Sheet(self.options, self.measure, words.axis_title(across, False), (low, high), x_wide=np.inf).panels(quantities)
