"""A frozen benchmark: 300 fields of the paper's kind over five densities and three aircraft.

`python -m mppflight.benchmark` flies the baselines through them and prints the table of docs/validation/benchmark.md.
The list `fields-v1.json` never changes; a better one gets another number. Each field has the hash of its obstacles.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import math
from collections.abc import Callable, Iterable
from dataclasses import asdict, dataclass
from importlib.resources import files
from typing import Any

import numpy
from numpy.typing import NDArray

from ._native import Aircraft, Field, fly, wilson

VERSION = "fields-v1"
# First 16 hexadecimal digits of the SHA-256 of the list.
SHA256 = "07d3faaf7fe6d82c"

AIRCRAFT = ("reference", "zagi", "aerosonde")
OBSTACLES = (10, 20, 40, 80, 120)
SEEDS = 20
FIRST_SEED = 7_000_000

# The baselines: keys of a scenario.
BASELINES: dict[str, dict[str, Any]] = {
    "RRT* alone": {"preset": "paper", "paths": 0, "replan_hz": 1.0},
    "paper": {"preset": "paper", "paths": 25, "replan_hz": 1.0},
    "ours, 1 Hz": {"preset": "flight", "replan_hz": 1.0},
    "ours, 4 Hz": {"preset": "flight", "replan_hz": 4.0},
    "oracle": {"preset": "flight", "oracle": True},
}


@dataclass(frozen=True)
class Entry:
    """A field of the list, and how hard it is; see `difficulty`."""

    aircraft: str
    obstacles: int
    seed: int
    traversability: float
    relative_gap: float
    field_hash: str

    def scenario(self) -> dict[str, Any]:
        """The keys with which `mppflight.fly` draws the field. Its lengths are scaled to the aircraft's speed."""
        scale = Aircraft(self.aircraft).world_scale
        keys = {"aircraft": self.aircraft, "obstacles": self.obstacles, "seed": self.seed}
        return {**keys, "world_scale": scale}

    def field(self) -> Field:
        """The field."""
        return _drawn(self.aircraft, self.obstacles, self.seed)


def fields() -> list[Entry]:
    """The fields of the list, in its order."""
    text = (files("mppflight") / f"{VERSION}.json").read_bytes()
    if hashlib.sha256(text).hexdigest()[:16] != SHA256:
        raise ValueError(f"{VERSION}.json is not the list that was frozen: install the package anew")
    return [Entry(**entry) for entry in json.loads(text)]


def difficulty(field: Field, world_scale: float = 1.0) -> tuple[float, float]:
    """Traversability and relative gap, after AvoidBench, in the plane and in the aircraft's own metres, which are
    `world_scale` metres: an aircraft turns alike in its own metres whatever its speed.

    Traversability is the mean free way from free places of the band in directions within 45 deg of downrange, at most
    the range of the paper's lidar. The relative gap is the mean distance between the edges of an obstacle and of
    its nearest neighbour. The field consists of circles.
    """
    circles = field.circles
    most = 45.0 * world_scale
    angles = numpy.linspace(-math.pi / 4, math.pi / 4, 19)
    # Places spread evenly by the golden ratio, without random numbers.
    count = numpy.arange(1, 201)
    x = world_scale * (25.0 + 215.0 * (count / 201.0))
    z = 50.0 + world_scale * 10.0 * (2.0 * (count * (math.sqrt(5.0) - 1.0) / 2.0 % 1.0) - 1.0)
    free = field.clearance(numpy.column_stack([x, z])) > 0.0
    ways = [numpy.minimum(field.ranges(at, up, angles), most).mean() for at, up in zip(x[free], z[free])]
    apart = numpy.hypot(*(circles[:, None, :2] - circles[None, :, :2]).transpose(2, 0, 1))
    gaps = apart - circles[:, 2, None] - circles[None, :, 2]
    numpy.fill_diagonal(gaps, numpy.inf)
    return float(numpy.mean(ways) / world_scale), float(gaps.min(axis=1).mean() / world_scale)


