# needs: sweep
"""Designs a second on one core, and what the samples are worth: `python benchmarks/sweep.py [command] [speed] ...`.

`--small` takes few designs, to see that it works.

Speed is processor time, the least of several repeats, as a ratio too: to bare kinematics, the plain numpy expressions
for the angles and positions of the same four-bars at as many samples, with nothing found from them. Take one core:
OMP_NUM_THREADS=1, and nothing beside it. `command` takes `camgeo sweep` itself, in a process of its own. `engines`
takes it in one process, in two, and with two workers of a Dask scheduler, and gives the processor time of each.
`screen` holds estimates of cams without a linkage against their exact designs, 1,000 random ones, in some minutes: what
it measured stands in `camgeo.capabilities.sweep.screen`. `accuracy` does so for four-bars.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import math
import os
import subprocess
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from camgeo.cams.flat_faced import breadth_of
from camgeo.capabilities.sweep.figures import Evaluator
from camgeo.capabilities.sweep.keys import Sweep
from camgeo.capabilities.sweep.screen import error_of
from camgeo.capabilities.sweep.single_designs import recipe_with
from camgeo.recipe.limits import Limit
from camgeo.recipe.loading import load_text
from camgeo.synthesis.linkage import mechanism_of
from kin.law.sources.laws import NAMES

if TYPE_CHECKING:
    from collections.abc import Callable

SMALL = "--small" in sys.argv
DESIGNS, ANGLES, REPEATS = (64, 360, 1) if SMALL else (4096, 360, 7)
SOUGHT = 2_000 if SMALL else 100_000
TEXT = """
cam:
  kind: support
  {shape}
  shaft: [18, 8.5]
linkage: {{kind: four-bar, ground: 80, coupler: 70, rocker: 105}}
dwell: {{band: 0.1}}
sweep:
  vary: {{linkage.rocker: {{from: 95, to: 115}}}}
  method: random
  count: 1
  rank: dwell
"""
CAM_2A = load_text(TEXT.format(shape="p: sin(3*t) + 13/15*sin(3*t)*cos(2*t) + 25"), "cam-2a.yaml")
FOURIER = load_text(
    TEXT.format(shape="fourier: {mean: 25, cos: {3: 1, 5: 0.1, 7: 0.1}, sin: {3: 1, 5: 0.1, 7: 0.1}}"), "fourier.yaml"
)
PLACES = {"cam.shaft[0]": (12, 20), "cam.shaft[1]": (3, 12), "linkage.ground": (70, 90), "linkage.rocker": (95, 115)}
HARMONICS = {f"cam.fourier.{kind}.{order}": (-1 / order, 1 / order) for order in (3, 5, 7) for kind in ("cos", "sin")}


def least(*functions: Callable[[], object]) -> list[float]:
    """Least processor seconds of each, taken in turn."""
    best = [math.inf] * len(functions)
    for _ in range(REPEATS):
        for i, function in enumerate(functions):
            start = time.process_time()
            function()
            best[i] = min(best[i], time.process_time() - start)
    return best


def drawn(ranges: dict[str, tuple[float, float]], count: int = DESIGNS) -> np.ndarray:
    low, high = np.array(list(ranges.values()), dtype=float).T
    return np.random.default_rng(1).uniform(low, high, (count, len(ranges)))


def bare(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """theta_3 and theta_4 as one would write them down, for all designs at once."""
    t = np.arange(ANGLES) * 2 * np.pi / ANGLES
    x, y, r1, r4 = (values[:, i : i + 1] for i in range(4))
    p = np.sin(3 * t) + 13 / 15 * np.sin(3 * t) * np.cos(2 * t) + 25
    s = p - x * np.cos(t) - y * np.sin(t)
    s1 = np.roll(p, -ANGLES // 4) + x * np.sin(t) - y * np.cos(t)
    along, across = 50 + 70 - s1, s - 25
    q = along**2 + across**2
    theta_4 = np.arccos((r1**2 + r4**2 - q) / (2 * r1 * r4))
    theta_3 = np.arctan2(r4 * np.sin(theta_4), r1 - r4 * np.cos(theta_4)) - np.arctan2(across, along)
    return theta_3, theta_4


def speed() -> None:
    print(f"\n{DESIGNS} four-bars at {ANGLES} relative angles, designs a second of processor time; target 20,000")
    places, both = drawn(PLACES), drawn({**PLACES, **HARMONICS})
    limits = (Limit("transmission-angle", 39.0), Limit("size", None, 40.0))
    limited = CAM_2A.with_value(replace(CAM_2A.of(Sweep), limits=limits))
    cases = [
        ("dwell alone", CAM_2A, PLACES, places, ("dwell",)),
        ("dwell, with margin, shaft rate, transmission, swing", CAM_2A, PLACES, places, SOME),
        ("all eleven figures", CAM_2A, PLACES, places, None),
        ("all eleven, two limits that few keep", limited, PLACES, places, None),
        ("all eleven, six harmonics vary too", FOURIER, {**PLACES, **HARMONICS}, both, None),
    ]
    base = least(lambda: bare(places))[0]
    print(f"{'bare kinematics, whole arrays':52} {DESIGNS / base:9.0f}")
    for name, recipe, ranges, values, figures in cases:
        evaluator = Evaluator.prepare(recipe, tuple(ranges), figures=figures, samples=ANGLES)
        evaluator.evaluate(values[:64])  # what is found once is found
        seconds, base = least(lambda e=evaluator, v=values: e.evaluate(v), lambda: bare(places))
        print(f"{name:52} {DESIGNS / seconds:9.0f}, {base / seconds:5.2f} times bare kinematics")


SEARCH = """
sweep:
  vary: {VARY}
  method: random
  count: COUNT
  limits: {LIMITS}
  rank: dwell
  keep: 5
