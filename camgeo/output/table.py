"""Tables: the intended motion, or the contact on the exact cam, row by row; CSV."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.files.table import write_table
from camgeo.output.job import Made
from camgeo.report.document import FileResult

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.output.job import Job
    from camgeo.recipe.export import FileRequest


def make_table(job: Job, request: FileRequest, path: Path) -> Made:
    """Write one table; that of a mechanism that does not turn is left out, as the report tells."""
    driven = job.design.driven
    if driven is not None and not driven.turns:
        return Made(())
    inspected = request.as_ == "inspection"
    with job.clock.stage("inspection" if inspected else "table"):
        if inspected:
            from camgeo.machining.inspection import inspection_table

            columns, rows = inspection_table(job.recipe, job.design)
        elif driven is not None:
            from camgeo.synthesis import linkage

            columns, rows = linkage.motion_table(job.recipe, driven.mechanism)
        else:
            from camgeo.synthesis.motion_table import motion_table

            columns, rows = motion_table(job.recipe, job.design.intent)
        write_table(path, columns, rows, gaps=inspected)
    return Made((FileResult(path, request, None, None, None, None, None),))
