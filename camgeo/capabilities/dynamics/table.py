"""The table of forces over the shaft angle: of a rigid follower, and under a linkage."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.formats.extension import Table
from camgeo.formats.tables.tabled import table_maker

if TYPE_CHECKING:
    from camgeo.formats.tables.tabled import Columns
    from camgeo.output.job import Job
    from camgeo.recipe.export import FileRequest
    from camgeo.schema.reader import Reader, Values


def _check(file: Values, values: Values, reader: Reader) -> None:
    """Note a table of forces for a recipe without a rigid train."""
    train = values.get("dynamics", {})
    if not train or "stiffness" in train:
        remedy = "give dynamics without stiffness, or leave this out"
        reader.fault_at(file["path"], "a table of forces needs a train whose forces are found", None, remedy)


def _columns(job: Job, request: FileRequest) -> Columns:
    """Columns of the table, a row for each of the recipe's `verify.angles` steps of the turn, and the end."""
    from camgeo.capabilities.dynamics.force_figures import forces_table
    from camgeo.capabilities.dynamics.running_forces import running_of

    running = running_of(job.recipe, job.design)
    if running is None:
        raise ValueError(f"{job.recipe.name}: there are no forces")
    return forces_table(running, job.recipe.verify.angles, job.recipe.in_units_of(request).units)


# forces are nan where the stem jams: such rows have gaps
FORM = Table(name="forces", surfaces=2, discs=2, check=_check, make=table_maker("forces", _columns, gaps=True))
