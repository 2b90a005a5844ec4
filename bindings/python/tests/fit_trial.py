"""Flies random aircraft of our own plant, fits their logs, and prints how near the values are: `fit_trial.py 50 --seed 1`.
With `--fields 100` each aircraft then flies past obstacles, by a core that was told its true file and by one that was told
the fitted file. With `--rolls` it fits the roll loops of random autopilots.
"""

import argparse
import math
import sys
import tomllib

import mppflight
import numpy
from mppflight import fit

# Of the wing [m]. It only goes into the file.
SPAN = 1.5
# Greatest errors that count as a success: shares of the value, and seconds.
WANTED = {"lift.alpha": 0.10, "thrust.max": 0.10, "pitch_loop.frequency": 0.05, "pitch_loop.delay": 0.015}
WANTED_ROLL = {"roll_loop.frequency": 0.05, "roll_loop.delay": 0.015}
MORE = ("lift.zero", "drag.zero", "drag.induced", "thrust.lag", "pitch_loop.damping")
MORE_ROLL = ("roll_loop.damping", "roll_loop.max_bank", "roll_loop.max_rate")


def aircraft(rng):
    """Keys of a random aircraft with a pitch loop, and the dead time of its autopilot [s]."""
    while True:
        mass, cruise = rng.uniform(0.8, 8.0), rng.uniform(11.0, 24.0)
        lift = rng.uniform(0.3, 0.7)
        keys = {
            "name": "random", "source": "drawn", "derivatives": "radian", "mass": mass, "chord": 0.3,
            "wing_area": 2 * mass * 9.81 / (1.225 * cruise**2 * lift), "cruise": cruise,
            "lift": {"zero": rng.uniform(0.0, 0.4), "alpha": rng.uniform(3.5, 6.5)},
            "drag": {"zero": rng.uniform(0.02, 0.1), "induced": rng.uniform(0.03, 0.09)},
            "pitch_loop": {"frequency": rng.uniform(3.5, 10.0), "damping": rng.uniform(0.5, 1.2)},
            "thrust": {"max": mass * 9.81 * rng.uniform(0.35, 0.9), "lag": rng.uniform(0.05, 0.5)},
        }  # fmt: skip
        delay = int(rng.integers(2, 15)) * 0.01
        try:
            if mppflight.Aircraft(keys).trim["thrust"] < 0.5 * keys["thrust"]["max"]:
                return keys, delay
        except mppflight.MppError:
            continue


def roll_loop(rng):
    """Keys of a random autopilot's roll loop."""
    return {
        "frequency": rng.uniform(2.5, 9.0), "damping": rng.uniform(0.5, 1.2), "delay": rng.uniform(0.02, 0.14),
        "max_bank": rng.uniform(0.6, 1.1), "max_rate": rng.uniform(0.7, 3.0),
    }  # fmt: skip


def roll(loop, t, rng):
    """The manoeuvres of the bank that end with a log at 50 Hz: the bank that is measured and the command, with noise, bias and
    lag, and the commands of an autopilot that holds the course before. The dead time has the lag in it."""
    w, damping, step = loop["frequency"], loop["damping"], 0.001
    begin = t[-1] - numpy.cumsum([seconds + rng.uniform(-0.1, 0.1) for seconds, _ in fit.ROLLS][::-1])[::-1]
    fine = numpy.arange(t[0] - 1.0, t[-1] + step, step)
    index = numpy.searchsorted(begin, fine, side="right") - 1
    command = numpy.radians(numpy.where(index < 0, 2.0 * numpy.sin(fine), numpy.array([it for _, it in fit.ROLLS])[index]))
    lag, most = rng.uniform(0.005, 0.02), 2 * damping * w * loop["max_rate"]
    bank = rate = told = 0.0
    flown = numpy.empty_like(fine)
    held = command[numpy.maximum(numpy.arange(len(fine)) - round((loop["delay"] - lag) / step), 0)]
    for k, wanted in enumerate(held.clip(-loop["max_bank"], loop["max_bank"])):
        flown[k] = told
        rate += step * (min(max(w * w * (wanted - bank), -most), most) - 2 * damping * w * rate)
        bank += step * rate
        told += step / lag * (bank - told)
    noise = math.radians(0.3) * rng.normal(size=len(t)) + rng.normal(0.0, math.radians(0.5))
    return {"roll": numpy.interp(t, fine, flown) + noise, "roll_command": numpy.interp(t, fine, command)}


