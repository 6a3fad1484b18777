"""Systems given by formulas: arcslip.Model, wherever the module takes a problem."""

import numpy as np
import pytest

import arcslip

BRUSSELATOR = {
    "equations": {"x": "A - (B + 1)*x + rate", "y": "B*x - rate"},
    "parameters": {"A": 1, "B": 1},
    "start": {"x": "A", "y": "B/A"},
    "definitions": {"rate": "x^2*y"},
    "observables": {"product": "x*y"},
}


def special(branch, kind):
    return [point for point in branch.special if point["type"] == kind]


def test_a_model_begins_by_itself_where_its_range_does():
    branch = arcslip.trace(arcslip.Model(**BRUSSELATOR), parameter="B", range=(1, 4))
    (hopf,) = special(branch, "hopf")
    assert hopf["B"] == pytest.approx(2, rel=1e-11) and branch.complete
    assert np.abs(branch["product"] - branch["x"] * branch["y"]).max() < 1e-14
    other = arcslip.trace(arcslip.Model(**BRUSSELATOR), None, {"A": 1.5}, "B", range=(1, 4))
    assert special(other, "hopf")[0]["B"] == pytest.approx(3.25, rel=1e-11)


def test_a_hopf_point_of_a_model_is_followed_in_two_parameters():
    branch = arcslip.trace(arcslip.Model(**BRUSSELATOR), parameter="B", range=(1, 4))
    curve = branch.continue_in_two(special(branch, "hopf")[0], "A", (0.5, 2))
    assert len(curve) > 10 and np.abs(curve["B"] - 1 - curve["A"] ** 2).max() < 1e-9


def test_a_model_is_the_same_as_its_case_file_and_as_its_functions():
    case = {"model": {name: BRUSSELATOR[name] for name in BRUSSELATOR}, "branch": {"parameter": "B", "from": 1, "to": 4}}
    theirs = arcslip.run(case).branches[0]
    mine = arcslip.trace(arcslip.Model(**BRUSSELATOR), parameter="B", range=(1, 4))
    assert len(mine) == len(theirs) and np.abs(mine["B"] - theirs["B"]).max() < 1e-13

    def f(u, p):
        rate = u[0] ** 2 * u[1]
        return np.array([p["A"] - (p["B"] + 1) * u[0] + rate, p["B"] * u[0] - rate])

    written = arcslip.trace(f, [1.0, 1.0], {"A": 1.0, "B": 1.0}, "B", range=(1, 4), equilibrium=True)
    assert special(written, "hopf")[0]["B"] == pytest.approx(special(mine, "hopf")[0]["B"], abs=1e-10)


def test_functions_of_a_model_may_be_called():
    model = arcslip.Model(**BRUSSELATOR)
    u, p = np.array([1.2, 0.7]), {"A": 1.1, "B": 2.3}
    assert model.residual(u, p) == pytest.approx([1.1 - 3.3 * 1.2 + 1.44 * 0.7, 2.3 * 1.2 - 1.44 * 0.7])
    assert model.jacobian(u, p) == pytest.approx(np.array([[-3.3 + 2 * 1.2 * 0.7, 1.44], [2.3 - 2 * 1.2 * 0.7, -1.44]]))
    assert model.parameter_jacobian(u, p) == pytest.approx(np.array([[1, -1.2], [0, 1.2]]))
    assert model.observables(u, [1.1, 2.3]) == pytest.approx({"product": 0.84})
    assert np.isnan(arcslip.Model({"x": "log(x)"}, {"a": 1}).residual([-1.0], {"a": 1.0})).all()


def test_a_map_doubles_its_period():
    logistic = {"equations": {"x": "r*x*(1 - x)"}, "parameters": {"r": 2}, "start": {"x": "1 - 1/r"}, "kind": "map"}
    once = arcslip.trace(arcslip.Model(**logistic), range=(1.5, 4))
    assert special(once, "period_doubling")[0]["r"] == pytest.approx(3, abs=1e-10)
    twice = arcslip.Model(**logistic, iterate=2)
    branches = arcslip.trace_all(twice, range=(1.5, 4))
    found = [point["r"] for branch in branches for point in special(branch, "period_doubling")]
    assert found == pytest.approx([1 + np.sqrt(6)] * 2, abs=1e-10)
    cycles = sorted(one[0] for one in arcslip.solve_all(twice, p0={"r": 3.2}, box=([0], [1])))
    half = np.sqrt(4.2 * 0.2) / 6.4
    assert cycles == pytest.approx([0, 4.2 / 6.4 - half, 1 - 1 / 3.2, 4.2 / 6.4 + half], abs=1e-9)


