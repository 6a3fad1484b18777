"""Matrices as a finite-element program stored them, node by node: the part of sector_matrices.py that reads.

A matrix goes by as pairs of a node k, from 0, and {i: its block with node i <= k}, nine values row by row.
"""

import math
from itertools import zip_longest

FREE_IT = ("in the step that stores the matrices free all supports (*BOUNDARY, OP=NEW) and the cyclic symmetry "
           "(CYCMPC=INACTIVE), and hold nodes here")


class Wrong(Exception):
    """Input that is not as it must be."""


def read_dofs(path):
    """The nodes of a finite-element program in its order; each has three rows, for x, y and z."""
    rows = []
    with open(path, encoding="utf-8", errors="replace") as text:
        for number, line in enumerate(text, 1):
            node, dot, direction = line.strip().partition(".")
            if not (node.isdigit() and dot and direction in ("1", "2", "3")):
                raise Wrong(f"{path}:{number}: expected node.direction with a direction 1, 2 or 3, got "
                            f"'{line.strip()}'")
            rows.append((int(node), int(direction)))
    order = [node for node, _ in rows[::3]]
    expected = ((node, direction) for node in order for direction in (1, 2, 3))
    for row, wanted in zip(rows + [(0, 0)] * (-len(rows) % 3), expected):
        if row != wanted:
            raise Wrong(f"{path}: node {wanted[0]} has not all three directions one after another: {FREE_IT}")
    return order


def node_columns(path, count):
    """For each node k, from 0: k and {i: its block with node i <= k}, nine values row by row, in one reading."""
    last, blocks = 0, {}
    with open(path, encoding="utf-8", errors="replace") as text:
        for number, line in enumerate(text, 1):
            try:
                row, column, value = line.split()
                row, column, value = int(row) - 1, int(column) - 1, float(value.replace("D", "e"))
            except ValueError:
                raise Wrong(f"{path}:{number}: expected a row, a column and a value") from None
            if row > column:
                row, column = column, row
            if not (0 <= row and column < 3 * count and math.isfinite(value)):
                raise Wrong(f"{path}:{number}: expected rows and columns from 1 to {3 * count} and a finite value")
            k = column // 3
            if k != last:
                if k < last:
                    raise Wrong(f"{path}:{number}: expected the larger of row and column in ascending order, got "
                                f"{column + 1} after node {last + 1} of the rows")
                yield last, blocks
                last, blocks = k, {}
            i = row // 3
            block = blocks.get(i)
            if block is None:
                block = blocks[i] = [0.0] * 9
            p, q = row - 3 * i, column - 3 * k
            if block[3 * p + q] not in (0.0, value):
                raise Wrong(f"{path}:{number}: row {row + 1}, column {column + 1} is given twice")
            block[3 * p + q] = value
            if i == k:
                block[3 * q + p] = value
    yield last, blocks


def per_speed_squared(turning, rest, square):
    """What each radian squared of a speed adds to a stiffness: that at `square` of it less that at rest, over it."""
    for (k, blocks), (other, still) in zip_longest(turning, rest, fillvalue=(-1, {})):
        if k != other or blocks.keys() - still.keys() or still.keys() - blocks.keys():
            raise Wrong("the stiffness at rest is that of another mesh than the turning one")
        yield k, {i: [(a - b) / square for a, b in zip(block, still[i])] for i, block in blocks.items()}


def gyroscopic(mass, axes):
    """Of Coriolis' forces 2 m e x v at one radian, e being the last of `axes` and m the mass of a pair of nodes."""
    a, b, _ = axes
    for k, blocks in mass:
        turned = {}
        for i, block in blocks.items():
            m = block[0]
            same = (m, 0.0, 0.0, 0.0, m, 0.0, 0.0, 0.0, m)
            if any(abs(value - wanted) > 1e-9 * abs(m) for value, wanted in zip(block, same)):
                raise Wrong(f"the mass of rows {3 * i + 1} and {3 * k + 1} is not the same in x, y and z: Coriolis' "
                            "forces do not follow from it")
            turned[i] = [0.0] * 9
            turned[i][3 * a + b], turned[i][3 * b + a] = -2 * m, 2 * m
        yield k, turned
