"""Flies an aircraft of JSBSim past circles, its longitudinal motion by our core over the link:
`python3 fly.py NAME --obstacles 40 --flights 50 --core PATH/TO/sil-harness`."""

import argparse
import hashlib
import json
import math
import multiprocessing
import random
import struct
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
from plane import AIRCRAFT, ALTITUDE, TICK, Plane

sys.path.insert(0, str(Path(__file__).parents[1] / "link"))
from client import STRUCTS, Core, read, sweep  # noqa: E402  it stands in another folder

FOLDER = Path(__file__).parent / "aircraft"
GRAVITY = 9.80665
NAVIGATION = {  # period and delay [ticks], white and wandering error [m], as mpp-sim/src/navigation.rs has them
    "ideal": (1, 0, 0.0, 0.0), "rtk": (10, 5, 0.02, 0.05)}
WANDER_TIME = 30.0  # s
AIRSPEED_SIGMA, PITCH_SIGMA = 0.5, math.radians(0.25)  # m/s, rad
RANGE_SIGMA = 0.01  # share of the range
ORACLE_REPLAN_HZ = 10  # plans in a second of the reference aircraft, as mpp-sim/src/scenario/mod.rs has it
PITCH_LIMIT, PATH_LIMIT = math.radians(60), math.radians(45)
PLAN_REPORT, STEP_REPORT, REJECTION = 8, 7, 9
OUTCOMES = ("adopted", "least violating", "kept previous", "trim hold", "pursuit", "reserve",
            "latest")
STRUCTS["StepReport"] = [("tick", "v")] + [(name, "d") for name in """airspeed pitch pitch_rate path x z wind_x wind_z
    lift x_wanted z_wanted airspeed_wanted pitch_wanted pitch_rate_wanted path_wanted""".split()]
STRUCTS["PlanReport"] = [("scan", "v"), ("used_from", "v"), ("outcome", "B")]


def configuration(name: str) -> dict:
    """The part of the configuration that describes the aircraft, from its file."""
    file = tomllib.loads((FOLDER / f"{name}.toml").read_text())
    lift, drag, moment, elevator, thrust = (file[key] for key in ("lift", "drag", "moment", "elevator", "thrust"))
    time = file["chord"] / (2 * file["cruise"])
    known = {
        "mass": file["mass"], "pitch_inertia": file["pitch_inertia"], "wing_area": file["wing_area"],
        "moment_length": file["chord"], "air_density": file["air_density"], "lift_zero": lift["zero"],
        "lift_alpha": lift["alpha"], "lift_alpha_rate": lift["alpha_rate"] * time,
        "lift_pitch_rate": lift["pitch_rate"] * time, "lift_elevator": elevator["lift"], "drag_zero": drag["zero"],
        "drag_induced": drag["induced"], "moment_zero": moment["zero"], "moment_alpha": moment["alpha"],
        "moment_alpha_rate": moment["alpha_rate"] * time, "moment_pitch_rate": moment["pitch_rate"] * time,
        "moment_elevator": elevator["moment"], "cruise": file["cruise"], "body_radius": file["body_radius"]}
    alpha, trim = level_flight(known)
    return known | {
        "stall": lift["stall"] - alpha if "stall" in lift else None, "thrust_max": thrust["max"],
        "thrust_lag": thrust["lag"], "elevator_below": trim - elevator["min"], "elevator_above": elevator["max"] - trim}


def level_flight(a: dict) -> tuple[float, float]:
    """Angle of attack and elevator of level flight [rad]."""
    force = 0.5 * a["air_density"] * a["cruise"] ** 2 * a["wing_area"]
    alpha = elevator = thrust = 0.0
    for _ in range(100):
        lift = (a["mass"] * GRAVITY - thrust * math.sin(alpha)) / force
        alpha = (lift - a["lift_zero"] - a["lift_elevator"] * elevator) / a["lift_alpha"]
        elevator = -(a["moment_zero"] + a["moment_alpha"] * alpha) / a["moment_elevator"]
        thrust = force * (a["drag_zero"] + a["drag_induced"] * lift**2) / math.cos(alpha)
    return alpha, elevator


