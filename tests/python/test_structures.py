"""Structures by functions of one's own: the results of the program's, and mistakes that are named."""

import numpy as np
import pytest

import arcslip

SHARED = {"contact_stiffness": 0.5, "limit_per_preload": 1.0, "preload": 0.7, "force": 1.0}
MASSES = {
    "model": "spring_mass",
    "base": {"mass": [1.0, 2.0], "stiffness": [1.0, 3.0]},
    "damper": {"mass": [0.4], "stiffness": [0.1]},
    "damping": {"base": 0.01, "damper": 0.02},
    "damping_kind": "viscous",
    **SHARED,
}
BRANCH = {"parameter": "eta", "from": 0.3, "to": 2.5}

K = np.array([[4.0, -3.0], [-3.0, 3.0]])
M = np.diag([1.0, 2.0])


def base(eta, wave):
    """Two masses, the second of which is loaded and rubs; C = 2 zeta K."""
    answer = np.linalg.inv(K * (1 + 0.02j * eta) - eta**2 * M)
    return answer[1:, 1:], answer[1:, 1]


def damper(eta, wave):
    return 1 / (0.1 * (1 + 0.04j * eta) - eta**2 * 0.4)


def base_with_slopes(eta, wave):
    answer = np.linalg.inv(K * (1 + 0.02j * eta) - eta**2 * M)
    slope = -answer @ (0.02j * K - 2 * eta * M) @ answer
    return answer[1:, 1:], answer[1:, 1], slope[1:, 1:], slope[1:, 1]


def damper_with_slope(eta, wave):
    c = damper(eta, wave)
    return c, -(c**2) * (0.004j - 0.8 * eta)


def modes(wave):
    squares, shapes = np.linalg.eigh(K / np.sqrt(np.outer([1, 2], [1, 2])))
    return np.sqrt(squares), shapes.T[:, 1:] / np.sqrt(2)


def own(**functions):
    given = {"base": base, "damper": damper, "base_modes": modes, "damper_modes": lambda wave: [0.5], **functions}
    return arcslip.Structure("own", **given)


def with_own(structure, **sections):
    return {"system": {"model": structure, **SHARED}, "branch": BRANCH, **sections}


@pytest.mark.parametrize(
    ("functions", "to"),
    [
        ({"base": base_with_slopes, "damper": damper_with_slope}, 1e-12),
        ({}, 1e-9),
        ({"base_modes": None, "damper_modes": None}, 1e-9),
    ],
    ids=["given", "differences", "without modes"],
)
@pytest.mark.parametrize("harmonics", [1, 3])
def test_masses_by_functions_are_those_of_the_program(functions, to, harmonics):
    expected = arcslip.run({"system": {**MASSES, "harmonics": harmonics}, "branch": BRANCH}).branches[0]
    case = with_own(own(**functions))
    case["system"]["harmonics"] = harmonics
    branch = arcslip.run(case).branches[0]
    assert branch.stop == "reached_end" and branch.summary["stop"] == "reached_end"
    types = [point["type"] for point in expected.special]
    assert {"peak", "switch"} <= set(types) and [point["type"] for point in branch.special] == types
    for name in ("eta", "Y", "U", "R"):
        assert [point[name] for point in branch.special] == pytest.approx(
            [point[name] for point in expected.special], rel=to
        )


def test_curves_preloads_and_studies_take_them():
    over = {"parameter": "P", "from": 0.1, "to": 1.5, "eta": 0.9}
    ridge = {"curve": "peak", "parameters": ["eta", "P"], "window": [0.4, 1.4], "from": 0.5, "to": 1.0}
    found = []
    for system in (MASSES, {"model": own(base=base_with_slopes, damper=damper_with_slope), **SHARED}):
        ends = arcslip.run({"system": system, "branch": over}).branches[0]["Y"][[0, -1]]
        curves = arcslip.run({"system": system, "branch": ridge}).branches
        study = {"parameter": "P", "from": 0.3, "to": 1.5, "eta": [0.4, 1.4]}
        optimum = arcslip.study({"system": system, "study": study}, jobs=2).optimum
        lows = [curve["Y"].min() for curve in curves]
        found.append([*ends, *lows, optimum["P_opt"][0], optimum["Y_opt"][0]])
    assert len(found[0]) > 4 and found[0][0] != pytest.approx(found[0][1], rel=1e-2)
    assert found[1] == pytest.approx(found[0], rel=1e-8)


