"""Elements with a memory: a slider written in Python is that of the program, to the error of its samples."""

import numpy as np
import pytest

import arcslip

LIMIT = 0.5
MASS = {"mass": np.eye(1) / (2 * np.pi) ** 2, "stiffness": np.eye(1), "contact": [1], "damping_kind": "modal"}
SYSTEM = {
    "model": "sector",
    "base": {**MASS, "load": {"dof": [1], "value": [1.0]}},
    "damping": {"base": 0.01},
    "preload": LIMIT,
}
OVER_ETA = {"parameter": "eta", "from": 0.6, "to": 1.6}


def step(x, before, f, k, limit):
    f = np.minimum(np.maximum(f + k * (x - before), -limit), limit)
    return f, f


def loop(x, k, limit):
    """The same of motions that turn back twice, at once."""
    half = len(x) // 2
    reached = np.minimum(limit, k * x[0])
    back = np.maximum(reached + k * (x[:half] - x[0]), -reached)
    return np.concatenate([back, -back])


def loop_slope(x, dx, k, limit):
    half = len(x) // 2
    slips = k * x[0] > limit
    sticks = ~slips | (limit + k * (x[:half] - x[0]) > -limit)
    back = np.where(sticks, k * (dx[:half] - np.where(slips, dx[0], 0)), 0)
    return np.concatenate([back, -back])


def slider(force=loop, samples=512, **more):
    settings = {"k": None, "limit": None}
    return arcslip.Element("slider", force, settings=settings, memory=True, samples=samples, **more)


def built_in(branch, harmonics=1, **system):
    return {"system": {**SYSTEM, "contact_stiffness": 0.5, "harmonics": harmonics, **system}, "branch": branch}


def written(element, branch, harmonics=1, limit=LIMIT):
    case = built_in(branch, harmonics, contact_stiffness=0.0)
    return {**case, "element": [{"kind": element, "at": "contact", "k": 0.5, "limit": limit}]}


def peaks(branches):
    return [point[name] for branch in branches for point in branch.special if point["type"] == "peak" for name in "YR"]


@pytest.mark.parametrize(
    ("element", "harmonics", "to"),
    [
        (slider(), 1, 5e-5),
        (slider(samples=4096), 1, 1e-6),
        (slider(slope=loop_slope), 1, 5e-5),
        (slider(arcslip.marched(step)), 1, 5e-5),
        (slider(arcslip.marched(step), 256), 3, 2e-4),
    ],
    ids=["at once", "more samples", "slope", "marched", "harmonics"],
)
def test_a_slider_is_a_contact_of_the_program(element, harmonics, to):
    expected = arcslip.run(built_in(OVER_ETA, harmonics)).branches
    found = arcslip.run(written(element, OVER_ETA, harmonics)).branches
    assert found[0].stop == "reached_end" and len(peaks(expected)) == 2
    assert peaks(found) == pytest.approx(peaks(expected), rel=to)
    ends = [[branches[0]["Y"][i] for i in (0, -1)] for branches in (expected, found)]  # in stick
    assert ends[1] == pytest.approx(ends[0], rel=1e-12)
    assert found[0].summary["power_error"] < 1e-9


@pytest.mark.filterwarnings("ignore::arcslip.CaseWarning")
def test_where_it_sticks_is_a_switch_as_that_of_a_contact():
    own = slider(sticks=lambda k, limit: (k, limit / k), samples=1024)
    switches, counts = [], []
    over_k = {"parameter": "slider.k", "from": 0.2, "to": 2.0, "eta": 0.8}
    for case, k in ((lambda branch, **_: built_in(branch), "K_FD"), (lambda branch: written(own, branch), "slider.k")):
        for branch in (OVER_ETA, {**over_k, "parameter": k}):
            (found,) = arcslip.run(case(branch)).branches
            assert found.stop == "reached_end"
            switches.append([[p["eta"], p["Y"]] for p in found.special if p["type"] == "switch"])
            counts.append(len(found))
    assert len(switches[0]) == 2 and len(switches[1]) == 1
    for theirs, mine in zip(switches[:2], switches[2:]):
        assert np.array(mine) == pytest.approx(np.array(theirs), rel=1e-9)
    assert counts[2] < 2 * counts[0]
    curve = {"curve": "switch", "parameters": ["eta", "P"], "window": [0.6, 0.9], "from": 0.3, "to": 0.7}
    theirs = arcslip.run(built_in(curve)).branches[0]
    curve["parameters"] = ["eta", "slider.limit"]
    mine = arcslip.run(written(own, curve)).branches[0]
    assert mine["slider.limit"][[0, -1]] == pytest.approx(theirs["P"][[0, -1]], rel=1e-9)
    assert mine["eta"][[0, -1]] == pytest.approx(theirs["eta"][[0, -1]], rel=1e-9)


