#!/usr/bin/env python3
"""Matrices of one sector as arcslip reads them, from those that a finite-element program wrote.

Reads JOB.sti, JOB.mas and JOB.dof, as CalculiX stores them, and nodes and sets of nodes from a deck:

  JOB.sti, JOB.mas   row column value, one triangle of a symmetric matrix, from 1
  JOB.dof            node.direction of each row, directions 1, 2, 3 being x, y, z
  deck               *NODE and *NSET (also GENERATE), in files that it includes too

Every displacement is turned into the cylindrical directions r, t, z of the axis, so that neighbouring sectors
move alike but for the phase; held dofs are left out; the nodes of both boundaries are paired by r and z.

Writes NAME_mass.mtx, NAME_stiffness.mtx, NAME_left.txt, NAME_right.txt, NAME_contact.txt, NAME_load.txt and
NAME_dofs.txt, which says what each dof is.

  sector_matrices.py rotor --deck rotor.inp --sectors 24 --left LEFT --right RIGHT --hold HUB \\
      --contact GROOVE:z --load RIM:z:1.0 --wave-number 3 --name base -o study
"""

import argparse
import cmath
import math
import os
import sys

DIRECTIONS = "rtz"


class Wrong(Exception):
    """Input that is not as it must be."""


def words(path):
    """Number and comma- or blank-separated words of each line with any."""
    with open(path, encoding="utf-8", errors="replace") as text:
        for number, line in enumerate(text, 1):
            found = line.replace(",", " ").split()
            if found:
                yield number, found


def read_triplets(path, size):
    """{(row, column): value} of both triangles, from 0."""
    entries = {}
    for number, line in words(path):
        try:
            row, column, value = int(line[0]) - 1, int(line[1]) - 1, float(line[2].replace("D", "e"))
        except (ValueError, IndexError):
            raise Wrong(f"{path}:{number}: expected a row, a column and a value") from None
        if not (0 <= row < size and 0 <= column < size and math.isfinite(value)):
            raise Wrong(f"{path}:{number}: expected rows and columns from 1 to {size} and a finite value")
        if entries.get((row, column), value) != value:
            raise Wrong(f"{path}:{number}: row {row + 1}, column {column + 1} is given twice")
        entries[row, column] = entries[column, row] = value
    return entries


def read_dofs(path):
    """(node, direction from 0) of each row."""
    dofs = []
    for number, line in words(path):
        node, dot, direction = line[0].partition(".")
        if not (node.isdigit() and dot and direction in ("1", "2", "3")):
            raise Wrong(f"{path}:{number}: expected node.direction with a direction 1, 2 or 3, got '{line[0]}'")
        dofs.append((int(node), int(direction) - 1))
    return dofs


def keyword(line):
    """Name and parameters of a line that begins with one star, in capitals."""
    name, *parameters = (part.strip() for part in line.split(","))
    values = dict((part.strip() for part in (p + "=").split("=")[:2]) for p in parameters if p)
    return name.upper(), {key.upper(): value for key, value in values.items()}


def read_deck(path, nodes, sets):
    """Adds {node: (x, y, z)} and {set: [node]}."""
    name, parameters = "", {}
    try:
        text = open(path, encoding="utf-8", errors="replace")
    except OSError as error:
        raise Wrong(f"{path}: {error.strerror}") from None
    with text:
        for number, line in enumerate(text, 1):
            if line.startswith("**") or not line.strip():
                continue
            if line.startswith("*"):
                name, parameters = keyword(line)
                if name == "*INCLUDE":
                    included = parameters["INPUT"].strip("\"'")
                    read_deck(os.path.join(os.path.dirname(path), included), nodes, sets)
                continue
            parts = [part.strip() for part in line.split(",") if part.strip()]
            members = sets.setdefault(parameters.get("NSET", "").upper(), [])
            try:
                if name == "*NODE":
                    nodes[int(parts[0])] = tuple(map(float, (parts[1:] + ["0", "0"])[:3]))
                    members.append(int(parts[0]))
                elif name == "*NSET" and "GENERATE" in parameters:
                    first, last, step = (list(map(int, parts)) + [1])[:3]
                    members.extend(range(first, last + 1, step))
                elif name == "*NSET":
                    for part in parts:
                        members.extend([int(part)] if part.isdigit() else sets[part.upper()])
            except (ValueError, IndexError, KeyError):
                raise Wrong(f"{path}:{number}: expected what {name} takes, got '{line.strip()}'") from None


