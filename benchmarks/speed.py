"""Speed as ratios in one run on one machine: `python benchmarks/speed.py [fit] [stl] [judge] [cold] [--small]`.

Each figure is the least of several repeats, taken in turn with what it is compared with, so that a machine whose speed
drifts changes both alike; fits are in processor time. The targets stand beside the figures; nothing here passes or
fails. `--small` takes little of everything, to see that it works: its ratios say nothing.
"""

from __future__ import annotations

import argparse
import math
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from peer import COLLECT_AFTER

from camgeo.files.layer_outline import LayerOutline
from camgeo.files.precision import SINGLE
from camgeo.files.prism import bore_polygon, extruded_mesh
from camgeo.fit.arcs import fit_arcs
from camgeo.fit.pieces import Bound, Polygon
from camgeo.fit.polygon import fit_polygon
from camgeo.fit.spline import fit_spline
from camgeo.formats.stl import write_stl
from camgeo.part.shapes import disc
from camgeo.recipe.loading import load
from camgeo.synthesis.design import designed
from kin.contour.contour import Contour
from kin.follower.follower import follower_of
from kin.law.contacts import Flat, Roller, on_one_arm, opposite
from kin.law.support_function import lift_from_fourier
from kin.law.transmission import from_delta

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.curve.curve import Curve

ROOT = Path(__file__).parents[1]
MICROMETRE = 1e-3
SMALL = "--small" in sys.argv


def least(*functions: Callable[[], object], repeats: int = 7) -> list[float]:
    """Least seconds of each function, the functions taken in turn."""
    best = [float("inf")] * len(functions)
    for _ in range(1 if SMALL else repeats):
        for i, function in enumerate(functions):
            start = time.perf_counter()
            function()
            best[i] = min(best[i], time.perf_counter() - start)
    return best


def median(function: Callable[[], object], repeats: int = 5) -> float:
    """Median processor seconds of a function: what others do on the machine counts for less than in wall time."""
    spent = []
    for _ in range(1 if SMALL else repeats):
        start = time.process_time()
        function()
        spent.append(time.process_time() - start)
    return statistics.median(spent)


def fits() -> None:
    """Recipe object to fitted pieces at 1 micrometre, against sin and cos at as many points."""
    print("\nrecipe object to pieces at 1 um; target: 50 times sin and cos at as many points, or 5 ms if that is more")
    print(f"{'recipe':16} {'form':8} {'pieces':>6} {'ms':>7} {'target ms':>9} {'ratio':>6}")
    for path in sorted((ROOT / "recipes").glob("*.yaml"))[:: 12 if SMALL else 1]:
        recipe = load(path)
        cam = recipe.cam
        if cam.undercut == "trim":
            continue  # its curve runs backwards before it is cut
        print(f"{path.stem:16} {'designed':8} {'':6} {1e3 * median(lambda recipe=recipe: designed(recipe)):7.2f}")
        for name, fit in (("arcs", fit_arcs), ("polygon", fit_polygon), ("spline", fit_spline)):

            def whole(fit: Callable[[Curve, float], object] = fit, cam: object = cam) -> object:
                return fit(cam.exact().surfaces[0].curve, MICROMETRE)

            count = whole().count
            t = np.linspace(0.0, 6.0, count)
            (base,) = least(lambda t=t: (np.sin(t), np.cos(t)))
            seconds, target = median(whole), max(50.0 * base, 5e-3)
            times = f"{1e3 * seconds:7.2f} {1e3 * target:9.2f} {seconds / target:6.2f}"
            print(f"{path.stem:16} {name:8} {count:6} {times}")


