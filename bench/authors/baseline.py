"""The authors' baseline. Each of its differences from ours can be exchanged separately."""

import math
from functools import lru_cache
from typing import Any

import numpy as np
import scipy.optimize

import authors
import search
from authors import THRUST, TICKS, Commands, NoPath

CHANGES = {
    "gravity": "the sign of weight along the path is right, thrust stays",
    "reference": "steady climbs and descents at the speed of cruise, with the thrust and elevator they need",
    "paths": "the shortest of 25 paths of their RRT*-AR",
    "knots": "19 points, and lines between what they ask for",
}
HORIZON = 450
"""Length of a plan [ticks]."""
STAGES, STAGE_TICKS = 18, 25
PATHS = 25


def planner(changes: set[str]) -> authors.Planner:
    """The baseline with these changes. Without changes it flies as `TrajGenRRT` does."""

    def plan(drone: Any, grid: np.ndarray, _: Commands, tick: int) -> Commands:
        path = shortest_of_many(drone, grid) if "paths" in changes else search.straight_ahead(drone, grid)
        knots = "knots" in changes
        points, _ = authors.mpp.calculateReferencePoints(STAGES + 1 if knots else HORIZON + 1, path)
        rows, columns = np.diff(np.array(points), axis=0).T
        at = steady_flight(drone, frozenset(changes))
        wanted = np.array([at(round(slope, 9)) for slope in np.arctan2(rows, columns)])
        if knots:
            # The last point keeps the slope that led to it.
            wanted = np.vstack((wanted, wanted[-1]))
            stages = np.arange(HORIZON) / STAGE_TICKS
            wanted = np.array([np.interp(stages, np.arange(STAGES + 1), each) for each in wanted.T]).T
        level, elevator = authors.level_flight(drone)
        commands = Commands.of(THRUST, elevator, level)
        span = min(HORIZON - 1, TICKS - tick)
        commands.states[tick : tick + span] = wanted[:span, :4]
        commands.thrust[tick : tick + span] = wanted[:span, 4]
        commands.elevator[tick : tick + span] = wanted[:span, 5]
        return commands

    return plan


@lru_cache(maxsize=1)
def steady_flight(drone: Any, changes: frozenset[str]) -> Any:
    """Returns a function from slope to (airspeed, pitch, pitch rate, slope, thrust, elevator)."""
    cruise = authors.level_flight(drone)[0][0]
    weight = drone.m * drone.g

    def forces(attack: float, slope: float, speed: float, thrust: float) -> tuple[float, float]:
        """Forces along and across the path; both are 0 in steady flight [N]."""
        lift = drone.Cl_0 + drone.Cl_alpha * attack
        drag = drone.Cd_0 + drone.K * lift**2
        pressure = 0.5 * drone.rhoNom * speed**2 * drone.S
        along = thrust * math.cos(attack) - drag * pressure - weight * math.sin(slope)
        across = lift * pressure - weight * math.cos(slope) + thrust * math.sin(attack)
        return along, across

    @lru_cache(maxsize=None)
    def at(slope: float) -> tuple[float, ...]:
        speed, thrust = cruise, THRUST
        if "reference" in changes:
            zero = scipy.optimize.root(lambda x: forces(x[0], slope, cruise, x[1]), [0.0, THRUST])
            pitch, thrust = zero.x[0] + slope, max(zero.x[1], 0.0)
        elif "gravity" in changes:
            zero = scipy.optimize.root(lambda x: forces(x[0], slope, x[1], THRUST), [0.0, 15.0])
            pitch, speed = zero.x[0] + slope, zero.x[1]
        else:
            speed, pitch, _, _ = drone.coherentCommand(THRUST, slope)
        # The authors' code takes the pitch for the angle of attack.
        elevator = drone.elevatorFromAlpha(pitch - slope if "reference" in changes else pitch)
        return speed, pitch, 0.0, slope, thrust, elevator

    return at


def shortest_of_many(drone: Any, grid: np.ndarray) -> np.ndarray:
    """The shortest of 25 paths of the authors' RRT*-AR: segments by ends by (row, column)."""
    cells, column = search.window(drone, grid)
    middle, goal = search.HALF_HEIGHT, column + search.AHEAD
    goals = [[goal, height] for height in (middle, middle / 2, middle / 2, middle * 1.5)]
    paths: list[np.ndarray] = []
    for _ in range(100):
        _, *found = authors.mpp.RRTAR().runRRT(column, middle, 150, 2.5, 5, cells.T.astype(int), goals)
        paths += [np.array(path)[:, ::-1] for path in found]
        if len(paths) >= PATHS:
            break
    if not paths:
        raise NoPath
    best = min(paths[:PATHS], key=lambda path: np.hypot(*np.diff(path, axis=0).T).sum())
    return np.stack((best[:-1], best[1:]), axis=1)