class Sector:
    """The rows of a finite-element program in cylindrical directions."""

    def __init__(self, nodes, dofs, axis):
        self.dofs = dofs
        self.row = {dof: i for i, dof in enumerate(dofs)}
        third = "xyz".index(axis)
        first, second = (third + 1) % 3, (third + 2) % 3
        self.place, self.turn = {}, {}
        for node in {node for node, _ in dofs}:
            if node not in nodes:
                raise Wrong(f"node {node} has dofs but no coordinates in the deck")
            x, y = nodes[node][first], nodes[node][second]
            r = math.hypot(x, y)
            if r == 0:
                raise Wrong(f"node {node} is on the axis, where directions r and t are not defined")
            if any((node, d) not in self.row for d in range(3)):
                raise Wrong(f"node {node} has not all three directions: take its support out of the deck and "
                            "hold it here")
            self.place[node] = (r, math.atan2(y, x), nodes[node][third])
            rows = [[0.0] * 3 for _ in range(3)]
            rows[0][first], rows[0][second] = x / r, y / r
            rows[1][first], rows[1][second] = -y / r, x / r
            rows[2][third] = 1.0
            self.turn[node] = rows

    def turned(self, entries):
        """The matrix in cylindrical directions, its lower triangle."""
        blocks = {}
        for (row, column), value in entries.items():
            (i, p), (k, q) = self.dofs[row], self.dofs[column]
            if i >= k:
                blocks.setdefault((i, k), [[0.0] * 3 for _ in range(3)])[p][q] = value
        result = {}
        for (i, k), block in blocks.items():
            left, right = self.turn[i], self.turn[k]
            half = [[sum(left[a][p] * block[p][q] for p in range(3)) for q in range(3)] for a in range(3)]
            for a in range(3):
                for b in range(3):
                    value = sum(half[a][q] * right[b][q] for q in range(3))
                    row, column = self.row[i, a], self.row[k, b]
                    if row >= column or i != k:
                        result[max(row, column), min(row, column)] = value
        return result


def members(sets, name):
    found = sets.get(name.upper())
    if not found:
        raise Wrong(f"the deck has no set of nodes {name}; it has {', '.join(filter(None, sorted(sets)))}")
    return list(dict.fromkeys(found))


def paired(sector, left, right, sectors):
    """Nodes of the right boundary in the order of those of the left one."""
    if len(left) != len(right):
        raise Wrong(f"the left boundary has {len(left)} nodes and the right one {len(right)}")
    size = max(max(place[0], abs(place[2])) for place in sector.place.values())
    tolerance, angle = 1e-5 * size, 2 * math.pi / sectors
    cells = {}
    for node in right:
        r, _, z = sector.place[node]
        cells.setdefault((round(r / tolerance), round(z / tolerance)), []).append(node)
    pairs = []
    for node in left:
        r, theta, z = sector.place[node]
        at = (round(r / tolerance), round(z / tolerance))
        near = [n for a in (-1, 0, 1) for b in (-1, 0, 1) for n in cells.get((at[0] + a, at[1] + b), [])]
        if len(near) != 1:
            raise Wrong(f"node {node} of the left boundary has {len(near)} partners of the same r and z")
        ahead = (sector.place[near[0]][1] - theta) % (2 * math.pi)
        if abs(ahead - angle) * r > tolerance:
            raise Wrong(f"nodes {node} and {near[0]} are {math.degrees(ahead):.6g} degrees apart, expected "
                        f"{math.degrees(angle):.6g}: are left and right exchanged?")
        pairs.append(near[0])
    if len(set(pairs)) != len(pairs):
        raise Wrong("a node of the right boundary is the partner of several")
    return pairs


def split(text, count):
    """SET:directions or SET:directions:value; all directions where none is given."""
    parts = text.split(":")
    directions = parts[1] if len(parts) > 1 else DIRECTIONS
    if len(parts) > count or not directions or set(directions) - set(DIRECTIONS):
        raise Wrong(f"expected SET:directions of r, t, z{':value' if count == 3 else ''}, got '{text}'")
    try:
        value = float(parts[2]) if len(parts) > 2 else 1.0
    except ValueError:
        raise Wrong(f"expected a number, got '{parts[2]}'") from None
    return parts[0], [DIRECTIONS.index(d) for d in directions], value


def matrix_text(entries, number):
    kept = sorted((number[column], number[row], value) for (row, column), value in entries.items()
                  if row in number and column in number and (value != 0 or row == column))
    lines = [f"{max(i, k)} {min(i, k)} {value!r}\n" for i, k, value in kept]
    size = len(number)
    return f"%%MatrixMarket matrix coordinate real symmetric\n{size} {size} {len(kept)}\n" + "".join(lines)


