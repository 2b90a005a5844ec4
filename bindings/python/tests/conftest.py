"""The tests run on the installed wheel, from outside the folder of the sources (`.ci/python`)."""

from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture(scope="session")
def root() -> Path:
    """The top of the repository."""
    return ROOT
