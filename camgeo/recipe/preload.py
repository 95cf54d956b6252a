"""Preloads by interference: keys and tolerances that exclude them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.common.rounding import downward
from camgeo.recipe.export import TOLERANCE
from camgeo.registry.formats import FORMATS

if TYPE_CHECKING:
    from camgeo.schema.reader import Reader, Values

PATH = "cam.preload"
SIDES = 2.0  # contacts on opposite sides of a contour, each of which may be off by the tolerance


def check_preload(values: Values, reader: Reader) -> None:
    """Note keys that do not go with a preload by interference, and a tolerance that may take all of it."""
    cam = values.get("cam", {})
    preload = cam.get("preload")
    if preload is None:
        return
    if cam.get("undercut") == "trim":
        remedy = "leave it out, or cam.preload: where metal is cut off nothing is preloaded"
        reader.fault_at("cam.undercut", "a preloaded cam is not trimmed", "trim", remedy)
    listed = values.get("export", {}).get("files", [])
    for file in listed:
        kind, path = file["kind"], file["path"]
        if "clearance" in file:
            remedy = "leave it out, or cam.preload"
            reader.fault_at(f"{path}.{kind}.clearance", "a clearance undoes the interference", None, remedy)
    if "interference" in preload:
        _check_tolerances(values, reader, preload["interference"])


def _check_tolerances(values: Values, reader: Reader, interference: float) -> None:
    """Note the first file whose tolerance may take all of the interference, mm, on both sides together."""
    export = values.get("export", {})
    for file in export.get("files", [{"kind": "dxf", "path": ""}]):
        tolerance = file.get("tolerance", export.get("tolerance", TOLERANCE))
        if not FORMATS[file["kind"]].contour or SIDES * tolerance < interference:
            continue
        paths = (f"{file['path']}.{file['kind']}.tolerance", "export.tolerance", f"{PATH}.interference")
        path = next(path for path in paths if path in reader.marks)
        problem = (
            f"a tolerance of {tolerance / reader.mm:g} on either side of a contour leaves none of the interference"
        )
        remedy = f"give a tolerance below {downward(interference / SIDES / reader.mm)}"
        if path == paths[-1]:
            remedy = f"give an export.tolerance below {downward(interference / SIDES / reader.mm)}"
        reader.fault_at(path, problem, None, remedy)
        return
