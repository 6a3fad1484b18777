"""The pages of the manual as what can be run: their code blocks, in order."""

import dataclasses
import pathlib
import re

SOURCE = pathlib.Path(__file__).parents[2]
PAGES = {"README": SOURCE / "README.md"} | {
    path.stem: path for path in sorted((SOURCE / "src/manual/pages").glob("*.md"))
}
FENCE = re.compile(
    r"^(?:<!-- not run: (?P<why>[^>]+) -->\n)?```(?P<language>\w*)(?: title=\"(?P<title>[^\"]+)\")?\n(?P<code>.*?)^```$",
    re.DOTALL | re.MULTILINE,
)
SECONDS = re.compile(r"[0-9.e+-]+ s\b")


@dataclasses.dataclass
class Block:
    """A fenced block: language, the file it is written to or None, text, why it is not run or None, its line."""

    language: str
    title: str | None
    code: str
    why: str | None
    line: int


def blocks(text):
    """All fenced blocks of a page."""
    return [
        Block(match["language"], match["title"], match["code"], match["why"], text.count("\n", 0, match.start()) + 1)
        for match in FENCE.finditer(text)
    ]


def samples(code):
    """The commands of a console block, each with the lines that it is to print."""
    found = []
    for line in code.splitlines():
        if line.startswith("$ "):
            found.append((line[2:], []))
        else:
            found[-1][1].append(line)
    return found


def missing(expected, printed):
    """The first expected line that is not at its place, where "..." stands for any lines, and times for any time."""
    lines = [SECONDS.sub("T s", line.rstrip()) for line in printed.splitlines()]
    at, anywhere = 0, False
    for line in expected:
        if line == "...":
            anywhere = True
            continue
        wanted = SECONDS.sub("T s", line.rstrip())
        places = range(at, len(lines)) if anywhere else range(at, min(at + 1, len(lines)))
        found = next((i for i in places if lines[i] == wanted), None)
        if found is None:
            return line
        at, anywhere = found + 1, False
    return None if anywhere or at == len(lines) else "(more is printed than shown)"
