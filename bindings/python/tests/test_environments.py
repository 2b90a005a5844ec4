"""The Gymnasium environments."""

import copy
import pickle
import threading
import time
import warnings

import gymnasium
import mppflight
import mppflight.environments
import mppflight.speed
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

NAMES = ["mpp/Control-v0", "mpp/Choice-v0"]


def equal(one, other):
    return one.keys() == other.keys() and all(np.array_equal(one[key], other[key]) for key in one)


def flown(env, actions):
    """Observations, rewards and ends of some steps."""
    steps = []
    for action in actions:
        step = env.step(action)
        steps.append(step)
        if step[2] or step[3]:
            break
    return steps


@pytest.mark.parametrize("name", NAMES)
def test_gymnasiums_own_checks_pass(name, monkeypatch):
    # It asks for a window, too.
    monkeypatch.setattr(mppflight.plots, "WINDOWLESS", ())
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        # Places and prices have no bound that means anything.
        for known in ("A Box observation space", "the casting"):
            warnings.filterwarnings("ignore", message=f".*{known}.*")
        check_env(gymnasium.make(name).unwrapped)


@pytest.mark.parametrize("name", NAMES)
def test_a_copy_goes_on_by_itself(name):
    env = gymnasium.make(name, duration=6).unwrapped
    env.reset(seed=5)
    steps = [env.action_space.sample() * 0 for _ in range(3)]
    env.step(steps[0])
    copied = copy.deepcopy(env)
    for a, b in zip(flown(env, steps), flown(copied, steps), strict=True):
        assert equal(a[0], b[0]) and a[1:] == b[1:]
    # The original went on; the copy draws the seeds that it would have drawn.
    assert copied.reset()[1]["seed"] == env.reset()[1]["seed"]
    many = gymnasium.make_vec("mpp/Control-v0", num_envs=2)
    many.reset(seed=1)
    actions = np.zeros((2, 2))
    assert equal(copy.deepcopy(many).step(actions)[0], many.step(actions)[0])


@pytest.mark.parametrize("name", NAMES)
def test_options_that_mean_nothing_are_refused(name):
    env = gymnasium.make(name, duration=1)
    env.reset(seed=1, options={})
    with pytest.raises(mppflight.InputError, match="options: give none, not {'obstacles': 3}"):
        env.reset(options={"obstacles": 3})
    for nothing in (0, "", [], False, np.zeros(0)):
        with pytest.raises(mppflight.InputError, match="options: give none, not"):
            env.reset(options=nothing)
    with pytest.raises(mppflight.InputError, match="options: give none"):
        gymnasium.make_vec("mpp/Control-v0", num_envs=2).reset(options={"obstacles": 3})


def test_the_mask_has_an_entry_for_each_action():
    env = gymnasium.make("mpp/Choice-v0").unwrapped
    observation, _ = env.reset(seed=1)
    mask = env.action_masks()
    assert mask.shape == (env.action_space.n,) and mask.dtype == bool
    assert mask[0] and (mask == observation["mask"]).all()
    # The rest has no price of its own.
    assert (observation["price"][mask[1:]] < 1e6).all() and (observation["price"][~mask[1:]] == 1e6).all()


@pytest.mark.parametrize("name", NAMES)
def test_no_return_is_not_an_obstacle_before_the_nose(name):
    env = gymnasium.make(name, obstacles=0, lidar={"range_max": 30.0})
    assert (env.reset(seed=1)[0]["lidar"] == 30.0).all()
    wall = {"polygon": [{"points": [[1.0, 40.0], [2.0, 40.0], [2.0, 60.0], [1.0, 60.0]]}]}
    near = gymnasium.make(name, field=wall).reset(seed=1)[0]["lidar"]
    assert 0.0 < near.min() < 2.0


@pytest.mark.parametrize("name", NAMES)
def test_a_seed_gives_the_same_flight(name):
    one, other = gymnasium.make(name), gymnasium.make(name)
    one.action_space.seed(3)
    for seed in (5, None, None):
        (first, told), (second, _) = one.reset(seed=seed), other.reset(seed=seed)
        assert equal(first, second) and told["seed"] == (seed or told["seed"])
        actions = [one.action_space.sample() * 0 if name == NAMES[1] else one.action_space.sample() for _ in range(30)]
        for a, b in zip(flown(one, actions), flown(other, actions), strict=True):
            assert equal(a[0], b[0]) and a[1:] == b[1:]
    another, _ = other.reset(seed=6)
    assert not equal(one.reset(seed=5)[0], another)


