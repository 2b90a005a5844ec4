"""Tests the package with a flight in real time."""

import json
import os
import shutil
import statistics
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from simulation import BINARY, LASTING, LIMIT, parameters

from mpp_ground import paramfile, plot
from mpp_ground.cli import main
from mpp_ground.link import GroundError, Vehicle, mavlink


@pytest.fixture
def held(simulate):
    simulation = simulate("--hold", "--speed", "1", "--duration", "3600", "--preset", "paper")
    vehicle = Vehicle(simulation.address, patience=LIMIT)
    yield simulation, vehicle
    vehicle.close()


def end(vehicle):
    vehicle.demand(mavlink.MAV_CMD_DO_FLIGHTTERMINATION, 1)


def test_a_flight_is_tuned_commanded_and_reproduced(held, simulate):
    simulation, vehicle = held
    assert vehicle.parameters() == pytest.approx(parameters("paper"), rel=1e-6)
    assert vehicle.write("LQR_R_ELEVATOR", 0.6) == pytest.approx(0.6)
    assert vehicle.read("LQR_R_ELEVATOR") == pytest.approx(0.6)
    with pytest.raises(GroundError, match="MPP_PATHS stays 25: 99 is refused .out of range."):
        vehicle.write("MPP_PATHS", 99)
    vehicle.ask_for_plans()
    vehicle.demand(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)
    assert vehicle.receive("MPP_PLAN_STATUS", LIMIT).candidates > 0
    assert vehicle.write("MPP_PATHS", 12) == 12
    with pytest.raises(GroundError, match="not in flight"):
        vehicle.write("LQR_R_ELEVATOR", 0.7)
    assert vehicle.command(31_000) == "UNSUPPORTED"
    while vehicle.receive("MPP_PLAN_STATUS", LIMIT).candidates != 12:
        pass
    end(vehicle)
    code, out, _ = simulation.result()
    result = json.loads(out)
    assert (code, result["outcome"]) == (8, "terminated")

    log = json.loads(open(result["log"]).read())
    orders = [(order["name"], order["value"]) for order in log["orders"] if order["order"] == "parameter"]
    assert orders == [("LQR_R_ELEVATOR", 0.6), ("MPP_PATHS", 12.0)]
    again = simulate("--orders", result["log"], "--speed", "max")
    _, out, _ = again.result()
    assert json.loads(out)["log_hash"] == result["log_hash"]


def test_what_is_heard_is_what_is_logged(simulate):
    simulation = simulate("--hold", "--speed", "2", "--duration", "6")
    vehicle = Vehicle(simulation.address, patience=LIMIT)
    vehicle.ask_for_plans()
    vehicle.demand(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)
    plans, scans = [], []
    while (message := vehicle.receive(["MPP_PLAN_STATUS", "MPP_LIDAR_SCAN", "STATUSTEXT"], LIMIT)) is not None:
        if message.get_type() != "STATUSTEXT":
            (plans if message.get_type() == "MPP_PLAN_STATUS" else scans).append(message)
        elif message.text.startswith("Flight ended"):
            break
    vehicle.close()
    _, out, _ = simulation.result()
    log = json.loads(open(json.loads(out)["log"]).read())
    outcomes = ["Adopted", "LeastViolating", "KeptPrevious", "TrimHold", "Pursuit", "Reserve", "Latest"]
    told = [(p.scan_tick, p.used_from_tick, p.candidates, p.feasible, outcomes[p.outcome]) for p in plans]
    names = ("tick", "used_from_tick", "candidates", "feasible", "outcome")
    assert told == [tuple(plan[name] for name in names) for plan in log["plans"]]
    for told, plan in zip(plans, log["plans"]):
        assert told.cost == pytest.approx(plan["cost"], rel=1e-6)
    assert [scan.tick for scan in scans] == [plan["tick"] for plan in log["plans"]]
    for scan in scans:
        hits = plot.returns({
            "MPP_LIDAR_SCAN": [scan],
            "LOCAL_POSITION_NED": [Pose(scan, log)],
            "ATTITUDE": [Pose(scan, log)],
        })
        for x, z in hits:
            # The return is on the edge of an obstacle of the log, except for the lidar's noise.
            edge = min(abs(((x - o["x"]) ** 2 + (z - o["z"]) ** 2) ** 0.5 - o["radius"]) for o in log["header"]["field"]["circle"])
            assert edge < 1.5, (scan.tick, x, z)


