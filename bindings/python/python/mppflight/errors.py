"""The exceptions of this package. Their messages are those of the core and of the simulation."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .campaigns import Rows


class MppError(Exception):
    """Any error of this package."""


class InputError(MppError, ValueError):
    """A number, an array, a key or a file makes no sense; the message says what to give instead."""


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
