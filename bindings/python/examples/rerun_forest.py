"""A flight through a forest in Rerun: what it saw, what it planned, where it flew.

    pip install rerun-sdk
    python rerun_forest.py                      # opens Rerun's viewer
    python rerun_forest.py --out forest.rrd     # or writes a file for it

Rerun's axes are ahead, left and up, so y and rotations about y and z change their sign.
"""

import argparse
from typing import Any

import mppflight
import numpy as np
import rerun as rr

LEFT = np.array([1.0, -1.0, 1.0])
# How high trunks are drawn [m]: in the simulation they have no end.
HIGH = 18.0


def bodies(look: dict[str, Any]) -> None:
    """What stands there, grey."""
    trunks = np.array([[it["x"], -it["y"], it["radius"], min(it["height"], HIGH)] for body in look["bodies"] for it in body.values()])
    places, high = np.column_stack([trunks[:, :2], 0.5 * trunks[:, 3]]), trunks[:, 3]
    rr.log("world/trunks", rr.Cylinders3D(lengths=high, radii=trunks[:, 2], centers=places, colors=[140, 120, 100]), static=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=4)
    parser.add_argument("--density", type=float, default=0.02)
    parser.add_argument("--out")
    asked = parser.parse_args()
    flight = mppflight.fly(preset="space", seed=asked.seed, density=asked.density)
    look, columns = flight.look(), flight.columns

    rr.init("mppflight", spawn=asked.out is None)
    if asked.out:
        rr.save(asked.out)
    rr.log("world", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
    bodies(look)
    rr.log("world/flown", rr.LineStrips3D([look["at"] * LEFT], colors=[217, 95, 2]), static=True)
    half = 0.5 * look["span"]
    wing = rr.LineStrips3D([[[0, -half, 0], [0, half, 0]], [[-half, 0, 0], [0.6 * half, 0, 0]]], radii=0.05, colors=[40, 40, 40])
    rr.log("world/aircraft/wing", wing, static=True)

    for tick, (at, (w, x, y, z)) in enumerate(zip(look["at"] * LEFT, look["attitude"])):
        rr.set_time("flight", duration=0.01 * tick)
        rr.log("world/aircraft", rr.Transform3D(translation=at, quaternion=rr.Quaternion(xyzw=[x, -y, -z, w])))
        rr.log("clearance", rr.Scalars(look["clearance"][tick]))
        if tick < len(flight):
            rr.log("bank/flown", rr.Scalars(np.degrees(columns["bank"][tick])))
            rr.log("bank/wanted", rr.Scalars(np.degrees(columns["ref_bank"][tick])))
            rr.log("airspeed", rr.Scalars(columns["airspeed"][tick]))
    for cycle in look["cycles"]:
        rr.set_time("flight", duration=0.01 * cycle["tick"])
        rr.log("world/lidar", rr.Points3D(cycle["hits"] * LEFT, radii=0.05, colors=[194, 24, 91]))
        *others, plan = [path[:, :3] * LEFT for path in cycle["paths"]] or [np.zeros((0, 3))]
        rr.log("world/candidates", rr.LineStrips3D(others, colors=[160, 138, 0]))
        rr.log("world/plan", rr.LineStrips3D([plan], radii=0.08, colors=[122, 63, 160]))
    print(flight)


if __name__ == "__main__":
    main()
