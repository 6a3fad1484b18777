"""What pictures look like: told apart without colour, no text over another, the same bytes each time."""

import csv
import json
import math
import os
import pathlib
import subprocess
import sys
import time

import pytest

matplotlib = pytest.importorskip("matplotlib")
SOURCE = pathlib.Path(__file__).parents[2]
sys.path.insert(0, str(SOURCE / "plots"))

import numpy as np  # noqa: E402
import pictures  # noqa: E402
from pictures import folder as folders  # noqa: E402
from pictures import style  # noqa: E402

PROGRAM = os.environ.get("ARCSLIP_PROGRAM", str(SOURCE / "build/release/bin/arcslip"))
PLOT = SOURCE / "plots/plot.py"


def run(case, folder, *settings, command="run"):
    more = [word for setting in settings for word in ("--set", setting)]
    path = SOURCE / "problems" / f"{case}.toml"
    subprocess.run([PROGRAM, command, path, "-o", folder, "--quiet", *more], check=True, capture_output=True)
    return folder


LIBRARY = ["ab", "cusp", "enz", "pp2", "freudenstein_roth", "lorenz84", "lure", "bratu", "duffing"]
FORMULAS = ["brusselator", "henon", "morris_lecar"]
ORBITS = ["buckling_boundary"]


@pytest.fixture(scope="session")
def results(tmp_path_factory):
    root = tmp_path_factory.mktemp("results")
    cases = {name: name for name in ["figure_8", "stability", "border", *LIBRARY, *FORMULAS, *ORBITS]} | {"rotor": "rotor_ring"}
    return {name: run(case, root / name) for name, case in cases.items()}


@pytest.fixture(autouse=True, scope="session")
def settings():
    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(style.SETTINGS)
        yield


def figures_of(folder, **options):
    found = folders.pictures_of(str(folder), pictures.Options(**options))
    return {name: draw() for name, draw in found.items()}


def texts_of(figure):
    """What is written outside the panels, and the labels of axes, with their extents."""
    renderer = figure.canvas.get_renderer()
    figure.draw_without_rendering()
    found = list(figure.texts)
    for ax in figure.axes:
        for axis in (ax.xaxis, ax.yaxis):
            found += [tick.label2 if axis.get_ticks_position() == "right" else tick.label1 for tick in axis.get_major_ticks()]
    found = [text for text in found if text.get_text() and text.get_visible()]
    return [(text.get_text(), text.get_window_extent(renderer)) for text in found]


def overlap(a, b):
    return min(a.x1, b.x1) - max(a.x0, b.x0) > 1 and min(a.y1, b.y1) - max(a.y0, b.y0) > 1


def check_layout(figure):
    texts = texts_of(figure)
    page = figure.bbox
    for i, (text, box) in enumerate(texts):
        assert box.x0 >= page.x0 - 1 and box.x1 <= page.x1 + 1 and box.y0 >= page.y0 - 1 and box.y1 <= page.y1 + 1, text
        for other, other_box in texts[:i]:
            assert not overlap(box, other_box), (text, other)
        for ax in figure.axes:
            assert not overlap(box, ax.get_window_extent()), text


@pytest.mark.parametrize("name", ["figure_8", "rotor", "stability", "pp2", "border"])
def test_no_text_lies_over_another_or_over_a_panel(results, name):
    for figure in figures_of(results[name]).values():
        check_layout(figure)


def test_long_names_of_many_branches_stay_within_the_page(results, tmp_path):
    for name in ("branches.csv", "curves.csv"):
        os.link(results["figure_8"] / name, tmp_path / name)
    summary = json.loads((results["figure_8"] / "summary.json").read_text())
    for i, branch in enumerate(summary["branches"]):
        branch["values"] = {f"a_long_name_of_a_key_{k}": 123456.7 + i for k in range(4)}
    (tmp_path / "summary.json").write_text(json.dumps(summary))
    figure = figures_of(tmp_path, only=["amplitude"])["amplitude"]
    check_layout(figure)
    assert any(text.endswith("…") for text, _ in texts_of(figure))


def test_every_colour_of_a_curve_has_a_contrast_of_three_to_white():
    for count in [*range(1, 40), 200]:
        assert min(style.contrast(colour) for colour in style.colours(count)) >= 3, count
    assert style.contrast(style.GREY) >= 3 and style.contrast(style.COMMON) >= 3
    assert style.contrast("#FFFFFF") == pytest.approx(1) and style.contrast("#000000") == pytest.approx(21)


