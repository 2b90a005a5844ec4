"""The exceptions of this package. Their messages are those of the core and of the simulation."""

from __future__ import annotations

import operator
import re
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .campaigns import Rows


class MppError(Exception):
    """Any error of this package."""


class InputError(MppError, ValueError):
    """A number, an array, a key or a file makes no sense; the message says what to give instead."""

    def add_note(self, note: str, /) -> None:
        """The native half notes so which argument it could not read: its name goes in front."""
        if found := re.fullmatch("while processing '(.+)'", note):
            self.args = (f"{found[1]}: {self}",)
        else:
            super().add_note(note)


def whole(name: str, value: Any, least: int, most: int, wanted: str = "") -> int:
    """A whole number within bounds, also one of NumPy's. True is none."""
    try:
        number = -1 if isinstance(value, bool) else operator.index(value)
    except TypeError:
        number = -1
    if not least <= number <= most:
        raise InputError(f"{name}: give {wanted or f'{least} to {most}'}, not {value!r}")
    return number


class SetUpError(MppError):
    """The core cannot be set up for this aircraft and these settings."""


class FlightError(MppError):
    """A flight ended without an outcome."""


class StateError(MppError):
    """Something was asked for too early or too late: before a first step, after a close."""


class BusyError(StateError):
    """Another thread is using the object."""


class Interrupted(KeyboardInterrupt):
    """Ctrl-C ended a campaign. `rows` are those that were flown."""

    def __init__(self, rows: Rows) -> None:
        super().__init__(f"interrupted after {len(rows)} flights; they are the attribute `rows`")
        self.rows = rows
