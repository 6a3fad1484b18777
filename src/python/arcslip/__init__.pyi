# Types of the package's face; shapes and units are in the docstrings.

from collections.abc import Callable, Iterator, Mapping, Sequence
from os import PathLike
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

__version__: str
__all__: list[str]

_Array = NDArray[np.float64]
_Case = str | PathLike[str] | Mapping[str, Any]
_Path = str | PathLike[str]
_Parameters = float | Mapping[str, float] | ArrayLike
_Regime = int | tuple[int, ...]
_Function = Callable[..., ArrayLike]
_Progress = Callable[[int, int, int, float], object]

def run(
    case: _Case,
    out: _Path | None = None,
    set: Sequence[str] = (),
    *,
    verify: bool = False,
    certify: bool = False,
    resume: _Path | Run | None = None,
    progress: _Progress | None = None,
) -> Run: ...
def study(
    case: _Case,
    out: _Path | None = None,
    set: Sequence[str] = (),
    *,
    jobs: int = 0,
    resume: bool = False,
    progress: Callable[[int, int], object] | None = None,
) -> Study: ...
def check(case: _Case, set: Sequence[str] = (), *, derivatives: bool = False) -> Check: ...
def trace(
    problem: _Function | Problem,
    u0: ArrayLike | None = None,
    p0: _Parameters | None = None,
    parameter: str | None = None,
    range: tuple[float, float] = (0.0, 1.0),
    *,
    regime: _Regime = 0,
    check: bool = True,
    checkpoint: str | None = None,
    progress: _Progress | None = None,
    stop_at: Sequence[float] = (),
    extrema_of: Sequence[str] = (),
    events: Mapping[str, Callable[..., float]] | None = None,
    stop_after: Mapping[str, int] | None = None,
    tolerance: float = 1e-10,
    max_step: float = 0.1,
    min_step: float = 1e-10,
    max_points: int = 100000,
    max_seconds: float = ...,
    bound: float = 1e12,
    **functions: Any,
) -> Branch: ...
def trace_all(
    problem: _Function | Problem,
    u0: ArrayLike | None = None,
    p0: _Parameters | None = None,
    parameter: str | None = None,
    range: tuple[float, float] = (0.0, 1.0),
    *,
    follow: Literal["connected", "deflation", "all"] = "connected",
    box: tuple[ArrayLike, ArrayLike] | None = None,
    regime: _Regime = 0,
    check: bool = True,
    progress: _Progress | None = None,
    functions: Mapping[str, Any] | None = None,
    **options: Any,
) -> list[Branch]: ...
def trace_cycles(
    problem: _Function | Problem,
    u0: ArrayLike | None = None,
    p0: _Parameters | None = None,
    parameter: str | None = None,
    range: tuple[float, float] = (0.0, 1.0),
    *,
    settle: float | None = None,
    period: str | float | None = None,
    follow: bool = True,
    discretisation: str = "collocation",
    harmonics: int = 8,
    intervals: int = 20,
    degree: int = 5,
    orbit_tolerance: float = 1e-6,
    doublings: int = 3,
    max_branches: int = 50,
    progress: _Progress | None = None,
    functions: Mapping[str, Any] | None = None,
    **options: Any,
) -> list[Branch]: ...
def trace_boundary(
    problem: Model,
    p0: _Parameters | None = None,
    parameter: str | None = None,
    range: tuple[float, float] = (0.0, 1.0),
    *,
    follow: bool = False,
    intervals: int = 20,
    degree: int = 5,
    orbit_tolerance: float = 1e-6,
    max_branches: int = 50,
    progress: _Progress | None = None,
    **options: Any,
) -> list[Branch]: ...
def solve_all(
    problem: _Function | Problem,
    u0: ArrayLike | list[ArrayLike] | None = None,
    p0: _Parameters | None = None,
    *,
    box: tuple[ArrayLike, ArrayLike] | None = None,
    starts: int = 100,
    regime: _Regime = 0,
    parameter: str | None = None,
    **functions: Any,
) -> Solutions: ...
def surface(
    problem: _Function | Problem,
    u0: ArrayLike | list[ArrayLike] | None = None,
    p0: _Parameters | None = None,
    parameters: tuple[str, str] | None = None,
    ranges: tuple[tuple[float, float], tuple[float, float]] | None = None,
    *,
    max_radius: float = 0.1,
    max_turn: float = 0.2,
    max_charts: int = 10000,
    max_seconds: float = ...,
    extrema_of: Sequence[str] = (),
    **functions: Any,
) -> Surface: ...