def test_orbits_of_twice_the_period_leave_the_period_doublings_of_a_map():
    logistic = {"equations": {"x": "r*x*(1 - x)"}, "parameters": {"r": 2}, "start": {"x": "1 - 1/r"}, "kind": "map"}
    branch = arcslip.trace(arcslip.Model(**logistic), range=(1.5, 3.6))
    for begins, ends in [(3, 1 + np.sqrt(6)), (1 + np.sqrt(6), 3.5440903596)]:  # known to all of these digits
        doubling = special(branch, "period_doubling")[0]
        assert doubling["r"] == pytest.approx(begins, abs=1e-9)
        (branch,) = branch.switch(doubling)
        assert branch.complete and branch["r"][0] == pytest.approx(begins, abs=1e-9) and branch["r"][-1] == 3.6
        assert special(branch, "period_doubling")[0]["r"] == pytest.approx(ends, abs=1e-9)
    x = orbit = branch["x"][-1]
    for _ in range(4):
        orbit = 3.6 * orbit * (1 - orbit)
    assert orbit == pytest.approx(x, abs=1e-9)
    long = arcslip.trace(arcslip.Model(**logistic, iterate=64), range=(2.9, 3.05))
    crossing = next(point for point in long.special if point["type"] in ("branch_point", "period_doubling"))
    assert crossing["type"] == "branch_point" and long.switch(crossing)


def test_each_orbit_leaves_where_two_multipliers_pass_minus_one_at_once():
    equations = {"x": "-(1 + p)*x + x^3 + 0.3*x*y^2", "y": "-(1 + p)*y + y^3 + 0.2*x^2*y"}
    branch = arcslip.trace(arcslip.Model(equations, {"p": -0.5}, kind="map"), range=(-0.5, 0.5))
    (doubling,) = special(branch, "period_doubling")
    ends = sorted(abs(doubled.unknowns[-1]).tolist() for doubled in branch.switch(doubling))
    both = [np.sqrt(0.7 / 0.94 / 2), np.sqrt(0.8 / 0.94 / 2)]
    assert np.array(ends) == pytest.approx(np.array([[0, np.sqrt(0.5)], both, both, [np.sqrt(0.5), 0]]), abs=1e-9)


def test_orbits_of_more_steps_than_a_map_may_take_are_refused():
    map = arcslip.Model({"x": "-(1 + p)*x + x^3"}, {"p": -0.5}, kind="map", iterate=51)
    branch = arcslip.trace(map, range=(-0.1, 0.1))
    with pytest.raises(ValueError, match="^iterate: 102 is more than 100$"):
        branch.switch(special(branch, "period_doubling")[0])


HENON = {
    "equations": {"x": "1 - a*x^2 + y", "y": "b*x"},
    "parameters": {"a": 0.1, "b": 0.3},
    "start": {"x": 0.8, "y": 0.2},
    "kind": "map",
}


def test_a_map_has_the_curves_and_coefficients_of_its_case_file():
    case = {"model": HENON, "branch": {"parameter": "a", "from": 0.1, "to": 1}}
    theirs = arcslip.run(case).branches[0]
    mine = arcslip.trace(arcslip.Model(**HENON), parameter="a", range=(0.1, 1))
    assert mine.summary["special"] == theirs.summary["special"]
    (doubling,) = special(mine, "period_doubling")
    curve = mine.continue_in_two(doubling, "b", (-0.9, 0.9))
    assert len(curve) > 10 and np.abs(curve["a"] - 3 * (1 - curve["b"]) ** 2 / 4).max() < 1e-9