@pytest.mark.parametrize("name", NAMES)
def test_a_state_is_restored_bit_for_bit_also_in_another_process(name):
    env = gymnasium.make(name, obstacles=30, faults={"gusts": {"intensity": 1.0}}).unwrapped
    env.reset(seed=8)
    rng = np.random.default_rng(1)
    actions = [0, 1, 2, 0, 3, 0] if name == NAMES[1] else list(rng.uniform(-0.1, 0.1, (120, 2)))
    half = len(actions) // 2
    flown(env, actions[:half])
    state = env.save()
    first = flown(env, actions[half:])
    following = env.reset()[1]["seed"]
    for copy in (state, pickle.loads(pickle.dumps(state))):
        env.restore(copy)
        again = flown(env, actions[half:])
        assert len(first) == len(again) > 1
        for a, b in zip(first, again, strict=True):
            assert equal(a[0], b[0]) and a[1:] == b[1:]
        assert env.reset()[1]["seed"] == following
    other = gymnasium.make(name, obstacles=31).unwrapped
    other.reset(seed=8)
    with pytest.raises(mppflight.InputError, match="other keys"):
        other.restore(state)
    for wrong in (None, 3, state.flight, gymnasium.make(NAMES[name == NAMES[0]]).unwrapped):
        if isinstance(wrong, gymnasium.Env):
            wrong.reset(seed=8)
            wrong = wrong.save()
        with pytest.raises(mppflight.InputError, match="^state: give what save"):
            env.restore(wrong)


def test_the_commands_of_a_flight_fly_the_flight():
    """The agent repeats the commands of the core and comes to the same places."""
    columns = mppflight.fly(seed=1, duration=4).columns
    env = gymnasium.make("mpp/Control-v0", duration=4).unwrapped
    env.reset(seed=1)
    low, high = np.array(env.controls).T
    commands = np.column_stack([columns["elevator"], columns["thrust"]])
    # Level with the core to within the rounding of the scale from -1 to 1.
    actions = 2.0 * (commands - low) / (high - low) - 1.0
    assert np.abs(actions).max() <= 1.0
    steps = flown(env, actions)
    assert np.allclose([step[4]["x"] for step in steps[:-1]], columns["x"][1:], atol=1e-6)
    assert steps[-1][3] and steps[-1][4]["outcome"] == "survived"
    assert sum(step[1] for step in steps) == pytest.approx(columns["x"][-1] / 48.0, abs=0.01)


@pytest.mark.parametrize("keys", [{}, {"latency_ms": 200, "replan_hz": 2.0}, {"latency_ms": 1000}])
def test_the_planners_own_choice_flies_what_fly_flies(keys):
    keys = {"obstacles": 30, "duration": 10, **keys}
    columns = mppflight.fly(seed=4, **keys).columns
    env = gymnasium.make("mpp/Choice-v0", **keys)
    _, told = env.reset(seed=4)
    while told["outcome"] is None:
        tick = round(100.0 * told["t"])
        assert (told["x"], told["z"]) == (columns["x"][tick], columns["z"][tick])
        _, reward, failed, ended, told = env.step(0)
    assert ended and told["t"] == 10.0 and told["outcome"] == "survived"


def test_another_choice_is_another_flight_and_no_candidate_keeps_the_plan():
    env = gymnasium.make("mpp/Choice-v0")
    ends = []
    for action in (0, 2, env.action_space.n - 1):
        observation, _ = env.reset(seed=1)
        assert observation["mask"].sum() > 3 and (np.diff(observation["price"]) >= 0.0).all()
        ends.append(env.step(action)[4]["z"])
    assert len(set(ends)) == 3


def test_flights_side_by_side_are_those_of_single_ones():
    many = gymnasium.make_vec("mpp/Control-v0", num_envs=4, obstacles=60)
    singles = [gymnasium.make("mpp/Control-v0", obstacles=60).unwrapped for _ in range(4)]
    observations, _ = many.reset(seed=20)
    starts = [env.reset(seed=20 + index)[0] for index, env in enumerate(singles)]
    rng, alive = np.random.default_rng(2), [True] * 4
    for _ in range(300):
        for index, start in enumerate(starts):
            if alive[index]:
                assert equal({key: rows[index] for key, rows in observations.items()}, start)
        actions = rng.uniform(-1.0, 1.0, (4, 2))
        observations, rewards, failed, ended, _ = many.step(actions)
        for index, env in enumerate(singles):
            if alive[index]:
                starts[index], reward, *ends, _ = env.step(actions[index])
                assert (reward, *ends) == (rewards[index], failed[index], ended[index])
                alive[index] = not any(ends)
    # Random actions end flights soon; the flights beside them go on, and ended ones start anew.
    assert not all(alive) and many.observation_space.contains(observations)