def test_few_curves_are_told_apart_without_colour_and_many_by_lightness():
    for count in range(2, len(style.DASHES) + 1):
        looks = [style.Look(i, count) for i in range(count)]
        assert len({look.dash for look in looks}) == count and len({look.mark for look in looks}) == count
    darkness = [style.contrast(colour) for colour in style.colours(60)]
    assert all(a > b for a, b in zip(darkness, darkness[1:]))


def test_stuck_parts_that_coincide_are_drawn_once_and_named(results):
    figure = figures_of(results["figure_8"], only=["amplitude"])["amplitude"]
    assert "stick, the same for all" in [text for text, _ in texts_of(figure)]
    whole = figure.axes[0]
    lines = [line for line in whole.lines if line.get_color() == style.COMMON]
    x = np.concatenate([line.get_xdata() for line in lines])
    y = np.concatenate([line.get_ydata() for line in lines])
    # Where P = 50 sticks, at eta = 1 for one, there is one line, at the height that the table tells.
    assert np.count_nonzero((x[:-1] < 1) & (x[1:] >= 1)) == 1
    table = np.genfromtxt(results["figure_8"] / "branches.csv", delimiter=",", names=True)
    first = table[table["branch"] == 4]
    assert np.interp(1.0, x[: np.argmax(x > 2)], y[: np.argmax(x > 2)]) == pytest.approx(
        np.interp(1.0, first["eta"], first["Y"]), rel=1e-3)
    drawn = [line for line in whole.lines if line.get_color() in style.FEW and line.get_linewidth() == style.THIN]
    assert not drawn
    # R/S is another for each preload.
    figure = figures_of(results["figure_8"], only=["relative"])["relative"]
    assert "stick" in [text for text, _ in texts_of(figure)]
    assert not [line for line in figure.axes[0].lines if line.get_color() == style.COMMON]


def test_windows_enlarge_where_peaks_crowd(results):
    figure = figures_of(results["figure_8"], only=["amplitude"])["amplitude"]
    assert [text.get_text() for text in figure.texts if text.get_fontweight() == "bold"] == ["a", "b", "c", "b", "c"]
    (_, first, second) = figure.axes
    assert first.get_xlim()[0] < 3.67 < 4.0 < first.get_xlim()[1] < 6
    assert second.get_xlim()[0] < 93.6 < second.get_xlim()[1] < 110


def test_si_columns_are_drawn_with_their_units(results):
    figure = figures_of(results["rotor"], only=["amplitude"])["amplitude"]
    texts = " ".join(text for text, _ in texts_of(figure))
    assert "(Hz)" in texts and "(µm)" in texts and "N/m" in texts
    table = np.genfromtxt(results["rotor"] / "branches.csv", delimiter=",", names=True)
    top = max(np.nanmax(line.get_ydata()) for line in figure.axes[0].lines if len(line.get_ydata()))
    assert top == pytest.approx(table["Y_m"].max() * 1e6, rel=1e-3)


def test_preloads_that_are_forces_are_drawn_in_newtons(tmp_path):
    units = ['system.units="SI"', "system.force=10"]
    over = ['branch.parameter="P"', "branch.eta=1", "branch.from=1", "branch.to=30", "branch.for_each={ force = [10.0] }"]
    keys = ["study.from=1", "study.to=100", "study.for_each={ contact_stiffness = [0.4, 0.5, 0.6] }"]
    run("spring_mass", tmp_path, *units, *over)
    amplitude = figures_of(tmp_path, only=["amplitude"])["amplitude"]
    assert amplitude.axes[0].get_xlim()[1] > 25
    assert "(N)" in " ".join(text for text, _ in texts_of(amplitude))
    study = tmp_path / "study"
    run("spring_mass", study, *units, *keys, command="study")
    drawn = figures_of(study)
    assert len(drawn) > 1
    for figure in drawn.values():
        assert "preload" in (told := " ".join(text for text, _ in texts_of(figure))) and "(N)" in told
        check_layout(figure)


