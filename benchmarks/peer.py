"""One peer at work: the same cam by what a user would pick instead. Nothing of camgeo is imported here.

    python benchmarks/peer.py PEER CAM COUNT FILE REPEATS     writes FILE, prints seconds of warm repeats as JSON

CAM is `yoke` (AS Figure 2a about the shaft (16, 7.5), a closed formula), `roller` (Wunderlich's Figure 9: the
parallel of a pitch curve at the roller radius), or a disc cam with cycloidal rise and return, 120 degrees each, and two
dwells: `disc-roller` on a stem set off, `disc-arm`, both by their pitch curves, `disc-flat`, a closed formula. COUNT is
the number of points of the curve that the peer is given. Each peer does with its own means what a careful user of it
would: exact points, its own offset, its own writer.
"""

from __future__ import annotations

import argparse
import gc
import json
import math
import resource
import subprocess
import time
from pathlib import Path

import numpy as np

COLLECT_AFTER = 300_000  # new objects: Python's collector of garbage waits as long in camgeo's own command
THICKNESS = 8.0
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


def cycloidal(stroke: float, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Shaft angles, displacement and its slope: a third of a turn up, a sixth at rest, a third down."""
    turn = np.linspace(0.0, 2.0 * math.pi, count, endpoint=False)
    third = 2.0 * math.pi / 3.0
    up, down = np.clip(turn / third, 0.0, 1.0), np.clip(turn / third - 1.5, 0.0, 1.0)
    rise = [u - np.sin(2.0 * math.pi * u) / (2.0 * math.pi) for u in (up, down)]
    slope = [(1.0 - np.cos(2.0 * math.pi * u)) / third for u in (up, down)]
    return turn, stroke * (rise[0] - rise[1]), stroke * (slope[0] - slope[1])


def stem(count: int) -> np.ndarray:
    """Pitch curve of a roller of 9 on a stem set off by 10, base radius 36, 24 high."""
    turn, s, _ = cycloidal(24.0, count)
    place = np.exp(1j * turn) * (math.sqrt(45.0**2 - 10.0**2) + s + 10j)
    return np.column_stack([place.real, place.imag])


def arm(count: int) -> np.ndarray:
    """Pitch curve of a roller of 8 on a trailing arm of 65, its pivot at 80, base radius 34, 20 degrees high."""
    turn, s, _ = cycloidal(math.radians(20.0), count)
    lean = math.acos((80.0**2 + 65.0**2 - 42.0**2) / (2.0 * 80.0 * 65.0)) + s
    place = np.exp(1j * turn) * (80.0 - 65.0 * np.exp(1j * lean))
    return np.column_stack([place.real, place.imag])


def tappet(count: int) -> np.ndarray:
    """Contour under a flat face, base radius 30, 12 high."""
    turn, s, slope = cycloidal(12.0, count)
    place = np.exp(1j * turn) * (30.0 + s + 1j * slope)
    return np.column_stack([place.real, place.imag])


CURVES = {  # of each cam, and the radius of its roller, 0 where the curve is the contour
    "yoke": (yoke, 0.0),
    "roller": (pitch, 8.0),
    "disc-roller": (stem, 9.0),
    "disc-arm": (arm, 8.0),
    "disc-flat": (tappet, 0.0),
}


def contour(cam: str, count: int) -> np.ndarray:
    """Points of the cam; the parallel of the pitch curve by shapely's buffer."""
    curve, roller = CURVES[cam]
    if not roller:
        return curve(count)
    from shapely import Polygon

    inside = Polygon(curve(count)).buffer(-roller, quad_segs=max(8, count // 8))
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


def by_hand(cam: str, count: int, path: Path) -> None:
    """numpy alone: the polygon extruded, its lids as fans about the middle, written as a binary STL."""
    points = contour(cam, count)
    after, middle = np.roll(points, -1, axis=0), np.broadcast_to(points.mean(axis=0), points.shape)

    def at(flat: np.ndarray, z: float) -> np.ndarray:
        return np.column_stack([flat, np.full(len(flat), z)])

    low, high, low_after, high_after = at(points, 0.0), at(points, THICKNESS), at(after, 0.0), at(after, THICKNESS)
    corners = np.concatenate(
        [
            np.stack(each, axis=1)
            for each in (
                (low, low_after, high_after),
                (low, high_after, high),
                (at(middle, THICKNESS), high, high_after),
                (at(middle, 0.0), low_after, low),
            )
        ]
    )
    records = np.zeros(len(corners), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    records["normal"] = normal / np.linalg.norm(normal, axis=1)[:, None]
    records["corners"] = corners
    path.write_bytes(bytes(80) + len(records).to_bytes(4, "little") + records.tobytes())


def spline(cam: str, count: int, path: Path) -> None:
    """scipy's periodic cubic spline through exact points as a DXF SPLINE; the offset by the spline's own normals."""
    from scipy.interpolate import CubicSpline

    t = np.linspace(0.0, 2.0 * math.pi, count + 1)

    def closed(points: np.ndarray) -> CubicSpline:
        return CubicSpline(t, np.vstack([points, points[:1]]), bc_type="periodic")

    points, roller = CURVES[cam][0](count), CURVES[cam][1]
    curve = closed(points)
    if roller:
        tangent = curve(t[:-1], 1)
        normal = np.column_stack([tangent[:, 1], -tangent[:, 0]]) / np.hypot(*tangent.T)[:, None]
        curve = closed(points - roller * normal)
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

    curve, roller = CURVES[cam]
    wire = cq.Workplane("XY").spline([tuple(map(float, point)) for point in curve(count)], periodic=True).close()
    if roller:
        wire = wire.offset2D(-roller)
    if path.suffix == ".dxf":
        cq.exporters.exportDXF(wire, str(path))
    else:
        tolerance = 50.0 / count**2
        solid = wire.extrude(THICKNESS)
        cq.exporters.export(solid, str(path), tolerance=tolerance, angularTolerance=2.0 * math.pi / count)


def openscad(cam: str, count: int, path: Path) -> None:
    """OpenSCAD: the points as a polygon, its own offset, linear_extrude, binary STL."""
    curve, roller = CURVES[cam]
    shape = f"polygon({json.dumps(curve(count).tolist())});"
    if roller:
        shape = f"offset(r=-{roller}, $fn={max(32, count // 2)}) {shape}"
    source = path.with_suffix(".scad")
    source.write_text(f"linear_extrude({THICKNESS}) {shape}\n")
    command = ["openscad", "-q", "-o", str(path), "--export-format", "binstl", str(source)]
    subprocess.run(command, check=True, capture_output=True)


PEERS = {
    "numpy": (by_hand, ".stl"),
    "numpy + shapely + ezdxf": (polyline, ".dxf"),
    "shapely + trimesh": (extruded, ".stl"),
    "scipy spline + ezdxf": (spline, ".dxf"),
    "CadQuery DXF": (cadquery, ".dxf"),
    "CadQuery STL": (cadquery, ".stl"),
    "OpenSCAD": (openscad, ".stl"),
}


def spent() -> float:
    """Processor seconds so far, of child processes too: of a busy machine's wall time much is others'."""
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.process_time() + children.ru_utime + children.ru_stime


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("peer", choices=PEERS)
    parser.add_argument("cam", choices=CURVES)
    parser.add_argument("count", type=int)
    parser.add_argument("file", type=Path)
    parser.add_argument("repeats", type=int)
    given = parser.parse_args()
    gc.set_threshold(COLLECT_AFTER)
    work, _ = PEERS[given.peer]
    seconds = []
    for _ in range(1 + given.repeats):
        start = spent()
        work(given.cam, given.count, given.file)
        seconds.append(spent() - start)
        if len(seconds) > 1 and seconds[-1] > LONG:  # the first also imports
            break
    print(json.dumps(seconds))


if __name__ == "__main__":
    main()
