"""A connection to one vehicle. Commands and parameters get an answer, or they fail with an error."""

import contextlib
import hashlib
import math
import struct
import threading
import time

from .dialect import load

mavlink = load()

from pymavlink import mavutil

COMPONENT = 1
RESULTS = {
    number: entry.name.removeprefix("MAV_RESULT_")
    for number, entry in mavlink.enums["MAV_RESULT"].items()
}


# How the bytes of a parameter's value are read, by its type. Those of another type are a float.
INTEGERS = {
    mavlink.MAV_PARAM_TYPE_UINT8: "<Bxxx", mavlink.MAV_PARAM_TYPE_INT8: "<bxxx",
    mavlink.MAV_PARAM_TYPE_UINT16: "<Hxx", mavlink.MAV_PARAM_TYPE_INT16: "<hxx",
    mavlink.MAV_PARAM_TYPE_UINT32: "<I", mavlink.MAV_PARAM_TYPE_INT32: "<i",
}


# The messages about scans and plans. A station that does not know them counts each as lost, so they come on request.
PLANS = [mavlink.MAVLINK_MSG_ID_MPP_LIDAR_SCAN, mavlink.MAVLINK_MSG_ID_MPP_PLAN_STATUS,
         mavlink.MAVLINK_MSG_ID_MPP_TRAJECTORY]
# MAV_PARAM_ERROR_DOES_NOT_EXIST
NO_SUCH_PARAMETER = 1


def downrange(position):
    """The distance flown of a LOCAL_POSITION_NED, whatever the heading."""
    return math.hypot(position.x, position.y)


def parameter_value(message):
    """The value in a PARAM_VALUE. A vehicle whose version was asked for sends whole numbers as integers."""
    layout = INTEGERS.get(message.param_type)
    return message.param_value if layout is None else struct.unpack(layout, struct.pack("<f", message.param_value))[0]


class GroundError(Exception):
    """The vehicle refused a request or did not answer it."""


def command_name(command):
    """The name of a command, without its prefix."""
    known = mavlink.enums["MAV_CMD"].get(command)
    return known.name.removeprefix("MAV_CMD_") if known else f"command {command}"


