"""Compares public QP solvers with ours on the same exported programs, in one table.

Every solver works on one thread, cold, and on the form that suits it. README.md tells how to run it.
"""

import os

os.environ.update(
    {f"{name}_NUM_THREADS": "1" for name in ("OMP", "OPENBLAS", "MKL", "RAYON")}
)

import argparse
import datetime
import json
import math
import platform
import shlex
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, field
from importlib.metadata import version
from pathlib import Path

from programs import Program, read_programs
from solvers import DAQP_NATIVE, PEERS, Answer, Peer

ROOT = Path(__file__).resolve().parents[2]
CARGO = ["cargo", "run", "--release", "-q", "-p", "sil-harness", "--features", "clarabel", "--"]
HEADER = (
    "solver", "version", "form", "clock", "timed", "n", "median us", "p99 us", "max us",
    "verdict errors", "cost error", "row error",
)
MEDIAN = HEADER.index("median us")
FEASIBLE = 1e-11
"""Row error up to which a solution may be the best one."""
EXPLANATION = """\
Times are the best of several cold runs of each program, on one thread; clock `native`: the
solver's own, `python`: around the call. Verdict errors include missing ones (in brackets); ties
do not count. Cost errors are relative to the best feasible cost that any solver found, else to the
recorded one; row errors [m, rad, N] are what the controls violate when the dynamics are followed
exactly. Both are the worst over feasible programs. The harness judges `mpp`, by the same costs
and margins."""


@dataclass
class Tally:
    """One solver's answers."""

    peer: Peer
    answers: list[Answer] = field(default_factory=list)
    failure: str = ""

    def ask(self, program: Program) -> None:
        """Runs the solver several times and keeps the fastest run. Any exception ends this solver's part."""
        if self.failure:
            return
        try:
            runs = [self.peer.solve(program) for _ in range(self.peer.runs)]
        except Exception as error:  # a solver may raise anything, and the table must show it
            self.failure = f"{type(error).__name__} at {program.name}: {error}"
            return
        self.answers.append(min(runs, key=lambda answer: answer.seconds))

    def row(self, programs: Sequence[Program], best: Sequence[float | None]) -> list[str]:
        """The solver's line of the table."""
        start = [self.peer.name, release(self.peer.package), self.peer.form]
        if self.failure:
            return failed(start, self.failure)
        wrong, silent, cost_errors, row_error = 0, 0, [], 0.0
        for program, answer, least in zip(programs, self.answers, best, strict=True):
            if program.feasible is not None:
                wrong += answer.feasible != program.feasible
                silent += answer.feasible is None
            if program.feasible and answer.controls is not None:
                cost, excess = program.judge(answer.controls)
                row_error = max(row_error, excess)
                if least is not None:
                    cost_errors.append(abs(cost - least) / max(1.0, abs(least)))
        times = sorted(answer.seconds * 1e6 for answer in self.answers)
        return [
            *start, self.peer.clock, self.peer.timed, str(len(times)),
            *(f"{percentile(times, percent):.1f}" for percent in (50, 99, 100)),
            f"{wrong} ({silent})" if silent else str(wrong),
            f"{max(cost_errors):.1e}" if cost_errors else "-", f"{row_error:.1e}",
        ]


def release(package: str) -> str:
    """The installed version of a package."""
    try:
        return version(package)
    except ImportError:
        return "none"


def percentile(ordered: Sequence[float], percent: int) -> float:
    """Nearest-rank percentile of sorted values."""
    return ordered[max(1, math.ceil(len(ordered) * percent / 100)) - 1]


def best_cost(program: Program, answers: Sequence[Answer]) -> float | None:
    """The least cost of feasible answers, or else the recorded cost, if there is one."""
    judged = [program.judge(a.controls) for a in answers if a.controls is not None]
    costs = [cost for cost, excess in judged if excess <= FEASIBLE]
    return min(costs, default=program.record["cost"])


