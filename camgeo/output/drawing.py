"""Drawings: the contour as arcs, a spline or a polyline, with the openings inside it."""

from __future__ import annotations

from functools import reduce
from typing import TYPE_CHECKING

from camgeo.files.precision import conversion_error
from camgeo.fit.bound import Bound
from camgeo.output import part_geometry
from camgeo.output.job import MadeFiles
from camgeo.output.part_geometry import contours_of, openings_of, rim_of
from kin.numeric.check import about

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from camgeo.files.layer_outline import LayerOutline
    from camgeo.fit.pieces import Outline
    from camgeo.output.job import Job
    from camgeo.recipe.export import FileRequest
    from kin.numeric.check import Check

    Draw = Callable[[Job, FileRequest, Path, list[LayerOutline], list[str]], Sequence[Check]]


def make_drawing(job: Job, request: FileRequest, path: Path, draw: Draw) -> MadeFiles:
    """Fit, write, read back and judge one drawing; returns the file and its checks.

    `draw`, (job, request, path, outlines, remarks), writes the outlines on their layers and the remarks, and returns
    the checks of all else that it writes. Raises RecipeErrors where the tolerance cannot be held or the part gives no
    sound drawing, OSError where the file cannot be written.
    """
    has_own_unit = request.units not in {None, job.recipe.units}

    def shift(outline: Outline) -> float:
        return conversion_error(outline) if has_own_unit else 0.0

    with job.refusals(request):
        contours = job.written_outlines(request.as_ or "polyline", job.tolerance(request), shift)
        outlines = [*contours_of(job.design, contours), *rim_of(job.body), *openings_of(job.body)]
        remarks = part_geometry.remarks(job.body, job.recipe.in_units_of(request).mm)
        checks = draw(job, request, path, outlines, remarks)
    bound = reduce(Bound.wider, (outline.bound.widened(shift(outline)) for outline in contours))
    judged = job.judge(request, path, bound, sum(outline.count for outline in contours))
    return MadeFiles(judged.files, (*(about(check, path.name) for check in checks), *judged.checks))
