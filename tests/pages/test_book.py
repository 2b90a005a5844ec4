"""The book's preprocessors: links out of docs go to the forge, and Python has a page of its names."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def through(script, path, text):
    """A page of the book after a preprocessor."""
    chapter = {"name": path, "path": path, "content": text, "number": [7], "sub_items": []}
    context = {"config": {"preprocessor": {"forge-links": {"repository": "https://forge/x"}}}}
    book = {"items": [{"Chapter": {"path": None, "content": "", "sub_items": []}}, "Separator", {"Chapter": chapter}]}
    command = [sys.executable, ROOT / ".ci" / script]
    done = subprocess.run(command, input=json.dumps([context, book]), capture_output=True, text=True, check=True)
    return json.loads(done.stdout)["items"][2]["Chapter"]


@pytest.mark.parametrize("page, link, expected", [
    ("planner.md", "../mpp-core/src/lib.rs", "https://forge/x/mpp-core/src/lib.rs"),
    ("validation/README.md", "../../README.md#fly", "https://forge/x/README.md#fly"),
    ("validation/qp.md", "../planner.md#stages", "../planner.md#stages"),
    ("fields.md", "fields/example.toml", "fields/example.toml"),
    ("fields.md", "scenarios/faults", "https://forge/x/docs/scenarios/faults"),
    ("fields.md", "#keys", "#keys"),
    ("fields.md", "https://elsewhere/a", "https://elsewhere/a"),
])
def test_links(page, link, expected):
    assert through("book_links.py", page, f"see [a]({link}) there")["content"] == f"see [a]({expected}) there"


def test_python_has_a_page_of_its_names_and_no_other_page_has():
    """Which names: `bindings/python/tests/test_names.py`, on the installed package."""
    (below,) = through("book_python.py", "python.md", "text")["sub_items"]
    page = below["Chapter"]
    assert page["number"] == [7, 1] and "### `fly`" in page["content"] and "#### `Planner.plan`" in page["content"]
    assert through("book_python.py", "planner.md", "text")["sub_items"] == []
