"""Aircraft, fields, lidars, planner and core by themselves."""

import copy
import pickle

import mppflight
import numpy as np
import pytest
import scipy.signal


def test_an_aircraft_comes_by_name_by_file_and_by_numbers(root):
    known = mppflight.Aircraft("zagi")
    from_file = mppflight.Aircraft(root / "aircraft/zagi.toml")
    from_numbers = mppflight.Aircraft(known.numbers)
    assert known.numbers == from_file.numbers == from_numbers.numbers
    assert pickle.loads(pickle.dumps(known)).trim == known.trim
    assert known.trim["airspeed"] == known.numbers["cruise"] == 15.0
    assert mppflight.Aircraft().name == "reference" and "zagi" in mppflight.Aircraft.known()
    assert mppflight.Aircraft().world_scale == 1.0 < known.world_scale


@pytest.mark.parametrize("name", ["reference", "cessna182"])
def test_the_linear_model_flies_as_the_aircraft_does_near_trim(name):
    aircraft = mppflight.Aircraft(name)
    model, trim = aircraft.linearize(), aircraft.trim
    assert model["A"].shape == (4, 4) and model["B"].shape == (4, 2)
    assert model["states"] == ["airspeed", "pitch", "pitch_rate", "flight_path"] and model["inputs"] == ["thrust", "elevator"]
    assert model["input_units"] == ("N", "deg" if name == "cessna182" else "command")
    still = np.array([trim["airspeed"], trim["pitch"], 0.0, 0.0])
    for push in ([0.01 * trim["thrust"], 0.0], [0.0, 0.01]):
        # With an elevator and a motor that follow at once.
        elevator = {key: aircraft.numbers["elevator"][key] for key in ("unit", "moment", "lift")}
        world = mppflight.World(aircraft={**aircraft.numbers, "elevator": elevator, "thrust": {}}, obstacles=0)
        x = np.zeros(4)
        for _ in range(40):
            world.measure()
            world.step(trim["thrust"] + push[0], trim["elevator"] + push[1])
            for _ in range(100):
                x = x + 1e-4 * (model["A"] @ x + model["B"] @ push)
        flown = np.array([world.state[key] for key in model["states"]]) - still
        assert np.allclose(flown, x, rtol=0.05, atol=0.02 * np.abs(x).max()), (flown, x)


@pytest.mark.parametrize("name", mppflight.Aircraft.known())
def test_the_loop_is_at_its_limit_with_its_margins(name):
    aircraft = mppflight.Aircraft(name)
    model, margins = aircraft.linearize(), aircraft.margins()

    def growth(gain, late):
        """Of the loop with so much of its gain, whose commands come so many ticks late, in a tick."""
        a, b, *_ = scipy.signal.cont2discrete((model["A"], model["B"][:, 1:], np.eye(4), np.zeros((4, 1))), 0.01)
        loop = np.zeros((4 + late, 4 + late))
        loop[:4, :4], loop[:4, 4:5], loop[-1, :4] = a, b, -gain * model["K"]
        loop[4:-1, 5:] = np.eye(late - 1)
        return np.abs(np.linalg.eigvals(loop)).max()

    assert growth(1.0, 1) < 1.0 and margins["gain_down"] == 0.0
    assert growth(0.98 * margins["gain_up"], 1) < 1.0 < growth(1.02 * margins["gain_up"], 1)
    ticks = 100 * margins["delay"]
    assert growth(1.0, int(ticks)) < 1.0 < growth(1.0, 3 + int(ticks))
    assert 40 < margins["phase"] < 100 and margins["delay"] == pytest.approx(margins["phase"] / 360 / margins["crossing"])


def test_a_generated_field_is_that_of_the_flight_with_its_seed():
    field = mppflight.Field.generate("forest", obstacles=40, seed=9, radius=1.5)
    flight = mppflight.fly(generator={"name": "forest", "radius": 1.5}, obstacles=40, seed=9, duration=1)
    assert len(field) == 40 and (field.circles == flight.field.circles).all()
    assert pickle.loads(pickle.dumps(field)).table == field.table


def test_a_field_comes_from_a_file_and_goes_to_one(root, tmp_path):
    field = mppflight.Field(root / "docs/fields/example.toml")
    assert set(field.table) > {"circle", "ground"}
    copy = tmp_path / "field.toml"
    copy.write_text(field.to_toml())
    assert mppflight.Field(copy).table == field.table


def test_distances_and_ranges_are_those_of_circles():
    circles = np.array([[10.0, 50.0, 2.0], [30.0, 45.0, 1.0]])
    field = mppflight.Field.of_arrays(circles=circles)
    points = np.random.default_rng(1).uniform([0.0, 30.0], [40.0, 60.0], (200, 2))
    apart = np.linalg.norm(points[:, None] - circles[None, :, :2], axis=2) - circles[:, 2]
    assert np.allclose(field.clearance(points), apart.min(axis=1))
    assert np.allclose(field.ranges(0.0, 50.0, [0.0, np.pi]), [8.0, np.inf])


