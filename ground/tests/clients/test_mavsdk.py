"""mavsdk for Python: what a program on a companion computer would do."""

import time

import pytest

pytest.importorskip("mavsdk", reason="mavsdk is not installed")

from mavsdk import ComponentType, Configuration, Mavsdk
from mavsdk.plugins.action import Action
from mavsdk.plugins.info import Info
from mavsdk.plugins.param import Param, ParamError
from mavsdk.plugins.telemetry import Telemetry


def test_mavsdk_finds_tunes_arms_and_watches(simulate):
    simulation = simulate("--hold", "--speed", "1", "--duration", "60")
    with Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION)) as sdk:
        sdk.add_any_connection(simulation.address.replace("udpin:", "udpin://"))
        system = sdk.first_autopilot(10.0)
        assert system is not None

        param = Param(system)
        values = {p.name: p.value for p in param.get_all_params().float_params}
        assert len(values) == 34 and values["MPP_ALT_M"] == 50
        param.set_param_float("MPP_ALT_M", 51.5)
        assert param.get_param_float("MPP_ALT_M") == 51.5
        with pytest.raises(ParamError):
            param.get_param_float("NO_SUCH_THING")

        telemetry = Telemetry(system)
        Action(system).arm()
        deadline = time.monotonic() + 5
        while not telemetry.armed() and time.monotonic() < deadline:
            time.sleep(0.1)
        assert telemetry.armed()

        telemetry.set_rate_attitude_euler(40.0)
        seen = []
        telemetry.subscribe_attitude_euler(lambda angle, _: seen.append(angle.pitch_deg))
        time.sleep(0.5)
        before = len(seen)
        time.sleep(3.0)
        assert (len(seen) - before) / 3.0 == pytest.approx(40, rel=0.3)
        assert all(-60 < pitch < 60 for pitch in seen)
        position = telemetry.position_velocity_ned().position
        assert position.north_m > 10 and -position.down_m == pytest.approx(50, abs=11)
        assert Info(system).get_version().flight_sw_major == 0
