"""The typed stubs say what the module has."""

import subprocess
import sys
from importlib.resources import files


def test_stubs_and_module_agree():
    assert (files("mppflight") / "py.typed").is_file()
    command = [sys.executable, "-m", "mypy.stubtest", "mppflight._native"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_python_half_is_typed():
    command = [sys.executable, "-m", "mypy", "--strict", "-p", "mppflight"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
