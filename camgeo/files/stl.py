"""Meshes as binary STL, always in millimetres."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.files.mesh import Mesh

_HEADER = 80  # bytes; must not begin with "solid", by which readers tell the text form
RECORD = np.dtype([("normal", "<f4", 3), ("vertices", "<f4", (3, 3)), ("attribute", "<u2")])


def write_stl(path: Path, mesh: Mesh, *, about: str = "") -> None:
    """Write a mesh whose points are in single precision already; raises OSError as the file system does."""
    normal = mesh.area_vectors
    records = np.zeros(len(mesh.triangles), dtype=RECORD)
    records["normal"] = normal / np.sqrt(np.sum(normal * normal, axis=1))[:, None]
    # take is four times as fast as points[triangles]
    records["vertices"] = np.take(mesh.points.astype(np.float32), mesh.triangles, axis=0)
    header = f"camgeo: binary STL in mm, z upwards. {about}".encode("ascii", "replace")[:_HEADER].ljust(_HEADER)
    with path.open("wb") as stream:
        stream.write(header)
        stream.write(len(records).to_bytes(4, "little"))
        records.tofile(stream)
