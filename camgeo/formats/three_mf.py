"""Meshes as 3MF, the zip archive that slicers read; by the core specification 1.3 alone.

Each body is a named object, and an item of the build gives its place. Coordinates are the shortest decimals that give
back the doubles. The archive has no dates and a fixed order, so that the same meshes give the same bytes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.common.units import INCH
from camgeo.files.markup import number, one_line
from camgeo.formats.meshes import EDGES, OPTIONS, mesh_making
from camgeo.registry.formats import Format

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from pathlib import Path

    from camgeo.files.mesh import Item, Mesh
    from camgeo.files.precision import Precision

_CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
_XML = '<?xml version="1.0" encoding="UTF-8"?>\n'
_MODEL = "3D/3dmodel.model"
_TYPES = (
    f'{_XML}<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">\n'
    '<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>\n'
    '<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>\n</Types>\n'
)
_LINKS = (
    f'{_XML}<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">\n'
    f'<Relationship Id="model" Target="/{_MODEL}" '
    'Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>\n</Relationships>\n'
)
_EPOCH = (1980, 1, 1, 0, 0, 0)  # the first moment that a zip archive can name
_LEVEL = 6
_UNITS = {1.0: "millimeter", INCH: "inch"}


def write_3mf(path: Path, items: Sequence[Item], *, title: str, mm: float = 1.0, about: str = "") -> None:
    """Write meshes, mm, each under its name and in its place, in a unit of `mm` mm, 1 or 25.4.

    Raises KeyError for another unit, OSError where the file cannot be written.
    """
    from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

    lines = [
        f'{_XML}<model unit="{_UNITS[mm]}" xml:lang="en-US" xmlns="{_CORE}">',
        f'<metadata name="Title">{one_line(title)}</metadata>',
        *([f'<metadata name="Description">{one_line(about)}</metadata>'] if about else []),
        '<metadata name="Application">camgeo</metadata>',
        "<resources>",
    ]
    for k, item in enumerate(items, start=1):
        lines += [f'<object id="{k}" type="model" name="{one_line(item.name)}"><mesh>', *_mesh(item.mesh, mm)]
        lines.append("</mesh></object>")
    lines += ["</resources>", "<build>", *(_built(k, item, mm) for k, item in enumerate(items, start=1)), "</build>"]
    lines += ["</model>", ""]
    with ZipFile(path, "w") as archive:
        for name, text in (("[Content_Types].xml", _TYPES), ("_rels/.rels", _LINKS), (_MODEL, "\n".join(lines))):
            entry = ZipInfo(name, _EPOCH)
            entry.compress_type, entry.create_system, entry.external_attr = ZIP_DEFLATED, 3, 0o644 << 16
            archive.writestr(entry, text, compresslevel=_LEVEL)


def _mesh(mesh: Mesh, mm: float) -> Iterable[str]:
    from camgeo.files.precision import DECIMALS

    points = mesh.points if mm == 1.0 else DECIMALS.nearest(mesh.points / mm)  # the quotient of a rounded number
    yield "<vertices>"
    x, y, z = (map(number, column) for column in points.T.tolist())
    for a, b, c in zip(x, y, z, strict=True):
        yield f'<vertex x="{a}" y="{b}" z="{c}"/>'
    yield "</vertices><triangles>"
    for i, j, k in mesh.triangles.tolist():
        yield f'<triangle v1="{i}" v2="{j}" v3="{k}"/>'
    yield "</triangles>"


def _built(k: int, item: Item, mm: float) -> str:
    if item.place is None:
        return f'<item objectid="{k}"/>'
    place = [*np.ravel(item.place[:3]).tolist(), *(item.place[3] / mm).tolist()]
    return f'<item objectid="{k}" transform="{" ".join(map(number, place))}"/>'


def _written(path: Path, items: Sequence[Item], title: str, mm: float, about: str) -> None:
    write_3mf(path, items, title=title, mm=mm, about=about)


def _decimals() -> Precision:
    from camgeo.files.precision import DECIMALS

    return DECIMALS


FORMAT = Format(name="3mf", options=OPTIONS, forms=EDGES, solid=True, mesh=True)
MAKING = mesh_making(_decimals, _written)
