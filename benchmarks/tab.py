"""What the live page costs in a browser: `python benchmarks/tab.py [--small]`.

Milliseconds on the clock, from a local server and with nothing kept by the browser: the first picture, which stands
in the page; Python and camgeo ready; from a slider's movement to the next frame with the new picture; a second export,
and how many times that is the native one of the same recipe. Aimed at are 100 ms from number to picture, 60 at best,
and 2.5 times. Without a browser or Pyodide nothing is measured, and that is said.
"""

from __future__ import annotations

import argparse
import statistics
import sys
import tempfile
import time
from pathlib import Path

import camgeo
from camgeo.recipe.starter import starter

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

STARTERS = ("disc-roller", "disc-flat", "constant-breadth", "double-roller", "four-bar")
MOVES = """(async () => {
  const slider = document.querySelector('#form [type=range]');
  const taken = [];
  for (let i = 1; i <= COUNT; i++) {
    const before = document.body.dataset.shown;
    const begun = performance.now();
    slider.value = Number(slider.value) + Number(slider.step) * (i % 2 ? 1 : -1);
    slider.dispatchEvent(new Event("input"));
    while (document.body.dataset.shown === before) await new Promise((done) => setTimeout(done));
    await new Promise(requestAnimationFrame);
    taken.push(performance.now() - begun);
  }
  return taken;
})()"""


def native(text: str) -> float:
    """Seconds of a second export here."""
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(2):
            begin = time.perf_counter()
            camgeo.export(camgeo.load(text), folder)
        return time.perf_counter() - begin


def main() -> None:
    """Print the table."""
    from support import tab
    from support.browser import Browser

    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--small", action="store_true", help="one recipe, a few movements")
    small = parser.parse_args().small
    if tab.why_not():
        print(f"nothing is measured: {tab.why_not()}")
        return
    with (
        tempfile.TemporaryDirectory() as name,
        tab.served(tab.built(Path(name) / "site")) as address,
        Browser(Path(name) / "profile") as browser,
    ):
        browser.size(1280, 800)
        begin = time.perf_counter()
        browser.open(address)
        first = time.perf_counter() - begin
        page = tab.Tab(browser, address)
        page.wait("document.body.dataset.loaded")
        ready = time.perf_counter() - begin
        page.settle()
        print(f"first picture {1e3 * first:.0f} ms, ready {1e3 * ready:.0f} ms")
        print("| recipe | number to picture: median, least | second export | native | times |")
        print("| --- | --- | --- | --- | --- |")
        for starter_name in STARTERS[:1] if small else STARTERS:
            text = starter(starter_name)
            page.load(starter_name, text)
            taken = page.ask(MOVES.replace("COUNT", "6" if small else "40"))
            page.load(starter_name, text)
            page.judged("make")
            page.judged("make")
            export, here = float(page.ask("document.body.dataset.seconds")), native(text)
            moves = f"{statistics.median(taken):.0f}, {min(taken):.0f}"
            print(f"| {starter_name} | {moves} | {1e3 * export:.0f} | {1e3 * here:.0f} | {export / here:.1f} |")


if __name__ == "__main__":
    main()
