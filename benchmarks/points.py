"""What judging measured points costs: `python benchmarks/points.py [--small]`.

Processor seconds without imports, and the greatest resident memory, for 1,000, 100,000 and 1,000,000 points of a disc
cam with a roller; one process each, on one thread. What is aimed at: 0.3 s, 3 s, and 60 s within 1 GB.
"""

from __future__ import annotations

import tempfile
import time
from pathlib import Path

from counted import peak_mb, table

COUNTS = (1_000, 100_000, 1_000_000)
RECIPE = """
cam:
  kind: disc
  base_radius: 36
  follower: {kind: roller, radius: 9, offset: 10}
  motion:
    - {rise: 24, over: 100, law: modified-sine}
    - {dwell: 40}
    - {return: 24, over: 140, law: modified-trapezoid}
    - {dwell: 80}
part: {bore: 12}
made: {profile: 0.05}
"""


def judge(count: int) -> list[str]:
    """Row of the table for a number of points: twice judged, since the first call imports."""
    import numpy as np

    import camgeo
    from camgeo.recipe.loading import load
    from camgeo.synthesis.design import designed
    from camgeo.synthesis.intent import intents

    with tempfile.TemporaryDirectory() as folder:
        recipe, few, file = (Path(folder) / name for name in ("cam.yaml", "few.csv", "points.csv"))
        recipe.write_text(RECIPE)
        gauge = intents(cam := load(recipe), designed(cam))[0].surfaces[0].gauge
        for path, size in ((few, 360), (file, count)):
            t = np.arange(size) * (2.0 * np.pi / size)
            frame = gauge.envelope.frames(t)
            e = 0.01 * np.cos(9.0 * t) + 0.002 * np.random.default_rng(1).normal(size=size)
            places = frame.points + e[:, None] * frame.normals
            np.savetxt(path, places, fmt="%.6f", delimiter=",", header="x_mm,y_mm", comments="")
        camgeo.verify(recipe, few)
        begin = time.process_time()
        made = dict(camgeo.verify(recipe, file))["made"]
        spent = time.process_time() - begin
    return [str(made["surfaces"][0]["spans"]), f"{spent:.2f}", peak_mb()]


if __name__ == "__main__":
    table(str(__doc__), ("points", "spans", "processor s", "greatest MB"), judge, COUNTS, 200)
