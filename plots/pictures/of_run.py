"""Which pictures there are of a run, and what they show."""

import numpy as np

from . import words
from .draw import Quantity, Sheet
from .run import followed
from .axes import is_wide, spread, with_room
from .tables import PRELOADS, unknown_column

LINES = {
    **{"fold": "folds", "branch_point": "branch points", "hopf": "Hopf points", "peak": "peaks", "trough": "troughs"},
    **{"switch": words.R_IS_S, "phase_resonance": "phase resonances", "cycle_fold": "folds of cycles"},
    **{"period_doubling": "period doublings", "neimark_sacker": "Neimark-Sacker points"},
}
SI = {"eta": ["frequency_Hz"], "P": PRELOADS, "Y": ["Y_m"], "U": ["U_m"], "R": ["R_m"]}


class PicturesOfRun:
    """Decides, and draws, what there is to see of a run."""

    def __init__(self, data, options, measure):
        self.data, self.options, self.measure = data, options, measure

    def pictures(self):
        """Names, each with what draws it."""
        data, branch = self.data, self.data.branch
        if "curve" in branch:
            return self._of_curves()
        parameter = branch["parameter"]
        if not data.is_friction:
            mode = "stability" if data.table.has("unstable") else "plain"
            return {"branch": lambda: self._panels(parameter, mode, self._observables(parameter))}
        response = branch.get("response", "forced")
        if response == "limit_cycle":
            return {"limit_cycle": lambda: self._panels(parameter, "plain", ["R_over_S", "eta"])}
        if response == "nonlinear_mode":
            x = "R_over_S" if parameter == "R" else parameter
            return {"nonlinear_mode": lambda: self._panels(x, "plain", ["eta", "zeta"])}
        data.table.require([parameter, "S", "R_over_S", "Y", "beta", "alpha", "psi", "dissipated"])
        x = self.x_column(parameter)
        mode = "stability" if data.table.has("unstable") else "regimes"
        return {name: lambda draw=getattr(self, f"_{name}"): draw(x, mode)
                for name in ("amplitude", "relative", "phases", "phase_difference", "dissipated")}

    # ---- Axes ----

    def x_column(self, parameter):
        """In SI units where the table has them."""
        return next((name for name in SI.get(parameter, []) if name in self.data.table.columns), parameter)

    def y_column(self, name):
        column = self.x_column(name)
        if column == name:
            return name
        (values,) = self.data.columns(column)
        return words.well_sized(column, np.nanmax(np.abs(values), initial=0))

    def title(self, column):
        text = words.axis_title(column, self.data.is_friction)
        is_relative = self.data.system.get("model") in ("rods", "beams")
        return text.replace(r"$\eta$", r"$\eta = \omega/\Omega_\mathrm{D}$") if column == "eta" and is_relative else text

    def sheet(self, x, lines_title="", titles=None):
        (values,) = self.data.columns(x)
        low, high = spread(values) or (0.0, 1.0)
        first, last = self.data.ends(x)
        is_log = is_wide(low, high)
        low, high = with_room(low, high, 0.04 if low < first or lines_title else 0, 0.04 if high > last or lines_title else 0,
                              is_log)
        return Sheet(self.options, self.measure, self.title(x), (low, high), lines_title=lines_title, titles=titles)

    # ---- Pictures of forced responses ----

    def _amplitude(self, x, mode):
        column = self.y_column("Y")
        curves = self.data.curves(x, column, mode)
        return self.sheet(x).response(Quantity(curves, mode, words.axis_title(column), words.short_title(column)))

    def _relative(self, x, mode):
        quantity = Quantity(self.data.curves(x, "R_over_S", mode), mode, words.axis_title("R_over_S"), "$R/S$",
                            reference=(1, words.R_IS_S))
        return self.sheet(x).response(quantity)

    def _phase_difference(self, x, mode):
        curves = self.data.curves(x, (("alpha", "beta"), lambda a, b: followed(a - b)), mode)
        return self.sheet(x).response(
            Quantity(curves, mode, r"phase difference  $(\alpha - \beta)/\pi$", r"$(\alpha - \beta)/\pi$", is_linear=True))

    def _dissipated(self, x, mode):
        """Nothing is lost in stick, nor at its ends but for rounding."""
        least = 4e-5  # over k S^2, as in one harmonic where R/S is 1 + 1e-5
        if "dissipated_J" in self.data.table.columns:
            (joules,) = self.data.columns("dissipated_J")
            column = words.well_sized("dissipated_J", np.nanmax(np.abs(joules), initial=0))
            other, energy, title, short = column, lambda d, e: e, words.axis_title(column), words.short_title(column)
        else:
            other, energy, title = "S", lambda d, s: d * s**2, "dissipated energy over $k$"
            if self.data.system.get("harmonics", 1) in (1, [1]):
                title = "dissipated  $4S\\,(R - S)$"
            short = title.replace("dissipated  ", "")
        known = (("dissipated", other), lambda d, value: np.where(d > least, energy(d, value), np.nan))
        curves = self.data.curves(x, known, mode, ["switch"])
        if mode == "regimes":
            for curve in curves:
                curve.told[:] = True
        return self.sheet(x).response(Quantity(curves, mode, title, short))

    def _phases(self, x, mode):
        parts = {"beta": "base", "alpha": "damper", "psi": "relative"}
        quantities = [Quantity(self.data.curves(x, ((name,), followed), mode), mode,
                               f"{title}  {words.symbol(name)}$\\,/\\pi$", is_linear=True) for name, title in parts.items()]
        return self.sheet(x).phases(quantities)

    # ---- Others ----

    def _observables(self, parameter):
        """Those whose extrema are asked for come first; then what is neither a setting nor said of the step."""
        found = list(self.data.branch.get("extrema_of", []))
        for name in self.data.table.columns[4:]:
            if name in ("unstable", "arclength"):
                break
            unknown, _, end = name.rpartition("_")
            if end in ("max", "min") and self.data.ends_of([unknown]):
                name = unknown  # both ends in one panel
            if name != parameter and name not in self.data.system and name not in found:
                found.append(name)
        return found[:3]

    def _panels(self, x, mode, columns, lines_title="", titles=None):
        self.data.table.require([x, "arclength", *(name for name in columns if not self.data.ends_of([name]))])
        unmarked = [kind for kind, title in (titles or {}).items() if not title]
        quantities = [Quantity(self.data.curves(x, column, mode, unmarked), mode, self.title(column), wide=20)
                      for column in columns]
        if lines_title:
            for quantity in quantities:
                _leave_out_turns_at_cusps(quantity.curves)
        return self.sheet(x, lines_title, titles).panels(quantities)

    def _of_curves(self):
        branch, data = self.data.branch, self.data
        first, second = branch["parameters"]
        kind = branch["curve"]
        is_ridge = kind in ("peak", "trough")
        height = words.symbol(branch.get("extrema_of", ["Y"])[0] if is_ridge else first, data.is_friction)
        titles = {"fold": f"fold in {words.symbol(second, data.is_friction)}", "peak": f"peak of {height}",
                  "trough": f"trough of {height}", "user": "requested" if data.is_requested else ""}
        lines = words.plain(branch["level_of"]) if kind == "level" else LINES[kind]
        has_regimes = data.is_friction and kind != "switch" and branch.get("response", "") != "limit_cycle"
        mode = "regimes" if has_regimes else "plain"
        data.table.require([first, second, "arclength"])
        pictures = {"curve": lambda: self._panels(first, mode, [second], lines, titles)}
        if data.is_friction:
            pictures["amplitude"] = lambda: self._panels(second, mode, ["Y"], lines, titles)
        return pictures

    def custom(self):
        """Columns that are asked for, over another."""
        options, data = self.options, self.data
        for name in [options.x, *options.y]:
            if name and not data.table.has(name):
                raise unknown_column(name, data.table)
        parameter = data.branch.get("parameter", data.branch.get("parameters", [""])[0])
        x = options.x or self.x_column(parameter)
        columns = options.y or [self.y_column("Y") if data.is_friction else self._observables(parameter)[0]]
        mode = "stability" if data.table.has("unstable") else "regimes" if data.is_friction else "plain"
        for name in [x, *columns]:
            if data.columns(name)[0].dtype != float:
                raise unknown_column(name, data.table, "holds no numbers")

        def drawn():
            made = [Quantity(data.curves(x, name, mode), mode, self.title(name)) for name in columns]
            return self.sheet(x).panels(made)

        return {f"{'_'.join(columns)}_over_{x}": drawn}


def _leave_out_turns_at_cusps(curves):
    """Both parameters turn where a curve has a cusp, which is all that is marked there."""
    for curve in curves:
        for i in curve.special.get("cusp", []):
            for kind in ("fold", "peak", "trough"):
                rows = curve.special.get(kind, np.array([], dtype=int))
                near = np.abs(curve.x[rows] - curve.x[i]) < 2e-3 * np.ptp(curve.x)
                near &= np.abs(curve.y[rows] - curve.y[i]) < 2e-3 * np.ptp(curve.y)
                curve.special[kind] = rows[~near]
        curve.special = {kind: rows for kind, rows in curve.special.items() if len(rows)}
