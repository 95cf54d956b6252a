"""Meshes as binary STL, in millimetres unless a recipe gives another unit."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.common.units import INCH
from camgeo.formats.meshes import mesh_format, mesh_making

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from camgeo.files.mesh import Item, Mesh
    from camgeo.files.precision import Precision

_HEADER = 80  # bytes; must not begin with "solid", by which readers tell the text form
RECORD = np.dtype([("normal", "<f4", 3), ("vertices", "<f4", (3, 3)), ("attribute", "<u2")])


def write_stl(path: Path, mesh: Mesh, *, mm: float = 1.0, about: str = "") -> None:
    """Write a mesh, mm, whose points are numbers in single precision of a unit of `mm` mm; `about` ends the header.

    Raises OSError where the file cannot be written.
    """
    normal = mesh.area_vectors
    records = np.zeros(len(mesh.triangles), dtype=RECORD)
    records["normal"] = normal / np.sqrt(np.sum(normal * normal, axis=1))[:, None]
    # take is four times as fast as points[triangles]
    records["vertices"] = np.take((mesh.points / mm).astype(np.float32), mesh.triangles, axis=0)
    title = f"camgeo: binary STL in {'inches' if mm == INCH else 'mm'}, z upwards. {about}"
    header = title.encode("ascii", "replace")[:_HEADER].ljust(_HEADER)
    with path.open("wb") as stream:
        stream.write(header)
        stream.write(len(records).to_bytes(4, "little"))
        stream.write(records.data)


def _write(path: Path, items: Sequence[Item], title: str, mm: float, _about: str) -> None:
    (item,) = items
    write_stl(path, item.mesh, mm=mm, about=title)


def _single() -> Precision:
    from camgeo.files.precision import SINGLE

    return SINGLE


FORMAT = mesh_format("stl", units=False)
MAKING = mesh_making(_single, _write)
