"""The page of names in the book has every name of the package, with the text that `help` shows."""

import importlib
import inspect
import subprocess
import sys

import pytest

import mppflight


@pytest.fixture(scope="module")
def entries(root):
    """The page's entries by their names."""
    script = [sys.executable, root / ".ci/book_python.py", "page"]
    page = subprocess.run(script, capture_output=True, text=True, check=True).stdout
    parts = [part.partition("`\n") for part in page.replace("\n#### `", "\n### `").split("\n### `")[1:]]
    names = [name for name, _, _ in parts]
    assert len(parts) > 100 and len(set(names)) == len(names)
    return {name: text for name, _, text in parts}


def public(kind):
    """The members that a class has of its own, or of this package."""
    own = [one for one in kind.__mro__ if one.__module__.startswith("mppflight")]
    return {name for one in own for name, member in vars(one).items()
            if not name.startswith("_") and (inspect.isroutine(member) or inspect.isdatadescriptor(member))}


def test_every_name_is_there_with_the_text_of_help(entries):
    own = {name: getattr(mppflight, name) for name in mppflight.__all__ if name != "errors"}
    for module in ("environments", "benchmark", "fit"):
        found = vars(importlib.import_module(f"mppflight.{module}")).items()
        own |= {name: one for name, one in found if getattr(one, "__module__", "") == f"mppflight.{module}"
                and inspect.isclass(one) and not name.startswith("_")}
    for name, one in own.items():
        assert name in entries
        members = {f"{name}.{member}": getattr(one, member) for member in (public(one) if inspect.isclass(one) else [])}
        assert members.keys() <= entries.keys(), members.keys() - entries.keys()
        for path, documented in {name: one, **members}.items():
            # A class without a text of its own has that of its base.
            text = None if isinstance(documented, str) else documented.__doc__
            assert inspect.cleandoc(text or "") in entries[path], path


def test_defaults_of_native_arguments_are_those_in_force(entries):
    for parameter in inspect.signature(mppflight.Planner.plan).parameters.values():
        assert parameter.name in entries["Planner.plan"]
    assert "z: float = 50.0" in entries["Planner.plan"]