class Solutions(list[_Array]):
    complete: bool | None
    reason: str
    def __init__(self, found: list[_Array], complete: bool | None, reason: str) -> None: ...

class Surface:
    parameters: tuple[str, str]
    parameter_names: list[str]
    unknown_names: list[str]
    charts: _Array
    values: _Array
    faces: _Array
    radius: _Array
    component: _Array
    determinant: _Array
    unstable: _Array
    folds: _Array
    fold_values: _Array
    fold_curve: _Array
    fold_type: _Array
    fold_turns: _Array
    ridges: _Array
    ridge_values: _Array
    ridge_curve: _Array
    ridge_observable: _Array
    ridge_type: _Array
    components: list[dict[str, Any]]
    complete: bool
    stop: str
    reason: str
    def __getitem__(self, name: str) -> _Array: ...

class Problem:
    parameters: Sequence[str]
    unknowns: Sequence[str]
    equilibrium: bool
    sparse: bool
    switches: int
    unknown_scale: ArrayLike
    parameter_scale: ArrayLike | None
    jacobian: Any
    parameter_jacobian: Any
    observables: Any
    eigenvalues: Any
    borders: Any
    beyond: Any
    def __init__(self, residual: _Function | None = None, **given: Any) -> None: ...
    def residual(self, u: Any, p: Any) -> Any: ...

class Model(Problem):
    values: dict[str, float]
    kind: str
    iterate: int
    def __init__(
        self,
        equations: Mapping[str, str | float],
        parameters: Mapping[str, float],
        start: Mapping[str, str | float] | None = None,
        definitions: Mapping[str, str | float] | None = None,
        observables: Mapping[str, str | float] | None = None,
        *,
        kind: Literal["flow", "forced", "map", "algebraic", "boundary", "piecewise"] = "flow",
        iterate: int = 1,
        period: str | float | None = None,
        angles: Sequence[str] = (),
        interval: Mapping[str, tuple[str | float, str | float]] | None = None,
        conditions: Sequence[str | float] = (),
        integrals: Sequence[str | float] = (),
        free: Sequence[str] = (),
        pieces: Mapping[str, Mapping[str, Any]] | None = None,
        cycle: Sequence[str] = (),
        scale: Mapping[str, float] | None = None,
    ) -> None: ...
    def residual(self, u: ArrayLike, p: Mapping[str, float] | ArrayLike) -> _Array: ...
    def jacobian(self, u: ArrayLike, p: Mapping[str, float] | ArrayLike) -> _Array: ...
    def parameter_jacobian(self, u: ArrayLike, p: Mapping[str, float] | ArrayLike) -> _Array: ...
    def observables(self, u: ArrayLike, p: Mapping[str, float] | ArrayLike) -> dict[str, float]: ...

class Element:
    kind: str
    force: _Function
    slope: _Function | None
    settings: dict[str, float | None]
    memory: bool
    sticks: Callable[..., tuple[float, float]] | None
    samples: int
    def __init__(
        self,
        kind: str,
        force: _Function,
        slope: _Function | None = None,
        settings: Mapping[str, float | None] | None = None,
        scales_force: Sequence[str] = (),
        *,
        memory: bool = False,
        sticks: Callable[..., tuple[float, float]] | None = None,
        samples: int = 512,
    ) -> None: ...