class Vehicle:
    """A vehicle at a pymavlink address, for instance udpin:127.0.0.1:14550."""

    def __init__(self, address, system=None, passphrase=None, patience=10.0, heartbeat=True):
        self.master = mavutil.mavlink_connection(address, source_system=255, source_component=190)
        if passphrase is not None:
            self.master.setup_signing(hashlib.sha256(passphrase.encode()).digest(), sign_outgoing=True)
        self.patience = patience
        self.stopped = threading.Event()
        self.asked = False
        self.system = self.find(system)
        self.master.target_system, self.master.target_component = self.system, COMPONENT
        self.beat()
        if heartbeat:
            threading.Thread(target=self.keep_beating, daemon=True).start()

    def find(self, system):
        """Waits for a vehicle's heartbeat: from the system that is asked for, or else from the first one."""
        deadline = time.monotonic() + self.patience
        while time.monotonic() < deadline:
            message = self.master.recv_match(type="HEARTBEAT", blocking=True, timeout=0.5)
            if message is None or message.type == mavlink.MAV_TYPE_GCS:
                continue
            if system in (None, message.get_srcSystem()):
                return message.get_srcSystem()
        who = "no vehicle" if system is None else f"no vehicle with system id {system}"
        raise GroundError(f"{who} was heard for {self.patience:g} s")

    def beat(self):
        self.master.mav.heartbeat_send(mavlink.MAV_TYPE_GCS, mavlink.MAV_AUTOPILOT_INVALID, 0, 0, 0)

    def keep_beating(self):
        while not self.stopped.wait(1.0):
            self.beat()

    def ask_for_plans(self):
        """Asks for the messages about scans and plans. A vehicle with a key does not hear who has none."""
        self.asked = True
        with contextlib.suppress(GroundError):
            for number in PLANS:
                self.command(mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, number, 1, patience=2.0)

    def close(self):
        self.stopped.set()
        # The next program at this address may not know them.
        for number in PLANS if self.asked else []:
            self.send_command(mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, number, -1)
        self.master.close()

    def receive(self, types=None, timeout=1.0):
        """The next message of the vehicle of one of these types; None if no such message comes in time."""
        deadline = time.monotonic() + timeout
        while (left := deadline - time.monotonic()) > 0:
            message = self.master.recv_match(type=types, blocking=True, timeout=left)
            if message is not None and message.get_srcSystem() == self.system:
                return message
        return None

    def ask(self, send, types, accept, what, patience=None):
        """Sends once a second, because datagrams get lost, until an answer comes that `accept` takes."""
        end = time.monotonic() + (patience or self.patience)
        while (now := time.monotonic()) < end:
            send()
            deadline = min(now + 1.0, end)
            while (left := deadline - time.monotonic()) > 0:
                message = self.receive(types, left)
                if message is not None and accept(message):
                    return message
        raise GroundError(f"no answer to {what}")

    def send_command(self, command, *parameters):
        values = [float(value) for value in parameters] + [0.0] * (7 - len(parameters))
        self.master.mav.command_long_send(self.system, COMPONENT, command, 0, *values)

    def command(self, command, *parameters, patience=None):
        """Sends a command. Returns the name of the acknowledgement's result."""
        ack = self.ask(
            lambda: self.send_command(command, *parameters),
            "COMMAND_ACK",
            lambda ack: ack.command == command,
            command_name(command),
            patience,
        )
        return RESULTS.get(ack.result, str(ack.result))

    def demand(self, command, *parameters):
        """Sends a command that must be accepted. Returns its name."""
        self.master.messages.pop("STATUSTEXT", None)
        result, name = self.command(command, *parameters), command_name(command)
        if result != "ACCEPTED":
            # The vehicle says why before it acknowledges.
            said = self.master.messages.get("STATUSTEXT")
            raise GroundError(f"{name}: {result}" + (f": {said.text}" if said else ""))
        return name

    def request(self, name):
        """Requests a message and returns it."""
        number = getattr(mavlink, f"MAVLINK_MSG_ID_{name}")
        self.demand(mavlink.MAV_CMD_REQUEST_MESSAGE, number)
        message = self.receive(name, 2.0) or self.master.messages.get(name)
        if message is None:
            raise GroundError(f"{name} did not come")
        return message

    def parameters(self):
        """Every parameter, name to value, in the vehicle's order."""
        found, count = {}, None
        mav = self.master.mav
        end = time.monotonic() + self.patience
        while time.monotonic() < end:
            if count is None:
                mav.param_request_list_send(self.system, COMPONENT)
            else:
                for index in set(range(count)) - set(found):
                    mav.param_request_read_send(self.system, COMPONENT, b"", index)
            while (message := self.receive("PARAM_VALUE", 0.5)) is not None:
                count = message.param_count
                if message.param_index < count:
                    found[message.param_index] = (message.param_id, parameter_value(message))
                if len(found) == count:
                    return dict(found[index] for index in range(count))
        raise GroundError(f"{len(found)} of {count or 'the'} parameters came")

    def ask_parameter(self, name, send, what):
        """Sends until the value in force comes."""
        def accept(answer):
            # Of an error with another number the value came first.
            return answer.param_id == name and getattr(answer, "error", NO_SUCH_PARAMETER) == NO_SUCH_PARAMETER

        answer = self.ask(send, ["PARAM_VALUE", "PARAM_ERROR"], accept, f"{what} of {name}")
        if answer.get_type() == "PARAM_ERROR":
            raise GroundError(f"{name}: no such parameter")
        return parameter_value(answer)

    def read(self, name):
        mav = self.master.mav
        ask = lambda: mav.param_request_read_send(self.system, COMPONENT, name.encode(), -1)
        return self.ask_parameter(name, ask, "a read")

    def write(self, name, value):
        """Sets a parameter. Raises an error if the value in force is different."""
        mav = self.master.mav
        real32 = mavlink.MAV_PARAM_TYPE_REAL32
        ask = lambda: mav.param_set_send(self.system, COMPONENT, name.encode(), value, real32)
        in_force = self.ask_parameter(name, ask, "a write")
        if abs(in_force - value) > 1e-6 * max(1.0, abs(value)):
            raise GroundError(f"{name} stays {in_force:g}: {value:g} is refused{self.why(name)}")
        return in_force

    def why(self, name):
        """The vehicle's text about a refused write, if there is one."""
        end = time.monotonic() + 1.0
        while (text := self.receive("STATUSTEXT", end - time.monotonic())) is not None:
            if text.text.startswith(name):
                return f" ({text.text.removeprefix(name).strip(': ')})"
        return ""
