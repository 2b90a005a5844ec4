"""The page that flies in space: the command line's hash, trees that are planted, crashes, and the next forest."""

import gzip
import json
import os
from pathlib import Path

import pytest
from test_web import PAGE as FLY
from test_web import PHONE, fly

PAGE = FLY.with_name("forest.html")
LAPTOP = {"width": 1366, "height": 768}

pytestmark = pytest.mark.skipif(not PAGE.exists(), reason="the page is not built: cargo xtask web")


def flies(page):
    page.wait_for_function("flight && flight.states.length > 30")


def stands(page):
    """Waits until the flight stands and its hash is known."""
    page.wait_for_function("flight && !playing && !busy && until === null && flight.hash !== null && "
                           "shown === flight.states.length - 1")


def to_tick(page, tick):
    """Flies on to a tick and stands there."""
    page.evaluate(f"flight.hash = null, playing = false, until = {tick}")
    stands(page)


def flags(**settings):
    return [text for name, value in settings.items() for text in (f"--{name}", str(value))]


def test_it_is_small_and_flies_by_itself(open_page):
    assert len(gzip.compress(PAGE.read_bytes(), 9)) < 900_000
    page = open_page(PAGE.as_uri(), viewport=LAPTOP)
    flies(page)
    page.wait_for_function("shown > 20")
    assert page.inner_text("#verdict") == "It has never seen this forest."
    page.wait_for_function("document.getElementById('v-airspeed').textContent.includes('m/s')")
    # It has seen trunks, and has a plan.
    page.wait_for_function("flight.trunks.some(trunk => trunk.seen !== null) && flight.cycles.at(-1).paths.length > 1")
    page.click("#play")
    stands(page)
    page.wait_for_function("location.hash.includes('t=')")


@pytest.mark.parametrize(("link", "settings", "outcome", "said"), [
    ("seed=5&density=0.01", {"seed": 5, "density": 0.01, "airspeed": 12}, "survived", "Through."),
    ("seed=3&density=0.02&speed=13&wind=-3&gusts=0.5",
     {"seed": 3, "density": 0.02, "airspeed": 13, "wind": "0,-3,0", "gusts": 0.5}, None, None),
    ("lidar=mid-360", {"seed": 2, "density": 0.04, "airspeed": 12, "lidar": "mid-360"}, None, None),
    ("seed=6&density=0.02&sight=20", {"seed": 6, "density": 0.02, "airspeed": 12, "sight": 20}, None, None),
    ("seed=4&density=0.08", {"seed": 4, "density": 0.08, "airspeed": 12}, "collision", "It hit a tree.")])
def test_the_hash_is_the_command_lines(open_page, tmp_path, link, settings, outcome, said):
    page = open_page(PAGE.as_uri() + f"#{link}&t=4000")
    page.wait_for_function("!document.getElementById('end').hidden")
    flown = fly(tmp_path, "--preset", "space", *flags(**settings))
    assert page.inner_text("#hash") == flown["log_hash"]
    assert outcome is None or flown["outcome"] == outcome
    assert said is None or page.inner_text("#outcome") == said
    assert f"{flown['x_end']:.0f} m in {flown['t_end']:.1f} s" in page.inner_text("#account")
    command = page.inner_text("#command").split()
    again = fly(tmp_path / "again", *command[2:])
    assert again["log_hash"] == flown["log_hash"]
    # The link is that of the whole flight.
    assert page.get_attribute("#link", "href") == f"#{link}"


