"""pymavlink as anybody uses it, and its parser compared with our framer."""

import json
import os
import random
import statistics
import subprocess
from pathlib import Path

import pytest

from simulation import LASTING, LIMIT, ROOT, free_port, parameters, until
from mpp_ground.dialect import load

mavlink = load()

from pymavlink import mavftp, mavutil

FRAMES = Path(os.environ.get("FRAMES", ROOT / "target" / "debug" / "examples" / "frames"))


@pytest.fixture
def vehicle(simulate):
    simulation = simulate(*LASTING, "--instance", "4")
    master = mavutil.mavlink_connection(simulation.address, source_system=254)
    assert master.wait_heartbeat(timeout=LIMIT) is not None
    yield master
    master.close()


def awaited(master, kind, accept=lambda message: True):
    """The next message of a kind that is accepted."""
    def look():
        message = master.recv_match(type=kind, blocking=True, timeout=1)
        return message if message is not None and accept(message) else None

    return until(look, kind)


def ack(master, command):
    return awaited(master, "COMMAND_ACK", lambda message: message.command == command).result


def value(master, name):
    return awaited(master, "PARAM_VALUE", lambda message: message.param_id == name).param_value


def test_it_is_a_fixed_wing_that_is_read_tuned_and_armed(vehicle):
    heartbeat = vehicle.messages["HEARTBEAT"]
    assert (heartbeat.get_srcSystem(), heartbeat.get_srcComponent()) == (5, 1)
    assert heartbeat.type == mavlink.MAV_TYPE_FIXED_WING
    assert heartbeat.autopilot == mavlink.MAV_AUTOPILOT_GENERIC
    assert vehicle.flightmode == "AUTO"

    expected = parameters()
    vehicle.param_fetch_all()
    found = {}
    while len(found) < len(expected):
        message = awaited(vehicle, "PARAM_VALUE")
        assert message.param_type == mavlink.MAV_PARAM_TYPE_REAL32
        assert message.param_count == len(expected)
        found[message.param_id] = message.param_value
    assert found == pytest.approx(expected, rel=1e-6)
    vehicle.param_set_send("MPP_PATHS", 17)
    assert value(vehicle, "MPP_PATHS") == 17
    vehicle.param_fetch_one("MPP_PATHS")
    assert value(vehicle, "MPP_PATHS") == 17
    vehicle.mav.command_long_send(5, 1, 31_999, 0, *[0] * 7)
    assert ack(vehicle, 31_999) == mavlink.MAV_RESULT_UNSUPPORTED
    vehicle.mav.command_int_send(5, 1, 0, 31_998, 0, 0, *[0] * 7)
    assert ack(vehicle, 31_998) == mavlink.MAV_RESULT_UNSUPPORTED
    vehicle.arducopter_arm()
    assert ack(vehicle, mavlink.MAV_CMD_COMPONENT_ARM_DISARM) == mavlink.MAV_RESULT_ACCEPTED
    vehicle.motors_armed_wait()
    vehicle.set_mode("CRUISE")
    awaited(vehicle, "HEARTBEAT", lambda heartbeat: vehicle.flightmode == "CRUISE")


def test_an_interval_change_is_measured(vehicle):
    def interval():
        """Milliseconds between attitudes by the vehicle's clock. A datagram may be lost."""
        times = [awaited(vehicle, "ATTITUDE").time_boot_ms for _ in range(40)]
        return statistics.median(b - a for a, b in zip(times[5:], times[6:]))

    assert interval() == 100
    vehicle.mav.command_long_send(5, 1, 511, 0, mavlink.MAVLINK_MSG_ID_ATTITUDE, 20_000, *[0] * 5)
    assert ack(vehicle, 511) == mavlink.MAV_RESULT_ACCEPTED
    assert interval() == 20


