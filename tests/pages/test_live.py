"""The live page in headless Chromium: one viewer or several, lost connections, one flight after the other."""

import contextlib
import json
import re
import signal
import socket
import subprocess
import threading
import urllib.request
from pathlib import Path

import pytest
from flown import BINARY, LIMIT, data_of, fly, page_of, pixels, says_what_the_log_holds, value


@pytest.fixture
def begin():
    """Begins a flight that is shown live; gives its process and the address of its page."""
    processes = []

    def begin_(out, *arguments, port=0):
        process = subprocess.Popen(
            [BINARY, "fly", "--live", f"127.0.0.1:{port}", "--json", "--out", out, *arguments],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        )
        processes.append(process)
        said = []
        for line in process.stderr:
            said.append(line)
            if found := re.search(r"live at (http://127\.0\.0\.1:\d+/)", line):
                return process, found[1]
        pytest.fail("".join(said))

    yield begin_
    for process in processes:
        process.kill()
        process.communicate()


@pytest.fixture
def live(begin, tmp_path):
    process, url = begin(tmp_path, "--duration", "120")
    return process, url, tmp_path


class Line:
    """A line to a server that can be cut."""

    def __init__(self, url):
        self.there = int(url.rstrip("/").split(":")[-1])
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.here = self.listener.getsockname()[1]
        self.url = f"http://127.0.0.1:{self.here}/"
        self.ends, self.is_cut = [], False
        threading.Thread(target=self.accept, daemon=True).start()

    def accept(self):
        while True:
            page, _ = self.listener.accept()
            threading.Thread(target=self.carry, args=(page,), daemon=True).start()

    def carry(self, page):
        with contextlib.suppress(OSError), page, socket.create_connection(("127.0.0.1", self.there)) as server:
            self.ends += [page, server]
            # The server answers only those who know its own address.
            request = page.recv(65536).replace(b":%d" % self.here, b":%d" % self.there)
            if request and not self.is_cut:
                server.sendall(request)
                while answer := server.recv(65536):
                    page.sendall(answer)

    def cut(self):
        self.is_cut = True
        for end in self.ends:
            # One that is closed has nothing to cut.
            with contextlib.suppress(OSError):
                end.shutdown(socket.SHUT_RDWR)


def log_of(process):
    """The log of a flight that ends now."""
    out, _ = process.communicate(timeout=LIMIT / 1000)
    return Path(json.loads(out)["log"])


def flies(page, tick):
    """Waits until the page shows a tick."""
    page.wait_for_function("tick => Number(document.getElementById('time').value) > tick", arg=tick)


def says(page, text):
    """Waits until the page says this about its server."""
    page.wait_for_function("text => document.getElementById('state').textContent.includes(text)", arg=text)


