"""Prints steps a second of the environments on one core, without rendering: `python -m mpp.speed`."""

from __future__ import annotations

import os
from collections.abc import Callable
from time import process_time

import gymnasium
import numpy

from . import environments  # noqa: F401  (registers them)

# Time of each measurement [s of the processor].
DURATION = 2.0
FLIGHTS = 64


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
    env.action_space.seed(0)
    env.reset(seed=0)

    def step() -> int:
        for _ in range(20):
            _, _, failed, ended, _ = env.step(0 if name == "mpp/Choice-v0" else env.action_space.sample())
            if failed or ended:
                env.reset()
        return 20

    return _rate(step)


def main() -> None:
    """Prints the table."""
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    print("environment                       steps a second and core")
    print(f"mpp/Control-v0, {FLIGHTS} side by side   {control(FLIGHTS):>12,.0f}")
    print(f"mpp/Control-v0, alone             {single('mpp/Control-v0'):>12,.0f}")
    print(f"mpp/Choice-v0, alone              {single('mpp/Choice-v0'):>12,.0f}")


if __name__ == "__main__":
    main()
