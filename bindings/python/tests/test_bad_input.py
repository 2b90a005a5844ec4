"""Bad input gives an exception with a message that says what to do, and never ends the process."""

import threading
import time

import mppflight
import numpy as np
import pytest

NAN = float("nan")


@pytest.fixture(scope="module")
def planner():
    return mppflight.Planner()


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"sede": 1}, r"^there is no key `sede` \(did you mean `seed`\?\): give preset, .*, field$"),
        ({"sed": None}, "there is no key `sed`"),
        ({"lidar": {"bems": None}}, r"^lidar: there is no key `bems` \(did you mean `beams`\?\): give beams, "),
        ({"lidar": (64, 90.0)}, r"^lidar: give a dict of its keys, not \(64, 90.0\)$"),
        ({"lidar": []}, "^lidar: give a dict of its keys, not "),
        ({"lidar": mppflight.Aircraft()}, "^lidar: give a dict of its keys, not Aircraft"),
        ({"field": mppflight.Lidar()}, "^field: give a dict of its keys, not Lidar"),
        ({"field": {"polygon": [{"points": [[0.0, 1.0, 2.0]]}]}}, "^field.polygon.0.points.0: give a list of 2, not "),
        ({"scenario": 1.5}, "^scenario: give a file: .* not float"),
        ({"scenario": "a\0b"}, "^scenario: give a file, not "),
        ({"seed": -1}, r"^seed: give a whole number from 0 to 2\*\*64 - 1, not -1$"),
        ({"seed": 10**30}, "^seed: give a whole number from 0"),
        ({"obstacles": 20.5}, "^obstacles: give a whole number from 0 .*, not 20.5$"),
        ({"obstacles": "x"}, "^obstacles: give a whole number from 0 .*, not 'x'$"),
        ({"obstacles": True}, "^obstacles: give a whole number .*, not True$"),
        ({"replan_hz": "4"}, "^replan_hz: give a number, not '4'$"),
        ({"oracle": 1}, "^oracle: give True or False, not 1$"),
        ({"preset": 7}, "^preset: give a name, not 7$"),
        ({"faults": {"scan": {"delay_ms": -20}}}, r"^faults\.scan\.delay_ms: give a whole number .*, not -20$"),
        ({"faults": {"gusts": 3}}, r"^faults\.gusts: give a dict of its keys, not 3$"),
        ({"lidar": {3: 4}}, "^lidar: give texts for keys, not 3$"),
        ({"field": {"polygon": [{"points": [[0.0, "a"]]}]}}, r"^field\.polygon\.0\.points\.0\.1: give a number, not 'a'$"),
        ({"aircraft": "f16"}, "^aircraft: there is no `f16`: give reference, .*delta, a file"),
        ({"aircraft": "zagy"}, r"`zagy` \(did you mean `zagi`\?\): give reference"),
        ({"obstacles": 10**9}, "at most 1000"),
        ({"duration": 0}, "give 0.01 to 3600 s"),
        ({"replan_hz": NAN}, "replan_hz"),
        ({"preset": "best"}, "preset: there is no `best`: give reference, "),
        ({"generator": "forrest"}, r"generator.name: there is no `forrest` \(did you mean `forest`\?\)"),
        ({"generator": {"name": "paper", "gap": 3.0}}, "generator.gap: leave it out"),
        ({"lidar": 3}, "^lidar: give a dict of its keys, not 3$"),
        ({"lidar": {"beams": 1000}}, "lidar.beams"),
        ({"body_radius": NAN}, "body_radius"),
        ({"field": {"circle": [{"x": NAN, "z": 50.0, "radius": 1.0}]}}, "circle 1"),
        ({"field": {"circle": [{"x": 0.0, "z": 50.0, "radius": 1.0}]}}, "circle 1"),
        ({"oracle": True, "preset": "paper"}, "only preset flight has an oracle"),
    ],
)
def test_a_scenario_that_makes_no_sense(keys, message):
    for use in (mppflight.fly, mppflight.Core, mppflight.World, mppflight.Planner):
        with pytest.raises(mppflight.InputError, match=message):
            use(**keys)