def test_each_of_two_stations_has_its_own_rates(simulate):
    other_port = free_port()
    simulation = simulate(*LASTING, others=(other_port,))
    first = mavutil.mavlink_connection(simulation.address, source_system=254)
    second = mavutil.mavlink_connection(f"udpin:127.0.0.1:{other_port}", source_system=253)
    assert first.wait_heartbeat(timeout=LIMIT) and second.wait_heartbeat(timeout=LIMIT)

    def interval(master):
        times = [awaited(master, "ATTITUDE").time_boot_ms for _ in range(12)]
        return statistics.median(b - a for a, b in zip(times[4:], times[5:]))

    first.mav.command_long_send(1, 1, 511, 0, mavlink.MAVLINK_MSG_ID_ATTITUDE, 20_000, *[0] * 5)
    assert ack(first, 511) == mavlink.MAV_RESULT_ACCEPTED
    second.mav.request_data_stream_send(1, 1, mavlink.MAV_DATA_STREAM_ALL, 4, 1)
    while interval(second) != 250:
        pass
    while interval(first) != 20:
        pass
    assert interval(second) == 250
    # By the numbers of its frames it has lost none, apart from a datagram that the machine lost: those of the first
    # station are not among them. (The first one gets more than this test reads.)
    assert second.packet_loss() < 5
    first.close()
    second.close()


def test_what_a_station_asks_for_once_is_sent_once(vehicle):
    vehicle.arducopter_arm()
    for _ in range(2):
        awaited(vehicle, "DISTANCE_SENSOR")
    # There was a plan by now, and nobody was told of it unasked.
    assert not any(name.startswith("MPP_") for name in vehicle.messages)
    # This pymavlink does not know the messages about modes and metadata, and names them by their numbers.
    asked = {f"UNKNOWN_{number}": number for number in (397, 435, 436)}
    for name in ("GPS_GLOBAL_ORIGIN", "MPP_LIDAR_SCAN", "MPP_PLAN_STATUS", "MPP_TRAJECTORY"):
        asked[name] = getattr(mavlink, f"MAVLINK_MSG_ID_{name}")
    for name, number in asked.items():
        vehicle.mav.command_long_send(5, 1, 512, 0, number, *[0] * 6)
        awaited(vehicle, name)
        assert ack(vehicle, 512) == mavlink.MAV_RESULT_ACCEPTED, name
    # The forerunner of 397 is refused at once, so that nothing waits for it.
    vehicle.mav.command_long_send(5, 1, 512, 0, 395, *[0] * 6)
    assert ack(vehicle, 512) == mavlink.MAV_RESULT_DENIED


def test_the_metadata_of_parameters_come_as_files(vehicle, tmp_path):
    """The way of a station: message, general file, file of parameters, each read by pymavlink's own client."""
    vehicle.mav.command_long_send(5, 1, 512, 0, 397, *[0] * 6)
    # Behind the head of the frame stand time, checksum and address.
    about = bytes(awaited(vehicle, "UNKNOWN_397").get_msgbuf())[10 + 8:-2].rstrip(b"\0").decode()
    ftp = mavftp.MAVFTP(vehicle, target_system=5, target_component=1)

    def read(uri):
        to = tmp_path / Path(uri).name
        ftp.cmd_get([uri.removeprefix("mftp://"), str(to)])
        result = ftp.process_ftp_reply("OpenFileRO", timeout=LIMIT)
        assert result.error_code == mavftp.FtpError.Success, result.error_code
        return json.loads(to.read_text())

    (entry,) = read(about)["metadataTypes"]
    described = {one["name"]: one for one in read(entry["uri"])["parameters"]}
    assert set(parameters()) <= set(described)
    assert described["MPP_PATHS"]["type"] == "Int32" and described["MPP_ALT_M"]["units"] == "m"
    listed = {one.name for one in ftp.cmd_list(["/"]).directory_listing}
    assert listed >= {"general.json", "parameter.json"}
    refused = ftp.cmd_rm(["/general.json"])
    assert refused.error_code == mavftp.FtpError.FileProtected


def test_tens_of_vehicles_are_told_apart(simulate):
    first = simulate("--hold", "--instance", "0")
    for instance in range(1, 20):
        simulate("--hold", "--instance", str(instance), port=first.port)
    master = mavutil.mavlink_connection(first.address)
    systems = set()

    def all_heard():
        message = master.recv_match(type="HEARTBEAT", blocking=True, timeout=1)
        systems.update([] if message is None else [message.get_srcSystem()])
        return len(systems) == 20

    until(all_heard, "twenty vehicles")
    master.close()
    assert systems == set(range(1, 21))


