#!/usr/bin/env python3
"""Matrices of one sector as arcslip reads them, from those that a finite-element program wrote.

Reads JOB.sti, JOB.mas and JOB.dof, as CalculiX stores them, and nodes and sets of nodes from a deck:

  JOB.sti, JOB.mas   row column value, one triangle of a symmetric matrix, from 1, the larger of row and
                     column in ascending order
  JOB.dof            node.direction of each row, directions 1, 2, 3 being x, y, z
  deck               *NODE and *NSET (also GENERATE), in files that it includes too

Every displacement is turned into the cylindrical directions r, t, z of the axis, so that neighbouring sectors
move alike but for the phase; held dofs are left out; the nodes of both boundaries are paired by r and z. The
matrices go through node by node: time grows as their entries do, memory as the nodes.

Writes NAME_mass.mtx, NAME_stiffness.mtx, NAME_left.txt, NAME_right.txt, NAME_contact.txt, NAME_load.txt,
NAME_coordinates.txt and NAME_dofs.txt, which says what each dof is; and case.toml, unless there is one, where
--name is base. With --name damper its table is added to the case. With --at-rest REST the stiffness is that of
REST, NAME_stiffness_speed2.mtx what each radian squared of a speed adds to it, by that of job and its speed, and
NAME_gyroscopic.mtx the matrix of Coriolis' forces at one radian, by the mass.

  sector_matrices.py rotor --deck rotor.inp --sectors 24 --left LEFT --right RIGHT --hold HUB \\
      --contact GROOVE:z --load RIM:z:1.0 --wave-number 3 --name base -o study
"""

import argparse
import cmath
import math
import os
import sys

from stored_matrices import FREE_IT, Wrong, gyroscopic, node_columns, per_speed_squared, read_dofs

DIRECTIONS = "rtz"


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
            if name not in ("*NODE", "*NSET"):
                continue
            parts = [part.strip() for part in line.split(",") if part.strip()]
            members = sets.setdefault(parameters.get("NSET", "").upper(), [])
            try:
                if name == "*NODE":
                    nodes[int(parts[0])] = tuple(map(float, (parts[1:] + ["0", "0"])[:3]))
                    members.append(int(parts[0]))
                elif "GENERATE" in parameters:
                    first, last, step = (list(map(int, parts)) + [1])[:3]
                    members.extend(range(first, last + 1, step))
                else:
                    for part in parts:
                        members.extend([int(part)] if part.isdigit() else sets[part.upper()])
            except (ValueError, IndexError, KeyError):
                raise Wrong(f"{path}:{number}: expected what {name} takes, got '{line.strip()}'") from None


class Sector:
    """The nodes of a finite-element program in cylindrical directions."""

    def __init__(self, nodes, order, axis):
        self.index = {node: i for i, node in enumerate(order)}
        if len(self.index) != len(order):
            raise Wrong("the dofs of a node stand in several places")
        third = "xyz".index(axis)
        self.axes = (third + 1) % 3, (third + 2) % 3, third
        self.place, self.turn = {}, []
        for node in order:
            if node not in nodes:
                raise Wrong(f"node {node} has dofs but no coordinates in the deck")
            x, y, z = (nodes[node][i] for i in self.axes)
            r = math.hypot(x, y)
            if r == 0:
                raise Wrong(f"node {node} is on the axis, where directions r and t are not defined")
            self.place[node] = (r, math.atan2(y, x), z)
            self.turn.append((x / r, y / r))

    def row(self, node, direction):
        return 3 * self.index[node] + direction

    def turned(self, i, k, block):
        """The block of nodes i and k in the directions r, t, z."""
        a, b, z = self.axes
        c, s = self.turn[i]
        columns = []
        for q in self.axes:
            x, y = block[3 * a + q], block[3 * b + q]
            columns.append((c * x + s * y, c * y - s * x, block[3 * z + q]))
        first, second, third = columns
        c, s = self.turn[k]
        return [(c * first[p] + s * second[p], c * second[p] - s * first[p], third[p]) for p in range(3)]

    def write(self, columns, path, number, sign=1):
        """The lower triangle of the dofs that have a number; `sign` is -1 of a skew-symmetric matrix."""
        size, count = sum(map(bool, number)), 0
        with open(path, "w", encoding="utf-8") as out:
            out.write(f"%%MatrixMarket matrix coordinate real {'skew-' if sign < 0 else ''}symmetric\n")
            head = out.tell()
            out.write(f"{size} {size} {0:12}\n")
            for k, blocks in columns:
                lines = []
                for i, block in blocks.items():
                    for p, values in enumerate(self.turned(i, k, block)):
                        column = number[3 * i + p]
                        for q, value in enumerate(values):
                            row = number[3 * k + q]
                            if row >= column > 0 and (value != 0 if row > column else sign > 0):
                                lines.append(f"{row} {column} {sign * value!r}\n")
                out.writelines(lines)
                count += len(lines)
            out.seek(head)
            out.write(f"{size} {size} {count:12}\n")


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


