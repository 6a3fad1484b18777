"""The words of pictures: symbols, titles of axes, labels of curves, units. Mathematics is in matplotlib's markup."""

from .tables import PREFIXES, split_number

GREEK = {
    **{name: f"\\{name}" for name in "alpha beta gamma delta epsilon zeta eta kappa lambda mu nu xi rho sigma tau".split()},
    **{"omega": r"\omega", "Omega": r"\Omega", "psi": r"\psi"},
}
UNITS = {"Hz": "Hz", "kHz": "kHz", "N_per_m": "N/m", "N": "N", "m": "m", "mm": "mm", "um": "µm", "nm": "nm", "J": "J", "mJ": "mJ"}
UNITS |= {"uJ": "µJ", "nJ": "nJ", "rad_per_s": "rad/s"}
R_IS_S = "$R = S$"

# Of systems with friction: a symbol, and what it is called along an axis.
SYMBOLS = {
    "eta": (r"$\eta$", "frequency"),
    "frequency": ("$f$", "frequency"),
    "P": ("$P$", "preload"),
    "preload": ("$P$", "preload"),
    "preload_per_length": ("$p_0$", "preload"),
    "force_per_length": ("$f_0$", "force"),
    "force": ("$F$", "force"),
    "F": ("$F$", "force"),
    "zeta": (r"$\zeta$", "damping ratio"),
    "zeta_B": (r"$\zeta_\mathrm{B}$", "base damping"),
    "zeta_D": (r"$\zeta_\mathrm{D}$", "damper's damping"),
    "R_over_S": ("$R/S$", "relative amplitude"),
    "R": ("$R$", "relative amplitude"),
    "S": ("$S$", "slip threshold"),
    "Y": ("$Y$", "amplitude"),
    "U": ("$U$", "damper's amplitude"),
    "beta": (r"$\beta$", "base's phase"),
    "alpha": (r"$\alpha$", "damper's phase"),
    "psi": (r"$\psi$", "relative phase"),
    "dissipated": ("", "dissipated energy"),
    "T_max": (r"$T_\mathrm{max}$", "greatest friction force"),
    "slip": ("", "part of the period in slip"),
    "mass_ratio": ("$M$*", "mass ratio"),
    "frequency_ratio": (r"$\gamma$", "frequency ratio"),
    "slenderness": (r"$L/h_\mathrm{D}$", "slenderness"),
    "poisson_ratio": (r"$\nu$", "Poisson's ratio"),
    "interface_stiffness": (r"$K_\mathrm{FD}$", "interface stiffness"),
    "wave_number": ("$n$", "wave number"),
    "elements": ("$N$", "elements"),
    "circumference": ("$L$", "circumference"),
    "radius": ("$r$", "radius"),
    "friction_coefficient": (r"$\mu$", "friction coefficient"),
    "arclength": ("", "arclength"),
    "ratio": (r"$Y/Y_\mathrm{ND}^\mathrm{max}$", "peaks"),
    "P_opt": (r"$P_\mathrm{opt}$", "best preload"),
    "ratio_opt": (r"$Y^\mathrm{max}/Y_\mathrm{ND}^\mathrm{max}$", "highest peak"),
    "eta_peak": (r"$\eta$", "frequency"),
    "Y_max": ("$Y$", "peaks"),
}

# Units of keys of [geometry], by the last part of their names.
KEY_UNITS = {
    **dict.fromkeys(["width", "height", "radius", "circumference"], "m"),
    **{"elastic_modulus": "Pa", "density": "kg/m³", "preload_per_length": "N/m", "force_per_length": "N/m"},
}


def plain(text):
    """Text in which nothing is markup."""
    return text.replace("_", " ").replace("$", "").replace("\\", "")


def unit_of(column):
    """The stem of a column's name and its unit, "" where the name has none."""
    for ending, unit in sorted(UNITS.items(), key=lambda item: -len(item[0])):
        if column.endswith("_" + ending):
            return column[: -len(ending) - 1], unit
    return column, ""


def _library_symbol(name):
    stem, index = split_number(name)
    if stem not in GREEK and len(stem) != 1:
        return plain(name)
    sign = GREEK.get(stem, stem)
    index = index.replace("_", r"\ ")
    return f"${sign}_\\mathrm{{{index}}}$" if index else f"${sign}$"


def symbol(name, is_friction=True):
    """Of a key of [system] or a column: the paper's for systems with friction, else as it is named."""
    stem, _ = unit_of(name)
    if is_friction and stem in SYMBOLS:
        return SYMBOLS[stem][0] or SYMBOLS[stem][1]
    return _library_symbol(stem)


def _with_unit(text, unit):
    return f"{text}  ({unit})" if unit else text


def axis_title(name, is_friction=True):
    """What stands along an axis."""
    stem, unit = unit_of(name)
    found = SYMBOLS.get(stem) if is_friction else None
    text = "  ".join(part for part in (found[1], found[0]) if part) if found else symbol(name, is_friction)
    unit = unit or KEY_UNITS.get(name.rpartition(".")[2], "")
    return _with_unit(text, unit)


def short_title(name, is_friction=True):
    """The same where there is no room for words."""
    _, unit = unit_of(name)
    return _with_unit(symbol(name, is_friction), unit)


def number_text(value):
    return f"{value:.6g}".replace("-", "−")


def value_text(key, value):
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return plain(str(value))
    unit = KEY_UNITS.get(key.rpartition(".")[2], "")
    return number_text(value) + (f" {unit}" if unit else "")


def label(values, keys, is_friction=True):
    """"P = 0.1" for these keys of a branch's values."""
    shown = [(key, values[key]) for key in values if key in keys]
    return ", ".join(f"{symbol(key, is_friction)} = {value_text(key, value)}" for key, value in shown)


def well_sized(column, largest):
    """The column with a prefix to its unit, where that leaves one to three digits before the point of the largest."""
    stem, unit = unit_of(column)
    if unit not in ("m", "J") or not largest > 0:
        return column
    for prefix in ("", "m", "u", "n"):
        size = PREFIXES[prefix + unit][1] if prefix else 1.0
        if largest >= size:
            break
    return f"{stem}_{prefix}{unit}"
