"""The checks of a second opinion: which library is asked about which file, and what would let each hold."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.checks.declared import Declared
from camgeo.common.rounding import upward

if TYPE_CHECKING:
    from camgeo.checks.declared import OfFile, Scene
    from camgeo.checks.remedies import Entry
    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.recipe import Recipe
    from camgeo.registry.formats import Format

AUDITED = frozenset({"dxf"})  # formats for which ezdxf has an auditor
SHOWN = {"csv": "a table has no contour", "glb": "a GLB is to look at", "html": "a page is to look at"}


def libraries(record: Format) -> frozenset[str]:
    """Names of the libraries that are asked about files of a format."""
    if not record.contour or not record.part:
        return frozenset()
    meshed = {"trimesh"} if record.numbers is not None else set()
    audited = {"ezdxf"} if record.name in AUDITED else set()
    return frozenset({"shapely", *meshed, *audited})


def silence(record: Format) -> str:
    """Why no library is asked about files of a format; empty where one is."""
    if libraries(record):
        return ""
    if record.program:
        return "no library of these reads a milling program"
    return SHOWN.get(record.name, "it holds no contour that is judged")


def _seen_by(library: str) -> OfFile:
    """Whether a library is asked about a file; one of all bodies is not the cam's alone."""

    def seen(_: Scene, file: FileRequest) -> bool:
        return library in libraries(file.format) and not file.united

    return seen


def exported_anew(_check: Entry, _report: Entry, _recipe: Recipe) -> str:
    """Tell of the file that the recipe itself makes."""
    return "the file that `camgeo export` writes from this recipe"


def wider(check: Entry, report: Entry, recipe: Recipe) -> str:
    """Tell of the tolerance that a contour keeps, measured between polygons within a tenth of the file's of it."""
    anew = exported_anew(check, report, recipe)
    tolerance = next((file["tolerance"] for file in report["files"] if file["path"] == check["file"]), None)
    if check["value"] is None or tolerance is None:
        return anew
    return f"a tolerance of {upward(check['value'] + 0.2 * tolerance)}, or {anew}"


_DRAWN, _MESHED = _seen_by("shapely"), _seen_by("trimesh")
AUDIT = Declared("ezdxf:audit", ("faults",), of_file=_seen_by("ezdxf"), remedy=exported_anew)
CONTOUR_VALID = Declared("shapely:valid", ("faults",), of_file=_DRAWN, remedy=exported_anew)
CONTOUR_AREA = Declared("shapely:area", ("mm^2",), of_file=_DRAWN, field="export.tolerance", remedy=exported_anew)
CONTOUR_DISTANCE = Declared("shapely:distance", ("mm",), of_file=_DRAWN, field="export.tolerance", remedy=wider)
MESH_WATERTIGHT = Declared("trimesh:watertight", ("faults",), of_file=_MESHED, remedy=exported_anew)
MESH_WINDING = Declared("trimesh:winding", ("faults",), of_file=_MESHED, remedy=exported_anew)
MESH_BODIES = Declared("trimesh:bodies", ("bodies",), of_file=_MESHED, remedy=exported_anew)
MESH_VOLUME = Declared("trimesh:volume", ("mm^3",), of_file=_MESHED, field="part.thickness", remedy=exported_anew)
MESH_STATUS = Declared("manifold3d:status", ("faults",), of_file=_MESHED, remedy=exported_anew)
SECOND_OPINIONS = (
    AUDIT,
    CONTOUR_VALID,
    CONTOUR_AREA,
    CONTOUR_DISTANCE,
    MESH_WATERTIGHT,
    MESH_WINDING,
    MESH_BODIES,
    MESH_VOLUME,
    MESH_STATUS,
)
"""All of them, in the order in which they are foreseen."""