def build() -> bytes:
    """The bytes of the list, made anew."""
    entries: list[Entry] = []
    for aircraft in AIRCRAFT:
        scale = Aircraft(aircraft).world_scale
        for obstacles in OBSTACLES:
            for seed in range(FIRST_SEED + len(entries), FIRST_SEED + len(entries) + SEEDS):
                field = _drawn(aircraft, obstacles, seed)
                traversability, gap = difficulty(field, scale)
                told = hashlib.sha256(field.to_toml().encode()).hexdigest()[:16]
                entry = Entry(aircraft, obstacles, seed, round(traversability, 3), round(gap, 3), told)
                entries.append(entry)
    lines = ",\n".join(json.dumps(asdict(entry)) for entry in entries)
    return f"[\n{lines}\n]\n".encode()


def _drawn(aircraft: str, obstacles: int, seed: int) -> Field:
    return Field.generate(obstacles=obstacles, seed=seed, world_scale=Aircraft(aircraft).world_scale)


def flown(entries: Iterable[Entry], keys: dict[str, Any], done: Callable[[], object]) -> list[bool]:
    """Which fields are flown strictly: to the end, without a collision, an extreme attitude, or leaving the band."""
    from concurrent.futures import ThreadPoolExecutor

    def fly_one(entry: Entry) -> bool:
        strict: bool = fly(**{**entry.scenario(), **keys}).summary["strict"]
        done()
        return strict

    with ThreadPoolExecutor() as pool:
        return list(pool.map(fly_one, entries))


def table(entries: list[Entry], baselines: dict[str, dict[str, Any]], done: Callable[[], object]) -> str:
    """The table of the baselines in Markdown, and how their failures go with the difficulty."""
    outcomes = {name: flown(entries, keys, done) for name, keys in baselines.items()}
    lines = [
        f"| aircraft | obstacles | traversability | relative gap | {' | '.join(outcomes)} |",
        "|---|---|---|---|" + "---|" * len(outcomes),
    ]
    for cell in dict.fromkeys((entry.aircraft, entry.obstacles) for entry in entries):
        own = [index for index, entry in enumerate(entries) if (entry.aircraft, entry.obstacles) == cell]
        means = [
            sum(getattr(entries[index], key) for index in own) / len(own)
            for key in ("traversability", "relative_gap")
        ]
        counts = [f"{sum(strict[index] for index in own)}" for strict in outcomes.values()]
        lines.append(f"| {cell[0]} | {cell[1]} | {means[0]:.1f} | {means[1]:.2f} | {' | '.join(counts)} |")
    total = len(entries)
    rates = [(sum(strict), *wilson(sum(strict), total)) for strict in outcomes.values()]
    told = [f"{count} = {100 * count / total:.1f} % [{100 * low:.1f}, {100 * high:.1f}]" for count, low, high in rates]
    lines.append(f"| of {total} | | | | {' | '.join(told)} |")
    for key in ("traversability", "relative_gap"):
        ranks = [_correlation([getattr(entry, key) for entry in entries], strict) for strict in outcomes.values()]
        lines.append(f"| rank correlation of {key} with success | | | | {' | '.join(ranks)} |")
    return "\n".join(lines)


def _correlation(difficulty: list[float], strict: list[bool]) -> str:
    """Spearman's rank correlation; ties have their mean rank."""

    def ranks(values: list[float]) -> NDArray[Any]:
        array = numpy.asarray(values, float)
        below = (array[None, :] < array[:, None]).sum(axis=1)
        equal = (array[None, :] == array[:, None]).sum(axis=1)
        return numpy.asarray(below + (equal - 1) / 2.0)

    one, other = ranks(difficulty), ranks([float(success) for success in strict])
    if other.std() == 0.0:
        return "-"
    return f"{numpy.corrcoef(one, other)[0, 1]:.2f}"


def main() -> None:
    """Flies the baselines, or writes the list anew."""
    parser = argparse.ArgumentParser(prog="python -m mppflight.benchmark", description=__doc__)
    parser.add_argument("--every", type=int, default=1, help="fly each n-th field only")
    parser.add_argument("--build", metavar="FILE", help="write the list anew instead; only for another version")
    arguments = parser.parse_args()
    if arguments.build:
        text = build()
        with open(arguments.build, "wb") as file:
            file.write(text)
        print(hashlib.sha256(text).hexdigest()[:16])
        return
    entries = fields()[:: arguments.every]
    print(table(entries, BASELINES, lambda: None))


if __name__ == "__main__":
    main()
