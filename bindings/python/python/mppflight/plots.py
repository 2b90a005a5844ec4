"""Pictures with matplotlib, which is loaded when the first one is asked for."""

from __future__ import annotations

import html
import io
import itertools
from base64 import b64encode
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy
from numpy.typing import NDArray

from ._native import wilson
from .errors import InputError

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ._native import Field, Flight
    from .campaigns import Rows

OBSTACLE, WAY, PLAN, HIT = "0.45", "tab:blue", "tab:orange", "tab:red"
# What has no window.
WINDOWLESS = ("agg", "cairo", "pdf", "pgf", "ps", "svg", "template")


def pyplot() -> Any:
    """`matplotlib.pyplot`."""
    try:
        from matplotlib import pyplot
    except ImportError as error:
        raise ImportError("pictures need matplotlib: pip install matplotlib") from error
    return pyplot


def _blank(width: float, height: float) -> tuple[Figure, Axes]:
    """A figure beside those of `pyplot`, so that no notebook shows it twice."""
    pyplot()
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = FigureCanvasAgg(Figure(figsize=(width, height))).figure
    return figure, figure.add_axes((0.07, 0.2, 0.91, 0.66))


def _field(axes: Axes, field: Field, time: float, x: tuple[float, float], z: tuple[float, float]) -> None:
    """Everything solid at a time [s] within a window [m]."""
    # Edges are drawn between points, 0.2 m apart where a lidar sees 45 m.
    step = min(x[1] - x[0], 60.0 * (z[1] - z[0]) / 20.0) / 300.0
    along, up = numpy.arange(x[0], x[1] + step, step), numpy.arange(z[0], z[1] + step, step)
    points = numpy.stack(numpy.meshgrid(along, up), axis=-1).reshape(-1, 2)
    apart = numpy.minimum(field.clearance(points, time), 1e3).reshape(len(up), len(along))
    if apart.min() < 0.0:
        axes.contourf(along, up, apart, levels=[-1e6, 0.0], colors=[OBSTACLE])
    axes.set(xlim=x, ylim=z, aspect="equal", xlabel="x [m]", ylabel="z [m]")


def _bodies(axes: Axes, flown: Flight) -> None:
    """What stands about a flight in space, from above; nothing of a flight that does not come out the same."""
    from matplotlib.collections import PatchCollection
    from matplotlib.patches import Circle, Rectangle

    try:
        bodies = flown.look()["bodies"]
    except InputError:
        return
    shapes: list[Circle | Rectangle] = []
    for body in bodies:
        for kind, it in body.items():
            if kind == "box":
                (x, y, _), (to_x, to_y, _) = it["least"], it["most"]
                shapes.append(Rectangle((x, y), to_x - x, to_y - y))
            elif kind != "capsule":
                x, y = (it["x"], it["y"]) if kind == "cylinder" else it["centre"][:2]
                shapes.append(Circle((x, y), it["radius"]))
    axes.add_collection(PatchCollection(shapes, color=OBSTACLE))


def flight(flown: Flight, axes: Axes | None = None) -> Axes:
    """Field, way and tracked plan of a flight; in space from above."""
    axes = pyplot().subplots(figsize=(10, 3), layout="constrained")[1] if axes is None else axes
    columns, summary = flown.columns, flown.summary
    across = "y" if "y" in columns else "z"
    x, z = columns["x"], columns[across]
    if across == "z":
        room = 15.0 * flown.header["world_scale"]
        bounds = (x.min() - room, x.max() + room), (z.min() - room, z.max() + room)
        _field(axes, flown.field, float(columns["t"][-1]), *bounds)
    axes.plot(x, z, color=WAY, linewidth=2.5, label="way")
    axes.plot(columns["ref_x"], columns[f"ref_{across}"], color=PLAN, linewidth=1.0, label="plan")
    if summary["outcome"] != "survived":
        axes.plot(x[-1], z[-1], "x", color=HIT, label=str(summary["outcome"]))
    if across == "y":
        _bodies(axes, flown)
        # To the right of the way is below.
        axes.set(aspect="equal", xlabel="x [m]", ylabel="y [m]", ylim=(z.max() + 10.0, z.min() - 10.0))
    axes.set_title(repr(flown))
    axes.legend(loc="upper right", ncols=3)
    return axes


def flight_html(flown: Flight) -> str:
    """The picture, or the text where there is no matplotlib."""
    text = f"<p>{html.escape(repr(flown))}</p>"
    try:
        figure, axes = _blank(10.0, 2.5)
    except ImportError:
        return text
    flight(flown, axes)
    png = io.BytesIO()
    figure.savefig(png)
    return f'<img alt="{html.escape(repr(flown))}" src="data:image/png;base64,{b64encode(png.getvalue()).decode()}">'


