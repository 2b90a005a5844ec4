"""Prints how the time of a planning cycle grows with obstacles, candidates and beams, by `sil-harness bench cycle`.

    python3 bench/scaling.py [--harness PROGRAM] [--flights N]
"""

import argparse
import json
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
CARGO = ["cargo", "run", "--release", "-q", "-p", "sil-harness", "--"]
USUAL = {"obstacles": 40, "paths": 25, "beams": 100}
SWEEPS = {
    "obstacles": (0, 20, 40, 80, 120, 160, 240),
    "paths": (1, 2, 5, 9, 25, 50),
    "beams": (25, 50, 100, 128),
}


def cycle(harness: list[str], flights: int, values: dict[str, int]) -> list[dict]:
    """The figures of both presets, `reference` and `flight`."""
    with tempfile.NamedTemporaryFile("w", suffix=".toml", encoding="utf-8") as scenario:
        scenario.write(f"[lidar]\nbeams = {values['beams']}\n")
        scenario.flush()
        given = ["--obstacles", values["obstacles"], "--paths", values["paths"], "--flights", flights]
        command = [*harness, "bench", "cycle", "--json", "--scenario", scenario.name, *map(str, given)]
        done = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True)
    return json.loads(done.stdout)["presets"]


def main() -> None:
    """Prints a table for each sweep; what does not vary has its usual value."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--harness", type=Path, help="program of the harness (default: cargo run)")
    parser.add_argument("--flights", type=int, default=10, help="flights that are recorded for each line")
    args = parser.parse_args()
    harness = [str(args.harness.resolve())] if args.harness else CARGO
    for name, values in SWEEPS.items():
        print(f"\n| {name} | `reference` median us | p99 | programs | `flight` median us | p99 | programs |")
        print("|---|---|---|---|---|---|---|")
        for value in values:
            presets = cycle(harness, args.flights, {**USUAL, name: value})
            cells = [
                f"{preset['cycle']['median_us']:.0f} | {preset['cycle']['p99_us']:.0f} | {preset['candidates_mean']:.1f}"
                for preset in presets
            ]
            print(f"| {value} | {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    main()
