"""Prints steps a second of the environments on one core, without rendering: `python -m mppflight.speed`. With `--dask` it
prints flights a second of a campaign on threads, and on one and two workers of a local Dask cluster.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from time import perf_counter, process_time
from typing import Any

import gymnasium
import numpy

from . import environments  # noqa: F401  (registers them)
from .campaigns import campaign

# Time of each measurement [s of the processor].
DURATION = 2.0
FLIGHTS = 64
# Flights of a campaign that is timed.
TRIALS = 600


def _rate(step: Callable[[], int]) -> float:
    """Steps a second of processor time."""
    step()
    done, start = 0, process_time()
    while process_time() < start + DURATION:
        done += step()
    return done / (process_time() - start)


def control(count: int) -> float:
    """Rate of `mpp/Control-v0`, `count` flights side by side, at random actions about the middle."""
    env = gymnasium.make_vec("mpp/Control-v0", num_envs=count)
    env.reset(seed=0)
    actions = numpy.random.default_rng(0).uniform(-0.1, 0.1, (100, count, 2))

    def step() -> int:
        for action in actions:
            env.step(action)
        return count * len(actions)

    return _rate(step)


def single(name: str) -> float:
    """Rate of one environment as `gymnasium.make` gives it."""
    env = gymnasium.make(name)
    env.reset(seed=0)
    # Drawing an action takes longer than flying it.
    drawn = numpy.random.default_rng(0).uniform(-0.1, 0.1, (1000, 2))
    actions = [0] * 20 if name == "mpp/Choice-v0" else list(drawn)

    def step() -> int:
        for action in actions:
            _, _, failed, ended, _ = env.step(action)
            if failed or ended:
                env.reset()
        return len(actions)

    return _rate(step)


def flights(**how: Any) -> float:
    """Flights a second of wall time past 20 obstacles."""
    campaign(trials=20, **how)
    start = perf_counter()
    campaign(trials=TRIALS, seed=100, **how)
    return TRIALS / (perf_counter() - start)


def cluster() -> None:
    """Prints the table of campaigns."""
    from distributed import Client, LocalCluster

    print("campaign                          flights a second")
    for count in (1, 2):
        print(f"{count} threads of one process           {flights(workers=count):>12,.0f}")
    for count in (1, 2):
        with (
            LocalCluster(  # type: ignore[no-untyped-call]
                n_workers=count, threads_per_worker=1, dashboard_address=":0"
            ) as local,
            Client(local) as client,  # type: ignore[no-untyped-call]
        ):
            print(f"{count} workers of Dask                  {flights(client=client):>12,.0f}")


def main() -> None:
    """Prints the tables that were asked for."""
    if "--dask" in sys.argv[1:]:
        cluster()
        return
    print("environment                       steps a second and core")
    print(f"mpp/Control-v0, {FLIGHTS} side by side   {control(FLIGHTS):>12,.0f}")
    print(f"mpp/Control-v0, alone             {single('mpp/Control-v0'):>12,.0f}")
    print(f"mpp/Choice-v0, alone              {single('mpp/Choice-v0'):>12,.0f}")


if __name__ == "__main__":
    main()
