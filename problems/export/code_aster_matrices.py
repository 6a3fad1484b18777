"""Writes assembled matrices of code_aster as sector_matrices.py reads them. In a command file:

    from code_aster_matrices import write_matrices
    write_matrices("rotor", stiffness, mass, mesh, ["LEFT", "RIGHT", "HUB", "GROOVE", "RIM"])

Writes rotor.sti and rotor.mas (row, column, value), rotor.dof (node.direction) and rotor.inp (nodes and
groups of nodes).
"""

DIRECTIONS = {"DX": 1, "DY": 2, "DZ": 3}


def triplets(matrix):
    """Values, rows and columns, of code_aster 17 and of those before."""
    if hasattr(matrix, "getValuesWithDescription"):
        values, rows, columns, _ = matrix.getValuesWithDescription()
    else:
        values, rows, columns, _ = matrix.EXTR_MATR(sparse=True)
    return zip(values, rows, columns)


def write_matrix(path, matrix, number):
    """The lower triangle; where both are given they are the same."""
    entries = {}
    for value, row, column in triplets(matrix):
        row, column = int(row), int(column)
        if row in number and column in number:
            entries[max(row, column), min(row, column)] = float(value)
    with open(path, "w", encoding="utf-8") as out:
        for (row, column), value in sorted(entries.items()):
            out.write(f"{number[row]} {number[column]} {value!r}\n")


def write_matrices(job, stiffness, mass, mesh, groups):
    """Displacements alone: multipliers of DDL_IMPO and other components are refused or left out."""
    numbering = stiffness.getDOFNumbering()
    number, names = {}, []
    for row in range(numbering.getNumberOfDOFs()):
        if not numbering.isPhysicalDOF(row):
            raise ValueError("the matrices have multipliers: leave DDL_IMPO out and hold the nodes later")
        component = numbering.getComponentFromDOF(row)
        if component not in DIRECTIONS:
            raise ValueError(f"component {component}: expected a solid model with DX, DY, DZ")
        number[row] = len(names) + 1
        names.append(f"{numbering.getNodeFromDOF(row) + 1}.{DIRECTIONS[component]}\n")
    write_matrix(job + ".sti", stiffness, number)
    write_matrix(job + ".mas", mass, number)
    with open(job + ".dof", "w", encoding="utf-8") as out:
        out.writelines(names)
    places = list(mesh.getCoordinates().getValues())
    with open(job + ".inp", "w", encoding="utf-8") as out:
        out.write("*NODE\n")
        for node in range(len(places) // 3):
            out.write("{}, {!r}, {!r}, {!r}\n".format(node + 1, *map(float, places[3 * node : 3 * node + 3])))
        for group in groups:
            out.write(f"*NSET, NSET={group}\n")
            out.writelines(f"{node + 1}\n" for node in mesh.getNodes(group))
