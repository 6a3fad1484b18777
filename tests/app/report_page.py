"""A report in Chromium, and what every one is asked."""

import csv
import math
import os
import subprocess
import tempfile
import unittest

import chromium

program = None  # the arcslip that makes the reports
cases = None    # the folder of case files


def read(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def number(text):
    value = float(text)
    return value if math.isfinite(value) else None


def contrast(colour):
    """Of a colour to white, as WCAG has it."""
    parts = [int(colour[i:i + 2], 16) / 255 for i in (1, 3, 5)]
    linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts]
    return 1.05 / (0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2] + 0.05)


class Report(unittest.TestCase):
    """What all reports are asked; a report's own class says how it is made."""

    folder = None

    @classmethod
    def make(cls, *commands):
        cls.kept = tempfile.TemporaryDirectory(prefix="arcslip-report-")
        cls.folder = os.path.join(cls.kept.name, "r")
        for command, case, *options in commands:
            subprocess.run([program, command, os.path.join(cases, case + ".toml"), "-o", cls.folder, "--quiet", *options],
                           check=True, stderr=subprocess.DEVNULL)
        subprocess.run([program, "report", cls.folder], check=True, stdout=subprocess.DEVNULL)
        cls.page = chromium.Chromium()
        cls.open()

    @classmethod
    def open(cls):
        cls.page.open(os.path.join(cls.folder, "report.html"))
        cls.page.evaluate("arcslipReport.ready.then(() => 1)")

    @classmethod
    def tearDownClass(cls):
        if cls.folder:
            cls.page.__exit__()
            cls.kept.cleanup()

    def tearDown(self):
        self.assertEqual(self.page.messages, [])
        self.assertEqual(self.page.evaluate("arcslipReport.errors"), [])

    def table(self, name):
        return read(os.path.join(self.folder, name))

    def traces(self, picture):
        return self.page.evaluate(
            f"document.getElementById('plot-{picture}').data.map((trace, i) => ({{ mode: trace.mode, x: trace.x, y: trace.y, fill: trace.fill ?? '', "
            "rows: trace.customdata ?? null, line: trace.line, marker: trace.marker, colour: trace.fillcolor, visible: trace.visible, "
            f"keys: arcslipReport.pictures['{picture}'].traces[i].keys }}))")

    def axis(self, picture, name="xaxis"):
        return self.page.evaluate(f"(({{ type, range }}) => ({{ type, range }}))(document.getElementById('plot-{picture}')._fullLayout.{name})")

    def press(self, picture, key):
        self.page.evaluate(f"document.querySelector('#figure-{picture} .key [data-key=\"{key}\"]').click()")
        return self.page.evaluate(f"document.querySelector('#figure-{picture} .key [data-key=\"{key}\"]').getAttribute('aria-pressed')")

    def choose(self, picture, value):
        self.page.evaluate(f"(list => {{ list.value = '{value}'; list.dispatchEvent(new Event('change')); }})"
                           f"(document.querySelector('#figure-{picture} select'))")

    def cells(self, table):
        """The rows of a table on the page, in full digits."""
        return self.page.evaluate(f"[...document.querySelectorAll('#table-{table} tbody tr')].map(row => [...row.cells].map(cell => cell.title))")

    def columns(self, table):
        return self.page.evaluate(f"[...document.querySelectorAll('#table-{table} th button')].map(button => button.title)")

    def assertNear(self, a, b, tolerance=1e-9):
        if a is None or b is None:
            self.assertEqual(a, b)
        elif abs(a - b) > tolerance * max(abs(a), abs(b)):
            self.fail(f"{a} is not {b}")

    def assertHolds(self, picture, table, x, y, unit=1):
        """The lines of a picture go through the points of these rows, and no others."""
        seen = {}
        for trace in self.traces(picture):
            if trace["mode"] != "lines" or trace["rows"] is None or trace["fill"]:
                continue
            for row, at, height in zip(trace["rows"], trace["x"], trace["y"]):
                if row is not None:
                    seen[row] = (at, height)
        self.assertGreater(len(seen), 0)
        for row, (at, height) in seen.items():
            self.assertNear(at, number(table[row][x]))
            self.assertNear(height, None if number(table[row][y]) is None else number(table[row][y]) / unit)
        return set(seen)

    def assertTable(self, name, rows):
        columns = self.columns(name)
        cells = self.cells(name)
        self.assertEqual(len(cells), len(rows))
        for shown, row in zip(cells, rows):
            for column, text in zip(columns, shown):
                try:
                    self.assertNear(number(text) if text else None, number(row[column]), 0)
                except ValueError:
                    self.assertEqual(text, row[column])

    def drag(self, picture):
        """Draws a rectangle over the middle of a picture with the mouse."""
        self.page.evaluate(f"document.getElementById('plot-{picture}').scrollIntoView({{ block: 'center' }})")
        box = self.page.evaluate(f"(({{ x, y, width, height }}) => [x, y, width, height])(document.querySelector('#plot-{picture} .nsewdrag').getBoundingClientRect())")
        places = [(box[0] + box[2] * part, box[1] + box[3] * part) for part in (0.3, 0.45, 0.6)]
        mouse = lambda kind, place, **more: self.page.send("Input.dispatchMouseEvent", type=kind, x=place[0], y=place[1], **more)
        mouse("mouseMoved", places[0])
        mouse("mousePressed", places[0], button="left", clickCount=1)
        mouse("mouseMoved", places[1], button="left", buttons=1)
        mouse("mouseMoved", places[2], button="left", buttons=1)
        mouse("mouseReleased", places[2], button="left", clickCount=1)
        self.settle()

    def settle(self):
        self.page.evaluate("new Promise(done => setTimeout(done, 300))")

    def check_nothing_outside(self):
        self.open()
        self.assertEqual(self.page.requests, ["file://" + os.path.join(self.folder, "report.html")])
        links = self.page.evaluate("[...document.querySelectorAll('[src],[href]')].map(one => one.getAttribute('src') || one.getAttribute('href'))")
        self.assertEqual([link for link in links if not link.startswith("#")], [])

    def check_phone(self):
        try:
            self.page.resize(390, 844, phone=True)
            self.open()
            self.assertLessEqual(self.page.evaluate("document.documentElement.scrollWidth"), 390)
            widths = self.page.evaluate("[...document.querySelectorAll('.plot .main-svg')].map(svg => svg.getBoundingClientRect().width)")
            self.assertGreater(min(widths), 330)
        finally:
            self.page.resize(1280, 900)
            self.open()