def test_a_map_has_curves_of_points_where_circles_are_born():
    equations = {"x": "r*x*(1 - y) + c*x", "y": "x"}  # of determinant r x = r - 1 + c at its fixed point
    model = arcslip.Model(equations, {"r": 1.5, "c": 0}, {"x": "1 - (1 - c)/r", "y": "1 - (1 - c)/r"}, kind="map")
    branch = arcslip.trace(model, parameter="r", range=(1.5, 2.5))
    (birth,) = special(branch, "neimark_sacker")
    assert birth["r"] == pytest.approx(2, abs=1e-10)
    curve = branch.continue_in_two(birth, "c", (-0.5, 0.5))
    assert len(curve) > 10 and np.abs(curve["r"] - 2 + curve["c"]).max() < 1e-9


@pytest.mark.parametrize(
    "change, message",
    [
        ({"equations": {"y": "x", "x": "A - z"}},
         r'^equations\.x: unknown name "z" at column 5 of "A - z"; there are y, x, A, B, rate$'),
        ({"parameters": {"A": "one"}}, r"^parameters\.A: expected a number, got 'one'$"),
        ({"parameters": {"A": 1, "pi": 3}}, r"^parameters\.pi: pi is a constant"),
        ({"start": {"z": 1}}, r"^start\.z: there is no equation of this name$"),
        ({"observables": {"x": "y"}}, r"^observables\.x: equations\.x has this name already$"),
        ({"definitions": {"rate": "rate"}}, r"^definitions\.rate: is defined by itself: rate -> rate$"),
        ({"kind": "flux"}, r"^kind: expected one of flow, forced, map, algebraic"),
        ({"iterate": 2}, r"^iterate: "),
        ({"scale": {"z": 1}}, r"^scale\.z: there is no unknown or parameter of this name$"),
        ({"scale": {"x": 0}}, r"^scale\.x: expected a number > 0, got 0\.0$"),
        ({"equations": {"x": None}}, r"^equations\.x: expected a formula"),
    ],
)
def test_mistakes_are_told_on_one_line(change, message):
    with pytest.raises(ValueError, match=message):
        arcslip.Model(**{**BRUSSELATOR, **change})


def test_cycles_of_a_model_in_small_units_are_those_in_usual_ones():
    ends = []
    for s in (1, 1e-6):
        model = arcslip.Model(
            equations={"x": "s - (B + 1)*x + x^2*y/s^2", "y": "B*x - x^2*y/s^2"},
            parameters={"B": 1.5, "s": s},
            start={"x": "s", "y": "s*B"},
            scale={"x": s, "y": s},
        )
        (cycles,) = arcslip.trace_cycles(model, parameter="B", range=(1.5, 4))
        ends.append((cycles["T"][-1], cycles["x_max"][-1] / s))
    assert ends[1] == pytest.approx(ends[0], rel=1e-7)


@pytest.mark.parametrize("r", [1e-3, 3e-9, 1e-9, 1e-12])
def test_a_small_parameter_is_measured_against_its_range(r):
    fold = 2 / 3**1.5
    model = arcslip.Model({"x": f"a/{r!r} - x + x^3"}, {"a": 0.0})
    own = (lambda u, p: p["a"] / r - u + u**3, [1.3247], {"a": -r}, "a")
    case = {
        "model": {"equations": {"x": f"a/{r!r} - x + x^3"}, "parameters": {"a": 0.0}},
        "branch": {"parameter": "a", "from": -r, "to": r},
    }
    branches = [
        arcslip.trace(model, parameter="a", range=(-r, r)),
        *arcslip.trace_all(model, parameter="a", range=(-r, r)),
        arcslip.trace(*own, range=(-r, r)),
        *arcslip.run(case).branches,
    ]
    for branch in branches:
        folds = [point["a"] / r for point in branch.special if point["type"] == "fold"]
        assert sorted(folds) == pytest.approx([-fold, fold], rel=1e-9)
        assert len(branch) == len(branches[0])


