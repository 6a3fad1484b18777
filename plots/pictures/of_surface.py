"""Surfaces of solutions over two parameters: the first observable above both, with folds, their special points, and ridges."""

import os

import numpy as np
from matplotlib.ticker import MaxNLocator
from matplotlib.tri import Triangulation

from . import style, words
from .maps import COLOURS
from .page import Page
from .tables import Refused, Table


class PicturesOfSurface:
    """Decides, and draws, what there is to see of the surfaces of a run."""

    def __init__(self, folder, case, options, measure):
        self.folder, self.options, self.measure = folder, options, measure
        self.parameters = case["branch"]["parameters"]
        self.is_friction = "model" not in case
        self.charts = self._table("atlas.csv", ["branch", "chart", *self.parameters])
        fixed = {"branch", "chart", "component", *self.parameters, *case.get("model", {}).get("parameters", {})}
        observed = [name for name in self.charts.columns[: self.charts.columns.index("determinant")] if name not in fixed]
        self.height = (self.options.y or ["Y" if "Y" in observed else observed[0]])[0]

    def _table(self, name, columns):
        return Table(os.path.join(self.folder, name), columns, "charts")

    def pictures(self):
        """Names, each with what draws it."""
        return {"surface": self._draw}

    def _curves(self, name, number):
        """Types and places of the points on each curve of a table."""
        wanted = ["branch", number, "type", *self.parameters, self.height]
        try:
            table = self._table(name, wanted)
        except Refused:  # there are none
            return []
        branch, curve, kind, *at = table.read(wanted)
        keys = np.stack([branch, curve], axis=1)
        starts = np.r_[0, np.flatnonzero(np.any(np.diff(keys, axis=0) != 0, axis=1)) + 1, len(keys)]
        return [(kind[a:b], [values[a:b] for values in at]) for a, b in zip(starts[:-1], starts[1:])]

    def _draw(self):
        branch, *place = self.charts.read(["branch", *self.parameters, self.height])
        try:
            of_face, *corners = self._table("faces.csv", ["branch"]).read(["branch", "chart_1", "chart_2", "chart_3"])
        except Refused:
            raise Refused(f"{self.folder}: holds no triangles of a surface, which ended before it had any") from None
        faces = np.stack(corners, axis=1).astype(int)
        faces += np.searchsorted(branch, of_face)[:, None]  # charts are counted anew in each branch
        width, tall = self.options.size or (style.WIDTH, 7.2)
        page = Page(width, tall, self.measure)
        ax = page.figure.add_axes([0.1, 0.07, 0.84, 0.95], projection="3d", computed_zorder=False)
        ax.plot_trisurf(Triangulation(place[0], place[1], faces), place[2], cmap=COLOURS, linewidth=0.1,
                        edgecolor="#FFFFFF40", antialiased=True, alpha=0.92, zorder=1)
        for _, at in self._curves("ridges.csv", "ridge"):
            ax.plot(*at, color="#000000", linewidth=style.THIN, linestyle="--", zorder=2)
        for kind, at in self._curves("folds.csv", "fold_curve"):
            ax.plot(*at, color=style.FEW[1], linewidth=style.THICK, zorder=2)
            for name, mark in (("cusp", "o"), ("branch_point", "."), ("isola_centre", "*"), ("simple_bifurcation", "X")):
                chosen = np.asarray(kind) == name
                ax.plot(*(values[chosen] for values in at), mark, color="#000000", markersize=3, zorder=3)
        for axis, name in zip("xyz", [*self.parameters, self.height]):
            getattr(ax, f"set_{axis}label")(words.axis_title(name, self.is_friction), labelpad=1)
            getattr(ax, f"{axis}axis").set_major_locator(MaxNLocator(5))
            getattr(ax, f"{axis}axis").pane.set_alpha(0.3)
            if name_range := self.options.ranges.get(axis):
                getattr(ax, f"set_{axis}lim")(*name_range)
        ax.tick_params(pad=0)
        ax.view_init(elev=28, azim=-125)
        return page.figure
