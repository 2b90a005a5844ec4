"""Reads MAVLink tlogs, DataFlash logs and ULogs into the columns of `fit.py`. Every value keeps the time of its message, in
seconds since the start of the autopilot.
"""

from __future__ import annotations

import contextlib
import importlib
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy
from numpy.typing import NDArray

from .errors import InputError

Floats = NDArray[numpy.float64]
# Times and fields of a message.
Message = tuple[Floats, dict[str, Floats]]

DEGREE = numpy.pi / 180
MILLI_G = 9.80665e-3
SEA_LEVEL = 1.225
# Values of one column that come within this time [s] become one, their mean. Fewer values than this count as none.
TOGETHER, FEWEST = 0.01, 50


@dataclass(frozen=True)
class Source:
    """A message, its fields, and the column by air density and fields."""

    message: str
    fields: tuple[str, ...]
    value: Callable[..., Floats]


def _times(factor: float, message: str, field: str) -> Source:
    return Source(message, (field,), lambda density, it: factor * it)


def _equivalent(message: str, field: str) -> Source:
    """True airspeed by the equivalent one."""
    return Source(message, (field,), lambda density, it: it * (SEA_LEVEL / density) ** 0.5)


def _turned(message: str, field: str, bank: bool = False) -> Source:
    """Pitch, or bank, by the rotation from forward, right, down to north, east, down."""
    names = tuple(f"{field}[{k}]" for k in range(4))
    if bank:
        return Source(message, names, lambda density, w, x, y, z: numpy.arctan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)))
    return Source(message, names, lambda density, w, x, y, z: numpy.arcsin((2 * (w * y - z * x)).clip(-1, 1)))


def _tlog(path: str, names: set[str]) -> dict[str, Message]:
    """What came since the last start of the autopilot. A message without a time of its own has that of its reception, less
    the median delay of the others."""
    log = importlib.import_module("pymavlink.mavutil").mavmmaplog(path)
    sender, newest = None, 0.0
    rows: dict[str, list[tuple[float, float, dict[str, Any]]]] = {}
    while (message := log.recv_match(type=names)) is not None:
        name, fields, source = message.get_type(), message.to_dict(), (message.get_srcSystem(), message.get_srcComponent())
        # Its other parts, other aircraft and the ground may be in the log, too.
        sender = source if sender is None and name == "ATTITUDE" else sender
        if source != sender:
            continue
        if name == "ATTITUDE":
            if fields["time_boot_ms"] / 1e3 < newest - 1.0:
                rows.clear()
            newest = fields["time_boot_ms"] / 1e3
        own = fields.get("time_boot_ms", fields.get("time_usec", numpy.nan) / 1e3) / 1e3
        # Some count from 1970.
        rows.setdefault(name, []).append((message._timestamp, own if own < 1e8 else numpy.nan, _flat(fields)))
    log.close()
    late = float(numpy.median([came - own for it in rows.values() for came, own, _ in it if own == own] or [0.0]))
    return {
        name: _arrays([(own if own == own else came - late, fields) for came, own, fields in it]) for name, it in rows.items()
    }


def _flat(fields: dict[str, Any]) -> dict[str, Any]:
    """Numbers by the names that a ULog gives to those of an array."""
    lists = {f"{name}[{k}]": it for name, them in fields.items() if isinstance(them, list) for k, it in enumerate(them)}
    return {name: it for name, it in (fields | lists).items() if isinstance(it, (int, float))}


def _arrays(rows: list[tuple[float, dict[str, Any]]]) -> Message:
    fields = {name: numpy.array([float(row[name]) for _, row in rows]) for name in rows[0][1]}
    return numpy.array([t for t, _ in rows]), fields


def _dataflash(path: str, names: set[str]) -> dict[str, Message]:
    """The messages of the first sensor or filter of each kind."""
    log = importlib.import_module("pymavlink.DFReader").DFReader_binary(path)
    rows: dict[str, list[tuple[float, dict[str, Any]]]] = {}
    while (message := log.recv_match(type=names)) is not None:
        fields = _flat(message.to_dict())
        if fields.get("I", 0) == 0 == fields.get("C", 0):
            rows.setdefault(message.get_type(), []).append((fields["TimeUS"] / 1e6, fields))
    log.close()
    return {name: _arrays(it) for name, it in rows.items()}


