# needs: study
"""Error over run time and size against what a user would pick instead: `python benchmarks/peers.py [--python PYTHON]`.

`--docs` is the one command for a quiet machine: it measures both cams of docs/performance.md at every point count and
writes its table and its picture anew, and the table of warm exports (`benchmarks/growth.py unseen`). `--targets` prints
one table of all aims of speed instead, and what is reached (`benchmarks/targets.py`).

Every peer (`benchmarks/peer.py`) and camgeo make the same cams at a ladder of point counts or tolerances, and every
file is judged by the same judge, `kin.judge.verify`, in the same run. All is processor time. Warm seconds are the least
of repeats within one process, cold seconds those of the whole process, with compiled modules and the garbage
collector's threshold of camgeo's command on either side; install camgeo, and not as `-e`, for what a user sees. PYTHON
runs the peers, and may have CadQuery; a peer that cannot run is reported. Writes docs/pictures/peers.png (matplotlib)
and prints the table.
"""

from __future__ import annotations

import argparse
import gc
import json
import platform
import shutil
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import yaml
from pages import rewrite
from peer import COLLECT_AFTER, PEERS
from speed import compiled, spent

from camgeo.capabilities.study.tolerance_ladder import Rung, climb
from camgeo.common import clock
from camgeo.recipe.loading import load, load_text
from camgeo.synthesis.design import designed
from camgeo.synthesis.intent import intended
from kin.judge.intent import Limits
from kin.judge.verify import verify

ROOT = Path(__file__).parents[1]
SHIPPED = {"yoke": "as-figure-2a", "roller": "w-figure-9"}
MOTION = (
    "[{{rise: {0}, over: 120, law: cycloidal}}, {{dwell: 60}}, "
    "{{return: {0}, over: 120, law: cycloidal}}, {{dwell: 60}}]"
)
DISCS = {
    "disc-roller": ("36", "24", "{kind: roller, radius: 9, offset: 10}"),
    "disc-arm": ("34", "20", "{kind: roller, radius: 8, arm: {length: 65, pivot: 80}}"),
    "disc-flat": ("30", "12", "{kind: flat}"),
}  # base radius, stroke and follower
CAMS = (*SHIPPED, *DISCS)
DOCUMENTED = ("yoke", "disc-roller")
COUNTS = [round(32 * 2 ** (k / 2)) for k in range(25)]  # of which a small run takes the first
PATIENCE = 3.0  # seconds for one file
SMALL = "--small" in sys.argv
REPEATS = 1 if SMALL else 3  # of whole processes
FINE = 1e-6  # mm: no peer is taken farther
LEVELS = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6)  # mm, as judged
OURS = {"arcs": "camgeo arcs", "spline": "camgeo spline", "polyline": "camgeo polyline", "stl": "camgeo STL"}
RIVALS = {".dxf": ("camgeo arcs", "camgeo spline", "camgeo polyline"), ".stl": ("camgeo STL",)}


@dataclass(frozen=True)
class Point:
    """One file: error of its contour (mm) as judged, seconds to make it, warm and cold, pieces, bytes."""

    tool: str
    kind: str
    error: float
    warm: float
    cold: float
    pieces: int
    bytes: int


def of_peer(name: str, cam: str, python: str, folder: Path, thin: int = 1) -> list[Point]:
    """Climb one peer's ladder, each `thin`-th rung, until it is fine enough, too slow, gets no better or fails."""
    recipe = load_text(yaml.safe_dump(bare_recipe(cam)), f"{cam}.yaml")
    intent, limits = intended(recipe, designed(recipe)), Limits(1.0)
    suffix = PEERS[name][1]
    path = folder / f"peer{suffix}"
    found: list[Point] = []
    for count in COUNTS[:1] if SMALL else COUNTS[::thin]:
        command = [python, str(ROOT / "benchmarks" / "peer.py"), name, cam, str(count), str(path), "5"]
        path.unlink(missing_ok=True)
        ran = subprocess.run(command, capture_output=True, text=True, check=False)
        if ran.returncode or not path.is_file():
            print(f"  {name}, {cam}, {count} points: {(ran.stderr.strip().splitlines() or ['no file'])[-1]}")
            if not found:
                return found
            continue
        seconds = json.loads(ran.stdout.splitlines()[-1])
        cold = timed([*command[:-1], "0"], folder)
        verdict = verify(path, intent, 360, limits)
        if verdict.measured_error is None:
            print(f"  {name}, {cam}, {count} points: {verdict.checks[0].detail}")
            continue
        error, pieces = verdict.measured_error, verdict.pieces or 0
        found.append(Point(name, suffix, error, min(seconds[1:]), cold, pieces, path.stat().st_size))
        if error < FINE or seconds[1] > PATIENCE or (len(found) > 8 and error > 0.7 * found[-5].error):
            break
    return found


