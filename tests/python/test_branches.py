"""What is done with traced branches: gone on with, switched, followed in two parameters, sampled."""

import numpy as np
import pytest

import arcslip
from examples import Cubic, circle


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


def test_a_list_of_solutions_says_whether_it_is_all():
    cusp = arcslip.Model({"x": "q + p*x - x^3"}, parameters={"p": 3.0, "q": 1.0}, kind="algebraic")
    found = arcslip.solve_all(cusp, box=([-5.0], [5.0]))
    assert found.complete is True and "proven by interval arithmetic" in found.reason
    assert sorted(float(u[0]) for u in found) == pytest.approx(sorted(np.roots([-1, 0, 3, 1]).real), abs=1e-12)
    outside = arcslip.solve_all(cusp, box=([1.0], [5.0]))
    assert len(outside) == 3 and outside.complete is True and "outside the box are 2 more" in outside.reason
    unknown = arcslip.solve_all(lambda u, p: u**3 - 3 * u - p, [2.0], 1.0, box=([-3.0], [3.0]))
    assert len(unknown) == 3 and unknown.complete is None and "independent starts" in unknown.reason
    assert arcslip.solve_all(lambda u, p: u - p, [2.0], 1.0).complete is None


@pytest.mark.parametrize("box", [([5.0], [-5.0]), ([np.nan], [5.0]), ([0.0], [0.0]), ([-5.0, -5.0], [5.0, 5.0]), ([], []),
                                 ([-5.0], [5.0], [6.0]), 5, ([-5.0], [np.inf])])
def test_a_box_that_is_none_is_refused(box):
    cusp = arcslip.Model({"x": "q + p*x - x^3"}, parameters={"p": 3.0, "q": 1.0}, kind="algebraic")
    with pytest.raises(ValueError, match="box: expected"):
        arcslip.solve_all(cusp, box=box)
    with pytest.raises(ValueError, match="box: expected"):
        arcslip.trace_all(cusp, parameter="p", range=(0, 4), follow="deflation", box=box)


@pytest.mark.parametrize("ends", ["ab", (-1,), 5, (0, 1, 2), (0, "b")])
def test_a_range_that_is_none_is_refused(ends):
    with pytest.raises(ValueError, match="range: expected"):
        arcslip.trace(circle, [1.0], {"lambda": 0.0}, range=ends)


def test_what_hangs_together_is_begun_anywhere_or_everywhere():
    pitchfork = lambda u, p: u * p - u**3  # noqa: E731
    connected = arcslip.trace_all(pitchfork, [0.0], -0.5, range=(-1, 1))
    assert sorted(abs(one["u0"]).max() for one in connected) == pytest.approx([0, 1, 1], abs=1e-8)
    for which, found in {"deflation": 2, "all": 3}.items():  # the line and the bend, which meets it: two halves
        branches = arcslip.trace_all(pitchfork, [0.9], 0.5, range=(-1, 1), follow=which, box=([-2.0], [2.0]))
        assert sum(abs(one["u0"]).max() < 1e-8 for one in branches) == 1
        assert len(branches) == found or which == "all"
    island = lambda u, p: (u**2 + (p - 3) ** 2 - 1) * u  # noqa: E731
    branches = arcslip.trace_all(island, [5.0], 3.0, range=(0, 6), follow="all", box=([-2.0], [2.0]))
    assert max(abs(one["u0"]).max() for one in branches) == pytest.approx(1, abs=1e-2)
    with pytest.raises(ValueError, match='"connected", "deflation" or "all"'):
        arcslip.trace_all(pitchfork, [0.0], -1.0, range=(-1, 1), follow="both")


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


def test_a_curve_of_peaks_in_two_parameters():
    """Of the amplitude 1/sqrt((1 - w^2)^2 + (2 zeta w)^2), at w = sqrt(1 - 2 zeta^2)."""

    def f(u, p):
        w, zeta = p["w"], p["zeta"]
        return u**2 * ((1 - w**2) ** 2 + (2 * zeta * w) ** 2) - 1

    branch = arcslip.trace(f, [1.0], {"w": 0.1, "zeta": 0.1}, "w", range=(0.1, 2), extrema_of=["u0"])
    (peak,) = [point for point in branch.special if point["type"] == "peak"]
    curve = branch.continue_in_two(peak, "zeta", (0.05, 0.6), observable="u0")
    assert curve["zeta"][0] == 0.05 and curve["zeta"][-1] == 0.6
    assert curve["w"] == pytest.approx(np.sqrt(1 - 2 * curve["zeta"] ** 2), abs=1e-6)


def test_a_curve_is_gone_on_with_and_never_in_two_threads_at_once():
    branch = arcslip.trace(Cubic(), [0.0], {"lambda": 0.0, "mu": 0.0}, "lambda", range=(-1, 1))
    fold = next(point for point in branch.special if point["type"] == "fold")
    whole = branch.continue_in_two(fold, "mu", (-2, 1))
    part = branch.continue_in_two(fold, "mu", (-2, 1), max_points=4)
    rest = part.resume(max_points=1000)
    assert rest.unknowns.tobytes() == whole.unknowns.tobytes()
    assert len(part["lambda"]) == len(part) < len(rest)


def test_what_a_branch_finds_of_its_curve_is_refused_while_it_is_traced():
    seen = []

    def f(u, p):
        if curves:
            try:
                curves[0].summary
            except RuntimeError as error:
                seen.append(str(error))
        return p["lambda"] - (1 + p["mu"]) * u + u**3

    curves = []
    branch = arcslip.trace(f, [0.0], {"lambda": 0.0, "mu": 0.0}, "lambda", range=(-1, 1))
    fold = next(point for point in branch.special if point["type"] == "fold")
    part = branch.continue_in_two(fold, "mu", (-2, 1), max_points=4)
    curves.append(part)
    part.resume(max_points=5)
    assert seen and "another thread is at work" in seen[0]


def test_columns_make_a_dict():
    branch = arcslip.trace(circle, [1.0], {"lambda": 0.0}, range=(-2, 2))
    columns = dict(branch)
    assert list(columns) == branch.columns and len(columns["u0"]) == len(branch)


def test_unstable_parts_are_dashed_and_given_axes_left_as_they_are():
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    from matplotlib import pyplot

    branch = arcslip.trace(Cubic(), [0.0], {"lambda": 0.0, "mu": 0.0}, "lambda", range=(-1, 1))
    axes = pyplot.figure().add_subplot()
    assert branch.plot(axes, y="square") is axes and axes.get_yscale() == "linear"
    drawn = {line.get_linestyle(): line.get_xydata() for line in axes.get_lines() if line.get_linestyle() != "None"}
    assert set(drawn) == {"-", "--"}
    assert np.nanmax(drawn["-"][:, 1]) == pytest.approx(1 / 3, abs=1e-2)  # up to the folds
    with pytest.raises(KeyError, match="'z': expected one of"):
        branch.plot(axes, y="z")