class Pose:
    """The aircraft's position at a scan, from the log."""

    def __init__(self, scan, log):
        ticks = log["ticks"]
        self.time_boot_ms = scan.time_boot_ms
        self.x, self.y, self.z = ticks["x"][scan.tick], 0.0, -ticks["z"][scan.tick]
        self.pitch = ticks["pitch"][scan.tick]


def test_an_interval_is_kept(simulate):
    simulation = simulate(*LASTING)
    vehicle = Vehicle(simulation.address, patience=LIMIT)
    for milliseconds in (20, 200):
        vehicle.demand(mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, mavlink.MAVLINK_MSG_ID_ATTITUDE, 1e3 * milliseconds)
        # Messages that were sent before come first.
        times = [vehicle.receive("ATTITUDE", LIMIT).time_boot_ms for _ in range(40)]
        assert statistics.median(b - a for a, b in zip(times[10:], times[11:])) == milliseconds
    vehicle.close()


def test_with_a_key_only_its_holder_commands(simulate, tmp_path):
    key = tmp_path / "key"
    key.write_text("correct horse\n")
    simulation = simulate(*LASTING, "--mavlink-key", str(key))
    stranger = Vehicle(simulation.address, patience=LIMIT)
    assert len(stranger.parameters()) == len(parameters())
    stranger.patience = 1.0
    with pytest.raises(GroundError, match="no answer to COMPONENT_ARM_DISARM"):
        stranger.command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)
    stranger.close()
    holder = Vehicle(simulation.address, passphrase="correct horse", patience=LIMIT)
    assert holder.write("MPP_PATHS", 11) == 11
    holder.ask_for_plans()
    holder.demand(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)
    assert holder.receive("MPP_PLAN_STATUS", LIMIT) is not None
    end(holder)
    holder.close()
    code, _, err = simulation.result()
    assert code == 8 and "1 commands or writes were refused: no good signature" in err


def test_every_command_of_the_command_line(simulate, tmp_path, capsys):
    simulation = simulate(*LASTING)

    def run(*arguments):
        code = main(["--connect", simulation.address, *arguments])
        said = capsys.readouterr()
        return code, said.out or said.err

    saved = tmp_path / "saved.parm"
    assert run("params", "save", str(saved)) == (0, "")
    assert dict(paramfile.values(saved.read_text()))["MPP_ALT_M"] == 50
    assert run("params", "set", "MPP_ALT_M", "51.5") == (0, "MPP_ALT_M,51.5\n")
    assert run("params", "get", "MPP_ALT_M") == (0, "MPP_ALT_M,51.5\n")
    code, out = run("params", "load", str(saved))
    assert code == 0 and "MPP_ALT_M,50\n" in out
    assert run("params", "set", "MPP_ALT_M", "-3")[0] == 1
    for arguments in (["set", "NOPE", "12"], ["get", "NOPE"]):
        assert run("params", *arguments) == (1, "error: NOPE: no such parameter\n")
    assert "capabilities" in run("command", "request", "autopilot_version")[1]
    # From here on whole numbers come as integers.
    assert run("params", "get", "MPP_PATHS") == (0, "MPP_PATHS,25\n")
    assert run("params", "set", "MPP_PATHS", "24") == (0, "MPP_PATHS,24\n")
    assert run("command", "interval", "attitude", "25")[0] == 0
    assert run("command", "interval", "no_such_thing", "25")[0] == 1
    assert run("command", "mode", "cruise")[0] == 0
    assert run("command", "mode", "auto")[0] == 0
    assert run("command", "arm") == (0, "COMPONENT_ARM_DISARM: ACCEPTED\n")
    assert run("command", "altitude", "52")[0] == 0
    code, said = run("command", "altitude", "9999")
    assert code == 1 and "DO_CHANGE_ALTITUDE: FAILED: MPP_ALT_M: out of range" in said
    assert run("command", "disarm")[0] == 1
    tlog = tmp_path / "a.tlog"
    assert run("record", str(tlog), "--seconds", "1.5")[0] == 0
    out = run("monitor", "--once")[1]
    assert "AUTO, armed" in out and "ATTITUDE" in out
    # It asked for what is sent to nobody else.
    assert plot.read(tlog)["MPP_LIDAR_SCAN"]
    assert run("command", "terminate")[0] == 0
    code, out, _ = simulation.result()
    assert code == 8 and json.loads(out)["outcome"] == "terminated"

    pytest.importorskip("matplotlib")
    picture = tmp_path / "a.png"
    assert run("plot", str(tlog), "--out", str(picture))[0] == 0
    assert picture.stat().st_size > 20_000


