"""How pictures look: sizes, colours, dashes, symbols."""

import numpy as np

# ---- Sizes: lengths in cm, type and lines in typographic points ----

WIDTH = 8.5  # a journal's column
TYPE = 7.5
LINE = 0.4  # from one line of the key to the next
FRAME = 0.5
THIN, MEDIUM, THICK = 0.6, 1.0, 1.4
FINE = {THIN: 0.4, MEDIUM: 0.55, THICK: 0.9}  # where curves are many
MANY = 12  # of more curves only some are named, and lightness tells their order

SETTINGS = {
    **{"font.family": ["DejaVu Sans"], "font.size": TYPE, "mathtext.fontset": "dejavusans", "savefig.dpi": 300},
    **{"figure.dpi": 300, "svg.hashsalt": "arcslip", "svg.fonttype": "path", "pdf.fonttype": 42, "ps.fonttype": 42},
    **{"axes.linewidth": FRAME, "path.simplify": True, "agg.path.chunksize": 20000, "axes.unicode_minus": True},
    **{"xtick.direction": "in", "ytick.direction": "in", "xtick.top": True, "ytick.right": True},
    **{"xtick.major.width": FRAME, "xtick.minor.width": FRAME, "ytick.major.width": FRAME, "ytick.minor.width": FRAME},
    **{"xtick.major.size": 3.5, "ytick.major.size": 3.5, "xtick.minor.size": 1.8, "ytick.minor.size": 1.8},
    **{"xtick.major.pad": 4.6, "ytick.major.pad": 2.5, "lines.scale_dashes": False},
    **{"lines.solid_capstyle": "round", "lines.dash_capstyle": "butt", "lines.solid_joinstyle": "round"},
}

# ---- Colours that the colour-blind tell apart, after Okabe and Ito 2008, dark enough for thin lines on white ----

FEW = ["#0072B2", "#D55E00", "#008F68", "#B8528F", "#9A6A00", "#2A7FB8", "#000000"]
SCALE = ["#440154", "#414487", "#2A788E", "#6C9A1E"]  # of many: lighter and lighter
GREY = "#606060"
COMMON = "#4A4A4A"  # of what is the same for several curves
SHADE = "#EAEAEA"

SOLID = (0, ())
DASHES = [SOLID, (0, (6, 1.6)), (0, (1.6, 1.4)), (0, (6, 1.4, 1.6, 1.4)), (0, (10, 2)), (0, (4, 1.2, 1.2, 1.2, 1.2, 1.2))]
UNSTABLE = (0, (3.2, 2.2))
UNTOLD = (0, (1.4, 2.0))  # where nothing tells of stability
LINE_MARKS = ["o", "s", "D", "p", "X", "h", "*"]  # hollow, spread along curves whose dashes tell of stability


def rgb(colour):
    """A colour's parts, from 0 to 1."""
    return np.array([int(colour[i : i + 2], 16) for i in (1, 3, 5)]) / 255


def mixed(a, b, part):
    """The colour that has this part of `b`, the rest of `a`."""
    parts = np.round(255 * ((1 - part) * rgb(a) + part * rgb(b))).astype(int)
    return "#{:02X}{:02X}{:02X}".format(*parts)


def colours(count):
    """As many, told apart as well as may be."""
    if count <= len(FEW):
        return FEW[:count]
    places = np.linspace(0, len(SCALE) - 1, count)
    return [mixed(SCALE[min(int(s), len(SCALE) - 2)], SCALE[min(int(s), len(SCALE) - 2) + 1],
                  s - min(int(s), len(SCALE) - 2)) for s in places]


def contrast(colour):
    """Of a colour to white, after WCAG 2."""
    parts = rgb(colour)
    linear = np.where(parts <= 0.04045, parts / 12.92, ((parts + 0.055) / 1.055) ** 2.4)
    return 1.05 / (0.05 + linear @ [0.2126, 0.7152, 0.0722])


class Look:
    """Of one of `count` curves; in a colour of its own, and so many times as large, if these are given."""

    def __init__(self, number, count, colour=None, scale=1.0):
        self.colour = colour or colours(count)[number]
        self.is_fine = count > MANY
        self.scale = scale
        self.mark_scale = scale * (0.7 if self.is_fine else 1)
        self.dash = SOLID if self.is_fine else DASHES[number % len(DASHES)]
        self.mark = None if self.is_fine or count == 1 else LINE_MARKS[number % len(LINE_MARKS)]

    def width(self, points):
        return self.scale * (FINE.get(points, points) if self.is_fine else points)


# ---- Special points in the order in which they are drawn: title, symbol, size in points, filled ----

KINDS = {
    "switch": ("$R = S$", "o", 2.7, False),
    "user": ("requested", "x", 3.2, False),
    "event": ("event", "+", 3.5, False),
    "branch_point": ("branch point", "D", 3.0, True),
    "corner_fold": ("corner fold", "s", 3.0, True),
    "hopf": ("Hopf", "o", 3.2, True),
    "peak": ("peak", "^", 3.6, True),
    "trough": ("trough", "v", 3.6, True),
    "fold": ("fold", "s", 4.6, False),
    "cusp": ("cusp", "D", 3.6, False),
    "bogdanov_takens": ("Bogdanov–Takens", "p", 4.2, True),
    "zero_hopf": ("zero–Hopf", "p", 4.2, False),
    "hopf_hopf": ("double Hopf", "^", 4.0, False),
    "generalized_hopf": ("generalised Hopf", "D", 3.6, True),
    "resonance_1_1": ("1:1 resonance", "s", 3.6, True),
    "resonance_1_2": ("1:2 resonance", "s", 3.6, True),
    "resonance_1_3": ("1:3 resonance", "s", 3.6, True),
    "resonance_1_4": ("1:4 resonance", "s", 3.6, True),
    "chenciner": ("Chenciner", "D", 3.6, True),
    "generalized_period_doubling": ("generalised period doubling", "D", 3.6, False),
    "isola_centre": ("isola centre", "*", 5.4, True),
    "simple_bifurcation": ("simple bifurcation", "X", 4.0, True),
    "fold_flip": ("fold–flip", "p", 4.2, False),
    "fold_neimark_sacker": ("fold–Neimark–Sacker", "h", 4.2, False),
    "flip_neimark_sacker": ("flip–Neimark–Sacker", "H", 4.2, False),
    "double_neimark_sacker": ("double Neimark–Sacker", "^", 4.0, False),
    "neimark_sacker": ("Neimark–Sacker", "h", 3.6, True),
    "period_doubling": ("period doubling", "v", 4.0, False),
    "symmetry_breaking": ("symmetry breaking", "d", 4.2, False),
    "corner": ("$R = S$", "o", 2.7, False),
    "birth": ("birth", "^", 3.6, True),
    "death": ("death", "v", 3.6, True),
    "exchange": ("exchange", "D", 3.0, True),
    "optimum": ("optimum", "o", 3.4, True),
    "robust": ("least 95 % quantile", "*", 5.4, True),
    "optimum smooth": ("smooth", "o", 3.4, True),
    "optimum exchange": ("exchange of peaks", "D", 3.2, True),
    "optimum corner": ("corner", "o", 3.0, False),
    "optimum flat": ("flat", "s", 3.2, True),
    "optimum end": ("end of the range", "x", 3.4, False),
    "optimum jump": ("beside a jump", ">", 3.4, True),
}
