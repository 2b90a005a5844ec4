"""Makes an aircraft file from a flight log: `python -m mppflight.fit LOG --mass 2.0 --wing-area 0.45 --out plane.toml`.
Needs SciPy: `pip install 'mppflight[fit]'`.

LOG is a MAVLink tlog (.tlog), a DataFlash log (.bin), a ULog (.ulg), or a CSV with a header. Cells may be empty, so sensors
may have rates of their own; log the pitch and its command at 25 Hz or more, the others at 10 Hz.

    t               time [s]
    airspeed        true airspeed [m/s]
    pitch           [rad], nose-up positive
    pitch_command   pitch that the autopilot was told to hold [rad]
    throttle        throttle command, 0 to 1
    climb, or z     climb rate [m/s], or height [m]; both upwards
    ax, az          optional: accelerometers forward and down [m/s^2], az is about -9.8 in level flight
    roll            optional, for the roll loop: bank [rad], to the right positive
    roll_command    the same: bank that the autopilot was told to hold [rad]

Fly in calm air, but for the roll loop with level wings (`--manoeuvres` prints what), and give with `--from` and `--to` the
stretch in which the autopilot followed the commands. Mass, wing area, air density and span are yours to give; with `--span`
the roll loop is fitted. Stretches of 10 s with more than 11 deg of bank tell nothing but the loops.

The method is output error: the aircraft's own equations are simulated with the parameters, and least squares bring
airspeed, climb and accelerations to the measured ones, in stretches of 10 s with free initial states. Delays of airspeed,
climb and accelerations against the pitch, and biases of airspeed and accelerometers, are estimated along. In gusts the log
does not tell the bias of the airspeed: it counts as 0, and each per cent of it is two of lift and drag. A bias of the pitch
goes into `lift.zero`. The dead time of the pitch loop goes from the command to the measured pitch; half the time between rows
adds to its interval. Its frequency is constant or grows with the airspeed, whatever fits better; the file has that of cruise.
Gain and offset of the loop are estimated too, but a file has no place for them. Not estimated: dead time of the thrust,
derivatives by rates, the stall, moments.

The roll loop turns the bank that is missing into a roll rate, up to the greatest, and follows it with a lag. A limit that the
log never reaches is the greatest bank or rate of the log.

Intervals are of 95 %. They come from the Jacobian, with the covariance of each sensor's residuals multiplied by
1 + 2 (sum of their autocorrelations up to the first that is not positive), because residuals are not white.

Times of a tlog, DataFlash log or ULog count from the start of the autopilot; of a tlog with several, from the last. True
airspeed comes from the equivalent one by the air density, unless the log has it. In a tlog the delays of the link are in the
estimated ones: prefer the log on board.
"""

from __future__ import annotations

import argparse
import csv
import json
import sys
import tomllib
from pathlib import Path

import numpy

from . import logs
from ._native import Aircraft
from .errors import InputError, MppError
from .identify import MEASURED, ROLL, STRETCH, Floats, Known, Value
from .identify import estimate as in_the_plane
from .roll import roll_loop

NEEDED = ("t", "airspeed", "pitch", "pitch_command", "throttle")
# Medians in the units of this module.
USUAL = {
    "airspeed": (3, 300), "pitch": (-0.8, 0.8), "pitch_command": (-0.8, 0.8), "throttle": (0, 1), "az": (-20, -2),
    "roll": (-0.8, 0.8), "roll_command": (-0.8, 0.8),
}  # fmt: skip
# Times [s], pitch against that of level flight [deg], and throttle against that of level flight.
MANOEUVRES = [
    (seconds, pitch, throttle)
    for throttle in (1.0, 0.5, 1.5)
    for seconds, pitch in [(3, 0), (1.5, 8), (1.5, -8), (0.7, 8), (0.7, -8), (2, 0), (2, 5), (2, -5), (1, 0)]
] + [(3, 0, 1.9), (3, 0, 0.1), (2, 0, 1.9), (2, 0, 0.1), (1, 0, 1.9), (1, 0, 0.1), (6, 6, 0.7), (5, -4, 1.3)]
# Times [s] and bank [deg].
ROLLS = [
    *[(2, 0), (1, 10), (1, -10), (0.5, 10), (0.5, -10), (1.5, 0), (1.2, 20), (1.2, -20), (0.6, 20), (0.6, -20), (1.5, 0)],
    *[(seconds, bank) for seconds in (0.3, 0.5, 0.4, 0.6, 0.35) for bank in (25, -25)],
    *[(1.5, 0), (2, 70), (2, -70), (2, 70), (0.7, -30), (0.7, 30), (1, 10), (0.5, -10), (0.5, 10), (2, 0)],
]


