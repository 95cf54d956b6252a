"""Where cost might outgrow the work, and warm runs: `python benchmarks/growth.py [growth] [scale] [warm] [unseen]`.

`growth` prints milliseconds over the size of the work, and the exponent of one by the other, by least squares over the
last two decades of the size that were measured, or over all where they are fewer; aim: 1.1. `scale` does so for what
users bring in great numbers, up to the most that is taken, each size in a process of its own, with the greatest memory
and what the last decade costs beyond ten times: a decade that costs more than 1.15 times as much a unit as the one
before it ends the call with status 1. `warm` prints milliseconds
from a recipe object to its exact design without part and limits, as shipped, and with every figure that may be asked;
then with arcs at 0.001 mm and their verdict at 3600 angles in memory, of a whole export of a DXF, and of the scene of a
finished design, which is all that a page draws. `unseen` prints those of a whole export of a DXF of recipes that the
process has not seen, one number changed each time. With `--docs` each writes its table into docs/performance.md.

All of it is processor time with one BLAS thread, the least of several repeats. `--small` takes little of everything, to
see that it works: its figures say nothing. `--only REGEX` takes the rows whose names match.
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before numpy

import argparse
import contextlib
import gc
import math
import re
import subprocess
import sys
import tempfile
import time
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import yaml
from counted import peak_mb
from pages import rewrite
from peer import COLLECT_AFTER
from speed import compiled, spent

import camgeo
from camgeo.api.design import Design
from camgeo.api.loading import load
from camgeo.cli.batch import folder_conflicts
from camgeo.cli.main import main
from camgeo.files.layer_outline import LayerOutline
from camgeo.files.precision import SINGLE
from camgeo.files.prism import extruded_mesh
from camgeo.fit.pieces import Bound, Polygon
from camgeo.fit.polygon import fit_polygon
from camgeo.formats.stl import write_stl
from camgeo.output.job import Job
from camgeo.output.pipeline import export
from camgeo.part.part import Part
from camgeo.part.shapes import disc
from camgeo.synthesis.design import designed
from camgeo.synthesis.intent import intended, intents, permitted
from kin.contour.contour import Contour
from kin.judge.contour_checks import judge_contour
from kin.read.nesting import ClosedContour

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from camgeo.recipe.recipe import Recipe

RECIPES = Path(__file__).parents[1] / "recipes"
MICROMETRE, ANGLES = 1e-3, 3600
ENOUGH = 0.3  # seconds of repeats
DECADES = 2.0
LAWS = ("cycloidal", "modified-sine", "polynomial-345")
DISC = {"kind": "disc", "base_radius": 60, "follower": {"kind": "roller", "radius": 5}}
BREADTH = {"kind": "constant-breadth", "base_radius": 60}


def least(function: Callable[[], object], repeats: int) -> float:
    """Least processor seconds of a few calls; of a long one there is one."""
    best, spent = math.inf, 0.0
    for _ in range(repeats):
        start = time.process_time()
        function()
        once = time.process_time() - start
        best, spent = min(best, once), spent + once
        if spent > ENOUGH:
            break
    return best


# --- growth -----------------------------------------------------------------------------------------------------------


class Row(NamedTuple):
    """Work to be measured at each of its sizes: `work(size)` prepares it and gives what is timed.

    What that returns counts as the size where it is a number.
    """

    name: str
    sizes: tuple[float, ...]
    work: Callable[[float], Callable[[], object]]


def exponent(sizes: list[float], seconds: list[float]) -> float:
    """Exponent of cost by size over the last decades."""
    x, y = np.log10(sizes), np.log10(seconds)
    last = x >= x[-1] - DECADES - 0.05
    return float(np.polyfit(x[last], y[last], 1)[0])


GROWTH_HEADING = "| what grows | size: ms | exponent |\n| --- | --- | --- |\n"


def growth(rows: list[Row], *, small: bool, docs: bool = False) -> dict[str, float]:
    """Print a line for each row, and give its exponent."""
    exponents, lines = {}, []
    print(f"\n{GROWTH_HEADING}", end="")
    for row in rows:
        sizes, seconds = [], []
        for size in row.sizes[:2] if small else row.sizes:
            work = row.work(size)
            found = work()
            sizes.append(float(found) if isinstance(found, int) else size)
            seconds.append(least(work, 1 if small else 7))
        told = ", ".join(f"{size:.7g}: {1e3 * spent:.3g}" for size, spent in zip(sizes, seconds, strict=True))
        exponents[row.name] = exponent(sizes, seconds)
        lines.append(f"| {row.name} | {told} | {exponents[row.name]:.2f} |")
        print(lines[-1], flush=True)
    if docs and not small:
        rewrite(GROWTH_HEADING, lines)
    return exponents


def polygons(name: str) -> Callable[[float], Callable[[], object]]:
    """Fit polygons of a shipped cam within a tolerance; the size is the number of edges."""
    ((_, contour),) = designed(load(RECIPES / f"{name}.yaml")).contours
    return lambda tolerance: lambda: len(fit_polygon(contour, tolerance).vertices)


def solids(count: float) -> Callable[[], object]:
    """Write the STL of a ring of so many edges."""
    t = np.linspace(0.0, 2.0 * np.pi, int(count), endpoint=False)
    r = 25.0 + 2.0 * np.cos(3 * t)
    polygon = Polygon(np.column_stack([r * np.cos(t), r * np.sin(t)]), Bound(0.0, 0.0))

    bore = disc("bore", "BORE", (0.0, 0.0), 5.0)
    outlines = [LayerOutline("CUT", polygon), LayerOutline(bore.layer, bore.outline, bore.circle)]

    def work() -> None:
        with tempfile.TemporaryDirectory() as folder:
            mesh, _ = extruded_mesh(outlines, thickness=8.0, tolerance=1e-3, precision=SINGLE)
            write_stl(Path(folder) / "ring.stl", mesh)

    return work


def large(length: float) -> Callable[[], object]:
    """Make and judge the STL of two discs, the second arm so long, mm; the size is the edges of both."""
    recipe = load(RECIPES / "conjugate-arm.yaml").replace("cam.conjugate.length", length)

    def work() -> int:
        with tempfile.TemporaryDirectory() as folder:
            files = export(recipe, Path(folder), only=("stl",)).report["files"]
        return sum(int(file["pieces"]) for file in files)

    return work


def judged(name: str) -> Callable[[float], Callable[[], object]]:
    """Judge a polygon with so many vertices, on the exact contour of a shipped recipe, at 3600 angles."""
    recipe = load(RECIPES / f"{name}.yaml")
    design = designed(recipe)
    phi = np.linspace(0.0, 2.0 * np.pi, ANGLES, endpoint=False)
    (surface,) = intended(recipe, design).surfaces
    ((_, contour),), limits = design.contours, permitted(recipe, MICROMETRE)

    def prepare(count: float) -> Callable[[], object]:
        run = contour.runs[0]
        t = np.linspace(run.low, run.high, int(count), endpoint=False)
        points = contour.sample(t).point
        return lambda: judge_contour(ClosedContour(Contour.from_vertices(points)), surface, phi, limits)[0] and None

    return prepare


def points(count: float) -> Recipe:
    """A disc cam by so many points of a smooth lift."""
    theta = np.linspace(0.0, 360.0, int(count), endpoint=False)
    turn = np.radians(theta)
    lift = 6.0 * (1.0 - np.cos(turn)) + 1.5 * (1.0 - np.cos(2.0 * turn)) + 0.2 * np.sin(3.0 * turn)
    at = [[float(f"{a:.9g}"), float(f"{s:.9g}")] for a, s in zip(theta, lift, strict=True)]
    return load({"cam": {**DISC, "motion": {"points": at}}, "export": {"tolerance": MICROMETRE, "files": ["dxf"]}})


def segments(cam: dict[str, object], over: float, bent: float) -> Callable[[float], Recipe]:
    """Make a cam of so many segments over an angle, rises and returns by turns of up to `bent`/count^2 mm."""

    def make(count: float) -> Recipe:
        number = int(count)
        span = f"{over:g}/{number}"
        steps = [
            {"rise" if i % 2 == 0 else "return": min(3.0, bent / number**2), "over": span, "law": LAWS[i // 2 % 3]}
            for i in range(number)
        ]
        return load({"cam": {**cam, "motion": steps}, "export": {"tolerance": MICROMETRE, "files": ["dxf"]}})

    return make


def harmonics(order: float) -> Recipe:
    """A plate of constant breadth with all odd harmonics up to an order."""
    waves = {str(k): 20.0 / k**3.5 for k in range(3, int(order) + 1, 2)}
    fourier = {"mean": 30, "cos": waves, "sin": {k: 0.7 * a for k, a in waves.items()}}
    return load({"cam": {"kind": "support", "fourier": fourier}, "export": {"tolerance": MICROMETRE, "files": ["dxf"]}})


def swing_harmonics(order: float) -> Recipe:
    """A double roller whose delta has every third harmonic that its arms admit, up to an order."""
    waves = {str(k): 300.0 / k**3.5 for k in range(1, int(order) + 1, 2)}
    cam = {"kind": "double-roller", "ratio": "2", "arm": 60, "roller_radius": 8, "delta": {"cos": waves}}
    return load({"cam": cam, "export": {"tolerance": MICROMETRE, "files": ["dxf"]}})


def waves(order: float) -> Recipe:
    """A roller's disc cam by a displacement formula of so many waves."""
    motion = {"formula": f"{40.0 / order**2:.9g}*(1 - cos({int(order)}*t))"}
    return load({"cam": {**DISC, "motion": motion}, "export": {"tolerance": MICROMETRE, "files": ["dxf"]}})


