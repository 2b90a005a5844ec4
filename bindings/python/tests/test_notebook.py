"""The example notebook runs, with few flights, and shows a figure."""

import nbformat
import pytest
from nbclient import NotebookClient


def test_the_notebook_runs(root, monkeypatch, tmp_path):
    monkeypatch.setenv("TRIALS", "2")
    notebook = nbformat.read(root / "bindings/python/examples/figure8.ipynb", as_version=4)
    assert not any(cell.get("outputs") for cell in notebook.cells), "clear the outputs"
    client = NotebookClient(notebook, timeout=600, resources={"metadata": {"path": str(tmp_path)}})
    client.execute()
    shown = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    kinds = {kind for output in shown for kind in output.get("data", {})}
    assert "image/png" in kinds and "text/html" in kinds
    assert not [output for output in shown if output.output_type == "error"]
    with pytest.raises(StopIteration):
        next(output for output in shown if output.get("name") == "stderr")
