"""The command line: `mpp-ground --connect udpin:127.0.0.1:14550 monitor`."""

import argparse
import sys
from importlib.metadata import version
from pathlib import Path

from . import monitor, paramfile, plot, record
from .link import GroundError, Vehicle, mavlink

# These are ArduPlane's numbers, which ground stations use for fixed wings.
MODES = {"AUTO": 10, "CRUISE": 7}
FORCE = 21196


def parser():
    top = argparse.ArgumentParser(prog="mpp-ground", description=__doc__)
    top.add_argument("--connect", default="udpin:127.0.0.1:14550", metavar="ADDRESS",
                     help="pymavlink address [%(default)s]")
    top.add_argument("--system", type=int, help="system id [the first one that is heard]")
    top.add_argument("--key", metavar="FILE", help="file with the signing passphrase in its first line")
    top.add_argument("--version", action="version", version=f"%(prog)s {version('mpp-ground')}")
    commands = top.add_subparsers(dest="command", required=True)

    sub = commands.add_parser("monitor", help="show a live table")
    sub.add_argument("--seconds", type=float, help="end after this time")
    sub.add_argument("--once", action="store_true", help="print one table and end")

    sub = commands.add_parser("params", help="read and write parameters")
    actions = sub.add_subparsers(dest="action", required=True)
    actions.add_parser("list", help="print all parameters as NAME,VALUE")
    one = actions.add_parser("get", help="print one parameter")
    one.add_argument("name")
    one = actions.add_parser("set", help="write one parameter")
    one.add_argument("name")
    one.add_argument("value", type=float)
    for action, what in (("save", "write all to a file"), ("load", "set all from a file")):
        actions.add_parser(action, help=what).add_argument("file", type=Path)

    sub = commands.add_parser("command", help="send a command to the vehicle")
    actions = sub.add_subparsers(dest="action", required=True)
    actions.add_parser("arm")
    one = actions.add_parser("disarm")
    one.add_argument("--force", action="store_true", help="also disarm in flight: the motor stops")
    actions.add_parser("mode").add_argument("mode", choices=sorted(MODES), type=str.upper)
    one = actions.add_parser("altitude", help="change the height to which the aircraft returns")
    one.add_argument("metres", type=float, help="above the ground of the start")
    actions.add_parser("terminate", help="end the flight")
    one = actions.add_parser("interval", help="set the rate of a message")
    one.add_argument("message")
    one.add_argument("hertz", type=float, help="rate in Hz; 0 means never")
    actions.add_parser("request", help="print a message once").add_argument("message")

    sub = commands.add_parser("record", help="record a .tlog")
    sub.add_argument("file", type=Path)
    sub.add_argument("--seconds", type=float, help="end after this time")

    sub = commands.add_parser("plot", help="draw a picture of a .tlog")
    sub.add_argument("tlog", type=Path)
    sub.add_argument("--out", type=Path, required=True, help="picture file: PNG, SVG or PDF")
    return top


def main(arguments=None):
    args = parser().parse_args(arguments)
    try:
        if args.command == "plot":
            plot.plot(args.tlog, args.out)
        else:
            connected(args)
    except GroundError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    except OSError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        pass
    return 0


def connected(args):
    passphrase = Path(args.key).read_text("utf-8-sig").splitlines()[0].rstrip() if args.key else None
    vehicle = Vehicle(args.connect, args.system, passphrase)
    try:
        {"monitor": run_monitor, "params": run_params, "command": run_command, "record": run_record}[
            args.command
        ](vehicle, args)
    finally:
        vehicle.close()


def run_monitor(vehicle, args):
    vehicle.ask_for_plans()
    monitor.monitor(vehicle, sys.stdout, args.seconds, args.once)


def run_record(vehicle, args):
    vehicle.ask_for_plans()
    count = record.record(vehicle, args.file, args.seconds)
    print(f"{count} frames in {args.file}", file=sys.stderr)


def run_params(vehicle, args):
    if args.action == "list":
        print(paramfile.text(vehicle.parameters()), end="")
    elif args.action == "get":
        print(f"{args.name},{vehicle.read(args.name):.9g}")
    elif args.action == "set":
        print(f"{args.name},{vehicle.write(args.name, args.value):.9g}")
    elif args.action == "save":
        args.file.write_text(paramfile.text(vehicle.parameters()))
    else:
        for name, value in paramfile.values(args.file.read_text()):
            print(f"{name},{vehicle.write(name, value):.9g}")


def run_command(vehicle, args):
    if args.action == "request":
        number(args.message)
        print(vehicle.request(args.message.upper()))
        return
    if args.action == "arm":
        demand = mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1
    elif args.action == "disarm":
        demand = mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 0, FORCE if args.force else 0
    elif args.action == "mode":
        demand = mavlink.MAV_CMD_DO_SET_MODE, mavlink.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED, MODES[args.mode]
    elif args.action == "altitude":
        demand = mavlink.MAV_CMD_DO_CHANGE_ALTITUDE, args.metres, mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT
    elif args.action == "terminate":
        demand = mavlink.MAV_CMD_DO_FLIGHTTERMINATION, 1
    else:
        interval = 1e6 / args.hertz if args.hertz > 0 else -1
        demand = mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, number(args.message), interval
    print(f"{vehicle.demand(*demand)}: ACCEPTED")


def number(message):
    """The id of the message with this name."""
    try:
        return getattr(mavlink, f"MAVLINK_MSG_ID_{message.upper()}")
    except AttributeError:
        raise GroundError(f"the dialect has no message {message.upper()}") from None
