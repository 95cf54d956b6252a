"""The aims of speed and what is reached, one table of one run: `python benchmarks/peers.py --targets [--tests]`.

Everything is processor time with one BLAS thread, and stands beside that of `import numpy` on the same machine in the
same run. Rows come from `speed.py`, `growth.py`, `sweep.py` and `peers.py`, whose own tables are printed on the way.
`--tests` takes the quick suite too, which is minutes.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import growth
import speed
import sweep
import yaml

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

ROOT = Path(__file__).parents[1]
FORMS_OF_FILES = ("arcs", "polygon", "spline", "export")
FORMS = ("law", "arc", "rosette")  # of double rollers and flat pairs, whose curve is found by equations
DESIGN = {  # aims in ms: the exact design; with arcs and verdict
    "supports, constant breadth": (5.0, 16.0),
    "disc cams": (12.0, 25.0),
    "double rollers, flat pairs": (15.0, 25.0),
    "by law, arc, rosette": (40.0, 25.0),
}
EXPORT = 50.0  # ms
SHIPPED, FIGURES = 2.0, 1.3  # times the plain design
EXPONENT = 1.1
FOUR_BARS, DISCS = 20_000, 1_000  # designs a second
TESTS = 250.0  # s
ALWAYS = ("shapely + trimesh", "scipy spline + ezdxf", "CadQuery DXF", "CadQuery STL")
AHEAD = ("numpy", "numpy + shapely + ezdxf", "OpenSCAD")  # they prove and judge nothing, and may be ahead


class Line(NamedTuple):
    """A row: what is measured, its aim, what is reached, how often `import numpy` that is, and whether it is met."""

    what: str
    aim: str
    reached: str
    numpy: str
    met: bool


def table(costs: Callable[[str, float], float | None], tests: list[str]) -> None:
    """Measure and print all; `costs` gives the least cold seconds of a tool at an error, mm."""
    base = speed.cold()["stl"][1]
    lines = [*of_peers(costs, base), *of_warm(base), *of_growth(), *of_sweeps()]
    if tests:
        seconds = of_children(tests)
        lines.append(Line("README's test line", f"{TESTS:g} s", f"{seconds:.0f} s", "", seconds <= TESTS))
    print(f"\n`import numpy`: {1e3 * base:.0f} ms\n")
    print("| what | aim | reached | over `import numpy` | |\n| --- | --- | --- | --- | --- |")
    for line in lines:
        print(f"| {line.what} | {line.aim} | {line.reached} | {line.numpy} | {'met' if line.met else 'not met'} |")


def of_peers(costs: Callable[[str, float], float | None], base: float) -> Iterator[Line]:
    """The whole process against peers at the same error, the best of our files of that kind."""
    from peer import PEERS
    from peers import RIVALS

    for name, (_, suffix) in PEERS.items():
        for level in (1e-3, 1e-5):
            theirs = costs(name, level)
            ours = min((found for tool in RIVALS[suffix] if (found := costs(tool, level))), default=None)
            if theirs is None or ours is None:
                continue
            must = name in ALWAYS or (level <= 1e-5 and name not in AHEAD)
            aim = "less" if must else "ahead of us, and said so"
            reached = f"{ours / theirs:.2f} times ({1e3 * ours:.0f}, {1e3 * theirs:.0f} ms)"
            met = ours < theirs or not must
            yield Line(
                f"cold, {suffix[1:].upper()} within {level:g} mm, against {name}",
                aim,
                reached,
                f"{ours / base:.1f}",
                met,
            )


def group(path: Path) -> str:
    """The kind of cam that a recipe has."""
    cam = yaml.safe_load(path.read_text(encoding="utf-8")).get("cam", {})
    kind = cam.get("kind", "")
    if kind in ("support", "constant-breadth"):
        return "supports, constant breadth"
    if kind in ("double-roller", "flat-pair"):
        return "by law, arc, rosette" if {*FORMS} & {*cam} else "double rollers, flat pairs"
    return "disc cams"


def of_warm(base: float) -> Iterator[Line]:
    """Exact designs, with arcs and verdict, and exports of a DXF, of the shipped recipes."""
    found = growth.warm("", small=speed.SMALL)
    numpy = 1e3 * base

    def line(what: str, aim: float, values: list[float], unit: str = " ms") -> Line:
        low, high, within = min(values), max(values), sum(value <= aim for value in values)
        digits = 0 if unit == " ms" else 2
        over = f"{low / numpy:.2f} to {high / numpy:.2f}" if unit == " ms" else ""
        reached = f"{low:.{digits}f} to {high:.{digits}f}, {within} of {len(values)} within"
        return Line(what, f"{aim:g}{unit}", reached, over, high <= aim)

    for name, (design, verdict) in DESIGN.items():
        mine = [spent for path, spent in found.items() if group(path) == name]
        if mine:
            yield line(f"design, {name}", design, [spent[0] for spent in mine])
            yield line(f"with arcs and verdict, {name}", verdict, [spent[3] for spent in mine])
    every = list(found.values())
    yield line("design as shipped", SHIPPED, [spent[1] / spent[0] for spent in every], " times plain")
    yield line("design, all figures", FIGURES, [spent[2] / spent[0] for spent in every], " times plain")
    yield line("warm export of a DXF", EXPORT, [spent[4] for spent in every])


def of_growth() -> Iterator[Line]:
    """Exponents of cost by size, of fits at 1 micrometre but the polygons left out."""
    rows = [row for row in growth.growing() if row.name.rpartition(" ")[2] not in FORMS_OF_FILES]
    groups: dict[str, list[float]] = {}
    for name, power in growth.growth(rows[::12] if speed.SMALL else rows, small=speed.SMALL).items():
        groups.setdefault(name.partition(",")[0], []).append(power)
    for name, powers in groups.items():
        within = sum(power <= EXPONENT for power in powers)
        reached = f"{min(powers):.2f} to {max(powers):.2f}, {within} of {len(powers)} within"
        yield Line(f"growth, {name}", f"exponent {EXPONENT:g}", reached, "", max(powers) <= EXPONENT)


def of_sweeps() -> Iterator[Line]:
    """Designs a second a core."""
    fast = sweep.command()
    yield Line("sweep, four-bars", f"{FOUR_BARS:,} a second", f"{fast:,.0f}", "", fast >= FOUR_BARS)
    rates = sweep.estimates().values()
    reached = f"{min(rates):,.0f} to {max(rates):,.0f}"
    yield Line("sweep, cams without a linkage", f"{DISCS:,} a second", reached, "", min(rates) >= DISCS)


def of_children(command: list[str]) -> float:
    """Processor seconds of a command and all its processes."""
    import subprocess

    start = os.times()
    subprocess.run(command, check=True, stdout=sys.stderr, cwd=ROOT)
    end = os.times()
    return end.children_user + end.children_system - start.children_user - start.children_system
