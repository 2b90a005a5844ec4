"""What people read at the prompt: help and version."""

import inspect
import re
from importlib.metadata import version

import mppflight
import mppflight.environments

CLASSES = [
    mppflight.Aircraft, mppflight.Campaign, mppflight.Core, mppflight.Field, mppflight.Flight, mppflight.Lidar,
    mppflight.Planner, mppflight.World,
]


def texts():
    """Every text and signature of the native half, with its name."""
    for one in [mppflight.fly, *CLASSES]:
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
    shown = inspect.signature(mppflight.Planner.plan).parameters
    assert shown["z"].default == 50.0 and shown["wind"].default == (0.0, 0.0)
    field = mppflight.Field.of_arrays(circles=[[25.0, 50.0, 1.0]])
    scan = mppflight.Lidar().scan(field, 0.0, 50.0)
    default, given = mppflight.Planner(), mppflight.Planner()
    assert default.plan(scan) == given.plan(scan, z=50.0, wind=(0.0, 0.0))


def test_the_version_is_that_of_the_package():
    assert mppflight.__version__ == version("mppflight")
    assert re.fullmatch(r"\d+\.\d+\.\d+", mppflight.__version__)
