"""What a milling program leaves of a sheet, by a reader and a simulation of its own."""

import re

import numpy as np

from support.heavy import shapely


def swept(path, radius, per_arc=60):
    """What is left of a sheet at the bottom, by words taken apart here and discs swept by shapely."""
    at, mode, lines = {"X": 0.0, "Y": 0.0, "Z": 0.0}, 0, []
    unit = 25.4 if "G20" in path.read_text() else 1.0
    for line in path.read_text().splitlines():
        words = {k: float(v) for k, v in re.findall(r"([GXYZIJ])(-?[0-9.]+)", re.sub(r"\(.*\)", "", line))}
        if "G" in words and words["G"] <= 3:
            mode = int(words["G"])
        start = np.array([at["X"], at["Y"]])
        at |= {k: unit * v for k, v in words.items() if k in at}
        end = np.array([at["X"], at["Y"]])
        if mode == 0 or not {"X", "Y"} & words.keys():
            continue
        if mode == 1:
            points = np.stack([start, end])
        else:
            centre = start + unit * np.array([words["I"], words["J"]])
            a, b = np.arctan2(*(start - centre)[::-1]), np.arctan2(*(end - centre)[::-1])
            sweep = (b - a) % (2 * np.pi) if mode == 3 else -((a - b) % (2 * np.pi))
            angle = a + sweep * np.linspace(0.0, 1.0, per_arc)
            points = centre + np.hypot(*(start - centre)) * np.column_stack([np.cos(angle), np.sin(angle)])
        lines.append((at["Z"], points))
    bottom = min(z for z, _ in lines)
    cut = [shapely.LineString(points).buffer(radius, quad_segs=500) for z, points in lines if z == bottom]
    size = 2.0 * max(np.abs(points).max() for _, points in lines)
    left = shapely.difference(shapely.box(-size, -size, size, size), shapely.union_all(cut))
    return bottom, sorted(left.geoms, key=lambda part: part.area)
