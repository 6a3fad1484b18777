"""Tables that were written, and the branches in them."""

import csv
import json
import os

import numpy as np

from . import _core
from ._branch import Branch


def table_of(text):
    """The columns of a table, a dict of arrays."""
    header, *rows = csv.reader(text.splitlines())
    return {column: _column([row[i] for row in rows]) for i, column in enumerate(header)}


def _column(texts):
    for kind in (int, float):
        try:
            return np.array([kind(text) for text in texts])
        except ValueError:
            continue
    return np.array(texts)


class _Stored:
    """What a `Branch` shows of one of which only the table is there."""

    checkpoint = None

    def __init__(self, table, said, parameter):
        self._table = table
        self._said = said
        self.parameter = parameter
        self.values = json.dumps(said["values"])
        self.stop = said["stop"]
        self.explanation = said["explanation"]
        self.warning = said.get("warning", "")
        ends = [said["stop"], said.get("first_stop", said["stop"])]
        self.why_not_whole = ", ".join(stop for stop in ends if not _core.is_end(stop))
        self.seconds = said.get("seconds", 0.0)

    def __len__(self):
        return len(self._table["type"])

    def names(self):
        return [name for name in self._table if name not in ("type", "regime")]

    def column(self, which):
        return self._table[self.names()[which]].astype(float)

    def types(self):
        return list(self._table["type"])

    def regimes(self):
        return list(self._table["regime"])

    def labels(self):
        return [""] * len(self)

    def summary(self, _):
        return json.dumps(self._said)

    def __getattr__(self, name):
        raise ValueError(f"{name}: of a branch that was traced before the run was resumed the table alone is known")


def stored_branches(folder, count):
    """The first branches of the run in a folder, as far as its tables tell them."""
    if count == 0:
        return []
    with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
        summary = json.load(file)
    with open(os.path.join(folder, "branches.csv"), encoding="utf-8", newline="") as file:
        header, *rows = csv.reader(file)
    verified = {}
    if os.path.exists(os.path.join(folder, "verify.csv")):
        with open(os.path.join(folder, "verify.csv"), encoding="utf-8", newline="") as file:
            verified = table_of(file.read())
    parameter = summary["case"]["branch"]["parameter"] if "parameter" in summary["case"]["branch"] else header[4]
    branches = []
    for i, said in enumerate(summary["branches"][:count]):
        if said["points"] == 0:
            continue
        mine = [row for row in rows if row[0] == str(i)]
        table = {}
        for k, name in enumerate(header[2:], 2):
            if name == "arclength" and "unstable" not in table:
                table["unstable"] = np.full(len(mine), -1)
            table[name] = _column([row[k] for row in mine])
        of_branch = verified["branch"] == i if verified else np.array([False])
        verification = {name: column[of_branch] for name, column in verified.items()} if of_branch.any() else None
        branches.append(Branch(_Stored(table, said, parameter), number=i, verification=verification))
    return branches