def stands_still(page):
    """Waits until the flight does not move for a second; gives the tick."""
    before = None
    for _ in range(LIMIT // 1000):
        now = page.input_value("#time")
        if now == before:
            return int(now)
        before = now
        page.wait_for_timeout(1000)
    pytest.fail("the flight goes on")


def test_a_live_flight_is_watched_paused_hurried_and_unchanged(live, open_page, tmp_path, shot):
    process, url, out = live
    page = open_page(url, loses=True)
    flies(page, 150)
    shot(page, "live")
    assert int(page.inner_text("#v-candidates")) > 0
    page.click("#play")
    still = stands_still(page)
    page.select_option("#speed", "max")
    page.click("#play")
    page.wait_for_function("document.title.includes('after 120.00 s')")
    assert still < 11_000
    log = json.loads(log_of(process).read_text())
    says_what_the_log_holds(page, log, 11_999)
    _, alone = fly(tmp_path / "alone", "--duration", "120")
    assert alone == log


def test_a_live_page_keeps_the_newest_ticks_and_cycles(live, open_page):
    process, url, out = live
    page = open_page(url, loses=True)
    page.evaluate("kept = 1000; keptCycles = 10")
    page.select_option("#speed", "max")
    page.wait_for_function("document.title.includes('after 120.00 s')")
    length, first, cycles = page.evaluate("[flights[0].ticks.t.length, flights[0].first, flights[0].details.size]")
    assert 1000 <= length <= 1105 and first + length == 12_000 and cycles == 10
    assert page.evaluate("flights[0].plans.length") <= 13
    log = json.loads(log_of(process).read_text())
    for tick in (11_999, 11_500):
        page.locator("#time").fill(str(tick))
        assert page.inner_text("#clock") == f"{tick / 100:.2f} s"
        assert float(value(page, "height").split()[0]) == pytest.approx(log["ticks"]["z"][tick], abs=0.0051)
    # What is no longer there cannot be chosen.
    page.keyboard.press("Home")
    assert page.input_value("#time") == str(first)


def test_the_server_refuses_what_it_does_not_know(live):
    _, url, _ = live

    def status(path, method="GET", **headers):
        headers = {name.replace("_", "-"): value for name, value in headers.items()}
        request = urllib.request.Request(url + path, method=method, headers=headers)
        try:
            return urllib.request.urlopen(request, timeout=LIMIT / 1000).status
        except urllib.error.HTTPError as error:
            return error.code

    assert status("") == 200
    assert status("passwd") == 404
    assert status("", Host="evil.example") == 403
    assert status("", Origin="http://evil.example") == 403
    assert status("control?pause=1", "POST") == 403
    page = urllib.request.urlopen(url, timeout=LIMIT / 1000).read().decode()
    token = re.search(r'TOKEN = "([0-9a-f]{32})"', page)[1]
    assert status("control?speed=-1", "POST", X_Token=token) == 400
    assert status("control?pause=0", "POST", X_Token=token) == 204


def test_a_page_that_lost_the_connection_goes_on_where_it_was(live, open_page):
    process, url, _ = live
    line = Line(url)
    page = open_page(line.url, loses=True)
    flies(page, 150)
    # Another beginning would bring another header.
    page.evaluate("flights[0].header.kept = true")
    line.cut()
    says(page, "The server is gone.")
    lost = int(page.input_value("#time"))
    page.wait_for_timeout(1500)
    assert int(page.input_value("#time")) == lost
    line.is_cut = False
    flies(page, lost + 150)
    assert page.inner_text("#state") == ""
    assert page.evaluate("flights[0].header.kept")
    page.select_option("#speed", "max")
    says(page, "The flight has ended.")
    times, plans = page.evaluate("[flights[0].ticks.x, flights[0].plans.map(plan => plan.tick)]")
    log = json.loads(log_of(process).read_text())
    # Nothing is missing, nothing came twice.
    assert times == log["ticks"]["x"]
    assert plans == [plan["tick"] for plan in log["plans"]]


def test_a_page_comes_back_after_another_answer_than_events(live, open_page):
    _, url, _ = live
    page = open_page(url, loses=True)
    flies(page, 50)
    asked = []

    def refuse_once(route):
        asked.append(route)
        if len(asked) == 1:
            return route.fulfill(status=503, body="too many pages")
        return route.continue_()

    page.route("**/events", refuse_once)
    page.reload()
    says(page, "The server is gone.")
    flies(page, 50)
    assert len(asked) == 2 and page.inner_text("#state") == ""


def test_every_viewer_sees_pause_and_speed(live, open_page):
    _, url, _ = live
    pages = [open_page(url), open_page(url)]
    for page in pages:
        flies(page, 50)
        assert (page.inner_text("#play"), page.input_value("#speed")) == ("Pause", "1")
    pages[0].click("#play")
    pages[1].select_option("#speed", "4")
    pages.append(open_page(url))

    def see(button, speed):
        for page in pages:
            page.wait_for_function(
                "([button, speed]) => $('play').textContent === button && $('speed').value === speed", arg=[button, speed])

    see("Play", "4")
    still = stands_still(pages[0])
    # The one who came last lets it go on.
    pages[2].click("#play")
    see("Pause", "4")
    flies(pages[0], still + 50)


def test_a_speed_of_the_command_line_is_shown(begin, open_page, tmp_path):
    _, url = begin(tmp_path, "--speed", "2.5")
    page = open_page(url)
    page.wait_for_function("$('speed').value === '2.5'")


def test_orders_are_listed(begin, open_page, tmp_path):
    (tmp_path / "set.parm").write_text("MPP_PATHS,7\n")
    _, url = begin(tmp_path, "--params", tmp_path / "set.parm")
    page = open_page(url)
    flies(page, 50)
    assert page.inner_text("#orders") == "0.00 s: parameter MPP_PATHS 7"


def test_the_closest_approach_is_marked_while_the_flight_goes_on(live, open_page, tmp_path):
    process, url, _ = live
    page = open_page(url, loses=True)
    flies(page, 150)
    page.click("#play")
    stands_still(page)
    tick, clearance = page.evaluate("[flights[0].closest.tick, flights[0].closest.clearance]")
    assert tick <= int(page.input_value("#time")) and clearance > 0
    page.uncheck("#follow")
    marked = pixels(page)
    page.evaluate("flights[0].closest = null; show()")
    assert pixels(page) != marked
    page.select_option("#speed", "max")
    page.click("#play")
    says(page, "The flight has ended.")
    assert page.evaluate("flights[0].closest") == data_of(page_of(log_of(process)))["closest"]


def test_an_open_page_shows_only_the_second_of_two_flights(begin, open_page, tmp_path):
    first, url = begin(tmp_path, "--seed", "7")
    page = open_page(url, loses=True)
    page.wait_for_function("document.title.includes('seed 7')")
    flies(page, 300)
    first.send_signal(signal.SIGINT)
    says(page, "The flight has ended.")
    assert "interrupted" in page.title()
    first.communicate(timeout=LIMIT / 1000)
    port = url.rstrip("/").split(":")[-1]
    second, _ = begin(tmp_path, "--seed", "9", port=port)
    page.wait_for_function("document.title.includes('seed 9')")
    assert page.inner_text("#state") == "" and "seed 7" not in page.content()
    flies(page, 50)
    # The page obeys the second server, and holds nothing of the first flight.
    page.select_option("#speed", "max")
    says(page, "The flight has ended.")
    heights = page.evaluate("flights.map(flight => flight.ticks.z)")
    assert heights == [json.loads(log_of(second).read_text())["ticks"]["z"]]


def test_a_page_says_that_a_server_is_gone_that_did_not_say_good_bye(begin, open_page, tmp_path):
    first, url = begin(tmp_path, "--seed", "7")
    page = open_page(url, loses=True)
    flies(page, 50)
    first.kill()
    says(page, "The server is gone.")
    assert "ended" not in page.inner_text("#state")
    first.communicate()
    begin(tmp_path, "--seed", "7", port=url.rstrip("/").split(":")[-1])
    page.wait_for_function("$('state').textContent === ''")
    flies(page, 50)
