"""Flies an aircraft of its own past circles, by docs/link.md alone: `python3 client.py 127.0.0.1:5790 [SEED]`."""

import hashlib
import random
import socket
import struct
import sys
import zlib
from math import cos, hypot, radians, sin, sqrt

VERSION = 2
IDS = {"Hello": 1, "Configure": 2, "ConfigureReply": 3, "SensorFrame": 4, "LidarScan": 5, "ActuatorCommand": 6}
# Kinds: B byte, v varint, f and d floats, ? an option, * a list, and the names of structs.
STRUCTS = {name: [field.split(":") for field in fields.split()] for name, fields in {
    "Hello": "role:B major:B minor:B patch:B tick_period_us:v beams_max:v stages:v",
    "Configure": """preset:B mass:d pitch_inertia:d wing_area:d moment_length:d air_density:d lift_zero:d lift_alpha:d
        lift_alpha_rate:d lift_pitch_rate:d lift_elevator:d drag_zero:d drag_induced:d moment_zero:d moment_alpha:d
        moment_alpha_rate:d moment_pitch_rate:d moment_elevator:d cruise:d body_radius:d stall:?d
        paths:v replan_period_ticks:v latency_ticks:v slices_per_tick:v seed:v beams:v range_max:f altitude:d thrust_max:?d thrust_lag:?d
        elevator_below:?d elevator_above:?d elevator_rate:?d""",
    "ConfigureReply": "verdict:B", "SensorFrame": "tick:v air:?AirData position:?Position",
    "Position": "tick:v x:d z:d sigma:f velocity:?GroundVelocity", "GroundVelocity": "x:f z:f sigma:f",
    "LidarScan": "tick:v angle_min:f angle_increment:f ranges:*f", "AirData": "tick:v airspeed:d pitch:d",
    "ActuatorCommand": "tick:v thrust:d elevator:d mode:B",
}.items()}


def write(kind, value) -> bytes:
    """The payload of a value."""
    if kind == "v":
        return bytes([value & 127 | 128]) + write("v", value >> 7) if value > 127 else bytes([value])
    if kind[0] == "?":
        return b"\0" if value is None else b"\1" + write(kind[1:], value)
    if kind[0] == "*":
        return write("v", len(value)) + b"".join(write(kind[1:], each) for each in value)
    if kind in STRUCTS:
        assert value.keys() <= dict(STRUCTS[kind]).keys(), f"{kind} has other fields: {', '.join(dict(STRUCTS[kind]))}"
        return b"".join(write(part, value.get(name)) for name, part in STRUCTS[kind])
    return struct.pack("<" + kind, value or 0)


def read(kind, data: bytes, at: int = 0):
    """A value, and the place after it."""
    if kind == "v":
        rest, end = read("v", data, at + 1) if data[at] > 127 else (0, at + 1)
        return data[at] & 127 | rest << 7, end
    if kind[0] == "?":
        return read(kind[1:], data, at + 1) if data[at] else (None, at + 1)
    if kind in STRUCTS or kind[0] == "*":
        count, at = (0, at) if kind in STRUCTS else read("v", data, at)
        values = {}
        for name, part in STRUCTS.get(kind) or [(place, kind[1:]) for place in range(count)]:
            values[name], at = read(part, data, at)
        return (values if kind in STRUCTS else list(values.values())), at
    return struct.unpack_from("<" + kind, data, at)[0], at + struct.calcsize("<" + kind)


def frame(name: str, value: dict) -> bytes:
    """A message as it goes over the wire."""
    plain = b"MP" + bytes([VERSION, IDS[name]]) + write(name, value)
    runs = (plain + struct.pack("<I", zlib.crc32(plain))).split(b"\0")
    parts = [run[at:at + 254] for run in runs for at in range(0, len(run) + 1, 254)]
    return b"".join(bytes([len(part) + 1]) + part for part in parts) + b"\0"


def unframe(wire: bytes) -> tuple[int, bytes]:
    """Id and payload of a frame without its delimiter."""
    plain, at = b"", 0
    while at < len(wire):
        code, at = wire[at], at + wire[at]
        plain += wire[at - code + 1:at] + (b"\0" if code < 255 and at < len(wire) else b"")
    if plain[:3] != b"MP" + bytes([VERSION]) or struct.pack("<I", zlib.crc32(plain[:-4])) != plain[-4:]:
        raise ValueError(f"no frame of link version {VERSION}: {wire.hex()}")
    return plain[3], plain[4:-4]