def test_heights_stand_alone_where_the_free_base_has_none(tmp_path):
    keys = ["study.from=0.1", "study.to=10", "study.for_each={ contact_stiffness = [0.4, 0.5, 0.6] }"]
    run("spring_mass", tmp_path, *keys, command="study")
    for table, column in (("sweep.csv", "ratio"), ("optimum.csv", "ratio_opt")):
        with open(tmp_path / table, newline="") as file:
            rows = list(csv.DictReader(file))
        with open(tmp_path / table, "w", newline="") as file:
            writer = csv.DictWriter(file, rows[0])
            writer.writeheader()
            writer.writerows({**row, column: "nan"} for row in rows)
    drawn = figures_of(tmp_path)
    assert {"ratio", "peaks", "optimum"} <= set(drawn)
    for figure in drawn.values():
        told = " ".join(text for text, _ in texts_of(figure))
        assert "nothing to show" not in told and "ND" not in told and "$Y$" in told
        check_layout(figure)


def test_any_columns_are_drawn_over_one_another(results):
    options = dict(x="frequency_Hz", y=["Y_um", "R_over_S"], linear={"y"}, ranges={"x": (2200, 2400)}, size=(12, 9))
    ((name, figure),) = figures_of(results["rotor"], **options).items()
    assert name == "Y_um_R_over_S_over_frequency_Hz" and len(figure.axes) == 2
    assert figure.axes[0].get_xlim() == (2200, 2400) and figure.axes[0].get_yscale() == "linear"
    assert figure.get_size_inches() * 2.54 == pytest.approx([12, 9])
    check_layout(figure)
    with pytest.raises(pictures.Refused, match=r"^Y_parsec: .*has no column of this name; there are eta, P, R, .*Y_m"):
        figures_of(results["rotor"], y=["Y_parsec"])
    with pytest.raises(pictures.Refused, match="no picture none; there are amplitude, relative"):
        figures_of(results["rotor"], only=["none"])


def test_bands_of_quantiles_hold_what_the_table_tells(tmp_path):
    header = "curve,mass_ratio,P_opt,eta_opt,Y_opt,ratio_opt,kind,P_low,P_high\n"
    (tmp_path / "optimum.csv").write_text(header + "0,5,1,4,1,0.1,smooth,0.5,2\n1,20,2,4,1,0.2,smooth,0.5,2\n")
    rows = [f"{c},{p},{p * 0.1 + c},{p * 0.2 + c},{p * 0.3 + c}" for c in (0, 1) for p in (1, 2, 4, 8)]
    (tmp_path / "quantiles.csv").write_text("curve,P,Y_q5,Y_q50,Y_q95\n" + "\n".join(rows) + "\n")
    (tmp_path / "summary.json").write_text('{"case": {"study": {"sweep": false}}}')
    drawn = figures_of(tmp_path)
    assert list(drawn) == ["optimum", "quantiles"]
    check_layout(drawn["quantiles"])
    first, second = (band.get_paths()[0].vertices for band in drawn["quantiles"].axes[0].collections)
    assert first[:, 1].min() == pytest.approx(0.1) and first[:, 1].max() == pytest.approx(2.4)
    assert second[:, 1].min() == pytest.approx(1.1) and second[:, 1].max() == pytest.approx(3.4)
    assert "50 % stay below" in [text for text, _ in texts_of(drawn["quantiles"])]


def test_maps_have_their_labels_beside_them(tmp_path):
    rows = [f"{i},{m},{g},{1 + i},4,1,{0.01 * (1 + i)},{'failed' if i == 5 else 'smooth'},0.5,2"
            for i, (m, g) in enumerate((m, g) for m in (1, 3, 100) for g in (1, 2, 3))]
    rows[5] = rows[5].replace(",6,4,1,0.06,", ",nan,nan,nan,nan,")
    header = "curve,mass_ratio,frequency_ratio,P_opt,eta_opt,Y_opt,ratio_opt,kind,P_low,P_high\n"
    (tmp_path / "optimum.csv").write_text(header + "\n".join(rows) + "\n")
    (tmp_path / "summary.json").write_text('{"case": {"study": {"sweep": false}}}')
    drawn = figures_of(tmp_path)
    assert list(drawn) == ["optimum_preload", "attenuation"]
    for figure in drawn.values():
        check_layout(figure)
        assert "not found" in [text for text, _ in texts_of(figure)]
        assert figure.axes[0].get_xscale() == "log" and figure.axes[0].get_yscale() == "linear"
        values = figure.axes[0].collections[0].get_array()
        assert 0 < np.ma.count_masked(values) < values.size / 2  # the gap of the design that failed


