"""What reports of studies show; report_browser.py runs it."""

from report_page import Report

CHART = "study.for_each={ mass_ratio = { from = 1.0, to = 100.0, count = 6, scale = \"log\" }, " \
        "frequency_ratio = { from = 1.0, to = 5.0, count = 5 } }"


class Chart(Report):
    """A study of two keys."""

    @classmethod
    def setUpClass(cls):
        cls.make(("study", "chart", "--set", CHART))

    def test_nothing_comes_from_elsewhere(self):
        self.check_nothing_outside()

    def test_it_fits_a_phone(self):
        self.check_phone()

    def test_the_map_shows_each_design_by_its_value(self):
        table = self.table("optimum.csv")
        self.assertEqual(len(table), 30)
        for name in ("ratio_opt", "P_opt"):
            with self.subTest(name):
                self.choose("map", name)
                self.settle()
                traces = self.traces("map")
                areas = [trace for trace in traces if trace["fill"] == "toself"]
                order = self.page.evaluate("Array.from({ length: steps }, (_, i) => shade(i))")
                level = []
                for row in table:
                    x, y = float(row["mass_ratio"]), float(row["frequency_ratio"])
                    found = [order.index(area["colour"]) for area in areas for i in range(0, len(area["x"]), 6)
                             if min(area["x"][i:i + 4]) < x < max(area["x"][i:i + 4]) and min(area["y"][i:i + 4]) < y < max(area["y"][i:i + 4])]
                    self.assertEqual(len(found), 1)
                    level.append((float(row[name]), found[0]))
                level.sort()
                self.assertEqual([one[1] for one in level], sorted(one[1] for one in level))
                self.assertEqual((level[0][1], level[-1][1]), (0, len(order) - 1))
        star = next(trace for trace in self.traces("map") if trace["keys"] == ["type optimum"])
        best = min(table, key=lambda row: float(row["ratio_opt"]))
        self.assertEqual((star["x"][0], star["y"][0]), (float(best["mass_ratio"]), float(best["frequency_ratio"])))

    def test_tables_are_those_of_the_files(self):
        table = self.table("optimum.csv")
        self.assertTable("optimum", table)
        self.assertTable("optimum-all", table)

    def test_it_can_be_enlarged(self):
        before = self.axis("map", "yaxis")["range"]
        self.drag("map")
        after = self.axis("map", "yaxis")["range"]
        self.assertLess(after[1] - after[0], 0.5 * (before[1] - before[0]))
        self.open()


class Scatter(Report):
    """A study in SI units with scatter, beside its run."""

    @classmethod
    def setUpClass(cls):
        cls.make(("study", "rotor_ring"), ("run", "rotor_ring"))

    def test_nothing_comes_from_elsewhere(self):
        self.check_nothing_outside()

    def test_it_fits_a_phone(self):
        self.check_phone()

    def test_quantiles_are_those_of_the_file_in_micrometres(self):
        table = self.table("quantiles.csv")
        size = {row["curve"]: float(row["Y_m"]) / float(row["Y_opt"]) for row in self.table("optimum.csv")}
        lines = [trace for trace in self.traces("quantiles") if trace["mode"] == "lines" and not trace["fill"]]
        self.assertEqual(len(lines), 6)
        for trace in lines:
            name = trace["keys"][1].replace("q ", "Y_q")
            self.assertEqual(len(trace["rows"]), sum(row["curve"] == table[trace["rows"][0]]["curve"] for row in table))
            for row, x, y in zip(trace["rows"], trace["x"], trace["y"]):
                self.assertNear(x, float(table[row]["preload_N_per_m"]))
                self.assertNear(y, 1e6 * float(table[row][name]) * size[table[row]["curve"]])
        robust = [trace for trace in self.traces("quantiles") if "type robust" in trace["keys"]]
        for trace, row in zip(robust, self.table("robust.csv")):
            self.assertNear(trace["x"][0], float(row["preload_N_per_m"]))
            self.assertNear(trace["y"][0], 1e6 * float(row["Y_q95_m"]))
        bands = [trace for trace in self.traces("quantiles") if trace["fill"]]
        self.assertEqual(len(bands), 2)
        self.choose("quantiles", "ratio")
        self.settle()
        trace = next(trace for trace in self.traces("quantiles") if trace["keys"][-1] == "q 95" and trace["mode"] == "lines")
        for row, y in zip(trace["rows"], trace["y"]):
            self.assertNear(y, float(table[row]["ratio_q95"]))
        self.open()

    def test_peaks_and_branches_are_in_units(self):
        rows = self.assertHolds("peaks", self.table("sweep.csv"), "preload_N_per_m", "Y_m", 1e-6)
        self.assertEqual(len(rows), len(self.table("sweep.csv")))
        self.assertHolds("amplitude", self.table("curves.csv"), "frequency_Hz", "Y_m", 1e-6)
        titles = self.page.evaluate("['.xtitle', '.ytitle'].map(one => document.querySelector('#plot-amplitude ' + one).textContent)")
        self.assertEqual(titles, ["frequency f [Hz]", "amplitude of the base Y [µm]"])

    def test_the_answer_is_in_units(self):
        answer = self.page.evaluate("document.getElementById('answer').textContent")
        for text in ("Of 2 designs the damper does most with damper.width = 0.012 m. ",
                     "Best preload 335.1 N/m: highest peak 2.491 µm at 2269 Hz, 92 % below the free base",
                     "With scatter the best preload is 390.7 N/m: 95 % of all stay below 3.541 µm"):
            self.assertIn(text, answer)

    def test_tables_are_those_of_the_files(self):
        self.assertTable("optimum", self.table("optimum.csv"))
        self.assertTable("robust", self.table("robust.csv"))

    def test_designs_can_be_taken_out(self):
        self.assertEqual(self.press("quantiles", "design 0"), "false")
        shown = [trace["keys"][0] for trace in self.traces("quantiles") if trace["visible"]]
        self.assertEqual(set(shown), {"design 1"})
        self.press("quantiles", "design 0")