def made(make: Callable[[float], Recipe], form: str = "") -> Callable[[float], Callable[[], object]]:
    """Design a recipe; with a form its fit at 1 micrometre alone, with `export` a whole export."""

    def prepare(size: float) -> Callable[[], object]:
        recipe = make(size)
        if form == "export":
            return lambda: exported(recipe)
        if not form:
            return lambda: designed(recipe).checks and None
        design = designed(recipe)
        return lambda: Job.of(recipe, design).outlines(form, MICROMETRE) and None

    return prepare


def growing() -> Iterator[Row]:
    """What is measured."""
    edges = tuple(10.0**-k for k in range(3, 10))
    yield Row("polygon, as-figure-2a, 1e-3 to 1e-9 mm, edges", edges, polygons("as-figure-2a"))
    yield Row("polygon, w-figure-9, 1e-3 to 1e-9 mm, edges", edges, polygons("w-figure-9"))
    yield Row("polygon, disc-roller, 1e-3 to 1e-9 mm, edges", edges, polygons("disc-roller"))
    decades = (1e3, 1e4, 1e5, 1e6)
    yield Row("STL of a ring, edges", decades, solids)
    yield Row("STL of a pair whose second arm is 3e3 to 3e4 mm long, edges", (3e3, 1e4, 2e4, 3e4), large)
    for name in ("shu-wu", "disc-roller", "disc-flat", "w-figure-5", "w-figure-9"):
        yield Row(f"judge, {name}, pieces", decades, judged(name))
    few = (10.0, 30.0, 100.0, 300.0, 1000.0)
    for form in ("", "arcs", "polygon", "spline", "export"):
        yield Row(f"points, disc roller, {form or 'design'}", few, made(points, form))
    for name, cam, over, bent in (("constant breadth", BREADTH, 180.0, 40.0), ("disc roller", DISC, 360.0, 150.0)):
        for form in ("", "arcs", "polygon", "spline", "export"):
            sizes = (2.0, 4.0, 10.0, 20.0, 50.0, 100.0)
            yield Row(f"segments, {name}, {form or 'design'}", sizes, made(segments(cam, over, bent), form))
    breaks = (59.0, 119.0, 239.0, 479.0)
    yield Row("breaks of a disc roller's points, polygon", breaks, made(lambda count: points(count + 1.0), "polygon"))
    sizes = (3.0, 7.0, 19.0, 49.0, 99.0, 199.0)
    for name, make in (
        ("support", harmonics),
        ("double roller", swing_harmonics),
        ("disc roller's formula", waves),
    ):
        for form in ("", "arcs", "polygon", "spline"):
            yield Row(f"harmonics, {name}, {form or 'design'}", sizes, made(make, form))