def bare_recipe(cam: str) -> dict[str, object]:
    """The cam and its thickness alone."""
    if cam in DISCS:
        base, stroke, follower = DISCS[cam]
        text = f"{{kind: disc, base_radius: {base}, follower: {follower}, motion: {MOTION.format(stroke)}}}"
        return {"cam": yaml.safe_load(text), "part": {"thickness": 8}}
    whole = yaml.safe_load((ROOT / "recipes" / f"{SHIPPED[cam]}.yaml").read_text(encoding="utf-8"))
    return {"cam": whole["cam"], "part": {"thickness": whole["part"]["thickness"]}}


def timed(command: list[str], folder: Path) -> float:
    """Least processor time of a process, its modules compiled in `folder`; one that fails ends all."""
    return min(spent(command, compiled(folder)) for _ in range(1 + REPEATS))  # the first compiles


def of_ours(cam: str, folder: Path) -> list[Point]:
    """Every form of ours at every tolerance; judging is not counted, as no peer does it."""
    bare = bare_recipe(cam)
    own = folder / "own.yaml"
    own.write_text(yaml.safe_dump(bare), encoding="utf-8")
    recipe = load(own)
    found = []
    for form, tool in OURS.items():
        for rung in climb(recipe, designed(recipe), form, folder, patience=PATIENCE):
            if not isinstance(rung, Rung) or rung.geometry_error is None or rung.tolerance < 0.99 * FINE:
                break
            warm = rung.stages["fit"] + rung.stages["write"] + design_seconds(recipe)
            kind = "stl" if form == "stl" else "dxf"
            asked = {kind: {} if form == "stl" else {"as": form}}
            export = {"tolerance": rung.tolerance, "files": [asked]}
            own.write_text(yaml.safe_dump(bare | {"export": export}), encoding="utf-8")
            cold = timed([sys.executable, "-m", "camgeo", "export", str(own), "--out", str(folder / "out")], folder)
            size = (folder / "out" / "own" / f"own.{kind}").stat().st_size
            found.append(Point(tool, f".{kind}", rung.geometry_error, warm, cold, rung.pieces, size))
            if SMALL:
                break
    return found


def design_seconds(recipe: object) -> float:
    """Least seconds to make the exact curve with its checks, which every export begins with."""
    seconds = []
    for _ in range(9):
        start = time.process_time()
        designed(recipe)
        seconds.append(time.process_time() - start)
    return min(seconds)


def at_level(points: list[Point], tool: str, level: float) -> dict[str, float] | None:
    """Least cost of any file of a tool that is at least as good as a level; None if it makes none."""
    good = [point for point in points if point.tool == tool and point.error <= level * 1.000001]
    if not good:
        return None
    return {key: min(getattr(point, key) for point in good) for key in ("warm", "cold", "pieces", "bytes")}


def rows(cam: str, points: list[Point]) -> str:
    """What each tool needs for files within each error: milliseconds warm and of the whole process, pieces, KB."""
    lines = []
    for tool in (*OURS.values(), *PEERS):
        costs = [at_level(points, tool, level) for level in LEVELS]
        cells = [
            f"{1e3 * cost['warm']:.3g}, {1e3 * cost['cold']:.3g}, {cost['pieces']}, {cost['bytes'] / 1e3:.3g}"
            if cost
            else ""
            for cost in costs
        ]
        lines.append(f"| {cam} | {tool} | {' | '.join(cells)} |")
    return "\n".join(lines)


def heading() -> str:
    """First two lines of the table."""
    levels = "".join(f" {level:.0e} mm |".replace("e-0", "e-") for level in LEVELS)
    return f"| cam | tool |{levels}\n| --- | --- |{' --- |' * len(LEVELS)}\n"


