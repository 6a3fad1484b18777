"""Branches drawn with matplotlib, by what draws the pictures of `arcslip plot`."""

import numpy as np
from matplotlib import cbook, pyplot, rcParams
from matplotlib.lines import Line2D

from ._pictures.axes import is_wide, spread
from ._pictures.curves import Curve, draw_curves, draw_marks
from ._pictures.style import KINDS, MEDIUM, Look

_WIDE = 100  # the ratio of largest to smallest from which axes of one's own are logarithmic


def _default_y(branch):
    if "Y" in branch:
        return "Y"
    others = [name for name in branch.columns[2:] if name not in branch.parameter_names]
    return others[0]


def new_axes():
    """Axes of a figure of their own."""
    return pyplot.figure().add_subplot()


def settle(ax):
    """Makes axes logarithmic on which positive values span more than two decades, and adds the legend."""
    for values, set_scale in (("get_xdata", ax.set_xscale), ("get_ydata", ax.set_yscale)):
        shown = np.concatenate([np.asarray(getattr(line, values)(), dtype=float) for line in ax.get_lines()] or [[]])
        bounds = spread(shown)
        if bounds and is_wide(*bounds, _WIDE):
            set_scale("log")
    if ax.get_legend_handles_labels()[0]:
        ax.legend()


def plot(branch, ax, x, y, style):
    """See `Branch.plot`."""
    x = x or branch.parameter
    y = y or _default_y(branch)
    branch[x], branch[y]  # refused before anything is drawn
    ax.set_xlabel(x)
    ax.set_ylabel(y)
    if len(branch) == 0:
        return ax
    style = cbook.normalize_kwargs(style, Line2D)
    (sample,) = ax.plot([], [], **style)  # has the colour whose turn it is on these axes
    sample.remove()
    look = Look(0, 1, sample.get_color(), rcParams["lines.linewidth"] / MEDIUM)
    curve, before, label = branch.curve(), len(ax.lines), style.pop("label", None)
    draw_curves(ax, [Curve(curve[x], curve[y], curve["unstable"] > 0, {}, look, style=style)], "stability")
    if label and len(ax.lines) > before:
        ax.lines[before].set_label(label)
    for kind in KINDS:
        at = branch["type"] == kind
        if at.any():
            draw_marks(ax, branch[x][at], branch[y][at], kind, look)
    return ax