def ask_ours(
    programs: Sequence[Program], best: Sequence[float | None], harness: Path | None
) -> list[str]:
    """The line of our own solver. The harness runs it and judges it by the best known costs."""
    start = ["mpp", "this tree", "own"]
    with tempfile.NamedTemporaryFile("w", suffix=".jsonl", encoding="utf-8") as file:
        for program, cost in zip(programs, best, strict=True):
            known = {"margin": program.margin, "cost": cost}
            file.write(json.dumps({**program.record, **known}) + "\n")
        file.flush()
        command = [str(harness.resolve())] if harness else CARGO
        command = [*command, "bench", "qp", "--instances", file.name, "--json"]
        try:
            run = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
        except OSError as error:
            return failed(start, str(error))
    if run.returncode != 0:
        return failed(start, run.stderr)
    report = json.loads(run.stdout)
    ours = next(solver for solver in report["solvers"] if solver["name"] == "mpp")
    return [
        *start, "native", "all but condensing", str(report["instances"]),
        *(f"{ours[key]:.1f}" for key in ("median_us", "p99_us", "max_us")),
        str(ours["verdict_errors"]),
        f"{ours['worst_objective_error']:.1e}", f"{ours['worst_row_error']:.1e}",
    ]


def failed(start: Sequence[str], reason: str) -> list[str]:
    """The line of a solver that could not run, with the reason in place of the times."""
    short = " ".join(reason.replace("|", "/").split())[:80]
    print(f"{start[0]}: {reason}", file=sys.stderr)
    return [*start, "-", f"failed: {short}", *["-"] * (len(HEADER) - 5)]


def table(rows: Sequence[Sequence[str]]) -> str:
    """A Markdown table."""
    columns = zip(HEADER, *rows, strict=True)
    widths = [max(len(cell) for cell in column) for column in columns]
    lines = [
        f"| {' | '.join(cell.ljust(width) for cell, width in zip(row, widths, strict=True))} |"
        for row in (HEADER, *rows)
    ]
    lines.insert(1, f"|{'|'.join('-' * (width + 2) for width in widths)}|")
    return "\n".join(lines)


def processor() -> str:
    """The processor's model name."""
    info = Path("/proc/cpuinfo")
    lines = info.read_text(encoding="utf-8").splitlines() if info.exists() else []
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.processor() or "unknown"


def arguments() -> argparse.Namespace:
    """Reads the command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    names = ", ".join(["mpp", *(peer.name for peer in PEERS)])
    parser.add_argument("--instances", type=Path, required=True, help="file that `bench qp --export` wrote")
    parser.add_argument("--limit", type=int, help="use this number of programs from the file's start")
    parser.add_argument("--harness", type=Path, help="program of the harness (default: cargo run)")
    parser.add_argument("--daqp", type=Path, help="unpacked source of DAQP, for daqp-native")
    parser.add_argument("--markdown", type=Path, help="also write the report to this file")
    parser.add_argument("--only", metavar="NAME,...", help=f"solvers to run: {names}")
    return parser.parse_args()


def main() -> None:
    """Runs all solvers and prints the table."""
    args = arguments()
    DAQP_NATIVE.source = args.daqp
    only = set(args.only.split(",")) if args.only else {"mpp", *(peer.name for peer in PEERS)}
    tallies = [Tally(peer) for peer in PEERS if peer.name in only]
    unknown = only - {"mpp", *(tally.peer.name for tally in tallies)}
    if unknown:
        sys.exit(f"no such solver: {', '.join(sorted(unknown))}")
    everything = read_programs(args.instances, args.limit)
    programs = [program for program in everything if not program.soft]
    if not programs:
        sys.exit("no programs with hard rows")
    for index, program in enumerate(programs, 1):
        print(f"\r{index}/{len(programs)}", end="", file=sys.stderr)
        for tally in tallies:
            tally.ask(program)
    print(file=sys.stderr)
    running = [tally.answers for tally in tallies if not tally.failure]
    best = [
        best_cost(program, [answers[index] for answers in running])
        for index, program in enumerate(programs)
    ]
    rows = [tally.row(programs, best) for tally in tallies]
    if "mpp" in only:
        rows.append(ask_ours(programs, best, args.harness))
    rows.sort(key=lambda row: math.inf if row[MEDIAN] == "-" else float(row[MEDIAN]))
    truths = [program.feasible for program in programs]
    summary = (
        f"{len(programs)} programs, {truths.count(True)} feasible, {truths.count(None)} ties; "
        f"{len(everything) - len(programs)} with soft rows skipped."
    )
    report = f"{summary}\n\n{table(rows)}\n\n{EXPLANATION}"
    print(report)
    if args.markdown:
        python = f"Python {platform.python_version()}"
        conditions = f"{datetime.date.today()}, {python}, {processor()}, one thread"
        command = shlex.join(["python", *sys.argv])
        text = f"# QP solvers on the same programs\n\n{conditions}\n\n`{command}`\n\n{report}\n"
        args.markdown.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