class Throttle:
    """The throttle that gives a thrust at an airspeed, in the steady state."""

    def __init__(self, name: str):
        table = json.loads((FOLDER / f"{name}-thrust.json").read_text())
        self.airspeeds, self.throttles, self.thrust = (
            np.array(table[key]) for key in ("airspeeds", "throttles", "thrust"))

    def of(self, thrust: float, airspeed: float) -> float:
        at = [float(np.interp(airspeed, self.airspeeds, column)) for column in self.thrust.T]
        # Beneath the thrust of idling the propeller brakes more with more throttle: a greater number counts.
        return float(np.interp(thrust, np.maximum.accumulate(at), self.throttles))


class Navigation:
    """Positions with a rate, a delay and errors."""

    def __init__(self, source: str, draw: random.Random):
        self.period, self.delay, self.sigma, self.size = NAVIGATION[source]
        self.draw, self.under_way = draw, []
        self.wander = [draw.gauss(0.0, self.size), draw.gauss(0.0, self.size)]

    def measure(self, tick: int, x: float, z: float) -> dict | None:
        if tick % self.period == 0:
            kept = math.exp(-self.period * TICK / WANDER_TIME)
            fresh = self.size * math.sqrt(1 - kept * kept)
            self.wander = [kept * error + self.draw.gauss(0.0, fresh) for error in self.wander]
            x, z = (value + error + self.draw.gauss(0.0, self.sigma) for value, error in zip((x, z), self.wander))
            self.under_way.append({"tick": tick, "x": x, "z": z, "sigma": self.sigma})
        arrived = self.under_way and self.under_way[0]["tick"] + self.delay <= tick
        return self.under_way.pop(0) if arrived else None


class Wind:
    """A steady wind, and turbulence by Dryden's spectra at 50 m, as mpp-sim/src/faults/gusts.rs has them."""

    def __init__(self, steady: float, intensity: float, draw: random.Random):
        factor = 0.177 + 0.000823 * 50 / 0.3048
        self.steady, self.intensity, self.draw = steady, intensity, draw
        self.along, self.length = intensity / factor**0.4, 50 / factor**1.2
        # Motion along, and two lags in a row of the vertical motion, each of unit variance.
        self.ahead, self.first, self.second = (draw.gauss(0, 1) for _ in range(3))
        self.second = 0.5 * (self.first + self.second)

    def next(self, airspeed: float) -> tuple[float, float]:
        """Motion of the air ahead and up in the next tick [m/s]."""
        kept = math.exp(-TICK * airspeed / self.length)
        self.ahead = kept * self.ahead + math.sqrt(1 - kept * kept) * self.draw.gauss(0, 1)
        kept = math.exp(-TICK * airspeed / 50)
        before = self.first
        self.first = kept * before + math.sqrt(1 - kept * kept) * self.draw.gauss(0, 1)
        self.second = kept * self.second + (1 - kept) * 0.5 * (before + self.first)
        up = (math.sqrt(3) * self.first + (1 - math.sqrt(3)) * self.second) / math.sqrt(2)
        return self.steady + self.along * self.ahead, self.intensity * up


@dataclass
class Flight:
    """The result of a flight. Lengths in metres; `scale` is the unit of length."""

    name: str
    seed: int
    obstacles: int
    end: str = "survived"
    strict: bool = True
    time: float = 0.0
    scale: float = 1.0
    clearance: float = math.inf
    height: float = 0.0
    off_plan: float = 0.0
    slowest: float = math.inf
    fastest: float = 0.0
    alpha: float = 0.0
    full_thrust: float = 0.0
    last_plan: str = ""
    rejected: int = 0
    commands: str = ""


class Notes:
    """What the core says beside its commands."""

    def __init__(self, flight: Flight):
        self.flight, self.step = flight, None

    def hear(self, number: int, payload: bytes):
        if number == STEP_REPORT:
            self.step = read("StepReport", payload)[0]
        elif number == PLAN_REPORT:
            self.flight.last_plan = OUTCOMES[read("PlanReport", payload)[0]["outcome"]]
        elif number == REJECTION:
            self.flight.rejected += 1


