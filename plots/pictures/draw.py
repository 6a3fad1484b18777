"""Draws pictures: panels of curves over what they share, with their key."""

import numpy as np
from . import style
from .axes import SUPERSCRIPTS, Ticks, is_wide, spread, with_room
from .curves import draw_curves, find_common, spread_marks
from .page import Key, Page, line_entry, mark_entry
from .windows import find_windows

BOTTOM = 1.0
LETTERS = "abc"


class Quantity:
    """What a panel shows: its curves, how they are drawn, the title of its axis, long and short.

    `ticks` are (places, labels) of an axis with its own; `reference` a line at a value, with its name.
    """

    def __init__(self, curves, mode, title, short=None, *, is_linear=False, reference=None, wide=4):
        self.curves, self.mode, self.title, self.short = curves, mode, title, short or title
        self.is_linear, self.reference, self.wide = is_linear, reference, wide
        self.common = find_common(curves) if mode == "regimes" else []


class Sheet:
    """What the pictures of a folder share: the options, and the axis of x.

    Parameters
    ----------
    options : Options
    measure : Measure
    x_title : str
    x_range : (float, float)
    lines_title : str
        What plain lines are, or "".
    titles : dict
        Other names of kinds of special points.
    """

    def __init__(self, options, measure, x_title, x_range, *, lines_title="", titles=None, x_wide=4):
        self.options, self.measure, self.x_title = options, measure, x_title
        self.lines_title, self.titles = lines_title, titles or {}
        self.x_low, self.x_high = options.ranges.get("x", x_range)
        self.x_is_log = options.is_log("x", is_wide(self.x_low, self.x_high, x_wide)) and self.x_low > 0
        self.width = options.size[0] if options.size else style.WIDTH
        self.right = self.width - max(0.32, measure("100") / 2 + 0.1)

    # ---- The key ----

    def _told(self, quantities):
        mode = quantities[0].mode
        curves = [curve for quantity in quantities for curve in quantity.curves]
        known = [curve for curve in curves if curve.style.get("linestyle") != style.UNTOLD]
        has = [any((curve.told[:-1] == told).any() for curve in known) for told in (False, True)]
        is_untold = len(known) < len(curves)
        entries = []
        if mode == "regimes":
            members = [curve for curve in quantities[0].curves if curve.is_common]
            in_words = f"{self.lines_title} in " if self.lines_title else ""
            if members:
                names = list(dict.fromkeys(curve.name for curve in members))
                alone = [c for c in quantities[0].curves if not c.is_common and not c.told[:-1].all() and len(c.x) > 1]
                which = "the same for all" if not alone else " and ".join([", ".join(names[:-1]), names[-1]][len(names) < 2:])
                text = f"{in_words}stick, {which}"
                entries.append(line_entry(text, style.COMMON, style.THIN))
            if has[0] and (not members or any(not curve.is_common and not curve.told[:-1].all() for curve in curves)):
                entries.append(line_entry(f"{in_words}stick", style.GREY, style.THIN))
            if has[1]:
                entries.append(line_entry(f"{in_words}slip", style.GREY, style.THICK))
        elif mode == "peaks":
            entries += [line_entry(text, style.GREY, width) for text, width, there in
                        [("other peaks", style.THIN, has[0]), ("highest peak", style.THICK, has[1])] if there]
        elif mode == "stability" and (has[1] or is_untold):
            entries += [line_entry("stable", style.GREY, style.MEDIUM)] * has[0]
            entries += [line_entry("unstable", style.GREY, style.MEDIUM, style.UNSTABLE)] * has[1]
            entries += [line_entry("stability not told", style.GREY, style.MEDIUM, style.UNTOLD)] * is_untold
        elif self.lines_title:
            entries.append(line_entry(self.lines_title, style.GREY, style.MEDIUM))
        present = {kind for curve in curves for kind in curve.special}
        kinds = {self.titles.get(kind, style.KINDS[kind][0]): kind for kind in style.KINDS if kind in present}
        return entries + [mark_entry(title, kind) for title, kind in kinds.items() if title]

    def _named(self, quantities):
        looks = {curve.name: curve.look for curve in quantities[0].curves if curve.name}
        names = list(looks)
        if len(names) > style.MANY:  # of many curves six: lightness tells the order of the others
            names = [names[int(round(i * (len(names) - 1) / 5))] for i in range(6)]
        is_marked = quantities[0].mode == "stability"
        return [line_entry(name, looks[name].colour, looks[name].width(1.2), style.SOLID if is_marked else looks[name].dash,
                           looks[name].mark if is_marked else None) for name in names]

    def key(self, quantities, more=()):
        return Key(self._named(quantities), [*self._told(quantities), *more], self.width, self.measure)

    # ---- Panels ----

    def y_axis(self, quantity, low_x, high_x, length):
        """The range of what lies between two x, whether it is logarithmic, its ticks, and whether there is any."""
        parts = []
        for curve in quantity.curves:
            y = np.where(curve.told | np.r_[False, curve.told[:-1]], curve.y, np.nan) if quantity.mode == "envelope" else curve.y
            parts.append(y[(curve.x >= low_x) & (curve.x <= high_x)])
        bounds = spread(np.concatenate(parts)) if parts else None
        low, high = bounds or (0.1, 1.0)
        is_log = not quantity.is_linear and self.options.is_log("y", is_wide(low, high, quantity.wide)) and low > 0
        low, high = with_room(low, high, 0.05, 0.07, is_log)
        low, high = self.options.ranges.get("y", (low, high))
        is_log = is_log and low > 0
        return low, high, is_log, Ticks(low, high, length, is_log, True, self.measure), bounds is not None

    def panel(self, page, quantity, box, x_range, *, has_labels=True, is_marked=None, shades=()):
        left, right, bottom, top = box
        ax = page.panel(left, right, bottom, top)
        low, high, is_log, ticks, is_there = self.y_axis(quantity, *x_range, top - bottom)
        ax.set_xscale("log" if self.x_is_log else "linear")
        ax.set_yscale("log" if is_log else "linear")
        ax.set_xlim(*x_range)
        ax.set_ylim(low, high)
        Ticks(*x_range, right - left, self.x_is_log, False, self.measure).apply(ax.xaxis, has_labels)
        ticks.apply(ax.yaxis)
        if ticks.common_power:
            page.text(left, top + 0.2, "×10" + str(ticks.common_power).translate(SUPERSCRIPTS))
        for shade in shades:
            ax.axvspan(*shade, color=style.SHADE, linewidth=0, zorder=0)
        if quantity.reference and low < quantity.reference[0] < high:
            ax.axhline(quantity.reference[0], color="black", linewidth=style.FRAME, linestyle=(0, (8, 6)), zorder=1)
            if x_range == (self.x_low, self.x_high):
                ax.annotate(quantity.reference[1], (0.015, quantity.reference[0]), xycoords=("axes fraction", "data"),
                            xytext=(0, 2), textcoords="offset points", fontsize=style.TYPE)
        if not is_there:
            ax.text(0.5, 0.5, "nothing to show", transform=ax.transAxes, ha="center", va="center")
        mode = "regimes" if quantity.mode in ("peaks", "bands") else quantity.mode
        draw_curves(ax, quantity.curves, mode, quantity.common, is_marked)
        if mode == "stability" and len({curve.name for curve in quantity.curves}) > 1:
            spread_marks(ax, quantity.curves)
        return ax

    def left_edge(self, axes_of_y):
        return 0.5 + 0.2 + max(ticks.label_width(self.measure) for _, _, _, ticks, _ in axes_of_y)

    def response(self, quantity):
        """The whole range in one panel and, below it, the ranges where peaks crowd."""
        windows = [] if self.options.ranges else find_windows(quantity.curves, self.x_low, self.x_high, self.x_is_log)
        key = self.key([quantity])
        upper = 4.2 if windows else 5.4
        below = 3.1 + 1.1 if windows else 0
        scale = self.row_scale(upper + below, BOTTOM + 0.45 + key.height)
        upper, lower = upper * scale, 3.1 * scale
        base = BOTTOM + (lower + 1.1 if windows else 0)
        top = base + upper
        whole = (self.x_low, self.x_high)
        left = self.left_edge([self.y_axis(quantity, *r, upper) for r in [whole, *windows[:1]]])
        page = Page(self.width, top + 0.45 + key.height, self.measure)
        key.place(page, left, self.right)
        page.upright(0.25, (base + top) / 2, quantity.title, top - base + 0.6)
        page.text((left + self.right) / 2, 0.25, self.x_title, self.width - 0.4, ha="center")
        in_window = lambda x: np.any([(x >= a) & (x <= b) for a, b in windows], axis=0)  # noqa: E731
        ax = self.panel(page, quantity, (left, self.right, base, top), whole, shades=windows,
                        is_marked=(lambda x: ~in_window(x)) if windows else None)
        if not windows:
            return page.figure
        page.text(0.25, top + 0.22, "a", ha="center", fontweight="bold")
        for letter, window in zip(LETTERS[1:], windows):
            centre = ax.transData.transform((np.sqrt(window[0] * window[1]) if self.x_is_log else np.mean(window), 1))[0]
            page.text(centre / page.figure.dpi * 2.54, top + 0.22, letter, ha="center", fontweight="bold")
        self._enlarged(page, quantity, windows, left, BOTTOM + lower)
        return page.figure

    def _enlarged(self, page, quantity, windows, left, top):
        measured = [self.y_axis(quantity, *window, top - BOTTOM) for window in windows]
        second = 0.55 + measured[-1][3].label_width(self.measure)
        half = (self.right - left - second) / 2
        edges = [(left, self.right)] if len(windows) == 1 else [(left, left + half), (self.right - half, self.right)]
        page.upright(0.25, (BOTTOM + top) / 2, quantity.short, top - BOTTOM)
        for number, (window, (a, b)) in enumerate(zip(windows, edges)):
            self.panel(page, quantity, (a, b, BOTTOM, top), window)
            page.text(0.25 if number == 0 else a - second + 0.2, top + 0.22, LETTERS[number + 1], ha="center", fontweight="bold")

    def phases(self, quantities):
        """Rows of quantities over the whole range and, beside it, where the peaks of the first crowd."""
        windows = [] if self.options.ranges else find_windows(quantities[0].curves, self.x_low, self.x_high, self.x_is_log)
        if not windows:
            return self.panels(quantities)
        key = self.key(quantities)
        row = 2.4 * self.row_scale(2.4 * len(quantities), BOTTOM + 0.45 + key.height)
        left, top = 1.55, BOTTOM + row * len(quantities)
        page = Page(self.width, top + 0.45 + key.height, self.measure)
        key.place(page, left, self.right)
        page.text((left + self.right) / 2, 0.25, self.x_title, self.width - 0.4, ha="center")
        beside = (self.right - left) * (0.46 if len(windows) == 1 else 0.27)
        edges = [self.right - beside * (len(windows) - i) for i in range(len(windows))]
        columns = [(left, edges[0] - 0.3), *[(edge + 0.05, edge + beside) for edge in edges]]
        in_window = lambda x: np.any([(x >= a) & (x <= b) for a, b in windows], axis=0)  # noqa: E731
        for number, quantity in enumerate(quantities):
            high = top - number * row
            low_y, high_y, ticks = _in_half_turns(quantity, row)
            page.upright(0.25, high - row / 2, quantity.title, row)
            for i, ((a, b), x_range) in enumerate(zip(columns, [(self.x_low, self.x_high), *windows])):
                ax = self.panel(page, quantity, (a, b, high - row, high), x_range, has_labels=number == len(quantities) - 1,
                                is_marked=None if i else lambda x: ~in_window(x), shades=() if i else windows)
                ticks.apply(ax.yaxis, i == 0)
                ax.set_ylim(low_y, high_y)
                if number == 0:
                    page.text(a + 0.1 if i == 0 else (a + b) / 2, top + 0.22, LETTERS[i], ha="center", fontweight="bold")
        return page.figure

    def row_scale(self, rows, fixed):
        """How much taller rows are than by themselves, where a height is asked for."""
        return max(0.3, (self.options.size[1] - fixed) / rows) if self.options.size else 1.0

    def panels(self, quantities, more=()):
        """Several quantities, one above the other."""
        count = len(quantities)
        row = {1: 5.4, 2: 3.6}.get(count, 2.8)
        key = self.key(quantities, more)
        whole = (self.x_low, self.x_high)
        has_power = any(self.y_axis(quantity, *whole, row)[3].common_power for quantity in quantities)
        gap, head = (0.45, 0.42) if has_power else (0.25, 0.15)
        row *= self.row_scale(row * count, BOTTOM + (count - 1) * gap + head + key.height)
        left = self.left_edge([self.y_axis(quantity, *whole, row) for quantity in quantities])
        top = BOTTOM + count * row + (count - 1) * gap
        page = Page(self.width, top + head + key.height, self.measure)
        key.place(page, left, self.right)
        page.text((left + self.right) / 2, 0.25, self.x_title, self.width - 0.4, ha="center")
        for number, quantity in enumerate(quantities):
            high = top - number * (row + gap)
            page.upright(0.25, high - row / 2, quantity.title, row + (0.4 if count == 1 else 0))
            self.panel(page, quantity, (left, self.right, high - row, high), whole, has_labels=number == count - 1)
        return page.figure


def _in_half_turns(quantity, length):
    """The range of phases over pi, ended at whole halves, with some room, and its ticks."""
    bounds = spread(np.concatenate([curve.y for curve in quantity.curves])) or (0.0, 1.0)
    low, high = np.floor(2 * bounds[0] + 0.1) / 2, np.ceil(2 * bounds[1] - 0.1) / 2
    high = high if high > low else low + 0.5
    low, high = low - 0.09 * (high - low), high + 0.09 * (high - low)
    return low, high, Ticks(low, high, length, False, True, len)