def test_trees_change_the_flight_and_are_in_its_link_and_its_log(open_page, tmp_path, shot):
    page = open_page(PAGE.as_uri() + "#seed=7&density=0.01&t=300", viewport=LAPTOP)
    stands(page)
    before = page.evaluate("flight.hash")
    x, y = page.evaluate("stateAt(flight, shown).at.slice(0, 2)")
    # 20 m ahead on the map, whose aircraft is at 55 of 69 m.
    box = page.locator("#map").bounding_box()
    scale = box["height"] / 69
    page.mouse.click(box["x"] + box["width"] / 2, box["y"] + 35 * scale)
    page.wait_for_function("flight.orders.length === 1")
    order = page.evaluate("flight.orders[0]")
    assert order["tick"] == 300 and order["order"] == "trunk"
    assert ((order["x"] - x) ** 2 + (order["y"] - y) ** 2) ** 0.5 == pytest.approx(20, abs=0.3)
    # A click on the ground of the scene.
    box = page.locator("#view").bounding_box()
    page.mouse.click(box["x"] + 0.4 * box["width"], box["y"] + 0.7 * box["height"])
    page.wait_for_function("flight.orders.length === 2")
    # A tree where the aircraft is.
    page.evaluate("plant(stateAt(flight, shown).at)")
    page.wait_for_function("document.getElementById('state').textContent.startsWith('Not planted')")
    to_tick(page, 350)
    page.keyboard.press("t")
    page.wait_for_function("flight.orders.length === 3")
    shot(page, "forest-planted")
    to_tick(page, 600)
    assert page.evaluate("flight.hash") != before
    page.wait_for_function("document.getElementById('verdict').textContent.startsWith('You planted 3, it passed')")
    # The same moment from the link alone.
    other = open_page(PAGE.as_uri() + page.evaluate("location.hash"))
    stands(other)
    assert other.evaluate("[flight.hash, flight.states.length]") == page.evaluate("[flight.hash, flight.states.length]")
    # The saved log is flown again by the command line.
    to_tick(page, 4000)
    page.wait_for_function("!document.getElementById('end').hidden")
    with page.expect_download() as saved:
        page.click("#save")
    saved.value.save_as(tmp_path / "forest.json")
    command = page.inner_text("#command").replace("LOG", str(tmp_path / "forest.json")).split()
    assert fly(tmp_path / "again", *command[2:])["log_hash"] == page.inner_text("#hash")
    # The same forest with these trees from the start.
    page.keyboard.press("m")
    page.wait_for_function("flight.orders.length === 3 && flight.orders.every(order => order.tick === 0)")


def test_a_crash_is_shown_slowly_and_the_next_forest_follows(open_page, shot):
    page = open_page(PAGE.as_uri() + "#seed=4&density=0.08", viewport=LAPTOP)
    page.wait_for_function("slow")
    assert page.inner_text("#verdict").startswith("Once more, slowly") or page.evaluate("shown < flight.states.length - 1")
    page.wait_for_function("!document.getElementById('end').hidden")
    assert page.inner_text("#outcome") == "It hit a tree." and "It saw this tree" in page.inner_text("#account")
    shot(page, "forest-crash")
    page.wait_for_function("settings.seed === 5 && document.getElementById('end').hidden && flight.states.length > 5")
    page.keyboard.press("n")
    page.wait_for_function("flight.header.seed === 6")


def test_who_wants_no_motion_gets_none_and_whoever_stays_stays(open_page):
    page = open_page(PAGE.as_uri() + "#seed=4&density=0.08", reduced_motion="reduce")
    page.wait_for_function("flight")
    assert page.evaluate("playing") is False
    page.click("#play")
    page.wait_for_function("!document.getElementById('end').hidden")
    assert page.evaluate("slow") is False and page.evaluate("next") is None


def test_what_cannot_be_flown_is_told(open_page):
    page = open_page(PAGE.as_uri() + "#density=7")
    page.wait_for_function("document.getElementById('state').textContent.includes('density')")
    page.wait_for_function("flight && flight.header.space.density === 0.04")
    page.goto("about:blank")
    page.goto(PAGE.as_uri() + "#o=1*p5_x_2")
    page.wait_for_function("document.getElementById('state').textContent.includes('damaged')")
    flies(page)
    page.click("#drawer > summary")
    page.fill("#seed", "-1")
    page.keyboard.press("Tab")
    page.wait_for_function("document.getElementById('state').textContent.includes('u64')")
    assert page.input_value("#seed") == "2"
    page.locator("#density").fill("0.02")
    page.wait_for_function("flight.header.space.density === 0.02")


def test_what_stands_still_is_not_painted_again(open_page):
    page = open_page(PAGE.as_uri() + "#seed=3&t=200", viewport=LAPTOP)
    stands(page)
    page.wait_for_timeout(300)
    count = "() => { const draw = drawMap; window.drawn = 0; drawMap = (...all) => { window.drawn++; return draw(...all); }; }"
    page.evaluate(count)
    page.wait_for_timeout(500)
    assert page.evaluate("drawn") == 0
    page.set_viewport_size({"width": 1200, "height": 700})
    page.wait_for_function("drawn > 0")
    drawn = page.evaluate("drawn")
    page.mouse.move(300, 400)
    page.wait_for_function(f"drawn > {drawn}")
    page.click("#play")
    page.wait_for_function("drawn > 20")


