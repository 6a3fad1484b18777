"""Cycles from Python: arcslip.trace_cycles and Branch.orbit."""

import math

import numpy as np
import pytest

import arcslip


def hopf_normal_form(u, p):
    x, y = u
    return np.array([p * x - (1 + p) * y - x * (x**2 + y**2), (1 + p) * x + p * y - y * (x**2 + y**2)])


def test_cycles_of_a_function_are_its_circles():
    (branch,) = arcslip.trace_cycles(hopf_normal_form, np.zeros(2), -0.5, "mu", range=(-0.5, 2))
    assert branch.complete
    assert np.abs(branch["T"] * (1 + branch["mu"]) - 2 * np.pi).max() < 1e-7
    assert np.abs(branch["norm"] - np.sqrt(branch["mu"])).max() < 1e-7
    with pytest.raises(ValueError, match="samples of cycles"):
        branch.sample(10)
    orbit = branch.orbit(-1)
    assert orbit["t"][0] == 0 and orbit["t"][-1] == pytest.approx(branch["T"][-1], rel=1e-14)
    assert np.abs(orbit["u0"] ** 2 + orbit["u1"] ** 2 - 2).max() < 1e-5
    with pytest.raises(IndexError):
        branch.orbit(len(branch))
    assert branch.orbit(np.int64(1))["t"][-1] == branch["T"][1]
    for row in (1.5, 1.0, "1"):
        with pytest.raises(TypeError, match="^point: expected a row, an integer, or one of special, got "):
            branch.orbit(row)


def test_a_model_settles_and_its_period_doubles():
    model = arcslip.Model(
        equations={"x": "-y - z", "y": "x + a*y", "z": "b + z*(x - c)"},
        parameters={"c": 2.5, "a": 0.2, "b": 0.2},
        start={"x": 1, "y": 1},
    )
    branches = arcslip.trace_cycles(model, parameter="c", range=(2.5, 4), settle=400, doublings=1)
    doubled = [point for branch in branches for point in branch.special if point["type"] == "period_doubling"]
    assert [point["c"] for point in doubled] == pytest.approx([2.832445, 3.837358], abs=1e-6)
    orbit = branches[0].orbit(doubled[0])
    assert set(orbit) == {"t", "x", "y", "z"} and orbit["x"].max() == pytest.approx(doubled[0]["x_max"], rel=1e-3)


def test_cycles_that_leave_equilibria_are_alone_unless_more_are_asked_for():
    equations = {"x": "al*(y - a*x^3 - c*x)", "y": "x - y + z", "z": "-be*y"}
    chua = arcslip.Model(equations, {"al": 4, "be": 14, "a": 0.0625, "c": -0.2}, {"x": 1.7, "z": -1.7})
    alone = arcslip.trace_cycles(chua, parameter="al", range=(4, 10), follow=False)
    more = arcslip.trace_cycles(chua, parameter="al", range=(4, 10), doublings=1)
    assert (len(alone), len(more)) == (1, 2)
    assert "period_doubling" in alone[0]["type"] and np.array_equal(alone[0]["T"], more[0]["T"])


@pytest.mark.parametrize(
    ("ends", "options", "said"),
    [
        ("", {"max_points": 5}, "max_points: max_points = 5 points were stored"),
        ("", {"max_seconds": 1e-6}, "time_limit: "),
        ("+ 0*sqrt(1.9 - B)", {}, "no_value: .*has no value there"),
    ],
)
def test_equilibria_that_end_before_their_hopf_point_are_told(ends, options, said):
    equations = {"x": "A - (B + 1)*x + x^2*y" + ends, "y": "B*x - x^2*y"}
    model = arcslip.Model(equations, {"A": 1, "B": 1}, {"x": "A", "y": "B/A"})
    with pytest.warns(RuntimeWarning, match="^the equilibria whose Hopf points cycles leave: " + said):
        assert arcslip.trace_cycles(model, parameter="B", range=(1, 4), **options) == []


