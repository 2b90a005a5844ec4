"""The MPP flight planner, its simulation and its campaigns. docs/python.md of the project describes this package."""

from . import errors
from ._native import Aircraft, Campaign, Core, Field, Flight, Lidar, Planner, World, __version__, fly, wilson
from .campaigns import Rows, campaign
from .errors import BusyError, FlightError, InputError, Interrupted, MppError, SetUpError, StateError

__all__ = [
    "Aircraft",
    "BusyError",
    "Campaign",
    "Core",
    "Field",
    "Flight",
    "FlightError",
    "InputError",
    "Interrupted",
    "Lidar",
    "MppError",
    "Planner",
    "Rows",
    "SetUpError",
    "StateError",
    "World",
    "__version__",
    "campaign",
    "errors",
    "fly",
    "wilson",
]