def test_a_flight_may_end_after_some_steps():
    """Side by side as alone, where Gymnasium counts them."""
    many = gymnasium.make_vec("mpp/Control-v0", num_envs=2, max_episode_steps=3)
    one = gymnasium.make("mpp/Control-v0", max_episode_steps=3)
    many.reset(seed=4)
    one.reset(seed=4)
    ends = []
    for _ in range(8):
        observations, _, failed, ended, _ = many.step(np.zeros((2, 2)))
        ends.append(ended.tolist())
        if len(ends) <= 3:
            observation, _, _, cut, _ = one.step(np.zeros(2))
            assert cut == ended[0] and equal({key: rows[0] for key, rows in observations.items()}, observation)
    # The fourth step starts anew.
    assert ends == [[False] * 2, [False] * 2, [True] * 2, [False] * 2] * 2
    for most in (0, -1, 2.5, True, "3"):
        with pytest.raises(mppflight.InputError, match="max_episode_steps: give 1 to"):
            gymnasium.make_vec("mpp/Control-v0", num_envs=2, max_episode_steps=most)


@pytest.mark.parametrize("name", NAMES)
def test_too_early_and_too_late(name):
    env = gymnasium.make(name, duration=1).unwrapped
    action = env.action_space.sample() * 0
    for too_early in (lambda: env.step(action), env.save):
        with pytest.raises(mppflight.StateError, match="call reset first"):
            too_early()
    env.reset(seed=1)
    while not any(env.step(action)[2:4]):
        pass
    with pytest.raises(mppflight.StateError, match="call reset"):
        env.step(action)
    env.close()
    for too_late in (env.reset, lambda: env.step(action), env.save):
        with pytest.raises(mppflight.StateError, match="closed"):
            too_late()


def test_actions_that_make_no_sense():
    env = gymnasium.make("mpp/Control-v0").unwrapped
    env.reset(seed=1)
    for action in ([np.nan, 0.0], [0.0, 1.5], [0.0], [0.0, 0.0, 0.0], [True, False], ["a", "b"]):
        with pytest.raises(mppflight.InputError, match="actions"):
            env.step(np.array(action))
    many = gymnasium.make_vec("mpp/Control-v0", num_envs=3)
    many.reset(seed=1)
    with pytest.raises(mppflight.InputError, match="a row for each of the 3 flights"):
        many.step(np.zeros((2, 2)))
    before = many.unwrapped._batch.truth(0)
    with pytest.raises(mppflight.InputError, match="give -1 to 1"):
        many.step(np.array([[0.0, 0.0], [0.0, 0.0], [0.0, 2.0]]))
    assert many.unwrapped._batch.truth(0) == before
    for count in (-1, 0, 10**12, 1.5, True, "2", None):
        with pytest.raises(mppflight.InputError, match="num_envs: give 1 to"):
            gymnasium.make_vec("mpp/Control-v0", num_envs=count)
    with pytest.raises(mppflight.InputError, match="lidar_hz"):
        gymnasium.make("mpp/Control-v0", lidar_hz=7.0)
    with pytest.raises(mppflight.InputError, match="faults.link"):
        gymnasium.make("mpp/Control-v0", faults={"link": {"loss": 0.1}}).reset(seed=1)
    with pytest.raises(mppflight.InputError, match="only flight has candidates"):
        gymnasium.make("mpp/Choice-v0", preset="paper")
    env = gymnasium.make("mpp/Choice-v0").unwrapped
    env.reset(seed=np.int64(1))
    most = env.action_space.n - 1
    for action in (-1, most + 1, 2**70, 0.5, "a", None, [1], True, np.True_):
        with pytest.raises(mppflight.InputError, match=f"action: give 0 to {most}, not"):
            env.step(action)
    env.step(np.int64(most))
    env.step(np.array(0))


@pytest.mark.parametrize(
    ("key", "keys"),
    [
        ("slices_per_tick", {"slices_per_tick": 1000}),
        ("faults.scan.delay_ms", {"faults": {"scan": {"delay_ms": 20}}}),
        ("faults.scan.show", {"faults": {"scan": {"show": "zeros"}}}),
        ("faults.scan.missing", {"faults": {"scan": {"missing": True, "from": 3.0}}}),
        ("faults.scan.one_late", {"faults": {"scan": {"one_late": True}}}),
        ("known_map", {"known_map": True}),
        ("oracle", {"oracle": True}),
    ],
)
def test_what_a_choice_could_not_fly_as_fly_does_is_refused(key, keys):
    with pytest.raises(mppflight.InputError, match=key):
        gymnasium.make("mpp/Choice-v0", **keys)