def field(seed: int, obstacles: int, scale: float) -> list[tuple[float, float, float]]:
    """The paper's random field: circles of 1 m from 25 m to 240 m, within 10 m of the altitude, all scaled."""
    draw = random.Random(f"{seed} field")
    gap = 215 / max(obstacles - 1, 1)
    return [(scale * (25 + gap * n), ALTITUDE + scale * draw.uniform(-10, 10), scale) for n in range(obstacles)]


def fly(address: str, args: argparse.Namespace, seed: int) -> Flight:
    """One flight over the field."""
    plane, throttle = Plane(args.name), Throttle(args.name)
    known = configuration(args.name)
    if args.body is not None:
        known["body_radius"] = args.body
    scale, pace = (plane.cruise / 12) ** 2, plane.cruise / 12
    period = max(round(pace * 100 / (ORACLE_REPLAN_HZ if args.oracle else args.replan_hz)), 1)
    circles, reach = field(seed, args.obstacles, scale), 45 * scale
    exact = 0.0 if args.oracle else 1.0
    source = "ideal" if args.oracle else args.navigation
    noise, navigation = random.Random(f"{seed} air"), Navigation(source, random.Random(f"{seed} positions"))
    wind = Wind(args.wind, args.gusts, random.Random(f"{seed} gusts"))
    beams, hashed = random.Random(f"{seed} lidar"), hashlib.sha256()
    flight = Flight(args.name, seed, args.obstacles, scale=scale)
    notes = Notes(flight)
    plane.blow(args.wind, 0.0)
    plane.settle()
    core = Core(address, known | {
        "preset": 2, "paths": 25, "replan_period_ticks": period, "latency_ticks": 1, "slices_per_tick": 1_000_000,
        "seed": seed, "beams": 100, "range_max": reach, "altitude": ALTITUDE}, notes.hear)
    full, ticks = 0, round(2000 * pace)
    for tick in range(ticks):
        plane.blow(*wind.next(plane.airspeed))
        air = {"tick": tick, "airspeed": plane.airspeed + exact * noise.gauss(0, AIRSPEED_SIGMA),
               "pitch": plane.pitch + exact * noise.gauss(0, PITCH_SIGMA)}
        scan = None
        if tick % period == 0:
            scan = sweep(tick, plane.x, plane.z, plane.pitch, circles, reach)
            errors = [1 + beams.gauss(0, RANGE_SIGMA) for _ in scan["ranges"]]
            scan["ranges"] = [min(value * error, 0.999 * reach) for value, error in zip(scan["ranges"], errors)]
        position = navigation.measure(tick, plane.x, plane.z)
        command = core.tick({"tick": tick, "air": air, "position": position}, scan)
        hashed.update(struct.pack("<dd", command["thrust"], command["elevator"]))
        full += command["thrust"] > 0.98 * known["thrust_max"]
        plane.step(throttle.of(command["thrust"], plane.airspeed), command["elevator"])
        if judge(flight, plane, circles, known["body_radius"], command["mode"] and notes.step):
            break
    flight.time, flight.full_thrust = (tick + 1) * TICK, full / (tick + 1)
    flight.strict = flight.end == "survived" and flight.height <= 11 * scale
    flight.commands = hashed.hexdigest()[:16]
    core.socket.close()
    return flight


def judge(flight: Flight, plane: Plane, circles: list, body: float, step: dict | None) -> bool:
    """Notes the extremes of a flight. Returns whether it has failed."""
    near = [math.hypot(plane.x - x, plane.z - z) - radius for x, z, radius in circles
            if abs(plane.x - x) < 5 * flight.scale]
    flight.clearance = min([flight.clearance, *(distance - body for distance in near)])
    flight.height = max(flight.height, abs(plane.z - ALTITUDE))
    flight.slowest = min(flight.slowest, plane.airspeed / plane.cruise)
    flight.fastest = max(flight.fastest, plane.airspeed / plane.cruise)
    flight.alpha = max(flight.alpha, plane.alpha)
    if step:
        flight.off_plan = max(flight.off_plan, abs(plane.z - step["z_wanted"]))
    if flight.clearance < 0:
        flight.end = "collision"
    elif abs(plane.pitch) > PITCH_LIMIT or abs(plane.path) > PATH_LIMIT:
        flight.end = "attitude"
    return flight.end != "survived"