def roll_log(loop, rng):
    """What a log has of the roll loop alone."""
    t = numpy.arange(0.0, sum(seconds for seconds, _ in fit.ROLLS) + 3.0, 0.02)
    return {"t": t, "airspeed": 15.0 + 0.3 * rng.normal(size=len(t))} | roll(loop, t, rng)


def over_ground(state):
    """Velocity downrange and up [m/s]."""
    path, wind = state["flight_path"], [state["wind_x"], state["wind_z"]]
    return state["airspeed"] * numpy.array([math.cos(path), math.sin(path)]) + wind


def fly(keys, delay, rng, gusts=0.0, accelerometers=True, rolls=None):
    """The manoeuvres as a log at 50 Hz, with noise, biases and lags of the sensors. With the keys of a roll loop those of the
    bank follow; our plant then flies straight on, and the loop beside it."""
    plane = mppflight.Aircraft(keys)
    duration = sum(seconds for seconds, _, _ in fit.MANOEUVRES)
    more = sum(seconds for seconds, _ in fit.ROLLS) + 2.0 if rolls else 0.0
    faults = {"gusts": {"intensity": gusts}} if gusts else {}
    # Manoeuvres begin when the pilot moves the stick, not at a tick of the log.
    begin = numpy.cumsum([0.0] + [seconds + rng.uniform(-0.1, 0.1) for seconds, _, _ in fit.MANOEUVRES])
    seed = int(rng.integers(1 << 30))
    world = mppflight.World(seed=seed, obstacles=0, duration=duration + more + 5.0, aircraft=plane, faults=faults)
    trim, most = plane.trim, keys["thrust"]["max"]
    commands, rows, before, air, felt = [], [], 0.0, None, None
    lag = rng.uniform(0.03, 0.2)
    filtering = rng.uniform(0.3, 1.0)
    late = int(rng.integers(0, 11))
    bias = rng.normal(0.0, [0.1, 0.1, 0.3, math.radians(0.5)])
    while world.state["t"] < begin[-1] + more - 0.2:
        s = world.state
        index = min(int(numpy.searchsorted(begin, s["t"], side="right")) - 1, len(fit.MANOEUVRES) - 1)
        _, pitch, factor = fit.MANOEUVRES[index] if s["t"] < begin[-1] or not rolls else (0.0, 0.0, 1.0)
        command = trim["pitch"] + math.radians(pitch)
        throttle = min(factor * trim["thrust"] / most, 1.0)
        commands.append(command)
        held = commands[max(len(commands) - 1 - round(delay / 0.01), 0)]
        world.measure()
        # The path at the middle of the tick: a real autopilot is not told it once a tick.
        middle = s["flight_path"] + 0.5 * (s["flight_path"] - before)
        before = s["flight_path"]
        world.step(throttle * most, held - middle)
        air = s["airspeed"] if air is None else air + 0.01 / lag * (s["airspeed"] - air)
        # Specific force along the body, of the motion over ground.
        fx, fz = (over_ground(world.state) - over_ground(s)) / 0.01 + [0.0, 9.81]
        sin, cos = math.sin(s["pitch"]), math.cos(s["pitch"])
        push = numpy.array([fx * cos + fz * sin, fx * sin - fz * cos])
        felt = push if felt is None else felt + filtering * (push - felt)
        rows.append([s["t"], air, s["pitch"], command, throttle, over_ground(s)[1], *felt])
    table = numpy.array(rows)
    table[late:, 5] = table[: len(table) - late, 5]
    table = table[20::2]
    noise = rng.normal(size=table.shape)
    table[:, 1] += bias[2] + 0.3 * noise[:, 1]
    table[:, 2] += bias[3] + math.radians(0.3) * noise[:, 2]
    table[:, 5] += 0.2 * noise[:, 5]
    table[:, 6:] += bias[:2] + 0.4 * noise[:, 6:]
    names = ["t", "airspeed", "pitch", "pitch_command", "throttle", "climb", "ax", "az"]
    log = {name: table[:, k].copy() for k, name in enumerate(names) if accelerometers or k < 6}
    return log | (roll(rolls, log["t"], rng) if rolls else {})


