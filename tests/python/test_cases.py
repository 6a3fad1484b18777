"""Case files through Python: the same numbers, files and messages as the program's."""

import csv
import json
import os
import pathlib
import re
import textwrap
import tomllib
import warnings

import numpy as np
import pytest

import arcslip

DUFFING = '[system]\nmodel = "duffing"\n\n[branch]\nparameter = "W"\nfrom = 0.5\nto = 3.0\n'


def rows_of(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def without_times(summary):
    """A summary but for what differs from run to run."""
    text = json.dumps({k: v for k, v in summary.items() if k != "interrupted"}, sort_keys=True)
    return re.sub(r'"seconds": [^,}]*', '"seconds": 0', text)


@pytest.fixture(scope="module")
def figure_8(cases, program, tmp_path_factory):
    """The result through Python, and the folder that the program has written."""
    folder = tmp_path_factory.mktemp("figure_8")
    assert program("run", cases / "figure_8.toml", "-o", folder, "--quiet").returncode == 0
    return arcslip.run(cases / "figure_8.toml"), folder


def test_a_branch_is_complete_where_the_program_calls_it_whole(program, tmp_path):
    case = '''[model]
    parameters = {{ mu = 0.3 }}
    equations = {{ x = "mu - x + 0*sqrt(0.5 - mu)" }}
    [branch]
    parameter = "mu"
    from = {}
    to = {}
    start = 0.3'''
    for first, last in ((0.4, 0), (1, 0), (0, 1)):
        path = tmp_path / "case.toml"
        path.write_text(case.format(first, last))
        (branch,) = arcslip.run(path).branches
        ended = program("run", path, "-o", tmp_path / "out", "--quiet")
        assert branch.complete == (ended.returncode == 0) == (1 not in (first, last))


def test_figure_8_equals_the_programs_table_bit_for_bit(figure_8):
    result, folder = figure_8
    rows = rows_of(folder / "branches.csv")
    assert len(rows) == sum(map(len, result.branches)) > 1000
    for number, branch in enumerate(result.branches):
        mine = [row for row in rows if row["branch"] == str(number)]
        for name in rows[0].keys() - {"branch", "point"}:
            if branch[name].dtype.kind == "U":
                assert list(branch[name]) == [row[name] for row in mine]
            else:
                given = np.array([float(row[name]) for row in mine])
                assert given.tobytes() == branch[name].astype(float).tobytes(), name


@pytest.mark.parametrize("name", ["figure_8", "rotor_ring", "enz", "cusp_curve", "stability"])
def test_files_equal_the_programs(cases, program, tmp_path, name):
    case = cases / f"{name}.toml"
    status = program("run", case, "-o", tmp_path / "program", "--quiet").returncode
    assert status in (0, 3)
    result = arcslip.run(case, out=tmp_path / "streamed")
    result.to_csv(tmp_path / "afterwards")
    summary = json.loads((tmp_path / "program/summary.json").read_text())
    for folder in ("streamed", "afterwards"):
        for file in ("branches.csv", "curves.csv"):
            assert (tmp_path / folder / file).read_bytes() == (tmp_path / "program" / file).read_bytes()
        written = json.loads((tmp_path / folder / "summary.json").read_text())
        assert without_times(written) == without_times(summary)
    assert without_times(result.summary) == without_times(summary)


def test_path_text_and_dict_are_the_same_case(cases):
    path = cases / "rods.toml"
    text = path.read_text()
    tables = [
        np.column_stack([branch["eta"] for branch in arcslip.run(case).branches[:1]])
        for case in (path, str(path), text, tomllib.loads(text))
    ]
    assert len(tables[0]) > 100
    assert all(table.tobytes() == tables[0].tobytes() for table in tables)


def test_a_dict_may_hold_what_numpy_makes():
    case = tomllib.loads(DUFFING)
    case["branch"]["from"] = np.float64(0.5)
    case["continuation"] = {"stop_at": np.array([1.0, 1.5]), "max_points": np.int64(1000)}
    (branch,) = arcslip.run(case).branches
    assert set(branch["W"][branch["type"] == "user"]) == {1.0, 1.5}


def test_settings_take_the_place_of_values(cases):
    result = arcslip.run(cases / "figure_8.toml", set=["branch.to=2.0", "branch.for_each.preload=[1.0]"])
    assert [branch.values for branch in result.branches] == [{"preload": 1.0}]
    assert result.branches[0]["eta"][-1] == 2.0


def test_columns_are_views_that_keep_what_they_show_alive(figure_8, cases):
    branch = arcslip.run(cases / "rods.toml").branches[0]
    eta, unknowns = branch["eta"], branch.unknowns
    before = eta.copy(), unknowns.copy()
    assert np.shares_memory(eta, branch["eta"]) and np.shares_memory(unknowns, branch.unknowns)
    assert unknowns.shape[0] == len(branch) and branch.tangents.shape == (len(branch), unknowns.shape[1] + 1)
    with pytest.raises(ValueError, match="read-only"):
        eta[0] = 1
    with pytest.raises(ValueError):
        unknowns.flags.writeable = True
        unknowns[0, 0] = 1
    del branch
    for _ in range(20):  # what was freed would be written over
        np.empty(len(eta)).fill(-1)
    assert np.array_equal(eta, before[0]) and np.array_equal(unknowns, before[1])


def test_an_unknown_column_is_named(figure_8):
    with pytest.raises(KeyError, match="'ETA': expected one of type, regime, eta, P"):
        figure_8[0].branches[0]["ETA"]


def test_special_points_are_those_of_the_summary(figure_8):
    result, _ = figure_8
    for branch, said in zip(result.branches, result.summary["branches"]):
        assert [point["type"] for point in branch.special] == [point["type"] for point in said["special"]]
        assert [point["Y"] for point in branch.special] == [point["Y"] for point in said["special"]]
        assert branch.summary["special"] == said["special"]


def test_samples_are_within_a_few_times_their_error(cases):
    coarse = arcslip.run(cases / "figure_8.toml", set=["branch.for_each.preload=[1.0]"]).branches[0]
    sample = coarse.sample(400)
    assert len(sample) == 400 and sample.error.shape == (400, coarse.unknowns.shape[1] + 1)
    assert sample["eta"][0] == coarse["eta"][0] and sample["eta"][-1] == coarse["eta"][-1]
    near = (sample["eta"] < 3.3) & (sample["eta"] > 1)  # where eta alone tells the point
    exact = arcslip.run(
        cases / "figure_8.toml",
        set=["branch.for_each.preload=[1.0]", f"continuation.stop_at={sample['eta'][near].tolist()}"],
    ).branches[0]
    at = {eta: u for eta, u, kind in zip(exact["eta"], exact.unknowns, exact["type"]) if kind == "user"}
    missed = np.array([np.abs(at[e] - u).max() for e, u in zip(sample["eta"][near], sample.unknowns[near])])
    assert near.sum() > 20
    assert (missed <= 10 * sample.error[near].max(axis=1) + 1e-9).all()


def test_where_the_parameter_has_a_value(figure_8):
    branch = figure_8[0].branches[1]
    assert branch.where(3.46)["eta"] == pytest.approx([3.46], abs=1e-12)


def test_curves_are_what_the_program_draws(figure_8):
    result, folder = figure_8
    rows = [row for row in rows_of(folder / "curves.csv") if row["branch"] == "1"]
    curve = result.branches[1].curve()
    assert curve["Y"] == pytest.approx([float(row["Y"]) for row in rows], rel=1e-9)


def test_check_says_what_the_program_says(cases, program):
    assert str(arcslip.check(cases / "rotor_ring.toml")) == program("check", cases / "rotor_ring.toml").stdout
    compared = arcslip.check(cases / "enz.toml", derivatives=True)
    assert compared and "derivatives against differences" in compared.text


def test_study_finds_what_the_program_finds(cases, program, tmp_path):
    case = cases / "figure_12.toml"
    assert program("study", case, "-o", tmp_path / "program", "--quiet").returncode == 0
    study = arcslip.study(case, out=tmp_path / "python")
    study.to_csv(tmp_path / "copied")
    for name in ("optimum.csv", "sweep.csv"):
        expected = (tmp_path / "program" / name).read_bytes()
        assert (tmp_path / "python" / name).read_bytes() == expected
        assert (tmp_path / "copied" / name).read_bytes() == expected
    rows = rows_of(tmp_path / "program/optimum.csv")
    assert list(study.optimum["P_opt"]) == [float(row["P_opt"]) for row in rows]
    assert study.done == study.count == len(rows) and not study.interrupted


@pytest.mark.parametrize(
    "wrong",
    [
        {"set": ["system.mass_ratio=-1"]},
        {"set": ["system.masratio=1"]},
        {"set": ["branch.for_each.preload=[1, -1]"]},
        {"set": ["nonsense"]},
        {"set": ["continuation.tolerance=nan"]},
        {"set": ["branch.parameter=omega"]},
    ],
)
def test_wrong_input_is_what_the_program_says_in_one_line(cases, program, wrong):
    said = program("run", cases / "figure_8.toml", *[x for s in wrong["set"] for x in ("--set", s)])
    assert said.returncode == 1
    with pytest.raises(ValueError) as raised:
        arcslip.run(cases / "figure_8.toml", **wrong)
    assert str(raised.value) == said.stderr.rstrip("\n")
    with pytest.raises(ValueError):
        arcslip.check(cases / "figure_8.toml", **wrong)


def test_wrong_input_that_is_in_no_file_names_the_key():
    with pytest.raises(ValueError, match=r"^<dict>:\d+:\d+: branch.from: expected a finite number.*got \"a\"$"):
        arcslip.run({"system": {"model": "duffing"}, "branch": {"parameter": "W", "from": "a", "to": 1.0}})
    with pytest.raises(ValueError, match=r"^<text>:5:\d+: branch.parametr: unknown key"):
        arcslip.run(DUFFING.replace("parameter", "parametr"))
    with pytest.raises(ValueError, match="^branch.from: expected a string, a number"):
        arcslip.run({"branch": {"from": object()}})
    with pytest.raises(ValueError, match="missing.toml: cannot be read"):
        arcslip.run("missing.toml")
    with pytest.raises(TypeError, match="^case: expected a path"):
        arcslip.run(3)


def test_slips_are_warned_of_before_the_work_where_the_call_stands(cases):
    case = {"case": cases / "rods.toml", "set": ["branch.from=1100", "branch.to=1200"]}
    calls = [arcslip.check, lambda **case: arcslip.run(**case, progress=lambda *_: pytest.fail("the work has begun"))]
    for call in calls:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            with pytest.raises(arcslip.CaseWarning, match="no resonance of the base or the damper lies from eta = 1100"):
                call(**case)
    for call in (arcslip.check, arcslip.run):
        with pytest.warns(arcslip.CaseWarning, match="no contact slips from P = 1e.06") as told:
            call(cases / "preload_response.toml", set=["branch.from=2e6", "branch.to=1e6"])
        assert [pathlib.Path(one.filename).name for one in told] == ["test_cases.py"]


def test_slips_of_studies_are_warned_of(cases):
    text = (cases / "chart.toml").read_text()
    study = text[: text.index("for_each")].replace("from = 0.1", "from = 1e6").replace("to = 100.0", "to = 1.1e6")
    for call in (arcslip.check, arcslip.study):
        with pytest.warns(arcslip.CaseWarning, match="no contact slips from P = 1e.06 to P = 1.1e.06") as told:
            call(study)
        assert {pathlib.Path(one.filename).name for one in told} == {"test_cases.py"}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        arcslip.study(text[: text.index("for_each")])


def test_what_cannot_be_written_is_an_oserror(cases):
    with pytest.raises(OSError, match="/proc/none"):
        arcslip.run(cases / "rods.toml", out="/proc/none")


def test_progress_is_told_and_its_exception_comes_through(cases):
    told = []
    long = {"case": cases / "bratu_2d.toml", "set": ["continuation.max_step=0.01"]}
    arcslip.run(**long, progress=lambda *numbers: told.append(numbers))
    assert told and all(len(numbers) == 4 for numbers in told)

    def fails(*_):
        raise LookupError("of progress")

    with pytest.raises(LookupError, match="of progress"):
        arcslip.run(**long, progress=fails)


def test_ctrl_c_ends_the_work_with_what_was_traced(cases, tmp_path, interrupted):
    script = textwrap.dedent(
        f"""
        import warnings, arcslip, sys
        warnings.simplefilter("ignore")
        print("ready", flush=True)
        result = arcslip.run({str(cases / "bratu_2d.toml")!r}, out={str(tmp_path / "out")!r},
                             set=["continuation.max_step=1e-4", "continuation.max_points=10000000"])
        print(result.interrupted, result.branches[-1].stop, len(result.branches[-1]) > 1)
        """
    )
    assert interrupted(script) == "True interrupted True\n"
    assert json.loads((tmp_path / "out/summary.json").read_text())["interrupted"] is True


def test_the_program_goes_on_with_a_run_that_was_interrupted_here(cases, program, tmp_path):
    case = cases / "figure_8.toml"
    seen = []

    def interrupts(*numbers):
        seen.append(numbers)
        if len(seen) == 3:
            raise KeyboardInterrupt

    with pytest.warns(RuntimeWarning, match="interrupted"):
        slow = ["continuation.max_step=0.002"]
        result = arcslip.run(case, out=tmp_path / "part", set=slow, progress=interrupts)
    assert result.interrupted and (tmp_path / "part/run.checkpoint").exists()
    settings = [x for s in slow for x in ("--set", s)]
    assert program("run", case, "--resume", tmp_path / "part", "--quiet", *settings).returncode == 0
    assert program("run", case, "-o", tmp_path / "whole", "--quiet", *settings).returncode == 0
    for file in ("branches.csv", "curves.csv"):
        assert (tmp_path / "part" / file).read_bytes() == (tmp_path / "whole" / file).read_bytes()


def test_a_certificate_is_in_the_summary(cases):
    result = arcslip.run(cases / "rods.toml", set=["branch.to=1.5"], certify=True)
    assert "certificate" in result.summary["branches"][0]
    assert result.branches[0].certificate == result.summary["branches"][0]["certificate"]
    with pytest.raises(ValueError, match="certify is for forced responses"):
        arcslip.run(cases / "enz.toml", certify=True)


def test_a_picture_shows_the_columns(figure_8):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    ax = figure_8[0].plot()
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("eta", "Y")
    assert (ax.get_xscale(), ax.get_yscale()) == ("log", "log")
    assert [text.get_text() for text in ax.get_legend().get_texts()][0] == "preload = 0.1"
    lines = [line for line in ax.get_lines() if len(line.get_xdata()) > 100]
    assert len(lines) == 5
    assert np.nanmax(lines[1].get_ydata()) == pytest.approx(figure_8[0].branches[1]["Y"].max(), rel=1e-3)


def test_paths_may_be_of_bytes_or_pathlib(cases):
    assert arcslip.check(os.fsencode(cases / "rods.toml").decode()).good
    assert arcslip.check(pathlib.Path(cases / "rods.toml")).good


def test_branches_of_cases_are_gone_on_with_as_those_of_functions(cases):
    case = {"system": {"model": "cusp"}, "branch": {"parameter": "mu", "from": -2.0, "to": 2.0}}
    case["system"]["lambda"] = 1.0
    (branch,) = arcslip.run(case).branches
    fold = next(point for point in branch.special if point["type"] == "fold")
    curve = branch.continue_in_two(fold, "lambda", (-1.0, 2.0))
    assert any(point["type"] == "cusp" for point in curve.special)
    middle = branch.start_from(len(branch) // 2)
    assert middle.unknowns[-1] == pytest.approx(branch.unknowns[-1], abs=1e-8)
    part = branch.continue_in_two(fold, "lambda", (-1.0, 2.0), max_points=4)
    assert part.resume(max_points=1000).unknowns.tobytes() == curve.unknowns.tobytes()
    (of_case, *_) = arcslip.run(cases / "cusp_curve.toml").branches
    with pytest.raises(ValueError, match="start_from: not from a curve"):
        of_case.start_from(2)
    with pytest.raises(ValueError, match="events: only of problems that are written in Python"):
        branch.start_from(2, events={"a": lambda u, p: 0.0})
