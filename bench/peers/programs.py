"""Programs as `bench qp --export` writes them, in the forms that solvers take, and their margins."""

import json
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.optimize import linprog

Array = NDArray[np.float64]

STAGES, STATES, CONTROLS = 18, 6, 2
KNOTS = STAGES + 1
X, Z, PITCH, FLIGHT_PATH = 0, 1, 3, 5
THRUST = 1
UNBOUNDED = 1e30
"""A bound that DAQP takes for none."""
TIE = 1e-7
"""A margin nearer to zero than this is a tie: neither verdict is wrong."""


@dataclass(frozen=True)
class Full:
    """Full form: min v'Pv/2 + q'v, A v = b, G v <= h, v = (x_0, u_0, x_1, ..., x_18)."""

    P: sparse.csc_matrix
    q: Array
    A: sparse.csc_matrix
    b: Array
    G: sparse.csc_matrix
    h: Array

    @staticmethod
    def controls(solution: Array) -> Array:
        """The controls among the variables of a solution."""
        stages = np.asarray(solution)[:-STATES].reshape(STAGES, STATES + CONTROLS)
        return stages[:, STATES:].ravel()


@dataclass(frozen=True)
class Condensed:
    """Form without states: min u'Hu/2 + f'u, G u <= h, u = (u_0, ..., u_17); all dense."""

    H: Array
    f: Array
    G: Array
    h: Array

    @cached_property
    def inverse_factor(self) -> Array:
        """The inverse of the upper triangular R with H = R'R."""
        return np.linalg.inv(np.linalg.cholesky(self.H)).T


@dataclass(frozen=True)
class TwoSided:
    """Condensed form whose opposite rows are one: min u'Hu/2 + f'u, lower <= G u <= upper."""

    H: Array
    f: Array
    G: Array
    lower: Array
    upper: Array


@dataclass(frozen=True)
class Stages:
    """Rows of the full form as a solver for stages wants them: lower <= rows v <= upper, dynamics before the others of a stage."""

    rows: sparse.csc_matrix
    lower: Array
    upper: Array
    counts: list[int]
    """Number of inequality rows of each knot."""


