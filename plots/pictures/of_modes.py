"""The picture of what `arcslip modes` has written: frequencies over nodal diameters, and which of them engine orders meet."""

import os

import numpy as np

from . import style, words
from .axes import with_room
from .curves import Curve, draw_marks
from .draw import Quantity, Sheet
from .of_campbell import Campbell, has_campbell
from .page import line_entry, mark_entry
from .tables import Refused, Table, json_of

PARTS = {"base": "base", "damper": "damper", "stuck": "both, stuck"}


def nodal_diameter(order, nodes):
    """That which an engine order excites of so many sectors."""
    return np.minimum(order % nodes, -order % nodes)


def crossings(diameters, values, met, excited):
    """Where frequencies over diameters are those of engine orders, between two orders as well: two arrays, x and y."""
    gap = np.interp(met, diameters, values, left=np.nan, right=np.nan) - excited
    here = np.flatnonzero((gap[:-1] * gap[1:] < 0) | (gap[:-1] == 0))
    part = gap[here] / np.where(gap[here] == 0, 1, gap[here] - gap[here + 1])
    return met[here] + part * np.diff(met)[here], excited[here] + part * np.diff(excited)[here]


class _Sheet(Sheet):
    def _named(self, quantities):
        looks = {curve.name: curve.look for curve in quantities[0].curves}
        return [line_entry(name, look.colour, style.MEDIUM, look.dash, look.mark) for name, look in looks.items()]


class PicturesOfModes:
    """Decides, and draws, what there is to see of modes, and of a run in the same folder beside them."""

    def __init__(self, folder, options, measure, run=None):
        self.options, self.measure = options, measure
        table = Table(os.path.join(folder, "modes.csv"), ["wave_number", "part", "mode", "eta"], "modes")
        self.column = "frequency_Hz" if table.has("frequency_Hz") else "eta"
        self.waves, self.parts, self.modes, self.values = table.read(["wave_number", "part", "mode", self.column])
        self.damped = None
        path = os.path.join(folder, "damping.csv")
        if os.path.exists(path):
            self.damped = Table(path, ["wave_number", "mode", "R", "zeta"], "modes --amplitude").read(["wave_number", "mode", "R", "zeta"])
        path = os.path.join(folder, "modes.json")
        about = json_of(path)
        try:
            self.nodes, self.speed = int(about["nodes"]), about["speed_per_minute"]
            self.is_turning = self.speed is not None and self.speed > 0 and self.nodes > 0 and self.column == "frequency_Hz"
        except (KeyError, TypeError, ValueError) as error:
            raise Refused(f"{path}: does not tell nodes and speed_per_minute; expected a file that arcslip has written") from error

        self.campbell = Campbell(folder, PARTS, run) if has_campbell(folder) else None

    def pictures(self):
        found = {"modes": self._modes} | ({"damping": self._damping} if self.damped else {})
        if self.campbell is not None:
            found["campbell"] = lambda: self.campbell.figure(lambda title, x: _Sheet(self.options, self.measure, title, x))
        return found

    def _damping(self):
        """Damping over nodal diameters, the first mode at each amplitude; below 0 of waves that run the other way."""
        waves, modes, amplitudes, zetas = self.damped
        given = np.unique(amplitudes)
        curves = []
        for i, amplitude in enumerate(given):
            rows = np.flatnonzero((modes == 1) & (amplitudes == amplitude))
            rows = rows[np.argsort(waves[rows])]
            look = style.Look(i, len(given))
            curves.append(Curve(waves[rows], zetas[rows], np.ones(len(rows), dtype=bool), {}, look, f"R = {words.number_text(amplitude)}"))
        span = with_room(min(waves.min(), 0), max(waves.max(), 1), 0.04, 0.04, False)
        sheet = _Sheet(self.options, self.measure, "nodal diameter", span)
        quantity = Quantity(curves, "plain", words.axis_title("zeta"), is_linear=True, reference=(0, "gains below"), wide=100)
        figure = sheet.panels([quantity], [])
        for curve in curves:
            figure.axes[0].plot(curve.x, curve.y, curve.look.mark, color=curve.look.colour, markersize=3.4, linestyle="none",
                                markerfacecolor="white", markeredgewidth=0.7, zorder=2.6)
        return figure

    def _curves(self):
        names = [name for name in PARTS if (self.parts == name).any()]
        looks = {name: style.Look(i, len(PARTS)) for i, name in enumerate(PARTS)}
        found = []
        for name in names:
            for mode in np.unique(self.modes[self.parts == name]):
                rows = np.flatnonzero((self.parts == name) & (self.modes == mode) & np.isfinite(self.values))
                rows = rows[np.argsort(self.waves[rows])]
                x, y = self.waves[rows], self.values[rows]
                found.append(Curve(x, y, np.ones(len(x), dtype=bool), {}, looks[name], PARTS[name]))
        return found

    def _engine_orders(self, high):
        """The diameters that engine orders meet up to a frequency, or twice the sectors, and their frequencies."""
        orders = np.arange(0, min(int(60 * high / self.speed) + 2, 2 * self.nodes + 1))
        return nodal_diameter(orders, self.nodes).astype(float), orders * self.speed / 60

    def _modes(self):
        curves = self._curves()
        more = []
        if self.is_turning:
            more = [line_entry(f"engine orders to {2 * self.nodes} at {words.number_text(self.speed)}/min", style.GREY, style.THIN),
                    mark_entry("crossing", "user")]
        title = words.axis_title(self.column)
        sheet = _Sheet(self.options, self.measure, "nodal diameter", with_room(min(self.waves.min(), 0), max(self.waves.max(), 1), 0.04, 0.04, False))
        figure = sheet.panels([Quantity(curves, "plain", title, wide=100)], more)
        (ax,) = figure.axes
        for curve in curves:
            ax.plot(curve.x, curve.y, curve.look.mark, color=curve.look.colour, markersize=3.4, linestyle="none",
                    markerfacecolor="white", markeredgewidth=0.7, zorder=2.6)
        if self.is_turning:
            self._draw_engine_orders(ax, curves)
        return figure

    def _draw_engine_orders(self, ax, curves):
        met, excited = self._engine_orders(ax.get_ylim()[1])
        if ax.get_yscale() == "log":
            met, excited = met[1:], excited[1:]
        ax.plot(met, excited, color=style.GREY, linewidth=style.THIN, zorder=1.5)
        for curve in curves:
            if len(curve.x):
                draw_marks(ax, *crossings(curve.x, curve.y, met, excited), "user", style.Look(0, 1, style.GREY))
