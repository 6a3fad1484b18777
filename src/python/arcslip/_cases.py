"""Case files: what the commands run, study and check of the program do."""

import json
import os
import shutil
import tempfile
import warnings

from . import _core
from ._branch import Branch
from ._stored import stored_branches, table_of
from ._toml import to_toml


class CaseWarning(UserWarning):
    """What a case asks for holds nothing of what it is likely meant for: no resonance, or nothing that slips."""


def _warn(text):
    warnings.warn(text, CaseWarning, stacklevel=3)


def _open(case, settings):
    if isinstance(settings, str):
        settings = [settings]
    settings = [str(setting) for setting in settings]
    if isinstance(case, dict):
        text, parts = to_toml(case)
        return _core.open_case("<dict>", text, settings, parts.files, parts.elements, parts.structures)
    if isinstance(case, str) and "\n" in case:
        return _core.open_case("<text>", case, settings, {}, [], {})
    if not isinstance(case, (str, os.PathLike)):
        raise TypeError(f"case: expected a path, TOML text or a dict, got {case!r}")
    return _core.open_case(os.fsdecode(case), None, settings, {}, [], {})


def run(case, out=None, set=(), *, verify=False, certify=False, resume=None, progress=None):
    """Trace the branches that a case asks for.

    Parameters
    ----------
    case : str, path or dict
        A case file's path, its text (of two lines or more), or the same as a dict of sections. In a dict matrices
        may be arrays of numpy or scipy.sparse, a kind of element an `Element`, and the model a `Structure`.
    out : path, optional
        A folder for the files of `arcslip run`: branches.csv, curves.csv and summary.json, written as the
        branches come.
    set : sequence of str
        Values in place of those of the case, "section.key=value", as `--set` takes them.
    verify : bool
        Solve special points and samples of forced responses anew, with more harmonics and by integrating the whole
        ring in time: `verification` of each branch, and verify.csv and offsets.csv.
    certify : bool
        Prove each branch by interval arithmetic: `certificate` of each branch, which the summary has too.
    resume : path or Run, optional
        Go on with an interrupted run of the same case, or one that had no time: that in a folder, which takes the
        place of `out`, or one that `run` has returned. The result is that of a run which was not interrupted.
    progress : callable, optional
        Called up to twenty times a second with four numbers: the branch, how many there are, its points so far,
        and its arclength.

    Returns
    -------
    Run
        The branches with their summary. Ctrl-C ends the work with what was traced: `interrupted` is true then.

    Raises
    ------
    ValueError
        The case is wrong: the line that the program says, which names file, line, column and key.
    OSError
        A file cannot be written.

    Warns
    -----
    CaseWarning
        Before the work, of a window without resonance and of preloads at which nothing slips.
    """
    file = _open(case, set)
    before, folder = None, ""
    if isinstance(resume, Run):
        before = resume._core
        if resume._folder and out is None:
            before, folder = None, resume._folder
    elif resume is not None:
        folder = os.fsdecode(resume)
    if folder and out is not None and os.path.abspath(os.fsdecode(out)) != os.path.abspath(folder):
        raise ValueError(f"out: {os.fsdecode(out)}; a run that is resumed from {folder} goes on there")
    out = folder or (None if out is None else os.fsdecode(out))
    core = _core.run(file, out, verify, certify, folder, before, progress, _warn)
    result = Run(core, out)
    for failure in core.failures:
        warnings.warn(failure, RuntimeWarning, stacklevel=2)
    if core.interrupted:
        warnings.warn("interrupted: what was traced is returned", RuntimeWarning, stacklevel=2)
    return result


class Run:
    """What `run` has traced.

    Attributes
    ----------
    branches : list of Branch
        In the order of branches.csv.
    interrupted : bool
        Whether Ctrl-C ended the work before its end.
    seconds : float
        Wall clock.
    """

    def __init__(self, core, folder=None):
        self._core = core
        self._folder = folder if core.interrupted or core.taken_over else None
        verifications = {i: table_of(text) for i, text in core.verifications().items()}
        self.branches = stored_branches(folder, core.taken_over)
        first = len(self.branches)
        for i, branch in enumerate(core.branches):
            self.branches.append(Branch(branch, number=first + i, verification=verifications.get(i)))
        self.interrupted = core.interrupted
        self.seconds = core.seconds
        self._summary = None

    @property
    def summary(self):
        """What summary.json holds, as a dict."""
        if self._summary is None:
            self._summary = json.loads(self._core.summary())
        return self._summary

    def to_csv(self, folder):
        """Write branches.csv, curves.csv and summary.json into a folder, as the program does.

        Parameters
        ----------
        folder : path
            Made if it is not there.
        """
        if not self._core.taken_over:
            self._core.write(os.fsdecode(folder))
        elif not (os.path.isdir(folder) and os.path.samefile(self._folder, folder)):
            os.makedirs(folder, exist_ok=True)
            for name in ("branches.csv", "curves.csv", "summary.json", "verify.csv", "offsets.csv",
                         "sectors.csv"):
                if os.path.exists(os.path.join(self._folder, name)):
                    shutil.copy(os.path.join(self._folder, name), folder)

    def plot(self, ax=None, x=None, y=None, **style):
        """Draw all branches.

        Parameters
        ----------
        ax, x, y, **style
            As `Branch.plot` takes them.

        Returns
        -------
        matplotlib.axes.Axes
        """
        from . import _plot

        own = ax is None
        ax = _plot.new_axes() if own else ax
        for branch in self.branches:
            label = ", ".join(f"{key} = {value}" for key, value in branch.values.items())
            branch.plot(ax, x, y, **{"label": label or None, **style})
        if own:
            _plot.settle(ax)
        return ax

    def __repr__(self):
        return f"<arcslip.Run: {len(self.branches)} branches, {sum(map(len, self.branches))} points>"