class Core:
    """A session with a core behind TCP. `heard` gets id and payload of each message that it sends."""

    def __init__(self, address: str, configure: dict, heard=lambda number, payload: None):
        self.socket, self.heard, self.rest = socket.create_connection(address.rsplit(":", 1), 60), heard, b""
        hello = dict(role=0, major=0, minor=1, patch=0, tick_period_us=10_000, beams_max=128, stages=0)
        self.ask(b"\0" + frame("Hello", hello), "Hello")
        if verdict := self.ask(frame("Configure", configure), "ConfigureReply")["verdict"]:
            raise ValueError(f"the core refuses the configuration with verdict {verdict} of docs/link.md")

    def ask(self, frames: bytes, answer: str) -> dict:
        """Sends frames and waits for the message that answers them."""
        self.socket.sendall(frames)
        while True:
            while b"\0" not in self.rest:
                if not (more := self.socket.recv(65536)):
                    raise ConnectionError("the core closed the link")
                self.rest += more
            wire, _, self.rest = self.rest.partition(b"\0")
            number, payload = unframe(wire) if wire else (0, wire)
            self.heard(number, payload)
            if number == IDS[answer]:
                return read(answer, payload)[0]

    def tick(self, sensed: dict, scan: dict | None = None) -> dict:
        """Sends the measurements of a tick. Returns the actuator command."""
        return self.ask((frame("LidarScan", scan) if scan else b"") + frame("SensorFrame", sensed), "ActuatorCommand")


# Aircraft and session. What is absent is 0, or an option without a value.
OWN = dict(mass=3.2, pitch_inertia=0.17, wing_area=0.25, moment_length=1.0, air_density=1.225, lift_zero=0.5,
           lift_alpha=5.73, drag_zero=0.1, drag_induced=0.05, moment_zero=0.5, moment_alpha=-8.0, moment_alpha_rate=-0.46,
           moment_elevator=0.2, cruise=12.0, body_radius=0.1, preset=2, paths=25, replan_period_ticks=100,
           latency_ticks=1, slices_per_tick=1000, beams=100, range_max=45.0, altitude=50.0)


def rates(s: list, thrust: float, elevator: float) -> list:
    """Rates of x, z, airspeed, pitch, pitch rate and flight path angle."""
    force, alpha = 0.5 * 1.225 * s[2] ** 2 * 0.25, s[3] - s[5]
    lift = 0.5 + 5.73 * alpha
    turn = (force * lift + thrust * sin(alpha)) / (3.2 * s[2]) - 9.81 * cos(s[5]) / s[2]
    gain = (thrust * cos(alpha) - force * (0.1 + 0.05 * lift ** 2)) / 3.2 - 9.81 * sin(s[5])
    moment = force * (0.5 - 8.0 * alpha - 0.46 * (s[4] - turn) + 0.2 * elevator)
    return [s[2] * cos(s[5]), s[2] * sin(s[5]), gain, s[4], moment / 0.17, turn]


def sweep(tick: int, x: float, z: float, pitch: float, circles: list, reach: float) -> dict:
    """Ranges of 100 beams over 100 degrees to circles `(x, z, radius)`; 0 where nothing is within reach."""
    ranges, near = [], [(cx - x, cz - z, r) for cx, cz, r in circles if hypot(cx - x, cz - z) - r <= reach]
    for up, ahead in ((sin(a), cos(a)) for a in (pitch + radians(beam * 100 / 99 - 50) for beam in range(100))):
        hits = [dx * ahead + dz * up - sqrt(r * r - (dx * up - dz * ahead) ** 2) for dx, dz, r in near
                if abs(dx * up - dz * ahead) <= r and dx * ahead + dz * up > 0]
        ranges.append(max(min((hit for hit in hits if hit <= reach), default=0.0), 0.0))
    return dict(tick=tick, angle_min=radians(-50), angle_increment=radians(100 / 99), ranges=ranges)


def fly(address: str, seed: int) -> tuple[float, str]:
    """Flies 20 s past 20 circles. Returns the least clearance [m] and a hash of all commands."""
    draw, hashed, clearance = random.Random(seed), hashlib.sha256(), 99.0
    circles = [(25 + 215 / 19 * n, 50 + draw.uniform(-10, 10), 1.0) for n in range(20)]
    s, core = [0.0, 50.0, 12.0, 0.156, 0.0, 0.0], Core(address, OWN | dict(seed=seed))
    for tick in range(2000):
        air = dict(tick=tick, airspeed=s[2] + draw.gauss(0, 0.5), pitch=s[3] + radians(draw.gauss(0, 0.25)))
        sensors = dict(tick=tick, air=air, position=dict(tick=tick, x=s[0], z=s[1], sigma=0.0))
        command = core.tick(sensors, sweep(tick, *s[:2], s[3], circles, 45) if tick % 100 == 0 else None)
        hashed.update(struct.pack("<dd", command["thrust"], command["elevator"]))
        for _ in range(5):
            s = [value + 0.002 * rate for value, rate in zip(s, rates(s, command["thrust"], command["elevator"]))]
        clearance = min([clearance] + [hypot(s[0] - x, s[1] - z) - r - OWN["body_radius"] for x, z, r in circles])
    return clearance, hashed.hexdigest()[:16]


if __name__ == "__main__":
    print("clearance {:.3f} m, commands {}".format(*fly(sys.argv[1], int((sys.argv + [1])[2]))))