def test_what_is_no_cycle_is_refused():
    rest = arcslip.Model(equations={"x": "y", "y": "-x - d*y"}, parameters={"d": 1}, start={"x": 1})
    with pytest.raises(ValueError, match="come to rest"):
        arcslip.trace_cycles(rest, range=(1, 2), settle=60)
    with pytest.raises(ValueError, match="only of branches of cycles"):
        arcslip.trace(rest, range=(1, 2)).orbit(0)
    assert arcslip.trace_cycles(rest, range=(1, 2)) == []


def normal_form(u, p):
    square = u[0] ** 2 + u[1] ** 2
    turn = 1 + p["mu"]
    return np.array([p["mu"] * u[0] - turn * u[1] - u[0] * square, turn * u[0] + p["mu"] * u[1] - u[1] * square])


def test_multipliers_of_a_function_cycles():
    (branch,) = arcslip.trace_cycles(
        normal_form, [0.0, 0.0], {"mu": -0.5}, range=(-0.5, 1), functions={"equilibrium": True, "unknowns": ["x", "y"]}
    )
    mu = branch["mu"]
    assert branch.stop == "reached_end"
    np.testing.assert_allclose(branch["T"], 2 * np.pi / (1 + mu), rtol=1e-9)
    np.testing.assert_allclose(branch["x_max"], np.sqrt(mu), atol=1e-7)
    last = len(branch) - 1
    np.testing.assert_allclose(branch.multipliers(last), [np.exp(-2 * mu[last] * branch["T"][last])], rtol=1e-7)
    orbit = branch.orbit(last)
    np.testing.assert_allclose(np.hypot(orbit["x"], orbit["y"]), 1, atol=1e-7)
    assert orbit["t"][-1] == branch["T"][last]


def test_a_forced_oscillator_is_as_its_formula_says():
    model = arcslip.Model(
        equations={"q": "v", "v": "cos(W*t) - 2*D*v - q"}, parameters={"W": 0.5, "D": 0.1}, kind="forced", period="2*pi/W"
    )
    (branch,) = arcslip.trace_cycles(model, parameter="W", range=(0.5, 2), extrema_of=["q_max"])
    W = branch["W"]
    np.testing.assert_allclose(branch["q_max"], 1 / np.hypot(1 - W**2, 0.2 * W), rtol=1e-6)
    assert [point["W"] for point in branch.special if point["type"] == "peak"] == pytest.approx([np.sqrt(1 - 0.02)], abs=1e-6)
    last = len(branch) - 1
    exact = np.exp(2 * np.pi / 2 * (-0.1 + 1j * np.sqrt(0.99)))
    np.testing.assert_allclose(max(branch.multipliers(last), key=np.imag), exact if exact.imag > 0 else exact.conj(), rtol=1e-10)


def test_mistakes_are_told():
    with pytest.raises(ValueError, match="period: expected a formula"):
        arcslip.Model(equations={"x": "cos(t) - x"}, parameters={"a": 1}, kind="forced")
    with pytest.raises(ValueError, match="settle: expected a number > 0"):
        arcslip.trace_cycles(arcslip.Model({"x": "a - x"}, {"a": 1}), range=(0, 1), settle=-1)
    with pytest.raises(ValueError, match="expected one of a flow"):
        arcslip.trace_cycles(arcslip.Model({"x": "a - x"}, {"a": 1}, kind="map"), range=(0, 1))
    branch = arcslip.trace(arcslip.Model({"x": "a - x"}, {"a": 0}), range=(0, 1))
    with pytest.raises(ValueError, match="orbit: only of branches of cycles"):
        branch.orbit(0)


def test_a_period_below_0_at_the_start_is_told_with_its_value():
    said = "^period: -5 at the parameters of the start; expected a number > 0"
    walls = {"only": {"until": "x - 1"}}
    for model in (
        arcslip.Model({"x": "cos(w*t) - x"}, {"w": -2}, kind="forced", period="10/w"),
        arcslip.Model({"x": "cos(w*t) - x"}, {"w": -2}, kind="piecewise", period="10/w", pieces=walls),
    ):
        with pytest.raises(ValueError, match=said):
            arcslip.trace_cycles(model, range=(-2, -1))
    with pytest.raises(ValueError, match=said):
        arcslip.trace_cycles(lambda t, u, p: np.cos(p * t) - u, 0.0, -2.0, "w", range=(-2, -1), period="10/w")