def test_its_settings_are_continued_and_its_peaks_followed():
    over = {"from": 0.6, "to": 1.5, "eta": 1.0}
    ridge = {"curve": "peak", "window": [0.9, 1.3], "from": 2.0, "to": 4.0}
    found = []
    own = slider(samples=1024)
    for case, name in (
        (lambda branch: built_in(branch, preload=3.0), "P"),
        (lambda branch: written(own, branch, limit=3.0), "slider.limit"),
    ):
        branches = arcslip.run(case({"parameter": name, **over})).branches
        curves = arcslip.run(case({"parameters": ["eta", name], **ridge})).branches
        assert branches[0].stop == "reached_end" and len(curves) == 1 and curves[0].stop == "reached_end"
        found.append([*branches[0]["Y"][[0, -1]], *curves[0]["Y"][[0, -1]], curves[0]["Y"].min()])
    assert found[0][0] > 2 * found[0][1]
    assert found[1] == pytest.approx(found[0], rel=1e-4)


def test_laws_with_several_states_settle():
    """Bouc-Wen's law beside an elastic slider; where it stays small it is a spring of stiffness a."""

    def bouc_wen(x, before, states, a, k, limit):
        z, f = states
        dx = x - before
        z = z + a * dx - 0.5 * np.abs(dx) * z - 0.5 * dx * np.abs(z)
        f = np.minimum(np.maximum(f + k * dx, -limit), limit)
        return z + f, np.array([z, f])

    settings = {"a": 0.3, "k": 0.2, "limit": 1e3}
    own = arcslip.Element("own", arcslip.marched(bouc_wen, [0, 0]), settings=settings, memory=True, samples=64)
    case = built_in({**OVER_ETA, "from": 1.0}, contact_stiffness=0.0)
    case["system"]["force"] = 1e-4
    case["element"] = [{"kind": own, "at": "contact"}]
    (branch,) = arcslip.run(case).branches
    assert branch.special[1]["type"] == "peak"
    assert branch.special[1]["eta"] == pytest.approx(np.sqrt(1.5), rel=1e-3)
    case["system"]["force"] = 1e-2
    (louder,) = arcslip.run(case).branches
    assert louder.stop == "reached_end" and louder["Y"].max() < 80 * branch["Y"].max()


def drifting(x, before, f, k, limit):
    f = f + k * (x - before) - 0.5 * np.abs(x - before) * f
    return f, f


@pytest.mark.parametrize(
    ("element", "said"),
    [
        (slider(lambda x, k, limit: x[0]), r"^element 'slider': force: expected an array of shape \(512, 1\)"),
        (slider(lambda x, k, limit: k * x**2), "^element 'slider': force: expected a settled cycle"),
        (slider(lambda x, k, limit: np.nan * x), "^element 'slider': force: nan at x = "),
        (slider(slope=lambda x, dx, k, limit: 2 * k * dx), "^element 'slider': slope: .* where differences of force"),
        (slider(sticks=lambda k, limit: (2 * k, limit / k)), "^element 'slider': sticks: expected the force"),
        (slider(sticks=lambda k, limit: (k, 0)), r"^element 'slider': sticks: expected \(stiffness, amplitude\)"),
        (slider(arcslip.marched(lambda x, b, f, k, limit: f)), "^marched: step: expected a tuple"),
        (slider(arcslip.marched(lambda x, b, f, k, limit: (f, 0 * x[:0]))), r"^marched: step: state: expected shape \(1,\)"),
        (slider(arcslip.marched(lambda x, b, f, k, limit: (k * x, f + x**2))), "^marched: step: state: expected -"),
        (slider(arcslip.marched(drifting, most_periods=1)), "^marched: the state has not come back after 1 periods"),
    ],
)
def test_wrong_functions_are_named(element, said):
    with pytest.raises(ValueError, match=said):
        arcslip.run(written(element, OVER_ETA))


def test_wrong_uses_are_refused():
    with pytest.raises(ValueError, match="^element 'slider': samples: expected an even number"):
        slider(samples=33)
    with pytest.raises(ValueError, match="^element 'soft': sticks: only with memory"):
        arcslip.Element("soft", lambda x: x, sticks=lambda: (1, 1))
    with pytest.raises(ValueError, match="^marched: state: expected a number or a row"):
        arcslip.marched(step, np.ones((2, 2)))
    with pytest.raises(TypeError, match="^marched: expected a function"):
        arcslip.marched(3)
    with pytest.raises(ValueError, match="stability: not beside element 'slider', which has a memory"):
        arcslip.run(written(slider(), {**OVER_ETA, "stability": True}))
    with pytest.raises(ValueError, match="verify is for forced responses, not for elements of one's own"):
        arcslip.run(written(slider(), OVER_ETA), verify=True)