def test_the_same_bytes_come_out_each_time_in_every_format(results, tmp_path):
    """Whatever the user's own settings are, and where nothing can be kept."""
    made = []
    for where, more in (("a", {}), ("b", {"MPLCONFIGDIR": "/proc/nowhere", "TZ": "Asia/Tokyo"})):
        folder = tmp_path / where
        folder.mkdir()
        for name in ("branches.csv", "curves.csv", "summary.json"):
            os.link(results["pp2"] / name, folder / name)
        formats = [f"--format={kind}" for kind in folders.FORMATS]
        said = subprocess.run([sys.executable, PLOT, folder, "--only=branch", *formats], env={**os.environ, **more},
                              capture_output=True, text=True)
        assert (said.returncode, said.stderr) == (0, "")
        assert said.stdout.split() == [str(folder / f"branch.{kind}") for kind in folders.FORMATS]
        made.append({path.name: path.read_bytes() for path in folder.iterdir()})
        time.sleep(1.1 if where == "a" else 0)  # a date would tell
    assert made[0] == made[1]
    assert made[0]["branch.pdf"].startswith(b"%PDF") and made[0]["branch.eps"].startswith(b"%!PS-Adobe-3.0 EPSF")


@pytest.mark.parametrize("wrong, said", [
    (["--range", "x=3:1"], "expected x=LOW:HIGH or y=LOW:HIGH with LOW < HIGH, got x=3:1"),
    (["--size", "1x1"], "expected WIDTHxHEIGHT in cm, both from 4 to 100, got 1x1"),
])
def test_options_that_are_wrong_are_refused_in_one_line(results, wrong, said):
    before = sorted(os.listdir(results["pp2"]))
    outcome = subprocess.run([PROGRAM, "plot", results["pp2"], *wrong], capture_output=True, text=True,
                             env={**os.environ, "ARCSLIP_PYTHON": sys.executable})
    assert outcome.returncode == 2 and outcome.stderr.count("\n") == 1 and said in outcome.stderr
    assert sorted(os.listdir(results["pp2"])) == before


def test_a_picture_of_four_hundred_designs_is_drawn_within_seconds(tmp_path):
    rows = [f"{i},{m:.17g},{g},{1 + 0.01 * i},4,1,{0.01 + 1e-4 * i},smooth,0.5,2"
            for i, (m, g) in enumerate((math.exp(0.2 * m), 1 + 0.2 * g) for m in range(20) for g in range(20))]
    header = "curve,mass_ratio,frequency_ratio,P_opt,eta_opt,Y_opt,ratio_opt,kind,P_low,P_high\n"
    (tmp_path / "optimum.csv").write_text(header + "\n".join(rows) + "\n")
    (tmp_path / "summary.json").write_text('{"case": {"study": {"sweep": false}}}')
    begin = time.process_time()
    pictures.draw_folder(str(tmp_path), pictures.Options(only=["attenuation"]))
    assert time.process_time() - begin < 10


@pytest.mark.parametrize("problem", [*LIBRARY, *FORMULAS, *ORBITS])
def test_branches_of_every_problem_of_the_library_and_of_formulas_are_drawn(results, problem):
    (figure,) = figures_of(results[problem], only=["branch"]).values()
    texts = [text for text, _ in texts_of(figure)]
    assert ("stable" in texts) == (problem in ("ab", "cusp", "enz", "pp2", "duffing", "lure", *FORMULAS))
    assert ("Hopf" in texts) == (problem in ("ab", "lorenz84", "pp2", "brusselator", "morris_lecar"))
    assert ("period doubling" in texts) == (problem in ("lure", "henon"))


def test_both_ends_of_what_an_unknown_runs_through_share_a_panel(results):
    (figure,) = figures_of(results["buckling_boundary"], only=["branch"]).values()
    assert {"angle", "moment", "norm"} <= {text for text, _ in texts_of(figure)}
    heights = np.concatenate([line.get_ydata() for line in figure.axes[0].lines])
    assert np.nanmax(heights) == pytest.approx(3.0876433, abs=1e-6) and np.nanmin(heights) == pytest.approx(-3.0876433, abs=1e-6)


