"""Branches drawn with matplotlib."""

import numpy as np

_MARKS = {
    "fold": "D",
    "corner_fold": "d",
    "branch_point": "o",
    "hopf": "s",
    "peak": "^",
    "trough": "v",
    "switch": "x",
    "cusp": "*",
    "neimark_sacker": "s",
    "period_doubling": "P",
}


def _default_y(branch):
    if "Y" in branch:
        return "Y"
    others = [name for name in branch.columns[2:] if name not in branch.parameter_names]
    return others[0]


def new_axes():
    """Axes of a figure of their own."""
    from matplotlib import pyplot

    return pyplot.figure().add_subplot()


def settle(ax):
    """Makes axes logarithmic on which positive values span more than two decades, and adds the legend."""
    for values, set_scale in (("get_xdata", ax.set_xscale), ("get_ydata", ax.set_yscale)):
        shown = np.concatenate([np.asarray(getattr(line, values)(), dtype=float) for line in ax.get_lines()] or [[]])
        shown = shown[np.isfinite(shown)]
        if len(shown) and shown.min() > 0 and shown.max() > 100 * shown.min():
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
    curve = branch.curve()
    unstable = curve["unstable"] > 0
    label = style.pop("label", None)
    dashed = {**style, "linestyle": "--"}
    line = None
    for is_unstable in (False, True):
        here = unstable == is_unstable
        if not here.any():
            continue
        joined = here.copy()  # each piece up to where the next one begins
        joined[1:] |= here[:-1]
        values = np.where(joined, curve[y], np.nan)
        color = {} if line is None else {"color": line.get_color()}
        (line,) = ax.plot(curve[x], values, **{**color, **(dashed if is_unstable else style)}, label=label)
        label = None
    _mark(branch, ax, x, y, line.get_color())
    return ax


def _mark(branch, ax, x, y, color):
    types = branch["type"]
    for kind, mark in _MARKS.items():
        at = types == kind
        if at.any():
            ax.plot(branch[x][at], branch[y][at], mark, color=color, markersize=5, label=None, fillstyle="none")
