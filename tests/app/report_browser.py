"""Reports as Chromium shows them: that pictures and tables hold the numbers of the files, that they can be used, and that
nothing is asked for from elsewhere.

    report_browser.py PROGRAM CASES

Exit status 77, skipped, where there is no Chromium or no plotly.js, but not where CI is set.
"""

import json
import math
import os
import sys
import unittest

sys.dont_write_bytecode = True
import chromium  # noqa: E402
import report_page  # noqa: E402
# What else unittest.main finds here.
from report_of_studies import Chart, MassesInUnits, Scatter  # noqa: E402, F401
from report_page import Report, contrast, number  # noqa: E402

SKIPPED = 77


class Figure8(Report):
    """A run with certificates."""

    @classmethod
    def setUpClass(cls):
        cls.make(("run", "figure_8", "--certify"))

    def test_nothing_comes_from_elsewhere(self):
        self.check_nothing_outside()

    def test_it_fits_a_phone(self):
        self.check_phone()

    def test_curves_hold_all_points_and_stuck_branches_once(self):
        table = self.table("curves.csv")
        drawn = self.assertHolds("amplitude", table, "eta", "Y")
        self.assertEqual(self.assertHolds("relative", table, "eta", "R_over_S"), set(range(len(table))))
        left_out = set(range(len(table))) - drawn
        self.assertGreater(len(left_out), 1000)
        self.assertEqual({table[row]["regime"] for row in left_out}, {"stick"})
        # Each point that is left out lies on what is drawn for all.
        common = sorted((x, y) for trace in self.traces("amplitude") if "common" in trace["keys"]
                        for x, y in zip(trace["x"], trace["y"]) if x is not None)
        for row in list(left_out)[::50]:
            x, y = float(table[row]["eta"]), float(table[row]["Y"])
            above = next((i for i, point in enumerate(common) if point[0] >= x), len(common) - 1)
            low, high = common[max(0, above - 1)], common[above]
            at = low[1] + (high[1] - low[1]) * (x - low[0]) / (high[0] - low[0] or 1)
            self.assertNear(at, y, 0.01)

    def test_special_points_are_those_of_the_summary_in_pictures_and_table(self):
        with open(os.path.join(self.folder, "summary.json")) as file:
            summary = json.load(file)
        special = [point for branch in summary["branches"] for point in branch["special"]]
        drawn = [(x, y) for trace in self.traces("amplitude") if trace["keys"][0].startswith("type ") for x, y in zip(trace["x"], trace["y"])]
        wanted = [point for point in special if point["type"] in ("peak", "trough", "switch")]
        self.assertEqual(len(drawn), len({(point["type"], f"{point['eta']:.8g}", f"{point['Y']:.8g}") for point in wanted}))
        for point in wanted:
            self.assertTrue(any(math.isclose(x, point["eta"], rel_tol=1e-9) and math.isclose(y, point["Y"], rel_tol=1e-8) for x, y in drawn))
        columns = self.columns("special")
        cells = self.cells("special")
        self.assertEqual(len(cells), len(special))
        for shown, point in zip(cells, special):
            for name in ("eta", "P", "R_over_S", "Y"):
                self.assertEqual(float(shown[columns.index(name)]), point[name])

    def test_branches_can_be_told_without_colour(self):
        symbols = [trace["marker"]["symbol"] for trace in self.traces("amplitude") if trace["mode"] == "markers" and trace["keys"][0].startswith("branch")]
        self.assertEqual(len(set(symbols)), 5)
        widths = {part: {trace["line"]["width"] for trace in self.traces("amplitude") if part in trace["keys"] and trace["mode"] == "lines"} for part in ("stick", "slip")}
        self.assertGreater(min(widths["slip"]), 1.5 * max(widths["stick"]))
        for colour in self.page.evaluate("[...palette, ink, commonLook.colour]"):
            self.assertGreaterEqual(contrast(colour), 3)

    def test_the_key_takes_curves_out_and_back(self):
        for key in ("branch 1", "stick", "type peak", "common"):
            with self.subTest(key):
                of_key = lambda: [trace["visible"] for trace in self.traces("amplitude") if key in trace["keys"]]
                self.assertTrue(of_key() and all(of_key()))
                self.assertEqual(self.press("amplitude", key), "false")
                self.assertFalse(any(of_key()))
                self.assertTrue(any(trace["visible"] for trace in self.traces("amplitude")))
                self.assertEqual(self.press("amplitude", key), "true")
                self.assertTrue(all(of_key()))

    def test_zoom_by_mouse_and_by_call(self):
        before = self.axis("amplitude")["range"]
        self.drag("amplitude")
        after = self.axis("amplitude")["range"]
        self.assertLess(after[1] - after[0], 0.5 * (before[1] - before[0]))
        self.page.evaluate("Plotly.relayout('plot-amplitude', { 'xaxis.range': [0.5, 0.7] }).then(() => 1)")
        self.assertEqual(self.axis("amplitude")["range"], [0.5, 0.7])
        self.open()
        self.assertEqual(self.axis("amplitude")["range"], before)

    def states(self):
        """Of each contact that is drawn, whether it slips."""
        return self.page.evaluate("[...document.querySelectorAll('#figure-wave path[class]')].map(one => one.getAttribute('class') === 'slip')")

    def test_the_wave_moves_as_the_table_tells(self):
        self.open()
        table = self.table("curves.csv")
        peaks = [float(row["Y"]) for row in table if row["type"] == "peak"]
        point = self.page.evaluate("arcslipReport.wave.point")
        self.assertNear(point["Y"], max(peaks))
        row = table[point["row"]]
        self.assertEqual(row["type"], "peak")
        Y, U, R, S, alpha, beta = (float(row[name]) for name in ("Y", "U", "R", "S", "alpha", "beta"))
        for node, turn in ((0, 0), (7, 0.3), (29, 0.85)):
            moved = self.page.evaluate(f"motionOf(arcslipReport.wave.point, {node}, {turn})")
            angle = 2 * math.pi * (turn - node / 30)
            self.assertAlmostEqual(moved["y"], Y * math.cos(angle - beta), delta=1e-9 * Y)
            self.assertAlmostEqual(moved["u"], U * math.cos(angle - alpha), delta=1e-9 * U)
            self.assertAlmostEqual(moved["r"], moved["u"] - moved["y"], delta=1e-6 * R)
        # A slider that is pulled along by r, S behind it at most, tells which contacts slip.
        slider, slips, steps = 0.0, [], 3000
        for k in range(2 * steps):
            r = R * math.cos(2 * math.pi * k / steps)
            after = min(max(slider, r - S), r + S)
            slips.append(after != slider)
            slider = after
        for k in range(5, steps, 50):
            told = self.page.evaluate(f"stateAt({R!r}, {S!r}, {2 * math.pi * k / steps!r})")
            at_border = len(set(slips[steps + k - 3 : steps + k + 4])) > 1
            self.assertTrue(at_border or (told == "slip") == slips[steps + k], k)
        self.assertGreater(sum(slips[steps:]), 0)

    def test_the_wave_plays_pauses_and_respects_who_wishes_little_motion(self):
        self.open()
        turn = lambda: self.page.evaluate("arcslipReport.wave.turn")
        press = lambda: self.page.evaluate("(button => { button.click(); return button.textContent; })(document.querySelector('#figure-wave .play'))")
        self.assertEqual(turn(), 0)
        self.assertEqual(press(), "Pause")
        self.settle()
        first, before = turn(), self.states()
        self.assertGreater(first, 0)
        self.assertEqual(len(before), 30)
        self.settle()
        self.assertNotEqual(turn(), first)
        self.assertEqual(press(), "Play")
        stopped = turn()
        self.settle()
        self.assertEqual(turn(), stopped)
        # What slips at the highest peak sticks where R = S.
        self.assertTrue(any(self.states()))
        self.page.evaluate("(list => { list.value = [...list.options].find(one => one.text.includes('switch')).value; list.dispatchEvent(new Event('change')); })"
                           "(document.querySelector('#figure-wave select'))")
        self.assertNear(self.page.evaluate("arcslipReport.wave.point.R / arcslipReport.wave.point.S"), 1)
        self.assertFalse(any(self.states()))
        try:
            self.page.send("Emulation.setEmulatedMedia", features=[{"name": "prefers-reduced-motion", "value": "reduce"}])
            self.open()
            press()
            self.page.evaluate("new Promise(done => setTimeout(done, 1400))")
            self.assertIn(turn(), (0.125, 0.25, 0.375))
        finally:
            self.page.send("Emulation.setEmulatedMedia", features=[])
            self.open()

    def test_linear_axes_and_other_quantities(self):
        self.assertEqual(self.axis("amplitude", "yaxis")["type"], "log")
        self.page.evaluate("document.querySelector('#figure-amplitude .controls input').click()")
        self.settle()
        self.assertEqual(self.axis("amplitude", "yaxis")["type"], "linear")
        self.choose("amplitude", "psi")
        self.settle()
        self.assertHolds("amplitude", self.table("curves.csv"), "eta", "psi")
        self.assertIn("[rad]", self.page.evaluate("document.querySelector('#plot-amplitude .ytitle').textContent"))
        self.open()

    def test_values_are_told_under_the_pointer(self):
        place = self.page.evaluate(
            "(plot => { plot.scrollIntoView({ block: 'center' }); const trace = plot.data.find(one => one.mode === 'lines' && one.y.some(y => y > 1));"
            "const i = trace.y.findIndex(y => y > 1); const { xaxis, yaxis } = plot._fullLayout; const box = plot.getBoundingClientRect();"
            "return [box.x + xaxis._offset + xaxis.d2p(trace.x[i]), box.y + yaxis._offset + yaxis.d2p(trace.y[i])]; })(document.getElementById('plot-amplitude'))")
        for shift in (20, 3, 0):
            self.page.send("Input.dispatchMouseEvent", type="mouseMoved", x=place[0] + shift, y=place[1])
            self.settle()
        self.assertIn("P = 0.1", self.page.evaluate("document.querySelector('#plot-amplitude .hoverlayer').textContent"))
        self.assertIn("R/S = ", self.page.evaluate("document.querySelector('#figure-amplitude .readout').textContent"))

    def test_answer_and_certificates_are_in_words(self):
        answer = self.page.evaluate("document.getElementById('answer').textContent")
        self.assertIn("lowest with preload = 1: Y = 0.007189 at η = 3.8411", answer)
        self.assertIn("5 of 5 branches are proven", answer)
        self.assertEqual(len(self.cells("certificates")), 5)

    def test_it_prints(self):
        path = os.path.join(self.kept.name, "report.pdf")
        self.page.print(path)
        with open(path, "rb") as file:
            self.assertEqual(file.read(5), b"%PDF-")


