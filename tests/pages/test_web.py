"""The page that flies in the browser: the command line's hash, clicks that change plans, links to a moment."""

import json
import os
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
BINARY = Path(os.environ.get("SIL_HARNESS", ROOT / "target" / "release" / "sil-harness"))
PAGE = ROOT / "target" / "cross" / "web" / "fly.html"
PHONE = {"width": 390, "height": 844}
# The paper's flight, whose hash the README has.
PAPERS = "#field=paper&obstacles=20&hz=1&duration=20"

pytestmark = pytest.mark.skipif(not PAGE.exists(), reason="the page is not built: cargo xtask web")


@pytest.fixture
def open_page(open_page):
    """Opens a page, and the drawer with all that the page that flies can do."""
    drawer_shut = open_page

    def open_(url, **options):
        page = drawer_shut(url, **options)
        page.evaluate("document.getElementById('drawer')?.setAttribute('open', '')")
        return page
    return open_


def stands(page):
    """Waits until the flight stands and its hash is shown."""
    page.wait_for_function("/^[0-9a-f]{16}$/.test(document.getElementById('hash').textContent)")


def begun(page):
    """Waits until the module is unpacked and flies."""
    page.wait_for_function("flight && flight.ticks.t.length > 0")


def pause(page):
    begun(page)
    page.click("#play")
    stands(page)


def to_tick(page, tick):
    """Flies on to a tick and stands there."""
    begun(page)
    page.evaluate(f"target = {tick}")
    page.wait_for_function(f"target === null && flight.ticks.t.length === {tick}")
    stands(page)


def fly(out, *arguments):
    done = subprocess.run([BINARY, "fly", "--json", "--out", out, *arguments], check=False, capture_output=True, text=True)
    return json.loads(done.stdout)


def test_the_hash_is_the_command_lines(open_page, tmp_path):
    for seed in (1, 5):
        page = open_page(PAGE.as_uri() + PAPERS + f"&seed={seed}")
        page.select_option("#speed", "max")
        page.wait_for_function("ended")
        stands(page)
        flown = fly(tmp_path, "--seed", str(seed))
        assert page.inner_text("#hash") == flown["log_hash"]
        assert "survived after 20.00 s" in page.inner_text("#state")


def test_a_click_in_the_way_changes_the_plan_within_one_replan(open_page, shot):
    page = open_page(PAGE.as_uri() + "#obstacles=0")
    pause(page)
    to_tick(page, 300)
    start = page.evaluate("[flight.ticks.x[now], flight.ticks.z[now]]")

    def dodge(order):
        """How far the plan in force passes above or below the middle of what was put into the way [m]."""
        (circle,) = order["field"]["circle"]
        places = page.evaluate("flight.details.get(flight.plans[planAt(flight.plans, now)].tick).trajectory")
        _, z = min(places, key=lambda place: abs(place[0] - circle["x"]))
        return abs(z - circle["z"])

    assert dodge({"field": {"circle": [{"x": start[0] + 18, "z": start[1]}]}}) < 0.2
    box = page.locator("#view").bounding_box()
    # 18 m ahead of the aircraft, which is at 0.22 of the width.
    scale = min(box["width"] / 62, box["height"] / 26)
    page.mouse.click(box["x"] + 0.22 * box["width"] + 18 * scale, box["y"] + box["height"] / 2)
    order = page.evaluate("flight.orders[0]")
    (circle,) = order["field"]["circle"]
    assert circle["x"] == pytest.approx(start[0] + 18, abs=0.3)
    assert circle["z"] == pytest.approx(start[1], abs=0.3)
    before = page.evaluate("flight.plans.length")
    page.click("#next")
    assert page.evaluate("flight.plans.length") == before + 1
    plan = page.evaluate("flight.plans[flight.plans.length - 1]")
    assert plan["tick"] >= 300 and plan["used_from_tick"] <= 300 + 25 + 1
    # The first scan shows the map a part of the near side: the plan makes way at once.
    first = dodge(order)
    assert first > 0.4
    # The scans after it show the rest: the plan then passes it.
    page.click("#next")
    assert dodge(order) > 1.5
    shot(page, "web-click")
    page.evaluate("target = 800")
    page.wait_for_function("target === null")
    assert not page.evaluate("ended")


