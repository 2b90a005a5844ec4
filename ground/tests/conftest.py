"""The fixture that starts flights for the tests."""

import pytest
from simulation import BINARY, Simulation


@pytest.fixture
def simulate(tmp_path):
    if not BINARY.exists():
        pytest.fail(f"no {BINARY}: cargo build --release -p sil-harness")
    running = []

    def start(*arguments, port=None, others=()):
        running.append(Simulation(tmp_path / "out", *arguments, port=port, others=others))
        return running[-1]

    yield start
    for simulation in running:
        simulation.stop()