class ManyNodes(Report):
    """A run of more nodes than are drawn."""

    @classmethod
    def setUpClass(cls):
        cls.make(("run", "figure_8", "--set", "system.elements=450", "--set", "branch.from=3", "--set", "branch.to=5"))

    def test_of_many_nodes_every_third_is_drawn(self):
        self.assertEqual(self.page.evaluate("document.querySelectorAll('#figure-wave path[class]').length"), 150)
        self.assertIn("One in 3 of the 450 nodes is drawn.", self.page.evaluate("document.querySelector('#figure-wave').textContent"))


class Neuron(Report):
    """A run of a system that is given by formulas."""

    @classmethod
    def setUpClass(cls):
        cls.make(("run", "morris_lecar"))

    def test_nothing_comes_from_elsewhere(self):
        self.check_nothing_outside()

    def test_curves_of_its_observables_hold_all_points(self):
        table = self.table("curves.csv")
        self.assertEqual(self.assertHolds("branch", table, "I", "I_Ca"), set(range(len(table))))
        self.assertHolds("second", table, "I", "V")


class WholeRing(Report):
    """A split ring whose contacts slip one by one."""

    @classmethod
    def setUpClass(cls):
        cls.make(("run", "split_ring", "--set", "branch.for_each.preload=[0.5]"))

    def points(self):
        """The rows of sectors.csv, for each special point."""
        points = {}
        for row in self.table("sectors.csv"):
            points.setdefault(int(row["point"]), []).append(row)
        return [points[number] for number in sorted(points)]

    def test_what_slips_is_drawn_over_sector_and_frequency(self):
        wanted = {"stick": 0.0, "slip": 0.0}
        points = self.points()
        for here, there in zip(points, points[1:]):
            for contact, after in zip(here, there):
                wanted[contact["state"]] += abs(float(after["eta"]) - float(contact["eta"]))
        self.assertGreater(min(wanted.values()), 1)
        for trace in self.traces("sticks"):
            area = 0.0
            self.assertEqual(len(trace["x"]) % 6, 0)
            for i in range(0, len(trace["x"]), 6):
                (left, right), (low, high) = trace["x"][i:i + 2], trace["y"][i + 1:i + 3]
                self.assertTrue(0.5 <= low < high <= 16.5)
                area += abs(right - left) * (high - low)
            self.assertNear(area, wanted[trace["keys"][0]], 1e-9)
        self.assertEqual(self.press("sticks", "slip"), "false")
        self.assertEqual([trace["visible"] for trace in self.traces("sticks") if "slip" in trace["keys"]], [False])

    def test_every_node_moves_as_its_own_row_tells(self):
        peak = max((rows for rows in self.points() if rows[0]["type"] == "peak"), key=lambda rows: float(rows[0]["Y"]))
        self.assertEqual(self.page.evaluate("arcslipReport.wave.point.sectors.length"), 16)
        for node in (0, 4, 15):
            Y, U, R, alpha, beta, psi, ratio = (float(peak[node][name]) for name in ("Y", "U", "R", "alpha", "beta", "psi", "R_over_S"))
            for turn in (0, 0.37):
                moved = self.page.evaluate(f"motionOf(arcslipReport.wave.point, {node}, {turn})")
                angle = 2 * math.pi * turn
                self.assertAlmostEqual(moved["y"], Y * math.cos(angle - beta), delta=1e-8 * Y)
                self.assertAlmostEqual(moved["u"], U * math.cos(angle - alpha), delta=1e-8 * U)
                self.assertAlmostEqual(moved["r"], moved["u"] - moved["y"], delta=1e-6 * R)
                if ratio <= 1:
                    self.assertEqual(moved["state"], "stick")
        self.assertEqual(self.page.evaluate("document.querySelectorAll('#figure-wave path[class]').length"), 16)
        self.assertIn("The ring at a special point", self.page.evaluate("document.querySelector('#figure-wave').textContent"))


