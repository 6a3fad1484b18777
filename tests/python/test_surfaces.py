"""Surfaces of solutions over two parameters."""

import numpy as np
import pytest

import arcslip

BOX = {"parameters": ("p", "q"), "ranges": ((-1, 1), (-1, 1))}


def cusp(u, p):
    return u**3 - p["q"] * u - p["p"]


def test_a_surface_has_its_folds_and_its_cusp():
    surface = arcslip.surface(cusp, [0.5], {"p": 0.125, "q": 0.0}, **BOX)
    assert surface.complete and len(surface.components) == 1 and surface.components[0]["euler"] == 1
    p, q = surface.fold_values.T
    assert np.abs(27 * p**2 - 4 * q**3).max() < 1e-9
    assert (surface.fold_type == "cusp").sum() == 1
    assert np.abs(surface["u0"] ** 3 - surface["q"] * surface["u0"] - surface["p"]).max() < 1e-12
    x, y = surface["p"][surface.faces].T, surface["q"][surface.faces].T
    shadow = ((x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0])).sum() / 2
    assert abs(abs(shadow) - 4) < 1e-12
    assert set(surface.determinant) == {-1, 1}


def test_isolas_and_ridges_are_told():
    model = arcslip.Model({"x": "x^2 + p^3 - p - q"}, kind="algebraic", parameters={"p": 0.0, "q": 0.0}, start={"x": 0.1})
    surface = arcslip.surface(model, parameters=("p", "q"), ranges=((-1.3, 1.3), (-1.3, 1.3)), extrema_of=["x"])
    at = 1 / np.sqrt(3)
    for kind, sign in (("isola_centre", 1), ("simple_bifurcation", -1)):
        place = np.array([sign * at, -sign * 2 * at / 3])
        (found,) = np.flatnonzero((surface.fold_type == kind) & (surface.fold_turns == "q"))
        assert np.abs(surface.fold_values[found] - place).max() < 1e-9
        (found,) = np.flatnonzero(surface.ridge_type == kind)
        assert np.abs(surface.ridge_values[found] - place).max() < 1e-9
    assert np.abs(np.abs(surface.ridge_values[:, 0]) - at).max() < 1e-9
    assert set(surface.ridge_type) == {"peak", "trough", "isola_centre", "simple_bifurcation"}
    assert set(surface.ridge_observable) == {"x"} and len(surface.ridges) == len(surface.ridge_curve)
    assert set(surface.fold_turns[surface.fold_type == "fold"]) == {""}


def test_components_begin_at_starts_and_sums_of_squares_are_closed():
    model = arcslip.Model({"u": "u^2 + p^2 + q^2 - 1"}, kind="algebraic", parameters={"p": 0.0, "q": 0.0}, start={"u": 1.0})
    ball = arcslip.surface(model, parameters=("p", "q"), ranges=((-1.2, 1.2), (-1.2, 1.2)))
    assert ball.components[0]["closed"] and ball.components[0]["euler"] == 2
    two = arcslip.surface(lambda u, p: u**2 - 1e-6 + 0 * p["p"], [[1e-3], [-1e-3]], {"p": 0.0, "q": 0.0}, **BOX)
    assert two.complete and len(two.components) == 2
    assert ((two.charts[:, 0] > 0) == (two.component == 0)).all()


def test_what_is_not_covered_is_told():
    with pytest.warns(RuntimeWarning, match="max_points: the most charts that were allowed, 20, are not enough"):
        part = arcslip.surface(cusp, [0.5], {"p": 0.125, "q": 0.0}, **BOX, max_charts=20)
    assert not part.complete and len(part.charts) == 20
    with pytest.raises(ValueError, match="a start has p = 3"):
        arcslip.surface(cusp, [0.5], {"p": 3.0, "q": 0.0}, **BOX)
    with pytest.raises(ValueError, match="ranges"):
        arcslip.surface(cusp, [0.5], {"p": 0.0, "q": 0.0}, parameters=("p", "q"))