@pytest.mark.parametrize("rows", [1, 2, 3, 700])
def test_what_there_is_of_a_run_that_was_cut_short_is_drawn(results, tmp_path, rows):
    lines = (results["figure_8"] / "branches.csv").read_text().splitlines(keepends=True)
    (tmp_path / "branches.csv").write_text("".join(lines[: rows + 1]))
    for name in ("curves.csv", "summary.json"):
        os.link(results["figure_8"] / name, tmp_path / name)
    os.utime(tmp_path / "branches.csv")
    figures = figures_of(tmp_path)
    assert list(figures) == ["amplitude", "relative", "phases", "phase_difference", "dissipated"]
    for figure in figures.values():
        content = folders.figure_bytes(figure, "svg")
        assert len(content) > 2000 and content.rstrip().endswith(b"</svg>")


def test_a_key_that_would_be_empty_is_left_out(tmp_path):
    heights = {}
    for value in (-1, 1):
        run("cusp", tmp_path / str(value), f"system.lambda={value}")
        (figure,) = figures_of(tmp_path / str(value)).values()
        heights[value] = figure.get_figheight()
    assert heights[-1] < heights[1]  # without folds all is stable


def test_a_table_without_the_columns_that_its_case_tells_of_is_refused(results, tmp_path):
    table = (results["cusp"] / "branches.csv").read_text()
    (tmp_path / "branches.csv").write_text("branch,point,type,regime,x,arclength" + table[table.index("\n"):])
    os.link(results["cusp"] / "summary.json", tmp_path / "summary.json")
    check_refused(tmp_path, "branches.csv: has no column mu")


GOOD = ("curve,mass_ratio,P_opt,eta_opt,Y_opt,ratio_opt,kind,P_low,P_high\n"
        "0,5,1,4,0.02,0.01,smooth,0.5,2\n1,20,1.1,4,0.04,0.02,smooth,0.5,2\n2,100,1.2,4,0.06,0.03,smooth,0.5,2\n")
SWEEP = "curve,peak_branch,P,eta_peak,Y_max,Y_nd_max,ratio,R_over_S,dissipated,is_global,type,site\n"


@pytest.mark.parametrize("optimum, sweep, said", [
    (GOOD.splitlines()[0] + "\n", "", "optimum.csv: holds no designs"),
    ("curve,mass_ratio\n0,5\n", "", "has no column P_opt"),
    (GOOD + "3,7\n", "", "line 5 has 2 fields; expected 9"),
    (GOOD, SWEEP, "sweep.csv: holds no peaks"),
    (GOOD.replace("mass_ratio,", "").replace(",5,1,4", ",1,4").split("1,20")[0], "", "nothing to draw"),
    (GOOD.replace("mass_ratio", "model").replace(",5,1", ",rods,1").split("1,20")[0], "", "nothing to draw"),
])
def test_a_studys_folder_that_lacks_something_is_refused_in_one_line(tmp_path, optimum, sweep, said):
    (tmp_path / "optimum.csv").write_text(optimum)
    if sweep:
        (tmp_path / "sweep.csv").write_text(sweep)
    (tmp_path / "summary.json").write_text(json.dumps({"case": {"study": {"sweep": bool(sweep)}}}))
    check_refused(tmp_path, said)