def _csv(path: str | Path) -> dict[str, Floats]:
    """The columns of a CSV; an empty cell is not a number."""
    try:
        with open(path, newline="", encoding="utf-8-sig") as file:
            rows = list(csv.DictReader(file))
    except (UnicodeDecodeError, csv.Error) as error:
        raise InputError(f"{path}: give a CSV, or a name that ends in {', '.join(logs.KINDS)}") from error
    names = set(rows[0]) if rows else set()
    missing = [name for name in NEEDED if name not in names]
    if missing or not names & {"climb", "z"}:
        raise InputError(f"{path}: give the columns {', '.join([*missing, 'climb or z'])}; --help has names and units")
    try:
        return {
            name: numpy.array([float(row[name] or "nan") for row in rows])
            for name in (*NEEDED, *MEASURED, *ROLL)
            if name in names
        }
    except (TypeError, ValueError) as error:
        raise InputError(f"{path}: give numbers or empty cells: {error}") from error


def read(
    path: str | Path, start: float = -numpy.inf, end: float = numpy.inf, air_density: float = 1.225, roll: bool = False
) -> dict[str, Floats]:
    """The columns of a log between two times; with `roll`, those of the roll loop must be there."""
    columns = logs.columns(path, air_density, ROLL if roll else ()) if Path(path).suffix.lower() in logs.KINDS else _csv(path)
    keep = (columns["t"] >= start) & (columns["t"] <= end)
    columns = {name: column[keep] for name, column in columns.items()}
    if missing := [name for name in ROLL if roll and name not in columns]:
        raise InputError(f"{path}: give the columns {', '.join(missing)} for the roll loop, or leave out --span")
    if len(columns["t"]) < 2 or not (numpy.diff(columns["t"]) > 0).all():
        raise InputError(f"{path}: `t` must rise from row to row")
    if columns["t"][-1] - columns["t"][0] < 2 * STRETCH:
        raise InputError(f"{path}: give {2 * STRETCH:.0f} s or more, not {columns['t'][-1] - columns['t'][0]:.1f} s")
    for name, column in columns.items():
        low, high = USUAL.get(name, (0, 0))
        there = column[numpy.isfinite(column)]
        middle = float(numpy.median(there)) if len(there) else numpy.nan
        if name in USUAL and not low <= middle <= high:
            raise InputError(f"{path}: `{name}` is {middle:.3g} in the median: give {low} to {high}; --help has the units")
    return columns


def estimate(log: dict[str, Floats], known: Known) -> dict[str, Value]:
    """All parameters of a log; those of the roll loop if the span is known."""
    cruise = known.cruise or float(numpy.nanmedian(log["airspeed"]))
    found: dict[str, Value] = in_the_plane(log, known)
    return found | (roll_loop(log, cruise) if known.span else {})


def unexcited(log: dict[str, Floats], roll: bool) -> list[str]:
    """What the log cannot tell, and what to fly."""

    def width(name: str) -> float:
        low, high = numpy.nanpercentile(log[name], [2, 98])
        return float(high - low)

    told = []
    if width("throttle") < 0.05:
        told.append("thrust: the throttle never changes by more than 5 %: fly throttle steps")
    if width("pitch_command") < 0.07:
        told.append("pitch loop, lift: the commanded pitch never changes by more than 4 deg: fly doublets of 8 deg")
    if width("airspeed") < 0.1 * numpy.nanmedian(log["airspeed"]):
        told.append("lift, drag: the airspeed stays within 10 %: fly slowly and fast")
    if roll and width("roll_command") < 0.2:
        told.append("roll loop: the commanded bank never changes by more than 11 deg: fly doublets of 20 deg, or leave out --span")
    return told


# What a file cannot do without: how far an interval may reach as a share of the value (of the delay: in s), and what to fly.
ESSENTIAL = {
    "lift.alpha": (0.25, "doublets of the pitch, slow and fast flight"),
    "thrust.max": (0.25, "throttle steps"),
    "pitch_loop.frequency": (0.15, "doublets of the pitch"),
    "pitch_loop.delay": (0.03, "doublets of the pitch"),
    "roll_loop.frequency": (0.15, "doublets of the bank"),
    "roll_loop.delay": (0.03, "doublets of the bank"),
}
UNITS = {
    "thrust.max": "N", "thrust.lag": "s", "pitch_loop.frequency": "rad/s", "pitch_loop.delay": "s", "lift.alpha": "1/rad",
    "airspeed delay": "s", "climb delay": "s", "acceleration delay": "s", "airspeed bias": "m/s",
    "roll_loop.frequency": "rad/s", "roll_loop.delay": "s", "roll_loop.max_bank": "rad", "roll_loop.max_rate": "rad/s",
}  # fmt: skip


def unclear(values: dict[str, Value]) -> list[str]:
    """What the fit could not tell, and what to fly."""
    told = []
    for name, (share, advice) in ESSENTIAL.items():
        if name not in values:
            continue
        value = values[name]
        if not value.half <= share * (1.0 if name.endswith("delay") else value.value):
            told.append(f"{name}: the log does not tell it, {value.value:.3g} +- {value.half:.2g}: fly {advice}")
    for name, what, angle in (("gain", "pitch", "pitch"), ("roll gain", "roll", "bank")):
        gain = values.get(name, Value(1.0, 0.0)).value
        if abs(gain - 1) > 0.15:
            told.append(f"{what} loop: the {angle} follows {gain:.2f} of its command: tune the autopilot's {what} loop")
    return told


