"""One peer at work: the same cam by what a user would pick instead. Nothing of camgeo is imported here.

    python benchmarks/peer.py PEER CAM COUNT FILE REPEATS     writes FILE, prints seconds of warm repeats as JSON

CAM is `yoke` (AS Figure 2a about the shaft (16, 7.5), a closed formula) or `roller` (Wunderlich's Figure 9: the
parallel of a pitch curve at the roller radius). COUNT is the number of points of the curve that the peer is given. Each
peer does with its own means what a careful user of it would: exact points, its own offset, its own writer.
"""

from __future__ import annotations

import argparse
import json
import math
import subprocess
import time
from pathlib import Path

import numpy as np

THICKNESS = 8.0
ROLLER = 8.0
LONG = 1.0  # seconds; what takes longer is not repeated


def yoke(count: int) -> np.ndarray:
    """Points of p = sin 3t + 13/15 sin 3t cos 2t + 25 about (16, 7.5), (count, 2)."""
    t = np.linspace(0.0, 2.0 * math.pi, count, endpoint=False)
    p = np.sin(3 * t) * (1 + 13 / 15 * np.cos(2 * t)) + 25 - 16 * np.cos(t) - 7.5 * np.sin(t)
    slope = 3 * np.cos(3 * t) * (1 + 13 / 15 * np.cos(2 * t)) - 26 / 15 * np.sin(3 * t) * np.sin(2 * t)
    slope += 16 * np.sin(t) - 7.5 * np.cos(t)
    c, s = np.cos(t), np.sin(t)
    return np.column_stack([p * c - slope * s, p * s + slope * c])


def pitch(count: int) -> np.ndarray:
    """Points of Wunderlich's pitch curve of Figure 9: lambda/mu = 4/3, l = 60, D = 625 cos 4t, (count, 2)."""
    t = np.linspace(0.0, 2.0 * math.pi, count, endpoint=False)
    alpha, l = 3 * math.pi / 4, 60.0
    d = 625 * np.cos(4 * t)
    a, b = math.cos(math.pi / 4 - alpha / 2), math.sin(math.pi / 4 - alpha / 2)
    r = math.sqrt(2) * (a * np.sqrt(l * l + d) + b * np.sqrt(l * l - d))
    return np.column_stack([r * np.cos(t), r * np.sin(t)])


def contour(cam: str, count: int) -> np.ndarray:
    """Points of the cam; the parallel of the pitch curve by shapely's buffer."""
    if cam == "yoke":
        return yoke(count)
    from shapely import Polygon

    inside = Polygon(pitch(count)).buffer(-ROLLER, quad_segs=max(8, count // 8))
    return np.array(inside.exterior.coords)[:-1]


def dxf_of(path: Path, draw) -> None:
    import ezdxf

    document = ezdxf.new("R2010", units=4)
    draw(document.modelspace())
    document.saveas(path)


def polyline(cam: str, count: int, path: Path) -> None:
    """Points at uniform parameters, shapely's offset, an LWPOLYLINE by ezdxf."""
    points = contour(cam, count)
    dxf_of(path, lambda space: space.add_lwpolyline(points, close=True))


def extruded(cam: str, count: int, path: Path) -> None:
    """The same polygon extruded by trimesh."""
    import trimesh
    from shapely import Polygon

    trimesh.creation.extrude_polygon(Polygon(contour(cam, count)), THICKNESS).export(path)


def spline(cam: str, count: int, path: Path) -> None:
    """scipy's periodic cubic spline through exact points as a DXF SPLINE; the offset by the spline's own normals."""
    from scipy.interpolate import CubicSpline

    t = np.linspace(0.0, 2.0 * math.pi, count + 1)

    def closed(points: np.ndarray) -> CubicSpline:
        return CubicSpline(t, np.vstack([points, points[:1]]), bc_type="periodic")

    if cam == "yoke":
        curve = closed(yoke(count))
    else:
        middle = closed(pitch(count))
        tangent = middle(t[:-1], 1)
        normal = np.column_stack([tangent[:, 1], -tangent[:, 0]]) / np.hypot(*tangent.T)[:, None]
        curve = closed(pitch(count) - ROLLER * normal)
    h = np.diff(curve.x)[:, None]
    _, c2, c1, c0 = curve.c
    # Bezier points of each span: the first, the two handles; the spline is C1 with double knots
    first, near = c0, c0 + h * c1 / 3
    far = c0 + h * (2 * c1 + h * c2) / 3
    points = np.vstack([first[:1], np.stack([near, far], axis=1).reshape(-1, 2), first[:1]])
    knots = np.concatenate([[t[0]] * 4, np.repeat(t[1:-1], 2), [t[-1]] * 4])
    dxf_of(path, lambda space: space.add_open_spline(points, degree=3, knots=knots))


def cadquery(cam: str, count: int, path: Path) -> None:
    """CadQuery: spline through the points, offset2D, extrude, its own exporters."""
    import cadquery as cq

    points = [tuple(map(float, point)) for point in (yoke(count) if cam == "yoke" else pitch(count))]
    wire = cq.Workplane("XY").spline(points, periodic=True).close()
    if cam == "roller":
        wire = wire.offset2D(-ROLLER)
    if path.suffix == ".dxf":
        cq.exporters.exportDXF(wire, str(path))
    else:
        tolerance = 50.0 / count**2
        solid = wire.extrude(THICKNESS)
        cq.exporters.export(solid, str(path), tolerance=tolerance, angularTolerance=2.0 * math.pi / count)


def openscad(cam: str, count: int, path: Path) -> None:
    """OpenSCAD: the points as a polygon, its own offset, linear_extrude, binary STL."""
    points = yoke(count) if cam == "yoke" else pitch(count)
    shape = f"polygon({json.dumps(points.tolist())});"
    if cam == "roller":
        shape = f"offset(r=-{ROLLER}, $fn={max(32, count // 2)}) {shape}"
    source = path.with_suffix(".scad")
    source.write_text(f"linear_extrude({THICKNESS}) {shape}\n")
    command = ["openscad", "-q", "-o", str(path), "--export-format", "binstl", str(source)]
    subprocess.run(command, check=True, capture_output=True)


PEERS = {
    "numpy + shapely + ezdxf": (polyline, ".dxf"),
    "shapely + trimesh": (extruded, ".stl"),
    "scipy spline + ezdxf": (spline, ".dxf"),
    "CadQuery DXF": (cadquery, ".dxf"),
    "CadQuery STL": (cadquery, ".stl"),
    "OpenSCAD": (openscad, ".stl"),
}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("peer", choices=PEERS)
    parser.add_argument("cam", choices=("yoke", "roller"))
    parser.add_argument("count", type=int)
    parser.add_argument("file", type=Path)
    parser.add_argument("repeats", type=int)
    given = parser.parse_args()
    work, _ = PEERS[given.peer]
    seconds = []
    for _ in range(1 + given.repeats):
        start = time.perf_counter()
        work(given.cam, given.count, given.file)
        seconds.append(time.perf_counter() - start)
        if len(seconds) > 1 and seconds[-1] > LONG:  # the first also imports
            break
    print(json.dumps(seconds))


if __name__ == "__main__":
    main()
