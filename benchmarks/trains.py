# needs: dynamics
"""What the dynamics of whole recipes cost: seconds of `camgeo check`, a drawing's run included, and how each ends.

python benchmarks/trains.py            prints the table
python benchmarks/trains.py --write    and puts it into docs/dynamics.md
python benchmarks/trains.py --small    two rows, to see that it works
"""

from __future__ import annotations

import argparse
import math
import os
import platform
import sys
import time
from dataclasses import dataclass
from pathlib import Path

from camgeo.output import pipeline
from camgeo.recipe.loading import read

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "dynamics.md"
BEGIN, END = "<!-- trains -->\n", "<!-- end of trains -->\n"
SMALL = "--small" in sys.argv
RPM = 300.0
CAMS = {  # with the mass or moment of inertia of the follower, and the preload
    "three-lobed support cam": ("{kind: support, p: 25 + 2*cos(3*t), shaft: [3, 2]}", 0.4, 150.0),
    "constant breadth": (
        "{kind: constant-breadth, base_radius: 40, motion: [{rise: 20, over: 120, law: modified-sine}, {dwell: 60}]}",
        0.4,
        150.0,
    ),
    "double roller": ("{kind: double-roller, ratio: 2, arm: 40, roller_radius: 8, delta: {cos: {1: 448}}}", 2e-3, 2.0),
    "flat pair": ("{kind: flat-pair, ratio: 3, arm: 60, delta: {cos: {1: 300}}}", 2e-3, 2.0),
}


@dataclass(frozen=True)
class Train:
    """One row: which cam, held by a spring or between two faces, natural frequency over the shaft's, damping ratio."""

    cam: str
    held: str
    ratio: float
    damping: float


TRAINS = (
    Train("three-lobed support cam", "preload", 1.3, 1.0),
    Train("constant breadth", "preload", 1e3, 1e-4),
    Train("constant breadth", "preload", 1e5, 1e-2),
    Train("constant breadth", "preload", 1e5, 1e-6),
    Train("double roller", "preload", 123.0, 0.03),
    Train("double roller", "preload", 1e4, 1e-3),
    Train("flat pair", "preload", 92.0, 0.3),
    Train("three-lobed support cam", "backlash", 1e3, 1e-3),
    Train("constant breadth", "backlash", 1e4, 0.1),
    Train("constant breadth", "backlash", 1e5, 1e-4),
    Train("double roller", "backlash", 123.0, 0.03),
    Train("flat pair", "backlash", 92.0, 0.3),
    Train("flat pair", "backlash", 1e4, 1e-2),
)


def measured(train: Train) -> str:
    """Check one recipe and return the row of the table."""
    cam, mass, preload = CAMS[train.cam]
    frequency = train.ratio * RPM * 2.0 * math.pi / 60.0
    stiffness, damping = mass * frequency**2, 2.0 * train.damping * mass * frequency
    held = f"preload: {preload}" if train.held == "preload" else "backlash: 0.05"
    text = (
        f"cam: {cam}\npart: {{thickness: 8, bore: 8}}\nexport: {{files: [dxf]}}\ndynamics: {{mass: {mass}, "
        f"damping: {damping!r}, stiffness: {stiffness!r}, {held}, rpm: {RPM}, transient: true}}\n"
    )
    begun = time.process_time()
    outcome = pipeline.check(read(text.encode(), Path("train.yaml")))
    seconds = time.process_time() - begun
    cells = (train.cam, train.held, f"{train.ratio:g}", f"{train.damping:g}", f"{seconds:.1f}")
    return f"| {' | '.join(cells)} | {ended(outcome.report['dynamics'])} |"


def ended(section: dict) -> str:
    """Tell how the intended run of a report ended."""
    (run,) = (run for run in section["runs"] if run["from"] == "intended")
    course = run.get("transient")
    if not course:
        words = f"course given up: {run['transient_why'].split(';')[0]}" if run.get("transient_why") else "no course"
    else:
        words = f"{course['turns']} turns, {'settled' if course['settled'] else 'not settled'}"
    if run.get("float_rpm"):
        return f"{words}; float from {run['float_rpm']:.6g} rpm"
    if run.get("float_between_rpm"):
        low, high = (f"{speed:.6g}" if speed else "an unknown speed" for speed in run["float_between_rpm"])
        return f"{words}; float between {low} and {high} rpm"
    return f"{words}; no float" if "float_why" in run else words


def main(*, write: bool) -> None:
    """Print the table, and write it where asked."""
    rows = [
        "| train | held by | natural ratio | damping ratio | seconds | outcome |",
        "| --- | --- | --- | --- | --- | --- |",
    ]
    measured(TRAINS[0])  # imports
    for train in TRAINS[::6][:2] if SMALL else TRAINS:
        rows.append(measured(train))
        print(rows[-1], flush=True)
    machine = f"{platform.machine()}, {os.cpu_count()} cores, Python {platform.python_version()}"
    table = "\n".join([*rows, "", f"Measured by `python benchmarks/trains.py --write` ({machine}).", ""])
    if write and not SMALL:
        text = PAGE.read_text(encoding="utf-8")
        head, rest = text.split(BEGIN)
        PAGE.write_text(head + BEGIN + table + END + rest.split(END)[1], encoding="utf-8")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--small", action="store_true", help="a small size, to see that it works")
    parser.add_argument("--write", action="store_true", help="put it into docs/dynamics.md")
    main(write=parser.parse_args().write)