def test_a_function_of_time_is_as_its_formula_says():
    def oscillator(t, u, p):
        return np.array([u[1], np.cos(p["W"] * t) - 2 * p["D"] * u[1] - u[0]])

    (branch,) = arcslip.trace_cycles(
        oscillator, [0, 0], {"W": 0.5, "D": 0.1}, "W", range=(0.5, 2), period="2*pi/W", extrema_of=["q_max"],
        functions={"unknowns": ["q", "v"]},
    )
    W = branch["W"]
    np.testing.assert_allclose(branch["q_max"], 1 / np.hypot(1 - W**2, 0.2 * W), rtol=1e-6)
    assert [point["W"] for point in branch.special if point["type"] == "peak"] == pytest.approx([np.sqrt(1 - 0.02)], abs=1e-6)
    assert branch.derivatives["parameter_jacobian"] == "complex step"
    numbers = arcslip.trace_cycles(
        lambda t, u, w: np.array([u[1], math.cos(w * t) - 0.2 * u[1] - u[0]]), [0, 0], 0.5, "W", range=(0.5, 2), period="2*pi/W"
    )[0]
    np.testing.assert_allclose(numbers["u0_max"], 1 / np.hypot(1 - numbers["W"] ** 2, 0.2 * numbers["W"]), rtol=1e-6)
    with pytest.raises(ValueError, match='period: unknown name "w"'):
        arcslip.trace_cycles(oscillator, [0, 0], {"W": 0.5, "D": 0.1}, "W", range=(0.5, 2), period="2*pi/w")
    with pytest.raises(TypeError, match="period: only of a function"):
        arcslip.trace_cycles(arcslip.Model({"x": "a - x"}, {"a": 1}), range=(0, 1), period=1)


def test_a_fault_in_a_function_of_time_is_raised():
    def fails(t, u, p):
        if p > 1.2 and t > 1:
            raise RuntimeError("late")
        return np.cos(p * t) - u

    with pytest.raises(RuntimeError, match="late"):
        arcslip.trace_cycles(fails, [0.0], 0.5, "W", range=(0.5, 2), period="2*pi/W")


def test_pieces_follow_each_other():
    model = arcslip.Model(
        {"x": "v", "v": "mu_d - x"},
        {"belt": 0.5, "mu_s": 0.6, "mu_d": 0.4},
        {"x": "mu_s", "v": "belt"},
        kind="piecewise",
        pieces={"slip": {"until": "v - belt"}, "stick": {"equations": {"v": 0}, "until": "x - mu_s"}},
    )
    (branch,) = arcslip.trace_cycles(model, parameter="mu_s", range=(0.6, 0.9), degree=7)
    d = branch["mu_s"] - 0.4
    np.testing.assert_allclose(branch["T_slip"], np.pi + 2 * np.arctan(0.5 / d), atol=1e-7)
    np.testing.assert_allclose(branch["T_stick"], 2 * d / 0.5, atol=1e-7)
    assert abs(branch.multipliers(0)).max() < 1e-12
    with pytest.raises(ValueError, match='discretisation: only "collocation"'):
        arcslip.trace_cycles(model, parameter="mu_s", range=(0.6, 0.9), discretisation="balance")
    with pytest.raises(ValueError, match="pieces.slip: expected until"):
        arcslip.Model({"x": "1"}, {"a": 1}, kind="piecewise", pieces={"slip": {"reset": {"x": 0}}})
    with pytest.raises(ValueError, match="cycle: there is no 'b' among a"):
        arcslip.Model({"x": "1"}, {"a": 1}, kind="piecewise", pieces={"a": {"until": "x - 1"}}, cycle=["b"])


