"""Writes docs/forest.png, the picture of docs/web.md: a moment of target/cross/web/forest.html, which `cargo xtask web` builds.

    target/clients/bin/python tests/pages/still.py
"""

import io

from conftest import CHROMIUM, playwright
from flown import ROOT
from PIL import Image
from test_forest import LAPTOP, PAGE, stands

# A turn between trunks, with a bank of 48 degrees.
MOMENT = "#seed=6&t=1550"
# Without the row of buttons [pixels].
SHOWN = {"x": 0, "y": 0, "width": LAPTOP["width"], "height": 717}


def main():
    with playwright.sync_playwright() as p:
        browser = p.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        page = browser.new_page(viewport=LAPTOP, color_scheme="light")
        page.goto(PAGE.as_uri() + MOMENT)
        stands(page)
        page.wait_for_timeout(500)
        taken = Image.open(io.BytesIO(page.screenshot(clip=SHOWN))).convert("RGB")
        browser.close()
    path = ROOT / "docs" / "forest.png"
    # An octree keeps the few bright pixels, too.
    taken.quantize(256, method=Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE).save(path, optimize=True)
    print(f"{path}: {path.stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    main()