def wilson(successes: int, flights: int) -> tuple[float, float]:
    """The 95 % interval of a share."""
    z, share = 1.959964, successes / flights
    middle, half = share + z * z / (2 * flights), z * math.sqrt(share * (1 - share) / flights + (z / flights / 2) ** 2)
    return (middle - half) / (1 + z * z / flights), (middle + half) / (1 + z * z / flights)


def serve(args: argparse.Namespace, known_field: str | None = None) -> tuple[subprocess.Popen, str]:
    """Starts a core on a free port, or the oracle of a field file."""
    advice = ["--oracle", known_field] if known_field else []
    process = subprocess.Popen([args.core, "core", "--listen", "127.0.0.1:0", *advice], stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, text=True)
    return process, process.stdout.readline().split("tcp:")[-1].strip()


def share_of(job: tuple) -> list[Flight]:
    """The flights of one process, with a core of their own."""
    args, seeds = job
    if args.oracle:
        return [informed(args, seed) for seed in seeds]
    return served(args, seeds)


def served(args: argparse.Namespace, seeds: Sequence[int], known_field: str | None = None) -> list[Flight]:
    """Flights with one process of the core."""
    process, address = serve(args, known_field)
    try:
        return [fly(address, args, seed) for seed in seeds]
    finally:
        process.kill()
        process.wait()


def informed(args: argparse.Namespace, seed: int) -> Flight:
    """The flight of a core whose planner knows the field. It gets exact measurements."""
    circles = field(seed, args.obstacles, (AIRCRAFT[args.name][0] / 12) ** 2)
    with tempfile.NamedTemporaryFile("w", suffix=".toml") as file:
        file.writelines(f"[[circle]]\nx = {x!r}\nz = {z!r}\nradius = {radius!r}\n" for x, z, radius in circles)
        file.flush()
        return served(args, [seed], file.name)[0]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("name", help="c172p, J3Cub or pa28")
    parser.add_argument("--obstacles", type=int, default=40, help="number of circles over 215 m, scaled")
    parser.add_argument("--flights", type=int, default=1)
    parser.add_argument("--seed", type=int, default=1, help="seed of the first flight")
    parser.add_argument("--replan-hz", type=float, default=4.0, help="plans in a second of the reference aircraft")
    parser.add_argument("--navigation", choices=NAVIGATION, default="rtk")
    parser.add_argument("--oracle", action="store_true", help="the core knows the field and measures exactly")
    parser.add_argument("--wind", type=float, default=0.0, help="tailwind [m/s]")
    parser.add_argument("--gusts", type=float, default=0.0, help="vertical intensity of Dryden's turbulence [m/s]")
    parser.add_argument("--body", type=float, help="body radius [m]; by default that of the aircraft's file")
    parser.add_argument("--core", default="sil-harness", help="the program that serves the core")
    parser.add_argument("--jobs", type=int, default=1, help="flights at a time")
    parser.add_argument("--rows", type=Path, help="file for one line of JSON a flight")
    args = parser.parse_args()
    seeds = range(args.seed, args.seed + args.flights)
    with multiprocessing.Pool(args.jobs) as pool:
        shares = pool.map(share_of, [(args, seeds[job::args.jobs]) for job in range(args.jobs)])
    flights = sorted((flight for share in shares for flight in share), key=lambda flight: flight.seed)
    if args.rows:
        args.rows.write_text("".join(json.dumps(asdict(flight)) + "\n" for flight in flights))
    for flight in flights:
        if not flight.strict:
            print(f"seed {flight.seed}: {flight.end} after {flight.time:.1f} s, {asdict(flight)}")
    strict = sum(flight.strict for flight in flights)
    whole = sum(flight.end == "survived" for flight in flights)
    low, high = (100 * bound for bound in wilson(strict, len(flights)))
    commands = hashlib.sha256("".join(flight.commands for flight in flights).encode()).hexdigest()[:16]
    print(f"{args.name} past {args.obstacles}: {strict} of {len(flights)} within the band [{low:.1f}, {high:.1f}] %, "
          f"{whole} without a touch, commands {commands}")


if __name__ == "__main__":
    main()