def check(case, set=(), *, derivatives=False):
    """Read and validate a case without running it.

    Parameters
    ----------
    case, set
        As `run` takes them.
    derivatives : bool
        Trace the branches and compare the problem's derivatives with differences.

    Returns
    -------
    Check

    Raises
    ------
    ValueError
        The case is wrong, in the words of the program.

    Warns
    -----
    CaseWarning
        As `run`; the text has the same.
    """
    text, good, slips = _core.check(_open(case, set), derivatives)
    for slip in slips:
        _warn(slip)
    return Check(text, good)


class Check:
    """What would run.

    Attributes
    ----------
    text : str
        The lines that `arcslip check` prints.
    good : bool
        Whether all derivatives that were compared are exact.
    """

    def __init__(self, text, good):
        self.text = text
        self.good = good

    def __bool__(self):
        return self.good

    def __str__(self):
        return self.text

    def __repr__(self):
        return self.text


def study(case, out=None, set=(), *, jobs=0, resume=False, progress=None):
    """Find the best preload of each design that a case asks for.

    Parameters
    ----------
    case, out, set
        As `run` takes them. A study that is to be resumed needs its folder, `out`.
    jobs : int
        Threads; 0: one for each core.
    resume : bool
        Go on with the study in the folder, if there is one.
    progress : callable, optional
        Called with two numbers: designs done, and how many there are.

    Returns
    -------
    Study
        Ctrl-C ends the work: `interrupted` is true then and there are no tables; with `out`, `resume=True` goes on.

    Raises
    ------
    ValueError, OSError
        As `run`.

    Warns
    -----
    CaseWarning
        As `run`.
    """
    file = _open(case, set)
    folder = tempfile.mkdtemp(prefix="arcslip-") if out is None else os.fsdecode(out)
    try:
        outcome = _core.study(file, folder, jobs, resume, progress, _warn)
        result = Study(outcome, folder)
    finally:
        if out is None:
            shutil.rmtree(folder, ignore_errors=True)
    for text in [*outcome.failures, *outcome.warnings]:
        warnings.warn(text, RuntimeWarning, stacklevel=2)
    if outcome.interrupted:
        warnings.warn(f"interrupted: {outcome.done} of {outcome.count} designs are done", RuntimeWarning, stacklevel=2)
    return result


class Study:
    """What `study` has found. The tables are dicts of columns, each an array of one entry for each row.

    Attributes
    ----------
    optimum : dict of numpy.ndarray
        One row for each design: optimum.csv.
    sweep, robust, quantiles : dict of numpy.ndarray or None
        The tables of the same names, where the case asks for them.
    summary : dict
        summary.json; empty of a study that was interrupted.
    interrupted : bool
    done, count : int
        Designs that are done, and all of them.
    """

    def __init__(self, outcome, folder):
        self.interrupted = outcome.interrupted
        self.done = outcome.done
        self.count = outcome.count
        self._files = {}
        if outcome.done == outcome.count:
            for name in ["optimum.csv", "sweep.csv", "robust.csv", "quantiles.csv", "summary.json"]:
                path = os.path.join(folder, name)
                if os.path.exists(path):
                    with open(path, encoding="utf-8", newline="") as file:
                        self._files[name] = file.read()
        self.summary = json.loads(self._files.get("summary.json", "{}"))
        self.optimum = self._table("optimum.csv") or {}
        self.sweep = self._table("sweep.csv")
        self.robust = self._table("robust.csv")
        self.quantiles = self._table("quantiles.csv")

    def _table(self, name):
        return table_of(self._files[name]) if name in self._files else None

    def to_csv(self, folder):
        """Write the tables and summary.json.

        Parameters
        ----------
        folder : path
            Where to; made if it is not there.
        """
        os.makedirs(folder, exist_ok=True)
        for name, text in self._files.items():
            with open(os.path.join(folder, name), "w", encoding="utf-8", newline="") as file:
                file.write(text)

    def __repr__(self):
        return f"<arcslip.Study: {self.done} of {self.count} designs>"
