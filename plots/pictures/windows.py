"""The ranges where peaks crowd, or a single branch slips, too narrow to be seen in the whole."""

import numpy as np

from .axes import place_of, value_at

BINS = 500
CROWD = 35  # bins: 7 % of the axis


def _bin(place):
    return np.clip((np.asarray(place) * BINS).astype(int), 0, BINS - 1)


def _margined(low, high):
    margin = max(0.6 * (high - low), 0.004)
    return max(low - margin, 0), min(high + margin, 1)


def _crowds(places):
    for _ in range(2):
        counts = np.bincount(_bin(places), minlength=BINS)
        sums = np.convolve(counts, np.ones(CROWD, dtype=int), "valid")
        if not len(places) or sums.max() <= 1:
            return
        begin = int(sums.argmax())
        there = places[(_bin(places) >= begin) & (_bin(places) < begin + CROWD)]
        low, high = _margined(there.min(), there.max())
        places = places[(_bin(places) < _bin(low)) | (_bin(places) > _bin(high))]
        yield low, high


def _slips(curve, low, high, is_log):
    here = np.flatnonzero(curve.told[:-1])
    if not len(here):
        return
    ends = np.flatnonzero(np.diff(here) > 1)
    for first, last in zip(here[np.r_[0, ends + 1]], here[np.r_[ends, len(here) - 1]] + 1):
        a, b = sorted(place_of(low, high, curve.x[[first, last]], is_log))
        if b - a < 0.05:
            yield _margined(a, b)


def find_windows(curves, low, high, is_log):
    """Two at most, from left to right, each as (low, high) in units of the axis from `low` to `high`."""
    peaks = [place_of(low, high, curve.x[curve.special.get("peak", [])], is_log) for curve in curves]
    places = np.concatenate(peaks) if peaks else np.array([])
    found = list(_crowds(places[(places >= 0) & (places <= 1)]))
    if not found and len(curves) == 1:
        found = list(_slips(curves[0], low, high, is_log))[:2]
    found = sorted(found)
    if len(found) == 2 and found[0][1] > found[1][0]:
        middle = 0.5 * (found[0][1] + found[1][0])
        found = [(found[0][0], middle), (middle, found[1][1])]
    return [tuple(value_at(low, high, place, is_log) for place in window) for window in found]
