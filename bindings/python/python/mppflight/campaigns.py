"""Campaigns: many flights over a grid, on threads of this process or on the workers of a Dask cluster."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Generator, Iterable, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from functools import lru_cache
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack, overload

from . import plots
from ._native import Campaign, Field, wilson
from .errors import InputError, Interrupted, whole
from .keys import CommonKeys, GeneratorKeys, GeneratorName, Preset

if TYPE_CHECKING:
    import pandas
    from distributed import Client
    from matplotlib.axes import Axes

# Flights in one task of a worker: a flight takes about 20 ms, the scheduler about 1 ms for a task.
CHUNK = 10


# Lines by the numbers of their flights, as they come.
Flown = Generator[dict[int, str], None, None]


class Rows(Sequence[dict[str, Any]]):
    """The rows of a campaign in the order of its cells and seeds, each a dict."""

    def __init__(self, lines: Iterable[str], flights: Campaign) -> None:
        self.lines = list(lines)
        self._flights = flights

    def __len__(self) -> int:
        return len(self.lines)

    @overload
    def __getitem__(self, index: int) -> dict[str, Any]: ...
    @overload
    def __getitem__(self, index: slice) -> Rows: ...
    def __getitem__(self, index: int | slice) -> dict[str, Any] | Rows:
        if isinstance(index, slice):
            return Rows(self.lines[index], self._flights)
        row: dict[str, Any] = json.loads(self.lines[index])
        return row

    def __eq__(self, other: object) -> bool:
        return self.lines == other.lines if isinstance(other, Rows) else NotImplemented

    def __repr__(self) -> str:
        flown = len(self)
        if not flown:
            return "<Rows: no flights>"
        strict = sum('"strict":true' in line for line in self.lines)
        low, high = (100.0 * share for share in wilson(strict, flown))
        share = 100.0 * strict / flown
        return f"<Rows: {flown} flights, {strict} strict successes, {share:.1f} % [{low:.1f}, {high:.1f}]>"

    def plot(self, axes: Axes | None = None) -> Axes:
        """Draws strict successes over obstacles with their intervals, a line for each other cell. Gives the axes."""
        return plots.rows(self, axes)

    def _repr_html_(self) -> str:
        return plots.rows_html(self)

    def to_pandas(self) -> pandas.DataFrame:
        """The rows as a `pandas.DataFrame`."""
        import pandas

        return pandas.DataFrame(list(self))

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the row file that `sil-harness campaign --out` writes, which its `--report` reads and which it can
        go on with: a header, then one line of JSON for each row.
        """
        lines = [self._flights.header(), *self.lines]
        Path(path).write_text("".join(f"{line}\n" for line in lines), encoding="utf-8")


def campaign(
    *,
    trials: int,
    seed: int | None = None,
    preset: Preset | Sequence[Preset] = (),
    generator: GeneratorName | Sequence[GeneratorName] | GeneratorKeys = (),
    obstacles: int | Sequence[int] = (),
    paths: int | Sequence[int] = (),
    replan_hz: float | Sequence[float] = (),
    fields: dict[str, Field] | None = None,
    workers: int | None = None,
    progress: Callable[[int, int], object] | None = None,
    client: Client | None = None,
    **scenario: Unpack[CommonKeys],
) -> Rows:
    """Flies `trials` seeds from `seed` on in each cell of a grid. The lists vary the presets, generators, numbers of
    obstacles and paths, replanning rates and fields; `scenario` holds the other keys of a scenario, for all.

    The flights go to `workers` threads, by default one for each core, or to the workers of a Dask `client`. The rows
    are the same for any of them. `progress` is called with the number of rows so far and of all. Ctrl-C raises
    `Interrupted`, which holds the rows so far.
    """
    keys: dict[str, Any] = {**scenario}
    if isinstance(generator, dict):
        # A generator with parameters is that of every cell.
        keys["generator"], generator = generator, ()
    workers = os.cpu_count() or 1 if workers is None else whole("workers", workers, 1, 1000)
    if progress is not None and not callable(progress):
        raise InputError(f"progress: give a function of two numbers, not {progress!r}")
    if client is not None and not hasattr(client, "map"):
        raise InputError(f"client: give a Dask client, not {client!r}")
    flights = Campaign(
        keys,
        trials=trials,
        seed=seed,
        preset=_listed(preset),
        generator=_listed(generator),
        obstacles=_listed(obstacles),
        paths=_listed(paths),
        replan_hz=_listed(replan_hz),
        fields=fields,
    )
    flown = _on_cluster(flights, client) if client is not None else _on_threads(flights, workers)
    lines: dict[int, str] = {}
    try:
        for done in flown:
            lines.update(done)
            if progress is not None:
                progress(len(lines), len(flights))
    except KeyboardInterrupt as signal:
        raise Interrupted(_sorted(lines, flights)) from signal
    finally:
        flown.close()
    return _sorted(lines, flights)


def _listed(value: Any) -> list[Any]:
    # A text, a dict and a number of NumPy are single values too.
    several = isinstance(value, Iterable) and getattr(value, "ndim", 1) > 0
    return list(value) if several and not isinstance(value, (str, bytes, Mapping)) else [value]


def _sorted(lines: dict[int, str], flights: Campaign) -> Rows:
    return Rows((lines[index] for index in sorted(lines)), flights)


def _on_threads(flights: Campaign, count: int) -> Flown:
    waiting = iter(range(len(flights)))
    running: dict[Future[str], int] = {}
    pool = ThreadPoolExecutor(count)
    try:
        while True:
            # A few wait, so that no thread does.
            for index in islice(waiting, 2 * count - len(running)):
                running[pool.submit(flights.fly, index)] = index
            if not running:
                return
            for future in wait(running, return_when=FIRST_COMPLETED).done:
                yield {running.pop(future): future.result()}
    finally:
        pool.shutdown(cancel_futures=True)


def _on_cluster(flights: Campaign, client: Client) -> Flown:
    from distributed import as_completed as as_dask_completes

    chunks = [range(first, min(first + CHUNK, len(flights))) for first in range(0, len(flights), CHUNK)]
    futures = client.map(_fly, chunks, text=flights.to_json(), pure=False)
    try:
        # A task whose worker was lost goes to another one.
        for future in as_dask_completes(futures):  # type: ignore[no-untyped-call]
            yield future.result()
    finally:
        client.cancel(futures)  # type: ignore[no-untyped-call]


def _fly(indices: range, text: str) -> dict[int, str]:
    flights = _known(text)
    return {index: flights.fly(index) for index in indices}


@lru_cache(maxsize=1)
def _known(text: str) -> Campaign:
    return Campaign.from_json(text)