@pytest.mark.parametrize("table, summary, said", [
    ("", "", "summary.json: cannot be read"),
    ("", "{}", "branches.csv: cannot be read"),
    ("header", "{}", "branches.csv: holds no points"),
    ("branch,point\n0,0\n", "{}", "branches.csv: has no column type"),
    ("whole", "", "summary.json: cannot be read"),
    ("whole", "cut", "summary.json: is not JSON"),
    ("whole", "[1, 2]", "summary.json: is not a summary"),
])
def test_a_folder_without_results_is_refused_in_one_line_that_names_the_file(results, tmp_path, table, summary, said):
    whole = (results["figure_8"] / "branches.csv").read_text()
    good = (results["figure_8"] / "summary.json").read_text()
    if table:
        (tmp_path / "branches.csv").write_text({"whole": whole, "header": whole.split("\n")[0] + "\n"}.get(table, table))
    if summary:
        (tmp_path / "summary.json").write_text({"{}": good, "cut": good[: len(good) // 2]}.get(summary, summary))
    check_refused(tmp_path, said)


def check_refused(folder, said):
    before = sorted(os.listdir(folder))
    with pytest.raises(pictures.Refused) as refused:
        pictures.draw_folder(str(folder))
    message = str(refused.value)
    assert message.startswith(str(folder)) and said in message and "\n" not in message
    assert sorted(os.listdir(folder)) == before


def write_modes(folder, speed, has_hertz=True):
    """Two modes of the base at 100 (1 + n) and 1000 Hz, one of the damper and of both."""
    rows = []
    for n in range(7):
        modes = [("base", 1, 100 * (1 + n)), ("base", 2, 1000), ("damper", 1, 40 * n + 20), ("stuck", 1, 120 * (1 + n))]
        rows += [f"{n},{part},{mode},{f / 100},{f},0.001" if has_hertz else f"{n},{part},{mode},{f / 100},0.001"
                 for part, mode, f in modes]
    header = "wave_number,part,mode,eta,frequency_Hz,zeta" if has_hertz else "wave_number,part,mode,eta,zeta"
    (folder / "modes.csv").write_text(header + "\n" + "\n".join(rows) + "\n")
    (folder / "modes.json").write_text(json.dumps({"arcslip": "0", "nodes": 12, "speed_per_minute": speed}))


def test_modes_are_drawn_over_the_diameters_that_engine_orders_meet(tmp_path):
    write_modes(tmp_path, 9000)  # 150 Hz
    figure = figures_of(tmp_path)["modes"]
    check_layout(figure)
    texts = [text for text, _ in texts_of(figure)]
    assert {"base", "damper", "both, stuck", "engine orders to 24 at 9000/min", "crossing"} <= set(texts)
    lines = figure.axes[0].lines
    (zigzag,) = [line for line in lines if line.get_color() == style.GREY and line.get_marker() == "None"]
    assert list(zigzag.get_xdata()[:8]) == [0, 1, 2, 3, 4, 5, 6, 5]  # order 7 of 12 sectors has 5 diameters
    assert list(zigzag.get_ydata()[:8]) == [0, 150, 300, 450, 600, 750, 900, 750 + 300]
    marks = [np.column_stack(line.get_data()) for line in lines if line.get_marker() == "x"]
    met = np.concatenate(marks)
    # 150 m = 100 (1 + m) at m = 2; 150 m = 120 (1 + m) at m = 4; on the way back, 150 m = 1000 at m = 6 2/3.
    expected = np.array([[2, 300], [4, 600], [12 - 20 / 3, 1000]])
    for place in expected:
        assert np.isclose(met, place).all(axis=1).any(), place
    assert all(np.isclose(y, 150 * x) or np.isclose(y, 150 * (12 - x)) for x, y in met)
    looks = {(line.get_color(), line.get_marker()) for line in lines if line.get_marker() in style.LINE_MARKS}
    assert len(looks) == 3 and len({mark for _, mark in looks}) == 3


def test_modes_without_speed_or_units_have_no_engine_orders(tmp_path):
    for speed, has_hertz in ((None, True), (9000, False)):
        write_modes(tmp_path, speed, has_hertz)
        figure = figures_of(tmp_path)["modes"]
        assert not [line for line in figure.axes[0].lines if line.get_color() == style.GREY]
    assert pictures.draw_folder(str(tmp_path), pictures.Options(formats=["svg"])) == [str(tmp_path / "modes.svg")]
    with pytest.raises(pictures.Refused, match="holds modes alone"):
        figures_of(tmp_path, y=["zeta"])
    (tmp_path / "modes.json").write_text('{"nodes": "many"}')
    with pytest.raises(pictures.Refused, match="modes.json: does not tell nodes and speed_per_minute"):
        figures_of(tmp_path)


def test_damping_is_drawn_over_nodal_diameters_both_ways_round(tmp_path):
    write_modes(tmp_path, None)
    rows = [f"{n},{mode},{R},0.2,{zeta}" for R in (0.5, 2) for mode in (1, 2) for n, zeta in ((-1, 0.01 * R), (1, -0.01 * mode), (0, 0))]
    (tmp_path / "damping.csv").write_text("wave_number,mode,R,eta,zeta\n" + "\n".join(rows) + "\n")
    figures = figures_of(tmp_path)
    assert list(figures) == ["modes", "damping"]
    figure = figures["damping"]
    check_layout(figure)
    assert {"R = 0.5", "R = 2", "nodal diameter"} <= {text for text, _ in texts_of(figure)}
    curves = [np.column_stack(line.get_data()) for line in figure.axes[0].lines if len(line.get_xdata()) == 3]
    for R in (0.5, 2):  # first modes alone, in the order of the diameters
        assert any(np.allclose(curve, [[-1, 0.01 * R], [0, 0], [1, -0.01]]) for curve in curves)


def test_campbell_diagrams_have_both_directions_engine_orders_and_crossings(tmp_path):
    write_modes(tmp_path, None)
    rows, met = [], []
    for part, f in (("base", 100), ("stuck", 140)):
        for wave in (3, -3):
            rows += [f"{s},{wave},{part},1,{f - wave * s / 3},0.001" for s in range(0, 21)]
        met.append(f"3,-3,{part},1,{f / 2},{3 * f / 2}")  # 3 s = f + s
    (tmp_path / "campbell.csv").write_text("speed,wave_number,part,mode,eta,zeta\n" + "\n".join(rows) + "\n")
    (tmp_path / "crossings.csv").write_text("engine_order,wave_number,part,mode,speed,eta\n" + "\n".join(met) + "\n")
    drawn = figures_of(tmp_path)
    assert list(drawn) == ["modes", "campbell"]
    figure = drawn["campbell"]
    check_layout(figure)
    texts = [text for text, _ in texts_of(figure)]
    names = {f"{part}, {way}" for part in ("base", "both, stuck") for way in ("forward", "backward")}
    assert names | {"engine orders", "crossing"} <= set(texts)
    lines = figure.axes[0].lines
    (order,) = [line for line in lines if line.get_color() == style.GREY and line.get_marker() == "None"]
    assert np.allclose(order.get_ydata(), 3 * np.asarray(order.get_xdata()))
    marks = np.concatenate([np.column_stack(line.get_data()) for line in lines if line.get_marker() == "x"])
    assert sorted(map(tuple, marks)) == [(50, 150), (70, 210)]


def run_with_modes(case, folder):
    run(case, folder)
    path = SOURCE / "problems" / f"{case}.toml"
    subprocess.run([PROGRAM, "modes", path, "--campbell", "0", "60", "-o", folder, "--quiet"], check=True, capture_output=True)
    return figures_of(folder)["campbell"]


def test_peaks_over_frequency_and_speed_lie_in_the_campbell_diagram_between_free_and_stuck(tmp_path):
    figure = run_with_modes("turning_disk_peaks", tmp_path)
    check_layout(figure)
    texts = [text for text, _ in texts_of(figure)]
    assert {"peak, $P$ = 0.5", "peak, $P$ = 2", "peak, $P$ = 4"} <= set(texts)
    lines = {}
    for line in figure.axes[0].lines:
        if len(line.get_xdata()) > 10 and line.get_color() != style.GREY:
            points = np.column_stack(line.get_data())
            lines.setdefault(line.get_color(), points[np.isfinite(points).all(axis=1)])
    colours = style.colours(7)
    free, stuck = lines[colours[1]], lines[colours[3]]  # backward
    below = np.interp(np.linspace(0, 60, 61), *free.T)
    for colour in colours[4:]:
        peaks = lines[colour]
        assert peaks[:, 0].min() == 0 and peaks[:, 0].max() == 60
        at = np.interp(np.linspace(0, 60, 61), *peaks[np.argsort(peaks[:, 0])].T)
        assert (at > below).all() and (at < np.interp(np.linspace(0, 60, 61), *stuck.T)).all()
        below = at  # the higher the preload, the nearer to sticking


def test_peaks_over_the_speed_of_an_engine_order_are_marked_on_its_line(tmp_path):
    figure = run_with_modes("turning_disk", tmp_path)
    check_layout(figure)
    assert "peak" in [text for text, _ in texts_of(figure)]
    (marks,) = [line for line in figure.axes[0].lines if line.get_marker() == style.KINDS["peak"][1]]
    assert len(marks.get_xdata()) >= 2
    assert np.allclose(marks.get_ydata(), 3 * np.asarray(marks.get_xdata()))


def test_modes_are_drawn_beside_a_run(results, tmp_path):
    for name in ("branches.csv", "curves.csv", "summary.json"):
        os.link(results["pp2"] / name, tmp_path / name)
    write_modes(tmp_path, None)
    assert list(figures_of(tmp_path)) == ["branch", "modes"]


def test_a_surface_is_drawn_over_both_parameters(tmp_path):
    run("tank_surface", tmp_path)
    names = sorted(pathlib.Path(path).name for path in folders.draw_folder(str(tmp_path)))
    assert names == ["surface.png", "surface.svg"]
    first = (tmp_path / "surface.svg").read_bytes()
    folders.draw_folder(str(tmp_path))
    assert (tmp_path / "surface.svg").read_bytes() == first