# --- scale ------------------------------------------------------------------------------------------------------------


# needs: made
def measured_points(count: int, folder: Path) -> Callable[[], object]:
    """Judge so many points, measured on a cam."""
    cam = load({**SCALED, "made": {"profile": 0.05}})
    t = np.arange(count) * (2.0 * np.pi / count)
    ((surface, *_), *_) = (intent.surfaces for intent in intents(cam, designed(cam)))
    frame = surface.gauge.envelope.frames(t)
    off = 0.01 * np.cos(9.0 * t) + 0.002 * np.random.default_rng(1).normal(size=count)
    path = folder / f"{count}.csv"
    np.savetxt(path, frame.points + off[:, None] * frame.normals, "%.6f", ",", header="x_mm,y_mm", comments="")
    return lambda: camgeo.verify(cam, path)


def table_rows(count: int, folder: Path) -> Callable[[], object]:
    """Read and design a motion from a table of so many rows."""
    theta = np.arange(count) * (2.0 * np.pi / count)
    path = folder / f"{count}.csv"
    lift = designed(load(SCALED)).motion.rows(theta, 0)[0]
    np.savetxt(path, np.column_stack([np.degrees(theta), lift]), "%.6f", ",", header="theta_deg,s_mm", comments="")
    recipe = folder / "cam.yaml"
    recipe.write_text(yaml.safe_dump({"cam": SCALED["cam"] | {"motion": {"table": path.name}}}), encoding="utf-8")
    return lambda: designed(load(recipe)).checks


