"""The table of paths of points of a linkage's moving links, with curvature and speed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.formats.extension import Table
from camgeo.formats.tables.tabled import table_maker

if TYPE_CHECKING:
    from camgeo.formats.tables.tabled import Columns
    from camgeo.output.job import Job
    from camgeo.recipe.export import FileRequest
    from camgeo.schema.reader import Reader, Values


def _check(file: Values, _: Values, reader: Reader) -> None:
    if "linkage.trace" not in reader.marks:
        remedy = "give points such as linkage.trace: [{on: coupler, point: [40, 10]}]"
        reader.fault_at(f"{file['path']}.csv.as", "needs linkage.trace", "'trace'", remedy)


def _columns(job: Job, request: FileRequest) -> Columns:
    from camgeo.synthesis.traces import trace_table

    return trace_table(job.recipe.in_units_of(request), job.design)


FORM = Table(name="trace", check=_check, make=table_maker("trace", _columns, gaps=True))  # nan: nothing moves
