"""Flights and their pages, for the tests of pages."""

import base64
import gzip
import itertools
import json
import os
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
BINARY = Path(os.environ.get("SIL_HARNESS", ROOT / "target" / "release" / "sil-harness"))
PHONE = {"width": 390, "height": 844}
# Nothing takes so long, on however slow a machine [ms].
LIMIT = 60_000


def fly(out, *arguments):
    subprocess.run([BINARY, "fly", "--out", out, *arguments], check=False, capture_output=True)
    (log,) = out.glob("*.json")
    return log, json.loads(log.read_text())


def page_of(log, *arguments):
    page = log.with_suffix(".html")
    subprocess.run([BINARY, "replay", log, "--out", page, *arguments], check=True, capture_output=True)
    return page


def value(page, name):
    return page.inner_text(f"#v-{name}")


def says_what_the_log_holds(page, log, tick):
    ticks = log["ticks"]
    assert page.input_value("#time") == str(tick)
    assert page.inner_text("#clock") == f"{ticks['t'][tick]:.2f} s"
    assert float(value(page, "downrange").split()[0]) == pytest.approx(ticks["x"][tick], abs=0.0051)
    assert float(value(page, "height").split()[0]) == pytest.approx(ticks["z"][tick], abs=0.0051)
    assert float(value(page, "airspeed").split()[0]) == pytest.approx(ticks["airspeed"][tick], abs=0.0051)
    assert float(value(page, "thrust").split()[0]) == pytest.approx(ticks["thrust"][tick], abs=0.0051)
    flown = [plan for plan in log["plans"] if plan["used_from_tick"] <= tick]
    if flown:
        assert value(page, "candidates") == str(flown[-1]["candidates"])
        assert value(page, "feasible") == str(flown[-1]["feasible"])
        assert value(page, "plan") == f"{len(flown)} of {len(log['plans'])}"
        assert float(value(page, "cost")) == pytest.approx(flown[-1]["cost"], abs=0.0051)


def pixels(page):
    return page.evaluate("document.getElementById('view').toDataURL()")


def data_of(page):
    """The flight that a page holds."""
    (line,) = [line for line in page.read_text().splitlines() if line.startswith("const DATA = ")]
    packed = json.loads(line.removeprefix("const DATA = ").removesuffix(";"))
    return json.loads(gzip.decompress(base64.b64decode(packed)))[0]


def holds(data, log):
    """Whether a page has the values of a log, as finely as it packs them."""
    for name in ("header", "summary", "plans"):
        assert data[name] == log[name]
    for name, (unit, steps) in data["ticks"].items():
        sums = itertools.accumulate(step or 0 for step in steps)
        found = [None if step is None else total * unit for step, total in zip(steps, sums)]
        assert found == pytest.approx(log["ticks"][name], abs=0.51 * unit), name