def lists(arguments, sector, sets):
    """The number of each dof, from 1, or 0 where it is held; pairs on the boundaries; contacts; {dof: force}."""
    def inside(name):
        found = members(sets, name)
        lost = [node for node in found if node not in sector.place]
        if lost:
            raise Wrong(f"{len(lost)} of {len(found)} nodes of {name}, as node {lost[0]}, have no dofs: {FREE_IT}")
        return found

    left = inside(arguments.left)
    right = paired(sector, left, inside(arguments.right), arguments.sectors)
    held = set()
    for text in arguments.hold:
        name, directions, _ = split(text, 2)
        held.update(sector.row(node, d) for node in inside(name) for d in directions)
    number, free = [], 0
    for row in range(3 * len(sector.turn)):
        free += row not in held
        number.append(0 if row in held else free)

    pairs = []
    for node, other in zip(left, right):
        for d in range(3):
            pair = number[sector.row(node, d)], number[sector.row(other, d)]
            if (pair[0] == 0) != (pair[1] == 0):
                raise Wrong(f"of nodes {node} and {other}, which are partners, one alone is held")
            if pair[0]:
                pairs.append(pair)
    beyond = set(right)  # their contacts and loads are those of the next sector

    def chosen(text, count):
        name, directions, value = split(text, count)
        for node in inside(name):
            for d in directions if node not in beyond else []:
                if not number[sector.row(node, d)]:
                    raise Wrong(f"node {node} of {name} is held in the direction {DIRECTIONS[d]}")
                yield node, number[sector.row(node, d)], value

    origin = sector.place[left[0]][1]

    def order(node):
        r, theta, z = sector.place[node]
        return round((theta - origin + 1e-6) % (2 * math.pi), 6), z, r

    found = {(order(node), dof) for text in arguments.contact for node, dof, _ in chosen(text, 2)}
    load = {}
    for text in arguments.load:
        for node, dof, value in chosen(text, 3):
            angle = sector.place[node][1] - origin
            load[dof] = load.get(dof, 0) + value * cmath.exp(-1j * arguments.wave_number * angle)
    return number, pairs, [dof for _, dof in sorted(found)], load


def table(name, turns, loaded):
    """The part of a case file that names the files of base or damper."""
    kinds = ("mass", "stiffness") + (("gyroscopic", "stiffness_speed2") if turns else ())
    text = f"\n[system.{name}]\n" + "".join(f'{kind} = "{name}_{kind}.mtx"\n' for kind in kinds)
    text += "".join(f'{key} = "{name}_{key}.txt"\n' for key in ("left", "right", "contact", "coordinates"))
    return text + (f'load = "{name}_load.txt"\n' if loaded else "") + 'damping_kind = "structural"\n'


def case_text(arguments, loaded):
    def line(key, value, means):
        return (f"# {key} = ?" if value is None else f"{key} = {value:.12g}").ljust(31) + f" # {means}\n"

    text = "# Written once by sector_matrices.py, to be edited.\n\n[system]\n" 'model = "sector"\n'
    text += line("wave_number", arguments.wave_number, "that of the phases in the load")
    text += line("sectors", arguments.sectors, "N")
    text += line("contact_stiffness", arguments.contact_stiffness, "of each contact; with kg, N and m in N/m")
    text += line("preload", arguments.preload, "mu p, the largest friction force of one contact; N")
    if arguments.at_rest:
        text += line("speed", math.sqrt(arguments.speed_squared) / (2 * math.pi), "revolutions; or engine_order = m")
    text += "damping = { base = 1e-3, damper = 1e-3 }\n\n[branch]\n" 'parameter = "eta"\n'
    text += "".join(line(key, eta, "Hz") for key, eta in zip(("from", "to"), arguments.eta or (None, None)))
    text += table("base", arguments.at_rest, loaded)
    damper = f"{arguments.output}/damper_"
    turns = os.path.exists(damper + "gyroscopic.mtx")
    return text + (table("damper", turns, False) if os.path.exists(damper + "mass.mtx") else "")


def case_file(arguments, loaded):
    """What case.toml is to hold; none where it stays as it is."""
    path = os.path.join(arguments.output, "case.toml")
    if not os.path.exists(path):
        return case_text(arguments, loaded) if arguments.name == "base" else None
    with open(path, encoding="utf-8") as text:
        case = text.read()
    adds = arguments.name == "damper" and "[system.damper]" not in case
    return case + table("damper", arguments.at_rest, False) if adds else None


