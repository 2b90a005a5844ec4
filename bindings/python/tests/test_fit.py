"""Aircraft files from flight logs. `fit_trial.py` measures more of them."""

import csv
import os
import subprocess
import sys
import tomllib

import fit_trial
import mppflight
import numpy
import pytest
from mppflight import fit
from mppflight.roll import roll_loop


@pytest.fixture(scope="module")
def flown():
    """A random aircraft with a pitch loop, and its log."""
    rng = numpy.random.default_rng([7, 0])
    keys, delay = fit_trial.aircraft(rng)
    rolls = fit_trial.roll_loop(rng)
    return keys, fit_trial.truth(keys | {"roll_loop": rolls}, delay), fit_trial.fly(keys, delay, rng, rolls=rolls)


def save(path, log):
    with open(path, "w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(log)
        rows.writerows([["" if numpy.isnan(cell) else cell for cell in row] for row in zip(*log.values(), strict=True)])
    return path


def command(*arguments):
    run = [sys.executable, "-m", "mppflight.fit", *map(str, arguments)]
    return subprocess.run(run, capture_output=True, text=True)


def fitted(path, keys, *more):
    done = command(path, "--mass", keys["mass"], "--wing-area", keys["wing_area"], "--cruise", keys["cruise"], *more)
    assert done.returncode == 0, done.stderr
    return done.stdout


def near(text, true):
    """Whether the values of a file are as near to the truth as asked."""
    found = {f"{table}.{key}": v for table, it in tomllib.loads(text).items() if isinstance(it, dict) for key, v in it.items()}
    wanted = fit_trial.WANTED | (fit_trial.WANTED_ROLL if "roll_loop.frequency" in found else {})
    errors = {name: fit_trial.error(name, found[name], true[name]) for name in wanted}
    assert all(errors[name] <= most for name, most in wanted.items()), errors


def test_a_log_gives_the_aircraft_that_flew(flown, tmp_path):
    keys, true, log = flown
    text = fitted(save(tmp_path / "log.csv", log), keys, "--span", fit_trial.SPAN)
    near(text, true)
    assert tomllib.loads(text)["roll_loop"]["span"] == fit_trial.SPAN
    (tmp_path / "plane.toml").write_text(text)
    assert mppflight.Aircraft(tmp_path / "plane.toml").trim["airspeed"] == pytest.approx(keys["cruise"], rel=1e-3)
    if harness := os.environ.get("SIL_HARNESS"):
        subprocess.run([harness, "aircraft", tmp_path / "plane.toml"], check=True, capture_output=True)


def test_height_and_sparse_sensors_do_as_well(flown, tmp_path):
    keys, true, log = flown
    log = {name: column.copy() for name, column in log.items()}
    log["z"] = numpy.cumsum(log.pop("climb")) * 0.02
    log["airspeed"][numpy.arange(len(log["t"])) % 5 != 0] = numpy.nan
    near(fitted(save(tmp_path / "log.csv", log), keys), true)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"throttle": 0.5}, "the throttle never changes by more than 5 %: fly throttle steps"),
        ({"pitch_command": 0.03}, "the commanded pitch never changes by more than 4 deg: fly doublets"),
        ({"pitch": numpy.nan}, "`pitch` is nan in the median"),
        ({"pitch": 4.0}, "`pitch` is 4 in the median: give -0.8 to 0.8"),
        ({"airspeed": 17.0}, "the airspeed stays within 10 %: fly slowly and fast"),
        ({"t": 1.0}, "`t` must rise"),
        ({"roll_command": 0.1}, "the commanded bank never changes by more than 11 deg: fly doublets"),
        ({"roll": 30.0}, "`roll` is 30 in the median: give -0.8 to 0.8"),
    ],
)
def test_what_a_log_does_not_tell_is_said(flown, tmp_path, change, told):
    _, _, log = flown
    log = log | {name: numpy.full_like(log[name], value) for name, value in change.items()}
    done = command(save(tmp_path / "log.csv", log), "--mass", 2, "--wing-area", 0.4, "--span", 1.5)
    assert done.returncode == 2 and told in done.stderr and not done.stdout, done.stderr


def test_a_column_that_is_missing_is_named(flown, tmp_path):
    _, _, log = flown
    path = save(tmp_path / "log.csv", {name: log[name] for name in ("t", "pitch", "climb")})
    with pytest.raises(mppflight.InputError, match="give the columns airspeed, pitch_command, throttle"):
        fit.read(path)


def test_a_log_that_is_no_csv_has_advice(tmp_path):
    (tmp_path / "log").write_bytes(b"\xfe\x00\xff" * 100)
    with pytest.raises(mppflight.InputError, match="give a CSV, or a name that ends in .tlog, .bin, .ulg"):
        fit.read(tmp_path / "log")


def test_the_manoeuvres_are_those_of_the_trials():
    printed = command("--manoeuvres").stdout.splitlines()
    assert len(printed) == len(fit.MANOEUVRES) + len(fit.ROLLS) + 8


def test_without_rolls_the_rest_is_fitted_and_with_a_span_they_are_asked_for(flown, tmp_path):
    keys, true, log = flown
    path = save(tmp_path / "log.csv", {name: column for name, column in log.items() if "roll" not in name})
    near(fitted(path, keys), true)
    done = command(path, "--mass", 2, "--wing-area", 0.4, "--span", 1.5)
    assert done.returncode == 2 and "give the columns roll, roll_command" in done.stderr, done.stderr


@pytest.mark.parametrize("trial", range(3))
def test_a_roll_loop_alone_is_found(trial):
    rng = numpy.random.default_rng([8, trial])
    loop = fit_trial.roll_loop(rng)
    found = roll_loop(fit_trial.roll_log(loop, rng), 15.0)
    assert found["roll_loop.frequency"].value == pytest.approx(loop["frequency"], rel=0.05)
    assert found["roll_loop.delay"].value == pytest.approx(loop["delay"], abs=0.015)
    assert found["roll_loop.max_bank"].value == pytest.approx(loop["max_bank"], rel=0.03)


def test_without_scipy_it_says_what_to_install():
    code = "import sys; sys.modules['scipy.optimize'] = None; import mppflight.fit"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert "pip install 'mppflight[fit]'" in done.stderr
