"""Whole flights: the same bytes as the command line's."""

import hashlib
import pickle
import re
import threading
import time
import tomllib

import mppflight
import numpy as np
import pytest
import scipy.io


def test_the_hash_is_the_readmes(root):
    [shown] = re.findall(r"result: seed 1, .* log ([0-9a-f]{16})", (root / "README.md").read_text())
    assert mppflight.fly(seed=1).log_hash == shown


def test_the_log_is_what_is_hashed_and_reads_back():
    flight = mppflight.fly(seed=2, duration=3)
    log = flight.to_json()
    assert hashlib.sha256(log).hexdigest()[:16] == flight.log_hash
    for copy in (mppflight.Flight.from_json(log), pickle.loads(pickle.dumps(flight))):
        assert copy.log_hash == flight.log_hash
        assert copy.summary == flight.summary


def test_columns_are_arrays_of_the_ticks():
    flight = mppflight.fly(seed=1, duration=5)
    columns = flight.columns
    assert len(flight) == 500
    assert {column.shape for column in columns.values()} == {(500,)}
    assert {column.dtype for column in columns.values()} == {np.dtype("float64")}
    assert np.allclose(np.diff(columns["t"]), 0.01)
    # Before the first plan there is no reference.
    assert np.isnan(columns["ref_x"][0]) and np.isfinite(columns["ref_x"][-1])
    frame = flight.to_pandas()
    assert list(frame.columns) == list(columns) and frame["z"].equals(frame["z"])
    assert (frame["x"].to_numpy() == columns["x"]).all()


def test_the_keys_are_those_of_a_scenario(root):
    file = root / "docs/scenarios/gusts.toml"
    calm, windy = mppflight.fly(seed=4, duration=4), mppflight.fly(scenario=file, seed=4, duration=4)
    assert not calm.columns["wind_x"].any() and windy.columns["wind_x"].any()
    by_hand = mppflight.fly(**{**tomllib.loads(file.read_text()), "seed": 4, "duration": 4})
    assert by_hand.log_hash == windy.log_hash
    assert mppflight.fly(seed=np.int64(4), duration=4).log_hash == calm.log_hash


def test_a_field_aircraft_and_lidar_of_ones_own_are_flown():
    field = mppflight.Field.of_arrays(circles=np.array([[60.0, 50.0, 3.0], [120.0, 52.0, 4.0]]))
    flight = mppflight.fly(field=field, aircraft=mppflight.Aircraft("zagi"), lidar=mppflight.Lidar(beams=64), seed=3)
    header = flight.header
    assert header["aircraft"]["name"] == "zagi" and header["lidar"]["beams"] == 64
    assert (flight.field.circles == field.circles).all()
    assert flight.summary["outcome"] == "survived"


def test_python_runs_while_a_flight_is_under_way():
    counted = 0

    def count():
        nonlocal counted
        while flying.is_set():
            counted += 1
            time.sleep(0)

    flying = threading.Event()
    flying.set()
    counter = threading.Thread(target=count)
    counter.start()
    before = counted
    mppflight.fly(seed=1, duration=60)
    after = counted
    flying.clear()
    counter.join()
    assert after - before > 10


def test_loop_of_world_and_core_flies_the_same_flight():
    keys = {"seed": 5, "obstacles": 30, "duration": 8, "latency_ms": 100}
    columns = mppflight.fly(**keys).columns
    world, core = mppflight.World(**keys), mppflight.Core(**keys)
    going, tick = True, 0
    while going:
        assert world.state["x"] == columns["x"][tick] and world.state["z"] == columns["z"][tick]
        thrust, elevator = core.step(**world.measure())
        assert (thrust, elevator) == (columns["thrust"][tick], columns["elevator"][tick])
        assert core.estimate["z"] == columns["est_z"][tick]
        going = world.step(thrust, elevator)
        tick += 1
    assert tick == 800 and world.outcome == "survived"
    assert core.mode == "tracking" and core.refused == []
    assert core.sensors["lidar"] == "healthy"


@pytest.mark.parametrize("preset", ["reference", "paper", "flight"])
def test_presets_fly(preset):
    assert mppflight.fly(preset=preset, seed=1, obstacles=5, duration=3).summary["replans"] == 3


def test_a_flight_in_space_has_lateral_columns():
    flight = mppflight.fly(preset="space", density=0.005, seed=5)
    columns = flight.columns
    assert len(columns["y"]) == len(columns["t"]) == len(flight)
    assert 0.01 < abs(columns["bank"]).max() < 1.5
    assert flight.header["space"]["density"] == 0.005
    assert mppflight.fly(preset="space", density=0.005, seed=5).log_hash == flight.log_hash
    for keys in ({"obstacles": 5}, {"density": -1.0}, {"aircraft": "cessna182"}):
        with pytest.raises(mppflight.InputError):
            mppflight.fly(preset="space", **keys)


def test_a_flight_in_space_is_looked_at():
    flight = mppflight.fly(preset="space", density=0.02, seed=4)
    look, columns = flight.look(), flight.columns
    assert np.array_equal(look["at"][:-1], np.column_stack([columns[name] for name in "xyz"]))
    assert look["clearance"].min() == flight.summary["min_clearance"]
    # The plan of the last cycle may come too late.
    assert len(look["cycles"]) - len(flight.plans) in (0, 1)
    # Bank and pitch of the attitude are those of the columns, but for the sideslip that the bank of the path leaves out.
    w, x, y, z = look["attitude"][:-1].T
    assert np.allclose(np.arcsin(2 * (w * y - z * x)), columns["pitch"], atol=1e-9)
    # Each hit is at the bark of a trunk or on the ground, but for the lidar's errors.
    trunks = np.array([[it["cylinder"][key] for key in ("x", "y", "radius")] for it in look["bodies"]])
    hits = look["cycles"][60]["hits"]
    off = np.abs(np.linalg.norm(hits[:, None, :2] - trunks[None, :, :2], axis=2) - trunks[:, 2]).min(axis=1)
    assert len(hits) > 100 and np.mean(np.minimum(off, np.abs(hits[:, 2])) < 0.3) > 0.9
    assert all(path.shape[1] == 4 for cycle in look["cycles"] for path in cycle["paths"])
    with pytest.raises(mppflight.InputError, match="look: this flight is in the vertical plane"):
        mppflight.fly(duration=1).look()
    log = flight.to_json().replace(b'"seed":4', b'"seed":5', 1)
    with pytest.raises(mppflight.InputError, match="does not come out the same"):
        mppflight.Flight.from_json(log).look()


def test_flights_and_models_go_to_matlab(tmp_path):
    flight, model = mppflight.fly(duration=1), mppflight.Aircraft().linearize()
    scipy.io.savemat(tmp_path / "flight.mat", flight.columns)
    scipy.io.savemat(tmp_path / "model.mat", model)
    assert np.array_equal(scipy.io.loadmat(tmp_path / "flight.mat")["airspeed"][0], flight.columns["airspeed"])
    back = scipy.io.loadmat(tmp_path / "model.mat")
    assert all(np.array_equal(back[name], model[name]) for name in "ABK")
    assert [name.strip() for name in back["states"]] == model["states"]
