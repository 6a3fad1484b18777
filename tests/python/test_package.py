"""The package itself: what is documented, typed and installed."""

import ast
import inspect
import os
import pathlib
import re
import subprocess
import sys

import numpy as np
import pytest

import arcslip

SOURCE = pathlib.Path(__file__).parents[2]
CLASSES = [getattr(arcslip, name) for name in arcslip.__all__ if inspect.isclass(getattr(arcslip, name))]
FUNCTIONS = [getattr(arcslip, name) for name in arcslip.__all__ if inspect.isfunction(getattr(arcslip, name))]
METHODS = [
    member
    for one in CLASSES
    for name, member in vars(one).items()
    if not name.startswith("_") and (inspect.isfunction(member) or isinstance(member, property))
]


def test_the_version_is_that_of_the_program(program):
    assert program("--version").stdout.splitlines()[0] == f"arcslip {arcslip.__version__}"


@pytest.mark.parametrize("function", [*FUNCTIONS, *METHODS], ids=lambda f: getattr(f, "fget", f).__qualname__)
def test_docstrings_name_every_parameter_and_what_is_returned(function):
    text = inspect.getdoc(function)
    assert text and text.splitlines()[0].endswith((".", ":")) or "\n" in text.split("\n\n")[0]
    if isinstance(function, property):
        return
    given = [name for name in inspect.signature(function).parameters if name not in ("self", "u", "p")]
    documented = text.split("Parameters\n----------\n")[1] if given else ""
    for name in given:
        assert re.search(rf"^([\w, *]*\b)?\*{{0,2}}{name}\b", documented, re.MULTILINE), name
    if function in FUNCTIONS:
        assert "Returns\n-------\n" in text


def test_the_stub_declares_what_there_is_with_the_same_arguments():
    tree = ast.parse((SOURCE / "src/python/arcslip/__init__.pyi").read_text())
    declared = {node.name: node for node in tree.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
    assert set(arcslip.__all__) - {"__version__"} == {name for name in declared if not name.startswith("_")}

    def arguments(node):
        a = node.args
        named = [*a.posonlyargs, *a.args, *a.kwonlyargs, *filter(None, [a.vararg, a.kwarg])]
        return {argument.arg for argument in named}

    for name, node in declared.items():
        if isinstance(node, ast.FunctionDef):
            assert arguments(node) == set(inspect.signature(getattr(arcslip, name)).parameters), name
        elif not name.startswith("_"):
            of_stub = {item.name: item for item in node.body if isinstance(item, ast.FunctionDef)}
            one = getattr(arcslip, name)
            public = {key for key in vars(one) if not key.startswith("_") and callable(vars(one)[key])}
            assert public <= set(of_stub), name
            for key in public:
                assert arguments(of_stub[key]) == set(inspect.signature(vars(one)[key]).parameters), key


def test_what_is_installed_can_be_imported_from_there(tmp_path):
    pytest.importorskip("matplotlib")
    build = os.environ.get("ARCSLIP_BUILD_DIR", SOURCE / "build/release")
    subprocess.run(["cmake", "--install", build, "--component", "python", "--prefix", tmp_path], check=True)
    (package,) = tmp_path.rglob("py.typed")
    code = (
        "import arcslip; print(arcslip.__file__); branch = arcslip.trace(lambda u, p: u - p, 0.0, 0.0);"
        "print(len(branch) > 2); print(len(branch.plot().lines) > 0)"
    )
    said = subprocess.run(
        [sys.executable, "-c", code],
        env={**os.environ, "PYTHONPATH": str(package.parents[1]), "MPLBACKEND": "Agg"},
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=True,
    )
    assert said.stdout.splitlines() == [str(package.parent / "__init__.py"), "True", "True"]
    assert (package.parent / "__init__.pyi").exists()


def test_the_readmes_example_runs(tmp_path, monkeypatch):
    readme = (SOURCE / "README.md").read_text()
    blocks = re.findall(r"```python\n(.*?)```", readme, re.DOTALL)
    assert len(blocks) == 1
    monkeypatch.chdir(SOURCE)
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    code = blocks[0].replace('"figure_8.png"', repr(str(tmp_path / "figure_8.png")))
    names = {}
    exec(compile(code, "README.md", "exec"), names)  # noqa: S102
    assert (tmp_path / "figure_8.png").stat().st_size > 10000
    # What the comments beside the prints say.
    assert names["result"].branches[1]["Y"].max() == pytest.approx(0.00718851766, rel=1e-8)
    folds = [point["lambda"] for point in names["branch"].special if point["type"] == "fold"]
    assert np.round(folds, 6).tolist() == [-0.3849, 0.3849]