def where(r, theta, z, direction):
    """x, y, z of a place, and one of the cylindrical directions there."""
    c, s = math.cos(theta), math.sin(theta)
    return (r * c, r * s, z) + ((c, s, 0), (-s, c, 0), (0, 0, 1))[direction]


def matrices(arguments, sector, number):
    """What to call with a path, to be written there, by the ends of the files' names."""
    count, job = len(sector.turn), arguments.job
    stored = lambda source: node_columns(source, count)
    written = lambda columns, sign=1: lambda path: sector.write(columns, path, number, sign)
    found = {"stiffness": written(stored((arguments.at_rest or job) + ".sti")), "mass": written(stored(job + ".mas"))}
    if arguments.at_rest:
        added = per_speed_squared(stored(job + ".sti"), stored(arguments.at_rest + ".sti"), arguments.speed_squared)
        found["gyroscopic"] = written(gyroscopic(stored(job + ".mas"), sector.axes), -1)
        found["stiffness_speed2"] = written(added)
    return {f"{arguments.name}_{name}.mtx": write for name, write in found.items()}


def convert(arguments):
    if bool(arguments.at_rest) != bool(arguments.speed_squared) or (arguments.speed_squared or 0) < 0:
        raise Wrong("--at-rest and --speed-squared, above 0, go together")
    nodes, sets = {}, {}
    for deck in arguments.deck:
        read_deck(deck, nodes, sets)
    order = read_dofs(arguments.job + ".dof")
    if arguments.at_rest and read_dofs(arguments.at_rest + ".dof") != order:
        raise Wrong(f"{arguments.at_rest}.dof has not the dofs of {arguments.job}.dof")
    sector = Sector(nodes, order, arguments.axis)
    number, pairs, contacts, load = lists(arguments, sector, sets)
    dofs = [(dof, order[row // 3], row % 3) for row, dof in enumerate(number) if dof]
    told = lambda values: " ".join(f"{value:.9g}" for value in values) + "\n"
    files = {
        "left.txt": "".join(f"{a}\n" for a, _ in pairs),
        "right.txt": "".join(f"{b}\n" for _, b in pairs),
        "contact.txt": "".join(f"{dof}\n" for dof in contacts),
        "dofs.txt": "# dof, node, direction, r, theta, z\n" + "".join(
            f"{dof} {node} {DIRECTIONS[d]} {told(sector.place[node])}" for dof, node, d in dofs),
        "coordinates.txt": "# dof, x, y, z with the axis along z, direction of its motion\n" + "".join(
            f"{dof} {told(where(*sector.place[node], d))}" for dof, node, d in dofs),
    }
    if load:
        files["load.txt"] = "# dof, force, imaginary part\n" + "".join(
            f"{dof} {force.real!r} {force.imag!r}\n" for dof, force in sorted(load.items()))
    files = {f"{arguments.name}_{name}": text for name, text in files.items()}
    case = case_file(arguments, bool(load))
    files.update({"case.toml": case} if case else {})
    made = os.path.isdir(arguments.output)
    os.makedirs(arguments.output, exist_ok=True)
    writers = matrices(arguments, sector, number)
    path = lambda name: os.path.join(arguments.output, name)
    try:
        for name, write in writers.items():
            write(path(name) + ".tmp")
        for name, text in files.items():
            with open(path(name) + ".tmp", "w", encoding="utf-8") as out:
                out.write(text)
        for name in (*writers, *files):
            os.replace(path(name) + ".tmp", path(name))
    except BaseException:
        for name in (*writers, *files):
            if os.path.exists(path(name) + ".tmp"):
                os.remove(path(name) + ".tmp")
        if not made:
            os.rmdir(arguments.output)
        raise
    print(f"{sum(map(bool, number))} dofs, {len(pairs)} pairs on the boundaries, {len(contacts)} contacts, "
          f"{number.count(0)} dofs held: {arguments.output}/{arguments.name}_*{', case.toml' if case else ''}")


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
    parser.add_argument("--contact-stiffness", type=float, help="of each contact, for the case file")
    parser.add_argument("--preload", type=float, help="of each contact, for the case file")
    parser.add_argument("--at-rest", metavar="REST", help="job of the same sector at rest; job turns")
    parser.add_argument("--speed-squared", type=float, metavar="S", help="square of its speed, as in CENTRIF")
    parser.add_argument("--eta", type=float, nargs=2, metavar=("FROM", "TO"), help="range, for the case file")
    parser.add_argument("-o", "--output", default=".", help="folder")
    try:
        convert(parser.parse_args())
    except (Wrong, OSError) as error:
        sys.exit(f"sector_matrices.py: {error}")


if __name__ == "__main__":
    main()