def test_polygons_ground_and_ceiling_bound_a_tunnel():
    tunnel = mppflight.Field.of_arrays(
        polygons=[[[20.0, 48.0], [22.0, 48.0], [22.0, 52.0], [20.0, 52.0]]],
        ground=[[0.0, 40.0]],
        ceiling=[[0.0, 60.0], [50.0, 58.0]],
    )
    assert np.allclose(tunnel.ranges(0.0, 50.0, [0.0, -np.pi / 2, np.pi / 2]), [20.0, 10.0, 10.0])


def test_a_ring_may_be_closed_as_shapely_gives_it():
    ring = [[20.0, 48.0], [22.0, 48.0], [22.0, 52.0]]
    opened, closed = (mppflight.Field.of_arrays(polygons=[one]) for one in (ring, [*ring, ring[0]]))
    assert opened.table == closed.table == mppflight.Field({"polygon": [{"points": [*ring, ring[0]]}]}).table
    assert len(opened.table["polygon"][0]["points"]) == 3


def test_a_lidar_scans_a_field():
    field = mppflight.Field.of_arrays(circles=[[20.0, 50.0, 1.0]])
    lidar = mppflight.Lidar(beams=51, field_of_view_deg=90.0, range_max=40.0)
    exact = lidar.scan(field, 0.0, 50.0)
    angles = lidar.angles
    assert exact.dtype == np.float32 and exact.shape == angles.shape == (51,)
    assert exact[25] == pytest.approx(19.0) and exact[0] == 0.0
    noisy = lidar.scan(field, 0.0, 50.0, seed=1)
    assert (noisy == lidar.scan(field, 0.0, 50.0, seed=1)).all() and (noisy != exact).any()
    # A pitch turns the fan.
    pitched = lidar.scan(field, 0.0, 50.0, pitch=float(angles[26]))
    assert pitched[24] == pytest.approx(19.0, abs=1e-5)


def test_a_lidar_is_copied_and_pickled():
    lidar = mppflight.Lidar(beams=51, range_max=40.0)
    for other in (copy.copy(lidar), copy.deepcopy(lidar), pickle.loads(pickle.dumps(lidar))):
        assert other.numbers == lidar.numbers


def test_a_planner_plans_around_what_a_scan_shows():
    field = mppflight.Field.of_arrays(circles=[[25.0, 50.0, 1.0]])
    planner, lidar = mppflight.Planner(), mppflight.Lidar()
    pitch = mppflight.Aircraft().trim["pitch"]
    cycle = planner.plan(lidar.scan(field, 0.0, 50.0, pitch))
    assert cycle["verdict"] == "feasible" and cycle["feasible"] > 0
    best = planner.best
    assert best["t"].shape == (19,) and np.allclose(np.diff(best["t"]), 0.25)
    points = np.column_stack([best["x"], best["z"]])
    assert field.clearance(points).min() > 0.5
    candidates = planner.candidates
    count = len(candidates["price"])
    assert count > 1 and candidates["z"].shape == (count, 19)
    # Candidates pass on both sides.
    beside = candidates["z"][np.arange(count), np.abs(candidates["x"] - 25.0).argmin(axis=1)]
    assert (beside > 50.0).any() and (beside < 50.0).any()


def test_the_map_holds_what_the_beams_met():
    field = mppflight.Field.of_arrays(circles=[[25.0, 50.0, 1.0]])
    planner, lidar = mppflight.Planner(), mppflight.Lidar(range_error=0.0)
    planner.plan(lidar.scan(field, 0.0, 50.0, mppflight.Aircraft().trim["pitch"]))
    seen = planner.map
    assert seen["occupied"].shape == seen["distance"].shape == (64, 128)
    rows, columns = np.nonzero(seen["seen"])
    points = np.column_stack([seen["x"][columns], seen["z"][rows]])
    assert len(points) > 0 and np.abs(field.clearance(points)).max() < 1.0
    assert (seen["distance"][seen["occupied"]] <= 0.5).all()
    assert seen["unknown"].any() and not (seen["unknown"] & seen["seen"]).any()
    planner.forget()
    planner.plan(np.zeros(100))
    assert not planner.map["seen"].any()


def test_a_core_shows_plan_and_map():
    core, world = mppflight.Core(seed=1), mppflight.World(seed=1)
    for _ in range(150):
        world.step(*core.step(**world.measure()))
    assert core.ticks == 150
    assert core.plan["t"][0] == pytest.approx(1.01) and core.map["seen"].any()
    assert len(core.candidates["price"]) > 1
    assert abs(core.reference["z"] - core.estimate["z"]) < 1.0
