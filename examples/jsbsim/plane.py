"""An aircraft of JSBSim with its wings held level, flown by thrust [N] and elevator [rad]."""

import math
import os

os.environ.setdefault("JSBSIM_DEBUG", "0")
import jsbsim  # noqa: E402  JSBSim reads the variable when it is imported

FOOT, POUND, SLUG = 0.3048, 4.4482216152605, 14.593902937206
TICK = 0.01  # s
ALTITUDE = 1000.0  # m

# Cruise [m/s]: between the best rate of climb and the greatest airspeed of level flight, so that thrust is left for
# climbs. Body radius [m]: half of the length of the aircraft, from the manufacturers' data sheets.
AIRCRAFT = {"c172p": (50.0, 4.14), "J3Cub": (30.0, 3.41), "pa28": (50.0, 3.61)}


def clip(value: float, least: float, most: float) -> float:
    return min(max(value, least), most)


class Plane:
    """One aircraft. It starts in the air with its engine running; `settle` brings it to level flight at cruise."""

    def __init__(self, name: str):
        self.name, (self.cruise, self.body_radius) = name, AIRCRAFT[name]
        self.fdm = fdm = jsbsim.FGFDMExec(None)
        fdm.set_debug_level(0)
        if not fdm.load_model(name):
            raise ValueError(f"JSBSim has no aircraft {name}")
        fdm.set_dt(TICK)
        fdm["fcs/mixture-cmd-norm"] = 0.9
        fdm["fcs/advance-cmd-norm"] = 1.0
        fdm["propulsion/magneto_cmd"] = 3
        fdm["propulsion/set-running"] = 0
        self.throttle = 0.6
        self.place(self.cruise, 0.0)
        # The mass stays what it was when the derivatives were taken.
        fdm["propulsion/fuel_freeze"] = 1
        self.elevator_range = self._ends_of_elevator()
        self.x = 0.0

    def place(self, airspeed: float, alpha: float, pitch_rate: float = 0.0, roll: float = 0.0):
        """Puts the aircraft into a state of level flight. The engine goes on as it runs."""
        values = {"ic/h-sl-ft": ALTITUDE / FOOT, "ic/psi-true-rad": math.pi / 2, "ic/vt-fps": airspeed / FOOT,
                  "ic/beta-rad": 0.0, "ic/phi-rad": roll, "ic/theta-rad": alpha, "ic/alpha-rad": alpha,
                  "ic/q-rad_sec": pitch_rate}
        for key, value in values.items():
            self.fdm[key] = value
        self.fdm["fcs/throttle-cmd-norm"] = self.throttle
        self.fdm.run_ic()

    def _ends_of_elevator(self) -> tuple[float, float]:
        """Deflections at both ends of the elevator's command [rad]."""
        ends = []
        for command in (-1.0, 1.0, 0.0):
            self.fdm["fcs/elevator-cmd-norm"] = command
            self.fdm.run_ic()
            ends.append(self.fdm["fcs/elevator-pos-rad"])
        return ends[0], ends[1]

    @property
    def airspeed(self) -> float:
        return self.fdm["velocities/vt-fps"] * FOOT

    @property
    def pitch(self) -> float:
        return self.fdm["attitude/theta-rad"]

    @property
    def z(self) -> float:
        return self.fdm["position/h-sl-meters"]

    @property
    def alpha(self) -> float:
        return self.fdm["aero/alpha-rad"]

    @property
    def path(self) -> float:
        """Flight path angle [rad]."""
        return math.atan2(-self.fdm["velocities/v-down-fps"], self._ground_speed() / FOOT)

    @property
    def thrust(self) -> float:
        return self.fdm["propulsion/engine/thrust-lbs"] * POUND

    @property
    def elevator(self) -> float:
        return self.fdm["fcs/elevator-pos-rad"]

    def _ground_speed(self) -> float:
        return math.hypot(self.fdm["velocities/v-north-fps"], self.fdm["velocities/v-east-fps"]) * FOOT

    def blow(self, ahead: float, up: float):
        """Moves the air along the track and upwards [m/s]."""
        self.fdm["atmosphere/wind-east-fps"], self.fdm["atmosphere/wind-down-fps"] = ahead / FOOT, -up / FOOT

    def step(self, throttle: float, elevator: float):
        """Flies one tick. Distance downrange is counted along the track."""
        fdm, (least, most) = self.fdm, self.elevator_range
        self.throttle = clip(throttle, 0.0, 1.0)
        fdm["fcs/throttle-cmd-norm"] = self.throttle
        # JSBSim scales each half of the command's range by the deflection at its end.
        fdm["fcs/elevator-cmd-norm"] = clip(elevator / (most if elevator > 0.0 else -least), -1.0, 1.0)
        self._level()
        before = self._ground_speed()
        fdm.run()
        self.x += 0.5 * (before + self._ground_speed()) * TICK

    def _level(self):
        """Holds wings and heading level: proportional and derivative, in units of full deflection per rad."""
        fdm = self.fdm
        turned = fdm["attitude/psi-rad"] - math.pi / 2
        roll = -2.0 * fdm["attitude/phi-rad"] - 0.5 * fdm["velocities/p-aero-rad_sec"] - 1.0 * turned
        yaw = 1.0 * fdm["aero/beta-rad"] + 0.5 * fdm["velocities/r-aero-rad_sec"]
        fdm["fcs/aileron-cmd-norm"] = clip(roll, -1.0, 1.0)
        fdm["fcs/rudder-cmd-norm"] = clip(yaw, -1.0, 1.0)

    def settle(self, seconds: float = 90.0):
        """Flies to level flight at cruise by a plain autopilot, and calls the place x = 0."""
        fdm, mean_throttle, mean_pitch = self.fdm, 0.5, 0.0
        for _ in range(round(seconds / TICK)):
            climb = fdm["velocities/h-dot-fps"] * FOOT
            wanted = clip(0.02 * (ALTITUDE - self.z) - 0.03 * climb, -0.15, 0.15)
            mean_pitch += 0.3 * wanted * TICK
            nose_up = 1.5 * (wanted + mean_pitch - self.pitch) - 0.5 * fdm["velocities/q-aero-rad_sec"]
            slow = self.cruise - self.airspeed
            mean_throttle += 0.02 * slow * TICK
            self.step(mean_throttle + 0.1 * slow, -0.4 * nose_up)
        self.x = 0.0
