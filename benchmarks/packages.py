"""What cam packages of PyPI make of a constant-breadth law: `python benchmarks/packages.py [--python PYTHON]`.

A cycloidal rise of 20 mm in 120 degrees, 60 of dwell, the same back, base radius 40 mm: a yoke of 100 mm fits the right
cam. `mechanism` and `pylinkage` give points of a profile; those are written as a polyline and judged as any file is.
PYTHON runs them. Run without it, in a Python that has neither, they are listed as missing.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

from camgeo.output import pipeline
from camgeo.recipe.loading import read
from camgeo.synthesis.design import designed
from camgeo.synthesis.intent import intended
from kin.judge.intent import Limits
from kin.judge.verify import verify

RECIPE = b"""\
cam:
  kind: constant-breadth
  base_radius: 40
  motion: [{rise: 20, over: 120, law: cycloidal}, {dwell: 60}]
export: {tolerance: 0.001, files: [dxf]}
"""
MECHANISM = """
import ezdxf, numpy as np
from mechanism import Cam
motion = [("Rise", 20, 120), ("Dwell", 60), ("Fall", 20, 120), ("Dwell", 60)]
cam = Cam(motion=motion, degrees=True, omega=1.0, h=0.001)
x, y = cam.cycloidal.get_profile(40, cam.thetas)
points = np.column_stack([x, y])[:-1]
"""
PYLINKAGE = """
import ezdxf, math, numpy as np
from pylinkage.cam import CycloidalMotionLaw, FunctionProfile
profile = FunctionProfile(motion_law=CycloidalMotionLaw(), base_radius=40.0, total_lift=20.0, rise_start=0.0,
    rise_end=math.radians(120), dwell_high_end=math.radians(180), fall_end=math.radians(300))
t = np.linspace(0.0, 2 * math.pi, 6283, endpoint=False)
r = np.array([profile.evaluate(float(angle)) for angle in t])
points = np.column_stack([r * np.cos(t), r * np.sin(t)])
"""
WRITE = """
document = ezdxf.new("R2010", units=4)
document.modelspace().add_lwpolyline(points, close=True)
document.saveas("PATH")
"""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--python", default=sys.executable, help="interpreter that has the packages")
    parser.add_argument("--small", action="store_true", help="fewer shaft angles, to see that it works")
    arguments = parser.parse_args()
    python, angles = arguments.python, 90 if arguments.small else 720
    recipe = read(RECIPE, Path("law.yaml"))
    design = designed(recipe)
    print("| package | contour off by, mm | lift off by, mm | breadth from, to, mm |")
    print("| --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory() as folder:
        pipeline.export(recipe, Path(folder))
        paths = {"camgeo": Path(folder) / "law" / "law.dxf"}
        for name, script in (("mechanism", MECHANISM), ("pylinkage", PYLINKAGE)):
            paths[name] = Path(folder) / f"{name}.dxf"
            command = [python, "-c", script + WRITE.replace("PATH", str(paths[name]))]
            ran = subprocess.run(command, capture_output=True, text=True, check=False)
            if ran.returncode:
                print(f"| {name} | {(ran.stderr.strip().splitlines() or ['failed'])[-1]} | | |")
                del paths[name]
        for name, path in paths.items():
            found = verify(path, intended(recipe, design), angles, Limits(1.0))
            motion, play = found.motion, found.play
            lift = "no contact" if motion is None else f"{motion.max:.4g}"
            breadth = "" if play is None else f"{100 - play.most:.5f} to {100 - play.least:.5f}"
            print(f"| {name} | {found.measured_error:.4g} | {lift} | {breadth} |")


if __name__ == "__main__":
    main()