def test_clicks_and_switches_are_in_the_link_and_in_the_log(open_page, tmp_path):
    page = open_page(PAGE.as_uri() + "#seed=3&obstacles=20")
    pause(page)
    to_tick(page, 200)
    page.check("#wind")
    to_tick(page, 260)
    box = page.locator("#view").bounding_box()
    x, y = box["x"] + 0.8 * box["width"], box["y"] + 0.4 * box["height"]
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 30, y + 40)
    page.mouse.up()
    to_tick(page, 300)
    page.check("#dropouts")
    page.check("#elevator")
    to_tick(page, 310)
    page.uncheck("#elevator")
    to_tick(page, 500)
    hash_, link = page.inner_text("#hash"), page.get_attribute("#link", "href")
    orders = page.evaluate("flight.orders")
    assert [order["tick"] for order in orders] == [200, 260, 300, 300, 310]
    assert "capsule" in orders[1]["field"]
    # The same moment in another page, from the link alone.
    other = open_page(PAGE.as_uri() + link)
    other.wait_for_function("flight && target === null && flight.ticks.t.length === 500")
    stands(other)
    assert other.inner_text("#hash") == hash_
    assert other.is_checked("#wind") and other.is_checked("#dropouts") and not other.is_checked("#elevator")
    # The saved log is flown again by the command line, and shown by `replay`.
    with page.expect_download() as saved:
        page.click("#save")
    log = tmp_path / "web.json"
    saved.value.save_as(log)
    assert fly(tmp_path / "again", "--orders", log)["log_hash"] == hash_
    html = tmp_path / "web.html"
    subprocess.run([BINARY, "replay", log, "--out", html], check=True, capture_output=True)
    replayed = open_page(html.as_uri() + "#t=4.9")
    assert hash_ in replayed.inner_text("#title")
    assert replayed.is_enabled("#layer-candidates")
    assert "2.60 s: obstacles 1 capsule" in replayed.inner_text("#orders")


def test_an_endless_field_goes_on_with_the_next_seed(open_page, tmp_path):
    page = open_page(PAGE.as_uri() + "#obstacles=10&duration=4")
    begun(page)
    page.check("#dropouts")
    page.select_option("#speed", "max")
    page.wait_for_function("flight.header.seed >= 4")
    page.select_option("#speed", "0.25")
    pause(page)
    # It holds one flight, and the switches stay as they are.
    assert page.evaluate("flight.ticks.t.length") < 400
    assert page.is_checked("#dropouts") and not page.is_checked("#wind")
    assert page.evaluate("flight.orders") == [{"tick": 0, "order": "disturb", "dropouts": 0.3}]
    seed, hash_ = page.evaluate("flight.header.seed"), page.inner_text("#hash")
    assert page.input_value("#seed") == str(seed)
    # The link names this field.
    other = open_page(PAGE.as_uri() + page.get_attribute("#link", "href"))
    stands(other)
    assert other.evaluate("flight.header.seed") == seed and other.inner_text("#hash") == hash_
    # A flight that fails does not go on.
    page = open_page(PAGE.as_uri() + "#obstacles=10&duration=4&t=10")
    stands(page)
    x, z = page.evaluate("[flight.ticks.x[now], flight.ticks.z[now]]")
    page.evaluate(f"order({{ order: 'obstacles', field: {{ circle: [{{ x: {x} + 4, z: {z}, radius: 3 }}] }} }})")
    page.click("#play")
    page.wait_for_function("ended")
    assert "collision" in page.inner_text("#state") and page.input_value("#seed") == "1"
    # Orders that nobody drew are obstacles of the duel too.
    assert page.inner_text("#verdict").startswith("You got it! You placed 1, it passed 0.")


def test_it_can_hurry_to_thirty_times_real_time(open_page):
    page = open_page(PAGE.as_uri())
    page.wait_for_function("flight && flight.ticks.t.length > 100")
    flown = page.evaluate("""() => {
      const begun = performance.now(), before = flight.ticks.t.length;
      while (performance.now() - begun < 500) fly(25);
      return (flight.ticks.t.length - before) * 10 / (performance.now() - begun);
    }""")
    print(f"{flown:.0f} times real time")
    # The aim is 30; a test does not depend on the machine's pace, but on nothing being ten times slower.
    assert flown > 3


def test_keys_settings_and_bad_links(open_page):
    page = open_page(PAGE.as_uri() + "#seed=2")
    begun(page)
    page.keyboard.press(" ")
    stands(page)
    still = page.evaluate("flight.ticks.t.length")
    page.keyboard.press(".")
    assert page.evaluate("flight.ticks.t.length") == still + 1
    page.keyboard.press("n")
    assert page.input_value("#seed") == "3" and "Seed 3" in page.inner_text("#title")
    page.select_option("#aircraft", "aerosonde")
    page.wait_for_function("flight.header.world_scale > 1.5")
    page.select_option("#field", "canyon")
    page.wait_for_function("flight.header.field.ceiling.length === 1")
    page.locator("#sight").fill("60")
    page.wait_for_function("flight.header.lidar.range_max < 0.61 * 45 * flight.header.world_scale")
    # A request that the simulation refuses is told, not flown.
    page.goto(PAGE.as_uri() + "#hz=0.37")
    page.wait_for_function("document.getElementById('state').textContent.includes('replan_hz')")
    page.goto("about:blank")
    page.goto(PAGE.as_uri() + "#orders=[")
    page.wait_for_function("document.getElementById('state').textContent.includes('damaged')")


