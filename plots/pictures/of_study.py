"""Which pictures there are of a preload study, and what they show."""

import os

import numpy as np

from . import style, words
from .axes import is_wide, spread, with_room
from .curves import Curve
from .draw import Quantity, Sheet
from .maps import draw_map
from .page import area_entry, line_entry
from .tables import Refused, Table, unknown_column, unknown_columns

MOST_CURVES = 200  # in one picture: more cannot be told apart
MOST_BANDS = 3
HIGHEST = "highest peak  " + words.SYMBOLS["ratio_opt"][0]
UNMARKED = {"ratio": ["birth", "death", "exchange", "corner"], "peaks": ["corner"]}


class Designs:
    """What optimum.csv has, by the keys whose values are not the same in all."""

    def __init__(self, folder):
        self.table = Table(os.path.join(folder, "optimum.csv"), ["curve", "P_opt", "ratio_opt", "kind"], "designs")
        names = self.table.columns[1 : self.table.columns.index("P_opt")]
        values = dict(zip(names, self.table.read(names)))
        self.values = {name: column for name, column in values.items() if len(set(column.tolist())) > 1}
        self.keys = list(self.values)
        (self.curve,) = self.table.read(["curve"])
        self.count = len(self.curve)
        self.is_numeric = all(column.dtype == float for column in self.values.values())
        self.looks = [style.Look(i, self.count) for i in range(self.count)]

    def label(self, i):
        return words.label({key: self.values[key][i] for key in self.keys}, self.keys)

    def is_grid(self):
        """Whether every value of the first key stands with every value of the second, which runs faster."""
        if not self.is_numeric or len(self.keys) != 2:
            return False
        first, second = self.values.values()
        many = len(set(second.tolist()))
        if len(set(first.tolist())) * many != self.count:
            return False
        first, second = first.reshape(-1, many), second.reshape(-1, many)
        return bool((first == first[:, :1]).all() and (second == second[:1]).all())

    def rises_or_falls(self):
        steps = np.diff(self.values[self.keys[0]])
        return bool((steps > 0).all() or (steps < 0).all())


