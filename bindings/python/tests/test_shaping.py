"""Rewards that are shaped, and observations without units."""

import gymnasium
import mppflight
import mppflight.environments
import numpy as np
import pytest

NAMES = ["mpp/Control-v0", "mpp/Choice-v0"]


def equal(one, other):
    return one.keys() == other.keys() and all(np.array_equal(one[key], other[key]) for key in one)


@pytest.mark.parametrize("name", NAMES)
def test_rewards_are_shaped_by_clearance_and_effort(name):
    reward = {"clearance": 2.0, "margin": 40.0, "effort": 0.5}
    plain, shaped = (gymnasium.make(name, reward=one, obstacles=40).unwrapped for one in (None, reward))
    # Full thrust and elevator, or the planner's own choice.
    action = np.ones(2) if name == NAMES[0] else 0
    for env in (plain, shaped):
        env.reset(seed=3)
    for _ in range(3):
        (_, usual, *_, truth), (_, less, *_, same) = plain.step(action), shaped.step(action)
        assert truth == same and 0 < truth["clearance"] < 40
        if name == NAMES[0]:
            assert usual - less == pytest.approx(0.01 * (2.0 * (1 - truth["clearance"] / 40) + 0.5 * 2))
        # A cycle has up to 100 ticks, each of which costs at most this.
        assert 0 < usual - less < 3.0
    with pytest.raises(mppflight.InputError, match="reward: give numbers for clearance, margin, effort, not way=1.0"):
        gymnasium.make(name, reward={"way": 1.0})
    with pytest.raises(mppflight.InputError, match="reward: give clearance and effort from 0, and margin more than 0 m"):
        gymnasium.make(name, reward={"clearance": -1.0})


@pytest.mark.parametrize("name", NAMES)
def test_observations_have_no_units_if_asked(name):
    plain, bare = (gymnasium.make(name, normalised=one, obstacles=40) for one in (False, True))
    (usual, _), (seen, _) = plain.reset(seed=3), bare.reset(seed=3)
    assert np.allclose(seen["lidar"] * plain.unwrapped._sight, usual["lidar"])
    assert bare.observation_space.contains(seen) and plain.observation_space.contains(usual)
    air, known = ("air", "air") if "air" in seen else ("state", "state")
    assert seen[air][0] == pytest.approx(usual[known][0] / mppflight.Aircraft().trim["airspeed"] - 1, abs=1e-6)
    assert all(np.abs(value).max() <= 2 for key, value in seen.items() if key != "mask")
    with pytest.raises(mppflight.InputError, match="normalised: give True or False, not 2"):
        gymnasium.make(name, normalised=2)


def test_flights_side_by_side_are_shaped_as_single_ones():
    keys = {"reward": {"clearance": 1.0, "margin": 30.0}, "normalised": True, "obstacles": 40}
    many, one = gymnasium.make_vec("mpp/Control-v0", num_envs=2, **keys), gymnasium.make("mpp/Control-v0", **keys)
    (seen, _), (alone, _) = many.reset(seed=5), one.reset(seed=5)
    assert equal({key: value[0] for key, value in seen.items()}, alone)
    seen, rewards, *_ = many.step(np.zeros((2, 2)))
    alone, reward, *_ = one.step(np.zeros(2))
    assert rewards[0] == reward and equal({key: value[0] for key, value in seen.items()}, alone)