# needs: budget
def simulated_parts(count: int, _folder: Path) -> Callable[[], object]:
    """Simulate so many parts within a budget."""
    from camgeo.capabilities.budget.library import budget

    tolerances = {"profile": 0.01, "follower.radius": 0.005, "shaft": 0.01}
    recipe = load({**SCALED, "budget": {"permitted": 0.05, "tolerances": tolerances, "runs": count}})
    return lambda: budget(recipe)


def recipes_of_a_call(count: int, folder: Path) -> Callable[[], object]:
    """Look for recipes of one call that would write into the same folder."""
    orders = [SimpleNamespace(path=folder / f"{k}.yaml", name=f"cam {k}") for k in range(count)]
    return lambda: folder_conflicts(orders)


# needs: sweep
def designs_of_a_sweep(count: int, folder: Path) -> Callable[[], object]:
    """Search so many designs in one process, by the command."""
    text = (RECIPES / "sweep-four-bar.yaml").read_text(encoding="utf-8")
    recipe = yaml.safe_load(text)
    vary = {key: {name: span[name] for name in ("from", "to")} for key, span in recipe["sweep"]["vary"].items()}
    recipe["sweep"] |= {"vary": vary, "method": "random", "count": count}
    path = folder / f"{count}.yaml"
    path.write_text(yaml.safe_dump(recipe), encoding="utf-8")

    def work() -> None:
        with contextlib.redirect_stdout(None), contextlib.redirect_stderr(None):
            main(["sweep", str(path), "--out", str(folder / "out"), "--jobs", "1"])

    return work


SCALED = {
    "cam": {
        "kind": "disc",
        "base_radius": 36,
        "follower": {"kind": "roller", "radius": 9, "offset": 10},
        "motion": [
            {"rise": 24, "over": 100, "law": "modified-sine"},
            {"dwell": 40},
            {"return": 24, "over": 140, "law": "modified-trapezoid"},
            {"dwell": 80},
        ],
    },
    "part": {"bore": 12},
}
SCALES: dict[str, tuple[Callable[[int, Path], Callable[[], object]], tuple[int, ...]]] = {
    "measured points": (measured_points, (10_000, 100_000, 1_000_000)),  # needs: made
    "rows of a table": (table_rows, (2_000, 20_000, 200_000)),
    "simulated parts of a budget": (simulated_parts, (10_000, 100_000, 1_000_000)),  # needs: budget
    "recipes of a call": (recipes_of_a_call, (1_000, 10_000, 100_000)),
    "designs of a sweep": (designs_of_a_sweep, (10_000, 100_000, 1_000_000)),  # needs: sweep
}
SCALE_HEADING = "| what grows | size: s | beyond ten times | MB |\n| --- | --- | --- | --- |\n"


