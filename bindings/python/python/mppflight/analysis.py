"""Margins of the core's regulator."""

from __future__ import annotations

import importlib
from typing import Any

import numpy

from .errors import InputError

# A tick of the core [s], and how many frequencies are looked at.
TICK, PLACES = 0.01, 20_000


def margins(model: dict[str, Any]) -> dict[str, float]:
    """Margins of the loop that is cut at the elevator, at 100 Hz with commands that come a tick late: by what factor its
    gain may grow and shrink, and what phase [deg] and delay [s] it may lose, and how often a second it crosses gain 1 [Hz].
    """
    try:
        control = importlib.import_module("control")
    except ImportError as error:
        raise ImportError("margins need python-control: pip install control") from error
    plant = control.sample_system(control.ss(model["A"], model["B"][:, 1:], model["K"], 0), TICK)
    loop = plant * control.ss([[0]], [[1]], [[1]], [[0]], TICK)
    if abs(control.feedback(loop).poles()).max() >= 1.0:
        raise InputError("margins: the regulator does not hold this aircraft with commands that come a tick late")
    seen = control.frequency_response(loop, numpy.geomspace(1e-2, numpy.pi / TICK, PLACES))
    factors, phases, _, _, rates, _ = control.stability_margins(seen, returnall=True)
    # What the phase lags behind the point -1, all the way round.
    lag = numpy.radians(phases) % (2 * numpy.pi) / rates
    return {
        "gain_up": float(min((it for it in factors if it > 1.0), default=numpy.inf)),
        "gain_down": float(max((it for it in factors if it < 1.0), default=0.0)),
        "phase": float(min(abs(phases), default=180.0)),
        "delay": float(min(lag, default=numpy.inf)),
        "crossing": float(max(rates, default=0.0) / (2 * numpy.pi)),
    }