def stl() -> None:
    """A ring's STL against numpy writing the same bytes."""
    print("\nSTL of a contour with a bore against numpy writing the same triangles; target: 5 times at 1e4, 10 at 1e5")
    with tempfile.TemporaryDirectory() as folder:
        for count in (1_000,) if SMALL else (1_000, 10_000, 100_000):
            t = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
            r = 25.0 + 2.0 * np.cos(3 * t)
            polygon = Polygon(np.column_stack([r * np.cos(t), r * np.sin(t)]), Bound(0.0, 0.0))
            bore = disc("bore", "BORE", (0.0, 0.0), 5.0)
            outlines = [LayerOutline("CUT", polygon), LayerOutline(bore.layer, bore.outline, bore.circle)]
            path, other = Path(folder) / "ours.stl", Path(folder) / "numpy.stl"

            def ours(outlines: list[LayerOutline] = outlines, path: Path = path) -> None:
                mesh, _ = extruded_mesh(outlines, thickness=8.0, tolerance=1e-3, precision=SINGLE)
                write_stl(path, mesh)

            ours()
            data = np.fromfile(path, dtype=np.uint8)
            corners = np.frombuffer(data[84:].tobytes(), dtype=RECORD)["vertices"].copy()

            def plain(corners: np.ndarray = corners, other: Path = other) -> None:
                records = np.zeros(len(corners), dtype=RECORD)
                edges = corners[:, 1:] - corners[:, :1]
                normal = np.cross(edges[:, 0], edges[:, 1])
                records["normal"] = normal / np.linalg.norm(normal, axis=1)[:, None]
                records["vertices"] = corners
                with other.open("wb") as stream:
                    stream.write(bytes(80) + len(records).to_bytes(4, "little"))
                    records.tofile(stream)

            seconds, base = least(ours, plain)
            bore = len(bore_polygon(10.0, 1e-3)[0])
            print(f"{count:7} + {bore:3} vertices: {1e3 * seconds:8.2f} ms, numpy {1e3 * base:8.2f} ms", end="")
            print(f", ratio {seconds / base:5.2f}")


RECORD = np.dtype([("normal", "<f4", 3), ("vertices", "<f4", (3, 3)), ("attribute", "<u2")])


def judge() -> None:
    """Judging 1e5 pieces at 3600 shaft angles; the contour has been read already."""
    print("\njudging 1e5 pieces at 3600 shaft angles; target: 50 ms for flat faces, 500 ms for double rollers")
    phi = np.linspace(0.0, 2.0 * np.pi, 3600, endpoint=False)
    t = np.linspace(0.0, 2.0 * np.pi, 1_000 if SMALL else 100_000, endpoint=False)
    lift = lift_from_fourier(25.0, {3: 2.0}, {}, (10.0, 5.0))
    p = lift.derivatives(t, 1)
    flat = np.column_stack([p[0] * np.cos(t) - p[1] * np.sin(t), p[0] * np.sin(t) + p[1] * np.cos(t)])
    law = from_delta(2, 1, 60.0, {1: 360.0}, {})
    r = law.pitch(t, 1)
    support = np.column_stack([r[0][0] * np.cos(t) - r[0][1] * np.sin(t), r[0][0] * np.sin(t) + r[0][1] * np.cos(t)])
    booth = from_delta(2, 1, 40.0, {1: 400.0}, {})
    radius, slope = booth.pitch(t, 1)[0]
    u, n = np.column_stack([np.cos(t), np.sin(t)]), np.column_stack([-np.sin(t), np.cos(t)])
    normal = radius[:, None] * u - slope[:, None] * n
    rolled = radius[:, None] * u - 8.0 * normal / np.hypot(normal[:, 0], normal[:, 1])[:, None]
    faces = on_one_arm(2.0 * law.arm, None, Flat(), 0.5 * np.pi, 0.5 * law.alpha)
    rollers = on_one_arm(booth.arm, booth.arm, Roller(8.0), np.pi, booth.alpha)
    for name, follower, points in (
        ("yoke", follower_of(opposite(Flat(), 50.0), lift.law), flat),
        ("flat pair", follower_of(faces, law), support),
        ("double roller", follower_of(rollers, booth), rolled),
    ):

        def contact(follower: object = follower, points: np.ndarray = points) -> None:
            for drive in follower.resting(Contour.from_vertices(points)):
                drive.rows(phi)

        def whole(follower: object = follower, points: np.ndarray = points) -> None:
            follower.judge(Contour.from_vertices(points), phi)

        both = least(contact, whole, repeats=3)
        print(f"{name:14} contact {1e3 * both[0]:7.1f} ms, with true extremes and play {1e3 * both[1]:7.1f} ms")


