"""Problems written in Python, traced by the engine."""

import threading
import traceback

import numpy as np
import pytest

import arcslip
from examples import FOLD, Cubic, circle


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


def test_where_differences_of_f_leave_its_domain_the_branch_ends_with_its_points():
    def root(u, p):
        return np.array([np.sqrt(0.3 - float(p)) - u[0] + u[0] ** 3 / 9 if p <= 0.3 else np.nan])

    def unknown_below(u, p):
        u = float(u[0])
        return np.array([p - u if u < 0.7 else np.nan])

    for f, guess, edge, which in ((root, 0.5, 0.3, "parameter_jacobian"), (unknown_below, 0.0, 0.7, "jacobian")):
        with pytest.warns(RuntimeWarning, match="no_value: .*the problem has no value there"):
            branch = arcslip.trace(f, [guess], 0.0, range=(0, 1))
        assert branch.derivatives[which] == "central differences"
        assert branch.stop == "no_value" and branch["lambda"][-1] == pytest.approx(edge, abs=1e-5)


def test_a_branch_that_breaks_off_before_its_start_is_not_complete():
    def f(u, p):
        return u - p if p.real < 1 else u * np.nan

    with pytest.warns(RuntimeWarning, match="no_value, before the start: .*the problem has no value there"):
        branch = arcslip.trace(f, [0.0], 0.0, range=(2, -1))
    assert branch.stop == "reached_end" and not branch.complete
    assert branch.summary["first_stop"] == "no_value" and branch["lambda"][0] == pytest.approx(1, abs=1e-8)


@pytest.mark.parametrize("name", ["type", "regime", "unstable", "arclength", "iterations", "residual", "point", "label"])
def test_a_name_that_results_have_is_refused(name):
    said = f"^'{name}': results have a column of this name; expected another name"
    for parts in ({"observables": {name: lambda u, p: u[0]}}, {"unknowns": (name,)}):
        with pytest.raises(ValueError, match=said):
            arcslip.trace(lambda u, p: u - 1.0, [1.0], {"p": 0.0}, **parts)
    with pytest.raises(ValueError, match=said):
        arcslip.trace(lambda u, p: u - 1.0, [1.0], {name: 0.0})


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
