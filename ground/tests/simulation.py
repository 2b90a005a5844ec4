"""Vehicles for the tests: the simulation, held at its start until it is armed.

The simulation flies at the pace of real time, and the tests run at their own: nothing here depends on how
long anything takes. Every wait may last a minute, and all measured times are those of the flight.
"""

import os
import socket
import subprocess
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BINARY = Path(os.environ.get("SIL_HARNESS", ROOT / "target" / "release" / "sil-harness"))
# Nothing takes longer than this, even on a slow machine.
LIMIT = 60.0
# A flight that lasts until it is ended, without obstacles.
LASTING = ("--hold", "--speed", "1", "--duration", "3600", "--obstacles", "0")


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def until(condition, what):
    """Waits until the condition holds. Returns the condition's value then."""
    deadline = time.monotonic() + LIMIT
    while not (result := condition()):
        assert time.monotonic() < deadline, f"waited {LIMIT:g} s for {what}"
        time.sleep(0.05)
    return result


def parameters(preset="flight"):
    """The parameters of a flight, from the program's own list."""
    command = [BINARY, "params", "--preset", preset]
    lines = subprocess.run(command, capture_output=True, check=True, text=True).stdout.splitlines()
    return {name: float(value) for name, value in (line.split(",") for line in lines)}


class Simulation:
    """A running flight. It sends to `address` and to `others`."""

    def __init__(self, out, *arguments, port=None, others=()):
        self.port = port or free_port()
        self.address = f"udpin:127.0.0.1:{self.port}"
        peers = ",".join(f"udp:127.0.0.1:{port}" for port in (self.port, *others))
        self.process = subprocess.Popen(
            [BINARY, "fly", "--mavlink", peers, "--json", "--out", out, *arguments],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )

    def result(self):
        """The exit code and the output of a flight that has ended by itself."""
        out, err = self.process.communicate(timeout=LIMIT)
        return self.process.returncode, out, err

    def stop(self):
        if self.process.poll() is None:
            self.process.kill()
        self.process.communicate()