def test_files_that_are_not_there_or_say_nothing(tmp_path):
    with pytest.raises(FileNotFoundError, match="nowhere"):
        mppflight.Aircraft(tmp_path / "nowhere.toml")
    bad = tmp_path / "bad.toml"
    bad.write_text("mass = 'heavy'\n")
    for use in (mppflight.Aircraft, mppflight.Field, mppflight.Lidar, lambda path: mppflight.fly(scenario=path)):
        with pytest.raises(mppflight.InputError, match="bad.toml"):
            use(bad)
    bad.write_bytes(b"\xff\xfe")
    with pytest.raises(UnicodeDecodeError):
        mppflight.Field(bad)


def test_an_aircraft_that_cannot_fly():
    numbers = mppflight.Aircraft("example").numbers
    with pytest.raises(mppflight.InputError, match="aircraft.mass"):
        mppflight.Aircraft({**numbers, "mass": -1.0})
    with pytest.raises(mppflight.InputError, match="^aircraft: missing field"):
        mppflight.Aircraft({"mass": 1.0})
    with pytest.raises(mppflight.InputError, match="^aircraft.mass: give a number, not 'heavy'"):
        mppflight.Aircraft({**numbers, "mass": "heavy"})
    with pytest.raises(mppflight.InputError, match="there is no `boeing`: give reference"):
        mppflight.Aircraft("boeing")


@pytest.mark.parametrize(
    ("ranges", "message"),
    [
        (np.zeros(99), "100 beams, not 99"),
        (np.zeros((100, 1)), r"shape \(100, 1\)"),
        (np.full(100, -1.0), "beam 0"),
        (np.zeros(100, dtype=complex), "dtype complex128"),
        (np.array(["a"] * 100), "dtype <U1"),
        (np.array([None] * 100), "dtype object"),
    ],
)
def test_scans_that_make_no_sense(planner, ranges, message):
    for use in (planner.plan, lambda ranges: mppflight.Core().step(scan=ranges)):
        with pytest.raises(mppflight.InputError, match=message):
            use(ranges)


def test_arrays_that_make_no_sense():
    with pytest.raises(mppflight.InputError, match="3 columns"):
        mppflight.Field.of_arrays(circles=np.zeros((4, 2)))
    with pytest.raises(mppflight.InputError, match="circle 1"):
        mppflight.Field.of_arrays(circles=[[50.0, NAN, 1.0]])
    with pytest.raises(mppflight.InputError, match="polygon 1"):
        mppflight.Field.of_arrays(polygons=[[[0.0, 0.0], [1.0, 1.0]]])
    field = mppflight.Field.of_arrays(circles=[[50.0, 50.0, 1.0]])
    with pytest.raises(mppflight.InputError, match="2 columns"):
        field.clearance(np.zeros((4, 3)))
    with pytest.raises(mppflight.InputError, match="axes"):
        field.ranges(0.0, 50.0, 0.0)


def test_states_that_are_no_numbers(planner):
    with pytest.raises(mppflight.InputError, match="x: give a finite number"):
        planner.plan(np.zeros(100), x=NAN)
    core = mppflight.Core()
    with pytest.raises(mppflight.InputError, match="airspeed: give a finite number"):
        core.step(NAN, 0.1)
    with pytest.raises(mppflight.InputError, match="airspeed and pitch together"):
        core.step(12.0)
    with pytest.raises(mppflight.InputError, match="sigma: give 0 or more"):
        core.step(x=0.0, z=50.0, sigma=-1.0)
    for velocity in ((0.0, 0.0, -1.0), (0.0, 0.0, NAN), (1e300, 0.0, 0.1)):
        with pytest.raises(mppflight.InputError, match="velocity: give"):
            core.step(x=0.0, z=50.0, velocity=velocity)
    for speed in (0.0, -5.0):
        with pytest.raises(mppflight.InputError, match="airspeed: give more than 0"):
            planner.plan(np.zeros(100), airspeed=speed)
    field = mppflight.Field.of_arrays(circles=[[50.0, 50.0, 1.0]])
    with pytest.raises(mppflight.InputError, match="angles: give a finite number"):
        field.ranges(0.0, 50.0, [0.0, NAN])
    with pytest.raises(mppflight.InputError, match="points: give a finite number"):
        field.clearance([[NAN, 50.0]])
    world = mppflight.World(seed=1)
    world.measure()
    with pytest.raises(mppflight.InputError, match="thrust: give a finite number"):
        world.step(NAN, 3.7)


