"""Problems written in Python, traced by the engine."""

import threading
import traceback

import numpy as np
import pytest

import arcslip


def circle(u, p):
    """u^2 + lambda^2 = 1."""
    return np.array([u[0] ** 2 + p["lambda"] ** 2 - 1])


class Cubic(arcslip.Problem):
    """A fold at u = +-1/sqrt(3): lambda = u - u^3 + mu u."""

    equilibrium = True

    def residual(self, u, p):
        return p["lambda"] - (1 + p["mu"]) * u + u**3

    def jacobian(self, u, p):
        return np.array([[-(1 + p["mu"]) + 3 * u[0] ** 2]])

    def parameter_jacobian(self, u, p):
        return np.array([[1.0, -u[0]]])

    def observables(self, u, p):
        return {"square": u[0] ** 2}


FOLD = 2 / 27**0.5


def test_a_function_is_traced_through_its_folds_round_a_circle():
    branch = arcslip.trace(circle, [1.0], {"lambda": 0.0}, range=(-2, 2))
    assert branch.stop == "closed_loop" and branch.complete
    assert np.abs(branch["u0"] ** 2 + branch["lambda"] ** 2 - 1).max() < 1e-9
    folds = [point["lambda"] for point in branch.special if point["type"] == "fold"]
    assert sorted(folds) == pytest.approx([-1, 1], abs=1e-9)
    assert branch.derivatives == {"jacobian": "complex step", "parameter_jacobian": "complex step"}


def test_the_branch_is_that_of_the_same_problem_in_cpp():
    """The library's Freudenstein-Roth equations, in Python."""

    def f(u, p):
        x, y = u
        first = x - y**3 + 5 * y**2 - 2 * y - 13 + 34 * (p["x3"] - 1)
        second = x + y**3 + y**2 - 14 * y - 29 + 10 * (p["x3"] - 1)
        return np.array([first, second])

    case = {"system": {"model": "freudenstein_roth"}, "branch": {"parameter": "x3", "from": 0.0, "to": 1.0}}
    theirs = arcslip.run(case).branches[0]
    mine = arcslip.trace(f, theirs.unknowns[0], {"x3": 0.0}, range=(0, 1))
    folds = [[p["x3"] for p in branch.special if p["type"] == "fold"] for branch in (mine, theirs)]
    assert folds[0] and folds[0] == pytest.approx(folds[1], abs=1e-9)
    assert len(mine) == len(theirs) and mine.unknowns[-1] == pytest.approx(theirs.unknowns[-1], abs=1e-8)


@pytest.mark.parametrize("p0", [0.0, {"lambda": 0.0}, [0.0]])
def test_parameters_come_as_they_were_given(p0):
    seen = set()

    def f(u, p):
        seen.add(type(p))
        value = p["lambda"] if isinstance(p, dict) else np.atleast_1d(p)[0]
        return u - value

    problem = arcslip.Problem(f, parameters=["lambda"])
    branch = arcslip.trace(problem, [0.0], p0, range=(0, 1))
    assert branch.complete and branch["u0"][-1] == pytest.approx(1)
    kinds = {type(p0)} if isinstance(p0, dict) else {np.ndarray} if isinstance(p0, list) else {float, complex}
    assert seen == kinds


def test_derivatives_come_from_differences_where_f_takes_no_complex_numbers():
    def f(u, p):
        out = np.empty(2)
        out[0] = float(u[0]) ** 2 + u[1] - p
        out[1] = u[1] - 1
        return out

    branch = arcslip.trace(f, [0.0, 1.0], 1.0, range=(1, 3))
    assert branch.derivatives["jacobian"] == branch.derivatives["parameter_jacobian"] == "central differences"
    assert branch.complete and abs(branch["u0"][-1]) == pytest.approx(2**0.5, abs=1e-9)


def test_a_function_that_complex_steps_would_mislead_is_differenced():
    branch = arcslip.trace(lambda u, p: np.abs(u) - p, [1.0], 1.0, range=(1, 2))
    assert branch.derivatives["jacobian"] == "central differences" and branch.complete


