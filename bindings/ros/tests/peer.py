"""A plant behind topics: rclpy on Fast DDS flies a World of `mppflight` with the commands of the node, in lockstep.

Each tick it publishes what the sensors say, odometry last, and waits for the command with the odometry's stamp. Its last
line of output is a JSON object.
"""

import argparse
import hashlib
import json
import math
import sys
import time

import mppflight
import numpy
import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped, TwistStamped
from nav_msgs.msg import OccupancyGrid, Odometry, Path
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParameters
from sensor_msgs.msg import JointState, LaserScan, PointCloud2, PointField
from trajectory_msgs.msg import MultiDOFJointTrajectory
from visualization_msgs.msg import MarkerArray

HEADING = 0.6
"""Direction of the track in the frame `odom`, from x to y [rad]."""
ORIGIN = (100.0, -40.0)
ALTITUDE = 50.0
PATIENCE = 60.0
"""Longest wait for a command [s]."""
RESEND = 10.0
"""The node takes odometry by best effort: one without an answer is sent again [s]."""


class Peer:
    def __init__(self, spoil: bool, clouds: bool) -> None:
        self.spoil, self.clouds = spoil, clouds
        self.node = rclpy.create_node("peer")
        give, take = self.node.create_publisher, self.node.create_subscription
        self.scan = give(LaserScan, "scan", 10)
        self.cloud = give(PointCloud2, "cloud", 10)
        self.odometry = give(Odometry, "odometry", 10)
        self.airspeed = give(TwistStamped, "airspeed", 10)
        self.goal = give(PoseStamped, "goal", 10)
        self.command = None
        self.hashes = {}
        self.counts = {}
        self.seen = {}
        self.diagnostics = []
        take(JointState, "renamed/setpoint", self.hear_command, 10)
        take(DiagnosticArray, "diagnostics", self.diagnostics.append, 10)
        for kind, name in (
            (Path, "plan"),
            (MultiDOFJointTrajectory, "trajectory"),
            (MarkerArray, "candidates"),
            (OccupancyGrid, "map"),
        ):
            take(kind, name, lambda message, name=name: self.hear(name, message), 50)

    def hear_command(self, message: JointState) -> None:
        self.command = message

    def hear(self, name: str, message) -> None:
        self.counts[name] = self.counts.get(name, 0) + 1
        self.seen[name] = message
        self.hashes.setdefault(name, hashlib.sha256()).update(repr(message).encode())

    def meet(self) -> None:
        """Waits until all topics are connected, in both directions."""
        out = (self.scan, self.cloud, self.odometry, self.airspeed, self.goal)
        taken = ("renamed/setpoint", "plan", "trajectory", "candidates", "map", "diagnostics")
        until = time.monotonic() + PATIENCE
        while not (
            all(topic.get_subscription_count() for topic in out)
            and all(self.node.count_publishers(name) for name in taken)
        ):
            if time.monotonic() > until:
                sys.exit("the node is not there")
            rclpy.spin_once(self.node, timeout_sec=0.05)
        # The node may know less of us than we of it.
        self.spin(1.0)

    def spin(self, seconds: float) -> None:
        until = time.monotonic() + seconds
        while time.monotonic() < until:
            rclpy.spin_once(self.node, timeout_sec=0.05)

    def set(self, name: str, value: float) -> bool:
        """Sets a parameter of the node, as `ros2 param set` does. Whether the node took it."""
        service = self.node.create_client(SetParameters, "mpp/set_parameters")
        service.wait_for_service(PATIENCE)
        number = ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=value)
        asked = SetParameters.Request(parameters=[Parameter(name=name, value=number)])
        answer = service.call_async(asked)
        rclpy.spin_until_future_complete(self.node, answer, timeout_sec=PATIENCE)
        return answer.result().results[0].successful

    def send_goal(self) -> None:
        goal = PoseStamped()
        goal.header.frame_id = "odom"
        goal.pose.position.x, goal.pose.position.y = ORIGIN
        goal.pose.position.z = ALTITUDE
        goal.pose.orientation.z = math.sin(HEADING / 2)
        goal.pose.orientation.w = math.cos(HEADING / 2)
        self.goal.publish(goal)

    def measure(self, tick: int, world: mppflight.World) -> None:
        measured, state = world.measure(), world.state
        if self.spoil and tick % 100 == 0 and tick > 0:
            self.send_nonsense(tick, state)
        if "scan" in measured and self.clouds:
            self.cloud.publish(cloud(tick, measured["scan"]))
        elif "scan" in measured:
            self.scan.publish(scan(tick, measured["scan"], self.spoil and tick == 300))
        airspeed = TwistStamped()
        airspeed.header.stamp = stamp(tick)
        airspeed.twist.linear.x = measured["airspeed"]
        self.airspeed.publish(airspeed)
        self.last = odometry(stamp(tick), state, measured["pitch"])
        self.odometry.publish(self.last)

    def send_nonsense(self, tick: int, state: dict) -> None:
        """What the node must refuse, before the good messages of the tick."""
        wrong = scan(tick, [10.0] * 100)
        wrong.header.frame_id = "base_link"
        self.scan.publish(wrong)
        wrong = scan(tick, [10.0] * 100)
        wrong.ranges = wrong.ranges[:50]
        self.scan.publish(wrong)
        wrong = scan(tick, [10.0] * 100)
        wrong.ranges = [math.nan] * 30 + [10.0] * 70
        self.scan.publish(wrong)
        self.odometry.publish(odometry(stamp(tick - 20), state, 0.0))
        wrong = odometry(stamp(tick - 0.25), state, 0.0)
        wrong.pose.pose.position.z = math.nan
        self.odometry.publish(wrong)

    def answer(self, tick: int) -> tuple[float, float]:
        """Thrust and elevator of the command with this tick's stamp."""
        until, again = time.monotonic() + PATIENCE, time.monotonic() + RESEND
        while self.command is None or self.command.header.stamp != stamp(tick):
            if time.monotonic() > until:
                sys.exit(f"no command for tick {tick}")
            if time.monotonic() > again:
                again += RESEND
                self.odometry.publish(self.last)
            rclpy.spin_once(self.node, timeout_sec=0.05)
        joints = {name: index for index, name in enumerate(self.command.name)}
        return self.command.effort[joints["thrust"]], self.command.position[joints["elevator"]]


