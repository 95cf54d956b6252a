"""What the live page costs in a browser: `python benchmarks/tab.py [--small]`.

Milliseconds, from a local server and with nothing kept by the browser: the first picture, which stands in the page;
Python and camgeo ready; from a slider's movement to the next frame with the new picture, and to the verdict on it with
all curves; the same from a joint of the drawn motion; a second export, and how many times that is the native one of the
same recipe. They are of the clock, and behind them of the processor: of the thread in which Python runs, and of the
native process. Aimed at are a median of 100 ms from number to picture, 60 at best, and 2.5 times: the last lines say
whether they are met. Without a browser or Pyodide nothing is measured, and that is said.
"""

from __future__ import annotations

import argparse
import os
import statistics
import sys
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING

import camgeo
from camgeo.recipe.starter import starter

if TYPE_CHECKING:
    from support.browser import Browser

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

STARTERS = ("disc-roller", "disc-flat", "support", "constant-breadth", "double-roller", "four-bar")
PICTURE, BEST = 100.0, 60.0  # ms, aimed at
TIMES = 2.5
WORKER = "DedicatedWorker"  # as Chromium names its threads
RECIPES = ("valve-lobe", "six-bar")
ROOT = Path(__file__).parents[1]
MOVES = """(async () => {
  const moved = document.querySelector("WHAT");
  const shown = () =>
    new Promise((done) => new MutationObserver(done).observe(document.body, { attributeFilter: ["data-shown"] }));
  const judged = () => document.body.dataset.answered === String(changeCount);
  const taken = [];
  for (let i = 1; i <= COUNT; i++) {
    const before = document.body.dataset.shown;
    const begun = performance.now();
    HOW
    while (document.body.dataset.shown === before) await shown();
    await new Promise(requestAnimationFrame);
    const seen = performance.now() - begun;
    while (!judged()) await new Promise(requestAnimationFrame);
    taken.push([seen, performance.now() - begun]);
  }
  return taken;
})()"""


SLIDER = (
    "#form [type=range]",
    "moved.value = +moved.value + (i % 2 ? 1 : -1) * moved.step; moved.dispatchEvent(new Event('input'));",
)
JOINT = (
    ".joint",
    "moved.dispatchEvent(new KeyboardEvent('keydown', { key: i % 2 ? 'ArrowUp' : 'ArrowDown', repeat: i > 1 }));",
)


def movement(count: int, what: str, how: str) -> str:
    """The script that moves an element so many times; its value has the ms to each picture and to each verdict."""
    return MOVES.replace("COUNT", str(count)).replace("WHAT", what).replace("HOW", how)


def native(text: str) -> tuple[float, float]:
    """Seconds of a second export here, on the clock and of the processor."""
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(2):
            begin = time.perf_counter(), time.process_time()
            camgeo.export(camgeo.load(text), folder)
        return time.perf_counter() - begin[0], time.process_time() - begin[1]


def spent(browser: Browser) -> float:
    """Seconds of the processor that Python has taken in a browser: threads of its workers; 0 where no system tells."""
    parents = {}
    for path in Path("/proc").glob("[0-9]*/stat"):
        if cells := _cells(path):
            parents[int(path.parent.name)] = int(cells[1])
    own = {browser.process}
    while more := {number for number, parent in parents.items() if parent in own} - own:
        own |= more
    threads = [path for number in own for path in Path(f"/proc/{number}/task").glob("*/stat")]
    ticks = sum(int(cells[11]) + int(cells[12]) for path in threads if (cells := _cells(path, WORKER)))
    return ticks / float(os.sysconf("SC_CLK_TCK"))


def aims(pictures: list[float], shares: list[float]) -> str:
    """Whether the aims are met by starters: ms from number to picture, and exports' processor time over the native."""
    median, most = statistics.median(pictures), max(shares)
    return (
        f"number to picture, median of starters: {median:.0f} ms, {'met' if median <= PICTURE else 'not met'} "
        f"({PICTURE:.0f}; {BEST:.0f} at best)\n"
        f"second export, most of starters: {most:.1f} times native, {'met' if most <= TIMES else 'not met'} ({TIMES})"
    )


def _cells(path: Path, name: str = "") -> list[str]:
    """What the system tells of a process or a thread behind its name; empty where it has ended or has another name."""
    try:
        own, _, told = path.read_text("utf-8").partition("(")[2].rpartition(")")
    except OSError:
        return []
    return told.split() if own.startswith(name) else []


def main() -> None:
    """Print the table."""
    from support import tab
    from support.browser import Browser

    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--small", action="store_true", help="one recipe, a few movements")
    parser.add_argument("names", nargs="*", metavar="NAME", help="starters and shipped recipes in place of those")
    given = parser.parse_args()
    small = given.small
    if tab.why_not():
        print(f"nothing is measured: {tab.why_not()}")
        return
    with (
        tempfile.TemporaryDirectory() as folder,
        tab.served(tab.built(Path(folder) / "site")) as address,
        Browser(Path(folder) / "profile") as browser,
    ):
        browser.size(1280, 800)
        begin = time.perf_counter()
        browser.open(address)
        first = time.perf_counter() - begin
        page = tab.Tab(browser, address)
        page.wait("document.body.dataset.loaded")
        ready, processor = time.perf_counter() - begin, spent(browser)
        page.settle()
        print(
            f"first picture {1e3 * first:.0f} ms, ready {1e3 * ready:.0f} ms, of the processor {1e3 * processor:.0f} ms"
        )
        print(
            "| recipe | number to picture: median, least | to verdict | processor of both "
            "| second export | native | times, processor |"
        )
        print("| --- | --- | --- | --- | --- | --- | --- |")
        pictures, shares = list[float](), list[float]()
        page.click("play")
        count = 6 if small else 40
        for name in given.names or (STARTERS[:1] if small else (*STARTERS, *RECIPES)):
            shipped = ROOT / "recipes" / f"{name}.yaml"
            text = starter(name) if name in STARTERS else shipped.read_text("utf-8")
            page.load(name, text)
            before = spent(browser)
            seen, judged = zip(*page.ask(movement(count, *SLIDER)), strict=True)
            each = (spent(browser) - before) / count
            page.load(name, text)
            page.judged("make")
            before = spent(browser)
            page.judged("make")
            there, here = (float(page.ask("document.body.dataset.seconds")), spent(browser) - before), native(text)
            moves = (
                f"{statistics.median(seen):.0f}, {min(seen):.0f} | {statistics.median(judged):.0f} | {1e3 * each:.0f}"
            )
            export, at_home = (", ".join(f"{1e3 * seconds:.0f}" for seconds in pair) for pair in (there, here))
            times = ", ".join(f"{a / b:.1f}" for a, b in zip(there, here, strict=True))
            print(f"| {name} | {moves} | {export} | {at_home} | {times} |", flush=True)
            if name in STARTERS:
                pictures.append(statistics.median(seen))
                shares.append(there[1] / here[1])
        if pictures:
            print(aims(pictures, shares))
        page.load(STARTERS[0], starter(STARTERS[0]))
        for name, how in (("slider", SLIDER), ("joint of the motion", JOINT)):
            page.settle()
            seen, judged = zip(*page.ask(movement(count, *how)), strict=True)
            taken = f"{statistics.median(seen):.0f}, {min(seen):.0f} ms; to verdict {statistics.median(judged):.0f} ms"
            print(f"{STARTERS[0]}, {name} to picture: median, least {taken}")


if __name__ == "__main__":
    main()