def test_a_recording_has_the_same_bytes_and_others_read_it(tmp_path):
    def fly(name):
        tlog = tmp_path / name
        command = [BINARY, "fly", "--duration", "5", "--tlog", tlog, "--out", tmp_path / "out"]
        subprocess.run(command, check=True, capture_output=True)
        return tlog

    tlog = fly("a.tlog")
    assert tlog.read_bytes() == fly("b.tlog").read_bytes()
    dump = subprocess.run(
        [sys.executable, Path(sys.executable).with_name("mavlogdump.py"), "--show-source", tlog],
        capture_output=True, check=True, text=True, env={**os.environ, "TZ": "UTC"},
    ).stdout.splitlines()
    # The flight takes 5 s, and a text comes at its end.
    count = {kind: sum(f" {kind} " in line for line in dump) for kind in ("ATTITUDE", "HEARTBEAT", "STATUSTEXT")}
    assert count == {"ATTITUDE": 50, "HEARTBEAT": 6, "STATUSTEXT": 1}
    assert not any("BAD_DATA" in line for line in dump)
    assert dump[0].startswith("2026-01-01 00:00:00.00") and dump[-1].startswith("2026-01-01 00:00:05.00")


def test_the_wheel_says_its_version_and_brings_its_licences(tmp_path):
    source = Path(__file__).resolve().parents[1]
    build = [sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "--no-build-isolation", "-w", tmp_path]
    # A copy, because a build leaves its folders beside the source.
    copy = shutil.copytree(source, tmp_path / "ground", ignore=shutil.ignore_patterns("build", "*.egg-info"))
    subprocess.run([*build, copy], check=True, capture_output=True)
    (wheel,) = tmp_path.glob("*.whl")
    names = zipfile.ZipFile(wheel).namelist()
    for licence in ("LICENSE-MIT", "LICENSE-APACHE"):
        (found,) = [name for name in names if name.endswith(licence)]
        assert zipfile.ZipFile(wheel).read(found) == (source.parent / licence).read_bytes()
    assert "mpp_ground/mpp.xml" in names
    said = subprocess.run(
        [Path(sys.executable).with_name("mpp-ground"), "--version"], check=True, capture_output=True, text=True,
    ).stdout
    assert said == f"mpp-ground {wheel.name.split('-')[1]}\n"


def test_the_height_of_a_calm_flight_is_no_line(tmp_path):
    pytest.importorskip("matplotlib").use("Agg")
    from matplotlib import pyplot

    tlog = tmp_path / "calm.tlog"
    command = [BINARY, "fly", "--duration", "5", "--obstacles", "0", "--tlog", tlog, "--out", tmp_path / "out"]
    subprocess.run(command, check=True, capture_output=True)
    figure = plot.draw(plot.read(tlog), pyplot)
    figure.canvas.draw()
    side, speed, *_ = figure.axes
    height = side.get_window_extent().height
    pyplot.close(figure)
    assert height > 0.5 * speed.get_window_extent().height


def test_an_installation_leaves_nothing_for_git():
    root = Path(__file__).resolve().parents[2]
    if not (root / ".git").exists():
        pytest.skip("no checkout")
    for left in ("ground/build/lib/mpp_ground/cli.py", "ground/mpp_ground.egg-info/PKG-INFO"):
        assert subprocess.run(["git", "check-ignore", "--quiet", left], cwd=root).returncode == 0, left


def test_a_silent_vehicle_is_an_error():
    with pytest.raises(GroundError, match="no vehicle was heard"):
        Vehicle("udpin:127.0.0.1:0", patience=0.5)


def test_parameter_files():
    values = {"A": 0.1, "LONG_NAME": 12.0}
    assert paramfile.values(paramfile.text(values)) == [("A", 0.1), ("LONG_NAME", 12.0)]
    assert paramfile.values("# x\nA   1 # y\n\n") == [("A", 1.0)]
    with pytest.raises(GroundError, match="line 2"):
        paramfile.values("A,1\nB\n")
