"""A vehicle to test against: the simulation, held at its start until it is armed."""

import os
import socket
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
BINARY = Path(os.environ.get("SIL_HARNESS", ROOT / "target" / "release" / "sil-harness"))


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Simulation:
    """A running flight; `address` is where it sends to."""

    def __init__(self, out, *arguments, port=None):
        self.port = port or free_port()
        self.address = f"udpin:127.0.0.1:{self.port}"
        self.process = subprocess.Popen(
            [BINARY, "fly", "--mavlink", f"udp:127.0.0.1:{self.port}", "--json", "--out", out, *arguments],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )

    def result(self, timeout=60):
        """Exit code and what was printed, when the flight has ended by itself."""
        out, err = self.process.communicate(timeout=timeout)
        return self.process.returncode, out, err

    def stop(self):
        if self.process.poll() is None:
            self.process.kill()
        self.process.communicate()


@pytest.fixture
def simulate(tmp_path):
    if not BINARY.exists():
        pytest.fail(f"no {BINARY}: cargo build --release -p sil-harness")
    running = []

    def start(*arguments, port=None):
        running.append(Simulation(tmp_path / "out", *arguments, port=port))
        return running[-1]

    yield start
    for simulation in running:
        simulation.stop()
