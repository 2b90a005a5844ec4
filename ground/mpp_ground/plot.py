"""A picture of a recording: path with plans and returns, speed, pitch, planner."""

import math

from .link import GroundError, downrange

from pymavlink import mavutil

# Least span of the heights as a share of that of the distances: about that of the panel.
LEAST_HEIGHT = 0.15
STYLE = {"path": "#d95f02", "plan": "#7570b3", "return": "#999999"}


def read(path):
    """The messages of a recording that a picture needs, by type."""
    wanted = ["LOCAL_POSITION_NED", "ATTITUDE", "VFR_HUD", "MPP_PLAN_STATUS", "MPP_TRAJECTORY", "MPP_LIDAR_SCAN"]
    found = {kind: [] for kind in wanted}
    log = mavutil.mavlink_connection(str(path))
    while (message := log.recv_match(type=wanted)) is not None:
        found[message.get_type()].append(message)
    if not found["LOCAL_POSITION_NED"]:
        raise GroundError(f"{path} holds no positions")
    return found


def returns(found):
    """Positions of the lidar's returns in the world, by the pose nearest in time."""
    poses = sorted(
        (attitude.time_boot_ms, attitude.pitch) for attitude in found["ATTITUDE"]
    )
    points = []
    for scan in found["MPP_LIDAR_SCAN"]:
        at = min(found["LOCAL_POSITION_NED"], key=lambda p: abs(p.time_boot_ms - scan.time_boot_ms))
        _, pitch = min(poses, key=lambda pose: abs(pose[0] - scan.time_boot_ms), default=(0, 0.0))
        for beam, range_cm in enumerate(scan.ranges[: scan.count]):
            if range_cm != 0xFFFF:
                angle = pitch + scan.angle_min + beam * scan.angle_increment
                reach = range_cm / 100
                points.append((downrange(at) + reach * math.cos(angle), -at.z + reach * math.sin(angle)))
    return points


def plot(tlog, out):
    try:
        import matplotlib
    except ImportError:
        raise GroundError("plot needs matplotlib: pip install 'mpp-ground[plot]'") from None
    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure = draw(read(tlog), pyplot)
    figure.savefig(out, dpi=150)
    pyplot.close(figure)


def draw(found, pyplot):
    figure, (side, speed, pitch, plans) = pyplot.subplots(
        4, 1, figsize=(11, 9), layout="constrained"
    )
    points = returns(found)
    side.plot([x for x, _ in points], [z for _, z in points], ".", ms=2, color=STYLE["return"], label="returns")
    for number, plan in enumerate(found["MPP_TRAJECTORY"]):
        label = "plans" if number == 0 else None
        side.plot(plan.x[: plan.count], plan.z[: plan.count], lw=0.8, color=STYLE["plan"], label=label)
    positions = found["LOCAL_POSITION_NED"]
    side.plot([downrange(p) for p in positions], [-p.z for p in positions], lw=2, color=STYLE["path"], label="flown")
    # Both axes have one scale, so a calm flight needs room above and below to be more than a line.
    (left, right), (low, high) = side.get_xlim(), side.get_ylim()
    more = max(0.0, LEAST_HEIGHT * (right - left) - (high - low)) / 2
    side.set(xlabel="downrange [m]", ylabel="height [m]", aspect="equal", ylim=(low - more, high + more))
    side.legend(loc="lower right", bbox_to_anchor=(1.0, 1.02), ncols=3, frameon=False)

    # VFR_HUD has no time of its own.
    times = [message._timestamp for message in found["VFR_HUD"]]
    start = positions[0]._timestamp
    speed.plot([t - start for t in times], [m.airspeed for m in found["VFR_HUD"]], color=STYLE["path"])
    speed.set(ylabel="airspeed [m/s]")
    pitch.plot([m._timestamp - start for m in found["ATTITUDE"]],
               [math.degrees(m.pitch) for m in found["ATTITUDE"]], color=STYLE["path"])
    pitch.set(ylabel="pitch [deg]")
    status = found["MPP_PLAN_STATUS"]
    plans.plot([m._timestamp - start for m in status], [m.feasible for m in status], "o-", ms=3, color=STYLE["plan"])
    plans.set(xlabel="time [s]", ylabel="feasible [-]")
    return figure
