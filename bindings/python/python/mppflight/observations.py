"""What the environments have in common besides flights: units of observations, and what is taken from rewards."""

from __future__ import annotations

from typing import Any, TypedDict

import numpy
from gymnasium import spaces

from ._native import Batch, Choice
from .errors import InputError

# Arrays by name.
Observation = dict[str, Any]


def box(shape: tuple[int, ...], low: float = -numpy.inf, high: float = numpy.inf) -> spaces.Box:
    return spaces.Box(low, high, shape, numpy.float32)


class Reward(TypedDict, total=False):
    """What a second costs besides."""

    clearance: float
    margin: float
    effort: float


def shaping(reward: Reward | None) -> list[float]:
    given: dict[str, Any] = {**(reward or {})}
    usual = {"clearance": 0.0, "margin": 1.0, "effort": 0.0}
    for name, value in given.items():
        if name not in usual or not isinstance(value, (int, float)):
            raise InputError(f"reward: give numbers for {', '.join(usual)}, not {name}={value!r}")
    return [float(value) for value in (usual | given).values()]


class Units:
    """Observations, with their units or without them."""

    def __init__(self, native: Batch | Choice, normalised: bool) -> None:
        if not isinstance(normalised, bool):
            raise InputError(f"normalised: give True or False, not {normalised!r}")
        self._normalised, (cruise, way, altitude, band) = normalised, native.scales
        sight = native.lidar[1]
        # What is taken off, and the unit.
        known = {
            "lidar": ([0.0], [sight]),
            "air": ([cruise, 0.0], [cruise, 1.0]),
            "position": ([0.0, altitude], [way, band]),
            "state": ([cruise, 0.0, 0.0, 0.0], [cruise, 1.0, 1.0, band]),
            "candidates": ([0.0], [sight]),
        }
        self._scales = {name: numpy.array(pair, numpy.float32) for name, pair in known.items()}

    def of(self, seen: Observation) -> Observation:
        """An observation as the agent gets it."""
        if not self._normalised:
            return seen
        made = dict(seen)
        for name in self._scales.keys() & seen.keys():
            off, unit = self._scales[name]
            made[name] = (seen[name] - off) / unit
        if "price" in made:
            made["price"] = made["price"] / (1.0 + made["price"])
        return made

    def space(self, observation: spaces.Dict[Any]) -> spaces.Dict[Any]:
        """The space of what `of` gives."""
        if self._normalised:
            for name in ("lidar", "price"):
                if name in observation.spaces:
                    observation.spaces[name] = box(observation.spaces[name].shape or (), 0.0, 1.0)
        return observation
