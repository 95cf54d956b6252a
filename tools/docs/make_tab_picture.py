"""Draw docs/pictures/tab.png, a page in a browser: `python tools/docs/make_tab_picture.py`, by Chromium and Pyodide."""

from __future__ import annotations

import argparse
import io
import sys
import tempfile
from pathlib import Path

from PIL import Image

from camgeo.recipe.starter import starter

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tests"))

SIZE = (1280, 800)
COLOURS = 96


def main() -> None:
    """Build the page, change two numbers, and keep what is seen."""
    from support import tab
    from support.browser import Browser

    if tab.why_not():
        sys.exit(tab.why_not())
    with (
        tempfile.TemporaryDirectory() as name,
        tab.served(tab.built(Path(name) / "site")) as address,
        Browser(Path(name) / "profile") as browser,
    ):
        browser.size(*SIZE)
        page = tab.Tab(browser, address).open()
        page.load("disc-roller", starter("disc-roller") + "limits: {pressure-angle: {at_most: 30}}\n")
        page.slide("cam.motion[0].over", 80)
        page.slide("cam.base_radius", 24)
        page.click("play")
        page.ask("document.querySelector('#failed .go').click()")
        picture = Image.open(io.BytesIO(browser.screenshot()))
    path = ROOT / "docs" / "pictures" / "tab.png"
    picture.convert("RGB").quantize(COLOURS, dither=Image.Dither.NONE).save(path, optimize=True)
    print(f"{path.name}: {path.stat().st_size} bytes")


if __name__ == "__main__":
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    main()
