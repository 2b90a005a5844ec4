"""Flies the authors' own code: success over obstacles, beside the results that the paper publishes.

Each row is a flight, and the table follows. README.md tells how to set it up.
"""

import argparse
import functools
import json
import os
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

os.environ.update({f"{name}_NUM_THREADS": "1" for name in ("OMP", "OPENBLAS", "MKL")})

from scipy.stats import binomtest, fisher_exact
from tqdm import tqdm

import authors
import baseline
import search

PUBLISHED = {
    25: {0: 100, 5: 99, 10: 98, 15: 97, 20: 90},
    5: {0: 100, 5: 94, 10: 85, 15: 71, 20: 65},
    1: {0: 100, 5: 91, 10: 67, 15: 51, 20: 35},
    0: {0: 100, 5: 67, 10: 28, 15: 25, 20: 18},
}
"""Successes of 100 flights by paths and obstacles (the authors' figure 8)."""


def start(options: argparse.Namespace) -> None:
    """Prepares each process."""
    authors.load(options.mpp, options.rrtplanner)
    if not options.as_published:
        authors.mpp.singleRay = search.ray


def fly(options: argparse.Namespace, cell: tuple[int, int, int]) -> dict[str, Any]:
    """One flight."""
    paths, obstacles, seed = cell
    if paths == 0 and not options.as_published:
        plan = baseline.planner(set(options.change))
    else:
        plan = authors.paths_planner(paths)
    return {"paths": paths, **authors.fly(seed, obstacles, plan)}


def report(rows: list[dict[str, Any]], compares: bool) -> None:
    """Prints a line for each cell: successes, Wilson interval, published rate, ends of the others."""
    for paths, obstacles in sorted({(row["paths"], row["obstacles"]) for row in rows}):
        cell = [row for row in rows if (row["paths"], row["obstacles"]) == (paths, obstacles)]
        good, count = sum(row["ended"] is None for row in cell), len(cell)
        low, high = binomtest(good, count).proportion_ci(method="wilson")
        line = f"{paths:2} paths {obstacles:2} obstacles: {good} of {count}, {100 * good / count:.1f} %"
        line += f" [{100 * low:.1f}, {100 * high:.1f}]"
        published = PUBLISHED.get(paths, {}).get(obstacles)
        if compares and published is not None:
            chance = fisher_exact([[good, count - good], [published, 100 - published]]).pvalue
            line += f", published {published} (p = {chance:.2g})"
        failures = Counter(row["ended"] for row in cell if row["ended"])
        print(line, dict(failures.most_common()))


def numbers(text: str) -> list[int]:
    """Reads a list with commas."""
    return [int(number) for number in text.split(",")]


def main() -> None:
    """Reads the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--mpp", type=Path, default=Path("out/authors/mpp"), help="the authors' code")
    parser.add_argument("--rrtplanner", type=Path, default=Path("out/authors/rrtplanner"))
    parser.add_argument("--paths", type=numbers, default=[0], help="25,5,1; 0 is the authors' baseline")
    parser.add_argument("--obstacles", type=numbers, default=[0, 5, 10, 15, 20])
    parser.add_argument("--trials", type=int, default=300)
    parser.add_argument("--seed", type=int, default=0, help="seed of the first flight of a cell")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--as-published", action="store_true", help="compile nothing, which is slow")
    changes = "; ".join(f"{name}: {what}" for name, what in baseline.CHANGES.items())
    parser.add_argument("--change", action="append", choices=baseline.CHANGES, default=[], help=changes)
    parser.add_argument("--out", type=Path, help="file for the rows, one flight per row, as JSON lines")
    options = parser.parse_args()
    if options.change and (options.as_published or options.paths != [0]):
        parser.error("--change is for the compiled baseline: --paths 0, no --as-published")
    start(options)  # A missing file is reported here, not by every process.
    seeds = range(options.seed, options.seed + options.trials)
    cells = [(p, o, s) for s in seeds for p in options.paths for o in options.obstacles]
    with ProcessPoolExecutor(options.jobs, initializer=start, initargs=(options,)) as pool:
        flights = pool.map(functools.partial(fly, options), cells)
        rows = list(tqdm(flights, total=len(cells), unit="flight"))
    if options.out:
        options.out.write_text("".join(json.dumps(row) + "\n" for row in rows))
    report(rows, compares=not options.change)


if __name__ == "__main__":
    main()