def stamp(tick: float):
    return rclpy.time.Time(nanoseconds=1_000_000_000 + int(tick * 10_000_000)).to_msg()


def scan(tick: int, ranges, short: bool = False) -> LaserScan:
    """A scan of the lidar of `World`: 100 deg, up to 45 m. A short one lacks its upper beams."""
    sent = LaserScan()
    sent.header.stamp, sent.header.frame_id = stamp(tick), "lidar_vertical"
    half = math.radians(50.0)
    sent.angle_min, sent.angle_max = -half, half
    sent.angle_increment = 2.0 * half / (len(ranges) - 1)
    sent.range_min, sent.range_max = 0.01, 45.0
    sent.ranges = [float(range_) if range_ > 0.0 else math.inf for range_ in ranges]
    if short:
        sent.ranges = sent.ranges[:-7]
        sent.angle_max -= 7.0 * sent.angle_increment
    return sent


def cloud(tick: int, ranges) -> PointCloud2:
    """The same as points in the body's axes; each stands in three columns, of which one is beside the slab."""
    sent = PointCloud2()
    sent.header.stamp, sent.header.frame_id = stamp(tick), "base_link"
    angles = numpy.linspace(-math.radians(50.0), math.radians(50.0), len(ranges))
    ahead, up = ranges * numpy.cos(angles), ranges * numpy.sin(angles)
    columns = [numpy.stack([ahead, 0.0 * ahead + y, up], axis=1) for y in (-0.2, 0.2, 2.0)]
    points = numpy.concatenate(columns)[numpy.tile(ranges > 0.0, 3)].astype("<f4")
    for index, name in enumerate("xyz"):
        field = PointField(name=name, offset=4 * index, datatype=PointField.FLOAT32, count=1)
        sent.fields.append(field)
    sent.height, sent.width = 1, len(points)
    sent.point_step, sent.row_step = 12, 12 * len(points)
    sent.data = points.tobytes()
    sent.is_dense = True
    return sent