def test_given_derivatives_are_said_and_used():
    branch = arcslip.trace(Cubic(), [0.0], {"lambda": 0.0, "mu": 0.0}, "lambda", range=(-1, 1))
    assert branch.derivatives == {"jacobian": "given", "parameter_jacobian": "given"}
    folds = [point["lambda"] for point in branch.special if point["type"] == "fold"]
    assert sorted(folds) == pytest.approx([-FOLD, FOLD], abs=1e-9)
    assert branch["square"] == pytest.approx(branch["u0"] ** 2)
    between = np.abs(branch["u0"]) < 0.57
    assert (branch["unstable"][between] == 0).all() and (branch["unstable"][np.abs(branch["u0"]) > 0.58] == 1).all()
    assert branch.eigenvalues[0].shape == (1,)


@pytest.mark.parametrize("given", ["jacobian", "parameter_jacobian"])
def test_a_wrong_derivative_is_named_with_its_entry(given):
    right = {
        "jacobian": lambda u, p: np.array([[2 * u[0], 1.0], [0.0, 1.0]]),
        "parameter_jacobian": lambda u, p: np.array([[-2.0], [-1.0]]),
    }
    wrong = {**right, given: lambda u, p: 1.5 * right[given](u, p)}
    f = lambda u, p: np.array([u[0] ** 2 + u[1] - 2 * p, u[1] - p])  # noqa: E731
    assert arcslip.trace(f, [1.0, 1.0], 1.0, range=(1, 2), **right).complete
    with pytest.raises(ValueError, match=r"the Jacobian differs from differences of the residual by 50 % in dF"):
        arcslip.trace(f, [1.0, 1.0], 1.0, range=(1, 2), **wrong)


def test_a_derivative_that_goes_wrong_on_the_way_is_warned_of():
    problem = Cubic()
    problem.parameter_jacobian = lambda u, p: np.array([[1.0 if abs(u[0]) < 0.1 else 1.4, -u[0]]])
    with pytest.warns(RuntimeWarning, match="differs from differences"):
        branch = arcslip.trace(problem, [0.0], {"lambda": 0.0, "mu": 0.0}, "lambda", range=(0, 1), max_points=500)
    assert branch.warning


@pytest.mark.parametrize(
    ("f", "said"),
    [
        (lambda u, p: np.zeros(3), r"^f: expected an array of shape \(2,\), as u0 has it, got shape \(3,\)"),
        (lambda u, p: np.zeros((2, 1)), r"^f: expected an array of shape \(2,\).*got shape \(2, 1\)"),
        (lambda u, p: None, "^f: expected"),
        (lambda u, p: 1j * u, "^f: expected real numbers, got complex128"),
        (lambda u, p: ["a", "b"], "^f: expected real numbers"),
        (lambda u, p: u * [1, np.nan], "^f: entry 1 is nan at the start, u0 and lambda = 0"),
    ],
)
def test_what_f_should_not_return_is_named(f, said):
    with pytest.raises(ValueError, match=said):
        arcslip.trace(f, [1.0, 2.0], 0.0)


@pytest.mark.parametrize("shape", [(2,), (2, 3), (4,)])
def test_a_wrong_shape_of_the_jacobian_is_named(shape):
    with pytest.raises(ValueError, match=r"^jacobian: expected shape \(2, 2\), got an array of shape"):
        arcslip.trace(lambda u, p: u - p, [0.0, 0.0], 0.0, jacobian=lambda u, p: np.ones(shape))


def test_a_shape_that_goes_wrong_on_the_way_is_named():
    with pytest.raises(ValueError, match=r"^f: expected shape \(2,\), got an array of shape \(3,\)"):
        arcslip.trace(lambda u, p: u - p if p.real < 0.5 else np.zeros(3), [0.0, 0.0], 0.0)


def test_nan_in_the_jacobian_is_named_with_its_place():
    def jacobian(u, p):
        return np.array([[1.0, np.nan if p > 0.5 else 0.0], [0.0, 1.0]])

    with pytest.raises(ValueError, match=r"^jacobian: entry \(0, 1\) is nan at lambda = 0\.[5-9]\d*, where f is finite"):
        arcslip.trace(lambda u, p: u - p, [0.0, 0.0], 0.0, jacobian=jacobian)


def test_where_f_is_nan_the_branch_ends_and_says_so():
    with pytest.warns(RuntimeWarning, match="no_value: .*the problem has no value there"):
        branch = arcslip.trace(lambda u, p: u - p if p.real < 1 else u * np.nan, [0.0], 0.0, range=(0, 2))
    assert branch.stop == "no_value" and branch["lambda"][-1] == pytest.approx(1, abs=1e-8)


class Broken(Exception):
    pass


