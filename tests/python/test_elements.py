"""Elements and matrices that a program gives in place of names: the same results, and mistakes that are named."""

import textwrap
import tomllib
import traceback

import numpy as np
import pytest

import arcslip

BEAMS = {
    "system": {
        "model": "beams",
        "wave_number": 1,
        "elements": 30,
        "mass_ratio": 5.0,
        "frequency_ratio": 4.0,
        "slenderness": 33.3,
        "force": 1.0,
        "preload": 1.0,
    },
    "branch": {"parameter": "eta", "from": 0.5, "to": 6.0},
}
STIFF = 2e6


def with_element(element, **branch):
    return {**BEAMS, "branch": {**BEAMS["branch"], **branch}, "element": [{"at": "base", **element}]}


def own(**functions):
    given = {"force": lambda x, k: k * x**3, "settings": {"k": None}, "scales_force": ["k"], **functions}
    return arcslip.Element("soft", **given)


@pytest.mark.parametrize(
    "functions",
    [
        {},
        {"slope": lambda x, k: 3 * k * x**2},
        {"force": lambda x, k: k * np.abs(x) * np.abs(x) * x},  # no complex steps
    ],
    ids=["complex step", "given", "differences"],
)
def test_an_own_cubic_spring_is_that_of_the_program(functions):
    expected = arcslip.run(with_element({"kind": "cubic", "coefficient": STIFF})).branches[0]
    branch = arcslip.run(with_element({"kind": own(**functions), "k": STIFF})).branches[0]
    assert [point["type"] for point in branch.special] == [point["type"] for point in expected.special]
    for name in ("eta", "Y", "R"):
        assert [point[name] for point in branch.special] == pytest.approx(
            [point[name] for point in expected.special], rel=1e-9
        )
    linear = arcslip.run(BEAMS).branches[0]
    assert branch["Y"].max() != pytest.approx(linear["Y"].max(), rel=1e-5)


def test_its_settings_are_continued_and_its_peaks_followed():
    choices = {"cubic": {"kind": "cubic", "coefficient": STIFF}, "soft": {"kind": own(), "k": STIFF}}
    ends, lowest = [], []
    for name, element in choices.items():
        (setting,) = set(element) - {"kind"}
        over = {"parameter": f"{name}.{setting}", "from": 1.0, "to": STIFF, "eta": 3.9}
        case = with_element(element)
        ends.append(arcslip.run({**case, "branch": over}).branches[0]["Y"])
        ridge = {"curve": "peak", "parameters": ["eta", "P"], "window": [3.0, 5.0], "from": 0.8, "to": 1.2}
        lowest.append([curve["Y"].min() for curve in arcslip.run({**case, "branch": ridge}).branches])
    assert ends[0][0] != pytest.approx(ends[0][-1], rel=1e-3)
    assert ends[1][[0, -1]] == pytest.approx(ends[0][[0, -1]], rel=1e-9)
    assert len(lowest[0]) > 0 and lowest[1] == pytest.approx(lowest[0], rel=1e-8)


def test_the_stability_of_one_mass_on_it_is_that_on_the_programs_spring():
    mass = {"model": "spring_mass", "base": {"mass": [1.0], "stiffness": [1.0]}, "contact_stiffness": 0.5}
    system = {**mass, "damping": {"base": 0.01}, "preload": 0.7, "force": 1.0, "harmonics": 3}
    branch = {"parameter": "eta", "from": 0.8, "to": 1.4, "stability": True}
    found = []
    for element in ({"kind": "cubic", "coefficient": 0.1}, {"kind": own(), "k": 0.1}):
        (one,) = arcslip.run({"system": system, "branch": branch, "element": [{"at": "base", **element}]}).branches
        found.append((one["Y"].max(), one["growth"].max()))
    assert found[0][1] > 0.5
    assert found[1] == pytest.approx(found[0], rel=1e-9)


def test_a_saturating_spring_tends_to_the_linear_one():
    """tanh, which is none of the program's laws: small motions meet k, which a study takes as well."""
    tanh = arcslip.Element("soft", lambda x, k, width: k * width * np.tanh(x / width), settings={"k": 1.0, "width": 1})
    wide = arcslip.run(with_element({"kind": tanh, "k": 5.0, "width": 1e3})).branches[0]
    narrow = arcslip.run(with_element({"kind": tanh, "k": 5.0, "width": 1e-3})).branches[0]
    assert narrow["Y"].max() != pytest.approx(wide["Y"].max(), rel=1e-6)
    case = with_element({"kind": tanh, "k": 5.0, "width": 1e3})
    del case["branch"]
    case["study"] = {"parameter": "P", "from": 0.9, "to": 1.2, "eta": [3.3, 4.2]}
    study = arcslip.study(case, jobs=2)
    assert study.done == 1 and 0.9 < study.optimum["P_opt"][0] < 1.2


