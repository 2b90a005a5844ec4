"""Takes the derivatives of JSBSim's aircraft by central differences and writes aircraft files:
`python3 fit.py [NAME ..]`."""

import json
import math
import sys
from pathlib import Path

import jsbsim
import numpy as np
from plane import AIRCRAFT, FOOT, SLUG, TICK, Plane

FOLDER = Path(__file__).parent / "aircraft"
# Sizes of the differences, as far from level flight as plans go: 0.8 g change the angle of attack by about this.
STEPS = {"alpha": 0.05, "pitch_rate": 0.1, "elevator": 0.05}  # rad, rad/s, rad
LOADS = np.linspace(0.2, 1.8, 9)  # load factors of the drag polar
THROTTLES = [n / 10 for n in range(11)]
AIRSPEEDS = [0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2, 1.3, 1.4]  # of the cruise


class Coefficients:
    """Coefficients of a plane in the states about its level flight."""

    def __init__(self, plane: Plane):
        plane.settle()
        fdm = plane.fdm
        self.plane, self.alpha, self.elevator, self.throttle = plane, plane.alpha, plane.elevator, plane.throttle
        self.thrust = plane.thrust
        self.area, self.chord = fdm["metrics/Sw-sqft"] * FOOT**2, fdm["metrics/cbarw-ft"] * FOOT
        self.mass = fdm["inertia/mass-slugs"] * SLUG
        self.inertia = fdm["inertia/iyy-slugs_ft2"] * SLUG * FOOT**2
        self.density = fdm["atmosphere/rho-slugs_ft3"] * SLUG / FOOT**3

    def at(self, alpha: float = 0.0, pitch_rate: float = 0.0, elevator: float = 0.0, roll: float = 0.0):
        """Regressors, and coefficients of lift, drag and moment, that far from level flight."""
        plane, fdm = self.plane, self.plane.fdm
        deflection = self.elevator + elevator
        least, most = plane.elevator_range
        fdm["fcs/elevator-cmd-norm"] = deflection / (most if deflection > 0.0 else -least)
        plane.throttle = self.throttle
        plane.place(plane.cruise, self.alpha + alpha, pitch_rate, roll)
        force = fdm["aero/qbar-psf"] * fdm["metrics/Sw-sqft"]
        moment = fdm["moments/m-aero-lbsft"] + fdm["moments/m-prop-lbsft"]
        time = self.chord / (2 * plane.cruise)
        row = [1.0, alpha, elevator, fdm["velocities/q-aero-rad_sec"] * time,
               fdm["aero/alphadot-rad_sec"] * time]
        return row, [fdm["forces/fsz-aero-lbs"] / force, fdm["forces/fsx-aero-lbs"] / force,
                     moment / (force * self.chord / FOOT)]

    def derivatives(self) -> dict[str, np.ndarray]:
        """Lift, drag and moment at level flight, and their derivatives."""
        states = [{key: sign * step} for key, step in STEPS.items() for sign in (-1, 1)]
        # In a bank less of the weight bends the path down: this tells the rate of alpha from the pitch rate.
        states += [{"roll": sign * math.pi / 3} for sign in (-1, 1)]
        rows, values = zip(*(self.at(**state) for state in [{}, *states]))
        slopes = np.linalg.lstsq(np.array(rows), np.array(values), rcond=None)[0][1:]
        # Level flight itself is kept, where the curves bend.
        return dict(zip(("level", "alpha", "elevator", "pitch_rate", "alpha_rate"), [np.array(values[0]), *slopes]))

    def drag(self, derivatives: dict[str, np.ndarray]) -> tuple[float, float]:
        """Parasitic drag, and factor on the squared lift, with the elevator in balance."""
        level, values = derivatives["level"], []
        effects = np.array([[derivatives[key][axis] for key in ("alpha", "elevator")] for axis in (0, 2)])
        for load in LOADS:
            alpha, elevator = np.linalg.solve(effects, [(load - 1) * level[0], 0.0])
            values.append(self.at(alpha=alpha, elevator=elevator)[1])
        lift, drag, _ = np.array(values).T
        factor, zero = np.polyfit(lift**2, drag, 1)
        return zero, factor

    def stall(self) -> float | None:
        """Angle of attack of the greatest lift [rad], if there is one below 0.4 rad."""
        angles = np.arange(self.alpha, 0.4, 0.005)
        lifts = [self.at(alpha=angle - self.alpha)[1][0] for angle in angles]
        best = int(np.argmax(lifts))
        return float(angles[best]) if best < len(angles) - 1 else None