def known(generator, mav):
    """Makes a frame of a message that the vehicle's dialect has."""
    mav.srcSystem, mav.srcComponent = generator.randrange(256), generator.randrange(256)
    messages = [
        lambda: mavlink.MAVLink_heartbeat_message(1, 0, 0, generator.getrandbits(32), 4, 3),
        lambda: mavlink.MAVLink_param_set_message(1, 1, b"MPP_PATHS", generator.uniform(-9, 9), 9),
        lambda: mavlink.MAVLink_command_long_message(
            1, 1, generator.randrange(65536), 0, *[generator.uniform(-9, 9) for _ in range(7)]),
        lambda: mavlink.MAVLink_mpp_lidar_scan_message(
            0, 1, 0.5, 0.1, 5000, 100, [generator.randrange(65536) for _ in range(100)]),
        lambda: mavlink.MAVLink_statustext_message(6, bytes(generator.randrange(1, 256) for _ in range(50))),
    ]
    version_1 = generator.random() < 0.2
    frame = generator.choice(messages[:1] if version_1 else messages)().pack(mav, force_mavlink1=version_1)
    mav.seq = (mav.seq + 1) % 256
    return bytes(frame)


def unknown(generator):
    """Makes a frame of a message that is not in the vehicle's dialect. It is full of false beginnings."""
    length = generator.randrange(256)
    number = generator.randrange(55_000, 65_000).to_bytes(3, "little")
    body = bytes(generator.choice([0xFD, 0xFE, 0, 1, generator.randrange(256)]) for _ in range(length))
    frame = bytes([0xFD, length, 0, 0, 1, 2, 3]) + number + body
    crc = mavlink.x25crc(frame[1:] + bytes([generator.randrange(256)])).crc
    return frame + crc.to_bytes(2, "little")


def stream(seed):
    """Makes a noisy stream. Returns it with the frames in it."""
    generator = random.Random(seed)
    mav = mavlink.MAVLink(None)
    out, planted = b"", []
    for _ in range(200):
        frame = known(generator, mav)
        kind = generator.randrange(8)
        if kind < 4:
            copies = 1 + (kind == 3)
            out += frame * copies
            planted += [frame] * copies
        elif kind == 4:
            out += frame[: generator.randrange(len(frame) - 3)]
        elif kind == 5:
            at = generator.randrange(len(frame))
            out += frame[:at] + bytes([frame[at] ^ 1 << generator.randrange(8)]) + frame[at + 1:]
        elif kind == 6:
            frame = unknown(generator)
            out += frame[: generator.choice([len(frame), generator.randrange(len(frame))])]
        else:
            out += generator.randbytes(generator.randrange(300))
    return out, planted


def test_the_framer_finds_all_that_was_sent_and_more_than_pymavlink():
    ours_total, theirs_total, planted_total = 0, 0, 0
    for seed in range(40):
        bytes_, planted = stream(seed)
        lines = subprocess.run([FRAMES], input=bytes_, capture_output=True, check=True).stdout.split()
        ours = [bytes.fromhex(line.decode()) for line in lines]
        assert ours == planted, seed
        parser = mavlink.MAVLink(None)
        parser.robust_parsing = True
        theirs = [bytes(m.get_msgbuf()) for m in parser.parse_buffer(bytes_) or [] if m.get_type() != "BAD_DATA"]
        theirs_total += sum(frame in planted for frame in theirs)
        ours_total, planted_total = ours_total + len(ours), planted_total + len(planted)
    print(f"{planted_total} frames: framer {ours_total}, pymavlink {theirs_total}")
    assert ours_total > theirs_total


def test_both_dialects_have_the_same_checksums():
    """pymavlink reads all that the vehicle sends, private messages too: nothing arrives as bad data."""
    mav = mavlink.MAVLink(None)
    frame = mavlink.MAVLink_mpp_trajectory_message(0, 1, 0.25, 19, [1.0] * 19, [2.0] * 19, [0.1] * 19).pack(mav)
    out = subprocess.run([FRAMES], input=bytes(frame), capture_output=True, check=True).stdout
    assert bytes.fromhex(out.strip().decode()) == bytes(frame)
