"""Flights of the node through topics alone: the plant and the node are processes of their own (`.ci/ros` runs this)."""

import json
import math
import os
import subprocess
import sys
from pathlib import Path

import mppflight
import pytest

NODE = os.environ["MPP_ROS"]
PEER = Path(__file__).with_name("peer.py")


def run(*flags: str) -> tuple[dict, str]:
    """A flight: what the peer says, and what the node says to its user."""
    rules = ["-r", "setpoint:=renamed/setpoint", "-p", "airspeed_from:=topic"]
    command = [NODE, "--ros-args", *rules]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as pilot:
        try:
            peer = [sys.executable, str(PEER), *flags]
            flown = subprocess.run(peer, capture_output=True, text=True, timeout=300)
        finally:
            pilot.kill()
        told = pilot.stderr.read()
    assert flown.returncode == 0, flown.stderr + told
    return json.loads(flown.stdout.splitlines()[-1]), told


@pytest.mark.parametrize("seed", [920001, 920002, 920003])
def test_a_flight_through_topics_ends_as_one_in_the_harness_and_is_the_same_twice(seed: int) -> None:
    flown, told = run("--seed", str(seed))
    assert flown["outcome"] == mppflight.fly(seed=seed).summary["outcome"] == "survived"
    assert "none" not in told and abs(flown["state"]["z"] - 50.0) < 10.0
    again, _ = run("--seed", str(seed))
    assert flown["counts"] == again["counts"] == dict.fromkeys(flown["hashes"], 20)
    assert flown["hashes"] == again["hashes"] and flown["state"] == again["state"]


def test_point_clouds_take_the_place_of_scans() -> None:
    flown, told = run("--seed", "920006", "--clouds")
    assert flown["outcome"] == "survived" and flown["counts"]["plan"] == 20
    assert flown["diagnostics"][1]["values"] == {}, told


def test_messages_say_what_the_core_plans_and_sees() -> None:
    flags = ("--seed", "920004", "--duration", "3", "--scan-hz", "10")
    flown, _ = run(*flags, "--replan", "0.5")
    assert flown["counts"]["plan"] == 6 and flown["frame"] == "odom" and flown["points"] == 19
    (x, y, _), (far_x, far_y, far_z) = flown["path"]
    assert math.isclose(math.atan2(far_y - y, far_x - x), 0.6, abs_tol=1e-6)
    assert 30.0 < math.hypot(far_x - x, far_y - y) < 80.0 and abs(far_z - 50.0) < 20.0
    assert 8.0 < flown["speed"] / math.cos(0.6) < 15.0
    assert 0 < flown["lines"] <= 7 and flown["cells"] == [128, 64, [-1, 0, 100]]
    core, inputs = flown["diagnostics"]
    assert (core["level"], core["name"], core["message"]) == (0, "mpp: core", "flies a plan")
    assert core["values"]["lidar"] == "healthy" and "plans_feasible" in core["values"]
    assert (inputs["level"], inputs["message"], inputs["values"]) == (0, "all used", {})


def test_bad_messages_are_told_once_and_the_flight_goes_on() -> None:
    flown, told = run("--seed", "920005", "--duration", "6", "--spoil")
    assert flown["outcome"] == "survived" and flown["ticks"] == 600
    kinds = (
        *("odometry numbers", "odometry stamp"),
        *("scan beams", "scan frame", "scan numbers", "scan size"),
    )
    values = flown["diagnostics"][1]["values"]
    assert set(kinds) <= set(values), values
    assert values["scan frame"].startswith("5, last: the frame is `base_link`, not `lidar_vertical`")
    assert "93 look ahead, and 100 did" in told
    for kind in kinds:
        assert told.count(kind + ": ") == 1, told


@pytest.mark.parametrize(
    ("arguments", "domain", "text"),
    [
        (["-p", "MPP_REPLAN_S:=-1"], "0", "MPP_REPLAN_S"),
        (["-p", "aircraft:=f16"], "0", "aircraft"),
        (["-r", "scan"], "0", "from:=to"),
        ([], "233", "ROS_DOMAIN_ID"),
    ],
)
def test_what_cannot_be_flown_is_refused_at_once(arguments: list[str], domain: str, text: str) -> None:
    ended = subprocess.run(
        [NODE, "--ros-args", *arguments],
        env={**os.environ, "ROS_DOMAIN_ID": domain},
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert ended.returncode == 2 and text in ended.stderr
