# needs: dynamics
"""Error against run time of a follower train's first turn: exact propagation, Radau and RK45, over its stiffness.

    python benchmarks/dynamics.py            prints the table
    python benchmarks/dynamics.py --write    and puts table and picture into docs/dynamics-numerics.md
    python benchmarks/dynamics.py --small    one row of each method, to see that it works

The motion is a cycloidal rise of 100 degrees, a dwell, and the same back; damping ratio 0.05; the train starts at rest.
Errors are the greatest of z over 400 places of the turn, as a share of its greatest, against closed forms at 60 digits.
Both solvers of scipy get the acceleration from a closed form in plain floats, the exact Jacobian, and the breaks.
"""

from __future__ import annotations

import argparse
import math
import os
import platform
import statistics
import sys
import time
from itertools import pairwise
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

from kin.dynamics.drive import drives
from kin.dynamics.oscillator import Oscillator
from kin.dynamics.peaks import ResponseFigure
from kin.dynamics.response import Forcing, ResponsePlaces, response

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "tests"))

from support.dynamics_oracle import Cycloid, Oracle  # noqa: E402

SMALL = "--small" in sys.argv  # a run that only shows that it works
RATIOS = (10.3,) if SMALL else (10.3, 100.3, 1000.3, 10_000.3, 100_000.3)
ZETA = 0.05
TOLERANCES = (1e-3,) if SMALL else (1e-3, 1e-5, 1e-7, 1e-9, 1e-11)
MOST = 400_000  # evaluations, then a solver has given up
PLACES = np.linspace(0.0, 2.0 * math.pi, 401)[1:]
MOTION = Cycloid(math.radians(100.0), 1.0)


class GaveUpError(Exception):
    """Too many evaluations."""


def reference(ratio):
    oracle = Oracle(ratio, ZETA)
    z, v, begin, found = 0, 0, 0.0, []
    for terms, duration in MOTION.pieces():
        end = begin + float(duration)
        last = end > 6.28
        inside = PLACES[(begin < PLACES) & ((end >= PLACES) | last)]
        found += [float(oracle.run(z, v, terms, place - begin)[0]) for place in inside]
        z, v = oracle.run(z, v, terms, duration)
        begin = end
    return np.array(found)


def exact(ratio):
    """Everything from the motion on: series, response, values."""
    (drive,) = drives([MOTION])
    found = response(Oscillator(ZETA * ratio, ratio**2), drive, Forcing())
    starts = found.starts(np.zeros(2), 0, len(found))
    stretch = np.minimum(np.searchsorted(found.drive.knots, PLACES, side="right") - 1, len(found) - 1)
    samples = ResponsePlaces(stretch, PLACES - found.drive.knots[stretch])
    return ResponseFigure.of(found, 1.0, 0.0).at(starts, samples), len(found)


def solved(ratio, method, tolerance):
    decay, square, w = 2.0 * ZETA * ratio, ratio**2, 2.0 * math.pi / MOTION.beta
    size = MOTION.stroke / MOTION.beta * w
    count, state, out = 0, np.zeros(2), []
    knots = [0.0, MOTION.beta, math.pi, math.pi + MOTION.beta, 2.0 * math.pi]
    for i, (low, high) in enumerate(pairwise(knots)):
        force = (-size, 0.0, size, 0.0)[i]

        def slope(t, y, low=low, force=force):
            nonlocal count
            count += 1
            if count > MOST:
                raise GaveUpError
            return [y[1], force * math.sin(w * (t - low)) - decay * y[1] - square * y[0]]

        more = {"jac": np.array([[0.0, 1.0], [-square, -decay]])} if method == "Radau" else {}
        inside = PLACES[(low < PLACES) & (high >= PLACES)]
        wanted = np.append(inside[inside < high], high)
        scale = np.array([size / square, size / ratio])
        run = solve_ivp(
            slope, (low, high), state, method=method, rtol=tolerance, atol=tolerance * scale, t_eval=wanted, **more
        )
        out.append(run.y[0, : len(inside)])
        state = run.y[:, -1]
    return np.concatenate(out), count


