"""The checks of a second opinion: which library judges which file, and the remedies of failed checks."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.checks.declaration import Declared
from camgeo.checks.extension import Checks
from camgeo.common.rounding import upward

if TYPE_CHECKING:
    from camgeo.checks.declaration import CheckFacts, Entry, OfFile
    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.recipe import Recipe
    from camgeo.registry.formats import Format

AUDITED = frozenset({"dxf"})  # formats for which ezdxf has an auditor
REASONS = {"csv": "a table has no contour", "glb": "a GLB is to look at", "html": "a page is to look at"}


def libraries(record: Format) -> frozenset[str]:
    """Names of the libraries that judge files of a format; trimesh stands for manifold3d, which judges meshes too.

    There are none for a format without a contour, and none for a program, which shows the cutter's path.
    """
    if not record.contour or not record.part:
        return frozenset()
    meshed = {"trimesh"} if record.mesh else set()
    audited = {"ezdxf"} if record.name in AUDITED else set()
    return frozenset({"shapely", *meshed, *audited})


def reason_without(record: Format) -> str:
    """Why no library judges files of a format; empty where one does."""
    if libraries(record):
        return ""
    if record.program:
        return "no library of these reads a milling program"
    return REASONS.get(record.name, "it holds no contour that is judged")


def _judged_by(library: str) -> OfFile:
    """Predicate: whether a library judges a file; files with other bodies than the cam are left out."""

    def judged(_: CheckFacts, file: FileRequest) -> bool:
        return library in libraries(file.format) and not file.holds_other_bodies

    return judged


def own_export(_check: Entry, _report: Entry, _recipe: Recipe) -> str:
    """Remedy in words: the file that the recipe itself makes."""
    return "the file that `camgeo export` writes from this recipe"


def wider(check: Entry, report: Entry, recipe: Recipe) -> str:
    """Remedy in words: a greater tolerance, or the file that the recipe itself makes.

    The tolerance is the measured distance plus 0.2 of the file's tolerance, for the errors of both polygons. Without a
    measured distance or a tolerance the recipe's file alone is named.
    """
    export = own_export(check, report, recipe)
    tolerance = next((file["tolerance"] for file in report["files"] if file["path"] == check["file"]), None)
    if check["value"] is None or tolerance is None:
        return export
    return f"a tolerance of {upward(check['value'] + 0.2 * tolerance)}, or {export}"


_DRAWN, _MESHED = _judged_by("shapely"), _judged_by("trimesh")
AUDIT = Declared("ezdxf:audit", ("faults",), of_file=_judged_by("ezdxf"), remedy=own_export)
CONTOUR_VALID = Declared("shapely:valid", ("faults",), of_file=_DRAWN, remedy=own_export)
CONTOUR_AREA = Declared("shapely:area", ("mm^2",), of_file=_DRAWN, field="export.tolerance", remedy=own_export)
CONTOUR_DISTANCE = Declared("shapely:distance", ("mm",), of_file=_DRAWN, field="export.tolerance", remedy=wider)
MESH_WATERTIGHT = Declared("trimesh:watertight", ("faults",), of_file=_MESHED, remedy=own_export)
MESH_WINDING = Declared("trimesh:winding", ("faults",), of_file=_MESHED, remedy=own_export)
MESH_BODIES = Declared("trimesh:bodies", ("bodies",), of_file=_MESHED, remedy=own_export)
MESH_VOLUME = Declared("trimesh:volume", ("mm^3",), of_file=_MESHED, field="part.thickness", remedy=own_export)
MESH_STATUS = Declared("manifold3d:status", ("faults",), of_file=_MESHED, remedy=own_export)
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
"""All checks of a second opinion, in the order of a report."""
ANSWERS = Checks(checks=SECOND_OPINIONS)
