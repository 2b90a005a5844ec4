"""The book's preprocessor: links out of docs go to the forge, all others stay."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def shown(path, text):
    """A page's text in the book."""
    chapter = {"path": path, "content": text, "sub_items": []}
    context = {"config": {"preprocessor": {"forge-links": {"repository": "https://forge/x"}}}}
    book = {"items": [{"Chapter": {"path": None, "content": "", "sub_items": []}}, "Separator", {"Chapter": chapter}]}
    script = [sys.executable, ROOT / ".ci/book_links.py"]
    done = subprocess.run(script, input=json.dumps([context, book]), capture_output=True, text=True, check=True)
    return json.loads(done.stdout)["items"][2]["Chapter"]["content"]


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
    assert shown(page, f"see [a]({link}) there") == f"see [a]({expected}) there"
