"""Margins of the core's regulator."""

from __future__ import annotations

import importlib
from typing import Any

import numpy
from numpy.typing import NDArray

from .errors import InputError

# A tick of the core [s], and places on the frequency axis.
TICK, PLACES = 0.01, 20_000


def _crossings(values: NDArray[Any]) -> NDArray[Any]:
    """Where a curve changes its sign, without jumps of an angle from one end to the other."""
    jumps = numpy.abs(numpy.diff(values)) > numpy.pi
    return numpy.flatnonzero((numpy.diff(numpy.sign(values)) != 0) & ~jumps)


def margins(model: dict[str, Any]) -> dict[str, float]:
    """Margins of the loop that is cut at the elevator, at 100 Hz with commands that come a tick late: by what factor its
    gain may grow and shrink, and what phase [deg] and delay [s] it may lose, and how often a second it crosses gain 1 [Hz].
    """
    try:
        signal = importlib.import_module("scipy.signal")
    except ImportError as error:
        raise ImportError("margins need SciPy: pip install scipy") from error
    a, b = model["A"], model["B"][:, 1:]
    a, b, *_ = signal.cont2discrete((a, b, numpy.eye(4), numpy.zeros((4, 1))), TICK)
    rate = numpy.geomspace(1e-2, numpy.pi / TICK, PLACES)
    z = numpy.exp(1j * rate * TICK)
    loop = (model["K"] @ numpy.linalg.solve(z[:, None, None] * numpy.eye(4) - a, b[None]))[:, 0, 0] / z
    size, beyond = numpy.abs(loop), numpy.angle(-loop)
    late = numpy.block([[a, b], [-model["K"], numpy.zeros((1, 1))]])
    if numpy.abs(numpy.linalg.eigvals(late)).max() >= 1.0:
        raise InputError("margins: the regulator does not hold this aircraft with commands that come a tick late")
    turned, unit = _crossings(beyond), _crossings(numpy.log(size))
    factors = 1.0 / size[turned]
    spare = numpy.abs(beyond[unit])
    # What the phase lags behind the point -1, all the way round.
    lag = numpy.mod(beyond[unit], 2.0 * numpy.pi) / rate[unit]
    return {
        "gain_up": float(min((it for it in factors if it > 1.0), default=numpy.inf)),
        "gain_down": float(max((it for it in factors if it < 1.0), default=0.0)),
        "phase": float(numpy.degrees(min(spare, default=numpy.pi))),
        "delay": float(min(lag, default=numpy.inf)),
        "crossing": float(max(rate[unit], default=0.0) / (2.0 * numpy.pi)),
    }
