"""All pictures of a folder of results, drawn in memory before the first is written."""

import io
import os
from dataclasses import dataclass, field

import matplotlib

from . import style
from .of_modes import PicturesOfModes
from .of_orbits import PicturesOfOrbits
from .of_run import PicturesOfRun
from .of_study import PicturesOfStudy
from .of_surface import PicturesOfSurface
from .page import new_measure
from .run import RunData
from .tables import Refused, summary_of

FORMATS = ("png", "svg", "pdf", "eps")
METADATA = {"png": {"Software": None}, "svg": {"Date": None, "Creator": None}, "pdf": {"CreationDate": None}, "eps": None}


@dataclass
class Options:
    """What may be asked of pictures.

    Attributes
    ----------
    x : str or None
    y : list of str
        Columns for a picture of one's own, in place of those that there are.
    log, linear : set of str
        Axes, "x" or "y", that are so whatever their range.
    ranges : dict of (float, float)
        Of axes, "x" or "y".
    size : (float, float) or None
        Width and height in cm.
    formats : list of str
    only : list of str
        The names of the pictures that are drawn; all if there is none.
    """

    x: str = None
    y: list = field(default_factory=list)
    log: set = field(default_factory=set)
    linear: set = field(default_factory=set)
    ranges: dict = field(default_factory=dict)
    size: tuple = None
    formats: list = field(default_factory=lambda: ["png", "svg"])
    only: list = field(default_factory=list)

    def is_log(self, axis, otherwise):
        return axis in self.log or (otherwise and axis not in self.linear)


def pictures_of(folder, options, release=""):
    """The names of a folder's pictures, each with what draws it. Raises Refused."""
    if _has(folder, "modes.csv") and not _has(folder, "summary.json"):
        return _chosen(folder, PicturesOfModes(folder, options, new_measure()).pictures(), options)
    summary = summary_of(folder)
    version = summary.get("arcslip") if isinstance(summary, dict) else None
    other = ""
    if version is not None and release and version != release:
        other = f' (the results are of arcslip "{version}", this is "{release}"; run the case again)'
    try:
        return _decide(folder, summary, options)
    except Refused as refused:
        raise Refused(f"{refused}{other}") from None
    except (KeyError, TypeError, AttributeError, IndexError) as error:
        path = os.path.join(folder, "summary.json")
        raise Refused(f"{path}: is not a summary that arcslip has written{other}") from error


def _has(folder, name):
    return os.path.exists(os.path.join(folder, name))


def _decide(folder, summary, options):
    measure = new_measure()
    has_run = "study" not in summary["case"]
    own = bool(options.x or options.y)
    if has_run and summary["case"]["branch"].get("surface"):
        return _chosen(folder, PicturesOfSurface(folder, summary["case"], options, measure).pictures(), options)
    run = RunData(folder, summary) if has_run else None
    parts = [PicturesOfRun(run, options, measure)] if has_run else []
    if has_run and not own and "parameter" in run.branch:
        parts.append(PicturesOfOrbits(folder, run, options, measure))
    if (not has_run or "study" in summary) and not (own and has_run):
        case = (summary["study"] if has_run else summary)["case"]
        parts.append(PicturesOfStudy(folder, case, options, measure))
    if _has(folder, "modes.csv") and not own:
        parts.append(PicturesOfModes(folder, options, measure, run))
    found = {}
    for part in parts:
        found.update(part.custom() if own else part.pictures())
    if not found:
        raise parts[-1].nothing()
    return _chosen(folder, found, options)


def _chosen(folder, found, options):
    own = [name for name in [options.x, *options.y] if name]
    if own and list(found) == ["modes"]:
        raise Refused(f"{folder}: holds modes alone, of which there is one picture; {own[0]} is for results of a run or study")
    unknown = [name for name in options.only if name not in found]
    if unknown:
        raise Refused(f"{folder}: there is no picture {unknown[0]}; there are {', '.join(found)}")
    return {name: draw for name, draw in found.items() if not options.only or name in options.only}


def figure_bytes(figure, kind):
    buffer = io.BytesIO()
    figure.savefig(buffer, format=kind, metadata=METADATA[kind])
    return buffer.getvalue()


def draw_folder(folder, options=None, release=""):
    """Draws a folder's pictures, and gives the paths of the files, in order.

    Raises
    ------
    Refused
        The folder, or what is asked of it, is wrong; nothing is written.
    OSError
        A file cannot be written.
    """
    options = options or Options()
    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(style.SETTINGS)
        drawn = {}
        for name, draw in pictures_of(folder, options, release).items():
            figure = draw()
            for kind in options.formats:
                drawn[os.path.join(folder, f"{name}.{kind}")] = figure_bytes(figure, kind)
    for path, content in drawn.items():
        write_whole(path, content)
    return list(drawn)


def write_whole(path, content):
    """A file that appears whole or not at all."""
    temporary = f"{path}.{os.getpid()}.tmp"
    try:
        with open(temporary, "wb") as file:
            file.write(content)
        os.replace(temporary, path)
    except OSError as error:
        try:
            os.unlink(temporary)
        except OSError:
            pass
        raise OSError(f"{path}: cannot be written: {error.strerror}") from None
