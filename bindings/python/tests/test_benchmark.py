"""The frozen list of the benchmark is what it was, and its baselines fly."""

import math
import subprocess
import sys
from importlib.resources import files

import mppflight
import numpy as np
import pytest
from mppflight import benchmark


def test_the_list_is_frozen():
    """The generator, the hashes of the obstacles and the figures of difficulty give the same bytes again."""
    assert benchmark.build() == (files("mppflight") / f"{benchmark.VERSION}.json").read_bytes()
    entries = benchmark.fields()
    assert len(entries) == 300 and len({entry.seed for entry in entries}) == 300


def test_a_field_of_the_list_is_the_one_that_is_flown():
    for entry in benchmark.fields()[::60]:
        flight = mppflight.fly(**entry.scenario(), duration=1)
        assert np.array_equal(flight.field.circles, entry.field().circles)


def test_difficulty_of_fields_that_are_easy_to_reckon():
    far = mppflight.Field.of_arrays(circles=[[500.0, 50.0, 1.0], [510.0, 50.0, 1.0]])
    assert benchmark.difficulty(far) == (45.0, pytest.approx(8.0))
    # An aircraft that is four times as fast has lengths sixteen times as long.
    circles = mppflight.Field.generate(obstacles=40, seed=3).circles
    scaled = (circles - [0.0, 50.0, 0.0]) * 16.0 + [0.0, 50.0, 0.0]
    one, other = mppflight.Field.of_arrays(circles=circles), mppflight.Field.of_arrays(circles=scaled)
    assert benchmark.difficulty(other, 16.0) == pytest.approx(benchmark.difficulty(one))


def test_more_obstacles_are_harder():
    entries = benchmark.fields()
    means = []
    for obstacles in benchmark.OBSTACLES:
        own = [(it.traversability, it.relative_gap) for it in entries if it.obstacles == obstacles]
        means.append(np.mean(own, axis=0))
    assert (np.diff(means, axis=0) < 0.0).all()


def test_intervals_are_wilsons():
    # Agresti and Coull 1998: 0 and 10 of 10.
    assert benchmark.wilson(0, 10) == pytest.approx((0.0, 0.2775), abs=1e-4)
    for successes, trials in ((4, 3), (-1, 3), (1.5, 3), (1, "3")):
        with pytest.raises(mppflight.InputError, match="^(successes|trials): give"):
            mppflight.wilson(successes, trials)
    low, high = benchmark.wilson(264, 300)
    assert math.isclose(low, 0.838, abs_tol=5e-4) and math.isclose(high, 0.912, abs_tol=5e-4)


def test_the_agent_flies_as_it_has_learned(root):
    """The network without Stable-Baselines3, in all cells."""
    command = [sys.executable, root / "bindings/python/examples/agent.py"]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    rows = [line.split() for line in done.stdout.splitlines()[:3]]
    counts = {name: [int(count) for count in own] for name, *own in rows}
    assert counts.keys() == set(benchmark.AIRCRAFT)
    # Other processors round other sums, so some flights differ.
    assert all(one >= 19 and two >= 18 for one, two, *_ in counts.values()), counts


def test_the_command_prints_the_table():
    command = [sys.executable, "-m", "mppflight.benchmark", "--every", "60"]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    lines = done.stdout.splitlines()
    assert lines[0].split(" | ")[4:] == ["RRT* alone", "paper", "ours, 1 Hz", "ours, 4 Hz", "oracle |"]
    assert len(lines) == 2 + 5 + 3 and lines[7].startswith("| of 5 |")
