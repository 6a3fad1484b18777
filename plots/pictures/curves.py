"""Curves: what there is of each, and how they are drawn on axes."""

from dataclasses import dataclass, field

import numpy as np

from . import style


@dataclass
class Curve:
    """A curve of n points.

    Attributes
    ----------
    x, y : numpy.ndarray
        Shape (n,), nan where there is nothing.
    told : numpy.ndarray of bool
        Of the stretch that begins at each point: whether it slips, is unstable or the highest of several.
    special : dict
        The kinds of special points, with the numbers of the points.
    look : style.Look
    name : str
        Those of the same name have the same look.
    """

    x: np.ndarray
    y: np.ndarray
    told: np.ndarray
    special: dict
    look: style.Look
    name: str = ""
    is_common: bool = field(default=False)  # what is not told of it is drawn once, with others
    style: dict = field(default_factory=dict)  # of its lines, as matplotlib names it, in place of the look's


def broken(x, y, chosen):
    """The stretches of a curve that are chosen by their first points, with nan between them."""
    here = np.flatnonzero(chosen[:-1])
    if not len(here):
        return np.array([]), np.array([])
    ends = np.flatnonzero(np.diff(here) > 1)
    parts_x, parts_y = [], []
    for first, last in zip(here[np.r_[0, ends + 1]], here[np.r_[ends, len(here) - 1]]):
        parts_x += [x[first : last + 2], [np.nan]]
        parts_y += [y[first : last + 2], [np.nan]]
    return np.concatenate(parts_x), np.concatenate(parts_y)


# ---- What several curves have in common ----


def _runs(x, y):
    """The parts between nans whose x rises, or falls, all the way; those that turn are left out."""
    gaps = np.flatnonzero(~np.isfinite(x) | ~np.isfinite(y))
    for first, last in zip(np.r_[0, gaps + 1], np.r_[gaps, len(x)]):
        part_x, part_y = x[first:last], y[first:last]
        steps = np.diff(part_x)
        if len(part_x) > 1 and ((steps >= 0).all() or (steps <= 0).all()):
            yield (part_x, part_y) if steps.sum() > 0 else (part_x[::-1], part_y[::-1])


def _is_same(x, y, runs):
    """Whether a curve is that of the runs wherever both are; and at which points they are not."""
    compared = agreed = 0
    alone = np.ones(len(x), dtype=bool)
    for run_x, run_y in runs:
        inside = (x >= run_x[0]) & (x <= run_x[-1]) & np.isfinite(y)
        expected = np.interp(x[inside], run_x, run_y)
        compared += inside.sum()
        agreed += (np.abs(y[inside] - expected) <= 1e-3 * np.abs(expected) + 1e-9).sum()
        alone[inside] = False
    return compared >= 3 and agreed >= 0.95 * compared, alone


def find_common(curves):
    """What is not slip coincides where the preload alone is another: it is to be drawn once.

    Marks the curves of which that holds, and gives the stretches to be drawn for all of them.
    """
    stuck = [(curve, *broken(curve.x, curve.y, ~curve.told)) for curve in curves]
    stuck = sorted((entry for entry in stuck if len(entry[1])), key=lambda entry: -len(entry[1]))
    if len(stuck) < 2:
        return []
    first, x, y = stuck[0]
    runs = list(_runs(x, y))
    pieces = [(x, y)]
    for curve, x, y in stuck[1:]:
        same, alone = _is_same(x, y, runs)
        if same:
            first.is_common = curve.is_common = True
            here = alone.copy()
            here[:-1] |= alone[1:]
            piece = broken(x, np.where(np.isfinite(y), y, np.nan), here)
            pieces.append(piece)
            runs += list(_runs(*piece))
    return pieces if first.is_common else []


# ---- Drawing ----


def draw_curves(ax, curves, mode, common=(), is_marked=None):
    """Draws curves and their special points.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
    curves : list of Curve
    mode : str
        "regimes": thin in stick and thick in slip; "stability": dashed where unstable, dotted where nothing tells;
        "envelope": only what is told; "plain".
    common : list of (x, y)
        What is drawn once for the curves that have it in common.
    is_marked : callable, optional
        At which x special points are marked; everywhere if not given.
    """
    for x, y in common:
        ax.plot(x, y, color=style.COMMON, linewidth=style.THIN, zorder=2)
    for curve in curves:
        _draw_lines(ax, curve, mode)
    for kind in style.KINDS:
        for curve in curves:
            points = curve.special.get(kind, np.array([], dtype=int))
            points = points[is_marked(curve.x[points])] if is_marked else points
            if len(points):
                draw_marks(ax, curve.x[points], curve.y[points], kind, curve.look)


def _draw_lines(ax, curve, mode):
    look = curve.look
    if len(curve.x) < 2:
        return
    whole = np.ones(len(curve.x), dtype=bool)
    told = whole if mode == "plain" else curve.told
    width = style.THIN if mode == "regimes" else style.MEDIUM
    dash = style.SOLID if mode == "stability" else look.dash
    lines = []
    if mode in ("regimes", "stability") and not curve.is_common:
        lines.append((~told, look.width(width), dash, 2.1))
    width = style.THICK if mode == "regimes" else style.MEDIUM
    lines.append((told, look.width(width), style.UNSTABLE if mode == "stability" else look.dash, 2.2))
    for chosen, width, dash, order in lines:
        x, y = broken(curve.x, curve.y, chosen)
        if len(x):
            dashes = (0, tuple(d * max(width, 0.9) for d in dash[1])) if dash[1] else "-"
            drawn = {"color": look.colour, "linewidth": width, "linestyle": dashes, "zorder": order, **curve.style}
            ax.plot(x, y, **drawn | ({"linestyle": dashes} if dash is style.UNSTABLE else {}))


def draw_marks(ax, x, y, kind, look):
    """Special points, each over its own shape in white."""
    _, shape, size, is_filled = style.KINDS[kind]
    size, colour = size * look.mark_scale, look.colour
    if shape in "x+":
        ax.plot(x, y, shape, color=colour, markersize=size, markeredgewidth=0.8, zorder=3)
        return
    edge = "white" if is_filled else colour
    fill = colour if is_filled else ("white" if kind != "fold" else "none")
    ax.plot(x, y, shape, color=colour, markersize=size, markerfacecolor=fill, markeredgecolor=edge,
            markeredgewidth=0.4 if is_filled else 0.6, zorder=3, linestyle="none")


def spread_marks(ax, curves, apart=1.7):
    """Hollow marks along curves that differ in colour only, `apart` cm from one another, once the axes are set."""
    figure_cm = ax.figure.dpi / 2.54
    for number, curve in enumerate(curves):
        if not curve.look.mark or len(curve.x) < 2:
            continue
        with np.errstate(all="ignore"):
            places = ax.transData.transform(np.column_stack([curve.x, curve.y])) / figure_cm
        inside = np.isfinite(places).all(axis=1)
        steps = np.hypot(*np.diff(np.where(inside[:, None], places, np.nan), axis=0).T)
        way = np.r_[0, np.nancumsum(steps)]
        wanted = np.arange(apart * (0.4 + 0.13 * (number % 5)), way[-1], apart)
        rows = np.unique(np.minimum(np.searchsorted(way, wanted), len(way) - 1))
        ax.plot(curve.x[rows], curve.y[rows], curve.look.mark, color=curve.look.colour, markersize=3.4, linestyle="none",
                markerfacecolor="white", markeredgewidth=0.7, zorder=2.6)