@pytest.mark.parametrize("where", ["residual", "jacobian", "observables", "borders", "eigenvalues", "events"])
def test_an_exception_comes_through_with_its_traceback(where):
    calls = []

    def fails_at_the_fortieth_call(*_):
        calls.append(1)
        if len(calls) > 40:
            raise Broken(f"in {where}")

    parts = {
        "residual": lambda u, p, *_: u - p,
        "jacobian": lambda u, p, *_: np.eye(1),
        "observables": lambda u, p, *_: {"y": 2 * u[0]},
        "eigenvalues": lambda u, p, *_: [-1.0],
    }
    if where == "borders":
        parts["borders"] = lambda u, p, regime: [-1.0]
        parts["beyond"] = lambda regime, border: None
    options = {"events": {"none": lambda u, p: 1.0}} if where == "events" else {}
    broken = {**parts, **options.get("events", {})}
    name = "none" if where == "events" else where
    sound = broken[name]

    def breaks(*arguments):
        fails_at_the_fortieth_call()
        return sound(*arguments)

    if where == "events":
        options["events"] = {"none": breaks}
    else:
        parts[where] = breaks
    residual = parts.pop("residual")
    with pytest.raises(Broken, match=where) as raised:
        branch = arcslip.trace(
            arcslip.Problem(residual, **parts), [0.0], 0.0, range=(0, 5), max_step=0.01, **options
        )
        branch["y"]  # observables are looked at where they are asked for
    assert "fails_at_the_fortieth_call" in [frame.name for frame in traceback.extract_tb(raised.tb)]


def test_after_an_exception_the_same_problem_works_again():
    state = {"fails": True}

    def f(u, p):
        if state["fails"] and p > 0.5:
            raise Broken
        return u - p

    problem = arcslip.Problem(f, jacobian=lambda u, p: np.eye(1), parameter_jacobian=lambda u, p: [-1.0])
    with pytest.raises(Broken):
        arcslip.trace(problem, [0.0], 0.0)
    state["fails"] = False
    assert arcslip.trace(problem, [0.0], 0.0).complete


def test_arrays_that_functions_keep_stay_what_they_were():
    kept = []

    def f(u, p):
        kept.append((u, u.copy()))
        u_before = u.copy()
        out = u - p
        u[:] = -1  # of no effect on the engine
        kept[-1] = (u_before, u_before.copy())
        return out

    branch = arcslip.trace(f, [0.0], 0.0)
    assert branch.complete and branch["u0"] == pytest.approx(branch["lambda"])
    assert all(np.array_equal(*pair) for pair in kept)


def test_keyboard_interrupt_in_f_ends_with_what_was_traced():
    calls = []

    def f(u, p):
        calls.append(1)
        if len(calls) > 200:
            raise KeyboardInterrupt
        return u - p

    with pytest.warns(RuntimeWarning, match="interrupted"):
        branch = arcslip.trace(f, [0.0], 0.0, range=(0, 100), max_step=0.01)
    assert branch.stop == "interrupted" and 2 < len(branch) < 200