def test_whole_numbers_that_are_negative_or_too_large():
    field = mppflight.Field.generate(seed=np.int64(3), obstacles=np.uint8(5))
    assert field.table == mppflight.Field.generate(seed=3, obstacles=5).table
    core, lidar = mppflight.Core(), mppflight.Lidar()
    uses = {
        "seed": (mppflight.Field.generate, lambda seed: lidar.scan(field, 0.0, 50.0, seed=seed)),
        "obstacles": (mppflight.Field.generate, lambda obstacles: mppflight.campaign(trials=1, obstacles=obstacles)),
        "trials": (mppflight.campaign,),
        "position_age": (core.step,),
        "air_age": (core.step,),
    }
    for name, calls in uses.items():
        for call in calls:
            for value in (-1, 2**64):
                with pytest.raises(mppflight.InputError, match=f"{name}: give a whole number from 0 to"):
                    call(value) if call.__name__ == "<lambda>" else call(**{name: value})


def test_what_has_sensors_alone_has_no_truth():
    for use in (mppflight.Core, mppflight.Planner, mppflight.World):
        for key in ("oracle", "known_map"):
            with pytest.raises(mppflight.InputError, match=f"{key}: it needs the"):
                use(**{key: True})


NO_NUMBERS = [True, "1", b"1", None, [1.0], {"a": 1.0}, 1j, np.array([1.0, 2.0]), np.bool_(True), object(), float]


@pytest.mark.parametrize("value", NO_NUMBERS, ids=repr)
def test_an_argument_that_is_no_number_is_named(planner, value):
    """Also those that Python would take for a number, as True."""
    field, lidar, core, world = mppflight.Field.generate(), mppflight.Lidar(), mppflight.Core(), mppflight.World()
    numbers = {
        "thrust": [lambda it: world.step(it, 3.7)],
        "elevator": [lambda it: world.step(4.4, elevator=it)],
        "sigma": [lambda it: core.step(x=0.0, z=50.0, sigma=it)],
        "x": [lambda it: planner.plan(np.zeros(100), x=it), lambda it: lidar.scan(field, it, 50.0), lambda it: field.ranges(it, 50.0, [0.0])],
        "pitch_rate": [lambda it: planner.plan(np.zeros(100), pitch_rate=it)],
        "time": [lambda it: field.clearance([[0.0, 50.0]], it)],
        "world_scale": [lambda it: mppflight.Field.generate(world_scale=it)],
    }
    wholes = {
        "position_age": [lambda it: core.step(position_age=it)],
        "obstacles": [lambda it: mppflight.Field.generate(obstacles=it)],
        "index": [mppflight.Campaign({}, trials=1).fly],
        "trials": [lambda it: mppflight.campaign(trials=it)],
    }
    for told, uses in (("a number", numbers), ("a whole number from 0", wholes)):
        for name, calls in uses.items():
            for call in calls:
                with pytest.raises(mppflight.InputError, match=f"^{name}: give {told}.*, not "):
                    call(value)
    for name, call in (("wind", lambda it: planner.plan(np.zeros(100), wind=it)), ("velocity", lambda it: core.step(x=0.0, z=50.0, velocity=it))):
        # Without a velocity a step is sound, and two numbers are a wind.
        if not (value is None and name == "velocity" or isinstance(value, np.ndarray) and name == "wind"):
            with pytest.raises(mppflight.InputError, match=f"^{name}.*: give a "):
                call(value)


