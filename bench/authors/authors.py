"""The authors' code. It is loaded from a checkout and flown as their notebook flies it.

Two things are done once where the authors do them often, to the same numbers. The lidar scans and the grid
is filled only where a plan uses them, and the direction search of the raytrace is compiled (`search.py`).
"""

import contextlib
import importlib.util
import io
import random
import sys
import types
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

THRUST = 4.3
"""The thrust that the authors take for level flight [N]."""
TICKS = 2000
"""Length of a flight [ticks of 10 ms]."""
REPLAN = 100
"""Time from one plan to the next [ticks]."""

mpp: Any = None
"""The authors' module `ConvexMotionPlanning`."""


class NoPath(Exception):
    """The search found no path."""


@dataclass
class Commands:
    """The authors' commands for every tick of a flight."""

    thrust: np.ndarray
    elevator: np.ndarray
    x: np.ndarray
    z: np.ndarray
    states: np.ndarray
    """Airspeed, pitch, pitch rate, flight path angle: ticks by 4."""

    @classmethod
    def of(cls, thrust: float, elevator: float, state: list[float]) -> "Commands":
        """Constant thrust and elevator. As in the authors' code, only the first tick has a state."""
        commands = cls(*(np.zeros(TICKS) for _ in range(4)), np.zeros((TICKS, 4)))
        commands.thrust += thrust
        commands.elevator += elevator
        commands.states[0] = state
        return commands


Planner = Callable[[Any, np.ndarray, Commands, int], Commands]
"""A function of drone, grid, the commands so far and the tick. It returns new commands."""


def load(checkout: Path, rrtplanner: Path) -> None:
    """Makes the authors' modules importable. The file of `rrtplanner` is loaded alone. Its package asks for
    a noise generator, and the authors' package asks for a solver (Mosek); neither is used."""
    global mpp
    warnings.filterwarnings("ignore")
    path = rrtplanner / "rrtplanner" / "rrt.py"
    spec = importlib.util.spec_from_file_location("rrtplanner.rrt", path)
    if not path.exists() or spec is None or spec.loader is None:
        raise SystemExit(f"{path} is missing: clone rrtplanner there (README.md)")
    if not (checkout / "ConvexMotionPlanning.py").exists():
        raise SystemExit(f"{checkout} is not the authors' code: clone it there (README.md)")
    planner = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(planner)
    mosek = types.ModuleType("mosek")
    mosek.iparam = None  # type: ignore[attr-defined]
    sys.modules.update({"rrtplanner": planner, "mosek": mosek})
    sys.path.insert(0, str(checkout))
    mpp = importlib.import_module("ConvexMotionPlanning")


def paths_planner(paths: int) -> Planner:
    """The authors' MPP with this number of paths, or their baseline (0)."""

    def plan(drone: Any, grid: np.ndarray, commands: Commands, tick: int) -> Commands:
        level, elevator = level_flight(drone)
        so_far = commands.thrust, commands.elevator, commands.x, commands.z
        before = drone, grid, *so_far, level, commands.states
        after = THRUST, elevator, TICKS, tick
        if paths == 0:
            return Commands(*mpp.TrajGenRRT(*before, *after))
        return Commands(*mpp.TrajGenMPP(*before, *after, pathSamples=paths))

    return plan


def level_flight(drone: Any) -> tuple[list[float], float]:
    """The authors' state of level flight, and its elevator."""
    state = drone.coherentCommand(THRUST, 0.0)
    return state, drone.elevatorFromAlpha(state[1] - state[3])


def fly(seed: int, obstacles: int, plan: Planner) -> dict[str, Any]:
    """One flight of 20 s. As in the authors' notebook, any exception of the planner ends it."""
    from configurations import defaultConfig
    from Drone import Drone

    np.random.seed(seed)
    random.seed(seed)
    config = defaultConfig()
    config.numObstacles = obstacles
    drone = Drone(config, config)
    level, elevator = level_flight(drone)
    drone.reset(np.hstack(([0, 50], level)))
    look = drone.update_rays, drone.update_grid
    blind = (lambda: None), (lambda _rays: None)
    commands = Commands.of(THRUST, elevator, level)
    ended = None
    with contextlib.redirect_stdout(io.StringIO()):
        for tick in range(TICKS):
            replans = tick % REPLAN == 0
            drone.update_rays, drone.update_grid = look if replans else blind
            action = [commands.thrust[tick], commands.elevator[tick], commands.states[tick]]
            _, grid, _, over = drone.step(action)
            if over:
                ended = cause(drone)
            elif replans:
                try:
                    commands = plan(drone, grid, commands, tick)
                except Exception:  # noqa: BLE001 (the authors' rule)
                    ended = "exception"
            if ended:
                break
    return {"seed": seed, "obstacles": obstacles, "ticks": tick + 1, "ended": ended}


def cause(drone: Any) -> str:
    """The limit of the authors that ended a flight. The paper has no limits on speed and pitch rate."""
    x, z, speed, pitch, rate, slope = drone.plant.state
    centre_x, centre_z, radius = drone.objects
    plant = drone.plant
    limits = {
        "collision": bool(((centre_x - x) ** 2 + (centre_z - z) ** 2 < radius**2).any()),
        "pitch": abs(pitch) > plant.theta_thres,
        "flight path": abs(slope) > plant.gamma_thres,
        "pitch rate": abs(rate) > plant.theta_dot_thres,
        "speed": abs(speed) > plant.v_thres,
    }
    return next((name for name, passed in limits.items() if passed), "other")