class Structure:
    name: str
    base: Callable[[float, int], tuple[ArrayLike, ...]]
    damper: Callable[[float, int], ArrayLike | tuple[ArrayLike, ArrayLike]] | None
    contacts: int
    base_modes: Callable[[int], ArrayLike | tuple[ArrayLike, ArrayLike]] | None
    damper_modes: Callable[[int], ArrayLike | tuple[ArrayLike, ArrayLike]] | None
    def __init__(
        self,
        name: str,
        base: Callable[[float, int], tuple[ArrayLike, ...]],
        damper: Callable[[float, int], ArrayLike | tuple[ArrayLike, ArrayLike]] | None = None,
        *,
        contacts: int = 1,
        base_modes: Callable[[int], ArrayLike | tuple[ArrayLike, ArrayLike]] | None = None,
        damper_modes: Callable[[int], ArrayLike | tuple[ArrayLike, ArrayLike]] | None = None,
    ) -> None: ...

def marched(
    step: Callable[..., tuple[ArrayLike, ArrayLike]],
    state: float | Sequence[float] = 0.0,
    *,
    most_periods: int = 200,
) -> Callable[..., NDArray[Any]]: ...

class _Columns:
    def __getitem__(self, name: str) -> NDArray[Any]: ...
    def __contains__(self, name: str) -> bool: ...
    def __len__(self) -> int: ...
    def __iter__(self) -> Iterator[str]: ...
    def keys(self) -> list[str]: ...

class Branch(_Columns):
    parameter: str
    values: dict[str, Any]
    stop: str
    explanation: str
    warning: str
    complete: bool
    seconds: float
    derivatives: dict[str, str]
    verification: dict[str, NDArray[Any]] | None
    @property
    def columns(self) -> list[str]: ...
    @property
    def unknowns(self) -> _Array: ...
    @property
    def parameters(self) -> _Array: ...
    @property
    def parameter_names(self) -> list[str]: ...
    @property
    def tangents(self) -> _Array: ...
    @property
    def eigenvalues(self) -> list[NDArray[np.complex128]]: ...
    @property
    def special(self) -> list[dict[str, Any]]: ...
    @property
    def summary(self) -> dict[str, Any]: ...
    @property
    def certificate(self) -> dict[str, Any] | None: ...
    @property
    def work(self) -> dict[str, int]: ...
    @property
    def checkpoint(self) -> str | None: ...
    def orbit(self, point: int | Mapping[str, Any]) -> dict[str, _Array]: ...
    def multipliers(self, point: int | Mapping[str, Any]) -> _Array: ...
    def sample(self, n: int = 1000) -> Sample: ...
    def where(self, value: float) -> Sample: ...
    def curve(self) -> dict[str, _Array]: ...
    def plot(self, ax: Any = None, x: str | None = None, y: str | None = None, **style: Any) -> Any: ...
    def to_csv(self, folder: _Path) -> None: ...
    def start_from(
        self,
        point: int | Mapping[str, Any],
        forward: bool = True,
        *,
        progress: _Progress | None = None,
        **options: Any,
    ) -> Branch: ...
    def switch(
        self,
        point: int | Mapping[str, Any],
        *,
        window: tuple[float, float] | None = None,
        progress: _Progress | None = None,
        **options: Any,
    ) -> list[Branch]: ...
    def continue_in_two(
        self,
        point: int | Mapping[str, Any],
        parameter: str,
        range: tuple[float, float],
        *,
        window: tuple[float, float] | None = None,
        observable: str = "",
        progress: _Progress | None = None,
        **options: Any,
    ) -> Branch: ...
    def resume(self, *, progress: _Progress | None = None, **options: Any) -> Branch: ...

class Sample(_Columns):
    columns: list[str]
    unknowns: _Array
    error: _Array

class Run:
    branches: list[Branch]
    interrupted: bool
    seconds: float
    @property
    def summary(self) -> dict[str, Any]: ...
    def to_csv(self, folder: _Path) -> None: ...
    def plot(self, ax: Any = None, x: str | None = None, y: str | None = None, **style: Any) -> Any: ...

class CaseWarning(UserWarning): ...

class Check:
    text: str
    good: bool
    def __bool__(self) -> bool: ...

class Study:
    optimum: dict[str, NDArray[Any]]
    sweep: dict[str, NDArray[Any]] | None
    robust: dict[str, NDArray[Any]] | None
    quantiles: dict[str, NDArray[Any]] | None
    summary: dict[str, Any]
    interrupted: bool
    done: int
    count: int
    def to_csv(self, folder: _Path) -> None: ...
