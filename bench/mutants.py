"""Mutates the flight code and tells which mutants no test notices.

    cargo install cargo-mutants --locked
    python3 bench/mutants.py --shard 0/10

Each mutant is tested twice: first by the tests of its own crate, which take seconds. What survives flies the golden
flights. What survives these too is listed. `--shard K/N` takes every N-th mutant, from the K-th on. Nothing in the
working tree changes: cargo-mutants works on a copy of it.
"""

import argparse
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
FILES = [
    "mpp-core/src/estimate/**",
    "mpp-core/src/flight/**",
    "mpp-core/src/qp/solve/**",
    "hil-protocol/src/frame/**",
    "hil-protocol/src/mavlink/**",
]
# No test takes longer, unless a mutant made it endless [s].
TIMEOUT = 200


def mutate(out, files, more, tests=()):
    """Runs cargo-mutants and returns its outcomes by verdict."""
    command = ["cargo", "mutants", "--workspace", "--output", str(out), "--timeout", str(TIMEOUT)]
    for file in files:
        command += ["--file", file]
    code = subprocess.call(command + more + list(tests), cwd=ROOT)
    # 2: some mutants survived; 3: some took too long.
    if code not in (0, 2, 3):
        sys.exit(f"cargo mutants ended with code {code}: see {out}")
    found = out / "mutants.out"
    read = lambda verdict: (found / f"{verdict}.txt").read_text().splitlines()
    return {verdict: read(verdict) for verdict in ("caught", "missed", "timeout", "unviable")}


def quoted(name):
    """A regular expression of cargo-mutants that matches a name and nothing else."""
    return "^" + "".join("\\" + c if c in r"\.+*?()|[]{}^$" else c for c in name) + "$"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--shard", default="0/1", help="K/N: every N-th mutant, from the K-th on [all]")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "out" / "mutants", help="folder of the records")
    options = parser.parse_args()
    for stage in ("own", "flights"):
        (options.out / stage).mkdir(parents=True, exist_ok=True)
    shard = ["--shard", options.shard, "--sharding", "round-robin"]
    first = mutate(options.out / "own", FILES, shard)
    survivors = first["missed"]
    left = survivors
    if survivors:
        files = sorted({name.split(":")[0] for name in survivors})
        # The flights are those of another crate than the mutants, whose baseline cargo-mutants would fly.
        subprocess.run(["cargo", "test", "-p", "mpp-tests", "--test", "all", "golden::"], cwd=ROOT, check=True)
        more = ["--test-package", "mpp-tests", "--baseline", "skip"]
        for name in survivors:
            more += ["--re", quoted(name)]
        second = mutate(options.out / "flights", files, more, ["--", "--test", "all", "golden::"])
        beaten = set(second["caught"] + second["timeout"])
        left = [name for name in survivors if name not in beaten]
    viable = sum(len(first[verdict]) for verdict in ("caught", "missed", "timeout"))
    flights = len(survivors) - len(left)
    print(f"{viable} viable mutants: {viable - len(survivors)} caught by the tests of their crate, {flights} by flights")
    print(f"{100 * (viable - len(left)) / max(viable, 1):.1f} % caught; {len(left)} survive:")
    print("\n".join(left))


if __name__ == "__main__":
    main()
