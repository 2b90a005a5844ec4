"""Logs of autopilots, written here message by message, give the aircraft that their CSV gives."""

import math
import struct
import subprocess
import sys
import tomllib

import fit_trial
import mppflight
import numpy
import pytest
from mppflight import fit
from pymavlink.dialects.v10 import ardupilotmega as one
from pymavlink.dialects.v20 import ardupilotmega as two
from test_fit import command, fitted, save

# What an autopilot logs at 10 Hz.
SLOW = ("airspeed", "throttle", "climb")
# Density of the air at the place of the flight [kg/m^3].
DENSITY = 1.1
EQUIVALENT = math.sqrt(DENSITY / 1.225)


@pytest.fixture(scope="module")
def flown():
    """A random aircraft and its log, with sensors of two rates."""
    rng = numpy.random.default_rng([7, 0])
    keys, delay = fit_trial.aircraft(rng)
    log = fit_trial.fly(keys, delay, rng, rolls=fit_trial.roll_loop(rng))
    # To the millisecond and the per cent, as in a tlog.
    log["t"], log["throttle"] = log["t"].round(3) + 100.0, log["throttle"].round(2)
    for name in SLOW:
        log[name][numpy.arange(len(log["t"])) % 5 != 0] = numpy.nan
    return keys, log


def rows(log):
    """The rows as a dictionary each, and whether it has the slow values."""
    for row in zip(*log.values(), strict=True):
        it = dict(zip(log, map(float, row), strict=True))
        yield it, not math.isnan(it["airspeed"])


def turn(roll, pitch, yaw=2.0):
    """The rotation with this bank and pitch."""
    (sr, cr), (sp, cp), (sy, cy) = ((math.sin(angle / 2), math.cos(angle / 2)) for angle in (roll, pitch, yaw))
    return [
        cy * cp * cr + sy * sp * sr, cy * cp * sr - sy * sp * cr, cy * sp * cr + sy * cp * sr, sy * cp * cr - cy * sp * sr,
    ]  # fmt: skip


def write_tlog(path, log, dialect=two):
    """A start of the autopilot that is of no use, then the flight, with another aircraft and the ground beside it."""
    autopilot, other, ground = (dialect.MAVLink(None, *them) for them in ((1, 1), (2, 1), (255, 190)))
    with open(path, "wb") as file:

        def put(t, message, sender=autopilot):
            file.write(struct.pack(">Q", round((1.7e9 + t) * 1e6)) + message.pack(sender))

        for k in range(100):
            put(k * 0.1 - 60, dialect.MAVLink_attitude_message(300_000 + 100 * k, 0, 0.5, 0, 0, 0, 0))
        for it, slow in rows(log):
            ms = round(it["t"] * 1e3)
            put(it["t"], ground.heartbeat_encode(6, 8, 0, 0, 0), ground)
            put(it["t"], dialect.MAVLink_attitude_message(ms, 0, 0.4, 0, 0, 0, 0), other)
            # The link takes 30 ms.
            came = it["t"] + 0.03
            put(came, dialect.MAVLink_attitude_message(ms, it["roll"], it["pitch"], 0, 0, 0, 0))
            told = [math.degrees(it[name]) for name in ("roll_command", "pitch_command")]
            put(came, dialect.MAVLink_nav_controller_output_message(*told, 0, 0, 0, 0, 0, 0))
            force = [round(it[name] / 9.80665e-3) for name in ("ax", "az")]
            put(came, dialect.MAVLink_scaled_imu_message(ms, force[0], 0, force[1], 0, 0, 0, 0, 0, 0))
            if slow:
                throttle = round(100 * it["throttle"])
                put(came, dialect.MAVLink_vfr_hud_message(it["airspeed"] * EQUIVALENT, 0, 0, throttle, 0, 0))
                put(came, dialect.MAVLink_local_position_ned_message(ms, 0, 0, 0, 0, 0, -it["climb"]))


def write_old_tlog(path, log):
    write_tlog(path, log, one)


# Formats and columns of ArduPlane.
DATAFLASH = {
    "FMT": (128, "BBnNZ", "Type,Length,Name,Format,Columns"),
    "ATT": (1, "Qffffff", "TimeUS,DesRoll,Roll,DesPitch,Pitch,DesYaw,Yaw"),
    "CTUN": (2, "QccccffffBffi", "TimeUS,NavRoll,Roll,NavPitch,Pitch,ThO,RdO,ThD,As,AsT,SAs,E2T,GU"),
    "XKF1": (3, "QBccCfff", "TimeUS,C,Roll,Pitch,Yaw,VN,VE,VD"),
    "IMU": (4, "QBffffff", "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ"),
}
PACKED = {"Q": "Q", "B": "B", "f": "f", "c": "h", "C": "H", "i": "i", "n": "4s", "N": "16s", "Z": "64s"}


