"""Cycles of problems written in Python or as formulas."""

import numpy as np
import pytest

import arcslip


def normal_form(u, p):
    square = u[0] ** 2 + u[1] ** 2
    turn = 1 + p["mu"]
    return np.array([p["mu"] * u[0] - turn * u[1] - u[0] * square, turn * u[0] + p["mu"] * u[1] - u[1] * square])


def test_cycles_of_a_function_leave_its_hopf_point():
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


def test_cycles_of_formulas_double_their_periods():
    model = arcslip.Model(
        equations={"x": "-y - z", "y": "x + a*y", "z": "b + z*(x - c)"},
        parameters={"a": 0.2, "b": 0.2, "c": 2},
        start={"x": 1},
    )
    branches = arcslip.trace_cycles(model, parameter="c", range=(2, 4), settle=300)
    doublings = [point["c"] for branch in branches for point in branch.special if point["type"] == "period_doubling"]
    assert doublings[0] == pytest.approx(2.832445, abs=2e-6)
    assert doublings[1] == pytest.approx(3.837358, abs=2e-6)
    first = next(point for point in branches[0].special if point["type"] == "period_doubling")
    curve = branches[0].continue_in_two(first, "a", (0.2, 0.22), window=(0, 10))
    assert curve.complete


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