@pytest.mark.parametrize("r", [1e-6, 1e-10])
def test_orbits_over_a_small_parameter_are_those_over_another(r):
    rate = f"(a/{r!r} - 0.5)"
    flow = arcslip.Model({"x": f"{rate}*x - y - x*(x^2 + y^2)", "y": f"{rate}*y + x - y*(x^2 + y^2)"}, {"a": 0.0})
    (cycles,) = arcslip.trace_cycles(flow, parameter="a", range=(0, r))
    assert cycles["a"][0] / r == pytest.approx(0.5, rel=1e-4)  # of a small amplitude
    assert cycles["x_max"][-1] == pytest.approx(0.5**0.5, rel=1e-6)
    forced = arcslip.Model(
        {"x": "v", "v": f"(F/{r!r})*cos(W*t) - 0.1*v - x - x^3"}, {"W": 1.6, "F": 0.0}, kind="forced", period="2*pi/W"
    )
    plain = arcslip.Model(
        {"x": "v", "v": "F*cos(W*t) - 0.1*v - x - x^3"}, {"W": 1.6, "F": 0.0}, kind="forced", period="2*pi/W"
    )
    (small,) = arcslip.trace_cycles(forced, parameter="F", range=(0.01 * r, r), settle=200)
    (usual,) = arcslip.trace_cycles(plain, parameter="F", range=(0.01, 1), settle=200)
    folds = [[point["F"] for point in one.special if point["type"] == "fold"] for one in (small, usual)]
    assert len(folds[1]) == 2
    assert np.array(folds[0]) / r == pytest.approx(folds[1], rel=1e-6)
    bratu = arcslip.Model(
        {"u": "v", "v": f"-(lam/{r!r})*exp(u)"},
        {"lam": 0.0},
        kind="boundary",
        interval={"x": (0, 1)},
        conditions=["u_left", "u_right"],
    )
    (branch,) = arcslip.trace_boundary(bratu, parameter="lam", range=(0.1 * r, 4 * r))
    assert [point["lam"] / r for point in branch.special if point["type"] == "fold"] == pytest.approx([3.513830719125])


@pytest.mark.parametrize("r", [1e-6, 1e-10])
def test_a_small_second_parameter_is_measured_against_its_range(r):
    model = arcslip.Model({"x": f"a + (b/{r!r})*x - x^3"}, {"a": -1.0, "b": r})
    own = (lambda u, p: p["a"] + p["b"] / r * u - u**3, [-1.5], {"a": -1.0, "b": r})
    for traced in (
        arcslip.trace(model, parameter="a", range=(-1, 1)),
        arcslip.trace(*own, parameter="a", range=(-1, 1)),
    ):
        row = [point["type"] for point in traced.special].index("fold")
        curve = traced.continue_in_two(traced.special[row]["point"], "b", (r, -r))
        (cusp,) = [point for point in curve.special if point["type"] == "cusp"]
        assert cusp["b"] / r == pytest.approx(0, abs=1e-9)
        onwards = traced.start_from(0, parameter="b", range=(r, -2 * r))
        assert onwards["b"][-1] / r == pytest.approx(-2, rel=1e-9)
        assert len(onwards) > 10


def test_more_branches_than_are_followed_are_told():
    with pytest.warns(RuntimeWarning, match="max_branches = 1 were followed"):
        found = arcslip.trace_all(
            lambda u, p: [p["p"] * u[0] - u[0] ** 3], [0.0], {"p": -1.0}, range=(-1, 1), max_branches=1
        )
    assert len(found) == 1


def test_parameters_that_a_model_has_not_are_refused():
    with pytest.raises(ValueError, match="p0: there is no 'C' among A, B"):
        arcslip.trace(arcslip.Model(**BRUSSELATOR), None, {"C": 1}, "B")
    with pytest.raises(TypeError, match="u0: missing"):
        arcslip.trace(lambda u, p: u - p)


@pytest.mark.parametrize(
    ("kind", "more", "instead"),
    [
        ("forced", {"period": "2*pi"}, "trace_cycles"),
        ("piecewise", {"pieces": {"only": {"until": "x - 1"}}}, "trace_cycles"),
        ("boundary", {"interval": {"z": (0, 1)}, "conditions": ["x_left"]}, "trace_boundary"),
    ],
)
def test_a_model_without_equilibria_is_refused_where_points_are_traced(kind, more, instead):
    model = arcslip.Model({"x": "a - x"}, {"a": 1, "b": 1}, kind=kind, **more)
    for work in (
        lambda: arcslip.trace(model, parameter="a", range=(1, 2)),
        lambda: arcslip.trace_all(model, parameter="a", range=(1, 2)),
        lambda: arcslip.solve_all(model),
        lambda: arcslip.surface(model, ranges=((0, 2), (0, 2))),
    ):
        with pytest.raises(ValueError, match=f'^problem: a Model of kind "{kind}" has no equilibria; .*arcslip.{instead}$'):
            work()
