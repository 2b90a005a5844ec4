"""The duel on the page that flies: its words, its slow motion, and obstacles that land where they are drawn."""

import json
from urllib.parse import quote

import pytest
from test_web import PAGE, PHONE, begun, stands

LAPTOP = {"width": 1366, "height": 768}

pytestmark = pytest.mark.skipif(not PAGE.exists(), reason="the page is not built: cargo xtask web")


def test_the_words_of_the_duel(open_page):
    page = open_page(PAGE.as_uri() + "#obstacles=0&t=10")
    stands(page)
    for given, said in (
            ("{ placed: 0, passed: 0, nearest: Infinity }", "It flies by its lidar alone."),
            ("{ placed: 7, passed: 7, nearest: 0.82 }", "You placed 7, it passed 7, nearest 0.8 m."),
            ("{ placed: 2, passed: 0, nearest: Infinity }", "You placed 2, it passed 0."),
            ("{ placed: 7, passed: 6, nearest: 1 }, { kind: 'circle', mine: true }", "You got it! You placed 7, it passed 6,"),
            ("{ placed: 1, passed: 1, nearest: 1 }, { kind: 'circle', mine: false }", "It hit the field. You placed 1,"),
            ("{ placed: 0, passed: 0, nearest: 1 }, { kind: null, mine: false }", "It lost control.")):
        assert page.evaluate(f"verdict({given})").startswith(said)
    seen = "{ kind: 'capsule', mine: true, placed: 800, end: 900, seen: 825, away: 9.14, known: 829 }"
    assert page.evaluate(f"sawText({seen})") == ("You placed the bar 1.00 s before the crash. It saw the bar 0.75 s before, "
                                                 "9.1 m away, and flew a plan that knew of it from 0.71 s before.")
    theirs = seen.replace("mine: true, placed: 800", "mine: false, placed: null")
    assert page.evaluate(f"sawText({theirs})").startswith("It saw the bar 0.75 s before the crash, 9.1 m away, and flew")
    unseen = "{ kind: 'circle', mine: false, placed: null, end: 900, seen: null, away: null, known: null }"
    assert page.evaluate(f"sawText({unseen})") == "It never saw the circle."
    # A second takes four, and stands at the end.
    assert page.evaluate("[0, 400, 2000, 4000, 9000].map(elapsed => slowTick(elapsed, 500))") == [400, 410, 450, 500, 500]
    assert page.evaluate("slowTick(0, 30)") == 0
    # Distances to edges, of what moves too.
    assert page.evaluate("apart('circle', { x: 3, z: 4, radius: 1 }, [0, 0], 9)") == 4
    assert page.evaluate("apart('capsule', { from: [0, 2], to: [8, 2], radius: .5, velocity: [0, 1] }, [4, 0], 1)") == 2.5
    assert page.evaluate("apart('ground', { points: [[0, 1], [9, 1]] }, [-50, 4], 0)") == 3
    # Nearest counts what was passed; what is put behind the aircraft is no duel.
    circles = "[[10, 2], [25, 0], [-9, 0]].map(([x, z]) => ({ tick: 0, field: { circle: [{ x, z, radius: 1 }] } }))"
    told_ = page.evaluate(f"tally({{ ticks: {{ t: [0, 1, 2], x: [0, 10, 20], z: [0, 0, 0] }}, orders: {circles} }})")
    assert told_ == {"placed": 2, "passed": 1, "nearest": 1}
    # Obstacles of the last four seconds come before them; what came earlier stays.
    orders = "[{ tick: 100, field: {} }, { tick: 950, gusts: 1 }, { tick: 990, field: {} }]"
    moved, begins = page.evaluate(f"withMine({{ orders: {orders}, ticks: {{ t: {{ length: 1000 }} }} }})")
    assert begins == 600 and [order["tick"] for order in moved] == [100, 600, 950]


