"""Output error for the closed roll loop: an autopilot that turns a bank that is missing into a roll rate, within limits.
`fit.py` says what goes in and comes out.
"""

from __future__ import annotations

from typing import Any

import numpy

from .identify import Floats, Value, given, intervals, least_squares, smooth, threadpool_limits

# Parameters with their bounds. Beyond the greatest bank and rate a limit counts as none [rad, rad/s].
LOOP = {
    "roll_loop.frequency": (0.5, 60.0), "roll_loop.damping": (0.05, 5.0), "roll_loop.delay": (1e-3, 0.3),
    "roll_loop.max_bank": (0.1, 1.4), "roll_loop.max_rate": (0.1, 20.0), "roll gain": (0.3, 3.0),
    "roll offset": (-0.5, 0.5), "start": (-1.5, 1.5), "start rate": (-5.0, 5.0),
}  # fmt: skip
BOUNDS = tuple(numpy.array(list(LOOP.values())).T)
LIMITS = ("roll_loop.max_bank", "roll_loop.max_rate")
# Time at a limit that tells it [s].
HELD = 0.3
# Step of the simulation [s], command that is a movement [rad], and what counts of the log around [s].
STEP, STILL, AROUND = 0.005, 0.08, 2.0


class Rolling:
    """Bank of the loop at the times of the log, for many sets of parameters side by side."""

    def __init__(self, log: dict[str, Floats], cruise: float) -> None:
        self.told, self.command = given(log, "roll_command")
        # Only where the command moves: a steady bank tells little, and each step takes its time.
        moves = self.told[abs(self.command - numpy.median(self.command)) > STILL]
        begin, end = (moves[0] - AROUND, moves[-1] + AROUND) if len(moves) else (-numpy.inf, numpy.inf)
        t, bank = given(log, "roll")
        there = (t >= begin) & (t <= end)
        self.t, self.bank = t[there], bank[there]
        self.times = numpy.arange(self.t[0], self.t[-1] + STEP, STEP)
        # Airspeed against cruise.
        self.pace = numpy.interp(self.times, t, smooth(numpy.interp(t, *given(log, "airspeed")), 0.3)) / cruise

    def commands(self, delay: float, most: float) -> Floats:
        """Mean of the command in each step, after a dead time and within a limit. It is smooth in both."""
        command = self.command.clip(-most, most)
        total = numpy.append(0.0, numpy.cumsum(numpy.diff(self.told) * (command[1:] + command[:-1]) / 2))
        edges = numpy.append(self.times, self.times[-1] + STEP) - delay
        before, after = numpy.minimum(edges - self.told[0], 0), numpy.maximum(edges - self.told[-1], 0)
        integral = numpy.interp(edges, self.told, total) + before * command[0] + after * command[-1]
        mean: Floats = numpy.diff(integral) / STEP
        return mean

    def simulate(self, sets: Floats, scheduled: bool) -> tuple[Floats, Floats]:
        """Bank by (step, set), and for how long either limit held [s], by (limit, set). If `scheduled`, the frequency grows with
        the airspeed."""
        frequency, damping, delay, most_bank, most_rate, gain, offset, bank, rate = sets.T.copy()
        commands = gain * numpy.array([self.commands(*it) for it in zip(delay, most_bank / gain, strict=True)]).T
        wanted = commands + offset
        w = frequency * (self.pace[:, None] if scheduled else numpy.ones_like(self.pace)[:, None])
        stiffness, drag = w * w, 2 * damping * w
        most = drag * most_rate
        least, way = -most, numpy.empty_like(wanted)
        for k, target in enumerate(wanted):
            way[k] = bank
            # Heun's method.
            push = stiffness[k] * (target - bank)
            first = numpy.minimum(numpy.maximum(push, least[k]), most[k]) - drag[k] * rate
            later = rate + STEP * first
            push -= STEP * stiffness[k] * rate
            second = numpy.minimum(numpy.maximum(push, least[k]), most[k]) - drag[k] * later
            bank = bank + STEP / 2 * (rate + later)
            rate = rate + STEP / 2 * (first + second)
        held = [(abs(commands) > 0.999 * most_bank).sum(axis=0), (abs(stiffness * (wanted - way)) > most).sum(axis=0)]
        return way, STEP * numpy.array(held)

    def residuals(self, sets: Floats, scheduled: bool) -> Floats:
        """Differences from the measured bank, by (set, row)."""
        way, _ = self.simulate(sets, scheduled)
        return numpy.array([numpy.interp(self.t, self.times, it) for it in way.T]) - self.bank

    def guesses(self) -> list[Floats]:
        """Of a grid the best sets, one for each greatest rate. The cost has valleys a swing apart, and others with a limit and
        without."""
        fast = float(abs(numpy.diff(self.bank) / numpy.diff(self.t)).max())
        slow = float(abs(numpy.gradient(smooth(numpy.interp(self.times, self.t, self.bank), 0.1), STEP)).max())
        far = float(numpy.percentile(abs(self.bank), 99.5))
        low, high = BOUNDS
        scan = numpy.array([
            (w, 0.8, delay, bank, rate, 1.0, 0.0, self.bank[0], 0.0) for rate in (20.0, slow, min(1.3 * slow, fast))
            for w in (2.0, 3.5, 6.0, 10.0, 16.0) for delay in numpy.linspace(0.0, 0.28, 8) for bank in (1.4, far)
        ])  # fmt: skip
        sets = scan.clip(low + 1e-6, high - 1e-6)
        cost = (self.residuals(sets, False) ** 2).sum(axis=1).reshape(3, -1)
        return list(sets.reshape(3, -1, len(LOOP))[range(3), cost.argmin(axis=1)])

    def fit(self, start: Floats, scheduled: bool) -> Any:
        """The nearest minimum. Steps of the derivatives are wide: limits that begin to hold in one step or the next make the cost
        rough."""
        last, slopes = numpy.empty(0), numpy.empty(0)

        def residual(p: Floats) -> Floats:
            # All sets at once cost little more than one.
            nonlocal last, slopes
            last = p.copy()
            steps = numpy.diag(1e-2 * numpy.maximum(abs(p), 0.1))
            base: Floats
            base, *moved = self.residuals(numpy.vstack([p, p + steps, p - steps]), scheduled)
            more, less = numpy.split(numpy.array(moved), 2)
            slopes = ((more - less) / (2 * numpy.diag(steps)[:, None])).T
            return base

        def jacobian(p: Floats) -> Floats:
            if not numpy.array_equal(p, last):
                residual(p)
            return slopes

        tolerances = {"xtol": 1e-5, "ftol": 1e-5, "max_nfev": 40}
        return least_squares(residual, start, jacobian, BOUNDS, x_scale="jac", **tolerances)


@threadpool_limits.wrap(limits=1)  # type: ignore[untyped-decorator]
def roll_loop(log: dict[str, Floats], cruise: float) -> dict[str, Value]:
    """The closed roll loop. Its frequency is constant or grows with the airspeed, whatever fits better. A limit that never held
    is the greatest value flown, and its interval is no number."""
    rolling = Rolling(log, cruise)
    best = min((rolling.fit(start, False) for start in rolling.guesses()), key=lambda it: it.cost)
    scheduled = False
    if numpy.ptp(rolling.pace) > 0.1:
        other = rolling.fit(best.x, True)
        scheduled = other.cost < best.cost
        best = other if scheduled else best
    halves = intervals(best.jac, [best.fun], len(LOOP))
    values = {name: Value(*pair) for name, *pair in zip(LOOP, best.x.tolist(), halves.tolist(), strict=True) if "start" not in name}
    way, held = rolling.simulate(best.x[None], scheduled)
    flown = abs(way[:, 0]).max(), abs(numpy.diff(way[:, 0]) / STEP).max()
    for name, time, reached in zip(LIMITS, held[:, 0], flown, strict=True):
        if time < HELD:
            values[name] = Value(float(numpy.clip(reached, *LOOP[name])), numpy.nan)
    return values