def _certain(value: Value) -> str:
    return "greatest of the log" if numpy.isnan(value.half) else f"+- {value.half:.2g}"


def toml(values: dict[str, Value], known: Known, cruise: float, name: str, log: str) -> str:
    """The aircraft file, each value with its interval."""
    span = " and span" if known.span else ""
    parts = [
        f"name = {json.dumps(name)}",
        f"source = {json.dumps(f'fitted to the flight log {log} by mppflight.fit; mass, wing area, air density{span} given')}",
        'derivatives = "radian"',
        f"mass = {known.mass!r}\nwing_area = {known.wing_area!r}\nair_density = {known.air_density!r}",
        f"chord = 1.0 # of no effect with a pitch loop\ncruise = {cruise:.4g}",
    ]
    for table in ("lift", "drag", "pitch_loop", "thrust", *(["roll_loop"] if known.span else [])):
        parts.append(f"\n[{table}]" + (f"\nspan = {known.span!r}" if table == "roll_loop" else ""))
        for key, value in values.items():
            if key.startswith(f"{table}."):
                parts.append(f"{key.split('.')[1]} = {value.value:.4g} # {_certain(value)}")
    return "\n".join(parts) + "\n"


def manoeuvres() -> str:
    """What to fly, as text."""
    lines = [
        "Trim in level flight at cruise speed, with level wings, in calm air, 100 m high or more. Note pitch and throttle.",
        "Let the autopilot hold the pitch. Angles add to the pitch of level flight, throttles are shares of its throttle.",
        "", "seconds  pitch, deg  throttle",
    ]  # fmt: skip
    lines += [f"{s:7.1f}  {pitch:+10.0f}  {throttle:8.1f}" for s, pitch, throttle in MANOEUVRES]
    lines += ["", "For the roll loop, then, with the pitch of level flight; 70 deg finds the autopilot's limits.", "", "seconds  bank, deg"]
    return "\n".join([*lines, *(f"{s:7.1f}  {bank:+9.0f}" for s, bank in ROLLS)])


def _arguments() -> argparse.Namespace:
    plain = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(prog="python -m mppflight.fit", description=__doc__, formatter_class=plain)
    parser.add_argument("log", nargs="?", help="tlog, DataFlash log, ULog, or CSV with the columns above")
    parser.add_argument("--mass", type=float, help="kg")
    parser.add_argument("--wing-area", type=float, help="m^2")
    parser.add_argument("--span", type=float, help="span of the wing [m]: fits the roll loop, too")
    parser.add_argument("--air-density", type=float, default=1.225, help="kg/m^3, by default 1.225")
    parser.add_argument("--cruise", type=float, help="airspeed of level flight [m/s], by default the median of the log")
    parser.add_argument("--from", dest="start", type=float, default=-numpy.inf, help="first time in use [s]")
    parser.add_argument("--to", dest="end", type=float, default=numpy.inf, help="last time in use [s]")
    parser.add_argument("--name", default="fitted", help="name of the aircraft")
    parser.add_argument("--out", help="aircraft file to write; by default it is printed")
    parser.add_argument("--manoeuvres", action="store_true", help="print what to fly, and end")
    given = parser.parse_args()
    if not given.manoeuvres and None in (given.log, given.mass, given.wing_area):
        parser.error("give LOG, --mass and --wing-area")
    return given


def aircraft(path: str, log: dict[str, Floats], known: Known, name: str) -> tuple[str, dict[str, Value]]:
    """The text of the aircraft file of a log, and all parameters."""
    given = (known.mass, known.wing_area, known.air_density, known.cruise or 1.0, 1.0 if known.span is None else known.span)
    if not all(0 < number < numpy.inf for number in given):
        raise InputError("mass, wing area, air density, cruise, span: give positive numbers")
    if told := unexcited(log, bool(known.span)):
        raise InputError("\n".join([f"{path} does not excite all that a file needs:", *told]))
    values = estimate(log, known)
    if told := unclear(values):
        raise InputError("\n".join([f"{path} does not tell all that a file needs:", *told]))
    cruise = known.cruise or float(numpy.nanmedian(log["airspeed"]))
    text = toml(values, known, cruise, name, Path(path).name)
    # It refuses what makes no sense.
    Aircraft(tomllib.loads(text))
    return text, values


def main() -> int:
    """The command."""
    given = _arguments()
    if given.manoeuvres:
        print(manoeuvres())
        return 0
    try:
        known = Known(given.mass, given.wing_area, given.air_density, given.cruise, given.span)
        log = read(given.log, given.start, given.end, given.air_density, given.span is not None)
        text, values = aircraft(given.log, log, known, given.name)
        for name, it in values.items():
            print(f"{name:22} {it.value:10.4g} {_certain(it):11} {UNITS.get(name, '')}", file=sys.stderr)
        if given.out:
            Path(given.out).write_text(text)
        else:
            print(text, end="")
    except (MppError, OSError) as error:
        print(f"fit: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