def write_dataflash(path, log, left_out=""):
    with open(path, "wb") as file:

        def put(name, *values):
            kind, form, _ = DATAFLASH[name]
            if name != left_out:
                packed = struct.pack("<" + "".join(PACKED[it] for it in form), *values)
                file.write(b"\xa3\x95" + bytes([kind]) + packed)

        for name, (kind, form, columns) in DATAFLASH.items():
            length = 3 + struct.calcsize("<" + "".join(PACKED[it] for it in form))
            put("FMT", kind, length, name.encode(), form.encode(), columns.encode())
        for it, slow in rows(log):
            us = round(it["t"] * 1e6)
            put("ATT", us, *(math.degrees(it[name]) for name in ("roll_command", "roll", "pitch_command", "pitch")), 0, 0)
            put("IMU", us, 0, 0, 0, 0, it["ax"], 0, it["az"])
            put("IMU", us, 1, 0, 0, 0, 5, 5, 5)
            if slow:
                speed = it["airspeed"] * EQUIVALENT
                put("CTUN", us, 0, 0, 0, 0, 100 * it["throttle"], 0, 0, speed, 0, 0, 1 / EQUIVALENT, 0)
                put("XKF1", us, 0, 0, 0, 0, 0, 0, -it["climb"])
                put("XKF1", us, 1, 0, 0, 0, 0, 0, 5)


# Topics and fields of PX4, and their form for `struct`.
ULOG = {
    "vehicle_attitude": ("uint64_t timestamp;uint64_t timestamp_sample;float[4] q;", "QQ4f"),
    "vehicle_attitude_setpoint": ("uint64_t timestamp;float[4] q_d;", "Q4f"),
    "vehicle_acceleration": ("uint64_t timestamp;uint64_t timestamp_sample;float[3] xyz;", "QQ3f"),
    "airspeed_validated": ("uint64_t timestamp;float true_airspeed_m_s;", "Qf"),
    "vehicle_thrust_setpoint": ("uint64_t timestamp;float[3] xyz;", "Q3f"),
    "vehicle_local_position": ("uint64_t timestamp;uint64_t timestamp_sample;float vz;", "QQf"),
}


def write_ulog(path, log, left_out=""):
    with open(path, "wb") as file:

        def put(kind, payload):
            file.write(struct.pack("<HB", len(payload), ord(kind)) + payload)

        def data(name, *values, second=False):
            if name != left_out:
                put("D", struct.pack("<H" + ULOG[name][1], list(ULOG).index(name) + 10 * second, *values))

        file.write(b"ULog\x01\x12\x35\x01" + struct.pack("<Q", 90_000_000))
        put("B", bytes(40))
        for name, (fields, _) in ULOG.items():
            put("F", f"{name}:{fields}".encode())
        for number, name in enumerate(ULOG):
            if name != left_out:
                put("A", struct.pack("<BH", 0, number) + name.encode())
        put("A", struct.pack("<BH", 1, 10 + list(ULOG).index("airspeed_validated")) + b"airspeed_validated")
        for it, slow in rows(log):
            us = round(it["t"] * 1e6)
            # What an estimator publishes is older than its message.
            data("vehicle_attitude", us + 4000, us, *turn(it["roll"], it["pitch"]))
            data("vehicle_attitude_setpoint", us, *turn(it["roll_command"], it["pitch_command"]))
            data("vehicle_acceleration", us + 4000, us, it["ax"], 0, it["az"])
            if slow:
                data("airspeed_validated", us, it["airspeed"])
                data("airspeed_validated", us, 5.0, second=True)
                data("vehicle_thrust_setpoint", us, it["throttle"], math.nan, 0)
                data("vehicle_local_position", us + 4000, us, -it["climb"])


WRITERS = {"log.tlog": write_tlog, "old.TLOG": write_old_tlog, "log.bin": write_dataflash, "log.ulg": write_ulog}


@pytest.fixture(scope="module")
def by_csv(flown, tmp_path_factory):
    """The columns and the values by a CSV."""
    keys, log = flown
    columns = fit.read(save(tmp_path_factory.mktemp("csv") / "log.csv", log))
    return columns, fit.estimate(columns, fit.Known(keys["mass"], keys["wing_area"], DENSITY, keys["cruise"], fit_trial.SPAN))


