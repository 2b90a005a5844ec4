"""The pages of flights in headless Chromium: no error, what they say is what the log holds."""

import json

import pytest
from flown import PHONE, data_of, fly, holds, page_of, pixels, says_what_the_log_holds


def test_the_text_is_the_logs_and_the_slider_moves_the_aircraft(flight, open_page, shot):
    page, log = flight
    page = open_page(page.as_uri())
    title = page.inner_text("#title")
    for part in ["seed 1", "survived after 20.00 s", f"{log['summary']['feasible']} feasible"]:
        assert part in title
    shapes = set()
    for tick in (0, 700, 1234, 1999):
        page.locator("#time").fill(str(tick))
        says_what_the_log_holds(page, log, tick)
        shapes.add(pixels(page))
    assert len(shapes) == 4
    page.locator("#time").fill("1234")
    shot(page, "light")


def test_keys_buttons_layers_and_links(flight, open_page):
    page, log = flight
    page = open_page(page.as_uri() + "#t=7.30")
    says_what_the_log_holds(page, log, 730)
    starts = [plan["used_from_tick"] for plan in log["plans"]]
    page.keyboard.press("]")
    after = min(tick for tick in starts if tick > 730)
    says_what_the_log_holds(page, log, after)
    page.keyboard.press("[")
    says_what_the_log_holds(page, log, max(tick for tick in starts if tick < after))
    page.keyboard.press("End")
    says_what_the_log_holds(page, log, 1999)
    page.keyboard.press("ArrowLeft")
    says_what_the_log_holds(page, log, 1989)
    page.keyboard.press("Home")
    page.click("#next")
    says_what_the_log_holds(page, log, starts[0] if starts[0] > 0 else starts[1])
    page.evaluate("location.hash = '#t=12.3'")
    page.wait_for_function("document.getElementById('time').value === '1230'")
    assert page.get_attribute("#link", "href") == "#t=12.30"
    seen = {pixels(page)}
    for layer in ["field", "scan", "occupancy", "candidates", "corridor", "plan", "reference", "flown", "unknown"]:
        page.click(f"#layer-{layer}")
        picture = pixels(page)
        assert picture not in seen, layer
        seen.add(picture)
    page.keyboard.press("1")
    assert page.is_checked("#layer-field")
    page.keyboard.press("Home")
    page.keyboard.press(" ")
    page.wait_for_function("Number(document.getElementById('time').value) > 50")
    page.keyboard.press(" ")
    page.wait_for_function(r"/^#t=\d+\.\d\d$/.test(location.hash)")


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_a_phone_shows_it_all_without_scrolling_sideways(flight, open_page, scheme, shot):
    page, _ = flight
    page = open_page(page.as_uri() + "#t=7.3", viewport=PHONE, color_scheme=scheme)
    assert page.evaluate("document.documentElement.scrollWidth") <= PHONE["width"]
    ground = page.evaluate("getComputedStyle(document.body).backgroundColor")
    assert ground == ("rgb(255, 255, 255)" if scheme == "light" else "rgb(20, 23, 26)")
    shot(page, f"phone-{scheme}")


def test_a_wide_page_is_dark_where_that_is_wanted(flight, open_page, shot):
    page, _ = flight
    page = open_page(page.as_uri() + "#t=12.34", color_scheme="dark")
    page.click("#legend summary")
    assert "cells of 0.5 m" in page.inner_text("#occupancy")
    shot(page, "dark")


# One whose planner has too few slices is flown again, too.
@pytest.mark.parametrize("flags", [
    ["--seed", "1"],
    ["--preset", "paper", "--latency-ms", "200", "--slices-per-tick", "12"],
    ["--latency-ms", "200", "--slices-per-tick", "3"],
    ["--preset", "reference", "--replan-hz", "2"],
])
def test_what_the_planner_considered_is_what_it_reported(flags, open_page, tmp_path):
    path, log = fly(tmp_path, *flags, "--duration", "10")
    page = page_of(path)
    data = data_of(page)
    holds(data, log)
    assert [detail["tick"] for detail in data["details"]] == [plan["tick"] for plan in log["plans"]]
    for detail, plan in zip(data["details"], log["plans"]):
        assert len(detail["paths"]) == len(detail["judged"]) == plan["candidates"]
        assert sum(judged["feasible"] for judged in detail["judged"]) == plan["feasible"]
        assert (detail["chosen"] is not None) == (plan["cost"] is not None)
        assert len(detail["trajectory"]) == (0 if detail["chosen"] is None else 19)
    assert any(detail["paths"] for detail in data["details"])
    remembers = log["header"]["preset"] == "flight"
    for detail in data["details"]:
        assert bool(detail["map"]["unknown"]) == remembers
    page = open_page(page.as_uri() + "#t=7.3")
    assert page.is_enabled("#layer-candidates")
    assert ("memory" in page.text_content("#occupancy")) == remembers


def test_what_counts_as_occupied_is_where_obstacles_are(flight):
    page, log = flight
    seen = [o for o in log["header"]["field"]["circle"] if o["x"] < 200]
    cells = 0
    for detail in data_of(page)["details"]:
        edge = detail["map"]["cell"]
        for x, z, length in detail["map"]["occupied"]:
            for number in range(round(length / edge)):
                u, v = x + edge * (number + 0.5), z + edge / 2
                near = min(((u - o["x"]) ** 2 + (v - o["z"]) ** 2) ** 0.5 - o["radius"] for o in log["header"]["field"]["circle"])
                # Errors of the lidar, and hidden parts that the map completes.
                assert near < 2.5, (detail["tick"], u, v)
                cells += 1
    assert cells > 10 * len(seen)


def test_a_flight_that_cannot_be_flown_again_has_a_page_without_candidates(flight, open_page, tmp_path):
    _, log = flight
    log = json.loads(json.dumps(log))
    log["ticks"]["z"][5] += 1e-9
    path = tmp_path / "other.json"
    path.write_text(json.dumps(log))
    page = open_page(page_of(path).as_uri())
    assert page.is_disabled("#layer-scan") and not page.is_disabled("#layer-flown")
    # It opens at its closest approach.
    says_what_the_log_holds(page, log, page.evaluate("flights[0].closest.tick"))
