"""Continuation of friction-damped vibrations, and of any F(u, p) = 0.

`run`, `study` and `check` take the case files of the program `arcslip`; `trace`, `trace_all` and `solve_all` take
problems written in Python or as formulas. Both give `Branch` objects, whose columns are numpy arrays.

    >>> import arcslip
    >>> result = arcslip.run("problems/figure_8.toml")
    >>> result.branches[1]["eta"], result.branches[1]["Y"]
    >>> branch = arcslip.trace(lambda u, p: u**2 + p - 1, 1.0, 0.0, range=(0, 2))
"""

from ._branch import Branch, Sample
from ._cases import CaseWarning, Check, Run, Study, check, run, study
from ._core import version as __version__
from ._cycle import marched
from ._element import Element
from ._model import Model
from ._problem import Problem
from ._structure import Structure
from ._surface import Surface, surface
from ._trace import Solutions, solve_all, trace, trace_all, trace_boundary, trace_cycles

__all__ = [
    "Branch",
    "CaseWarning",
    "Check",
    "Element",
    "Model",
    "Problem",
    "Run",
    "Sample",
    "Structure",
    "Study",
    "Surface",
    "__version__",
    "check",
    "marched",
    "run",
    "Solutions",
    "solve_all",
    "study",
    "surface",
    "trace",
    "trace_all",
    "trace_boundary",
    "trace_cycles",
]
