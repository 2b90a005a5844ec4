"""Campaigns on a Dask cluster: a lost worker costs time, and no row."""

import os
import signal

import mppflight
import pytest
from distributed import Client, LocalCluster

GRID = {"obstacles": [10, 30], "trials": 40, "seed": 200, "duration": 10}


@pytest.fixture(scope="module")
def rows():
    return mppflight.campaign(**GRID)


@pytest.fixture
def client():
    with (
        LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0") as cluster,
        Client(cluster) as client,
    ):
        yield client


def test_rows_are_the_same_if_a_worker_dies_in_the_middle(rows, client):
    killed = []

    def kill(done, total):
        if not killed and done >= 20:
            victim = next(iter(client.run(os.getpid).values()))
            os.kill(victim, signal.SIGKILL)
            killed.append((victim, done))

    assert mppflight.campaign(**GRID, client=client, progress=kill).lines == rows.lines
    assert killed and killed[0][1] < len(rows)


def test_ctrl_c_keeps_what_the_workers_flew(rows, client):
    def press(done, total):
        raise KeyboardInterrupt

    with pytest.raises(mppflight.Interrupted) as caught:
        mppflight.campaign(**GRID, client=client, progress=press)
    kept = caught.value.rows
    assert 0 < len(kept) < len(rows) and set(kept.lines) <= set(rows.lines)


def test_an_error_of_a_flight_comes_back(client):
    with pytest.raises(mppflight.InputError, match="duration"):
        mppflight.campaign(trials=1, duration=0, client=client)
