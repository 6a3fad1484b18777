#!/usr/bin/env python3
"""The mesh of a sector as CalculiX takes it, from the one that gmsh wrote.

`gmsh -3 -format inp` writes an element on every face of the named surfaces and on every edge of the named
curves as well (CPS3, CPS6, T3D2, ...), which CalculiX would take for membranes and bars. These are left out
here, and the sets of elements with them; those of volumes become one set, ALL.

In a step with cyclic symmetry the nodes of the right face follow those of the left one: nothing else may hold
them. --hold SET adds the set of nodes SET_HELD, which are those of SET that are not on the right face.

  volume_mesh.py rotor_gmsh.inp --right RIGHT --hold HUB -o rotor.msh
"""

import argparse
import os
import sys

from sector_matrices import Wrong, keyword, members, read_deck

VOLUME = "C3D"


def volume_lines(path):
    """The lines that stay, and how many elements of which types do not."""
    kept, dropped, drop, kind, elements = [], {}, False, "", 0
    with open(path, encoding="utf-8", errors="replace") as text:
        for line in text:
            if line.startswith("**"):
                continue
            if line.startswith("*"):
                name, parameters = keyword(line)
                kind = parameters.get("TYPE", "").upper() if name == "*ELEMENT" else ""
                drop = name in ("*ELSET", "*HEADING") or bool(kind) and not kind.startswith(VOLUME)
                if kind and not drop:
                    line = f"*ELEMENT, TYPE={kind}, ELSET=ALL\n"
            elif kind and drop:
                dropped[kind] = dropped.get(kind, 0) + 1
            elif kind:
                elements += 1
            if not drop:
                kept.append(line)
    if elements == 0:
        raise Wrong(f"{path} has no volume elements: name the volume as well, Physical Volume(\"ALL\") = ...")
    return kept, dropped


def convert(arguments):
    nodes, sets = {}, {}
    read_deck(arguments.mesh, nodes, sets)
    kept, dropped = volume_lines(arguments.mesh)
    right = set(members(sets, arguments.right)) if arguments.hold else set()
    for name in arguments.hold:
        kept.append(f"*NSET, NSET={name}_HELD\n")
        kept.extend(f"{node},\n" for node in members(sets, name) if node not in right)
    with open(arguments.output + ".tmp", "w", encoding="utf-8") as out:
        out.writelines(kept)
    os.replace(arguments.output + ".tmp", arguments.output)
    print(f"{len(nodes)} nodes; left out: "
          + (", ".join(f"{count} {kind}" for kind, count in sorted(dropped.items())) or "nothing"))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh", help="file that gmsh wrote")
    parser.add_argument("--right", default="RIGHT", help="set of nodes, ahead of the left face; RIGHT")
    parser.add_argument("--hold", action="append", default=[], help="set of nodes that is held; repeatable")
    parser.add_argument("-o", "--output", required=True, help="file to write")
    try:
        convert(parser.parse_args())
    except (Wrong, OSError) as error:
        sys.exit(f"volume_mesh.py: {error}")


if __name__ == "__main__":
    main()
