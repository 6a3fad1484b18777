"""Ranges, scales and ticks of axes. Labels are measured, and set where they fit."""

import math

import numpy as np
from matplotlib.ticker import FixedFormatter, FixedLocator

from .style import TYPE

CM = 72 / 2.54  # points
SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
WIDE = 4  # the ratio of largest to smallest from which an axis is logarithmic


def is_wide(low, high, wide=WIDE):
    """Whether a range is worth a logarithmic axis."""
    return low > 1e-17 * high and high > wide * low and low > 0


def place_of(low, high, value, is_log):
    """The place of a value on an axis, from 0 to 1."""
    if is_log:
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.log(value / low) / math.log(high / low)
    return (value - low) / (high - low)


def value_at(low, high, place, is_log):
    return low * (high / low) ** place if is_log else low + place * (high - low)


def spread(values):
    """The range of the values that are defined; about a single one, but for rounding errors, some room; or None."""
    values = values[np.isfinite(values)]
    if not len(values):
        return None
    low, high = float(values.min()), float(values.max())
    if high - low <= 1e-9 * (abs(low) + abs(high)) or (low <= 0 and high - low < 1e-12):
        return tuple(v + side * (0.1 * abs(v) if abs(v) > 1e-12 else 1) for v, side in ((low, -1), (high, 1)))
    return low, high


def with_room(low, high, below, above, is_log):
    """The range with these parts of it added."""
    return value_at(low, high, -below, is_log), value_at(low, high, 1 + above, is_log)


def power_text(power):
    return "10" + str(power).translate(SUPERSCRIPTS)


class Ticks:
    """Of an axis from `low` to `high`, `length` cm long, whose labels `measure` tells the width of, in cm.

    `common_power` is the k of the 10^k in which the labels are counted, 0 mostly.
    """

    def __init__(self, low, high, length, is_log, is_upright, measure):
        self.low, self.high, self.length = low, high, length
        self.room = (lambda text: 0.55) if is_upright else (lambda text: measure(text) + 0.25)
        self.common_power = 0
        self.major, self.labels, self.minor = [], [], []
        self._set_log() if is_log else self._set_linear(is_upright)

    def _inside(self, value):
        return self.low * (1 - 1e-9) <= value <= self.high * (1 + 1e-9)

    def _set_log(self):
        decades = math.log10(self.high / self.low)
        is_plain = decades <= 3.2 and self.low >= 1e-3 and self.high < 1e4
        powers = range(math.floor(math.log10(self.low)) - 1, math.ceil(math.log10(self.high)) + 1)
        text_of = (lambda m, k: f"{m * 10.0**k:g}") if is_plain else lambda m, k: (
            power_text(k) if m == 1 else f"{m}·{power_text(k)}")
        choices = [(1, 2, 3, 4, 5, 6, 7, 8, 9)] if decades < 0.8 else []
        choices += [(1, 2, 5), (1, 3)] if is_plain or decades < 1.5 else []
        every = 1
        for steps in [*choices, *[(1,)] * 40]:
            chosen = [(m, k) for k in powers for m in steps if k % every == 0 and self._inside(m * 10.0**k)]
            if self._fits([math.log10(m * 10.0**k / self.low) / decades for m, k in chosen], [text_of(*c) for c in chosen]):
                break
            every += steps == (1,)
        if len(chosen) < 2 and decades < 1.5:
            return self._set_linear(False)
        self.major = [m * 10.0**k for m, k in chosen]
        self.labels = [text_of(m, k) for m, k in chosen]
        parts = range(1, 10) if decades < 8 else [1]
        self.minor = [m * 10.0**k for k in powers for m in parts if self._inside(m * 10.0**k)]

    def _fits(self, places, texts):
        rooms = [self.room(text) for text in texts]
        gaps = [self.length * (b - a) for a, b in zip(places, places[1:])]
        return all(gap >= (a + b) / 2 for gap, a, b in zip(gaps, rooms, rooms[1:]))

    def _set_linear(self, is_upright):
        largest = max(abs(self.low), abs(self.high))
        span = self.high - self.low
        self.common_power = math.floor(math.log10(largest)) if is_upright and not 0.05 <= largest < 1e4 else 0
        size = 10.0**self.common_power
        top = math.floor(math.log10(span))
        for step, parts in [(m * 10.0 ** (top + k), n) for k in (-2, -1, 0, 1) for m, n in ((1, 5), (2, 4), (5, 5))]:
            numbers = range(math.ceil(self.low / step - 1e-9), math.floor(self.high / step + 1e-9) + 1)
            if len(numbers) > 60:
                continue
            texts = [f"{n * step / size:.9g}".replace("-", "−") for n in numbers]
            chosen = (numbers, texts, step, parts)
            if self._fits([(n * step - self.low) / span for n in numbers], texts):
                break
            if len(numbers) <= 2:
                break
        numbers, self.labels, step, parts = chosen
        self.major = [n * step for n in numbers]
        fine = step / parts
        count = range(math.ceil(self.low / fine), math.floor(self.high / fine) + 1)
        self.minor = [] if len(count) > 200 else [n * fine for n in count]

    def apply(self, axis, is_labelled=True):
        axis.set_major_locator(FixedLocator(self.major))
        axis.set_major_formatter(FixedFormatter(self.labels if is_labelled else [""] * len(self.labels)))
        axis.set_minor_locator(FixedLocator(self.minor))
        axis.set_minor_formatter(FixedFormatter([]))

    def label_width(self, measure):
        return max([measure(text) for text in self.labels], default=0)


class Measure:
    """The width of texts in cm, as they are drawn."""

    def __init__(self, renderer, properties):
        self._renderer = renderer
        self._properties = properties
        self._known = {}

    def __call__(self, text, size=TYPE):
        if not text:
            return 0.0
        if text not in self._known:
            width, _, _ = self._renderer.get_text_width_height_descent(
                text, self._properties, _markup(text))
            self._known[text] = width / self._renderer.dpi * 2.54
        return self._known[text] * size / TYPE


def _markup(text):
    return text.count("$") >= 2
