"""Pictures: flights, campaigns, and what an environment shows."""

import base64
import copy
import io
import re
import subprocess
import sys

import gymnasium
import matplotlib
import mppflight
import mppflight.environments
import numpy as np
import pytest
from matplotlib import pyplot

matplotlib.use("agg")
NAMES = ["mpp/Control-v0", "mpp/Choice-v0"]
WALL = {"polygon": [{"points": [[30.0, 20.0], [32.0, 20.0], [32.0, 80.0], [30.0, 80.0]]}]}


@pytest.fixture(autouse=True)
def closed():
    yield
    pyplot.close("all")


def test_a_flight_is_drawn_with_its_field_its_plan_and_its_end():
    flight = mppflight.fly(field=WALL, duration=10)
    axes = flight.plot()
    way, plan, end = axes.get_lines()
    assert np.array_equal(way.get_xdata(), flight.columns["x"]) and np.array_equal(plan.get_ydata(), flight.columns["ref_z"], equal_nan=True)
    assert end.get_label() == "collision" and end.get_xdata() == [flight.columns["x"][-1]]
    # The wall is where it stands.
    [solid] = [path for path in axes.collections[0].get_paths() if len(path.vertices)]
    assert solid.vertices[:, 0].min() == pytest.approx(30.0, abs=0.3) and solid.vertices[:, 0].max() == pytest.approx(32.0, abs=0.3)
    own = pyplot.figure().subplots()
    assert mppflight.fly(obstacles=0, duration=1).plot(own) is own and not own.collections


def test_a_flight_in_space_is_drawn_from_above():
    flight = mppflight.fly(preset="space", density=0.005, seed=5)
    axes = flight.plot()
    assert np.array_equal(axes.get_lines()[0].get_ydata(), flight.columns["y"]) and axes.yaxis_inverted()
    # The trunks are those of its world.
    (trunks,) = axes.collections
    assert len(trunks.get_paths()) == flight.header["obstacles"]


def test_a_notebook_shows_a_flight_and_a_campaign():
    flight = mppflight.fly(seed=1, duration=2)
    picture = base64.b64decode(re.search('base64,(.*)"', flight._repr_html_())[1])
    assert pyplot.imread(io.BytesIO(picture)).shape == (250, 1000, 4) and not pyplot.get_fignums()
    rows = mppflight.campaign(obstacles=[10, 20], trials=2, duration=1)
    assert "<td>20</td><td>2</td><td>2</td><td>100.0</td><td>34.2-100.0</td>" in rows._repr_html_()
    assert "<td>" not in rows[:0]._repr_html_() and rows[:0].plot() is not None


def test_a_campaign_is_drawn_with_intervals():
    rows = mppflight.campaign(obstacles=[20, 10], replan_hz=[1, 4], trials=3, duration=1)
    axes = rows.plot()
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["replan_hz 1.0", "replan_hz 4.0"]
    line, _, bars = axes.containers[0]
    assert line.get_xdata().tolist() == [10, 20] and line.get_ydata().tolist() == [100, 100]
    low, high = mppflight.wilson(3, 3)
    assert np.allclose(bars[0].get_segments()[0][:, 1], [100 * low, 100 * high])


def test_without_matplotlib_there_is_text_and_advice():
    code = """
import sys
sys.modules["matplotlib"] = None
import mppflight, mppflight.environments
flight = mppflight.fly(duration=1)
assert "log" in flight._repr_html_() and "img" not in flight._repr_html_()
for draw in (flight.plot, mppflight.campaign(trials=1, duration=1).plot, lambda: mppflight.environments.ControlEnv(render_mode="human")):
    try:
        draw()
    except ImportError as error:
        assert "pip install matplotlib" in str(error)
    else:
        raise AssertionError
"""
    subprocess.run([sys.executable, "-c", code], check=True)


@pytest.mark.parametrize("name", NAMES)
def test_an_environment_shows_pictures(name):
    env, blind = (gymnasium.make(name, render_mode=mode, seed=3, obstacles=40) for mode in ("rgb_array", None))
    with pytest.raises(mppflight.StateError, match="call reset first"):
        env.render()
    starts = [one.reset()[0] for one in (env, blind)]
    first = env.render()
    assert first.shape == (320, 800, 3) and first.dtype == np.uint8
    assert np.array_equal(first, env.render())
    action = env.action_space.sample() * 0
    steps = [one.step(action)[0] for one in (env, blind)]
    # To look changes nothing.
    for one, other in (starts, steps):
        assert all(np.array_equal(one[key], other[key]) for key in one)
    assert not np.array_equal(first, env.render())
    assert np.array_equal(copy.deepcopy(env).render(), env.render())
    assert env.metadata["render_fps"] == (100 if name == NAMES[0] else 1.0)
    env.close()
    with pytest.raises(mppflight.StateError, match="closed"):
        env.render()


@pytest.mark.parametrize("name", NAMES)
def test_a_window_shows_each_step_or_there_is_advice(name, monkeypatch):
    with pytest.raises(mppflight.InputError, match="render_mode: give rgb_array, matplotlib has no window here"):
        gymnasium.make(name, render_mode="human")
    with pytest.raises(mppflight.InputError, match="render_mode: give rgb_array, human or None, not 'ansi'"):
        mppflight.environments.ControlEnv(render_mode="ansi")
    with pytest.raises(mppflight.InputError, match="render_mode: give it to gymnasium.make"):
        gymnasium.make_vec("mpp/Control-v0", num_envs=2, render_mode="rgb_array")
    shown = []
    monkeypatch.setattr(mppflight.plots, "WINDOWLESS", ())
    monkeypatch.setattr(pyplot, "pause", shown.append)
    env = gymnasium.make(name, render_mode="human")
    env.reset(seed=1)
    for _ in range(8):
        env.step(env.action_space.sample() * 0)
    assert len(shown) == (3 if name == NAMES[0] else 9)
    env.close()
    assert not pyplot.get_fignums()