def picture(found: dict[str, list[Point]], path: Path) -> None:
    """Error over warm time and over that of the whole process, ours drawn solid."""
    import matplotlib as mpl

    mpl.use("Agg")
    import matplotlib.pyplot as plt

    figure, rows = plt.subplots(len(found), 2, figsize=(11, 4.3 * len(found)), layout="constrained", sharey=True)
    colours = [
        "#0072B2",
        "#D55E00",
        "#009E73",
        "#CC79A7",
        "#E69F00",
        "#56B4E9",
        "#000000",
        "#999999",
        "#8B4513",
        "#6A3D9A",
        "#A0A000",
    ]
    tools = [*OURS.values(), *PEERS]
    for row, (cam, points) in zip(np.atleast_2d(rows), found.items(), strict=True):
        for axes, (key, label) in zip(row, (("warm", "warm, ms"), ("cold", "whole process, ms")), strict=True):
            for i, tool in enumerate(tools):
                mine = [point for point in points if point.tool == tool]
                if not mine:
                    continue
                own = tool in OURS.values()
                style = {"color": colours[i], "linewidth": 1.8 if own else 0.9}
                axes.plot(
                    [1e3 * getattr(point, key) for point in mine],
                    [point.error for point in mine],
                    "-o" if own else "--x",
                    markersize=4,
                    label=tool,
                    **style,
                )
            axes.set_xscale("log")
            axes.set_yscale("log")
            axes.set_ylim(0.5 * LEVELS[-1], 2.0 * LEVELS[0])
            axes.set_xlabel(f"{cam}: {label}")
            axes.grid(visible=True, color="#e0e0e0")
        row[0].set_ylabel("error of the file, mm")
    named: dict[str, object] = {}
    for axes in np.ravel(rows):
        handles, labels = axes.get_legend_handles_labels()
        named |= dict(zip(labels, handles, strict=True))
    figure.legend(list(named.values()), list(named), loc="outside lower center", ncols=5, frameon=False)
    figure.savefig(path, dpi=90)


def main() -> None:
    clock.time = SimpleNamespace(perf_counter=time.process_time)  # the stages of a run, too, in processor time
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--python", default=sys.executable, help="interpreter that runs the peers")
    parser.add_argument("--picture", type=Path, default=ROOT / "docs" / "pictures" / "peers.png")
    parser.add_argument("--cam", action="append", choices=tuple(CAMS))
    parser.add_argument(
        "--small", action="store_true", help="one file of each kind and no picture, to see that it works"
    )
    parser.add_argument("--peer", action="append", choices=tuple(PEERS), help="only this one; repeatable")
    parser.add_argument("--thin", type=int, default=1, help="only every so many point counts")
    parser.add_argument("--docs", action="store_true", help="write the table of docs/performance.md and its picture")
    parser.add_argument("--targets", action="store_true", help="the table of aims, with the first cam of these alone")
    parser.add_argument("--tests", action="store_true", help="the quick suite's row in it too, which takes minutes")
    arguments = parser.parse_args()
    gc.set_threshold(COLLECT_AFTER)
    print(f"{platform.machine()}, Python {platform.python_version()}, numpy {np.__version__}")
    print("\nms warm, ms of the whole process, pieces, KB")
    print(heading(), end="")
    found = {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for cam in arguments.cam or (DOCUMENTED if arguments.docs else CAMS):
            points = of_ours(cam, folder)
            for peer in arguments.peer or PEERS:
                if peer == "OpenSCAD" and shutil.which("openscad") is None:
                    print("  OpenSCAD is not installed")
                    continue
                points += of_peer(peer, cam, arguments.python, folder, arguments.thin)
            found[cam] = points
            print(rows(cam, points), flush=True)
            if arguments.targets:
                break
        if arguments.targets:
            from targets import table

            line = [sys.executable, "-m", "pytest", "-q", "-n", "2"] if arguments.tests else []
            table(lambda tool, level: (at_level(points, tool, level) or {}).get("cold"), line)
            return
        picture(found, folder / "peers.png" if SMALL else arguments.picture)
        if arguments.docs and not SMALL:
            rewrite(heading(), [rows(cam, points) for cam, points in found.items()])
            subprocess.run([sys.executable, str(ROOT / "benchmarks" / "growth.py"), "unseen", "--docs"], check=True)


if __name__ == "__main__":
    main()
