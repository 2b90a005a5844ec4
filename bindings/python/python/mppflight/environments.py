"""Gymnasium environments. Importing this module registers them:

- `mpp/Control-v0`: the agent moves elevator and thrust, 100 times a second.
- `mpp/Choice-v0`: the agent chooses among the planner's candidates, once a cycle.

Further arguments of `gymnasium.make` are keys of a scenario, for example `obstacles=40`. A flight has the seed that
`reset` gets, the first one without it that of the key `seed`; otherwise it is drawn from the environment's generator.
Its obstacles, noise and gusts are those of `mppflight.fly` with this seed.

`reward` takes what a second costs besides: `clearance` times the missing share of a `margin` [m] to the nearest obstacle,
and `effort` times the squares of the elevator's and the thrust's share of their ranges. `normalised=True` gives
observations without units: ranges as shares of the greatest, airspeed as its share beyond cruise, places as shares of the way
and of the band, ages in seconds, prices p as p / (1 + p).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Generic, TypeVar, Unpack

import gymnasium
import numpy
from gymnasium import spaces
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from ._native import Batch, Choice, Fork, Moment
from .errors import InputError, StateError, whole
from .keys import ScenarioKeys
from .observations import Observation, Reward, Units, box, shaping
from .plots import Window

Step = tuple[Observation, float, bool, bool, dict[str, Any]]
Saved = TypeVar("Saved")


@dataclass(frozen=True)
class State(Generic[Saved]):
    """All that an environment goes on from: the flight, and the generator that draws the next seeds. It pickles."""

    flight: Saved
    random: dict[str, Any]


def _drawn(random: numpy.random.Generator) -> int:
    return int(random.integers(2**32))


def _seed(value: Any) -> int:
    """A seed, also one of NumPy's integers."""
    return whole("seed", value, 0, 2**64 - 1, "a whole number from 0 to 2**64 - 1")


def _refuse(options: dict[str, Any] | None) -> None:
    if options is not None and not (isinstance(options, dict) and not options):
        raise InputError(f"options: give none, not {options!r}: keys of a scenario go to gymnasium.make")


def _is_list(value: Any) -> bool:
    return isinstance(value, (list, tuple, numpy.ndarray)) and numpy.shape(value) != ()


def _seeds(value: Any, count: int) -> list[int | None]:
    """A seed for each flight: numbers from a first one on, or those of a list."""
    if value is None:
        return [None] * count
    if _is_list(value):
        if len(value) != count:
            raise InputError(f"seed: give a whole number or a list of {count}, not {value!r}")
        return [None if one is None else _seed(one) for one in value]
    first = _seed(value)
    return [_seed(first + index) for index in range(count)]


class _Single(gymnasium.Env[Observation, Any], Generic[Saved]):
    """What both environments have in common: seeds, states and pictures of one flight."""

    metadata = {"render_modes": ["rgb_array", "human"], "render_fps": 100}
    # The place of the flight among those of a batch.
    _place: tuple[int, ...] = ()
    _kind: type[Saved]

    def _open(self, native: Batch | Choice, units: Units, first: int | None, mode: str | None) -> None:
        if mode not in (None, *self.metadata["render_modes"]):
            raise InputError(f"render_mode: give rgb_array, human or None, not {mode!r}")
        self._native: Any = native
        self._units = units
        self._first = first
        beams, self._sight, view = native.lidar
        self._angles = numpy.linspace(-0.5 * view, 0.5 * view, beams) if beams > 1 else numpy.zeros(1)
        self.render_mode, self._window = mode, Window(mode == "human") if mode else None
        self._way: list[tuple[float, float]] = []

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        _refuse(options)
        seed, self._first = self._first if seed is None else seed, None
        seed = None if seed is None else _seed(seed)
        super().reset(seed=seed)
        native, seed = _of(self._native), _drawn(self.np_random) if seed is None else seed
        native.reset([seed] if self._place else seed)
        return self._start()

    def _start(self) -> tuple[Observation, dict[str, Any]]:
        self._way, truth = [], self._native.truth(*self._place)
        self._at(truth)
        return self._units.of(self._native.observe_one()), truth

    def _at(self, truth: dict[str, Any]) -> None:
        """The aircraft came to a place."""
        if self.render_mode:
            self._way.append((truth["x"], truth["z"]))
            # A person sees 25 pictures a second.
            if self.render_mode == "human" and (self.metadata["render_fps"] < 25 or len(self._way) % 4 == 1):
                self.render()

    def render(self) -> NDArray[numpy.uint8] | None:
        """The picture of the flight as it is now, or its window."""
        native = _of(self._native)
        seen, truth = native.observe_one(), native.truth(*self._place)
        if self._window is None:
            gymnasium.logger.warn("nothing is drawn: give gymnasium.make a render_mode, rgb_array or human")
            return None
        ranges, (x, z) = seen["lidar"], self._way[-1]
        met, pitch = ranges < self._sight, (seen["air"] if "air" in seen else seen["state"])[1]
        angles = self._angles[met] + pitch
        hits = numpy.column_stack([x + ranges[met] * numpy.cos(angles), z + ranges[met] * numpy.sin(angles)])
        plans = seen["candidates"][seen["mask"][1:] > 0] + (x, z) if "candidates" in seen else numpy.zeros((0, 2, 2))
        return self._window.draw(native.field(*self._place), truth["t"], self._way, hits, self._sight, plans)

    def save(self) -> State[Saved]:
        """The state of the environment, to go on from it any number of times."""
        flight = _of(self._native).save(*self._place)
        return State(flight, self.np_random.bit_generator.state)  # type: ignore[arg-type]

    def restore(self, state: State[Saved]) -> Observation:
        """Goes on from a saved state, bit for bit."""
        native = _of(self._native)
        if not isinstance(state, State) or not isinstance(state.flight, self._kind):
            raise InputError(f"state: give what save() of such an environment gave, not {state!r}")
        native.restore(*self._place, state.flight)
        self.np_random.bit_generator.state = state.random
        return self._start()[0]

    def close(self) -> None:
        self._native = None
        if self._window is not None:
            self._window.close()


