"""The Campbell diagram that `arcslip modes --campbell` has written: frequencies over the speed, with engine orders that cross.

Beside a run in the same folder its peaks are drawn over them: those that curves follow over frequency and speed, or those of
branches over the speed of an engine order.
"""

import os

import numpy as np

from . import style, words
from .axes import with_room
from .curves import Curve, draw_marks
from .draw import Quantity
from .page import line_entry, mark_entry
from .tables import Table

MOST_ORDERS = 12  # that are drawn: those with most to meet come first


def has_campbell(folder):
    """Whether there is one."""
    return all(os.path.exists(os.path.join(folder, name)) for name in ("campbell.csv", "crossings.csv"))


class Campbell:
    """What there is to see of it. `parts` are the names of its parts, in their order; `run` is that of its folder, or None."""

    def __init__(self, folder, parts, run=None):
        names = ["speed", "wave_number", "part", "mode", "eta"]
        table = Table(os.path.join(folder, "campbell.csv"), names, "modes")
        self.column = "frequency_Hz" if table.has("frequency_Hz") else "eta"
        self.speeds, self.waves, self.parts, self.modes, self.values = table.read([*names[:4], self.column])
        crossings = Table(os.path.join(folder, "crossings.csv"), ["engine_order", "speed", "eta"], "modes")
        self.orders, self.met, self.excited = crossings.read(["engine_order", "speed", self.column])
        self.names, self.run = parts, run
        branch = run.branch if run is not None and run.table.has("speed", self.column) else {}
        self.has_ridges = branch.get("curve") == "peak" and set(branch["parameters"]) == {"eta", "speed"}
        self.has_peaks = branch.get("parameter") == "speed" and (run.types == "peak").any()

    def ridges(self, count, others):
        """The run's peaks over the speed, a curve each, their looks after those of so many others."""
        if not self.has_ridges:
            return []
        names = list(dict.fromkeys(self.run.names))
        found = []
        for curve in self.run.curves("speed", self.column, "plain"):
            look = style.Look(others + names.index(curve.name), count)
            name = f"peak, {curve.name}" if curve.name else "peak"
            found.append(Curve(curve.x, curve.y, curve.told, {}, look, name, style={"linewidth": style.THICK}))
        return found

    def curves(self):
        """One for each mode, named by its part and the way in which the wave runs, and the run's peaks after them."""
        found = []
        kinds = [(part, wave) for part in self.names for wave in sorted(set(self.waves), reverse=True)]
        kinds = [(part, wave) for part, wave in kinds if ((self.parts == part) & (self.waves == wave)).any()]
        count = len(kinds) + (len(set(self.run.names)) if self.has_ridges else 0)
        for number, (part, wave) in enumerate(kinds):
            way = "" if len(set(self.waves)) == 1 else ", forward" if wave > 0 else ", backward"
            for mode in np.unique(self.modes[(self.parts == part) & (self.waves == wave)]):
                rows = np.flatnonzero((self.parts == part) & (self.waves == wave) & (self.modes == mode))
                rows = rows[np.argsort(self.speeds[rows])]
                look = style.Look(number, count)
                there = np.ones(len(rows), dtype=bool)
                found.append(Curve(self.speeds[rows], self.values[rows], there, {}, look, self.names[part] + way))
        return found + self.ridges(count, len(kinds))

    def figure(self, make_sheet):
        """Drawn on the sheet that `make_sheet` gives for a title and a range of x."""
        curves = self.curves()
        more = []
        if len(self.met):
            more = [line_entry("engine orders", style.GREY, style.THIN), mark_entry("crossing", "user")]
        if self.has_peaks:
            more.append(mark_entry("peak", "peak"))
        low, high = self.speeds.min(), self.speeds.max()
        sheet = make_sheet("speed  (revolutions)", with_room(low, high, 0.0, 0.04, False))
        figure = sheet.panels([Quantity(curves, "plain", words.axis_title(self.column), wide=100)], more)
        (ax,) = figure.axes
        for order in np.unique(self.orders)[:MOST_ORDERS]:
            slope = (self.excited / self.met)[self.orders == order][0]
            speeds = np.linspace(max(low, 1e-3 * high), high, 50)
            ax.plot(speeds, slope * speeds, color=style.GREY, linewidth=style.THIN, zorder=1.5, scaley=False)
        drawn = np.isin(self.orders, np.unique(self.orders)[:MOST_ORDERS])
        if drawn.any():
            draw_marks(ax, self.met[drawn], self.excited[drawn], "user", style.Look(0, 1, style.GREY))
        if self.has_peaks:
            here = self.run.types == "peak"
            draw_marks(ax, *(values[here] for values in self.run.columns("speed", self.column)), "peak", style.Look(0, 1, style.GREY))
        return figure