class Verified(Report):
    """A run of several harmonics whose points were solved anew."""

    @classmethod
    def setUpClass(cls):
        cls.make(("run", "harmonics", "--verify", "--set", "branch.from=3.4", "--set", "branch.to=3.43", "--set", "continuation.stop_at=[]",
                  "--set", "system.elements=4", "--set", "branch.for_each={ harmonics = [9] }"))

    def test_nothing_comes_from_elsewhere(self):
        self.check_nothing_outside()

    def test_harmonics_stand_beside_one_another_on_one_scale(self):
        titles = self.page.evaluate("document.getElementById('plot-harmonics').layout.annotations.map(one => one.text)")
        self.assertEqual(titles, [f"<b>harmonic {number}</b>" for number in (1, 3, 5, 7, 9)])
        self.page.evaluate("Plotly.relayout('plot-harmonics', { 'yaxis.range': [-6, -3] }).then(() => 1)")
        for axis in ("yaxis", "yaxis2", "yaxis5"):
            self.assertEqual(self.axis("harmonics", axis)["range"], [-6, -3])
        table = self.table("curves.csv")
        seen = {}
        for trace in self.page.evaluate("document.getElementById('plot-harmonics').data.filter(one => one.mode === 'lines').map(one => [one.yaxis, one.customdata, one.y])"):
            for row, y in zip(trace[1], trace[2]):
                if row is not None:
                    seen[trace[0], row] = y
        for (panel, row), y in seen.items():
            column = {"y": "Y", "y2": "Y_h3", "y3": "Y_h5", "y4": "Y_h7", "y5": "Y_h9"}[panel]
            self.assertNear(y, number(table[row][column]))

    def test_points_solved_anew_are_those_of_the_file(self):
        self.assertTable("verified", self.table("verify.csv"))
        self.assertIn("points were solved anew", self.page.evaluate("document.getElementById('answer').textContent"))

    def test_a_picture_can_be_kept(self):
        image = self.page.evaluate("Plotly.toImage('plot-amplitude', { format: 'png', width: 400, height: 300 })")
        self.assertTrue(image.startswith("data:image/png;base64,"))
        self.assertGreater(len(image), 5000)


def missing():
    """What the test cannot do without, or nothing."""
    if chromium.find() is None:
        return "chromium"
    share = os.path.join(os.path.dirname(os.path.dirname(report_page.program)), "share/arcslip/report/plotly-basic.min.js")
    return "" if os.path.exists(share) else share


if __name__ == "__main__":
    report_page.program, report_page.cases = (os.path.abspath(path) for path in sys.argv[1:3])
    lacking = missing()
    if lacking:
        print(f"{lacking} is missing: nothing is opened")
        sys.exit(1 if os.environ.get("CI") == "true" else SKIPPED)
    unittest.main(argv=sys.argv[:1] + sys.argv[3:], verbosity=2)