def _control_spaces(batch: Batch, units: Units) -> tuple[spaces.Dict[Any], spaces.Box]:
    beams, range_max, _ = batch.lidar
    observation: spaces.Dict[Any] = spaces.Dict(
        {
            "lidar": box((beams,), 0.0, range_max),
            "air": box((2,)),
            "position": box((2,)),
            "age": box((2,), 0.0),
        }
    )
    return units.space(observation), spaces.Box(-1.0, 1.0, (2,), numpy.float64)


class ControlEnv(_Single[Moment]):
    """Elevator and thrust, one step a tick of 10 ms.

    Observation: `lidar`, ranges of the last scan [m], the greatest where nothing came back; `air`, measured airspeed [m/s] and
    pitch [rad]; `position`, measured, downrange and up [m]; `age` of position and scan [s].
    Action: elevator and thrust from -1 to 1; `controls` holds what they mean. The middle of the elevator is about
    level trim, the least thrust is 0.
    Reward: the share of the way at cruise, about 1 for a whole flight, and -1 for a failure. A flight fails by the
    strict rule: collision, extreme attitude, or out of the band.
    """

    _place, _kind = (0,), Moment

    def __init__(
        self,
        lidar_hz: float = 10.0,
        render_mode: str | None = None,
        reward: Reward | None = None,
        normalised: bool = False,
        **scenario: Unpack[ScenarioKeys],
    ) -> None:
        batch = Batch({**scenario}, 1, lidar_hz, shaping(reward))
        self.controls = batch.controls
        units = Units(batch, normalised)
        self.observation_space, self.action_space = _control_spaces(batch, units)
        self._open(batch, units, scenario.get("seed"), render_mode)

    def step(self, action: NDArray[Any]) -> Step:
        seen, *rest, truth = _of(self._native).step_one(action)
        self._at(truth)
        return self._units.of(seen), *rest, truth