def truth(keys, delay=None):
    """The true value of each parameter."""
    values = {f"{table}.{key}": v for table, it in keys.items() if isinstance(it, dict) for key, v in it.items()}
    return values | ({"pitch_loop.delay": delay} if delay else {})


def error(name, found, true):
    """Error as it is judged."""
    return abs(found - true) / (1.0 if name in ("pitch_loop.delay", "roll_loop.delay", "lift.zero") else true)


def past_obstacles(keys, delay, values, obstacles, seeds):
    """How many fields an aircraft survives, planned at 1 Hz: with a core that was told the true file, the fitted file, with
    either. The core's thrust reaches the motor as a throttle, a share of the greatest thrust of the file."""
    true = mppflight.Aircraft(keys | {"pitch_loop": keys["pitch_loop"] | {"delay": delay}})
    known = fit.Known(keys["mass"], keys["wing_area"])
    fitted = mppflight.Aircraft(tomllib.loads(fit.toml(values, known, keys["cruise"], "fitted", "of a trial")))
    most = keys["thrust"]["max"]

    def survives(told, factor, seed):
        shared = {"seed": int(seed), "preset": "flight", "obstacles": obstacles, "replan_hz": 1.0}
        shared["world_scale"] = true.world_scale
        world, core = mppflight.World(aircraft=true, **shared), mppflight.Core(aircraft=told, **shared)
        going = True
        while going:
            thrust, elevator = core.step(**world.measure())
            going = world.step(thrust * factor, elevator)
        return world.outcome == "survived"

    ends = [(survives(true, 1.0, it), survives(fitted, most / values["thrust.max"].value, it)) for it in seeds]
    return numpy.array([(one, other, one and other) for one, other in ends]).sum(axis=0)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("trials", type=int)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--gusts", type=float, default=0.0)
    parser.add_argument("--without-accelerometers", action="store_true")
    parser.add_argument("--fields", type=int, default=0, help="fields that each aircraft flies through")
    parser.add_argument("--obstacles", type=int, default=20, help="obstacles in each field")
    parser.add_argument("--rolls", action="store_true", help="roll loops instead, each beside our plant")
    given = parser.parse_args()
    past = numpy.zeros(3, int)
    wanted, more = (WANTED_ROLL, MORE_ROLL) if given.rolls else (WANTED, MORE)
    errors, covered = {name: [] for name in (*wanted, *more)}, []
    for trial in range(given.trials):
        rng = numpy.random.default_rng([given.seed, trial])
        if given.rolls:
            loop = roll_loop(rng)
            values, true = fit.roll_loop(roll_log(loop, rng), 15.0), truth({"roll_loop": loop})
        else:
            keys, delay = aircraft(rng)
            log = fly(keys, delay, rng, given.gusts, not given.without_accelerometers)
            values = fit.estimate(log, fit.Known(keys["mass"], keys["wing_area"], cruise=keys["cruise"]))
            true = truth(keys, delay)
        for name in errors:
            errors[name].append(error(name, values[name].value, true[name]))
        covered.append([abs(values[name].value - true[name]) <= values[name].half for name in errors])
        if given.fields:
            past += past_obstacles(keys, delay, values, given.obstacles, rng.integers(1 << 30, size=given.fields))
        print(trial, {n: (round(values[n].value, 3), round(true[n], 3)) for n in errors}, file=sys.stderr)
    print("parameter              within   of         median error  90 % error  in interval")
    for k, (name, found) in enumerate(errors.items()):
        most = wanted.get(name)
        share = f"{numpy.mean(numpy.array(found) <= most):7.0%}   {most:<8}" if most else f"{'-':>7}   {'':8}"
        most, inside = numpy.percentile(found, 90), numpy.mean(covered, axis=0)[k]
        print(f"{name:22} {share}   {numpy.median(found):10.4f}  {most:10.4f}  {inside:9.0%}")
    every = [all(errors[n][k] <= w for n, w in wanted.items()) for k in range(given.trials)]
    print(f"all                    {sum(every)} of {len(every)}")
    if flights := given.trials * given.fields:
        for name, count in zip(("true", "fitted"), past, strict=False):
            low, high = mppflight.wilson(int(count), flights)
            print(f"{name:7} file told: {count} of {flights} survive, {count / flights:.2%} ({low:.2%} to {high:.2%})")
        print(f"survive with only one of the files: {past[0] - past[2]} true, {past[1] - past[2]} fitted")


if __name__ == "__main__":
    main()