def timed(work, repeats):
    seconds = []
    for _ in range(repeats):
        begin = time.perf_counter()
        values, count = work()
        seconds.append(time.perf_counter() - begin)
    return statistics.median(seconds), values, count


def measured():
    rows = []
    for ratio in RATIOS:
        want = reference(ratio)
        scale = np.abs(want).max()
        exact(ratio)
        seconds, values, parts = timed(lambda ratio=ratio: exact(ratio), 9)
        rows.append((ratio, "exact", None, seconds, np.abs(values - want).max() / scale, parts))
        for method in ("Radau", "RK45"):
            for tolerance in TOLERANCES:
                begin = time.perf_counter()
                try:
                    seconds, values, count = timed(lambda r=ratio, m=method, e=tolerance: solved(r, m, e), 1)
                except GaveUpError:
                    rows.append((ratio, method, tolerance, time.perf_counter() - begin, math.nan, MOST))
                    continue
                rows.append((ratio, method, tolerance, seconds, np.abs(values - want).max() / scale, count))
    return rows


def table(rows):
    lines = [
        "| natural frequency, turns of the shaft | method | tolerance | error | time, ms | parts or evaluations |",
        "| --- | --- | --- | --- | --- | --- |",
    ]
    for ratio, method, tolerance, seconds, error, count in rows:
        asked = "" if tolerance is None else f"{tolerance:.0e}"
        reached = "gave up" if math.isnan(error) else f"{error:.1e}"
        lines.append(f"| {ratio:g} | {method} | {asked} | {reached} | {1e3 * seconds:.3g} | {count} |")
    cores = os.cpu_count()
    lines += ["", f"{platform.machine()}, {cores} cores, Python {platform.python_version()}, numpy {np.__version__}."]
    return "\n".join(lines)


def picture(rows):
    import matplotlib as mpl

    mpl.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(1, len(RATIOS), figsize=(13, 3.3), sharey=True, sharex=True, constrained_layout=True)
    colours = {"exact": "#c8442c", "Radau": "#26323f", "RK45": "#7d93ab"}
    for axis, ratio in zip(axes, RATIOS, strict=True):
        for method, colour in colours.items():
            own = [row for row in rows if row[0] == ratio and row[1] == method]
            done = [row for row in own if not math.isnan(row[4])]
            axis.loglog(
                [row[3] for row in done],
                [row[4] for row in done],
                "o" if method == "exact" else ".-",
                color=colour,
                label=method,
            )
            if len(done) < len(own):
                text = f"RK45 gave up at {len(own) - len(done)} of {len(own)} tolerances"
                axis.text(0.05, 0.3, text, transform=axis.transAxes, fontsize=7, color=colour)
        axis.set_title(f"natural frequency {ratio:,.0f} x shaft", fontsize=9)
        axis.set_xlabel("seconds", fontsize=8)
        axis.tick_params(labelsize=7)
        axis.grid(alpha=0.25)
    axes[0].set_ylabel("error of a turn, share of the greatest", fontsize=8)
    axes[0].legend(fontsize=8, frameon=False)
    figure.savefig(ROOT / "docs" / "pictures" / "dynamics-work.png", dpi=90)


def main(*, write: bool):
    rows = measured()
    text = table(rows)
    print(text)
    if write and not SMALL:
        page = ROOT / "docs" / "dynamics-numerics.md"
        before, rest = page.read_text(encoding="utf-8").split("<!-- work -->\n")
        page.write_text(f"{before}<!-- work -->\n{text}\n<!-- end -->{rest.split('<!-- end -->', 1)[1]}", "utf-8")
        picture(rows)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--small", action="store_true", help="a small size, to see that it works")
    parser.add_argument("--write", action="store_true", help="put it into docs/dynamics-numerics.md")
    main(write=parser.parse_args().write)
