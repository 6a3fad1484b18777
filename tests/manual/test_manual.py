"""Every block of the manual that can be run is run, and prints what stands there; links and anchors hold."""

import contextlib
import io
import os
import pathlib
import re
import subprocess
import sys

import pytest
from manual_blocks import PAGES, SOURCE, blocks, missing, samples

PROGRAM = os.environ.get("ARCSLIP_PROGRAM", str(SOURCE / "build/release/bin/arcslip"))
LINK = re.compile(r"\]\(([^)\s]+)\)")


@pytest.fixture
def checkout(tmp_path, monkeypatch):
    """A folder that has the case files, with the program in PATH."""
    (tmp_path / "problems").symlink_to(SOURCE / "problems")
    programs = tmp_path / "bin"
    programs.mkdir()
    (programs / "arcslip").symlink_to(PROGRAM)
    (programs / "python3").symlink_to(sys.executable)
    monkeypatch.setenv("PATH", f"{programs}:{os.environ['PATH']}")
    monkeypatch.setenv("MPLBACKEND", "Agg")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def run_console(code):
    for command, expected in samples(code):
        done = subprocess.run(["bash", "-c", command], capture_output=True, text=True, check=False, timeout=120)
        assert done.returncode == 0, f"$ {command}\n{done.stdout}{done.stderr}"
        if expected:
            assert missing(expected, done.stdout) is None, f"$ {command}\n{done.stdout}"


def run_python(block, names):
    """Gives what it prints."""
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(block.code, f"line {block.line}", "exec"), names)  # noqa: S102
    return printed.getvalue()


def columns_not_told(folder):
    """Columns of the tables of friction there that the page of results or that of studies does not name."""
    text = "".join(PAGES[page].read_text() for page in ("results", "studies", "keys", "sectors", "commands"))
    told = {re.sub(r"\d+", "k", word) for name in re.findall(r"`([^`\n]+)`", text) for word in re.split(r"[\s,=]+", name)}
    columns = set()
    for table in folder.glob("**/*.csv"):
        header = table.read_text().partition("\n")[0].split(",")
        if "eta" in header or "curve" in header:
            columns.update(re.sub(r"\d+", "k", column) for column in header)
    return columns - told


@pytest.mark.parametrize("page", PAGES)
def test_blocks_do_what_they_show(page, checkout):
    names, printed = {"__name__": "__manual__"}, None
    for block in blocks(PAGES[page].read_text()):
        if block.why:
            continue
        if block.title and block.title.startswith("src/"):
            assert block.code == (SOURCE / block.title).read_text()
        elif block.title:
            pathlib.Path(block.title).write_text(block.code)
        elif block.language == "console":
            run_console(block.code)
        elif block.language == "text" and printed is not None:
            assert missing(block.code.splitlines(), printed) is None, f"line {block.line}: printed\n{printed}"
        printed = run_python(block, names) if block.language == "python" and not block.title else None
    assert not columns_not_told(checkout)


def test_what_is_not_run_is_what_cannot_be():
    found = {}
    for page, path in PAGES.items():
        for block in blocks(path.read_text()):
            if block.why:
                found.setdefault(block.why, set()).add(page)
    allowed = {"builds": {"README", "start", "python", "paper", "oscillator"}, "needs MPI": {"batch"},
               "needs CalculiX": {"matrices"}, "needs plotly.js": {"reports", "rotor"},
               "takes a minute": {"checks"}}
    assert found.keys() <= allowed.keys()
    for why, pages in found.items():
        assert pages <= allowed[why], why


def test_most_commands_stand_in_blocks_that_are_run():
    run = [block for path in PAGES.values() for block in blocks(path.read_text()) if not block.why]
    assert sum(block.language == "console" for block in run) >= 16
    assert sum(block.language == "python" for block in run) >= 6
    for page, path in PAGES.items():  # no command in a block that is only indented, which nothing would run
        prose = re.sub(r"^```.*?^```$", "", path.read_text(), flags=re.DOTALL | re.MULTILINE)
        assert not re.search(r"^    (\$ |\./dev|arcslip |python3 |import )", prose, re.MULTILINE), page


def test_a_sample_that_lacks_a_line_or_has_another_one_is_told():
    printed = "one\ntwo (3 boxes, 0.5 s)\nthree\n"
    assert missing(["one", "two (3 boxes, 0.02 s)", "three"], printed) is None
    assert missing(["...", "three"], printed) is None
    assert missing(["one", "..."], printed) is None
    assert missing(["two (3 boxes, 0.5 s)", "..."], printed) == "two (3 boxes, 0.5 s)"
    assert missing(["one", "two (4 boxes, 0.5 s)", "..."], printed) == "two (4 boxes, 0.5 s)"
    assert missing(["one", "three"], printed) == "three"
    assert missing(["one"], printed) == "(more is printed than shown)"
    assert missing(["...", "three", "four"], printed) == "four"


def anchors(text):
    """The names that mkdocs gives to a page's headings."""
    prose = re.sub(r"^```.*?^```$", "", text, flags=re.DOTALL | re.MULTILINE)
    plain = [re.sub(r"[^\w\s-]", "", heading).strip().lower() for heading in re.findall(r"^#+ (.*)$", prose, re.MULTILINE)]
    return {re.sub(r"[-\s]+", "-", heading) for heading in plain}


@pytest.mark.parametrize("page", PAGES)
def test_links_lead_somewhere(page):
    path = PAGES[page]
    for link in LINK.findall(re.sub(r"^```.*?^```$", "", path.read_text(), flags=re.DOTALL | re.MULTILINE)):
        if link.startswith(("http://", "https://")):
            continue
        target, _, anchor = link.partition("#")
        place = (path.parent / target) if target else path
        assert place.exists(), link
        if anchor:
            assert anchor in anchors(place.read_text()), link


def test_every_page_stands_in_the_navigation():
    navigation = (SOURCE / "src/manual/mkdocs.yml").read_text().split("\nnav:\n")[1]
    assert set(re.findall(r"(\w+)\.md", navigation)) - {"module", "headers"} == set(PAGES) - {"README"}


def test_the_readme_is_short():
    assert len(PAGES["README"].read_text().splitlines()) <= 200