def convert(arguments):
    dofs = read_dofs(arguments.job + ".dof")
    nodes, sets = {}, {}
    for deck in arguments.deck:
        read_deck(deck, nodes, sets)
    sector = Sector(nodes, dofs, arguments.axis)
    inside = lambda name: [node for node in members(sets, name) if node in sector.place]
    left = inside(arguments.left)
    right = paired(sector, left, inside(arguments.right), arguments.sectors)
    held = set()
    for text in arguments.hold:
        name, directions, _ = split(text, 2)
        held.update(sector.row[node, d] for node in inside(name) for d in directions)
    rows = [row for row in range(len(dofs)) if row not in held]
    number = {row: i for i, row in enumerate(rows, 1)}

    def free(node, d):
        return number.get(sector.row[node, d])

    pairs = [(free(a, d), free(b, d)) for a, b in zip(left, right) for d in range(3)]
    for (a, b), (node, other) in zip(pairs, [(a, b) for a, b in zip(left, right) for _ in range(3)]):
        if (a is None) != (b is None):
            raise Wrong(f"of nodes {node} and {other}, which are partners, one alone is held")
    pairs = [pair for pair in pairs if pair[0] is not None]
    beyond = set(right)  # their contacts and loads are those of the next sector

    def chosen(text, count):
        name, directions, value = split(text, count)
        for node in inside(name):
            for d in directions if node not in beyond else []:
                if free(node, d) is None:
                    raise Wrong(f"node {node} of {name} is held in the direction {DIRECTIONS[d]}")
                yield node, free(node, d), value

    origin = sector.place[left[0]][1]

    def order(node):
        r, theta, z = sector.place[node]
        return round((theta - origin + 1e-6) % (2 * math.pi), 6), z, r

    found = {(order(node), dof) for text in arguments.contact for node, dof, _ in chosen(text, 2)}
    contacts = [dof for _, dof in sorted(found)]
    load = {}
    for text in arguments.load:
        for node, dof, value in chosen(text, 3):
            angle = sector.place[node][1] - origin
            load[dof] = load.get(dof, 0) + value * cmath.exp(-1j * arguments.wave_number * angle)
    describe = (f"{i} {dofs[row][0]} {DIRECTIONS[dofs[row][1]]} "
                "{:.9g} {:.9g} {:.9g}\n".format(*sector.place[dofs[row][0]]) for i, row in enumerate(rows, 1))
    files = {
        "stiffness.mtx": matrix_text(sector.turned(read_triplets(arguments.job + ".sti", len(dofs))), number),
        "mass.mtx": matrix_text(sector.turned(read_triplets(arguments.job + ".mas", len(dofs))), number),
        "left.txt": "".join(f"{a}\n" for a, _ in pairs),
        "right.txt": "".join(f"{b}\n" for _, b in pairs),
        "contact.txt": "".join(f"{dof}\n" for dof in contacts),
        "dofs.txt": "# dof, node, direction, r, theta, z\n" + "".join(describe),
    }
    if load:
        files["load.txt"] = "# dof, force, imaginary part\n" + "".join(
            f"{dof} {force.real!r} {force.imag!r}\n" for dof, force in sorted(load.items()))
    os.makedirs(arguments.output, exist_ok=True)
    for name, text in files.items():
        path = os.path.join(arguments.output, f"{arguments.name}_{name}")
        with open(path + ".tmp", "w", encoding="utf-8") as out:
            out.write(text)
        os.replace(path + ".tmp", path)
    print(f"{len(rows)} dofs, {len(pairs)} pairs on the boundaries, {len(contacts)} contacts, "
          f"{len(held)} dofs held: {arguments.output}/{arguments.name}_*")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("job", help="name of the files without .sti, .mas, .dof")
    parser.add_argument("--deck", action="append", required=True, help="input deck with nodes and sets; repeatable")
    parser.add_argument("--sectors", type=int, required=True, help="N")
    parser.add_argument("--left", required=True, help="set of nodes")
    parser.add_argument("--right", required=True, help="set of nodes, ahead of the left one by 360/N degrees")
    parser.add_argument("--axis", choices="xyz", default="z", help="axis of rotation; z")
    parser.add_argument("--hold", action="append", default=[], help="SET or SET:rtz; repeatable")
    parser.add_argument("--contact", action="append", default=[], help="SET:z, SET:tz, ...; repeatable")
    parser.add_argument("--load", action="append", default=[], help="SET:z:value, force on each node; repeatable")
    parser.add_argument("--wave-number", type=int, default=0, help="of the load's phase within the sector; 0")
    parser.add_argument("--name", default="base", help="what the files' names begin with; base")
    parser.add_argument("-o", "--output", default=".", help="folder")
    try:
        convert(parser.parse_args())
    except (Wrong, OSError) as error:
        sys.exit(f"sector_matrices.py: {error}")


if __name__ == "__main__":
    main()