"""
RUN = """
import sys, time
from camgeo.cli.main import main
from camgeo.capabilities.sweep import search
spent = []
def timed(*arguments, compute=search.compute, **named):
    begun = time.process_time()
    work = compute(*arguments, **named)
    spent.append(time.process_time() - begun)
    return work
search.compute = timed
status = main(["sweep", sys.argv[1], "--out", sys.argv[2], "--jobs", "1"])
print(status, spent[0], time.process_time(), file=sys.stderr)
"""


LIMITS = "transmission-angle: {at_least: 34}, size: {at_most: 44}"


def search_text(limits: str, count: int) -> str:
    """Recipe that searches `count` four-bars within limits."""
    vary = ", ".join(f"'{path}': {{from: {low}, to: {high}}}" for path, (low, high) in PLACES.items())
    text = CAM_2A.text[: CAM_2A.text.index("sweep:")] + SEARCH.replace("VARY", vary).replace("LIMITS", limits)
    return text.replace("COUNT", str(count))


def command() -> float:
    """The command itself; gives designs a second that it computes, of the usual limits."""
    print(f"\n`camgeo sweep --jobs 1`, {SOUGHT:,} four-bars, 360 angles, designs a second of processor; target 20,000")
    print(f"{'':42}{'computing':>10} {'whole process':>14}")
    found = []
    for limits in (LIMITS, "peak-velocity: {at_most: 22}"):
        text = search_text(limits, SOUGHT)
        best = [math.inf, math.inf]
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "speed.yaml").write_text(text)
            for repeat in range(1 if SMALL else 3):
                call = [sys.executable, "-c", RUN, f"{folder}/speed.yaml", f"{folder}/out-{repeat}"]
                environment = {**os.environ, "OMP_NUM_THREADS": "1"}
                told = subprocess.run(call, env=environment, capture_output=True, text=True, check=True).stderr
                best = [min(a, float(b)) for a, b in zip(best, told.split()[-2:], strict=True)]
        print(f"limits on {limits.split(':')[0]:24} {SOUGHT / best[0]:10.0f} {SOUGHT / best[1]:14.0f}")
        found.append(SOUGHT / best[0])
    return found[0]


class Running:
    """A process with those that it starts: a session of its own, whose processor time is read while it runs."""

    def __init__(self, folder: str, *arguments: str) -> None:
        environment = {**os.environ, "OMP_NUM_THREADS": "1"}
        nowhere = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "start_new_session": True}
        self.process = subprocess.Popen([sys.executable, "-m", *arguments], cwd=folder, env=environment, **nowhere)
        self._seconds: dict[str, float] = {}

    def seconds(self) -> float:
        """Processor seconds of all its processes so far."""
        for path in Path("/proc").glob("[0-9]*/stat"):
            try:
                values = path.read_text().rpartition(")")[2].split()
            except OSError:  # it ended meanwhile
                continue
            if int(values[3]) == self.process.pid:
                ticks = int(values[11]) + int(values[12])
                self._seconds[path.parent.name] = ticks / os.sysconf("SC_CLK_TCK")
        return sum(self._seconds.values())

    def finish(self) -> float:
        """Wait for its end; give its processor seconds."""
        while self.process.poll() is None:
            self.seconds()
            time.sleep(0.02)
        if self.process.returncode:
            raise SystemExit(f"exit status {self.process.returncode}")
        return self.seconds()


def listening(scheduler: Running, file: Path) -> str:
    """Address of a scheduler that writes itself into a file, once it listens; SystemExit where it ended instead."""
    while True:
        if scheduler.process.poll() is not None:
            raise SystemExit(f"the scheduler ended with status {scheduler.process.returncode}")
        with contextlib.suppress(OSError, ValueError):  # it is not there, or not whole
            return str(json.loads(file.read_text())["address"])
        time.sleep(0.1)


def engines() -> None:
    """Processor seconds of one sweep by engine; needs Linux and the extra `dask`."""
    from distributed import Client

    small, large = (500, 2_000) if SMALL else (20_000, 100_000)
    print("\n`camgeo sweep --fresh`, four-bars, 360 angles: processor seconds, the least of several runs")
    print(f"{'designs':>8} {'engine':24} {'command':>8} {'scheduler':>10} {'workers':>14} {'all':>6}")
    with tempfile.TemporaryDirectory() as folder:
        options = ("--host", "127.0.0.1", "--port", "0", "--no-dashboard", "--scheduler-file", "scheduler.json")
        cluster = [Running(folder, "distributed.cli.dask_scheduler", *options)]
        try:
            address = listening(cluster[0], Path(folder) / "scheduler.json")
            options = (address, "--nthreads", "1", "--no-nanny", "--no-dashboard")
            cluster += [Running(folder, "distributed.cli.dask_worker", *options) for _ in range(2)]
            with Client(address) as client:
                client.wait_for_workers(2)
            for count in (small, large):
                (Path(folder) / f"of-{count}.yaml").write_text(search_text(LIMITS, count))
                least: dict[str, list[float]] = {}
                for _ in range(1 if SMALL else 3):
                    for engine in ("--jobs 1", "--jobs 2", f"--scheduler {address}"):
                        before = [each.seconds() for each in cluster]
                        call = ("camgeo", "sweep", f"of-{count}.yaml", "--fresh", *engine.split())
                        spent = [Running(folder, *call).finish()]
                        if "scheduler" in engine:
                            spent += [each.seconds() - b for each, b in zip(cluster, before, strict=True)]
                        least[engine] = min(least.get(engine, [math.inf]), spent, key=sum)
                for engine, spent in least.items():
                    row = f"{spent[1]:10.2f} {spent[2]:6.2f} and {spent[3]:.2f}" if spent[1:] else f"{'':26}"
                    print(f"{count:8,} {engine.split(':')[0]:24} {spent[0]:8.2f} {row} {sum(spent):6.2f}", flush=True)
        finally:
            for each in reversed(cluster):
                each.process.kill()  # a worker that loses its scheduler as it is asked to end may stay
                each.process.wait()


SOME = ("dwell", "margin", "shaft-rate", "transmission-angle", "swing")


def accuracy() -> None:
    print(
        "\ndwell over the shaft and other figures of some four-bars against "
        "kin.numeric.longest_window and kin.linkage.mechanism"
    )
    values = drawn(PLACES, 4 if SMALL else 60)
    wanted: dict[str, list[float]] = {}
    for row in values:
        made = recipe_with(CAM_2A, tuple(PLACES), row)
        lift = made.cam.exact().law
        mechanism = mechanism_of(made, lift, breadth_of(lift)[0])
        told = mechanism.figures()
        one = {
            "dwell": mechanism.dwells(made.dwell.band, "shaft")[0].length,
            "dwell-relative": mechanism.dwells(made.dwell.band, "relative")[0].length,
            "swing": told.swing,
            "peak-velocity": abs(told.velocity.value),
            "peak-acceleration": abs(told.acceleration.value),
            "transmission-angle": told.transmission_least.value,
            "force-angle": told.force_least.value,
        }
        for name, value in one.items():
            wanted.setdefault(name, []).append(math.degrees(value))
    print(f"{'greatest error, deg':20}" + "".join(f"{n:>9} angles" for n in COUNTS))
    found = [Evaluator.prepare(CAM_2A, tuple(PLACES), samples=n).evaluate(values).figures for n in COUNTS]
    for name, exact in wanted.items():
        print(f"{name:20}" + "".join(f"{np.abs(figures[name] - exact).max():16.1e}" for figures in found))
    print(f"{'dwell, median':20}" + "".join(f"{np.median(np.abs(f['dwell'] - wanted['dwell'])):16.1e}" for f in found))


COUNTS = (120, 180, 360, 720, 1440)

MOTION = "[{rise: 20, over: 110, law: LAW}, {dwell: 50}, {to: 0, over: 120, law: LAW}, {dwell: 80}]"
HALF = "[{rise: 8, over: 120, law: LAW}, {dwell: 60}]"
DISC = f"kind: disc, base_radius: 40, motion: {MOTION}, follower: "
SIZE, OFFSET, RISE = {"cam.base_radius": (30, 60)}, {"cam.follower.offset": (-12, 12)}, {"cam.motion[0].rise": (5, 25)}
ROLLER = {"cam.follower.radius": (4, 14)}
ARM = {"cam.follower.arm.pivot": (75, 95)}
LENGTH = {"cam.follower.arm.length": (55, 75)}
CAMS = {
    "roller, stem": (DISC + "{kind: roller, radius: 9, offset: 5}", {**SIZE, **OFFSET, **ROLLER, **RISE}),
    "knife edge, stem": (DISC + "{kind: knife-edge, offset: 5}", {**SIZE, **OFFSET, **RISE}),
    "shoe, stem": (DISC + "{kind: shoe, radius: 20, offset: 5}", {**SIZE, **OFFSET, **ROLLER, **RISE}),
    "flat face, stem": (
        DISC.replace("40", "90") + "{kind: flat, tilt: 5, offset: 5}",
        {"cam.base_radius": (70, 120), "cam.follower.tilt": (-20, 20), **OFFSET, "cam.motion[0].rise": (5, 12)},
    ),
    "roller, arm": (
        DISC + "{kind: roller, radius: 9, arm: {length: 65, pivot: 80}}",
        {**SIZE, **ARM, **LENGTH, **ROLLER, **RISE},
    ),
    "shoe, leading arm": (
        DISC + "{kind: shoe, radius: 9, arm: {length: 65, pivot: 80, side: leading}}",
        {**SIZE, **ARM, **LENGTH, **ROLLER, **RISE},
    ),
    "flat face, arm": (
        DISC + "{kind: flat, arm: {pivot: 90, face: 5}}",
        {**SIZE, **ARM, "cam.follower.arm.face": (-5, 10), "cam.motion[0].rise": (2, 5)},
    ),
    "roller, ring": (
        DISC.replace("kind", "track: internal, kind", 1) + "{kind: roller, radius: 9, offset: 5}",
        {"cam.base_radius": (50, 90), **OFFSET, **ROLLER, "cam.motion[0].rise": (5, 20)},
    ),
    "constant breadth": (
        f"kind: constant-breadth, base_radius: 60, motion: {HALF}",
        {"cam.base_radius": (50, 90), "cam.motion[0].rise": (3, 12)},
    ),
    "support": (
        "kind: support, fourier: {mean: 30, cos: {2: 1, 3: 0.8, 5: 0.2}, sin: {3: 0.7}}, shaft: [3, 2]",
        {f"cam.fourier.{name}": (-1, 1) for name in ("cos.2", "cos.3", "sin.3")}
        | {"cam.fourier.cos.5": (-0.3, 0.3), "cam.shaft[0]": (-5, 15), "cam.shaft[1]": (-5, 5)},
    ),
}
LAWS = ("cycloidal", "modified-sine") if SMALL else tuple(name for name in NAMES if name != "constant-velocity")


def estimates() -> dict[str, float]:
    """Designs a second of cams without a linkage, all figures estimated, by follower."""
    found = {}
    for name, (text, ranges) in CAMS.items():
        recipe = load_text(cam_text(text.replace("LAW", "cycloidal"), ranges), "0.yaml")
        evaluator, many = Evaluator.prepare(recipe, tuple(ranges), screened=True), drawn(ranges)
        evaluator.evaluate(many[:64])
        found[name] = DESIGNS / least(lambda e=evaluator, v=many: e.evaluate(v))[0]
    return found


def screen() -> None:
    each = 2 if SMALL else 100
    print("\ncams without a linkage at 360 angles, all figures: estimates and exact designs a second of processor time")
    worst: dict[str, tuple[float, str]] = {}
    count = 0
    for name, (text, ranges) in CAMS.items():
        laws = LAWS if "LAW" in text else ("",)
        evaluators, spent, exact_spent, looked = [], 0.0, 0.0, 0
        for number, law in enumerate(laws):
            recipe = load_text(cam_text(text.replace("LAW", law), ranges), f"{number}.yaml")
            evaluator = Evaluator.prepare(recipe, tuple(ranges), screened=True)
            if isinstance(evaluator.screen, str):
                raise SystemExit(f"{name}, {law}: {evaluator.screen}")
            evaluators.append(evaluator)
            rows = drawn(ranges, each * (number + 1) // len(laws))[each * number // len(laws) :]
            many = drawn(ranges, 4 * DESIGNS // len(laws) + 1)
            spent += least(lambda e=evaluator, v=many: e.evaluate(v))[0] / len(many)
            start = time.process_time()
            exact = replace(evaluator, screened=False).evaluate(rows)
            exact_spent += time.process_time() - start
            estimates = evaluator.evaluate(rows)
            looked += len(rows)
            count += len(rows)
            for figure, values in exact.figures.items():
                for estimate, value, code in zip(estimates.figures[figure], values, exact.reason, strict=True):
                    error = 0.0 if code else error_of(figure, float(estimate), float(value))
                    worst[figure] = max(worst.get(figure, (0.0, "")), (error, f"{name}, {law}"))
        print(f"{name:20} {len(laws) / spent:9.0f} a second, exact designs {looked / exact_spent:7.1f}")
    print(f"greatest error of an estimate on {count} random designs, in degrees or as a share of the value")
    for figure, (error, where) in worst.items():
        print(f"    {figure:26} {error:9.1e}   {where}")


def cam_text(cam: str, ranges: dict[str, tuple[float, float]]) -> str:
    vary = ", ".join(f"'{path}': {{from: {low}, to: {high}}}" for path, (low, high) in ranges.items())
    part = "part: {thickness: 8, outer: 400}\n" if "internal" in cam else ""
    return f"cam: {{{cam}}}\n{part}sweep: {{vary: {{{vary}}}, method: random, count: 1, rank: size}}\n"


if __name__ == "__main__":
    parts = {"command": command, "engines": engines, "speed": speed, "screen": screen, "accuracy": accuracy}
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("part", nargs="*", help=f"of {', '.join(parts)} (default: all)")
    parser.add_argument("--small", action="store_true", help="a small size, to see that it works")
    chosen = parser.parse_args().part or list(parts)
    if unknown := [name for name in chosen if name not in parts]:
        parser.error(f"no part is called {', '.join(unknown)}; there are: {', '.join(parts)}")
    for name, part in parts.items():
        if name in chosen:
            part()
