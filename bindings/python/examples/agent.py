"""An agent that has learned to fly in the plane, beside the baselines of the benchmark (docs/validation/benchmark.md).

    python agent.py                     # flies the 300 fields of the benchmark
    python agent.py --train 12000000    # learns anew in other fields: pip install stable-baselines3

It moves elevator and thrust ten times a second, and sees the last scan and the measurements. All is in the aircraft's
own units, so one network (agent.npz) flies all three. It has no model, no map and no memory but its last action
and measurements.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import gymnasium
import mppflight
import mppflight.environments
import numpy
from mppflight import benchmark
from numpy.typing import NDArray

Array = NDArray[Any]

WEIGHTS = Path(__file__).with_suffix(".npz")
# Beams that the agent sees: the nearest return of each four.
SECTORS = 25
# Sight, altitude, half the band [m], and the cruise [m/s] of a world of scale 1.
SIGHT, ALTITUDE, BAND, CRUISE = 45.0, 50.0, 10.0, 12.0
# Share of the range of its actions that it moves about trim.
REACH = 0.5
# Flights of each cell that learn side by side, and seeds far from those of the benchmark.
SIDE_BY_SIDE, FIRST_SEED = 8, 10**9


class Flights:
    """Flights of one cell of the benchmark side by side, as the agent sees them."""

    def __init__(self, aircraft: str, obstacles: int, count: int) -> None:
        known = mppflight.Aircraft(aircraft)
        self.count, self.scale, trim = count, known.world_scale, known.trim
        self.speed, self.pitch = trim["airspeed"], trim["pitch"]
        # A tenth of a second, in ticks and in the aircraft's own time.
        self.hold = round(10.0 * self.speed / CRUISE)
        self.kind = numpy.eye(len(benchmark.AIRCRAFT))[[benchmark.AIRCRAFT.index(aircraft)] * count]
        keys: dict[str, Any] = {"aircraft": aircraft, "obstacles": obstacles, "world_scale": self.scale}
        self.env = mppflight.environments.ControlVectorEnv(count, **keys)
        low, high = numpy.transpose(mppflight.environments.ControlEnv(**keys).controls)
        self.level = 2.0 * (numpy.array([trim["elevator"], trim["thrust"]]) - low) / (high - low) - 1.0

    def reset(self, seed: int | list[int | None]) -> Array:
        """Begins with these seeds, or with numbers from a first one on."""
        self.action = numpy.zeros((self.count, 2))
        seen = self.env.reset(seed=seed)[0]
        self.before = self._measured(seen)
        return self._look(seen)

    def step(self, action: Array) -> tuple[Array, Array, Array, Array]:
        """Holds an action, and gives observations, rewards, and which flights failed or came to their end."""
        self.action = numpy.clip(action, -1.0, 1.0)
        asked = numpy.clip(self.level + REACH * self.action, -1.0, 1.0)
        rewards = numpy.zeros(self.count)
        failed, ended = numpy.zeros((2, self.count), bool)
        for _ in range(self.hold):
            seen, gained, fails, ends, _ = self.env.step(asked)
            # A flight that is over begins anew at once: the rest of the action is not its own.
            under_way = ~(failed | ended)
            rewards += gained * under_way
            failed, ended = failed | fails & under_way, ended | ends & under_way
        return self._look(seen, failed | ended), rewards, failed, ended

    def _measured(self, seen: dict[str, Array]) -> tuple[Array, Array]:
        airspeed, pitch = seen["air"].T
        air = 4.0 * numpy.column_stack([airspeed / self.speed - 1.0, pitch - self.pitch])
        return air, seen["position"][:, 1:]

    def _look(self, seen: dict[str, Array], fresh: Array | bool = False) -> Array:
        ranges = seen["lidar"].reshape(self.count, SECTORS, -1).min(axis=2) / (SIGHT * self.scale)
        air, height = now = self._measured(seen)
        turned, climbed = air - self.before[0], height - self.before[1]
        # A flight that begins has no past.
        turned[fresh], climbed[fresh] = 0.0, 0.0
        self.before = now
        level = (height - ALTITUDE) / (BAND * self.scale)
        climb = 4.0 * climbed / (0.1 * CRUISE * self.scale)
        parts = [0.1 / (0.05 + ranges), ranges, air, 5.0 * turned, level, climb, self.action, self.kind]
        return numpy.hstack(parts).astype(numpy.float32)


def action(weights: dict[str, Array], seen: Array) -> Array:
    """What the network does: the mean of the learned policy."""
    for layer in ("0", "1"):
        seen = numpy.tanh(seen @ weights["w" + layer].T + weights["b" + layer])
    return seen @ weights["w2"].T + weights["b2"]


def flown(weights: dict[str, Array], entries: list[benchmark.Entry]) -> int:
    """How many fields of one cell the agent flies strictly."""
    flights = Flights(entries[0].aircraft, entries[0].obstacles, len(entries))
    seen = flights.reset([entry.seed for entry in entries])
    passed, over = numpy.zeros((2, len(entries)), bool)
    while not over.all():
        seen, _, failed, ended = flights.step(action(weights, seen))
        passed, over = passed | ended & ~over, over | ended | failed
    return int(passed.sum())


def train(steps: int) -> dict[str, Any]:
    """Learns by proximal policy optimisation (Schulman and others, 2017), in all cells of the benchmark at once."""
    import torch  # type: ignore[import-not-found, unused-ignore]
    from stable_baselines3 import PPO  # type: ignore[import-not-found, unused-ignore]
    from stable_baselines3.common.vec_env import VecEnv, VecMonitor  # type: ignore[import-not-found, unused-ignore]

    class Cells(VecEnv):  # type: ignore[misc]
        """All cells as one environment of Stable-Baselines3."""

        def __init__(self) -> None:
            self.cells = [Flights(a, n, SIDE_BY_SIDE) for a in benchmark.AIRCRAFT for n in benchmark.OBSTACLES]
            seen = self.reset()
            sights = gymnasium.spaces.Box(-numpy.inf, numpy.inf, seen.shape[1:])
            super().__init__(len(seen), sights, gymnasium.spaces.Box(-1.0, 1.0, (2,)))

        def reset(self) -> Array:
            return numpy.vstack([cell.reset(FIRST_SEED + 1000 * at) for at, cell in enumerate(self.cells)])

        def step_async(self, actions: Array) -> None:
            self.actions = numpy.split(actions, len(self.cells))

        def step_wait(self) -> tuple[Array, Array, Array, list[dict[str, Any]]]:
            steps = [cell.step(actions) for cell, actions in zip(self.cells, self.actions)]
            seen, rewards, failed, ended = (numpy.concatenate(parts) for parts in zip(*steps))
            return seen, rewards, failed | ended, [{} for _ in rewards]

        def close(self) -> None: ...

        def seed(self, seed: int | None = None) -> list[None]:
            return [None] * self.num_envs

        def get_attr(self, name: str, indices: Any = None) -> list[Any]:
            return [getattr(self, name, None)] * self.num_envs

        def set_attr(self, name: str, value: Any, indices: Any = None) -> None: ...

        def env_method(self, name: str, *given: Any, indices: Any = None, **named: Any) -> list[Any]:
            return []

        def env_is_wrapped(self, wrapper: Any, indices: Any = None) -> list[bool]:
            return [False] * self.num_envs

    torch.set_num_threads(1)
    model = PPO(
        "MlpPolicy", VecMonitor(Cells()), seed=1, device="cpu", verbose=1, n_steps=128, batch_size=3840, n_epochs=6,
        learning_rate=lambda left: 5e-4 * left, policy_kwargs={"net_arch": [64, 64], "log_std_init": -1.0},
    )  # fmt: skip
    model.learn(steps, log_interval=20)
    network = model.policy.mlp_extractor.policy_net
    layers = enumerate([network[0], network[2], model.policy.action_net])
    arrays = {name + str(at): one for at, layer in layers for name, one in (("w", layer.weight), ("b", layer.bias))}
    return {name: one.detach().numpy() for name, one in arrays.items()}


def main() -> None:
    """Flies the benchmark, and learns first if it is told to."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--train", type=int, metavar="STEPS", help="learn for so many steps first, and write agent.npz")
    steps = parser.parse_args().train
    if steps:
        numpy.savez(WEIGHTS, **train(steps))
    weights, entries, passed = dict(numpy.load(WEIGHTS)), benchmark.fields(), 0
    for aircraft in benchmark.AIRCRAFT:
        cells = [[it for it in entries if (it.aircraft, it.obstacles) == (aircraft, n)] for n in benchmark.OBSTACLES]
        counts = [flown(weights, cell) for cell in cells]
        passed += sum(counts)
        print(aircraft, *counts)
    low, high = mppflight.wilson(passed, len(entries))
    print(f"{passed} of {len(entries)}: {100 * passed / len(entries):.1f} % [{100 * low:.1f}, {100 * high:.1f}]")


if __name__ == "__main__":
    main()
