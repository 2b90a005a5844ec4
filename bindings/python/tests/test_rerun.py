"""The example for Rerun writes what Rerun reads."""

import subprocess
import sys

import pytest


def test_a_forest_is_written_for_rerun(root, tmp_path):
    pytest.importorskip("rerun", reason="rerun-sdk is not installed")
    example, out = root / "bindings/python/examples/rerun_forest.py", tmp_path / "forest.rrd"
    subprocess.run([sys.executable, example, "--density", "0.01", "--seed", "5", "--out", out], check=True)
    told = subprocess.run([sys.executable, "-m", "rerun", "rrd", "stats", out], check=True, capture_output=True, text=True).stdout
    for entity in ("world/aircraft", "world/trunks", "world/lidar", "world/plan", "world/candidates", "clearance", "bank/flown"):
        assert f"/{entity}:" in told
