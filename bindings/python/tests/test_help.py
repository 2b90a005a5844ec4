"""What people read at the prompt: help and version."""

import inspect
import re
from importlib.metadata import version

import mpp
import mpp.environments

CLASSES = [mpp.Aircraft, mpp.Campaign, mpp.Core, mpp.Field, mpp.Flight, mpp.Lidar, mpp.Planner, mpp.World]


def texts():
    """Every text and signature of the native half, with its name."""
    for one in [mpp.fly, *CLASSES]:
        yield one.__name__, one.__doc__, one.__text_signature__
        for name, member in getattr(one, "__dict__", {}).items():
            if inspect.isroutine(member) or inspect.isgetsetdescriptor(member):
                yield f"{one.__name__}.{name}", member.__doc__, getattr(member, "__text_signature__", None)


def test_help_is_plain_text():
    shown = list(texts())
    assert len(shown) > 60
    for name, text, signature in shown:
        assert "\\" not in (text or ""), name
        assert "..." not in (signature or "") and "Ellipsis" not in (signature or ""), f"{name}{signature}"


def test_the_defaults_that_help_shows_are_those_in_force():
    shown = inspect.signature(mpp.Planner.plan).parameters
    assert shown["z"].default == 50.0 and shown["wind"].default == (0.0, 0.0)
    field = mpp.Field.of_arrays(circles=[[25.0, 50.0, 1.0]])
    scan = mpp.Lidar().scan(field, 0.0, 50.0)
    default, given = mpp.Planner(), mpp.Planner()
    assert default.plan(scan) == given.plan(scan, z=50.0, wind=(0.0, 0.0))


def test_the_version_is_that_of_the_package():
    assert mpp.__version__ == version("mpp-flight")
    assert re.fullmatch(r"\d+\.\d+\.\d+", mpp.__version__)
