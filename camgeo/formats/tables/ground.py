"""Tables by which a lobe is ground: their rows by a step, and the judged metal that their wheel leaves."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.formats.extension import Table
from camgeo.formats.tables.tabled import check_step

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from camgeo.output.job import Job, MadeFiles
    from camgeo.recipe.export import FileRequest
    from camgeo.schema.reader import Reader, Values


def ground_form(name: str, check: Callable[[Values, Values, Reader], None], *more: str) -> Table:
    """Record of the form `name`, a table by which a lobe is ground; `more` are options beside step and tolerance.

    `check`, (values of the file, values of the recipe, reader), notes what a recipe lacks for it.
    """

    def checked(file: Values, values: Values, reader: Reader) -> None:
        check(file, values, reader)
        _check(file, values, reader)

    takes = ("step", "tolerance", *more)
    return Table(name=name, listed=("as",), ground=True, takes=takes, check=checked, make=make_ground)


def _check(file: Values, values: Values, reader: Reader) -> None:
    path = f"{file['path']}.csv"
    check_step(file, reader)
    if values.get("cam", {}).get("track", "external") != "external":
        reader.fault_at(f"{path}.as", "a wheel grinds the outside of a disc", None, "leave the table or track out")


def make_ground(job: Job, request: FileRequest, path: Path) -> MadeFiles:
    """Write a table, read it back and judge the metal that its wheel leaves.

    Raises RecipeErrors for a wheel that is not given, a wheel or roller too large for a hollow of the contour, a
    contour with corners, and a step or tolerance that cannot be held; OSError where the file cannot be written.
    """
    from camgeo.files.table import write_table
    from camgeo.fit.bound import Bound
    from camgeo.machining.grinding import grinding_table

    recipe = job.recipe.in_units_of(request)
    with job.clock.stage("grinding"), job.refusals(request):
        table = grinding_table(recipe, job.design, request, job.tolerance(request), job.field(request))
        write_table(path, table.columns, table.rows, head=table.head)
    return job.judge(request, path, Bound(table.error, table.error), len(table.rows) - 1)
