"""The authors' searches, compiled. The same draws give the same paths and hits to the last digit."""

import math
from typing import Any

import numba as nb
import numpy as np

from authors import NoPath

SAMPLES = 3000
REWIRE = 5.0
HALF_HEIGHT = 10
"""Rows of the search grid to either side of the aircraft."""
COLUMNS = 85
AHEAD = 54


def window(drone: Any, grid: np.ndarray) -> tuple[np.ndarray, int]:
    """The part of the grid that is searched, and the aircraft's column. Its row is the middle one."""
    column, row = drone.ogOrigin
    return np.ascontiguousarray(grid[row - HALF_HEIGHT : row + HALF_HEIGHT, :COLUMNS]), column


def straight_ahead(drone: Any, grid: np.ndarray) -> np.ndarray:
    """The path of the authors' baseline: segments by ends by (row, column).

    This is the method of `rrtplanner` 0.1.2. Nodes are cells, each taken once, and a new node looks for its
    best parent. The documented rewiring compares a cost with itself plus a length, so it never happens.
    """
    cells, column = window(drone, grid)
    free = np.argwhere(cells == 0)
    draws = free[np.random.choice(free.shape[0], SAMPLES)]
    start, goal = (HALF_HEIGHT, column), (HALF_HEIGHT, column + AHEAD)
    points = np.array(_search(cells, draws, start, goal)[::-1], dtype=float)
    if len(points) < 2:
        raise NoPath
    return np.stack((points[:-1], points[1:]), axis=1)


@nb.njit
def _search(cells, draws, start, goal):  # type: ignore[no-untyped-def]
    nodes = np.empty((SAMPLES + 1, 2), np.int64)
    costs = np.empty(SAMPLES + 1)
    parents = np.full(SAMPLES + 1, -1)
    taken = np.zeros(cells.shape, np.bool_)
    nodes[0] = start
    costs[0] = 0.0
    count = 1
    for row, column in draws:
        squares = (nodes[:count, 0] - row) ** 2 + (nodes[:count, 1] - column) ** 2
        best = np.argmin(squares)
        if taken[row, column] or count == SAMPLES:
            continue
        if not _is_clear(cells, nodes[best], (row, column)):
            continue
        taken[row, column] = True
        cost = costs[best] + math.sqrt(squares[best])
        for near in range(count):
            if squares[near] < REWIRE * REWIRE:
                other = costs[near] + math.sqrt(squares[near])
                if other < cost and _is_clear(cells, nodes[near], (row, column)):
                    best, cost = near, other
        nodes[count] = row, column
        costs[count] = cost
        parents[count] = best
        count += 1
    left = np.sqrt((nodes[:count, 0] - goal[0]) ** 2 + (nodes[:count, 1] - goal[1]) ** 2)
    for last in np.argsort(costs[:count] + left):
        if _is_clear(cells, nodes[last], goal):
            path = [goal]
            while last >= 0:
                path.append((nodes[last, 0], nodes[last, 1]))
                last = parents[last]
            return path
    return [start]


@nb.njit
def _is_clear(cells, start, end):  # type: ignore[no-untyped-def]
    """Checks the cells of Bresenham's line."""
    row, column = start[0], start[1]
    rows, columns = abs(end[0] - row), abs(end[1] - column)
    down = 1 if row < end[0] else -1
    right = 1 if column < end[1] else -1
    error = rows - columns
    while cells[row, column] == 0:
        if row == end[0] and column == end[1]:
            return True
        twice = 2 * error
        if twice >= -columns:
            error -= columns
            row += down
        if twice <= rows:
            error += rows
            column += right
    return False


def ray(origin: Any, direction: np.ndarray, grid: np.ndarray, limit: float = 10) -> np.ndarray:
    """The authors' `singleRay`, which changes zeros of the given direction."""
    direction[direction == 0] = 10**-8
    return _ray(np.array(origin, dtype=float), direction, grid, limit)


@nb.njit
def _ray(point, direction, grid, limit):  # type: ignore[no-untyped-def]
    inverse = 1 / direction
    travelled = 0.0
    while travelled < limit:
        step = math.inf
        for axis in range(2):
            if direction[axis] < 0:
                edge = math.ceil(point[axis] - 1)
            else:
                edge = math.floor(point[axis] + 1)
            step = min(step, (edge - point[axis]) * inverse[axis])
        point = step * direction + point
        if point[0] >= grid.shape[0] or point[1] >= grid.shape[1]:
            break
        if grid[int(point[0]), int(point[1])]:
            break
        travelled += step
    return np.floor(point)