MOST = 1.15  # times the cost of a unit, from one decade to the next


def scale(pattern: str, *, small: bool, docs: bool) -> list[str]:
    """Print a line for each row of `SCALES`, and give the names of those whose cost outgrows their size."""
    print(f"\n{SCALE_HEADING}", end="")
    rows, beyond = [], []
    for name, (_, sizes) in SCALES.items():
        if not re.search(pattern, name):
            continue
        command = [sys.executable, __file__, "--row", name, "--size"]
        told = []
        for size in (sizes[0] // 100, sizes[0] // 10) if small else sizes:
            done = subprocess.run([*command, str(size)], capture_output=True, text=True, check=True)
            told.append((size, *map(float, done.stdout.split()[-2:])))
        each = [seconds / size for size, seconds, _ in told]
        decades = [after / before for before, after in pairwise(each)]
        if max(decades) > MOST and not small:
            beyond.append(name)
        cells = ", ".join(f"{size:,}: {seconds:.3g}" for size, seconds, _ in told)
        rows.append(f"| {name} | {cells} | {decades[-1]:.2f} | {', '.join(f'{mb:.0f}' for *_, mb in told)} |")
        print(rows[-1], flush=True)
    if docs and not small:
        rewrite(SCALE_HEADING, rows)
    return beyond


def one_size(name: str, size: int) -> None:
    """Print the processor seconds of one size, after a small one that imports, and the greatest memory, MB."""
    make, sizes = SCALES[name]
    gc.set_threshold(COLLECT_AFTER)  # as the command has
    with tempfile.TemporaryDirectory() as folder:
        make(max(sizes[0] // 10, 100), Path(folder))()
        work = make(size, Path(folder))
        start = time.process_time()
        work()
        print(time.process_time() - start, peak_mb())


# --- warm -------------------------------------------------------------------------------------------------------------


def exported(recipe: Recipe) -> None:
    """Write and judge a recipe's DXF."""
    with tempfile.TemporaryDirectory() as folder:
        export(recipe, Path(folder), only=("dxf",))


def in_memory(recipe: Recipe) -> None:
    """Design, arcs at 0.001 mm, verdict at 3600 angles."""
    design = designed(recipe)
    phi, limits = np.linspace(0.0, 2.0 * np.pi, ANGLES, endpoint=False), permitted(recipe, MICROMETRE)
    surfaces = (surface for intent in intents(recipe, design) for surface in intent.surfaces)
    for fit, surface in zip(Job.of(recipe, design).fits, surfaces, strict=True):
        arcs = fit.within("arcs", MICROMETRE)
        judge_contour(ClosedContour(Contour.from_bulges(arcs.points, arcs.bulges)), surface, phi, limits)


WARM_HEADING = (
    "| recipe | plain | as shipped | times | all figures | times | arcs and verdict | DXF | scene |\n"
    "| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n"
)


def warm(pattern: str, *, small: bool, docs: bool = False) -> dict[Path, list[float]]:
    """Print a line for each shipped recipe, and give its milliseconds."""
    found, lines = {}, []
    print(f"\n{WARM_HEADING}", end="")
    for path in sorted(RECIPES.glob("*.yaml"))[:: 12 if small else 1]:
        if not re.search(pattern, path.stem):
            continue
        recipe = load(path)
        plain = replace(recipe, part=replace(Part(), outer=recipe.part.outer), limits=(), linkage=None)
        dxf = recipe.replace("export.files", ["dxf"])
        calls: tuple[Callable[[], object], ...] = (
            lambda plain=plain: designed(plain),
            lambda recipe=recipe: designed(recipe),
            lambda plain=plain: Design(plain, designed(plain)).figures,
            lambda plain=plain: in_memory(plain),
            lambda dxf=dxf: exported(dxf),
            Design(recipe, designed(recipe)).scene,
        )
        spent = []
        for call in calls:
            call()
            spent.append(1e3 * least(call, 1 if small else 7))
        found[path] = spent
        a, b, c, d, e, f = spent
        times = f"{b:.1f} | {b / a:.2f} | {c:.1f} | {c / a:.2f} | {d:.1f} | {e:.1f} | {f:.1f}"
        lines.append(f"| {path.stem} | {a:.1f} | {times} |")
        print(lines[-1], flush=True)
    if docs and not small:
        rewrite(WARM_HEADING, lines)
    return found


UNSEEN = (  # recipe, form of its DXF, the number that is changed, aim in ms or none
    ("shu-wu", "arcs", "cam.base_radius", "50"),
    ("disc-flat", "arcs", "cam.base_radius", "50"),
    ("disc-roller", "arcs", "cam.base_radius", "50"),
    ("disc-roller", "spline", "cam.base_radius", ""),
    ("as-figure-2a", "arcs", "part.bore", ""),
    ("w-ellipse", "arcs", "part.bore", ""),
    ("groove-stem", "arcs", "cam.base_radius", ""),
    ("conjugate-arm", "arcs", "cam.base_radius", ""),
    ("w-figure-9", "arcs", "cam.arm", ""),
    ("w-figure-9", "spline", "cam.arm", "120"),
    ("valve-lobe", "arcs", "cam.base_radius", "120"),
    ("six-bar", "arcs", "linkage.ground", "150"),
    ("yoke-swing", "arcs", "linkage.ground", "150"),
)
UNSEEN_HEADING = "| recipe | DXF as | aim, ms | ms | times `import numpy` |\n| --- | --- | --- | --- | --- |\n"


def unseen(*, small: bool, docs: bool) -> None:
    """Print a line for each row of `UNSEEN`, the least of nine exports after one that is not counted."""
    gc.set_threshold(COLLECT_AFTER)
    command = [sys.executable, "-c", f"import gc; gc.set_threshold({COLLECT_AFTER}); import numpy"]
    with tempfile.TemporaryDirectory() as folder:
        base = 1e3 * min(spent(command, compiled(Path(folder))) for _ in range(2 if small else 10))
    print(UNSEEN_HEADING, end="")
    rows = []
    for name, form, key, aim in UNSEEN:
        recipe = load(RECIPES / f"{name}.yaml").replace("export.files", [{"dxf": {"as": form}}])
        *within, last = key.split(".")
        number = yaml.safe_load(recipe.text)[within[0]][last]
        each = [recipe.replace(key, number * (1.0 + 1e-6 * k)) for k in range(2 if small else 10)]
        ms = []
        for changed in each:
            start = time.process_time()
            exported(changed)
            ms.append(1e3 * (time.process_time() - start))
        rows.append(f"| {name} | {form} | {aim} | {min(ms[1:]):.0f} | {min(ms[1:]) / base:.1f} |")
        print(rows[-1], flush=True)
    if docs and not small:
        rewrite(UNSEEN_HEADING, rows)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("part", nargs="*", choices=["growth", "scale", "warm", "unseen", []], help="default: all")
    parser.add_argument("--only", default="", metavar="REGEX", help="the rows whose names match")
    parser.add_argument("--small", action="store_true", help="a small size, to see that it works")
    parser.add_argument("--docs", action="store_true", help="write its tables in docs/performance.md")
    parser.add_argument("--row", choices=list(SCALES), help=argparse.SUPPRESS)
    parser.add_argument("--size", type=int, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.row:
        one_size(arguments.row, arguments.size)
        sys.exit()
    if not arguments.part or "growth" in arguments.part:
        rows = [row for row in growing() if re.search(arguments.only, row.name)]
        growth(rows[:: 12 if arguments.small else 1], small=arguments.small, docs=arguments.docs)
    outgrown: list[str] = []
    if not arguments.part or "scale" in arguments.part:
        outgrown = scale(arguments.only, small=arguments.small, docs=arguments.docs)
    if not arguments.part or "warm" in arguments.part:
        warm(arguments.only, small=arguments.small, docs=arguments.docs)
    if not arguments.part or "unseen" in arguments.part:
        unseen(small=arguments.small, docs=arguments.docs)
    if outgrown:
        sys.exit(f"a decade costs more than {MOST:g} times as much a unit as the one before: {', '.join(outgrown)}")