def odometry(at_time, state: dict, pitch: float) -> Odometry:
    """The true position and velocity, and the measured pitch, in ENU and FLU."""
    sent = Odometry()
    sent.header.stamp = at_time
    sent.header.frame_id, sent.child_frame_id = "odom", "base_link"
    x, at = state["x"], sent.pose.pose.position
    at.x, at.y = ORIGIN[0] + x * math.cos(HEADING), ORIGIN[1] + x * math.sin(HEADING)
    at.z = state["z"]
    # Yaw, then nose up, which is a negative turn about the axis to the left.
    sin, cos = math.sin(HEADING / 2), math.cos(HEADING / 2)
    up, level = math.sin(-pitch / 2), math.cos(-pitch / 2)
    turn = sent.pose.pose.orientation
    turn.x, turn.y, turn.z, turn.w = -sin * up, cos * up, sin * level, cos * level
    along = state["airspeed"] * math.cos(state["flight_path"]) + state["wind_x"]
    climb = state["airspeed"] * math.sin(state["flight_path"]) + state["wind_z"]
    own = sent.twist.twist.linear
    own.x = along * math.cos(pitch) + climb * math.sin(pitch)
    own.z = climb * math.cos(pitch) - along * math.sin(pitch)
    sent.pose.covariance[0], sent.twist.covariance[0] = 0.02**2, 0.1**2
    return sent


def fly(peer: Peer, world: mppflight.World, replan: float | None) -> dict:
    peer.meet()
    if replan is not None:
        assert not peer.set("MPP_REPLAN_S", -1.0) and peer.set("MPP_REPLAN_S", replan)
    peer.send_goal()
    peer.spin(0.5)
    tick = 0
    while world.outcome is None:
        peer.measure(tick, world)
        world.step(*peer.answer(tick))
        tick += 1
    peer.spin(0.5)
    path, grid = peer.seen["plan"], peer.seen["map"]
    first, last = path.poses[0].pose.position, path.poses[-1].pose.position
    return {
        "outcome": world.outcome,
        "ticks": tick,
        "hashes": {name: own.hexdigest() for name, own in peer.hashes.items()},
        "counts": peer.counts,
        "path": [[at.x, at.y, at.z] for at in (first, last)],
        "frame": path.header.frame_id,
        "points": len(peer.seen["trajectory"].points),
        "speed": peer.seen["trajectory"].points[0].velocities[0].linear.x,
        "lines": len(peer.seen["candidates"].markers) - 1,
        "cells": [grid.info.width, grid.info.height, sorted(set(grid.data))],
        "state": world.state,
        "diagnostics": [
            {
                "level": status.level[0],
                "name": status.name,
                "message": status.message,
                "values": {pair.key: pair.value for pair in status.values},
            }
            for status in peer.diagnostics[-1].status
        ],
    }


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--duration", type=float, default=20.0)
    parser.add_argument("--scan-hz", type=float, default=1.0)
    parser.add_argument("--replan", type=float, help="set MPP_REPLAN_S [s]")
    parser.add_argument("--spoil", action="store_true", help="send bad messages, too")
    parser.add_argument("--clouds", action="store_true", help="send point clouds, not scans")
    args = parser.parse_args()
    rclpy.init()
    keys = {"seed": args.seed, "duration": args.duration, "replan_hz": args.scan_hz}
    world = mppflight.World(**keys)
    began = time.monotonic()
    flown = fly(Peer(args.spoil, args.clouds), world, args.replan)
    print(json.dumps({**flown, "wall": time.monotonic() - began}))


if __name__ == "__main__":
    main()