def _ulog(path: str, names: set[str]) -> dict[str, Message]:
    """The first instance of each topic, with the times at which it was sampled."""
    found = {}
    for it in importlib.import_module("pyulog").ULog(path, sorted(names)).data_list:
        if it.multi_id == 0:
            fields = {name: numpy.asarray(values, numpy.float64) for name, values in it.data.items()}
            found[it.name] = fields.get("timestamp_sample", fields["timestamp"]) / 1e6, fields
    return found


@dataclass(frozen=True)
class Kind:
    """A kind of log: what reads it; for each column, what brings it into the log, and its sources, the best first."""

    library: str
    read: Callable[[str, set[str]], dict[str, Message]]
    columns: dict[str, tuple[str, *tuple[Source, ...]]]


STREAM = "have it sent at 25 Hz by SET_MESSAGE_INTERVAL, or by ArduPilot's stream rate "
ATTITUDE, TUNING = "set bit 0 of LOG_BITMASK (fast attitude)", "set bit 4 of LOG_BITMASK (control tuning)"
HIGH_RATE = "set bits 0 and 4 of SDLOG_PROFILE (default, high rate)"
REPLAY = "set bits 0 and 1 of SDLOG_PROFILE (default, estimator replay)"
KINDS = {
    ".tlog": Kind("pymavlink", _tlog, {
        "pitch": (STREAM + "EXTRA1", _times(1, "ATTITUDE", "pitch")),
        "pitch_command": (
            STREAM + "EXT_STAT", _turned("ATTITUDE_TARGET", "q"), _times(DEGREE, "NAV_CONTROLLER_OUTPUT", "nav_pitch"),
        ),
        "roll": (STREAM + "EXTRA1", _times(1, "ATTITUDE", "roll")),
        "roll_command": (
            STREAM + "EXT_STAT", _turned("ATTITUDE_TARGET", "q", True), _times(DEGREE, "NAV_CONTROLLER_OUTPUT", "nav_roll"),
        ),
        "airspeed": (STREAM + "EXTRA2", _equivalent("VFR_HUD", "airspeed")),
        "throttle": (STREAM + "EXTRA2", _times(0.01, "VFR_HUD", "throttle")),
        "climb": (
            STREAM + "POSITION", _times(-1, "LOCAL_POSITION_NED", "vz"), _times(-0.01, "GLOBAL_POSITION_INT", "vz"),
            _times(1, "VFR_HUD", "climb"),
        ),
        # ArduPilot fills RAW_IMU in the units of SCALED_IMU.
        **{name: (
            "", _times(1, "HIGHRES_IMU", field), _times(MILLI_G, "SCALED_IMU", field), _times(MILLI_G, "RAW_IMU", field),
        ) for name, field in [("ax", "xacc"), ("az", "zacc")]},
    }),
    ".bin": Kind("pymavlink", _dataflash, {
        "pitch": (ATTITUDE, _times(DEGREE, "ATT", "Pitch")),
        "pitch_command": (ATTITUDE, _times(DEGREE, "ATT", "DesPitch")),
        "roll": (ATTITUDE, _times(DEGREE, "ATT", "Roll")),
        "roll_command": (ATTITUDE, _times(DEGREE, "ATT", "DesRoll")),
        "airspeed": (TUNING, Source("CTUN", ("As", "E2T"), lambda _, speed, ratio: speed * ratio), _equivalent("ARSP", "Airspeed")),
        "throttle": (TUNING, _times(0.01, "CTUN", "ThO")),
        "climb": (f"{ATTITUDE}, and AHRS_EKF_TYPE to 3", _times(-1, "XKF1", "VD"), _times(-1, "NKF1", "VD")),
        "ax": ("", _times(1, "IMU", "AccX")),
        "az": ("", _times(1, "IMU", "AccZ")),
    }),
    ".ulg": Kind("pyulog", _ulog, {
        "pitch": (HIGH_RATE, _turned("vehicle_attitude", "q")),
        "pitch_command": (HIGH_RATE, _turned("vehicle_attitude_setpoint", "q_d")),
        "roll": (HIGH_RATE, _turned("vehicle_attitude", "q", True)),
        "roll_command": (HIGH_RATE, _turned("vehicle_attitude_setpoint", "q_d", True)),
        "airspeed": (REPLAY, *(_times(1, name, "true_airspeed_m_s") for name in ("airspeed_validated", "airspeed"))),
        "throttle": (HIGH_RATE, _times(1, "vehicle_thrust_setpoint", "xyz[0]"), _times(1, "actuator_controls_0", "control[3]")),
        "climb": (HIGH_RATE, _times(-1, "vehicle_local_position", "vz")),
        **{name: (
            "", _times(1, "vehicle_acceleration", f"xyz[{k}]"), _times(1, "sensor_combined", f"accelerometer_m_s2[{k}]"),
        ) for name, k in [("ax", 0), ("az", 2)]},
    }),
}  # fmt: skip
OPTIONAL = {"ax", "az", "roll", "roll_command"}
# Least rates [Hz]: what is slower hides the loops.
RATES = dict.fromkeys(("pitch", "pitch_command", "roll", "roll_command"), 15.0)