class PicturesOfStudy:
    """Decides, and draws, what there is to see of a study."""

    def __init__(self, folder, case, options, measure):
        self.folder, self.options, self.measure = folder, options, measure
        self.designs = Designs(folder)
        self.objective = words.symbol(case["study"].get("objective", "Y"))
        self.has_sweep = case["study"]["sweep"] and self.designs.count <= MOST_CURVES

    def pictures(self):
        designs, all_pictures = self.designs, {}
        if self.has_sweep:
            self._sweep_table()
            all_pictures = {"ratio": lambda: self._over_preload("ratio"), "peaks": lambda: self._over_preload("peaks")}
        if designs.is_grid():
            all_pictures["optimum_preload"] = lambda: self._map(self._preload())
            all_pictures["attenuation"] = lambda: self._map(self._height(designs.table, "ratio_opt", "Y_opt")[0])
        elif designs.is_numeric and designs.keys and (len(designs.keys) == 1 or designs.rises_or_falls()):
            all_pictures["optimum"] = self._optimum
        if os.path.exists(os.path.join(self.folder, "quantiles.csv")):
            all_pictures["quantiles"] = self._quantiles
        return all_pictures

    def nothing(self):
        return Refused(f"{self.designs.table.path}: nothing to draw; expected sweep.csv of at most {MOST_CURVES} designs "
                       "beside it, or one or two keys of for_each with numbers")

    def _sheet(self, x, values, *, room=False, x_title=None):
        low, high = spread(values) or (0.1, 1.0)
        is_log = is_wide(low, high)
        if room:
            low, high = with_room(low, high, 0.04, 0.04, is_log)
        return Sheet(self.options, self.measure, x_title or words.axis_title(x), (low, high))

    def _preload(self):
        return self.designs.table.preload("P_opt")

    def _height(self, table, over_free, alone):
        """The column of heights over that of the free base, or alone where that has none, and their symbol."""
        if alone not in table.columns or np.isfinite(table.read([over_free])[0]).any():
            return over_free, words.SYMBOLS[over_free][0]
        return alone, self.objective

    def _best_title(self, column):
        return words.axis_title("P_opt") if column == "P_opt" else f"best preload  ({words.unit_of(column)[1]})"

    # ---- Peaks over the preload ----

    def _sweep_table(self):
        columns = ["curve", "peak_branch", "P", "eta_peak", "ratio", "is_global", "type"]
        return Table(os.path.join(self.folder, "sweep.csv"), columns, "peaks")

    def _curves(self, table, x, y, mode, unmarked=()):
        curve, branch, xs, ys, top, types = table.read(["curve", "peak_branch", x, y, "is_global", "type"])
        highest = (top == 1) | (types == "exchange")  # there both peaks are as high
        begins = (np.diff(curve) != 0) | (np.diff(branch) != 0)
        starts = np.r_[0, np.flatnonzero(begins) + 1]
        number = {value: i for i, value in enumerate(self.designs.curve)}
        kinds = [kind for kind in set(types) if kind in style.KINDS and kind not in unmarked]
        made = []
        for a, b in zip(starts, np.r_[starts[1:], len(curve)]):
            part = slice(a, b)
            told = highest[part] & np.r_[highest[part][1:], False]
            special = {kind: np.flatnonzero((types[part] == kind) & (highest[part] | (mode != "envelope"))) for kind in kinds}
            i = number.get(curve[a], 0)
            made.append(Curve(xs[part], ys[part], told, {k: v for k, v in special.items() if len(v)}, self.designs.looks[i],
                              self.designs.label(i)))
        return made

    def _over_preload(self, name):
        table = self._sweep_table()
        x = table.preload()
        eta = "frequency_Hz" if "frequency_Hz" in table.columns else "eta_peak"
        mode = "envelope" if name == "ratio" else "peaks"
        height, symbol = self._height(table, "ratio", "Y_max")
        highest = HIGHEST if height == "ratio" else f"highest peak  {symbol}"
        rows = [(height, highest)] if name == "ratio" else [(height, f"peaks  {symbol}"), (eta, words.axis_title(eta))]
        quantities = [Quantity(self._curves(table, x, y, mode, UNMARKED[name]), mode, title) for y, title in rows]
        return self._sheet(x, table.read([x])[0]).panels(quantities)

    # ---- The optimum over keys ----

    def _optimum(self):
        designs = self.designs
        key, column = designs.keys[0], self._preload()
        (kinds,) = designs.table.read(["kind"])
        xs = designs.values[key]
        look = style.Look(0, 1)
        rises = designs.rises_or_falls()
        marks = [kind for kind in style.KINDS if kind.startswith("optimum ")] if len(xs) <= 60 or not rises else []
        quantities = []
        height, symbol = self._height(designs.table, "ratio_opt", "Y_opt")
        for name, title in [(column, self._best_title(column)), (height, f"highest peak  {symbol}")]:
            (ys,) = designs.table.read([name])
            special = {kind: np.flatnonzero(kinds == kind.partition(" ")[2]) for kind in marks}
            special = {kind: rows for kind, rows in special.items() if len(rows)}
            told = np.full(len(xs), rises)
            quantities.append(Quantity([Curve(xs, ys, told, special, look)], "envelope" if not rises else "plain", title))
            if not rises:
                quantities[-1].mode = "plain"
                quantities[-1].curves = [Curve(xs[i : i + 1], ys[i : i + 1], told[i : i + 1],
                                               {k: np.array([0]) for k, rows in special.items() if i in rows}, look)
                                         for i in range(len(xs))]
        return self._sheet(key, xs, room=True).panels(quantities)

    def _map(self, column):
        designs = self.designs
        keys = designs.keys
        z, kinds = designs.table.read([column, "kind"])
        is_preload = column == self._preload()
        _, symbol = self._height(designs.table, "ratio_opt", "Y_opt")
        title = self._best_title(column) if is_preload else f"highest peak  {symbol}"
        z = np.where((kinds == "flat") & is_preload, np.nan, z)
        notes = ["no single best preload"] * bool(is_preload and (kinds == "flat").any())
        notes += ["not found"] * bool((kinds == "failed").any())
        axes = [(designs.values[key], words.axis_title(key)) for key in keys]
        return draw_map(self.options, self.measure, axes, z, title, notes)

    # ---- Scatter ----

    def _quantiles(self):
        """The highest peak under scatter: bands between the outermost quantiles, each quantile a line."""
        table = Table(os.path.join(self.folder, "quantiles.csv"), ["curve", "P"], "preloads")
        names = [name for name in table.columns if name.startswith("ratio_q")] or [
            name for name in table.columns if name.startswith("Y_q")]
        names.sort(key=lambda name: float(name.rpartition("q")[2]))
        x = table.preload()
        curve, xs, *levels = table.read(["curve", x, *names])
        chosen = list(dict.fromkeys(curve.tolist()))[:MOST_BANDS]
        middle = len(names) // 2
        quantities, bands = [], []
        for i, value in enumerate(chosen):
            rows = curve == value
            look = style.Look(i, max(2, len(chosen)))
            name = self.designs.label(int(np.flatnonzero(self.designs.curve == value)[0]))
            bands.append((xs[rows], levels[0][rows], levels[-1][rows], style.mixed(look.colour, "#FFFFFF", 0.8)))
            for k, level in enumerate(levels):
                quantities.append(Curve(xs[rows], level[rows], np.full(rows.sum(), k == middle), {}, look, name))
        percent = [name.rpartition("q")[2] for name in names]
        title = "highest peak  " + (words.SYMBOLS["ratio"][0] if names[0].startswith("ratio") else "$Y$")
        quantity = Quantity(quantities, "regimes", title)
        quantity.mode, quantity.common = "bands", []
        for made in quantities:
            made.is_common = False
        sheet = self._sheet(x, xs)
        more = [line_entry(f"{percent[middle]} % stay below", style.GREY, style.THICK)]
        if len(names) > 1:
            more += [line_entry(f"{percent[0]} %, {percent[-1]} %", style.GREY, style.THIN),
                     area_entry("between them", style.SHADE)]
        figure = sheet.panels([quantity], more)
        for x_values, low, high, colour in bands:
            figure.axes[0].fill_between(x_values, low, high, color=colour, linewidth=0, zorder=1)
        return figure

    def custom(self):
        """Columns of sweep.csv, or of optimum.csv over a key, that are asked for."""
        options = self.options
        names = [name for name in [options.x, *options.y] if name]
        tables = ([self._sweep_table()] if self.has_sweep else []) + [self.designs.table]
        table = next((table for table in tables if table.has(*names)), None)
        if table is None:
            raise unknown_columns(names, tables)
        is_sweep = self.has_sweep and table is tables[0]
        x = options.x or ("P" if is_sweep else (self.designs.keys or ["P_opt"])[0])
        columns = options.y or ["ratio" if is_sweep else "ratio_opt"]
        for name in [x, *columns]:
            if table.read([name])[0].dtype != float:
                raise unknown_column(name, table, "holds no numbers")

        def drawn():
            (xs,) = table.read([x])
            made = []
            for name in columns:
                if is_sweep:
                    curves = self._curves(table, x, name, "peaks")
                else:
                    order = np.argsort(xs, kind="stable")
                    curves = [Curve(xs[order], table.read([name])[0][order], np.full(len(xs), True), {}, style.Look(0, 1))]
                made.append(Quantity(curves, "peaks" if is_sweep else "plain", words.axis_title(name)))
            return self._sheet(x, xs, room=True).panels(made)

        return {f"{'_'.join(columns)}_over_{x}": drawn}