# Greatest differences: a tlog has accelerations in thousandths of g.
ROUGH = {"ax": 0.0051, "az": 0.0051}


@pytest.mark.parametrize("name", WRITERS)
def test_a_log_has_the_columns_of_its_csv(flown, by_csv, tmp_path, name):
    WRITERS[name](tmp_path / name, flown[1])
    read, (columns, _) = fit.read(tmp_path / name, air_density=DENSITY), by_csv
    assert set(read) == set(columns)
    for column, wanted in columns.items():
        most = ROUGH.get(column, 1e-5) if "tlog" in name.lower() else 1e-5
        numpy.testing.assert_allclose(read[column], wanted, rtol=0, atol=most, err_msg=column)


@pytest.mark.parametrize("name", ["log.tlog", "log.bin", "log.ulg"])
def test_a_log_gives_the_aircraft_of_its_csv(flown, by_csv, tmp_path, name):
    keys, log = flown
    WRITERS[name](tmp_path / name, log)
    known = fit.Known(keys["mass"], keys["wing_area"], DENSITY, keys["cruise"], fit_trial.SPAN)
    _, values = fit.aircraft(str(tmp_path / name), fit.read(tmp_path / name, air_density=DENSITY), known, "read")
    for parameter, wanted in by_csv[1].items():
        assert values[parameter].value == pytest.approx(wanted.value, abs=0.1 * wanted.half), parameter


@pytest.mark.parametrize(
    ("name", "left_out", "told"),
    [
        ("log.bin", "ATT", "`pitch`: no ATT.Pitch: set bit 0 of LOG_BITMASK"),
        ("log.bin", "CTUN", "`airspeed`: no CTUN.As or ARSP.Airspeed: set bit 4 of LOG_BITMASK"),
        ("log.ulg", "airspeed_validated", "no airspeed_validated.true_airspeed_m_s or airspeed.true.*set bits 0 and 1 of SDLOG"),
        ("log.ulg", "vehicle_attitude_setpoint", "`pitch_command`: no vehicle_attitude_setpoint"),
    ],
)
def test_a_message_that_is_missing_is_named_with_what_to_set(flown, tmp_path, name, left_out, told):
    WRITERS[name](tmp_path / name, flown[1], left_out)
    with pytest.raises(mppflight.InputError, match=told):
        fit.read(tmp_path / name)


def test_only_the_aircraft_file_goes_to_the_output(flown, tmp_path):
    keys, log = flown
    write_dataflash(tmp_path / "log.bin", log)
    # DFReader and pyulog tell of such bytes.
    with (tmp_path / "log.bin").open("ab") as file:
        file.write(bytes(100))
    text = fitted(tmp_path / "log.bin", keys)
    assert tomllib.loads(text)["mass"] == keys["mass"] and text.startswith("name")


def test_accelerations_may_be_missing(flown, tmp_path):
    write_dataflash(tmp_path / "log.bin", flown[1], "IMU")
    assert set(fit.read(tmp_path / "log.bin")) == set(flown[1]) - {"ax", "az"}


def test_a_slow_stream_is_refused(flown, tmp_path):
    write_tlog(tmp_path / "log.tlog", {name: column[::5] for name, column in flown[1].items()})
    done = command(tmp_path / "log.tlog", "--mass", 2, "--wing-area", 0.4)
    assert done.returncode == 2 and not done.stdout
    assert "`pitch`: 10 Hz of ATTITUDE.pitch: have it sent at 25 Hz" in done.stderr, done.stderr


@pytest.mark.parametrize("content", [b"", b"\xfe\x00\xff" * 100, b"t,airspeed\n0,1\n"])
@pytest.mark.parametrize("name", WRITERS)
def test_a_file_of_another_kind_is_refused(tmp_path, name, content):
    (tmp_path / name).write_bytes(content)
    with pytest.raises(mppflight.InputError, match="lacks what the fit needs|cannot read it"):
        fit.read(tmp_path / name)


@pytest.mark.parametrize(("name", "library"), [("log.tlog", "pymavlink"), ("log.bin", "pymavlink"), ("log.ulg", "pyulog")])
def test_without_its_library_it_says_what_to_install(tmp_path, name, library):
    (tmp_path / name).touch()
    code = f"import sys; sys.modules[{library!r}] = None; from mppflight import logs; logs.columns({str(tmp_path / name)!r}, 1.0)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert f"pip install {library}" in done.stderr, done.stderr


def test_a_log_that_is_not_there_is_an_error_of_the_system(tmp_path):
    for name in WRITERS:
        with pytest.raises(FileNotFoundError):
            fit.read(tmp_path / name)
