"""Meshes as binary PLY in double precision, in mm unless a recipe gives another unit; the format states no unit."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.common.units import INCH
from camgeo.formats.meshes import mesh_format, mesh_making

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from camgeo.files.mesh import Item
    from camgeo.files.precision import Precision

_COMMENT = 200  # characters
_FACE = np.dtype([("count", "u1"), ("corners", "<i4", 3)])


def write_ply(path: Path, items: Sequence[Item], title: str, mm: float, _about: str) -> None:
    """Write the only mesh of `items`, mm, with coordinates in a unit of `mm` mm and the title in a comment.

    Raises OSError where the file cannot be written, ValueError for several meshes.
    """
    (item,) = items
    mesh, numbers = item.mesh, _numbers()
    # doubles are written as they are; that the quotient rounds is counted by `Precision.in_units`
    points = mesh.points if mm == 1.0 else numbers.nearest(mesh.points / mm)
    faces = np.empty(len(mesh.triangles), dtype=_FACE)
    faces["count"], faces["corners"] = 3, mesh.triangles
    comment = f"camgeo: in {'inches' if mm == INCH else 'mm'}, z upwards. {' '.join(title.split())}"
    header = (
        "ply",
        "format binary_little_endian 1.0",
        f"comment {comment[:_COMMENT]}",
        f"element vertex {len(points)}",
        *(f"property double {axis}" for axis in "xyz"),
        f"element face {len(faces)}",
        "property list uchar int vertex_indices",
        "end_header",
        "",
    )
    with path.open("wb") as stream:
        stream.write("\n".join(header).encode("ascii", "replace"))
        stream.write(points.astype("<f8").tobytes())
        stream.write(faces.tobytes())


def _numbers() -> Precision:
    from camgeo.files.precision import DOUBLE

    return DOUBLE


FORMAT = mesh_format("ply", units=False)
MAKING = mesh_making(_numbers, write_ply)
