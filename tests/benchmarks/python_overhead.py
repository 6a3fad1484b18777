"""What the Python module costs: a C++ problem through it, beside the program, and a problem written in Python, beside its own calls.

PYTHONPATH=build/release/python python3 tests/benchmarks/python_overhead.py build/release/bin/arcslip
"""

import pathlib
import resource
import subprocess
import sys
import tempfile
import time
import warnings

import numpy as np

import arcslip

CASES = pathlib.Path(__file__).parents[2] / "problems"
REPEATS = 7


def program_seconds(program, case, settings, folder):
    """Processor time of the program, from its start to its end."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    arguments = [x for setting in settings for x in ("--set", setting)]
    subprocess.run([program, "run", case, "-o", folder, "--quiet", *arguments], check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def module_seconds(case, settings, folder):
    """The same of the module, with the same files written and every column looked at."""
    begun = time.process_time()
    for branch in arcslip.run(case, out=folder, set=settings).branches:
        branch.unknowns, [branch[name] for name in branch.columns]
    return time.process_time() - begun


def compare_with_program(program):
    for name, settings in [
        ("figure_8", ["continuation.max_step=0.005"]),
        ("stability", ["continuation.max_step=0.02"]),
        ("bratu_2d", ["continuation.max_step=0.02"]),
    ]:
        theirs, mine = [], []
        with tempfile.TemporaryDirectory() as folder:
            for _ in range(REPEATS):  # in turn, so that both see the same machine
                theirs.append(program_seconds(program, CASES / f"{name}.toml", settings, folder))
                mine.append(module_seconds(CASES / f"{name}.toml", settings, folder))
        print(f"{name}: program {min(theirs):.3f} s, module {min(mine):.3f} s, {min(mine) / min(theirs):.2f} x")


def duffing(harmonics=15, samples=256):
    """Duffing's oscillator in odd harmonics, with its cubic force evaluated in time."""
    t = 2 * np.pi * np.arange(samples) / samples
    orders = np.arange(1, harmonics + 1, 2)
    shapes = np.hstack([np.cos(np.outer(t, orders)), np.sin(np.outer(t, orders))])
    back = 2 * shapes.T / samples
    squares = np.concatenate([orders, orders]) ** 2.0
    n = len(squares)
    damping = np.zeros((n, n))
    damping[: n // 2, n // 2 :] = np.diag(0.1 * orders)
    damping[n // 2 :, : n // 2] = -np.diag(0.1 * orders)
    load = np.zeros(n)
    load[0] = 1.0

    def f(u, p):
        return (1 - p**2 * squares) * u + p * (damping @ u) + back @ (shapes @ u) ** 3 - load

    def jacobian(u, p):
        x = shapes @ u
        return np.diag(1 - p**2 * squares) + p * damping + back @ ((3 * x**2)[:, None] * shapes)

    def parameter_jacobian(u, p):
        return -2 * p * squares * u + damping @ u

    start = np.zeros(n)
    start[0] = 1.0
    return "Duffing", f, start, 0.2, (0.2, 3.0), {"jacobian": jacobian, "parameter_jacobian": parameter_jacobian}


def bratu(n=100):
    """u'' + lambda e^u = 0 by differences."""
    stiffness = (n + 1) ** 2 * (np.eye(n, k=1) + np.eye(n, k=-1) - 2 * np.eye(n))

    def f(u, p):
        return (stiffness @ u + p * np.exp(u)) / n**2

    def jacobian(u, p):
        return (stiffness + np.diag(p * np.exp(u))) / n**2

    def parameter_jacobian(u, p):
        return np.exp(u) / n**2

    return "Bratu", f, np.zeros(n), 0.0, (0.0, 4.0), {"jacobian": jacobian, "parameter_jacobian": parameter_jacobian}


def sparse_bratu(n=5000):
    """The same with compressed columns."""
    rows = [[i for i in (j - 1, j, j + 1) if 0 <= i < n] for j in range(n)]
    indices = np.concatenate(rows)
    indptr = np.concatenate([[0], np.cumsum([len(column) for column in rows])])
    diagonal = indices == np.repeat(np.arange(n), np.diff(indptr))

    def f(u, p):
        value = -2 * u + p * np.exp(u) / (n + 1) ** 2
        value[1:] += u[:-1]
        value[:-1] += u[1:]
        return value

    def jacobian(u, p):
        data = np.where(diagonal, -2.0, 1.0)
        data[diagonal] += p * np.exp(u) / (n + 1) ** 2
        return data, indices, indptr

    def parameter_jacobian(u, p):
        return np.exp(u) / (n + 1) ** 2

    parts = {"jacobian": jacobian, "parameter_jacobian": parameter_jacobian}
    return "Bratu, sparse", f, np.zeros(n), 0.0, (0.0, 4.0), parts


def without_jacobian(made):
    name, f, u0, p0, range_, _ = made
    return f"{name}, complex steps", f, u0, p0, range_, {}


def seconds_of_solves(jacobian, u, p, count):
    """The time in which numpy, or scipy's SuperLU, solves as many systems with the Jacobian, without a border."""
    given = jacobian(u, p)
    if isinstance(given, tuple):
        from scipy.sparse import csc_matrix
        from scipy.sparse.linalg import splu

        matrix = csc_matrix(given, shape=(len(u), len(u)))
        solve = lambda: splu(matrix).solve(u + 1)
    else:
        solve = lambda: np.linalg.solve(given, u + 1)
    begun = time.process_time()
    for _ in range(count):
        solve()
    return time.process_time() - begun


def compare_with_calls(name, f, u0, p0, range_, parts):
    """The time of a trace beside that of the calls that it makes, made again from Python."""
    calls = []

    def recorded(function):
        def record(u, p):
            calls.append((function, u, p))
            return function(u, p)

        return record

    recording = {key: recorded(function) for key, function in parts.items()}
    sparse = len(u0) > 1000
    arcslip.trace(arcslip.Problem(recorded(f), sparse=sparse, **recording), u0, p0, range=range_, check=False)
    problem = arcslip.Problem(f, sparse=sparse, **parts)
    own, whole = [], []
    for _ in range(REPEATS):
        begun = time.process_time()
        for function, u, p in calls:
            function(u, p)
        own.append(time.process_time() - begun)
        begun = time.process_time()
        branch = arcslip.trace(problem, u0, p0, range=range_, check=False)
        whole.append(time.process_time() - begun)
    each = 1e6 * min(own) / len(calls)
    solves = ""
    if "jacobian" in parts:
        count = branch.work["factorizations"]
        rest = (min(whole) - min(own)) / seconds_of_solves(parts["jacobian"], branch.unknowns[1], p0 + 0.1, count)
        solves = f"; the rest {rest:.2f} x the time in which numpy or scipy solves the {count} systems it factors"
    print(
        f"{name}, {len(u0)} unknowns: {len(branch)} points, {len(calls)} calls of {each:.1f} us, "
        f"trace {min(whole) / min(own):.2f} x these{solves}"
    )


def main():
    warnings.simplefilter("ignore")
    if len(sys.argv) > 1:
        compare_with_program(sys.argv[1])
    for made in (duffing(), bratu(), sparse_bratu(), without_jacobian(duffing()), without_jacobian(bratu(20))):
        compare_with_calls(*made)


if __name__ == "__main__":
    main()
