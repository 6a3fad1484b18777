"""The notebooks run from a new kernel without an error, and are stored without what they print."""

import pathlib
import shutil

import pytest

NOTEBOOKS = sorted((pathlib.Path(__file__).parents[2] / "src/python/notebooks").glob("*.ipynb"))


def test_there_are_three():
    assert [path.stem for path in NOTEBOOKS] == ["duffing", "figure_8", "sector"]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs_and_its_assertions_hold(path, monkeypatch):
    nbformat = pytest.importorskip("nbformat")
    nbclient = pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    if path.stem == "sector" and not (shutil.which("gmsh") and shutil.which("ccx")):
        pytest.skip("gmsh or ccx is not installed")
    monkeypatch.setenv("OMP_NUM_THREADS", "1")
    notebook = nbformat.read(path, as_version=4)
    nbformat.validate(notebook)
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert any("assert" in cell.source for cell in code)
    assert all(not cell.outputs and cell.execution_count is None for cell in code)
    nbclient.NotebookClient(
        notebook, timeout=120, kernel_name="python3", resources={"metadata": {"path": str(path.parent)}}
    ).execute()  # which raises what a cell does
    assert any("image/png" in output.get("data", {}) for cell in code for output in cell.outputs)