class MassesInUnits(Report):
    """Masses on springs in SI units, of which preloads are forces: a study with scatter over a key, and its run."""

    @classmethod
    def setUpClass(cls):
        units = ("--set", 'system.units="SI"', "--set", "system.force=10")
        cls.make(("study", "spring_mass", *units, "--set", "study.from=1", "--set", "study.to=100", "--set", "study.for_each={ contact_stiffness = [0.4, 0.5, 0.6] }",
                  "--set", "study.uncertain={ mu = { lognormal = 0.2 }, samples = 100 }"),
                 ("run", "spring_mass", *units, "--set", "branch.for_each={ force = [10.0, 20.0] }", "--set", "branch.parameter=\"P\"", "--set", "branch.eta=1",
                  "--set", "branch.from=1", "--set", "branch.to=30"))

    def test_pictures_are_over_preloads_in_newtons(self):
        self.assertHolds("peaks", self.table("sweep.csv"), "preload_N", "Y_m")
        self.assertHolds("amplitude", self.table("curves.csv"), "preload_N", "Y_m")
        for picture, name, axis in (("quantiles", "quantiles.csv", "x"), ("optimum", "optimum.csv", "y")):
            table = self.table(name)
            traces = [trace for trace in self.traces(picture) if trace["mode"].startswith("lines") and not trace["fill"]]
            self.assertGreater(len(traces), 0)
            for trace in traces:
                self.assertEqual([float(table[row]["preload_N"]) for row in trace["rows"]], trace[axis])
        for picture, axis in (("quantiles", "x"), ("peaks", "x"), ("optimum", "y"), ("amplitude", "x")):
            title = self.page.evaluate(f"document.querySelector('#plot-{picture} .{axis}title').textContent")
            self.assertEqual(title, "preload P [N]")
        self.assertEqual(sum(bool(trace["fill"]) for trace in self.traces("optimum")), 1)

    def test_tables_and_the_row_under_the_pointer_have_them(self):
        self.assertTable("optimum", self.table("optimum.csv"))
        self.assertEqual(self.columns("optimum")[1:4], ["preload_N", "preload_low_N", "preload_high_N"])
        self.assertRegex(self.page.evaluate("document.getElementById('answer').textContent"), r"Best preload [0-9.]+ N: ")
        for picture in ("peaks", "amplitude"):
            self.page.evaluate(f"void document.getElementById('plot-{picture}').emit('plotly_hover', {{ points: [{{ customdata: 2 }}] }})")
            told = self.page.evaluate(f"document.querySelector('#figure-{picture} .readout').textContent")
            self.assertRegex(told, r"P (= )?[0-9.]+ N\b")