@pytest.mark.parametrize(
    ("functions", "said"),
    [
        ({"force": lambda x, k: x[:3]}, r"^element 'soft': force: expected an array of shape \(32,\)"),
        ({"force": lambda x, k: x**2}, r"^element 'soft': force: expected f\(-x\) = -f\(x\)"),
        ({"force": lambda x, k: np.nan * x}, "^element 'soft': force: nan at x = "),
        ({"force": lambda x, k: 1j * x}, "^element 'soft': force: expected real numbers"),
        ({"slope": lambda x, k: k * x**2}, "^element 'soft': slope: .* where differences of force give"),
    ],
)
def test_wrong_functions_are_named(functions, said):
    with pytest.raises(ValueError, match=said):
        arcslip.run(with_element({"kind": own(**functions), "k": 1.0}))


def test_what_a_function_raises_comes_with_its_traceback(tmp_path):
    calls = []

    def fails(x, k):
        calls.append(len(x))
        if len(calls) > 100:
            raise LookupError("of force")
        return k * x**3

    case = with_element({"kind": own(force=fails), "k": STIFF})
    with pytest.raises(LookupError, match="of force") as raised:
        arcslip.run(case, out=tmp_path)
    assert "fails" in [frame.name for frame in traceback.extract_tb(raised.value.__traceback__)]
    count = len(calls)
    del case["branch"]
    case["study"] = {"parameter": "P", "from": 0.5, "to": 2.0, "eta": [2.0, 6.0]}
    with pytest.raises(LookupError, match="of force"):
        arcslip.study(case, jobs=2)
    assert len(calls) < count + 50


def test_wrong_uses_are_refused():
    with pytest.raises(ValueError, match="^element 'cubic': there is a kind of this name"):
        arcslip.run(with_element({"kind": arcslip.Element("cubic", lambda x: x)}))
    with pytest.raises(ValueError, match="^element 'soft': two different ones"):
        arcslip.run({**BEAMS, "element": [{"kind": own(), "at": "base"}, {"kind": own(), "at": "base"}]})
    with pytest.raises(ValueError, match=r"element\[0\].k: missing"):
        arcslip.run(with_element({"kind": own()}))
    with pytest.raises(ValueError, match="^kind: expected a name of letters"):
        arcslip.Element("a b", lambda x: x)
    with pytest.raises(TypeError, match="^element 'a': force: expected a function"):
        arcslip.Element("a", 3)
    with pytest.raises(ValueError, match="verify is for forced responses, not for elements of one's own"):
        arcslip.run(with_element({"kind": own(), "k": 1.0}), verify=True)


def test_ctrl_c_within_a_function_leaves_what_was_traced(interrupted):
    script = textwrap.dedent(
        f"""
        import warnings, time, arcslip
        warnings.simplefilter("ignore")
        def force(x, k):
            time.sleep(0.0002)
            return k * x**3
        case = {BEAMS!r}
        case["element"] = [{{"kind": arcslip.Element("slow", force, settings={{"k": 1.0}}), "at": "base"}}]
        print("ready", flush=True)
        result = arcslip.run(case, set=["continuation.max_step=0.001"])
        print(result.interrupted, len(result.branches[0]) > 1)
        """
    )
    assert interrupted(script) == "True True\n"


@pytest.fixture(scope="module")
def sector(program, tmp_path_factory):
    """The folder of a sector of rods with its case."""
    folder = tmp_path_factory.mktemp("sector")
    outcome = program("sector", "rods", "-o", folder)
    assert outcome.returncode == 0, outcome.stderr
    return folder


@pytest.mark.parametrize("kind", ["csc_matrix", "coo_array", "dense"])
def test_matrices_may_be_arrays(sector, kind):
    scipy_io = pytest.importorskip("scipy.io")
    sparse = pytest.importorskip("scipy.sparse")
    case = tomllib.loads((sector / "case.toml").read_text())
    expected = arcslip.run(sector / "case.toml")
    for part in ("base", "damper"):
        for key, name in case["system"][part].items():
            if not isinstance(name, str) or not name.endswith(".mtx"):
                continue
            matrix = scipy_io.mmread(sector / name)
            case["system"][part][key] = matrix.toarray() if kind == "dense" else getattr(sparse, kind)(matrix)
        for key, name in case["system"][part].items():
            if isinstance(name, str) and (sector / name).exists():
                case["system"][part][key] = str(sector / name)
    result = arcslip.run(case)
    assert len(result.branches[0]) > 20
    for mine, theirs in zip(result.branches, expected.branches):
        assert mine["Y"] == pytest.approx(theirs["Y"], rel=1e-12)
    assert result.summary["case"]["system"]["base"]["mass"] == "<array system.base.mass>"


def test_wrong_matrices_name_their_key(sector):
    case = tomllib.loads((sector / "case.toml").read_text())
    for part in ("base", "damper"):
        for key, name in case["system"][part].items():
            if isinstance(name, str) and (sector / name).exists():
                case["system"][part][key] = str(sector / name)
    case["system"]["base"]["mass"] = np.eye(3) * 1j
    with pytest.raises(ValueError, match="^system.base.mass: expected a matrix of real numbers"):
        arcslip.check(case)
    case["system"]["base"]["mass"] = np.ones((2, 3))
    with pytest.raises(ValueError, match="system.base.mass: <array system.base.mass>"):
        arcslip.check(case)
