"""Boundary value problems from Python: arcslip.trace_boundary."""

import numpy as np
import pytest

import arcslip


def bratu(**more):
    given = {
        "equations": {"u": "v", "v": "-lambda*exp(u)"},
        "parameters": {"lambda": 0.5},
        "kind": "boundary",
        "interval": {"x": (0, 1)},
        "conditions": ["u_left", "u_right"],
    }
    return arcslip.Model(**{**given, **more})


def test_bratu_folds_where_its_closed_form_does():
    (branch,) = arcslip.trace_boundary(bratu(), range=(0.5, 4), intervals=40)
    assert branch.complete
    fold = next(point for point in branch.special if point["type"] == "fold")
    assert fold["lambda"] == pytest.approx(3.513830719125, abs=1e-9)
    orbit = branch.orbit(fold)
    assert list(orbit) == ["x", "u", "v"] and orbit["x"][-1] == 1
    theta = np.arccosh(np.exp(orbit["u"].max() / 2))
    np.testing.assert_allclose(orbit["u"], 2 * np.log(np.cosh(theta) / np.cosh(theta * (1 - 2 * orbit["x"]))), atol=1e-6)
    with pytest.raises(ValueError, match="multipliers: only of branches of cycles"):
        branch.multipliers(0)


def test_a_free_parameter_and_an_integral():
    model = bratu(parameters={"mean": 0.1, "lambda": 0.5}, integrals=["u - mean"], free=["lambda"])
    (branch,) = arcslip.trace_boundary(model, parameter="mean", range=(0.1, 2))
    assert branch.complete and not any(point["type"] == "fold" for point in branch.special)
    assert branch["lambda"].max() == pytest.approx(3.5138, abs=0.05)
    orbit = branch.orbit(-1)
    sums = 0.5 * (orbit["u"][1:] + orbit["u"][:-1]) * np.diff(orbit["x"])
    assert sums.sum() == pytest.approx(2, abs=1e-3)


def test_branches_are_switched_to():
    column = arcslip.Model(
        equations={"angle": "moment", "moment": "-P*sin(angle)"},
        parameters={"P": 1},
        kind="boundary",
        interval={"s": (0, 1)},
        conditions=["moment_left", "moment_right"],
    )
    branches = arcslip.trace_boundary(column, range=(1, 50), follow=True)
    assert len(branches) == 3
    loads = [point["P"] for point in branches[0].special if point["type"] == "branch_point"]
    assert loads == pytest.approx([np.pi**2, 4 * np.pi**2], rel=1e-9)


@pytest.mark.parametrize(
    "change, told",
    [
        ({"conditions": ["u_left"]}, "conditions: expected 2 conditions and integrals"),
        ({"conditions": ["u_left", "w"]}, r"conditions\[1\]: unknown name \"w\""),
        ({"conditions": ["u_left", None]}, "conditions.1: expected a formula"),
        ({"interval": None}, "interval: expected one name with both its ends"),
        ({"free": ["mu"]}, r"free\[0\]: expected each parameter once, of lambda, got 'mu'"),
        ({"kind": "flow"}, 'interval: only of kind "boundary"'),
    ],
)
def test_mistakes_are_told(change, told):
    with pytest.raises(ValueError, match=told):
        bratu(**change)


def test_other_models_are_refused():
    with pytest.raises(ValueError, match='expected a Model of kind "boundary"'):
        arcslip.trace_boundary(arcslip.Model({"x": "a - x"}, {"a": 1}))
    with pytest.raises(ValueError, match="lambda"):
        arcslip.trace_boundary(
            bratu(parameters={"mean": 0.1, "lambda": 0.5}, integrals=["u - mean"], free=["lambda"]), parameter="lambda"
        )


def test_only_values_of_the_continued_parameter_are_stopped_at():
    (branch,) = arcslip.trace_boundary(bratu(), range=(0.5, 3), stop_at=[1])
    assert [point["lambda"] for point in branch.special if point["type"] == "user"] == [1]
    for given in ({"u_max": [0.2]}, 1.0):
        with pytest.raises(ValueError, match="^stop_at: expected values of lambda alone, which is continued, got "):
            arcslip.trace_boundary(bratu(), range=(0.5, 3), stop_at=given)
    with pytest.raises(ValueError, match="stop_at: lambda = 4 is not between 0.5 and 3"):
        arcslip.trace_boundary(bratu(), range=(0.5, 3), stop_at=[4])
