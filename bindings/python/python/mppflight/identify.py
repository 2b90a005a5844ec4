"""Output error: simulates the aircraft's own equations of motion and brings them to a log by least squares. `fit.py` says
what goes in and comes out.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy
from numpy.typing import NDArray

from .errors import InputError

try:
    from scipy.optimize import least_squares as least_squares  # type: ignore[import-untyped]
    from scipy.signal import cont2discrete, lfilter  # type: ignore[import-untyped]
    from threadpoolctl import threadpool_limits as threadpool_limits  # type: ignore[import-untyped]
except ImportError as error:
    raise ImportError("mppflight.fit needs SciPy and threadpoolctl: pip install 'mppflight[fit]'") from error

Floats = NDArray[numpy.float64]

GRAVITY = 9.81
# Steps of the inputs and of the equations of motion [s], length of a stretch, and greatest delay of a sensor.
FINE, STEP, STRETCH, LATEST = 0.01, 0.02, 10.0, 0.3
# Bank up to which the equations of the vertical plane count [rad].
LEVEL = 0.2
# What is compared, and its error before the first fit.
MEASURED = {"airspeed": 0.5, "climb": 0.5, "z": 0.5, "ax": 0.5, "az": 0.5}
# What the roll loop needs.
ROLL = ("roll", "roll_command")
# Parameters with the bounds and steps of their derivatives; then initial airspeed and path of each stretch.
MOTION = {
    "lift.zero": (-5.0, 5.0, 1e-4), "lift.alpha": (0.2, 20.0, 1e-3), "drag.zero": (0.0, 5.0, 1e-5),
    "drag.induced": (0.0, 5.0, 1e-5), "thrust.max": (1e-3, 1e7, 1e-3), "thrust.lag": (2e-3, 5.0, 1e-4),
    "airspeed delay": (-LATEST, LATEST, 1e-3), "climb delay": (-LATEST, LATEST, 1e-3),
    "acceleration delay": (-LATEST, LATEST, 1e-3), "ax bias": (-3.0, 3.0, 1e-3), "az bias": (-3.0, 3.0, 1e-3),
    "airspeed bias": (-5.0, 5.0, 1e-3),
}  # fmt: skip
# Interval of the airspeed's bias beyond which it counts as none [m/s].
UNKNOWN = 0.4
LOOP = {
    "pitch_loop.frequency": (0.5, 60.0), "pitch_loop.damping": (0.05, 5.0), "pitch_loop.delay": (1e-3, 0.3),
    "gain": (0.3, 3.0), "offset": (-0.5, 0.5), "start": (-1.5, 1.5), "start rate": (-5.0, 5.0),
}  # fmt: skip


@dataclass(frozen=True)
class Value:
    """A parameter and half the width of its interval of 95 %."""

    value: float
    half: float


@dataclass(frozen=True)
class Known:
    """What no log tells."""

    mass: float
    wing_area: float
    air_density: float = 1.225
    cruise: float | None = None
    # Of the wing, for the roll loop [m].
    span: float | None = None


def given(log: dict[str, Floats], name: str) -> tuple[Floats, Floats]:
    """Times and values of a sensor or command, without the empty cells."""
    there = numpy.isfinite(log[name])
    if there.sum() < 50:
        raise InputError(f"log: `{name}` has {there.sum()} values: give 50 or more")
    return log["t"][there], log[name][there]


def _held(log: dict[str, Floats], name: str, edges: Floats) -> Floats:
    """Mean of a command between each two times. It is smooth in them."""
    t, value = given(log, name)
    total = numpy.concatenate([[0.0], numpy.cumsum(numpy.diff(t) * (value[1:] + value[:-1]) / 2)])
    integral = numpy.interp(edges, t, total)
    integral += numpy.minimum(edges - t[0], 0) * value[0] + numpy.maximum(edges - t[-1], 0) * value[-1]
    mean: Floats = numpy.diff(integral) / numpy.diff(edges)
    return mean


def smooth(value: Floats, time: float) -> Floats:
    """Without what is faster than a time [s], and without a delay."""
    keep = numpy.exp(-FINE / time)
    for _ in range(2):
        value = lfilter([1 - keep], [1, -keep], value, zi=[keep * value[0]])[0][::-1]
    return value


def intervals(jacobian: Floats, residuals: list[Floats], count: int) -> Floats:
    """Half the intervals of 95 % of the first parameters, of residuals that are coloured by sensor."""
    inverse = numpy.linalg.pinv(jacobian.T @ jacobian)
    middle, row = numpy.zeros_like(inverse), 0
    for part in residuals:
        own = jacobian[row : row + len(part)]
        row += len(part)
        power = numpy.abs(numpy.fft.rfft(part - part.mean(), 2 * len(part))) ** 2
        correlation = numpy.fft.irfft(power)[: len(part)]
        correlation = correlation / max(correlation[0], 1e-300)
        first = int(numpy.argmax(correlation <= 0)) or len(part)
        middle += own.T @ own * (2 * correlation[:first].sum() - 1) * (part**2).mean()
    halves: Floats = 1.96 * numpy.sqrt(numpy.diag(inverse @ middle @ inverse)[:count].clip(0))
    return halves


@dataclass(frozen=True)
class Loop:
    """The closed pitch loop, and the pitch that was flown at fine times."""

    values: dict[str, Value]
    times: Floats
    pitch: Floats
    cost: float
    scheduled: bool


def pitch_loop(log: dict[str, Floats], cruise: float, scheduled: bool) -> Loop:
    """The closed pitch loop. If `scheduled`, its frequency grows with the airspeed, as that of moments of the air does: it is
    constant in a time that passes with the airspeed."""
    t, pitch = given(log, "pitch")
    times = numpy.arange(t[0], t[-1], FINE)
    airspeed = smooth(numpy.interp(times, *given(log, "airspeed")), 0.3)
    pace = airspeed / cruise if scheduled else numpy.ones_like(times)
    passed = numpy.append(0.0, FINE * numpy.cumsum(pace))
    grid = numpy.arange(0.0, passed[-1] - FINE, FINE)
    edges, seen = numpy.interp(grid, passed, numpy.append(times, t[-1])), numpy.interp(t, times, passed[:-1])

    def flown(p: Floats) -> Floats:
        frequency, damping, delay, gain, offset, start, rate = p
        command = gain * _held(log, "pitch_command", numpy.append(edges, edges[-1] + FINE) - delay) + offset
        plain = [frequency**2], [1.0, 2 * damping * frequency, frequency**2]
        top, below, _ = cont2discrete(plain, FINE)
        # Impulses make the free motion: from the start, and from a step later.
        impulses = numpy.zeros_like(grid)
        impulses[:2] = start, start + FINE * rate + below[1] * start
        angle: Floats = command[0] + lfilter(top.ravel(), below, command - command[0]) + lfilter([1.0], below, impulses)
        return angle

    def residual(p: Floats) -> Floats:
        gap: Floats = numpy.interp(seen, grid, flown(p)) - pitch
        return gap

    low, high = numpy.array(list(LOOP.values())).T
    # The cost has valleys a swing apart: begin in the lowest of a grid.
    start = pitch[0] - given(log, "pitch_command")[1][0]
    scan = [(w, delay) for w in (2.0, 3.5, 6.0, 10.0, 16.0) for delay in numpy.linspace(0.0, 0.28, 8)]
    firsts = [numpy.array([w, 0.8, delay, 1.0, 0.0, start, 0.0]).clip(low + 1e-6, high - 1e-6) for w, delay in scan]
    first = min(firsts, key=lambda p: float((residual(p) ** 2).sum()))
    best = least_squares(residual, first, bounds=(low, high), x_scale="jac", diff_step=1e-4)
    halves = intervals(best.jac, [best.fun], len(LOOP))
    values = {name: Value(*pair) for name, *pair in zip(LOOP, best.x.tolist(), halves.tolist(), strict=True)}
    # Slow differences from the loop are gusts, which the wing feels. Fast ones are noise.
    rest = smooth(numpy.interp(times, t, -best.fun), 0.1)
    return Loop(values, times, numpy.interp(passed[:-1], grid, flown(best.x)) + rest, float(best.cost), scheduled)


class Motion:
    """Airspeed and flight path in stretches of the log, for many sets of parameters side by side."""

    def __init__(self, log: dict[str, Floats], known: Known, times: Floats, pitch: Floats) -> None:
        self.known, self.pitch = known, pitch
        self.throttle = _held(log, "throttle", numpy.append(times, times[-1] + FINE))
        count = int((times[-1] - times[0] - 2 * LATEST) // STRETCH)
        length = (times[-1] - times[0] - 2 * LATEST) / count
        # A stretch starts early and ends late enough for delayed sensors.
        self.steps = int((length + 2 * LATEST) / STEP)
        begin = ((length * numpy.arange(count)) / FINE).astype(int)
        if "roll" in log:
            bank = abs(numpy.interp(times, *given(log, "roll")))
            level = numpy.array([bank[it : it + 2 * self.steps + 1].max() < LEVEL for it in begin])
        else:
            level = numpy.ones(count, dtype=bool)
        if not level.any():
            raise InputError(f"log: give {STRETCH:.0f} s or more in which the bank stays below {LEVEL} rad")
        begin = begin[level]
        self.at = begin[:, None] + numpy.arange(2 * self.steps + 1)
        self.starts = times[begin]
        self.seen = {}
        for name in MEASURED:
            if name in log and not (name == "z" and "climb" in log):
                t, value = given(log, name)
                stretch = numpy.floor((t - times[0] - LATEST) / length).astype(int)
                there = (stretch >= 0) & (stretch < count)
                there[there] &= level[stretch[there]]
                self.seen[name] = t[there], value[there], numpy.cumsum(level)[stretch[there]] - 1
        self.deviation = {name: MEASURED[name] for name in self.seen}

    def first(self) -> Floats:
        """A guess to begin with: a usual wing, and level flight on the whole."""
        t, airspeed, _ = self.seen["airspeed"]
        speed, path = float(numpy.median(airspeed)), numpy.zeros(len(self.starts))
        load = 2 * self.known.mass * GRAVITY / (self.known.air_density * self.known.wing_area * speed**2)
        thrust = self.known.mass * GRAVITY / 8 / max(float(self.throttle.mean()), 0.05)
        wing = [load - 5 * float(numpy.median(self.pitch)), 5.0, 0.04, 0.05]
        starts = numpy.interp(self.starts, t, airspeed)
        return numpy.concatenate([wing, [thrust, 0.2], numpy.zeros(6), starts, path])

    def simulate(self, p: Floats) -> dict[str, Floats]:
        """Outputs by (set, stretch, step)."""
        sets, count, known = len(p), len(self.starts), self.known
        wing = p[:, :4].T[:, :, None]
        lag = numpy.exp(-FINE / p[:, 5])
        follow = [lfilter([1 - a], [1, -a], self.throttle, zi=[a * self.throttle[0]])[0] for a in lag]
        thrust = (p[:, 4, None] * numpy.array(follow))[:, self.at]
        pitch = self.pitch[self.at]
        area, weight = 0.5 * known.air_density * known.wing_area / known.mass, GRAVITY

        def forces(v: Floats, path: Floats, pitch: Floats, wing: Any = wing) -> tuple[Floats, Floats, Floats]:
            alpha = pitch - path
            lift = wing[0] + wing[1] * alpha
            return alpha, area * v * v * lift, area * v * v * (wing[2] + wing[3] * lift * lift)

        def rate(v: Floats, path: Floats, k: int) -> tuple[Floats, Floats]:
            alpha, lift, drag = forces(v, path, pitch[:, k])
            pull = thrust[:, :, k] / known.mass
            sideways = (lift + pull * numpy.sin(alpha) - weight * numpy.cos(path)) / v
            return pull * numpy.cos(alpha) - drag - weight * numpy.sin(path), sideways

        v, path = p[:, -2 * count : -count].copy(), p[:, -count:].copy()
        states = numpy.empty((2, sets, count, self.steps + 1))
        for k in range(self.steps):
            states[:, :, :, k] = v, path
            # Heun's method; the inputs of half steps stand between.
            v1, path1 = rate(v, path, 2 * k)
            v2, path2 = rate(v + STEP / 2 * v1, path + STEP / 2 * path1, 2 * k + 1)
            v, path = (v + STEP * v2).clip(2.0, 400.0), (path + STEP * path2).clip(-1.4, 1.4)
        states[:, :, :, -1] = v, path
        speed, angle = states
        alpha, lift, drag = forces(speed, angle, pitch[:, ::2], wing[..., None])
        sin, cos, climb = numpy.sin(alpha), numpy.cos(alpha), speed * numpy.sin(angle)
        ahead = thrust[:, :, ::2] / known.mass - drag * cos + lift * sin + p[:, 9, None, None]
        down = -(lift * cos + drag * sin) + p[:, 10, None, None]
        height = numpy.cumsum(climb, axis=2) * STEP
        return {"airspeed": speed + p[:, 11, None, None], "climb": climb, "z": height, "ax": ahead, "az": down}

    def residuals(self, p: Floats) -> list[list[Floats]]:
        """Weighted differences, by set and sensor."""
        outputs = self.simulate(p)
        return [[self._compared(name, outputs[name][k], row) for name in self.seen] for k, row in enumerate(p)]

    def _compared(self, name: str, output: Floats, p: Floats) -> Floats:
        t, value, stretch = self.seen[name]
        delay = {"airspeed": p[6], "climb": p[7], "z": p[7], "ax": p[8], "az": p[8]}[name]
        place = ((t - delay - self.starts[stretch]) / STEP).clip(0, self.steps - 1e-9)
        whole = place.astype(int)
        share = place - whole
        gap = output[stretch, whole] * (1 - share) + output[stretch, whole + 1] * share - value
        if name == "z":
            gap -= (numpy.bincount(stretch, gap) / numpy.bincount(stretch).clip(1))[stretch]
        weighted: Floats = gap / self.deviation[name]
        return weighted

    def jacobian(self, p: Floats) -> Floats:
        """Derivatives of the residuals. The starts of all stretches move at once, each in its own rows."""
        count, fixed = len(self.starts), len(MOTION)
        steps = numpy.array([step for _, _, step in MOTION.values()] + [1e-3, 1e-4])
        sets = numpy.tile(p, (fixed + 3, 1))
        for k in range(fixed):
            sets[k + 1, k] += steps[k]
        sets[fixed + 1, fixed : fixed + count] += steps[fixed]
        sets[fixed + 2, fixed + count :] += steps[fixed + 1]
        base, *moved = [numpy.concatenate(it) for it in self.residuals(sets)]
        slopes = [(it - base) / step for it, step in zip(moved, steps, strict=True)]
        own = numpy.concatenate([it[2] for it in self.seen.values()])[:, None] == numpy.arange(count)
        return numpy.column_stack([*slopes[:fixed], slopes[fixed][:, None] * own, slopes[fixed + 1][:, None] * own])

    def fit(self, airspeed_bias: float) -> dict[str, Value]:
        """The parameters, with this greatest bias of the airspeed [m/s]. The errors of the sensors are taken from what the
        first fits leave over."""
        p, count = self.first(), len(self.starts)
        bounds = [*((low, high) for low, high, _ in MOTION.values()), *[(3.0, 300.0)] * count, *[(-1.2, 1.2)] * count]
        low, high = numpy.array(bounds).T
        low[len(MOTION) - 1], high[len(MOTION) - 1] = -airspeed_bias, airspeed_bias

        def residual(p: Floats) -> Floats:
            return numpy.concatenate(self.residuals(p[None])[0])

        for _ in range(3):
            inside = p.clip(low + 1e-7, high - 1e-7)
            p = least_squares(residual, inside, self.jacobian, (low, high), x_scale="jac", xtol=1e-5, ftol=1e-6).x
            for name, left in zip(self.seen, self.residuals(p[None])[0], strict=True):
                self.deviation[name] *= max(float(numpy.sqrt((left**2).mean())), 1e-3)
        halves = intervals(self.jacobian(p), self.residuals(p[None])[0], len(MOTION))
        return {name: Value(*pair) for name, *pair in zip(MOTION, p.tolist(), halves.tolist(), strict=False)}


@threadpool_limits.wrap(limits=1)  # type: ignore[untyped-decorator]
def estimate(log: dict[str, Floats], known: Known) -> dict[str, Value]:
    """All parameters of a log. Matrices are small: threads of the linear algebra would only wait for each other."""
    cruise = known.cruise or float(numpy.nanmedian(log["airspeed"]))
    loop = min((pitch_loop(log, cruise, scheduled) for scheduled in (False, True)), key=lambda it: it.cost)
    simulated = Motion(log, known, loop.times, loop.pitch)
    motion = simulated.fit(5.0)
    if motion["airspeed bias"].half > UNKNOWN:
        # Gusts hide it, and it would spoil the rest.
        motion = simulated.fit(1e-6)
    # Once more, by the airspeed without its bias and delay.
    t, airspeed = given(log, "airspeed")
    later = numpy.interp(log["t"] + motion["airspeed delay"].value, t, airspeed)
    true = log | {"airspeed": later - motion["airspeed bias"].value}
    return pitch_loop(true, cruise, loop.scheduled).values | motion