def test_links_are_short_and_long_ones_lead_to_the_same(open_page):
    page = open_page(PAGE.as_uri() + "#obstacles=0&aircraft=aerosonde&t=200")
    stands(page)
    x, z, unit = page.evaluate("[flight.ticks.x[now], flight.ticks.z[now], flight.header.world_scale]")
    for given in (f"order: 'obstacles', field: {{ circle: [{{ x: {x} + 99, z: {z}, radius: {unit} }}] }}",
                  f"order: 'obstacles', field: {{ capsule: [{{ from: [{x} + 99, {z} - 30], to: [{x} + 99, -2.5], radius: {unit} / 2 }}] }}",
                  "order: 'disturb', gusts: 1.5", "order: 'disturb', dropouts: 0.3", "order: 'disturb', elevator_stuck: true"):
        page.evaluate(f"order({{ {given} }})")
    page.click("#play")
    page.wait_for_function("pending.length === 0")
    page.click("#play")
    stands(page)
    hash_, link, orders = page.inner_text("#hash"), page.get_attribute("#link", "href"), page.evaluate("flight.orders")
    assert len(orders) == 5 and "&o=" in link and "%" not in link
    long = f"#obstacles=0&aircraft=aerosonde&t={page.evaluate('flight.ticks.t.length')}&orders={quote(json.dumps(orders))}"
    assert len(link) < len(long) / 2.5
    for same in (link, long):
        other = open_page(PAGE.as_uri() + same)
        stands(other)
        assert other.inner_text("#hash") == hash_ and other.get_attribute("#link", "href") == link
    # What has no short form is not lost, and a damaged one is told.
    wide = "{ tick: 1, order: 'obstacles', field: { circle: [{ x: 9, z: 50, radius: 2 }] } }"
    assert page.evaluate(f"packOrders([{wide}], 1)") == ""
    for damaged in ("1*c5", "1*c5_x_2", "1*q5_1_2", "*", "y*c5_1_2"):
        page.goto("about:blank")
        page.goto(PAGE.as_uri() + "#o=" + damaged)
        page.wait_for_function("document.getElementById('state').textContent.includes('damaged')")


def test_a_crash_is_shown_slowly_and_flown_again_with_the_same_obstacles(open_page, shot):
    page = open_page(PAGE.as_uri() + "#obstacles=0&t=300", viewport=LAPTOP)
    stands(page)
    assert page.is_disabled("#mine") and page.is_hidden("#slow")
    x, z = page.evaluate("[flight.ticks.x[now], flight.ticks.z[now]]")
    page.evaluate(f"order({{ order: 'obstacles', field: {{ capsule: "
                  f"[{{ from: [{x} + 6, {z} - 2], to: [{x} + 6, {z} + 2], radius: 0.5 }}] }} }})")
    page.click("#play")
    page.wait_for_function("ended && slow !== null && now < flight.ticks.t.length - 30")
    assert "slow motion" in page.inner_text("#clock")
    shot(page, "web-slow")
    page.wait_for_function("slow === null")
    assert page.evaluate("now === flight.ticks.t.length - 1")
    assert page.inner_text("#verdict") == "You got it! You placed 1, it passed 0."
    assert page.inner_text("#saw").startswith("You placed the bar ") and "It saw the bar" in page.inner_text("#saw")
    crash = page.evaluate("({ ...flight.crash, o: null })")
    assert crash["mine"] and crash["placed"] == 300 and 300 <= crash["seen"] < crash["known"] < crash["end"]
    page.click("#slow")
    page.wait_for_function("slow !== null && now < flight.ticks.t.length - 30")
    # Known from the start, the bar is no danger.
    page.click("#mine")
    page.wait_for_function("!ended && flight.orders.length === 1 && flight.ticks.t.length > 500")
    assert page.evaluate("flight.orders[0].tick") == 0
    page.wait_for_function("document.getElementById('verdict').textContent.startsWith('You placed 1, it passed 1, nearest')")
    # Other settings do not lose them.
    page.keyboard.press("n")
    page.click("#mine")
    page.wait_for_function("flight.orders.length === 1")