def test_its_keys_may_be_listed_and_its_parameters_continued():
    case = with_own(own(), branch={**BRANCH, "for_each": {"contact_stiffness": [0.2, 0.8]}})
    soft, stiff = arcslip.run(case).branches
    assert soft["Y"].max() != pytest.approx(stiff["Y"].max(), rel=1e-3)
    over = {"parameter": "F", "from": 0.5, "to": 2.0, "eta": 0.8}
    ends = [
        arcslip.run({"system": system, "branch": over}).branches[0]["Y"][[0, -1]]
        for system in (MASSES, {"model": own(), **SHARED})
    ]
    assert ends[1] == pytest.approx(ends[0], rel=1e-9)


def test_waves_and_contacts_are_told():
    """Two contacts of a structure of 12 sectors: what is asked for the harmonics 1 and 3 of two nodal diameters."""
    asked = set()

    def two(eta, wave):
        asked.add((wave, round(eta / 0.5)))
        stiffness = np.diag([2.0, 3.0]) + wave**2
        answer = np.linalg.inv(stiffness * (1 + 0.02j) - eta**2 * np.eye(2))
        return answer, answer @ [1.0, 0.5]

    structure = arcslip.Structure("two", two, contacts=2)
    system = {"model": structure, "sectors": 12, "wave_number": 2, "contact_stiffness": [0.5, 0.4], "harmonics": 3}
    branch = {"parameter": "P", "from": 0.05, "to": 1.0, "eta": 0.5}
    (found,) = arcslip.run({"system": system, "branch": branch}).branches
    assert found.stop == "reached_end" and asked == {(2, 1), (6, 3)}
    assert found["R_contact_2"].max() > 0


@pytest.mark.parametrize(
    ("functions", "said"),
    [
        ({"base": lambda eta, wave: 1 / (1 - eta**2 + 0.01j)}, r"base: expected \(C, y0\) or"),
        ({"base": lambda eta, wave: (np.eye(2), np.ones(2))}, r"base: C: expected shape \(1, 1\), got shape \(2, 2\)"),
        ({"base": lambda eta, wave: (np.nan, 1)}, "base: C: .*nan.* at eta = "),
        ({"base": lambda eta, wave: ("a", 1)}, "base: C: expected complex numbers"),
        ({"damper": lambda eta, wave: (damper(eta, wave), 3.0)}, "damper: dC: .* where differences give"),
        ({"base_modes": lambda wave: [-1.0]}, "base_modes: expected a row of frequencies"),
        ({"base_modes": lambda wave: ([1.0], [[1.0, 2.0]])}, r"base_modes: shapes: expected \(1, 1\)"),
    ],
)
def test_wrong_functions_are_named(functions, said):
    with pytest.raises(ValueError, match=f"^structure 'own': {said}"):
        arcslip.run(with_own(own(**functions)))


def test_what_a_function_raises_is_passed_on():
    def fails(eta, wave):
        if eta > 1:
            raise LookupError("of base")
        return base(eta, wave)

    with pytest.raises(LookupError, match="of base"):
        arcslip.run(with_own(own(base=fails)))


def test_what_takes_equations_of_motion_is_refused():
    for case, said in (
        (with_own(own(), branch={**BRANCH, "stability": True}), "stability: not of a structure by its responses"),
        (with_own(own(), branch={"parameter": "zeta_B", "from": 0.01, "to": 0.1, "eta": 1.0}), "no parameter zeta_B"),
        (with_own(own(), branch={"response": "nonlinear_mode", "parameter": "R", "from": 0.1, "to": 2.0, "eta": 0.9}), "model: nonlinear modes and"),
    ):
        with pytest.raises(ValueError, match=said):
            arcslip.run(case)
    with pytest.raises(ValueError, match="not for structures by their responses alone"):
        arcslip.run(with_own(own()), verify=True)
    with pytest.raises(ValueError, match="certify"):
        arcslip.run(with_own(own()), certify=True)
    with pytest.raises(ValueError, match="^structure 'beams': there is a model of this name"):
        arcslip.run(with_own(arcslip.Structure("beams", base)))
    with pytest.raises(TypeError, match="^structure 'own': base: expected a function"):
        arcslip.Structure("own", 3)
    with pytest.raises(ValueError, match="^structure 'own': contacts"):
        arcslip.Structure("own", base, contacts=0)
    with pytest.raises(ValueError, match="system.damping"):
        arcslip.run({"system": {**SHARED, "model": own(), "damping": {"base": 0.1}}, "branch": BRANCH})


def test_check_says_what_it_is_and_that_derivatives_are_exact():
    found = arcslip.check(with_own(own()), derivatives=True)
    assert found and "structure by its responses, n = 0, N = 1, k = 0.5" in found.text