def told(page, text):
    """Waits until the page tells of a failure."""
    page.wait_for_function(f"document.getElementById('state').textContent.includes({json.dumps(text)})")
    assert page.get_attribute("#state", "class") == "over"


def same_from_link(open_page, page):
    """The page's link and its address lead to the moment and the hash that the page shows."""
    hash_, link = page.inner_text("#hash"), page.get_attribute("#link", "href")
    assert page.evaluate("location.hash") == link
    other = open_page(PAGE.as_uri() + link)
    other.wait_for_function(f"target === null && flight.ticks.t.length === {page.evaluate('flight.ticks.t.length')}")
    stands(other)
    assert other.inner_text("#hash") == hash_ and other.inner_text("#title") == page.inner_text("#title")


@pytest.mark.parametrize("seed", ["-1", "1.5"])
def test_a_seed_that_cannot_be_leaves_the_flight_as_it_is(open_page, seed):
    page = open_page(PAGE.as_uri() + "#obstacles=20&t=120")
    to_tick(page, 120)
    hash_ = page.inner_text("#hash")
    page.fill("#seed", seed)
    page.keyboard.press("Tab")
    told(page, "u64")
    assert page.input_value("#seed") == "1" and page.inner_text("#hash") == hash_
    # A look at the picture does not hide why.
    page.hover("#view")
    page.set_viewport_size(PHONE)
    assert page.get_attribute("#state", "class") == "over"
    same_from_link(open_page, page)
    page.click("#step")
    assert page.get_attribute("#state", "class") == "" and page.evaluate("flight.ticks.t.length") == 121
    same_from_link(open_page, page)


def test_a_sight_that_cannot_be_leaves_the_flight_as_it_is(open_page):
    page = open_page(PAGE.as_uri() + "#obstacles=20&sight=60&t=120")
    to_tick(page, 120)
    page.evaluate("location.hash = '#seed=7&sight=-5'")
    told(page, "range")
    assert page.input_value("#sight") == "60" and page.input_value("#seed") == "1"
    page.click("#step")
    assert page.evaluate("flight.ticks.t.length") == 121
    same_from_link(open_page, page)


@pytest.mark.parametrize(("link", "why"), [("aircraft=foo", "foo"), ("seed=3&orders=[", "damaged"), ("sight=-5", "range"),
                                           ("seed=foo", "seed"), ("hz=0.37&t=50", "replan_hz")])
def test_a_link_that_cannot_be_flown_shows_the_usual_flight(open_page, tmp_path, link, why):
    page = open_page(PAGE.as_uri() + "#" + link)
    told(page, why)
    assert page.input_value("#aircraft") == "reference" and page.input_value("#seed") == "1"
    assert page.evaluate("location.hash") == "#t=1"
    page.click("#step")
    page.click("#next")
    same_from_link(open_page, page)
    page.check("#wind")
    with page.expect_download() as saved:
        page.click("#save")
    saved.value.save_as(tmp_path / "web.json")
    assert json.loads((tmp_path / "web.json").read_text())["header"]["seed"] == 1
    page.click("#play")
    page.wait_for_function("flight.orders.length === 1 && pending.length === 0")


def test_without_a_flight_buttons_do_nothing_and_no_error_is_saved(open_page):
    page = open_page(PAGE.as_uri())
    pause(page)
    # Nothing but this test takes the flight away.
    page.evaluate("[flight, module] = [null, gauge]")
    for button in ("#play", "#step", "#next", "#wind"):
        page.click(button)
    address = page.url
    page.on("download", lambda _: pytest.fail("an error was saved"))
    page.click("#save")
    told(page, "no flight has begun")
    assert page.url == address


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("size", ["wide", "phone"])
def test_how_it_looks(open_page, shot, scheme, size):
    options = {"viewport": PHONE, "has_touch": True} if size == "phone" else {}
    page = open_page(PAGE.as_uri() + "#t=700", color_scheme=scheme, **options)
    page.wait_for_function("flight && target === null && flight.ticks.t.length === 700")
    stands(page)
    width = page.evaluate("window.innerWidth")
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    if size == "phone":
        box = page.locator("#view").bounding_box()
        page.touchscreen.tap(box["x"] + 0.7 * box["width"], box["y"] + 0.3 * box["height"])
        page.wait_for_function("flight.orders.length === 1")
        assert page.evaluate("flight.orders[0].field.circle.length") == 1
    shot(page, f"web-{size}-{scheme}")