def test_a_crash_that_motion_would_disturb_is_still(open_page):
    page = open_page(PAGE.as_uri() + "#obstacles=0&t=10", reduced_motion="reduce")
    stands(page)
    x, z = page.evaluate("[flight.ticks.x[now], flight.ticks.z[now]]")
    page.evaluate(f"order({{ order: 'obstacles', field: {{ circle: [{{ x: {x} + 4, z: {z}, radius: 3 }}] }} }})")
    page.click("#play")
    page.wait_for_function("ended")
    assert page.evaluate("slow === null") and page.is_visible("#slow")


def test_time_passes_at_an_eighth_while_a_bar_is_drawn_and_it_lands_where_it_was_drawn(open_page, shot):
    page = open_page(PAGE.as_uri() + "#obstacles=0", viewport=LAPTOP)
    begun(page)
    box = page.locator("#view").bounding_box()
    u, v = box["x"] + 0.7 * box["width"], box["y"] + 0.2 * box["height"]
    page.mouse.move(u, v)
    page.mouse.down()
    # What a frame flies, by the clock that it is given.
    steps = page.evaluate("""() => {
      const flown = [];
      for (const speed of ["1", "max", "4"]) {
        $("speed").value = speed; last = 0; due = 0;
        const before = flight.ticks.t.length;
        frame(160);
        flown.push(flight.ticks.t.length - before);
      }
      return flown;
    }""")
    assert steps == [2, 2, 2]
    page.evaluate("$('speed').value = '1'")
    # The field runs on beneath the pointer; the bar's start stays where it was in the world.
    first = page.evaluate("flight.ticks.t.length")
    page.wait_for_function(f"flight.ticks.t.length > {first} + 8")
    page.mouse.move(u, v + 200)
    shot(page, "web-drag")
    start = page.evaluate("drawn().capsule[0].from")
    page.mouse.up()
    page.wait_for_function("flight.orders.length === 1")
    (bar,) = page.evaluate("flight.orders[0].field.capsule")
    end = bar["to"]
    assert bar["from"] == start
    # The end is beneath the pointer: the aircraft is at 0.22 of the width.
    tick = page.evaluate("flight.orders[0].tick")
    scale = box["height"] / 26
    aircraft = page.evaluate(f"flight.ticks.x[{tick} - 1]")
    assert end[0] == pytest.approx(aircraft + 0.48 * box["width"] / scale, abs=0.3)
    assert start[1] - end[1] == pytest.approx(200 / scale, abs=0.3)


def test_a_choice_of_field_brings_its_density_and_nobody_needs_a_pointer(open_page):
    page = open_page(PAGE.as_uri())
    begun(page)
    page.click("#drawer > summary")
    page.select_option("#field", "slalom")
    page.wait_for_function("flight.header.field.capsule?.length || flight.header.field.polyline?.length || "
                           "flight.header.field.polygon?.length")
    assert page.input_value("#obstacles") == "10"
    page.evaluate("document.activeElement.blur()")
    page.keyboard.press("o")
    page.wait_for_function("flight.orders.length === 1 && pending.length === 0")
    # On a button that has the focus, the space key presses that one.
    page.focus("#wind")
    page.keyboard.press(" ")
    page.focus("#next")
    page.keyboard.press(" ")
    page.wait_for_function("!playing")
    assert page.is_checked("#wind")
    x, order = page.evaluate("[flight.ticks.x[flight.orders[0].tick - 1], flight.orders[0]]")
    assert 10 < order["field"]["circle"][0]["x"] - x < 26


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("size", ["laptop", "phone"])
def test_how_the_open_page_looks(open_page, shot, scheme, size):
    options = {"viewport": PHONE, "has_touch": True} if size == "phone" else {"viewport": LAPTOP}
    page = open_page(PAGE.as_uri() + "#t=500", color_scheme=scheme, **options)
    stands(page)
    share, width = page.evaluate("[$('view').clientWidth * $('view').clientHeight / innerWidth / innerHeight, "
                                 "document.documentElement.scrollWidth - innerWidth]")
    assert share > 0.59 and width <= 0
    # All but the row of the duel is in the drawer, and the row is on the first screen.
    assert page.locator("#wind").bounding_box()["y"] < options["viewport"]["height"]
    assert page.is_hidden("#charts") and page.is_hidden("#obstacles")
    shot(page, f"web-first-{size}-{scheme}")
