"""A column of optimum.csv over the plane of two keys, in colours with lines of equal value."""

import math

import numpy as np
from matplotlib.colors import LinearSegmentedColormap, LogNorm, Normalize
from matplotlib.patches import Rectangle

from . import style
from .axes import Ticks, is_wide, place_of, spread, value_at
from .page import Page

COLOURS = LinearSegmentedColormap.from_list("scale", ["#440154", "#414487", "#2A788E", "#22A884", "#7AD151", "#B5DE2B"])
FINE = 240  # points along each side between which colours are mixed
MOST_CELLS = 200


def _axis(values):
    """The values in rising order, and whether they are spaced as on a logarithmic axis."""
    steps = np.diff(values)
    ratio = values[-1] / values[0] if values[0] > 0 else 0
    return bool(ratio > 1.01 and steps[-1] > math.sqrt(ratio) * steps[0])


def _finer(places, z):
    """Rows of z at evenly spaced places from 0 to 1."""
    wanted = np.linspace(0, 1, FINE)
    right = np.clip(np.searchsorted(places, wanted), 1, len(places) - 1)
    part = ((wanted - places[right - 1]) / (places[right] - places[right - 1]))[:, None]
    with np.errstate(invalid="ignore"):
        return np.where(part == 0, z[right - 1], np.where(part == 1, z[right], (1 - part) * z[right - 1] + part * z[right]))


def _levels(low, high):
    if is_wide(low, high):
        steps = (1,) if high / low > 1e4 else (1, 2, 5)
        return [m * 10.0**k for k in range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1) for m in steps
                if low < m * 10.0**k < high]
    step = 10.0 ** math.floor(math.log10((high - low) / 2))
    step *= 5 if (high - low) / step > 12 else 2 if (high - low) / step > 6 else 1
    return [k * step for k in range(math.ceil(low / step), math.floor(high / step) + 1) if low < k * step < high]


def draw_map(options, measure, axes, z, title, notes):
    """A figure; `axes` are the values of both keys, the second of which runs faster, with their titles."""
    (x_all, x_title), (y_all, y_title) = axes
    xs, ys = (np.unique(values) for values in (x_all, y_all))
    grid = np.full((len(xs), len(ys)), np.nan)
    grid[np.searchsorted(xs, x_all), np.searchsorted(ys, y_all)] = z
    chosen = [np.unique(np.round(np.linspace(0, len(v) - 1, min(len(v), MOST_CELLS))).astype(int)) for v in (xs, ys)]
    grid, xs, ys = grid[np.ix_(*chosen)], xs[chosen[0]], ys[chosen[1]]
    low, high = options.ranges.get("z") or spread(z) or (0.1, 1.0)
    is_log = [options.is_log("x", _axis(xs)) and xs[0] > 0, options.is_log("y", _axis(ys)) and ys[0] > 0, is_wide(low, high)]
    width, tall = options.size or (style.WIDTH, 1.0 + 5.4 + (0.75 if notes else 0.35))
    bottom, top = 1.0, tall - (0.75 if notes else 0.35)
    scale = Ticks(low, high, top - bottom, is_log[2], True, measure)
    bar = width - 0.95 - scale.label_width(measure)
    y_ticks = Ticks(ys[0], ys[-1], top - bottom, is_log[1], True, measure)
    left, right = 0.75 + y_ticks.label_width(measure), bar - 0.25
    page = Page(width, tall, measure)
    ax = page.panel(left, right, bottom, top)
    ax.set_facecolor(style.SHADE)
    _fill(ax, xs, ys, grid, low, high, is_log)
    Ticks(xs[0], xs[-1], right - left, is_log[0], False, measure).apply(ax.xaxis)
    y_ticks.apply(ax.yaxis)
    _bar(page.panel(bar, bar + 0.3, bottom, top), low, high, is_log[2], scale)
    for axes_drawn in page.figure.axes:
        axes_drawn.tick_params(which="both", direction="out", top=False, right=axes_drawn is not ax)
    page.text((left + right) / 2, 0.25, x_title, right - left + 1.2, ha="center")
    page.upright(0.25, (bottom + top) / 2, y_title, top - bottom)
    page.upright(width - 0.25, (bottom + top) / 2, title, top - bottom)
    if scale.common_power:
        page.text(bar, top + 0.2, f"×1e{scale.common_power}")
    if notes:
        page.figure.add_artist(Rectangle((left / width, (top + 0.3) / tall), 0.35 / width, 0.22 / tall,
                                         facecolor=style.SHADE, transform=page.figure.transFigure))
        page.text(left + 0.5, top + 0.41, ", ".join(notes))
    return page.figure


def _bar(ax, low, high, is_log, ticks):
    edges = value_at(low, high, np.linspace(0, 1, 129), is_log)
    norm = LogNorm(low, high) if is_log else Normalize(low, high)
    ax.pcolormesh([0, 1], edges, np.sqrt(edges[:-1] * edges[1:])[:, None] if is_log else 0.5 * (edges[:-1] + edges[1:])[:, None],
                  norm=norm, cmap=COLOURS, rasterized=True)
    ax.set_yscale("log" if is_log else "linear")
    ax.set_ylim(low, high)
    ax.yaxis.tick_right()
    ticks.apply(ax.yaxis)
    ax.set_xticks([])


def _fill(ax, xs, ys, grid, low, high, is_log):
    ax.set_xscale("log" if is_log[0] else "linear")
    ax.set_yscale("log" if is_log[1] else "linear")
    ax.set_xlim(xs[0], xs[-1])
    ax.set_ylim(ys[0], ys[-1])
    values = np.log(grid) if is_log[2] else grid
    fine = _finer(place_of(xs[0], xs[-1], xs, is_log[0]), values)
    fine = _finer(place_of(ys[0], ys[-1], ys, is_log[1]), fine.T)
    fine = np.exp(fine) if is_log[2] else fine
    fine_x, fine_y = (value_at(v[0], v[-1], np.linspace(0, 1, FINE), log) for v, log in ((xs, is_log[0]), (ys, is_log[1])))
    norm = LogNorm(low, high) if is_log[2] else Normalize(low, high)
    shown = np.ma.masked_invalid(fine)
    ax.pcolormesh(fine_x, fine_y, shown, shading="nearest", norm=norm, cmap=COLOURS, rasterized=True)
    levels = _levels(low, high)
    if levels and shown.count():
        lines = ax.contour(fine_x, fine_y, shown, levels=levels, colors="white", linewidths=style.THIN)
        names = ax.clabel(lines, fmt=lambda v: f"{v:g}", fontsize=0.8 * style.TYPE, colors="black", inline=False)
        for name in names:
            name.set_rotation(0)
            name.set_bbox(dict(facecolor="white", edgecolor="none", pad=0.8))