def test_pieces_have_branches_that_leave_them_and_curves():
    wall = arcslip.Model(
        {"x": "v", "v": "cos(w*t) - 0.1*v - x"},
        {"w": 2.8, "r": 0.8},
        {"v": 0.5},
        kind="piecewise",
        period="2*pi/w",
        pieces={"free": {"until": "x - 0.5", "reset": {"v": "-r*v"}}},
    )
    once, twice, _ = arcslip.trace_cycles(wall, parameter="w", range=(2.8, 1.9), settle=400)
    doubling = next(i for i, kind in enumerate(once["type"]) if kind == "period_doubling")
    assert abs(once["w"][doubling] - twice["w"][0]) < 1e-5
    np.testing.assert_allclose(twice["T_free"] + twice["T_free_2"], 8 * np.pi / twice["w"], atol=1e-9)
    curve = once.continue_in_two(doubling, "r", (0.8, 0.5))
    assert abs(once["w"][doubling] - curve["w"][0]) < 1e-8 and min(curve["r"]) < 0.6
    (single,) = arcslip.trace_cycles(wall, parameter="w", range=(2.8, 1.9), settle=400, follow=False)
    assert len(single) == len(once)


def only(branch, kind):
    (point,) = [point for point in branch.special if point["type"] == kind]
    return point


def test_switch_leads_to_cycles_and_to_curves_of_these():
    grows = "(mu + b*(x^2 + y^2) - (x^2 + y^2)^2)"
    model = arcslip.Model({"x": f"{grows}*x - y", "y": f"x + {grows}*y"}, {"mu": -1, "b": 1})
    rest = arcslip.trace(model, parameter="mu", range=(-1, 1))
    hopf = only(rest, "hopf")
    (cycles,) = rest.switch(hopf)
    assert only(cycles, "fold")["mu"] == pytest.approx(-0.25, abs=1e-9)
    curve = rest.continue_in_two(hopf, "b", (-2, 2), window=(-1, 1))
    (folds,) = curve.switch(only(curve, "generalized_hopf"), window=(-1, 1))
    assert folds["mu"] == pytest.approx(-(folds["b"] ** 2) / 4, abs=1e-9)
    assert folds["b"][-1] == 2
    assert 0 < cycles.seconds < 60 and 0 < folds.seconds < 60
    orbit = folds.orbit(-1)  # of x^2 + y^2 = b/2
    np.testing.assert_allclose(orbit["x"] ** 2 + orbit["y"] ** 2, 1, atol=1e-7)
    assert orbit["t"][-1] == pytest.approx(2 * np.pi, abs=1e-7)
    np.testing.assert_allclose(folds.multipliers(-1), [1], atol=1e-5)


def test_switch_leads_to_cycles_of_twice_the_period():
    model = arcslip.Model({"x": "-y - z", "y": "x + 0.2*y", "z": "0.2 + z*(x - c)"}, {"c": 2.5}, start={"x": 1})
    (once,) = arcslip.trace_cycles(model, parameter="c", range=(2.5, 3), settle=400, follow=False)
    doubling = only(once, "period_doubling")
    (twice,) = once.switch(doubling)
    assert twice["T"][-1] == pytest.approx(2 * once["T"][-1], rel=0.02)
    again = once.start_from(doubling, range=(2.5, 3.2))
    assert again["c"][-1] == 3.2


def test_equilibria_of_cycles_begin_where_the_start_lies():
    # at mu < 0 there are none; both of z = +-sqrt(mu) have a Hopf point at mu = 1/2
    grows = "(mu - 1/2 - x^2 - y^2)"
    model = arcslip.Model(
        {"x": f"{grows}*x - y", "y": f"x + {grows}*y", "z": "z^2 - mu"}, {"mu": 1}, start={"z": 1}
    )
    cycles = arcslip.trace_cycles(model, p0={"mu": 1}, parameter="mu", range=(-0.5, 2))
    assert sorted(np.sign(branch["z_max"][-1]) for branch in cycles) == [-1, 1]
    assert all(branch["mu"][-1] == 2 for branch in cycles)
    with pytest.raises(ValueError, match="no solution was found"):
        arcslip.trace_cycles(model, p0={"mu": -0.3}, parameter="mu", range=(-0.5, -0.1))
