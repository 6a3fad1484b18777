"""A page: panels placed in cm, and above them the key, laid out by the measured widths of its texts."""

import math

from matplotlib.figure import Figure
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.font_manager import FontProperties
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle

from . import style
from .axes import Measure
from .words import plain

SAMPLE = 0.65  # of a line
MARK = 0.26  # room for a symbol
BLANK = 0.1
GAP = 0.35  # between entries


def new_measure():
    figure = Figure(dpi=300)
    return Measure(FigureCanvasAgg(figure).get_renderer(), FontProperties(family="DejaVu Sans", size=style.TYPE))


class Entry:
    """Of the key: a text behind a sample, of which `artists` gives what it consists of, from x to x + width at y in cm."""

    def __init__(self, text, width, artists):
        self.text, self.sample, self.artists = text, width, artists


def line_entry(text, colour, width, dash=style.SOLID, mark=None):
    dash = (0, tuple(d * max(width, 0.9) for d in dash[1]))
    return Entry(text, SAMPLE, lambda x, y: [dict(
        xdata=[x, x + SAMPLE / 2, x + SAMPLE], ydata=[y] * 3, color=colour, linewidth=width, linestyle=dash, marker=mark,
        markevery=[1], markersize=3.4, markerfacecolor="white", markeredgewidth=0.7)])


def mark_entry(text, kind, colour=style.GREY):
    _, shape, size, is_filled = style.KINDS[kind]
    return Entry(text, MARK, lambda x, y: [dict(
        xdata=[x + MARK / 2], ydata=[y], color=colour, marker=shape, markersize=size, linestyle="none",
        markerfacecolor=colour if is_filled else "white", markeredgewidth=0.2 if is_filled else 0.7)])


def area_entry(text, colour):
    return Entry(text, SAMPLE, lambda x, y: [dict(area=(x, y - 0.11, SAMPLE, 0.22), color=colour)])


class Key:
    """The names of curves in columns, then what lines and symbols tell, in few lines of about the same length."""

    def __init__(self, named, told, width, measure):
        self.measure = measure
        self.width = width - 0.2
        self.named = [self._cut(entry) for entry in named]
        self.told = [self._cut(entry) for entry in told]
        column = max([self._width(entry) for entry in self.named], default=0) + GAP
        self.column = column
        columns = max(1, int((self.width + GAP) / column)) if self.named else 1
        self.name_lines = math.ceil(len(self.named) / columns)
        self.columns = math.ceil(len(self.named) / self.name_lines) if self.named else 1  # lines of the same length
        self.lines = self._balanced()
        self.height = (self.name_lines + len(self.lines)) * style.LINE + 0.08

    def _width(self, entry):
        return entry.sample + BLANK + self.measure(entry.text)

    def _length(self, entries):
        return sum(self._width(entry) + GAP for entry in entries) - GAP

    def _filled(self, width):
        """What is told in lines up to so long."""
        lines = [[]]
        for entry in self.told:
            if lines[-1] and self._length([*lines[-1], entry]) > width:
                lines.append([])
            lines[-1].append(entry)
        return [line for line in lines if line]

    def _balanced(self):
        """The same in as few lines as there may be, none much longer than the others."""
        widest = self._filled(self.width)
        lengths = {self._length(self.told[i:j]) for i in range(len(self.told)) for j in range(i + 1, len(self.told) + 1)}
        balanced = (self._filled(length) for length in sorted(lengths) if length <= self.width)
        return next((lines for lines in balanced if len(lines) == len(widest)), widest)

    def _cut(self, entry):
        """One that is too long for the page ends with an ellipsis."""
        room = self.width - entry.sample - BLANK
        if self.measure(entry.text) > room:
            text = plain(entry.text)
            while self.measure(text + "…") > room:
                text = text[:-1]
            entry = Entry(text + "…", entry.sample, entry.artists)
        return entry

    def place(self, page, left, right):
        """Sets it on the top of a page, centred between `left` and `right` where there is room."""

        def start(length):
            return 0.5 * (left + right - length) if length <= right - left else 0.5 * (page.width - length)

        top = page.height - 0.04
        for i, entry in enumerate(self.named):
            x = start(self.columns * self.column - GAP) + i % self.columns * self.column
            page.entry(entry, x, top - (i // self.columns + 0.5) * style.LINE)
        for number, line in enumerate(self.lines):
            x = start(self._length(line))
            for entry in line:
                page.entry(entry, x, top - (self.name_lines + number + 0.5) * style.LINE)
                x += self._width(entry) + GAP


class Page:
    """A figure with lengths in cm from its lower left corner."""

    def __init__(self, width, height, measure):
        self.width, self.height, self.measure = width, height, measure
        self.figure = Figure(figsize=(width / 2.54, height / 2.54), dpi=300)
        FigureCanvasAgg(self.figure)

    def panel(self, left, right, bottom, top):
        return self.figure.add_axes(
            [left / self.width, bottom / self.height, (right - left) / self.width, (top - bottom) / self.height])

    def text(self, x, y, text, length=None, **more):
        """Text, smaller where it would be longer than `length`."""
        size = style.TYPE
        if length and self.measure(text) > length:
            size = max(4.5, style.TYPE * length / self.measure(text))
        more = {"va": "center", "fontsize": size, **more}
        return self.figure.text(x / self.width, y / self.height, text, **more)

    def upright(self, x, y, text, length=None):
        return self.text(x, y, text, length, rotation="vertical", ha="center")

    def entry(self, entry, x, y):
        for parts in entry.artists(x, y):
            if "area" in parts:
                left, bottom, width, height = parts["area"]
                self.figure.add_artist(Rectangle(
                    (left / self.width, bottom / self.height), width / self.width, height / self.height,
                    facecolor=parts["color"], edgecolor="none", transform=self.figure.transFigure))
                continue
            xs = [value / self.width for value in parts.pop("xdata")]
            ys = [value / self.height for value in parts.pop("ydata")]
            self.figure.add_artist(Line2D(xs, ys, transform=self.figure.transFigure, **parts))
        self.text(x + entry.sample + BLANK, y, entry.text, ha="left", va="center").set_gid("key")
