"""The notebooks run, with few flights, and are stored with their pictures."""

import nbformat
import pytest
from nbclient import NotebookClient


def shown(notebook):
    return [output for cell in notebook.cells for output in cell.get("outputs", [])]


def kinds(notebook):
    return {kind for output in shown(notebook) for kind in output.get("data", {})}


@pytest.mark.parametrize(("name", "flown"), [("figure8", {"image/png", "text/html"}), ("tour", {"image/png"})])
def test_a_notebook_runs_and_is_stored_with_its_pictures(name, flown, root, monkeypatch, tmp_path):
    monkeypatch.setenv("TRIALS", "2")
    path = root / f"bindings/python/examples/{name}.ipynb"
    notebook = nbformat.read(path, as_version=4)
    assert flown <= kinds(notebook), "run store.py"
    assert path.stat().st_size < 500_000
    pictures = sum("image/png" in output.get("data", {}) for output in shown(notebook))
    for cell in notebook.cells:
        cell.pop("outputs", None)
        if cell.cell_type == "code":
            cell["outputs"] = []
    NotebookClient(notebook, timeout=600, resources={"metadata": {"path": str(tmp_path)}}).execute()
    assert flown <= kinds(notebook)
    assert pictures == sum("image/png" in output.get("data", {}) for output in shown(notebook))
    assert not [output for output in shown(notebook) if output.output_type == "error" or output.get("name") == "stderr"]
