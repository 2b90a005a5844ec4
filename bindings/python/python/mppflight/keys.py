"""The keys of a scenario as types. tests/keys_of_scenarios.py writes this file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from os import PathLike
from typing import Any, Literal, Required, TypeAlias, TypedDict

from ._native import Aircraft, Field, Lidar

Path: TypeAlias = str | PathLike[str]
Preset: TypeAlias = Literal["reference", "paper", "flight"]
GeneratorName: TypeAlias = Literal["paper", "sealed", "endless", "forest", "canyon", "slalom", "walls", "wires"]
NavigationSource: TypeAlias = Literal["ideal", "rtk", "gnss-ins", "lidar-odometry"]
LidarKeys = TypedDict("LidarKeys", {"beams": int, "field_of_view_deg": float, "range_max": float,
    "range_error": float, "rule": Literal["nearest", "authors"]}, total=False)
GeneratorKeys = TypedDict("GeneratorKeys", {"name": GeneratorName, "radius": float, "gap": float, "spread": float,
    "cluster": int, "length": float, "velocity": Sequence[float]}, total=False)
NavigationKeys = TypedDict("NavigationKeys", {"source": NavigationSource, "rate_hz": float, "delay_ms": int,
    "sigma": float, "wander": float, "wander_time": float, "drift": float, "velocity_sigma": float}, total=False)
AirDataKeys = TypedDict("AirDataKeys", {"airspeed_sigma": float, "pitch_sigma_deg": float}, total=False)
FaultsActuatorsKeys = TypedDict("FaultsActuatorsKeys", {"thrust_max": float, "thrust_lag": float,
    "elevator_range": float, "elevator_rate": float, "elevator_delay": float, "thrust_delay": float,
    "untold_delay": float}, total=False)
FaultsGustsKeys = TypedDict("FaultsGustsKeys", {"intensity": float}, total=False)
FaultsModelErrorKeys = TypedDict("FaultsModelErrorKeys", {"mass": float, "lift_slope": float,
    "pitch_stiffness": float, "signs": Literal["given", "drawn"]}, total=False)
FaultsLidarKeys = TypedDict("FaultsLidarKeys", {"dropouts": float, "false_hits": float}, total=False)
FaultsAirspeedKeys = TypedDict("FaultsAirspeedKeys", {"from": float, "until": float, "toggle_hz": float,
    "scale": float, "bias": float, "ramp": float, "noise": float, "quantum": float, "frozen": bool}, total=False)
FaultsAirKeys = TypedDict("FaultsAirKeys", {"from": float, "until": float, "toggle_hz": float, "missing": bool,
    "delay_ms": int, "rate_hz": float}, total=False)
FaultsScanKeys = TypedDict("FaultsScanKeys", {"from": float, "until": float, "toggle_hz": float,
    "show": Literal["zeros", "full-range", "frozen", "reversed", "upper-half", "lower-half"], "sight": float,
    "age_ms": int, "rotation_deg": float, "missing": bool, "delay_ms": int, "one_late": bool}, total=False)
FaultsLinkKeys = TypedDict("FaultsLinkKeys", {"from": float, "until": float, "toggle_hz": float, "silent": bool,
    "loss": float}, total=False)
FaultsClockKeys = TypedDict("FaultsClockKeys", {"start": int, "from": float, "until": float, "jump": float},
    total=False)
FaultsKeys = TypedDict("FaultsKeys", {"actuators": FaultsActuatorsKeys, "gusts": FaultsGustsKeys,
    "model_error": FaultsModelErrorKeys, "lidar": FaultsLidarKeys, "airspeed": FaultsAirspeedKeys,
    "pitch": FaultsAirspeedKeys, "air": FaultsAirKeys, "x": FaultsAirspeedKeys, "z": FaultsAirspeedKeys,
    "position": FaultsAirKeys, "scan": FaultsScanKeys, "elevator": FaultsAirspeedKeys, "thrust": FaultsAirspeedKeys,
    "link": FaultsLinkKeys, "clock": FaultsClockKeys}, total=False)
# What all cells of a campaign have in common.
CommonKeys = TypedDict("CommonKeys", {"scenario": Path, "aircraft": Aircraft | Path | Mapping[str, Any],
    "world_scale": float, "body_radius": float, "scene": Literal["flytrap", "dynamics", "long-way"],
    "latency_ms": int, "slices_per_tick": int, "duration": float, "oracle": bool, "known_map": bool, "lidar": Lidar |
    Path | LidarKeys, "air_data": AirDataKeys, "navigation": NavigationSource | NavigationKeys, "faults": FaultsKeys,
    "field": Field | Path | Mapping[str, Any]}, total=False)
# The keys of a flight in space.
TerrainKeys = TypedDict("TerrainKeys", {"corner": Sequence[float], "cell": float, "rows": Sequence[Sequence[float]]},
    total=False)
SpaceKeys = TypedDict("SpaceKeys", {"preset": Required[Literal["space"]], "aircraft": Aircraft | Path | Mapping[str,
    Any], "airspeed": float, "world": str, "density": float, "window": float, "terrain": TerrainKeys,
    "altitude": float, "lidar": str, "sight": float, "sphere": float, "exact": bool, "see_through": bool,
    "candidates": int, "programs": bool, "baseline": str, "mode": str, "wind": Sequence[float], "gusts": float,
    "deskew": bool, "lidar_clock": float, "replan_hz": float, "latency_ms": int, "seed": int}, total=False)


class ScenarioKeys(CommonKeys, total=False):
    """The keys of a scenario: docs/scenarios/example.toml."""

    preset: Preset
    seed: int
    obstacles: int
    paths: int
    replan_hz: float
    generator: GeneratorName | GeneratorKeys