@pytest.mark.parametrize("key", ["oracle", "known_map"])
def test_a_controlled_flight_has_no_truth(key):
    with pytest.raises(mppflight.InputError, match=f"{key}: it needs the"):
        gymnasium.make("mpp/Control-v0", **{key: True})


def starts(many, seed, steps=200):
    """Seeds of the flights of some steps, also of those that start anew."""
    many.reset(seed=seed)
    seeds = []
    for _ in range(steps):
        many.step(np.ones((many.num_envs, 2)))
        seeds.append([many.unwrapped._batch.truth(index)["seed"] for index in range(many.num_envs)])
    return seeds


def test_a_seed_or_a_list_of_seeds_also_gives_the_flights_that_start_anew():
    one, other = (gymnasium.make_vec("mpp/Control-v0", num_envs=2, duration=1) for _ in range(2))
    first = starts(one, [7, 9])
    assert first[0] == [7, 9] != first[-1]
    assert first == starts(other, np.array([7, 9])) != starts(other, [7, 10])
    assert starts(one, 7)[0] == [7, 8] and starts(one, 7) == starts(other, np.int64(7))
    assert starts(one, [None, 5], 1)[0][1] == 5


@pytest.mark.parametrize("seed", [[], [1], [1, 2, 3], [1, -2], -1, 2**64, 2**64 - 1, 1.5, "ab", [1, 2.5], True, [True, False], np.array([1.0, 2.0])])
def test_seeds_that_make_no_sense(seed):
    with pytest.raises(mppflight.InputError, match="seed: give a whole number"):
        gymnasium.make_vec("mpp/Control-v0", num_envs=2).reset(seed=seed)
    for name in NAMES:
        if not np.array_equal(seed, 2**64 - 1):
            with pytest.raises(mppflight.InputError, match="seed: give a whole number"):
                gymnasium.make(name).reset(seed=seed)


@pytest.mark.parametrize("name", NAMES)
def test_a_seed_among_the_keys_is_that_of_the_first_flight(name):
    """So an environment with the keys of the benchmark flies its field."""
    keyed, plain = gymnasium.make(name, seed=7), gymnasium.make(name)
    assert equal(keyed.reset()[0], plain.reset(seed=7)[0])
    assert keyed.reset()[1]["seed"] == plain.reset()[1]["seed"] != 7
    assert gymnasium.make(name, seed=7).reset(seed=8)[1]["seed"] == 8
    many = gymnasium.make_vec("mpp/Control-v0", num_envs=2, seed=7)
    many.reset()
    assert [many.unwrapped._batch.truth(index)["seed"] for index in range(2)] == [7, 8]


@pytest.mark.parametrize("name", NAMES)
def test_a_small_stack_is_enough(name):
    def flight():
        env = gymnasium.make(name, duration=2).unwrapped
        env.reset(seed=1)
        state = env.save()
        first = env.step(env.action_space.sample() * 0)
        env.restore(pickle.loads(pickle.dumps(state)))
        again = env.step(env.action_space.sample() * 0)
        same.append(equal(first[0], again[0]))

    same = []
    size = threading.stack_size(256 * 1024)
    try:
        thread = threading.Thread(target=flight)
        thread.start()
        thread.join()
    finally:
        threading.stack_size(size)
    assert same == [True]


def test_the_second_thread_on_one_environment_gets_an_exception():
    many = gymnasium.make_vec("mpp/Control-v0", num_envs=200)
    many.reset(seed=1)
    refused, broken, actions = [], [], np.zeros((200, 2))

    def step():
        while not refused and not broken and time.monotonic() < end:
            try:
                many.step(actions)
            except mppflight.BusyError as error:
                refused.append(error)
            except BaseException as error:
                broken.append(error)

    end = time.monotonic() + 60.0
    threads = [threading.Thread(target=step) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert refused and not broken


def test_rates_are_printed(capsys, monkeypatch):
    monkeypatch.setattr(mppflight.speed, "DURATION", 0.01)
    monkeypatch.setattr("sys.argv", ["speed"])
    mppflight.speed.main()
    rates = [float(line.split()[-1].replace(",", "")) for line in capsys.readouterr().out.splitlines()[1:]]
    assert len(rates) == 3 and min(rates) > 0.0
