"""Meshes of a ring in closed form, and STL and 3MF files of them, written with numpy alone."""

from __future__ import annotations

import zipfile
from typing import TYPE_CHECKING

import numpy as np

from kin.contour.arcs import unit

if TYPE_CHECKING:
    from pathlib import Path

RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
N, HEIGHT = 120, 8.0
T = np.arange(N) * 2.0 * np.pi / N
OUTER = (np.array([3.0, 1.0]) + (25.0 + 2.0 * np.cos(3.0 * T))[:, None] * unit(T)).astype(np.float32).astype(float)
BORE = (5.0 * unit(T)).astype(np.float32).astype(float)


def quads(a: np.ndarray, b: np.ndarray, c: np.ndarray, d: np.ndarray) -> np.ndarray:
    return np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])


def ring(outer: np.ndarray = OUTER, inner: np.ndarray = BORE, low: float = 0.0, high: float = HEIGHT) -> np.ndarray:
    """Triangles (4n * 2, 3, 3) of a ring between two loops of as many corners, all facing outward."""

    def at(loop: np.ndarray, z: float) -> tuple[np.ndarray, np.ndarray]:
        here = np.column_stack([loop, np.full(len(loop), z)])
        return here, np.roll(here, -1, axis=0)

    (ob, ob1), (ot, ot1), (ib, ib1), (it, it1) = at(outer, low), at(outer, high), at(inner, low), at(inner, high)
    return np.concatenate(
        [quads(ob, ob1, ot1, ot), quads(ib1, ib, it, it1), quads(ot, ot1, it1, it), quads(ob1, ob, ib, ib1)]
    )


def binary(path: Path, triangles: np.ndarray, header: bytes = b"binary") -> Path:
    records = np.zeros(len(triangles), dtype=RECORD)
    records["corners"] = triangles
    path.write_bytes(header.ljust(80) + len(triangles).to_bytes(4, "little") + records.tobytes())
    return path


def text(path: Path, triangles: np.ndarray) -> Path:
    lines = ["solid cam 7 facet"]
    for triangle in triangles.tolist():
        lines += ["facet normal 0 0 0", "  outer loop"]
        lines += ["    vertex " + " ".join(repr(v) for v in corner) for corner in triangle]
        lines += ["  endloop", "endfacet"]
    path.write_text("\n".join([*lines, "endsolid cam 7"]) + "\n")
    return path


def in_3mf(path: Path, *bodies: np.ndarray, model_name: str = "m.model", place: np.ndarray | None = None) -> Path:
    """Bodies in the order of the build, all in one place (4, 3) on the plate."""
    objects = "".join(_object(k, triangles) for k, triangles in enumerate(bodies, start=1))
    there = "" if place is None else f' transform="{" ".join(map(repr, place.ravel().tolist()))}"'
    items = "".join(f'<item objectid="{k}"{there}/>' for k in range(1, len(bodies) + 1))
    model = (
        '<model unit="millimeter" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources>'
        f"{objects}</resources><build>{items}</build></model>"
    )
    link = (
        '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Id="r" '
        f'Target="/{model_name}" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>'
    )
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("_rels/.rels", link)
        archive.writestr(model_name, model)
    return path


def _object(number: int, triangles: np.ndarray) -> str:
    points, corners = np.unique(triangles.reshape(-1, 3), axis=0, return_inverse=True)
    vertices = "".join(f'<vertex x="{x!r}" y="{y!r}" z="{z!r}"/>' for x, y, z in points.tolist())
    rows = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in corners.reshape(-1, 3).tolist())
    name = "cam" if number == 1 else f"body {number}"
    mesh = f"<mesh><vertices>{vertices}</vertices><triangles>{rows}</triangles></mesh>"
    return f'<object id="{number}" name="{name}">{mesh}</object>'


def triangles_in(path: Path) -> np.ndarray:
    """Triangles (t, 3, 3) of a binary STL."""
    return np.frombuffer(path.read_bytes(), RECORD, offset=84)["corners"].astype(float)


def bumped(
    triangles: np.ndarray, wall: tuple[float, float], span: tuple[float, float], *, angle: float, out: float
) -> np.ndarray:
    """Raise a pyramid by `out`, mm, on the outermost wall of two triangles from z to z in a direction, rad.

    It covers four fifths of the wall's width and the heights `span`; the wall's own corners stay.
    """
    z = triangles[:, :, 2]
    ray, across = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
    middle = (triangles.min(axis=1) + triangles.max(axis=1))[:, :2] / 2.0
    here = np.isclose(z.min(axis=1), wall[0], atol=1e-5) & np.isclose(z.max(axis=1), wall[1], atol=1e-5)
    first = int(np.argmax(np.where(here, middle @ ray - 20.0 * np.abs(middle @ across), -np.inf)))
    pair = np.flatnonzero(here & (np.abs(middle - middle[first]).max(axis=1) < 1e-9))
    assert len(pair) == 2
    a, b = np.unique(triangles[pair][:, :, :2].reshape(-1, 2), axis=0)
    one, two, three = triangles[first]
    facing = np.cross(two - one, three - one)[:2]
    if float(np.array([(b - a)[1], (a - b)[0]]) @ facing) < 0.0:
        a, b = b, a
    low, high = float(z[first].min()), float(z[first].max())
    outer = [(*a, low), (*b, low), (*b, high), (*a, high)]
    left, right = a + 0.1 * (b - a), a + 0.9 * (b - a)
    inner = [(*left, span[0]), (*right, span[0]), (*right, span[1]), (*left, span[1])]
    normal = np.array([(b - a)[1], (a - b)[0]]) / np.hypot(*(b - a))
    tip = (*(0.5 * (a + b) + out * normal), 0.5 * sum(span))
    made = []
    for k in range(4):
        n = (k + 1) % 4
        made += [(outer[k], outer[n], inner[n]), (outer[k], inner[n], inner[k]), (inner[k], inner[n], tip)]
    return np.concatenate([np.delete(triangles, pair, axis=0), np.array(made)])
