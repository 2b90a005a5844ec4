"""The fit of the derivatives, and a flight of an aircraft of JSBSim."""

import argparse
import json
import tomllib
from pathlib import Path

import fit
import fly
import pytest
from plane import AIRCRAFT, ALTITUDE, Plane

ROOT = Path(__file__).resolve().parents[2]


def arguments(name, **changes):
    values = {"name": name, "obstacles": 20, "replan_hz": 4.0, "navigation": "rtk", "body": None, "oracle": False,
              "wind": 0.0, "gusts": 0.0,
              "core": ROOT / "target/release/sil-harness"}
    return argparse.Namespace(**values | changes)


@pytest.mark.parametrize("name", AIRCRAFT)
def test_level_flight_of_the_file_is_that_of_jsbsim(name):
    plane = Plane(name)
    plane.settle()
    assert abs(plane.z - ALTITUDE) < 0.5 and abs(plane.path) < 1e-3 and abs(plane.airspeed / plane.cruise - 1) < 1e-3
    alpha, elevator = fly.level_flight(fly.configuration(name))
    assert alpha == pytest.approx(plane.alpha, abs=2e-3)
    assert elevator == pytest.approx(plane.elevator, abs=5e-3)
    assert fly.Throttle(name).of(plane.thrust, plane.cruise) == pytest.approx(plane.throttle, abs=0.02)


def numbers(table):
    """All numbers of a table, by key."""
    parts = {key: value for key, value in table.items() if isinstance(value, dict)}
    own = {key: value for key, value in table.items() if isinstance(value, float)}
    return own | {f"{part}.{key}": value for part, inner in parts.items() for key, value in numbers(inner).items()}


def test_the_files_are_what_the_command_writes():
    text, table = fit.fit("J3Cub")
    kept = json.loads((fit.FOLDER / "J3Cub-thrust.json").read_text())
    # The last digit may differ between machines.
    assert [force for row in table["thrust"] for force in row] == pytest.approx(
        [force for row in kept["thrust"] for force in row], abs=0.2)
    kept = numbers(tomllib.loads((fit.FOLDER / "J3Cub.toml").read_text()))
    assert len(kept) > 15 and numbers(tomllib.loads(text)) == pytest.approx(kept, rel=1e-3, abs=2e-3)


def test_the_fit_finds_the_derivatives_that_the_model_has():
    """The J3Cub's reference point is its centre of gravity, and its model names these numbers."""
    level = fit.Coefficients(Plane("J3Cub"))
    found, named = level.derivatives(), level.plane.fdm
    force = named["aero/qbar-psf"] * named["metrics/Sw-sqft"]
    level.at(elevator=0.05)
    lift = named["aero/force/Lift_elevator"] / (force * (level.elevator + 0.05))
    assert found["elevator"][0] == pytest.approx(lift, rel=0.02)
    time = level.chord / (2 * level.plane.cruise)
    level.at(pitch_rate=0.1)
    damping = named["aero/moment/Pitch_damp"] / (force * named["metrics/cbarw-ft"] * 0.1 * time)
    assert found["pitch_rate"][2] == pytest.approx(damping, rel=0.05)


def test_a_flight_survives_and_is_the_same_twice():
    args = arguments("J3Cub")
    (one,), (two,) = fly.share_of((args, [3])), fly.share_of((args, [3]))
    assert one.strict and one.clearance > 0.0
    assert one == two


def test_the_body_counts():
    process, address = fly.serve(arguments("J3Cub"))
    small = fly.fly(address, arguments("J3Cub", body=0.1, navigation="ideal"), 3)
    # The core accepts a body of at most two units of length, 12.5 m here. No way past 160 circles is so wide.
    large = fly.fly(address, arguments("J3Cub", obstacles=160, body=12.0, navigation="ideal"), 3)
    process.kill()
    process.communicate()
    assert small.end == "survived" and large.end == "collision"


def test_an_oracle_knows_what_no_beam_has_seen():
    """With a scan of nothing only the field file tells where the circle is."""
    circle = (400.0, ALTITUDE, 10.0)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(fly, "field", lambda *_: [circle])
        patch.setattr(fly, "sweep", lambda tick, *_: {
            "tick": tick, "angle_min": -0.5, "angle_increment": 0.01, "ranges": [0.0] * 100})
        (blind,), (knows,) = (fly.share_of((arguments("c172p", oracle=oracle), [3])) for oracle in (False, True))
    assert blind.end == "collision" and knows.end == "survived"


def test_a_wind_moves_the_aircraft_and_gusts_have_their_intensity():
    plane = Plane("c172p")
    plane.blow(5.0, 0.0)
    plane.settle()
    for _ in range(100):
        plane.step(plane.throttle, plane.elevator)
    assert plane.x == pytest.approx(plane.cruise + 5.0, abs=0.3)
    gusts = fly.Wind(2.0, 1.0, fly.random.Random(1))
    ahead, up = fly.np.array([gusts.next(50.0) for _ in range(200_000)]).T
    assert (ahead.mean(), ahead.std()) == pytest.approx((2.0, gusts.along), abs=0.15)
    assert (up.mean(), up.std()) == pytest.approx((0.0, 1.0), abs=0.08)


def test_the_interval_is_wilsons():
    """Source: Wilson's score interval, e.g. Brown, Cai, DasGupta 2001: 8 of 10 gives 0.490 to 0.943."""
    assert fly.wilson(8, 10) == pytest.approx((0.490, 0.943), abs=5e-4)