def test_the_five_flights_are_there(open_page):
    page = open_page(PAGE.as_uri())
    links = page.evaluate("[...document.querySelectorAll('#drawer a[href^=\"#seed\"]')].map(link => link.getAttribute('href'))")
    assert len(links) == 5
    for link in links:
        before = page.evaluate("turn")
        page.evaluate(f"location.hash = {link!r}")
        page.wait_for_function(f"turn > {before} && flight && flight.header.seed === settings.seed && flight.states.length > 5")
        assert "over" not in page.get_attribute("#state", "class")
    # The last one has a tree of its own.
    page.wait_for_function("flight.orders.length === 1 && flight.orders[0].tick === 600")


def processor_time():
    """What this process and all below it have used of processors [ms]. Other work on the machine changes it less than the pace."""
    used, below = {}, {}
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            pid, rest = stat.parent.name, stat.read_text().rpartition(")")[2].split()
        except OSError:
            continue
        used[pid] = int(rest[11]) + int(rest[12])
        below.setdefault(rest[1], []).append(pid)
    total, todo = 0, [str(os.getpid())]
    while todo:
        pid = todo.pop()
        total += used.get(pid, 0)
        todo += below.get(pid, [])
    return total * 1000 / os.sysconf("SC_CLK_TCK")


# Paints one frame and counts what it paints.
PAINTS = """() => {
  const brush = CanvasRenderingContext2D.prototype, was = {};
  let count = 0;
  for (const name of ["fill", "stroke", "fillRect"]) {
    was[name] = brush[name];
    brush[name] = function (...all) { count++; return was[name].apply(this, all); };
  }
  drawScene(flight, shown, look);
  Object.assign(brush, was);
  return count;
}"""


def test_frames_a_second(open_page):
    """Prints figures: the aim is 60 frames a second among 2,000 trunks. A test does not depend on the machine's pace: it counts what
    is painted."""
    for density in (0.022, 0.04, 0.08):
        page = open_page(PAGE.as_uri() + f"#seed=11&density={density}", viewport=LAPTOP)
        chromium = page.context.new_cdp_session(page)
        chromium.send("Performance.enable", {"timeDomain": "threadTicks"})
        flies(page)
        told = page.evaluate("""() => new Promise(done => {
          const times = [], first = shown;
          const next = time => {
            times.push(time);
            if (time - times[0] < 2000 && !flight.ended) return requestAnimationFrame(next);
            const gaps = times.slice(1).map((time, i) => time - times[i]).sort((a, b) => a - b), all = times.at(-1) - times[0];
            done({ trunks: flight.trunks.length, frames: gaps.length / all * 1000, slow: gaps[Math.floor(gaps.length * 0.95)],
              pace: (shown - first) * 10 / all, cycle: flight.planning.sort((a, b) => a - b)[flight.planning.length >> 1] });
          };
          requestAnimationFrame(next);
        })""")
        page.click("#play")
        stands(page)

        def busy():
            """What script and painting have used of the page's thread [ms]."""
            values = {value["name"]: value["value"] for value in chromium.send("Performance.getMetrics")["metrics"]}
            return 1000 * values["ScriptDuration"], 1000 * values["TaskDuration"]

        before, (script, task) = processor_time(), busy()
        painted = page.evaluate("""() => new Promise(done => {
          const first = performance.now();
          let count = 0;
          const next = time => { count++; painted = null; if (time - first < 3000) requestAnimationFrame(next); else done(count); };
          requestAnimationFrame(next);
        })""")
        used = (processor_time() - before, *(now - was for now, was in zip(busy(), (script, task), strict=True)))
        told |= zip(("processor_ms_a_frame", "script", "script_and_painting"), (value / painted for value in used))
        told["paints"] = page.evaluate(PAINTS)
        print(json.dumps({name: round(value, 2) for name, value in told.items()}))
        assert told["frames"] > 0 and 100 < told["paints"] < 1600


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("size", ["laptop", "phone"])
def test_how_it_looks(open_page, shot, scheme, size):
    options = {"viewport": PHONE, "has_touch": True} if size == "phone" else {"viewport": LAPTOP}
    page = open_page(PAGE.as_uri() + "#seed=3&t=600", color_scheme=scheme, **options)
    stands(page)
    # All of it is on the first screen.
    assert page.evaluate("[document.documentElement.scrollWidth - innerWidth, document.documentElement.scrollHeight - innerHeight]") == [0, 0]
    assert page.locator("#play").bounding_box()["y"] < options["viewport"]["height"]
    if size == "phone":
        box = page.locator("#view").bounding_box()
        page.touchscreen.tap(box["x"] + 0.6 * box["width"], box["y"] + 0.6 * box["height"])
        page.wait_for_function("flight.orders.length === 1")
    page.wait_for_timeout(200)
    shot(page, f"forest-{size}-{scheme}")
