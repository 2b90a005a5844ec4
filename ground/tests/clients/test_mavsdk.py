"""mavsdk for Python, used as in a program on a companion computer."""

import json
import math
import statistics

import pytest

from simulation import LASTING, LIMIT, parameters, until

pytest.importorskip("mavsdk", reason="mavsdk is not installed")

from mavsdk import ComponentType, Configuration, Mavsdk
from mavsdk.plugins.action import Action, ActionError, ActionResult
from mavsdk.plugins.component_metadata import ComponentMetadata, ComponentMetadataError, MetadataType
from mavsdk.plugins.info import Info
from mavsdk.plugins.log_files import LogFiles, LogFilesError, LogFilesResult
from mavsdk.plugins.mission_raw import MissionRaw
from mavsdk.plugins.param import Param, ParamError
from mavsdk.plugins.telemetry import LandedState, Telemetry


def test_mavsdk_sees_a_healthy_vehicle_in_the_air(simulate):
    simulation = simulate("--speed", "1", "--duration", "3600", "--obstacles", "0")
    with Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION)) as sdk:
        sdk.add_any_connection(simulation.address.replace("udpin:", "udpin://"))
        system = sdk.first_autopilot(LIMIT)
        telemetry = Telemetry(system)
        # A program that waits for these goes on.
        until(telemetry.health_all_ok, "a healthy vehicle")
        until(telemetry.in_air, "a vehicle in the air")
        until(lambda: telemetry.battery().remaining_percent == 100, "a full battery")
        assert telemetry.battery().voltage_v == pytest.approx(16.2)
        assert telemetry.landed_state() == LandedState.IN_AIR
        assert (telemetry.gps_info().fix_type, telemetry.gps_info().num_satellites) == (6, 10)
        assert telemetry.raw_gps().horizontal_uncertainty_m == pytest.approx(0.02)
        assert MissionRaw(system).download_mission() == []
        with pytest.raises(LogFilesError) as refused:
            LogFiles(system).get_entries()
        assert refused.value.result == LogFilesResult.NO_LOGFILES


def test_what_a_program_waits_for_comes(simulate):
    """Scripts wait for home and others before they go on. A vehicle that waits hangs in the air."""
    simulation = simulate(*LASTING, "--home", "-33.9,151.2,20,90")
    with Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION)) as sdk:
        sdk.add_any_connection(simulation.address.replace("udpin:", "udpin://"))
        telemetry = Telemetry(sdk.first_autopilot(LIMIT))
        came = {}
        for name in ("home", "altitude", "imu", "odometry", "unix_epoch_time"):
            came[name] = []
            subscribe = getattr(telemetry, f"subscribe_{name}")
            subscribe(lambda value, _, name=name: came[name].append(value))
        # mavsdk itself asks for home, but once.
        until(lambda: all(len(values) > 1 for values in came.values()), f"two of each: {came}")
        home, altitude = came["home"][-1], came["altitude"][-1]
        assert (home.latitude_deg, home.longitude_deg) == pytest.approx((-33.9, 151.2))
        assert (home.absolute_altitude_m, altitude.altitude_relative_m) == pytest.approx((20, 50))
        assert altitude.altitude_amsl_m == pytest.approx(70)
        assert came["unix_epoch_time"][-1] > 1_767_225_600_000_000
        imu, odometry = came["imu"][-1], came["odometry"][-1]
        assert imu.angular_velocity_frd.right_rad_s == 0
        assert imu.acceleration_frd.down_m_s2 == pytest.approx(-9.8, abs=0.2)
        assert imu.acceleration_frd.right_m_s2 == 0
        assert (odometry.position_body.x_m, odometry.position_body.z_m) == (0, -50)
        assert odometry.velocity_body.x_m_s == 0
        assert odometry.q.z == pytest.approx(math.sin(math.pi / 4), abs=0.01)
        until(telemetry.in_air, "a vehicle in the air")
        assert telemetry.landed_state() == LandedState.IN_AIR
        assert telemetry.velocity_ned().north_m_s == 0
        assert telemetry.heading().heading_deg == 90


def test_mavsdk_reads_what_the_vehicle_says_of_its_parameters(simulate):
    simulation = simulate(*LASTING)
    with Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION)) as sdk:
        sdk.add_any_connection(simulation.address.replace("udpin:", "udpin://"))
        metadata = ComponentMetadata(sdk.first_autopilot(LIMIT))
        metadata.request_autopilot_component()

        def described():
            try:
                return metadata.get_metadata(1, MetadataType.PARAMETER).json_metadata
            except ComponentMetadataError:
                return None

        told = json.loads(until(described, "the metadata of parameters"))["parameters"]
        assert set(parameters()) <= {one["name"] for one in told}


def test_mavsdk_finds_tunes_arms_and_watches(simulate):
    simulation = simulate(*LASTING)
    with Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION)) as sdk:
        sdk.add_any_connection(simulation.address.replace("udpin:", "udpin://"))
        system = sdk.first_autopilot(LIMIT)
        assert system is not None

        param = Param(system)
        # mavsdk asks for the vehicle's version when it finds it, and reads there that whole numbers are integers.
        every = param.get_all_params()
        integers = {p.name: p.value for p in every.int_params}
        floats = {p.name: p.value for p in every.float_params}
        assert {**integers, **floats} == pytest.approx(parameters(), rel=1e-6)
        assert "MPP_PATHS" in integers and "MPP_ALT_M" in floats
        assert param.get_param_int("MPP_PATHS") == 25
        param.set_param_int("MPP_PATHS", 12)
        assert param.get_param_int("MPP_PATHS") == 12
        param.set_param_float("MPP_ALT_M", 51.5)
        assert param.get_param_float("MPP_ALT_M") == 51.5
        with pytest.raises(ParamError):
            param.get_param_float("NO_SUCH_THING")

        telemetry = Telemetry(system)
        with pytest.raises(ActionError) as refused:
            Action(system).goto_location(47.4, 8.5, 60.0, 0.0)
        assert refused.value.result == ActionResult.COMMAND_DENIED
        Action(system).arm()
        until(telemetry.armed, "an armed vehicle")

        seen = []
        telemetry.subscribe_attitude_euler(lambda angle, _: seen.append((angle.timestamp_us, angle.pitch_deg)))
        telemetry.set_rate_attitude_euler(50.0)
        before = len(seen)
        until(lambda: len(seen) >= before + 150, "150 attitudes")
        # The time is that of the vehicle's clock. A datagram may be lost or late.
        times = [time for time, _ in seen[before + 50:]]
        assert statistics.median(b - a for a, b in zip(times, times[1:])) == 20_000
        assert all(-60 < pitch < 60 for _, pitch in seen)
        until(lambda: telemetry.position_velocity_ned().position.north_m > 10, "ten metres downrange")
        assert -telemetry.position_velocity_ned().position.down_m == pytest.approx(50, abs=11)
        assert Info(system).get_version().flight_sw_major == 0