class Program:
    """One program."""

    def __init__(self, line: str) -> None:
        """Reads a program from a line of an export."""
        self.record: dict[str, Any] = json.loads(line)
        record = self.record
        self.name: str = record["name"]
        self.soft = record["penalty"] is not None
        self.a, self.b, self.offset = (_stages(record[name]) for name in ("a", "b", "offset"))
        self.control_weight = np.tile(record["control_weight"], STAGES)
        self.terminal_weight: float = record["terminal_weight"]
        self.initial, self.target = np.array(record["initial"]), np.array(record["target"])
        rows = [row for row in _rows(record) if row[2] is not None and np.isfinite(row[2])]
        self.state_rows = np.array([row[0].ravel() for row in rows])
        self.control_rows = np.array([row[1].ravel() for row in rows])
        self.bounds = np.array([row[2] for row in rows], dtype=float)

    @cached_property
    def full(self) -> Full:
        """The full form."""
        count = KNOTS * STATES + STAGES * CONTROLS
        places = np.arange(count + CONTROLS).reshape(KNOTS, STATES + CONTROLS)
        x, u = places[:, :STATES], places[:-1, STATES:].ravel()
        diagonal, linear = np.zeros(count), np.zeros(count)
        diagonal[u] = self.control_weight
        diagonal[x[-1]] = self.terminal_weight
        linear[x[-1]] = -self.terminal_weight * self.target
        dynamics = np.zeros((KNOTS * STATES, count))
        dynamics[:STATES, x[0]] = np.eye(STATES)
        for stage in range(STAGES):
            rows = slice((stage + 1) * STATES, (stage + 2) * STATES)
            dynamics[rows, x[stage]] = self.a[stage]
            dynamics[rows, places[stage, STATES:]] = self.b[stage]
            dynamics[rows, x[stage + 1]] = -np.eye(STATES)
        right = np.concatenate([self.initial, -self.offset.ravel()])
        inequalities = np.zeros((len(self.bounds), count))
        inequalities[:, x.ravel()] = self.state_rows
        inequalities[:, u] = self.control_rows
        return Full(
            sparse.csc_matrix(np.diag(diagonal)), linear, sparse.csc_matrix(dynamics), right,
            sparse.csc_matrix(inequalities), self.bounds,
        )

    @cached_property
    def stages(self) -> Stages:
        """The rows of the full form by stage, without those of the first state."""
        form = self.full
        A, G = form.A.tocsr(), form.G.tocsr()
        knots = np.array([G[row].indices.min() // (STATES + CONTROLS) for row in range(len(form.h))])
        rows, lower, upper = [], [], []
        for knot in range(KNOTS):
            dynamics = slice((knot + 1) * STATES, (knot + 2) * STATES)
            own = np.flatnonzero(knots == knot)
            rows += [A[dynamics], G[own]]
            lower += [form.b[dynamics], np.full(len(own), -np.inf)]
            upper += [form.b[dynamics], form.h[own]]
        counts = [int(np.sum(knots == knot)) for knot in range(KNOTS)]
        return Stages(sparse.vstack(rows, "csc"), np.concatenate(lower), np.concatenate(upper), counts)

    @cached_property
    def condensed(self) -> Condensed:
        """The condensed form."""
        free, forced = self._response
        miss, reach = free[-STATES:] - self.target, forced[-STATES:]
        return Condensed(
            np.diag(self.control_weight) + self.terminal_weight * reach.T @ reach,
            self.terminal_weight * reach.T @ miss,
            self.state_rows @ forced + self.control_rows,
            self.bounds - self.state_rows @ free,
        )

    @cached_property
    def two_sided(self) -> TwoSided:
        """The condensed form whose opposite rows are one."""
        form = self.condensed
        # The recorded directions are opposite to within rounding, which is far below the tolerance of answers. Adding 0
        # makes every zero positive, so that equal rows have equal bytes.
        factors = np.round(np.hstack([self.state_rows, self.control_rows]), 13) + 0.0
        kept: dict[bytes, int] = {}
        lower = np.full(len(form.h), -UNBOUNDED)
        for index, row in enumerate(factors):
            other = kept.get((0.0 - row).tobytes())
            if other is None:
                kept[row.tobytes()] = index
            else:
                lower[other] = -form.h[index]
        rows = list(kept.values())
        return TwoSided(form.H, form.f, np.ascontiguousarray(form.G[rows]), lower[rows], form.h[rows])

    @cached_property
    def _response(self) -> tuple[Array, Array]:
        """All states without control, and their changes by each control."""
        free, forced = [self.initial], [np.zeros((STATES, STAGES * CONTROLS))]
        for stage in range(STAGES):
            free.append(self.a[stage] @ free[-1] + self.offset[stage])
            gain = self.a[stage] @ forced[-1]
            gain[:, stage * CONTROLS : (stage + 1) * CONTROLS] += self.b[stage]
            forced.append(gain)
        return np.concatenate(free), np.concatenate(forced)

    @cached_property
    def feasible(self) -> bool | None:
        """Whether the rows can hold together; `None` for a tie."""
        return None if abs(self.margin) < TIE else self.margin < 0.0

    @cached_property
    def margin(self) -> float:
        """The least t by which all rows must be relaxed to hold: the recorded one, or else that of HiGHS."""
        if self.record["margin"] is not None:
            return float(self.record["margin"])
        form = self.full
        objective = np.append(np.zeros(len(form.q)), 1.0)
        rows = sparse.hstack([form.G, np.full((len(form.h), 1), -1.0)])
        equal = sparse.hstack([form.A, np.zeros((len(form.b), 1))])
        result = linprog(objective, rows, form.h, equal, form.b, bounds=(None, None))
        if not result.success:
            raise ValueError(f"{self.name}: no margin: {result.message}")
        return float(result.fun)

    def judge(self, controls: Array) -> tuple[float, float]:
        """Cost of controls, and the worst violation of a row when the dynamics follow these controls."""
        free, forced = self._response
        states = free + forced @ controls
        miss = states[-STATES:] - self.target
        cost = controls @ (self.control_weight * controls) + self.terminal_weight * (miss @ miss)
        excess = self.state_rows @ states + self.control_rows @ controls - self.bounds
        return 0.5 * float(cost), max(0.0, float(excess.max(initial=0.0)))


def read_programs(path: Path, limit: int | None) -> list[Program]:
    """Reads the first programs of an export, or all of them without a limit."""
    lines = [line for line in path.read_text(encoding="utf-8").splitlines() if line.strip()]
    return [Program(line) for line in lines[:limit]]


def _stages(given: list[Any]) -> Array:
    """Returns one array for each stage. A single array holds for all stages."""
    stages = np.array(given)
    return np.broadcast_to(stages, (STAGES, *stages.shape[1:]))


def _rows(record: dict[str, Any]) -> Iterator[tuple[Array, Array, float | None]]:
    """Inequality rows: factors of states [19][6] and of controls [18][2], bound (`None`: no row)."""

    def row() -> tuple[Array, Array]:
        return np.zeros((KNOTS, STATES)), np.zeros((STAGES, CONTROLS))

    for knot, bounds in enumerate(record["position_bounds"]):
        for direction, bound in zip(record["directions"], bounds, strict=True):
            states, controls = row()
            states[knot, [X, Z]] = direction
            yield states, controls, bound
    if record["attitude"] is not None:
        upper, lower = record["attitude"]
        for knot in range(1, KNOTS):
            for sign, limits in ((1.0, upper), (-1.0, lower)):
                attack, climb = row(), row()
                attack[0][knot, [PITCH, FLIGHT_PATH]] = sign, -sign
                climb[0][knot, FLIGHT_PATH] = sign
                yield *attack, sign * limits[0]
                yield *climb, sign * limits[1]
    for stage in range(STAGES):
        for sign, bound in ((1.0, record.get("thrust_rise")), (-1.0, record["thrust_reserve"])):
            states, controls = row()
            controls[stage, THRUST] = sign
            yield states, controls, bound