def test_an_argument_that_is_no_object_of_its_kind_is_named():
    lidar, field = mppflight.Lidar(), mppflight.Field.generate()
    for name, call in {
        "field": lambda it: lidar.scan(it, 0.0, 50.0),
        "log": mppflight.Flight.from_json,
        "aircraft": mppflight.Aircraft,
        "lidar": mppflight.Lidar,
        "polygons": lambda it: mppflight.Field.of_arrays(polygons=it),
        "keys": lambda it: mppflight.Campaign(it, trials=1),
        "fields": lambda it: mppflight.campaign(trials=1, fields=it),
        "workers": lambda it: mppflight.campaign(trials=1, workers=it),
        "progress": lambda it: mppflight.campaign(trials=1, progress=it),
        "client": lambda it: mppflight.campaign(trials=1, client=it),
    }.items():
        for value in (0, 2.5, [7], True, 10**30) if name != "workers" else (0, -1, 2.5, True, "2", 10**30):
            with pytest.raises(mppflight.InputError, match=f"^{name}: give "):
                call(value)
    with pytest.raises(mppflight.InputError, match="^generator.name: give a name, not 3$"):
        mppflight.Field.generate(3)
    with pytest.raises(mppflight.InputError, match="^polygons: give 2 columns"):
        mppflight.Field.of_arrays(polygons=[np.zeros((3, 3))])
    assert (mppflight.Lidar().scan(field, 0, np.int64(50)) == lidar.scan(field, 0.0, 50.0)).all()


def test_notes_of_others_stay_notes():
    error = mppflight.InputError("give more")
    error.add_note("in line 3")
    assert str(error) == "give more" and error.__notes__ == ["in line 3"]


def test_a_core_keeps_the_last_inputs_that_it_refused():
    core, trim = mppflight.Core(), mppflight.Aircraft().trim
    for tick in range(2010):
        core.step(trim["airspeed"] if tick % 2 else 1e6, trim["pitch"], x=0.12 * tick, z=50.0)
    assert core.refusals == 1005 and len(core.refused) == 1000
    assert core.refused[0][0] == 10 and core.refused[-1][0] == 2008


def test_too_early_and_too_late():
    core = mppflight.Core()
    for look in ("mode", "estimate", "reference", "sensors"):
        with pytest.raises(mppflight.StateError, match="call step first"):
            getattr(core, look)
    for planner in (core, mppflight.Planner()):
        with pytest.raises(mppflight.StateError, match="there is no plan"):
            getattr(planner, "plan" if planner is core else "best")
    with pytest.raises(mppflight.StateError, match="preset flight"):
        mppflight.Planner(preset="paper").map
    world = mppflight.World(seed=1, duration=1)
    with pytest.raises(mppflight.StateError, match="call measure first"):
        world.step(4.4, 3.7)
    world.measure()
    with pytest.raises(mppflight.StateError, match="call step"):
        world.measure()
    while world.step(4.4, 3.7):
        world.measure()
    assert world.outcome == "survived"
    with pytest.raises(mppflight.StateError, match="ended"):
        world.measure()
    with pytest.raises(mppflight.StateError, match="ended"):
        world.step(4.4, 3.7)


def test_the_second_thread_on_one_planner_gets_an_exception():
    """Two threads plan on one planner until they have met."""
    planner, field = mppflight.Planner(), mppflight.Field.generate(obstacles=100, seed=1)
    scan = mppflight.Lidar().scan(field, 20.0, 50.0)
    refused, broken = [], []

    def plan():
        while not refused and not broken and time.monotonic() < end:
            try:
                planner.plan(scan)
            except mppflight.BusyError as error:
                refused.append(str(error))
            except BaseException as error:
                broken.append(error)

    end = time.monotonic() + 60.0
    threads = [threading.Thread(target=plan) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert broken == [] and "give each thread one of its own" in refused[0]
    # The planner works on.
    assert planner.plan(scan)["verdict"] != ""


def test_errors_are_one_family():
    for error in (mppflight.InputError, mppflight.SetUpError, mppflight.FlightError, mppflight.StateError, mppflight.BusyError):
        assert issubclass(error, mppflight.MppError)
    assert issubclass(mppflight.InputError, ValueError) and issubclass(mppflight.BusyError, mppflight.StateError)
    assert issubclass(mppflight.Interrupted, KeyboardInterrupt)


def test_a_small_stack_is_enough():
    """Threads of other programs may have little stack; the core is built on one of its own."""
    size = threading.stack_size(256 * 1024)
    hashes = []
    try:
        thread = threading.Thread(target=lambda: hashes.append(mppflight.fly(seed=1, duration=2).log_hash))
        thread.start()
        thread.join()
    finally:
        threading.stack_size(size)
    assert hashes == [mppflight.fly(seed=1, duration=2).log_hash]
