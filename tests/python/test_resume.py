"""Runs that are proven, verified, interrupted and gone on with."""

import csv

import numpy as np
import pytest

import arcslip

SLOW = ["continuation.max_step=0.0004", "branch.to=6.0", "branch.for_each.preload=[0.1, 1.0, 5.0]"]


def interrupting(after):
    """A progress function that is Ctrl-C in the second branch."""
    seen = []

    def progress(*numbers):
        seen.append(numbers)
        if numbers[0] >= 1 and len(seen) > after:
            raise KeyboardInterrupt

    return progress


def interrupted(case, **options):
    with pytest.warns(RuntimeWarning, match="interrupted"):
        return arcslip.run(case, set=SLOW, progress=interrupting(0), **options)


@pytest.fixture(scope="module")
def whole(cases, tmp_path_factory):
    folder = tmp_path_factory.mktemp("whole")
    return arcslip.run(cases / "figure_8.toml", out=folder, set=SLOW), folder


def test_a_run_in_a_folder_is_resumed_to_the_same_tables(cases, whole, tmp_path):
    part = interrupted(cases / "figure_8.toml", out=tmp_path)
    assert part.interrupted and part.branches[-1].stop == "interrupted" and len(part.branches) == 2
    result = arcslip.run(cases / "figure_8.toml", set=SLOW, resume=tmp_path)
    for file in ("branches.csv", "curves.csv"):
        assert (tmp_path / file).read_bytes() == (whole[1] / file).read_bytes()
    assert not (tmp_path / "run.checkpoint").exists()
    assert len(result.branches) == 3 and not result.interrupted
    for mine, theirs in zip(result.branches, whole[0].branches):
        assert mine.columns == theirs.columns and mine.values == theirs.values and mine.stop == theirs.stop
        assert all(np.array_equal(mine[name], theirs[name], equal_nan=True) for name in ("eta", "Y", "R", "arclength"))
        assert [p["type"] for p in mine.special] == [p["type"] for p in theirs.special]
    with pytest.raises(ValueError, match="sample: of a branch that was traced before the run was resumed"):
        result.branches[0].sample(10)
    result.to_csv(tmp_path / "copy")
    assert (tmp_path / "copy/branches.csv").read_bytes() == (whole[1] / "branches.csv").read_bytes()


def test_a_run_at_hand_is_resumed(cases, whole, tmp_path):
    part = interrupted(cases / "figure_8.toml")
    result = arcslip.run(cases / "figure_8.toml", set=SLOW, resume=part, out=tmp_path)
    assert not result.interrupted and len(result.branches) == 3
    for mine, theirs in zip(result.branches, whole[0].branches):
        assert mine.unknowns.tobytes() == theirs.unknowns.tobytes()
    for file in ("branches.csv", "curves.csv"):
        assert (tmp_path / file).read_bytes() == (whole[1] / file).read_bytes()


def test_other_runs_are_not_resumed(cases, tmp_path):
    with pytest.raises(ValueError, match="run.checkpoint: resume: there is no interrupted run in this folder"):
        arcslip.run(cases / "rods.toml", resume=tmp_path)
    part = interrupted(cases / "figure_8.toml", out=tmp_path)
    with pytest.raises(ValueError, match="it is a run of another case, which differs in"):
        arcslip.run(cases / "rods.toml", resume=tmp_path)
    with pytest.raises(ValueError, match="^resume: it is a run of another case"):
        arcslip.run(cases / "rods.toml", resume=part, out=tmp_path / "other")
    with pytest.raises(ValueError, match="^out: .* goes on there"):
        arcslip.run(cases / "figure_8.toml", resume=tmp_path, out=tmp_path / "other")


MASS = """[system]
model = "spring_mass"
base = { mass = [1.0], stiffness = [1.0] }
contact_stiffness = 0.5
damping = { base = 0.01 }
force = 1.0
preload = 0.7

[branch]
parameter = "eta"
from = 0.8
to = 1.4
"""


def test_verification_is_the_programs_table(cases, program, tmp_path):
    case = tmp_path / "mass.toml"
    case.write_text(MASS)
    assert program("run", case, "--verify", "-o", tmp_path / "program", "--quiet").returncode == 0
    result = arcslip.run(case, verify=True, out=tmp_path / "python")
    result.to_csv(tmp_path / "afterwards")
    expected = (tmp_path / "program/verify.csv").read_bytes()
    assert (tmp_path / "python/verify.csv").read_bytes() == expected
    assert (tmp_path / "afterwards/verify.csv").read_bytes() == expected
    rows = list(csv.DictReader(expected.decode().splitlines()))
    (branch,) = result.branches
    assert list(branch.verification["Y_harmonics"]) == [float(row["Y_harmonics"]) for row in rows]
    assert branch["Y"][branch.verification["point"]] == pytest.approx(branch.verification["Y"], rel=1e-12)
    assert branch.certificate is None
    with pytest.raises(ValueError, match="verify is for forced responses, not for"):
        arcslip.run(cases / "enz.toml", verify=True)
