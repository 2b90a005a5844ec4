"""Writes docs/forest.webp, the moving picture on top of README: seconds of a flight in space, from its replay.

    target/clients/bin/python tests/pages/animation.py
"""

import io
import tempfile
from pathlib import Path

from conftest import CHROMIUM, playwright
from flown import ROOT, fly, page_of
from PIL import Image

# The flight of docs/forest.png: six seconds that end in its turn, at 8 frames a second of real time.
FLIGHT = ["--preset", "space", "--seed", "6", "--density", "0.04", "--airspeed", "12"]
TICKS = range(1100, 1700, 12)
WIDTH, QUALITY, MOST = 560, 24, 500_000
HIDDEN = "#head, #legend { display: none; } #now dd { font-size: 1rem !important; }"


def main():
    frames = []
    with tempfile.TemporaryDirectory() as folder, playwright.sync_playwright() as p:
        page_file = page_of(fly(Path(folder), *FLIGHT)[0])
        browser = p.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": 1280, "height": 700}, color_scheme="light")
        page.goto(page_file.as_uri())
        page.wait_for_function("!document.body.inert && flight")
        page.add_style_tag(content=HIDDEN)
        box = page.locator("#scene").bounding_box()
        for tick in TICKS:
            page.evaluate(f"go({tick}); show()")
            taken = Image.open(io.BytesIO(page.screenshot(clip=box))).convert("RGB")
            frames.append(taken.resize((WIDTH, WIDTH * taken.height // taken.width), Image.Resampling.LANCZOS))
        browser.close()
    path = ROOT / "docs" / "forest.webp"
    frames[0].save(path, save_all=True, append_images=frames[1:], duration=120, loop=0, quality=QUALITY, method=6, minimize_size=True)
    size = path.stat().st_size
    print(f"{path}: {len(frames)} frames, {size / 1000:.0f} kB")
    assert size <= MOST, "lower the quality, or take fewer frames"


if __name__ == "__main__":
    main()
