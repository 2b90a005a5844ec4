"""The replay of a flight in space: scene, plan and side view, attitude and charts of one moment."""

import math

import pytest
from flown import PHONE, fly, page_of, pixels

LAPTOP = {"width": 1366, "height": 768}


@pytest.fixture(scope="session")
def forest(tmp_path_factory):
    path, log = fly(tmp_path_factory.mktemp("space"), "--preset", "space", "--density", "0.04", "--airspeed", "12", "--seed", "5")
    return page_of(path), log


def test_hills_are_below_the_flight_in_all_views(open_page, tmp_path):
    path, log = fly(tmp_path, "--preset", "space", "--world", "hills", "--density", "0.8", "--airspeed", "12", "--seed", "6200003")
    page = open_page(page_of(path).as_uri(), viewport=LAPTOP)
    above = page.evaluate("flight.states.map(([[x, y, z]]) => z - flight.heightAt(x, y))")
    assert min(above) == pytest.approx(log["summary"]["min_clearance"], abs=0.8) and max(above) > 10
    views = "['view', 'map', 'side'].map(id => document.getElementById(id).toDataURL())"
    hills, level = page.evaluate(f"show(); const a = {views}; flight.heightAt = null; show(); [a, {views}]")
    assert all(one != other for one, other in zip(hills, level))


def at(page, tick):
    page.evaluate(f"go({tick}); show()")
    return {name: page.inner_text(f"#v-{name}") for name in ("ahead", "right", "height", "airspeed", "bank", "nearest")}


def test_it_opens_at_the_closest_approach_and_says_what_the_log_holds(open_page, forest):
    file, log = forest
    page = open_page(file.as_uri(), viewport=LAPTOP)
    assert page.inner_text("#v-nearest") == f"{log['summary']['min_clearance']:.2f} m"
    assert page.inner_text("#title") == "forest 0.04, ultrastick, seed 5" and "survived" in page.inner_text("#result")
    for tick in (0, 700, len(log["ticks"]["t"]) - 1):
        said = at(page, tick)
        for name, column in (("ahead", log["ticks"]["x"]), ("right", log["lateral"]["y"]), ("height", log["ticks"]["z"]), ("airspeed", log["ticks"]["airspeed"])):
            assert float(said[name].split()[0]) == pytest.approx(column[tick], abs=0.0051)
        # Sideslip tells the bank of the wing from that of the path.
        assert float(said["bank"].rstrip("\u00b0")) == pytest.approx(math.degrees(log["lateral"]["bank"][tick]), abs=6)
        assert page.evaluate(f"valueAt(flight, CHARTS[2], 'bank', {tick})") == pytest.approx(math.degrees(log["lateral"]["bank"][tick]), abs=0.01)


def test_all_views_show_one_moment(open_page, forest):
    file, _ = forest
    page = open_page(file.as_uri() + "#t=5.00", viewport=LAPTOP)
    assert page.inner_text("#clock") == "5.00 s"
    pictures = lambda: page.evaluate("['view', 'map', 'side', 'attitude', 'strip', 'charts'].map(id => document.getElementById(id).toDataURL())")
    before = pictures()
    # A click in the charts goes to its time.
    page.locator("#charts").scroll_into_view_if_needed()
    box = page.locator("#charts").bounding_box()
    page.mouse.click(box["x"] + 0.7 * box["width"], box["y"] + 60)
    page.wait_for_function("now > 600")
    page.wait_for_timeout(200)
    assert all(one != other for one, other in zip(before, pictures()))
    page.keyboard.press("ArrowLeft")
    page.keyboard.press("Space")
    page.wait_for_function("playing && now > 1500")
    page.keyboard.press("Space")
    page.wait_for_function("!playing && location.hash.startsWith('#t=')")
    # A drag looks around, and lets go.
    page.evaluate("scrollTo(0, 0)")
    page.wait_for_timeout(100)
    before = pixels(page)
    page.mouse.move(600, 300)
    page.mouse.down()
    page.mouse.move(700, 300)
    page.wait_for_timeout(100)
    assert pixels(page) != before
    page.mouse.up()
    page.wait_for_timeout(100)
    assert pixels(page) == before


@pytest.mark.parametrize("world", [("--world", "walls"), ("--world", "spheres", "--sphere", "0.4")])
def test_other_worlds_are_drawn_too(open_page, shot, tmp_path, world):
    path, log = fly(tmp_path, "--preset", "space", "--airspeed", "12", "--seed", "962003", *world)
    page = open_page(page_of(path).as_uri() + "#t=3", viewport=LAPTOP)
    assert page.evaluate("flight.bodies.length") == log["header"]["obstacles"]
    before = pixels(page)
    page.evaluate("flight.bodies.length = 0; show()")
    assert pixels(page) != before
    shot(page, f"replay-{world[1]}")


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("size", [LAPTOP, PHONE], ids=["laptop", "phone"])
def test_how_it_looks(open_page, shot, forest, size, scheme):
    page = open_page(forest[0].as_uri(), viewport=size, color_scheme=scheme)
    assert page.evaluate("document.documentElement.scrollWidth - innerWidth") <= 0
    assert page.locator("#play").bounding_box()["y"] < size["height"]
    shot(page, f"replay-space-{size['width']}-{scheme}")