def steady_thrust(plane: Plane, airspeed: float, throttle: float, alpha: float) -> list[float]:
    """Thrust over 8 s at a held airspeed, tick by tick [N]."""
    trace, plane.throttle = [], throttle
    for _ in range(round(8 / TICK)):
        plane.place(airspeed, alpha)
        plane.fdm.run()
        trace.append(plane.thrust)
    return trace


def thrust_map(level: Coefficients) -> list[list[float]]:
    """Steady thrust [N] by airspeed and throttle."""
    plane = level.plane
    return [[round(steady_thrust(plane, share * plane.cruise, throttle, level.alpha)[-1], 1)
             for throttle in THROTTLES] for share in AIRSPEEDS]


def lag(level: Coefficients, forces: list[float]) -> float:
    """Time [s] in which the thrust makes 63 % of a step from level flight, the mean of a step up and one down."""
    times = []
    for factor in (0.6, 1.4):
        throttle = float(np.interp(factor * level.thrust, forces, THROTTLES))
        start = steady_thrust(level.plane, level.plane.cruise, level.throttle, level.alpha)[-1]
        trace = steady_thrust(level.plane, level.plane.cruise, throttle, level.alpha)
        reached = [abs(value - start) >= 0.63 * abs(trace[-1] - start) for value in trace]
        times.append((reached.index(True) + 1) * TICK)
    return sum(times) / 2


def fit(name: str) -> tuple[str, dict]:
    """The aircraft file, and the map of the thrust."""
    level = Coefficients(plane := Plane(name))
    d, stall = level.derivatives(), level.stall()
    drag_zero, drag_induced = level.drag(d)
    forces = thrust_map(level)
    cruise = forces[AIRSPEEDS.index(1.0)]
    zero = d["level"] - d["alpha"] * level.alpha - d["elevator"] * level.elevator
    least, most = plane.elevator_range
    lines = [
        f"# Written by examples/jsbsim/fit.py: {name} of JSBSim about level flight at 1,000 m.",
        f'name = "{name}"',
        f'source = "central differences in JSBSim {jsbsim.__version__}"',
        'derivatives = "radian"',
        f"mass = {level.mass:.1f}", f"pitch_inertia = {level.inertia:.1f}", f"wing_area = {level.area:.3f}",
        f"chord = {level.chord:.4f}", f"air_density = {level.density:.4f}", f"cruise = {plane.cruise:.1f}",
        f"body_radius = {plane.body_radius:.2f}", "",
        "[lift]", f"zero = {zero[0]:.4f}", f"alpha = {d['alpha'][0]:.3f}",
        f"alpha_rate = {d['alpha_rate'][0]:.2f}", f"pitch_rate = {d['pitch_rate'][0]:.2f}"]
    lines += [f"stall = {stall:.3f}"] if stall else []
    lines += ["", "[drag]", f"zero = {drag_zero:.4f}", f"induced = {drag_induced:.4f}", "",
              "[moment]", f"zero = {zero[2]:.4f}", f"alpha = {d['alpha'][2]:.3f}",
              f"pitch_rate = {d['pitch_rate'][2]:.2f}",
              # The fit of the pa28 gives a small moment of the other sign; a file takes dampings alone.
              f"alpha_rate = {min(d['alpha_rate'][2], 0.0):.2f}", "",
              "[elevator]", 'unit = "rad"', f"moment = {d['elevator'][2]:.3f}", f"lift = {d['elevator'][0]:.3f}",
              f"min = {least:.4f}", f"max = {most:.4f}", "",
              "[thrust]", f"max = {cruise[-1]:.0f}", f"lag = {lag(level, cruise):.2f}", ""]
    airspeeds = [round(share * plane.cruise, 1) for share in AIRSPEEDS]
    return "\n".join(lines), {"airspeeds": airspeeds, "throttles": THROTTLES, "thrust": forces}


if __name__ == "__main__":
    for aircraft in sys.argv[1:] or AIRCRAFT:
        text, table = fit(aircraft)
        (FOLDER / f"{aircraft}.toml").write_text(text)
        (FOLDER / f"{aircraft}-thrust.json").write_text(json.dumps(table) + "\n")
        print(f"aircraft/{aircraft}.toml, aircraft/{aircraft}-thrust.json")
