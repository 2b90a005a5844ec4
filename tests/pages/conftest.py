"""Pages in headless Chromium: what a test opens must complain of nothing and ask nobody else."""

import os
import shutil

import pytest
from flown import LIMIT, fly, page_of

playwright = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")

CHROMIUM = shutil.which("chromium")
SHOTS = os.environ.get("SCREENSHOTS")


@pytest.fixture(scope="session")
def browser():
    if CHROMIUM is None:
        pytest.skip("chromium is not installed")
    with playwright.sync_playwright() as p:
        browser = p.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield browser
        browser.close()


@pytest.fixture
def open_page(browser):
    """Opens a page; afterwards it must have complained of nothing and asked nobody else."""
    pages, complaints = [], []

    def complain(message, loses):
        lost = loses and message.text.startswith("Failed to load resource")
        if message.type in ("error", "warning") and not lost:
            complaints.append(message.text)

    def open_(url, loses=False, **options):
        """`loses` says that the page will not reach its server all the time; the browser complains of that."""
        page = browser.new_page(**options)
        page.set_default_timeout(LIMIT)
        own = url.split("#")[0]
        page.on("console", lambda message: complain(message, loses))
        page.on("pageerror", lambda error: complaints.append(str(error)))
        page.on("request", lambda r: None if r.url.startswith((own, "data:", "blob:")) else complaints.append(r.url))
        page.goto(url)
        # A page unpacks what it holds before anybody can use it.
        page.wait_for_function("!document.body.inert")
        pages.append(page)
        return page

    yield open_
    for page in pages:
        page.close()
    assert complaints == []


@pytest.fixture
def shot():
    """Saves a picture of the page, if the environment says where."""
    def shot_(page, name):
        if SHOTS:
            page.screenshot(path=f"{SHOTS}/{name}.png", full_page=True)
    return shot_


@pytest.fixture(scope="session")
def flight(tmp_path_factory):
    path, log = fly(tmp_path_factory.mktemp("flight"), "--seed", "1")
    return page_of(path), log


@pytest.fixture(scope="session")
def collided(tmp_path_factory):
    """A flight that ends in an obstacle."""
    arguments = ["--preset", "reference", "--paths", "1", "--obstacles", "40", "--seed", "8"]
    path, log = fly(tmp_path_factory.mktemp("collided"), *arguments)
    assert log["summary"]["outcome"] == "collision"
    return page_of(path), log
