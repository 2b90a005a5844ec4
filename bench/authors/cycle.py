"""Times the authors' own planning cycles: from a grid to the commands of the best of 25 paths.

One thread, one JSON object. `sil-harness bench cycle --authors PYTHON` runs it beside our cycles. README.md tells how
to set it up.
"""

import argparse
import json
import os
import time
from pathlib import Path
from typing import Any

os.environ.update({f"{name}_NUM_THREADS": "1" for name in ("OMP", "OPENBLAS", "MKL")})

import numpy as np

import authors
import search


def main() -> None:
    """Reads the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--mpp", type=Path, default=Path("out/authors/mpp"), help="the authors' code")
    parser.add_argument("--rrtplanner", type=Path, default=Path("out/authors/rrtplanner"))
    parser.add_argument("--paths", type=int, default=25)
    parser.add_argument("--obstacles", type=int, default=40)
    parser.add_argument("--flights", type=int, default=5)
    parser.add_argument("--seed", type=int, default=1, help="seed of the first flight")
    parser.add_argument("--as-published", action="store_true", help="compile nothing, which is slow")
    options = parser.parse_args()
    authors.load(options.mpp, options.rrtplanner)
    if not options.as_published:
        authors.mpp.singleRay = search.ray
    seconds: list[float] = []
    plan = authors.paths_planner(options.paths)

    def timed(*arguments: Any) -> authors.Commands:
        start = time.perf_counter()
        try:
            return plan(*arguments)
        finally:
            seconds.append(time.perf_counter() - start)

    # The first flight compiles what is to be compiled.
    authors.fly(options.seed, 0, timed)
    seconds.clear()
    for seed in range(options.seed, options.seed + options.flights):
        authors.fly(seed, options.obstacles, timed)
    median, p99 = (1e6 * float(value) for value in np.quantile(seconds, [0.5, 0.99]))
    print(json.dumps({"cycles": len(seconds), "median_us": median, "p99_us": p99}))


if __name__ == "__main__":
    main()