class ControlVectorEnv(VectorEnv[Observation, NDArray[Any], NDArray[Any]]):
    """Many flights of `ControlEnv` side by side, all in one call of native code. After its end a flight starts anew."""

    metadata = {"render_modes": [], "autoreset_mode": AutoresetMode.NEXT_STEP}

    def __init__(
        self,
        num_envs: int = 1,
        lidar_hz: float = 10.0,
        render_mode: str | None = None,
        max_episode_steps: int | None = None,
        reward: Reward | None = None,
        normalised: bool = False,
        **scenario: Unpack[ScenarioKeys],
    ) -> None:
        if render_mode is not None:
            raise InputError("render_mode: give it to gymnasium.make, flights side by side are not drawn")
        most = 2**62 if max_episode_steps is None else max_episode_steps
        self._most = whole("max_episode_steps", most, 1, 2**62)
        self.num_envs = num_envs
        batch = Batch({**scenario}, num_envs, lidar_hz, shaping(reward))
        self._batch: Batch | None = batch
        self._units = Units(batch, normalised)
        self._first = scenario.get("seed")
        self.single_observation_space, self.single_action_space = _control_spaces(batch, self._units)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._done, self._steps = numpy.zeros(num_envs, bool), numpy.zeros(num_envs, numpy.int64)

    def reset(
        self, *, seed: int | list[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """With a seed, flight k gets the k-th number from it on; with a list, each gets its own, or a drawn one for
        None. Flights that start anew later draw theirs from a generator that a seed, or a list without None, sets.
        """
        _refuse(options)
        seed, self._first = self._first if seed is None else seed, None
        seeds = _seeds(seed, self.num_envs)
        listed = _is_list(seed)
        super().reset(seed=None if listed else seeds[0])
        given = [one for one in seeds if one is not None]
        if listed and len(given) == self.num_envs:
            self.np_random = numpy.random.default_rng(given)
        batch = _of(self._batch)
        batch.reset([_drawn(self.np_random) if one is None else one for one in seeds])
        self._done[:], self._steps[:] = False, 0
        return self._units.of(dict(batch.observe())), {}

    def step(
        self, actions: NDArray[Any]
    ) -> tuple[Observation, NDArray[Any], NDArray[Any], NDArray[Any], dict[str, Any]]:
        batch, fresh = _of(self._batch), None
        if self._done.any():
            fresh = [_drawn(self.np_random) if done else None for done in self._done]
        rewards, failed, ended = batch.step(actions, fresh)
        self._steps = numpy.where(self._done, 0, self._steps + 1)
        ended |= self._steps >= self._most
        self._done = failed | ended
        return self._units.of(dict(batch.observe())), rewards, failed, ended, {}

    def close_extras(self, **_: Any) -> None:
        self._batch = None


class ChoiceEnv(_Single[Fork]):
    """A choice among the candidates of the planner, one step a planning cycle.

    Observation: `lidar`, as that of `ControlEnv`; `state`, estimated airspeed [m/s], pitch and flight path angle [rad]
    and height above the altitude [m]; `candidates` by price, as places from the aircraft [m]; `price` of each; `mask`,
    which actions there are.
    Action: 0 is the planner's own best plan, which `mppflight.fly` flies; k is the candidate with the k-th lowest price.
    A number beyond the candidates keeps the last plan.
    Reward: as that of `ControlEnv`.
    """

    _kind = Fork

    def __init__(
        self,
        render_mode: str | None = None,
        reward: Reward | None = None,
        normalised: bool = False,
        **scenario: Unpack[ScenarioKeys],
    ) -> None:
        choice = Choice({**scenario}, shaping(reward))
        units = Units(choice, normalised)
        beams, range_max, _ = choice.lidar
        most, knots = Choice.SHAPE
        observation: spaces.Dict[Any] = spaces.Dict(
            {
                "lidar": box((beams,), 0.0, range_max),
                "state": box((4,)),
                "candidates": box((most, knots, 2)),
                "price": box((most,), 0.0),
                "mask": spaces.MultiBinary(1 + most),
            }
        )
        self.observation_space = units.space(observation)
        self.action_space = spaces.Discrete(1 + most)
        self.metadata = {**self.metadata, "render_fps": choice.rate}
        self._open(choice, units, scenario.get("seed"), render_mode)

    def step(self, action: numpy.int64) -> Step:
        choice, (most, _) = _of(self._native), Choice.SHAPE
        reward, failed, ended = choice.step(whole("action", action, 0, most))
        truth = choice.truth()
        self._at(truth)
        return self._units.of(choice.observe_one()), reward, failed, ended, truth

    def action_masks(self) -> NDArray[numpy.bool_]:
        """Which actions there are: the mask of the observation, as agents with masks ask for it."""
        mask: NDArray[numpy.bool_] = _of(self._native).observe_one()["mask"].astype(bool)
        return mask


Native = TypeVar("Native")


def _of(native: Native | None) -> Native:
    if native is None:
        raise StateError("the environment is closed: make another one")
    return native


def register() -> None:
    """Registers the environments with Gymnasium. They do without its wrappers: those cost time in each step, and the
    environments themselves refuse a step before a reset and an action out of its range.
    """
    gymnasium.register(
        "mpp/Control-v0",
        entry_point="mppflight.environments:ControlEnv",
        vector_entry_point="mppflight.environments:ControlVectorEnv",
        order_enforce=False,
        disable_env_checker=True,
    )
    gymnasium.register(
        "mpp/Choice-v0",
        entry_point="mppflight.environments:ChoiceEnv",
        order_enforce=False,
        disable_env_checker=True,
    )


register()
