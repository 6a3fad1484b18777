"""Cycles from Python: arcslip.trace_cycles and Branch.orbit."""

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
    orbit = branch.orbit(-1)
    assert orbit["t"][0] == 0 and orbit["t"][-1] == pytest.approx(branch["T"][-1], rel=1e-14)
    assert np.abs(orbit["u0"] ** 2 + orbit["u1"] ** 2 - 2).max() < 1e-5
    with pytest.raises(IndexError):
        branch.orbit(len(branch))


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


def test_what_is_no_cycle_is_refused():
    rest = arcslip.Model(equations={"x": "y", "y": "-x - d*y"}, parameters={"d": 1}, start={"x": 1})
    with pytest.raises(ValueError, match="come to rest"):
        arcslip.trace_cycles(rest, range=(1, 2), settle=60)
    with pytest.raises(ValueError, match="only of branches of cycles"):
        arcslip.trace(rest, range=(1, 2)).orbit(0)
    assert arcslip.trace_cycles(rest, range=(1, 2)) == []