def cold() -> dict[str, tuple[float, float, float]]:
    """The whole command in a fresh process, as installed, against the imports it cannot do without.

    By the files that are asked for: seconds of it, of the imports, and MB.
    """
    print("\nprocessor time and memory of the whole command in a fresh process, its bytecode compiled as pip does")
    text = (
        "cam: {{kind: constant-breadth, base_radius: 40, motion: [{{rise: 20, over: 120, law: modified-sine}}, "
        "{{dwell: 60}}]}}\n"
        "part: {{thickness: 10, bore: 20}}\nexport: {{tolerance: 0.001, files: [{files}]}}\n"
    )
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        environment = compiled(Path(folder))
        for files, imports in (("stl", "numpy"), ("dxf", "numpy, ezdxf"), ("dxf, stl", "numpy, ezdxf")):
            recipe = Path(folder) / "cam.yaml"
            recipe.write_text(text.format(files=files), encoding="utf-8")
            words = ["export", str(recipe), "--out", str(Path(folder) / "out")]
            command = ["-m", "camgeo", *words]
            best = [math.inf] * 2
            for _ in range(2 if SMALL else 10):  # the first of them compiles
                for i, arguments in enumerate((command, ["-c", f"{AS_OURS}import {imports}"])):
                    best[i] = min(best[i], spent([sys.executable, *arguments], environment))
            (seconds, base), memory = best, held(words, environment)
            print(f"{files:9} {1e3 * seconds:6.0f} ms, import {imports:12} {1e3 * base:6.0f} ms", end="")
            print(f", ratio {seconds / base:5.2f}, {memory:4.0f} MB")
            found[files] = seconds, base, memory
    return found


def compiled(folder: Path) -> dict[str, str]:
    """Variables for a process whose bytecode is kept, in `folder`, and whose linear algebra runs in one thread."""
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONDONTWRITEBYTECODE"}
    return environment | {"PYTHONPYCACHEPREFIX": str(folder), "OPENBLAS_NUM_THREADS": "1"}


def spent(command: list[str], environment: dict[str, str]) -> float:
    """Processor seconds of a process."""
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, env=environment)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise subprocess.CalledProcessError(process.returncode, command)
    return usage.ru_utime + usage.ru_stime


AS_OURS = f"import gc; gc.set_threshold({COLLECT_AFTER}); "
HELD = """
import atexit, sys
def told():
    with open("/proc/self/status", encoding="utf-8") as status:
        print(next(line.split()[1] for line in status if line.startswith("VmHWM")), file=sys.stderr)
atexit.register(told)
from camgeo.__main__ import main
main()
"""


def held(words: list[str], environment: dict[str, str]) -> float:
    """The most memory that the command holds, MB, as Linux has it: what wait4 gives counts this process too."""
    command = [sys.executable, "-c", HELD, *words]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    return int(done.stderr.split()[-1]) / 1024.0


if __name__ == "__main__":
    parts = {"fit": fits, "stl": stl, "judge": judge, "cold": cold}
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("part", nargs="*", help=f"of {', '.join(parts)} (default: all)")
    parser.add_argument("--small", action="store_true", help="a small size, to see that it works")
    chosen = parser.parse_args().part or list(parts)
    if unknown := [name for name in chosen if name not in parts]:
        parser.error(f"no part is called {', '.join(unknown)}; there are: {', '.join(parts)}")
    for name, part in parts.items():
        if name in chosen:
            part()