def _column(found: dict[str, Message], sources: list[Source], density: float) -> tuple[Floats, Floats]:
    """Times and values by the first source of which the log has enough."""
    for source in sources:
        times, fields = found.get(source.message, (numpy.empty(0), {}))
        if all(name in fields for name in source.fields):
            value = source.value(density, *(fields[name] for name in source.fields))
            there = numpy.isfinite(value)
            if there.sum() >= FEWEST:
                return _together(times[there], value[there])
    return numpy.empty(0), numpy.empty(0)


def _together(times: Floats, values: Floats) -> tuple[Floats, Floats]:
    """In the order of time; times to 0.1 ms, so that messages of one time share a row."""
    _, group = numpy.unique(numpy.floor(times / TOGETHER), return_inverse=True)
    count = numpy.bincount(group)
    return (numpy.bincount(group, times) / count).round(4), numpy.bincount(group, values) / count


def _read(path: str, kind: Kind) -> dict[str, Message]:
    names = {source.message for _, *sources in kind.columns.values() for source in sources}
    # The libraries take a missing file for something else.
    Path(path).open("rb").close()
    try:
        # Their warnings are not part of an aircraft file.
        with contextlib.redirect_stdout(sys.stderr):
            return kind.read(path, names)
    except ImportError as error:
        raise InputError(f"{path}: {kind.library} reads it: pip install {kind.library}") from error
    except Exception as error:  # The libraries raise what their parsers meet.
        raise InputError(f"{path}: {kind.library} cannot read it: {error}") from error


def columns(path: str | Path, density: float, needed: tuple[str, ...] = ()) -> dict[str, Floats]:
    """The columns of a log, with a row for each time and cells that are not a number where no message came. Those that are
    `needed` must be there, beside the usual ones."""
    kind = KINDS[Path(path).suffix.lower()]
    found, series, lacking = _read(str(path), kind), {}, []
    for name, (advice, *sources) in kind.columns.items():
        times, values = _column(found, sources, density)
        rate = 1 / float(numpy.median(numpy.diff(times))) if len(times) > 1 else 0.0
        if rate > RATES.get(name, 0.0):
            series[name] = times, values
        elif name in needed or name not in OPTIONAL:
            sought = " or ".join(f"{it.message}.{it.fields[0]}" for it in sources)
            lacking.append(f"`{name}`: {f'{rate:.0f} Hz of' if rate else 'no'} {sought}: {advice}")
    if lacking:
        raise InputError("\n".join([f"{path} lacks what the fit needs:", *lacking]))
    t = numpy.unique(numpy.concatenate([times for times, _ in series.values()]))
    table = {"t": t} | {name: numpy.full(len(t), numpy.nan) for name in series}
    for name, (times, values) in series.items():
        table[name][numpy.searchsorted(t, times)] = values
    return table