def test_other_python_threads_run_meanwhile_and_trace_as_well():
    results = {}

    def work(i):
        results[i] = arcslip.trace(circle, [1.0], {"lambda": 0.0}, range=(-2, 2))

    threads = [threading.Thread(target=work, args=(i,)) for i in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    tables = {branch.unknowns.tobytes() for branch in results.values()}
    assert len(results) == 6 and len(tables) == 1


def test_a_trace_within_a_trace():
    def f(u, p):
        inner = arcslip.trace(lambda v, q: v - q, [0.0], 0.0, range=(0, 0.01))
        return u - p * inner["u0"][-1] * 100

    branch = arcslip.trace(f, [0.0], 0.0, range=(0, 0.05), parameter_jacobian=lambda u, p: [-1.0])
    assert branch.complete and branch["u0"][-1] == pytest.approx(0.05)


def test_an_interrupted_branch_is_gone_on_with_bit_by_bit():
    whole = arcslip.trace(circle, [1.0], {"lambda": 0.0}, range=(-0.99, 0.99))
    part = arcslip.trace(circle, [1.0], {"lambda": 0.0}, range=(-0.99, 0.99), max_points=4)
    assert part.stop == "max_points" and part.checkpoint
    rest = part.resume(max_points=1000)
    assert rest.unknowns.tobytes() == whole.unknowns.tobytes() and rest.stop == whole.stop
    with pytest.raises(ValueError, match="there is nothing further"):
        arcslip.trace(circle, [1.0], {"lambda": 0.0}, range=(-2, 2)).resume()


def test_a_branch_goes_on_from_a_checkpoint_that_was_kept():
    one_way = {"u0": [0.0], "p0": {"lambda": 0.0, "mu": 0.0}, "parameter": "lambda", "range": (0, 1)}
    whole = arcslip.trace(Cubic(), **one_way)
    part = arcslip.trace(Cubic(), **one_way, max_points=5)
    rest = arcslip.trace(Cubic(), **one_way, checkpoint=part.checkpoint)
    assert np.concatenate([part["u0"], rest["u0"]]).tobytes() == whole["u0"].tobytes()
    with pytest.raises(ValueError, match="^checkpoint: "):
        arcslip.trace(Cubic(), **one_way, checkpoint="nonsense")


def test_a_branch_is_begun_at_any_stored_point():
    branch = arcslip.trace(Cubic(), [0.0], {"lambda": 0.0, "mu": 0.0}, "lambda", range=(-1, 1))
    middle = len(branch) // 2
    ahead, back = branch.start_from(middle), branch.start_from(middle, forward=False)
    for part, end in ((ahead, -1), (back, 0)):
        assert part["u0"][0] == pytest.approx(branch["u0"][middle], abs=1e-12)
        assert part["u0"][-1] == pytest.approx(branch["u0"][end], abs=1e-8)
    over_mu = branch.start_from(middle, parameter="mu", range=(0, 1))
    assert over_mu.parameter == "mu" and over_mu["mu"][-1] == 1
    assert np.abs(over_mu["lambda"] - branch["lambda"][middle]).max() == 0


def test_a_curve_of_folds_in_two_parameters_passes_its_cusp():
    branch = arcslip.trace(Cubic(), [0.0], {"lambda": 0.0, "mu": 0.0}, "lambda", range=(-1, 1))
    fold = next(point for point in branch.special if point["type"] == "fold")
    curve = branch.continue_in_two(fold, "mu", (-2, 1))
    mu = curve["mu"]
    assert curve["lambda"] ** 2 == pytest.approx(4 / 27 * np.maximum(1 + mu, 0) ** 3, abs=1e-8)
    cusp = next(point for point in curve.special if point["type"] == "cusp")
    assert (cusp["mu"], cusp["lambda"]) == pytest.approx((-1, 0), abs=1e-7)


def test_branches_are_switched_at_a_branch_point():
    pitchfork = lambda u, p: u * p - u**3  # noqa: E731
    branch = arcslip.trace(pitchfork, [0.0], -1.0, range=(-1, 1))
    point = next(point for point in branch.special if point["type"] == "branch_point")
    assert point["lambda"] == pytest.approx(0, abs=1e-9)
    others = branch.switch(point)
    assert sorted(other["u0"][-1] for other in others) == pytest.approx([-1, 1], abs=1e-8)
    connected = arcslip.trace_all(pitchfork, [0.0], -1.0, range=(-1, 1))
    assert sorted(abs(one["u0"]).max() for one in connected) == pytest.approx([0, 1, 1], abs=1e-8)


def test_deflation_finds_all_solutions_and_their_branches():
    f = lambda u, p: u**3 - u - p  # noqa: E731
    found = arcslip.solve_all(f, [2.0], 0.0, box=([-3.0], [3.0]))
    assert sorted(float(u[0]) for u in found) == pytest.approx([-1, 0, 1], abs=1e-9)
    branches = arcslip.trace_all(f, [2.0], 0.0, range=(-1, 1), follow="deflation", box=([-3.0], [3.0]))
    assert len(branches) == 1 and len(branches[0].special) >= 4  # all three lie on one


def test_hopf_points_of_an_equilibrium():
    def brusselator(u, p):
        a, b = 1.0, p["b"]
        return np.array([a - (b + 1) * u[0] + u[0] ** 2 * u[1], b * u[0] - u[0] ** 2 * u[1]])

    branch = arcslip.trace(brusselator, [1.0, 1.0], {"b": 1.0}, range=(1, 3), equilibrium=True, unknowns=["x", "y"])
    (hopf,) = [point for point in branch.special if point["type"] == "hopf"]
    assert hopf["b"] == pytest.approx(2, abs=1e-8) and hopf["x"] == pytest.approx(1)
    assert branch["unstable"][-1] == 2


def test_events_extrema_and_what_ends_a_branch():
    branch = arcslip.trace(
        lambda u, p: u - np.sin(p),
        [0.0],
        0.0,
        range=(0, 10),
        extrema_of=["u0"],
        events={"half": lambda u, p: u[0] - 0.5},
        stop_after={"half": 3},
    )
    peaks = [point["lambda"] for point in branch.special if point["type"] == "peak"]
    halves = [(point["label"], point["lambda"]) for point in branch.special if point["type"] == "event"]
    assert peaks[0] == pytest.approx(np.pi / 2, abs=1e-8)
    assert [label for label, _ in halves] == ["half"] * 3 and branch.stop == "requested"
    assert halves[-1][1] == pytest.approx(2 * np.pi + np.pi / 6, abs=1e-8)


class Rattle(arcslip.Problem):
    """A spring that stiffens at u = 1: two pieces with a corner."""

    unknowns = ("x",)

    def residual(self, u, p, regime):
        return u - p if regime == 0 else 5 * u - 4 - p

    def borders(self, u, p, regime):
        return u - 1 if regime == 0 else 1 - u

    def beyond(self, regime, border):
        return 1 - regime


def test_borders_are_met_exactly_and_crossed():
    branch = arcslip.trace(Rattle(), [0.0], 0.0, range=(0, 3))
    (switch,) = [point for point in branch.special if point["type"] == "switch"]
    assert switch["x"] == pytest.approx(1, abs=1e-12) and set(branch["regime"]) == {"states 0", "states 1"}
    assert branch["x"][-1] == pytest.approx(7 / 5)
    ended = Rattle()
    ended.beyond = lambda regime, border: None
    assert arcslip.trace(ended, [0.0], 0.0, range=(0, 3)).stop == "left_regime"


def test_samples_know_their_error():
    branch = arcslip.trace(lambda u, p: u - np.sin(p), [0.0], 0.0, range=(0, 6))
    sample = branch.sample(500)
    missed = np.abs(sample.unknowns[:, 0] - np.sin(sample["lambda"]))
    assert missed.max() < 1e-2 and (missed <= 10 * sample.error.max(axis=1) + 1e-9).all()


def test_many_unknowns_have_a_norm_in_place_of_columns():
    branch = arcslip.trace(lambda u, p: u - p, np.zeros(40), 0.0)
    assert "u0" not in branch and branch["norm"][-1] == pytest.approx(1)
    assert branch.unknowns.shape == (len(branch), 40)


def test_a_branch_is_written_with_all_digits(tmp_path):
    branch = arcslip.trace(circle, [1.0], {"lambda": 0.0}, range=(-2, 2))
    branch.to_csv(tmp_path)
    header, *rows = (tmp_path / "branch.csv").read_text().splitlines()
    column = header.split(",").index("u0")
    assert [float(row.split(",")[column]) for row in rows] == list(branch["u0"])


@pytest.mark.parametrize(
    ("change", "error", "said"),
    [
        ({"u0": ["a"]}, ValueError, "^u0: expected numbers"),
        ({"u0": [np.inf]}, ValueError, "^u0: entry 0 is not finite"),
        ({"p0": {"lambda": "a"}}, ValueError, "^p0: expected numbers"),
        ({"p0": 5.0}, ValueError, "^p0: lambda = 5; expected a value from 0 to 1"),
        ({"p0": {"a": 0.0, "b": 0.0}}, ValueError, "^parameter: expected one of a, b, got None"),
        ({"p0": [0.0, 1.0]}, ValueError, "^p0: 2 numbers of 0 parameters"),
        ({"extrema_of": ["v"]}, ValueError, "v"),
        ({"stop_after": {"flod": 1}}, ValueError, "^stop_after: 'flod' is no type of points"),
        ({"tolerance": "a"}, ValueError, "^tolerance: 'a' is none"),
        ({"tolerance": -1.0}, ValueError, "`tolerance` must be positive"),
        ({"max_points": 1}, ValueError, "`max_points` must be at least 2"),
        ({"jacobean": abs}, TypeError, "'jacobean' is no part of a Problem"),
        ({"problem": 3}, TypeError, "^problem: expected a function"),
        ({"unknown_scale": 0.0}, ValueError, "^unknown_scale: expected numbers > 0"),
        ({"unknowns": ["lambda"]}, ValueError, "^'lambda': two columns have this name"),
    ],
)
def test_wrong_arguments_are_named(change, error, said):
    arguments = {"problem": lambda u, p: u - (p if np.isscalar(p) else 0), "u0": [0.0], "p0": 0.0, **change}
    with pytest.raises(error, match=said):
        arcslip.trace(**arguments)