Cell = dict[str, Any]


def cells(flown: Rows) -> list[tuple[Cell, int, int]]:
    """The cells of a campaign, each with its flights and its strict successes. What is the same in all is left out."""
    counts: dict[tuple[tuple[str, Any], ...], list[bool]] = {}
    for row in flown:
        # A row begins with the keys of its cell.
        cell = itertools.takewhile(lambda item: item[0] != "seed", row.items())
        counts.setdefault(tuple(cell), []).append(row["strict"])
    told = [dict(cell) for cell in counts]
    names = dict.fromkeys(name for cell in told for name in cell)
    varied = [name for name in names if name == "obstacles" or len({cell.get(name) for cell in told}) > 1]
    shown = [{name: cell.get(name, "") for name in varied} for cell in told]
    return [(cell, len(strict), sum(strict)) for cell, strict in zip(shown, counts.values())]


def rows(flown: Rows, axes: Axes | None = None) -> Axes:
    """Strict successes over obstacles with their intervals, a line for each other cell."""
    axes = pyplot().subplots(layout="constrained")[1] if axes is None else axes
    lines: dict[str, list[tuple[float, float, float, float]]] = {}
    for cell, flights, strict in cells(flown):
        low, high = wilson(strict, flights)
        name = ", ".join(f"{key} {value}" for key, value in cell.items() if key != "obstacles")
        share = strict / flights
        lines.setdefault(name, []).append((cell["obstacles"], 100 * share, 100 * (share - low), 100 * (high - share)))
    for name, points in lines.items():
        at, shares, below, above = numpy.array(sorted(points)).T
        axes.errorbar(at, shares, numpy.maximum([below, above], 0.0), marker="o", capsize=3, label=name or None)
    axes.set(xlabel="obstacles", ylabel="strict successes [%]", ylim=(0, 103), title=f"{len(flown)} flights")
    if any(lines):
        axes.legend()
    return axes


def rows_html(flown: Rows) -> str:
    """A table of the cells."""
    told = cells(flown)
    heads = [*(told[0][0] if told else ()), "flights", "strict", "%", "95 %"]
    lines = ["".join(f"<th>{head}</th>" for head in heads)]
    for cell, flights, strict in told:
        low, high = wilson(strict, flights)
        values = [*cell.values(), flights, strict, f"{100 * strict / flights:.1f}", f"{100 * low:.1f}-{100 * high:.1f}"]
        lines.append("".join(f"<td>{html.escape(str(value))}</td>" for value in values))
    return f"<table>{''.join(f'<tr>{line}</tr>' for line in lines)}</table>"


class Window:
    """The pictures of an environment: one figure, drawn anew for each."""

    def __init__(self, human: bool) -> None:
        self._human = human
        if human and pyplot().get_backend().lower() in WINDOWLESS:
            raise InputError("render_mode: give rgb_array, matplotlib has no window here; or set MPLBACKEND")
        drawn: tuple[Figure, Axes] = pyplot().subplots(figsize=(8, 3.2)) if human else _blank(8.0, 3.2)
        self._figure, self._axes = drawn

    def __deepcopy__(self, memo: dict[int, Any]) -> Window:
        return Window(self._human)

    def draw(
        self, field: Field, time: float, way: Sequence[tuple[float, float]], hits: NDArray[Any], sight: float,
        plans: NDArray[Any],
    ) -> NDArray[numpy.uint8] | None:
        """The way so far, the ends of the beams that met something, and plans, rows of places [m]."""
        (x, z), axes = way[-1], self._axes
        axes.clear()
        _field(axes, field, time, (x - 0.2 * sight, x + 1.1 * sight), (50.0 - 0.25 * sight, 50.0 + 0.25 * sight))
        for plan in plans:
            axes.plot(*plan.T, color=PLAN, linewidth=0.8)
        axes.plot(*numpy.array(way).T, color=WAY)
        axes.plot(x, z, ">", color=WAY)
        axes.plot(*hits.T, ".", color=HIT, markersize=3)
        axes.set_title(f"{time:.2f} s")
        if self._human:
            pyplot().pause(1e-3)
            return None
        canvas: Any = self._figure.canvas
        canvas.draw()
        return numpy.array(canvas.buffer_rgba(), numpy.uint8)[:, :, :3]

    def close(self) -> None:
        """Closes the window."""
        if self._human:
            pyplot().close(self._figure)
