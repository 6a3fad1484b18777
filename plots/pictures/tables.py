"""Reads what `arcslip run` and `arcslip study` have written: tables in CSV, and summary.json."""

import csv
import json
import os
import re

import numpy as np


class Refused(Exception):
    """What is wrong with the input, in one line."""


# A column that may be asked for in another unit than its own: the unit, what it is made of, and how much of that it is.
PREFIXES = {"mm": ("m", 1e-3), "um": ("m", 1e-6), "nm": ("m", 1e-9), "kHz": ("Hz", 1e3), "mJ": ("J", 1e-3)}
PREFIXES |= {"uJ": ("J", 1e-6), "nJ": ("J", 1e-9)}

# The preload in SI units, of rings per length.
PRELOADS = ["preload_N_per_m", "preload_N"]

CHUNK = 50_000  # rows that are held as text


def in_other_unit(column, columns):
    """The column of which `column` holds the same in another unit, and what to divide its values by; or None."""
    stem, _, unit = column.rpartition("_")
    base, size = PREFIXES.get(unit, ("", 1))
    name = f"{stem}_{base}"
    return (name, size) if base and name in columns else None


class Table:
    """A CSV file that arcslip has written, of which only the first line is read at first, and whether there is a second.

    Parameters
    ----------
    path : str
    columns : sequence of str
        Those that it must have.
    holds : str
        What a table without rows lacks.

    Raises
    ------
    Refused
    """

    def __init__(self, path, columns, holds):
        self.path = path
        with self._open() as file:
            self.columns = next(csv.reader(file), [])
            self.require(columns)
            if not file.readline():
                raise Refused(f"{path}: holds no {holds}")

    def preload(self, otherwise="P"):
        """The column of the preload, in SI units where there are any."""
        return next((name for name in PRELOADS if name in self.columns), otherwise)

    def _open(self):
        try:
            return open(self.path, encoding="utf-8", errors="replace", newline="")
        except OSError:
            raise Refused(f"{self.path}: cannot be read; expected a file that arcslip has written") from None

    def has(self, *names):
        return all(name in self.columns or in_other_unit(name, self.columns) for name in names)

    def require(self, names):
        for name in names:
            if not self.has(name):
                raise Refused(f"{self.path}: has no column {name}; expected a table that arcslip has written")

    def read(self, names):
        """The columns of these names: arrays of numbers, or of texts where not all are numbers."""
        self.require(names)
        places, sizes = [], []
        for name in names:
            name, size = (name, 1.0) if name in self.columns else in_other_unit(name, self.columns)
            places.append(self.columns.index(name))
            sizes.append(size)
        parts = [[] for _ in names]
        for rows in self._chunks():
            for part, place in zip(parts, places):
                part.append(_numbers([row[place] for row in rows]))
        return [_joined(part, size) for part, size in zip(parts, sizes)]

    def _chunks(self):
        width = len(self.columns)
        with self._open() as file:
            rows = csv.reader(file)
            next(rows, None)
            chunk = []
            for number, row in enumerate(rows, 2):
                if len(row) != width:
                    raise Refused(f"{self.path}: line {number} has {len(row)} fields; expected {width}")
                chunk.append(row)
                if len(chunk) == CHUNK:
                    yield chunk
                    chunk = []
            yield chunk


def _numbers(texts):
    try:
        return np.array(texts, dtype=float)
    except ValueError:
        return np.array(texts, dtype=object)


def _joined(parts, size):
    if all(part.dtype == float for part in parts):
        values = np.concatenate(parts)
        return values if size == 1 else values / size
    return np.concatenate([part.astype(str).astype(object) for part in parts])


def summary_of(folder):
    """The folder's summary.json."""
    if not os.path.isdir(folder):
        raise Refused(f"{folder}: is not a folder; expected one that arcslip run or study has written")
    return json_of(os.path.join(folder, "summary.json"))


def json_of(path):
    """What a file of JSON holds."""
    try:
        with open(path, "rb") as file:
            return json.loads(file.read().decode("utf-8", "replace"))
    except OSError:
        raise Refused(f"{path}: cannot be read; expected a file that arcslip has written") from None
    except json.JSONDecodeError as error:
        raise Refused(f"{path}: is not JSON (byte {error.pos})") from None


def drawn_table(folder):
    """The table that pictures of a run are drawn from: that of its curves, unless the branches were changed since."""
    branches, curves = (os.path.join(folder, name) for name in ("branches.csv", "curves.csv"))

    def header(path):
        try:
            with open(path, encoding="utf-8", errors="replace") as file:
                return file.readline()
        except OSError:
            return None

    def changed(path):
        return os.stat(path).st_mtime_ns

    same = header(curves) is not None and header(curves) == header(branches)
    return curves if same and changed(branches) <= changed(curves) else branches


def split_number(name):
    """A name and the number or word behind it: "u1", "R_contact_2"; the second is empty where there is none."""
    match = re.fullmatch(r"([A-Za-z]+?)(?:_(\w+)|(\d+))?", name)
    return (match[1], match[2] or match[3] or "") if match else (name, "")


def columns_of(table):
    """What can be drawn of a table."""
    others = ("branch", "point", "type", "regime", "kind", "site")
    return ", ".join(name for name in table.columns if name not in others)


def unknown_column(name, table, problem="has no column of this name"):
    """What is said of a column that cannot be drawn."""
    return Refused(f"{name}: {table.path} {problem}; there are {columns_of(table)}")


def unknown_columns(names, tables):
    """The same of columns that no table has, or not all of."""
    nowhere = [name for name in names if not any(table.has(name) for table in tables)]
    if len(tables) == 1:
        return unknown_column(nowhere[0], tables[0])
    problem = "no table has a column of this name" if nowhere else "no table has all of these columns"
    have = "; ".join(f"{table.path} has {columns_of(table)}" for table in tables)
    return Refused(f"{nowhere[0] if nowhere else ', '.join(names)}: {problem}; {have}")
