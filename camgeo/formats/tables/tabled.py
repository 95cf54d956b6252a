"""Tables over the shaft angle or of the contour, which nothing judges."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

from camgeo.files.table import write_table
from camgeo.recipe.machining import COARSEST, FINEST
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path
    from typing import TypeAlias

    from camgeo.output.job import Job, MadeFiles
    from camgeo.recipe.export import FileRequest
    from camgeo.schema.reader import Reader, Values
    from kin.numeric.arrays import Array

    Columns: TypeAlias = tuple[tuple[str, ...], Array]

TICKS = 10_000  # in a degree: steps are whole numbers of them, so that angles have four decimals
WHOLE = 1e-9  # rad by which steps may miss a turn


def check_step(file: Values, reader: Reader) -> None:
    """Note in the reader a step between rows that does not divide a turn."""
    if "step" in file:
        count = round(TURN / file["step"])
        if abs(count * file["step"] - TURN) > WHOLE:
            remedy = f"give {360.0 / count:.9g} or another divisor of 360"
            path = f"{file['path']}.{file['kind']}.step"
            reader.fault_at(path, "360 degrees are no whole number of it", None, remedy)


def fewest_rows(
    holds: Callable[[int], bool], finest: float = FINEST, may: Callable[[int], bool] | None = None
) -> int | None:
    """Number of steps of a turn, about the fewest, that hold what is asked; None where no number is enough.

    `holds` says whether a number of steps does; `may` costs less, and is false only where `holds` is. Each is asked
    once of a number. Steps divide a turn and are whole 1/10000 degrees, from COARSEST down to `finest` degrees. The
    search assumes that finer steps err less; where some err more, fewer might be enough.
    """
    whole = 360 * TICKS
    ticks = range(int(COARSEST * TICKS), round(finest * TICKS) - 1, -1)
    counts = [whole // tick for tick in ticks if whole % tick == 0]
    if may is None:
        return _first(holds, counts)
    first = _first(may, counts)
    if first is None or holds(first):
        return first
    return _first(holds, counts[counts.index(first) + 1 :])


def _first(holds: Callable[[int], bool], counts: Sequence[int]) -> int | None:
    """First of rising counts that holds, or about it; None for none."""
    asked = lru_cache(maxsize=None)(holds)
    low, high = 0, len(counts) - 1
    while low < high:  # finer steps leave less, but for a few that meet the motion's breaks
        middle = (low + high) // 2
        low, high = (low, middle) if asked(counts[middle]) else (middle + 1, high)
    return next((count for count in counts[low:] if asked(count)), None)


def table_maker(
    stage: str, columns: Callable[[Job, FileRequest], Columns], *, gaps: bool = False
) -> Callable[[Job, FileRequest, Path], MadeFiles]:
    """Function `make` of a form that writes a table of these columns, which nothing judges, in a stage of the run.

    `columns` gives the names of columns and the rows. With `gaps` a nan becomes an empty cell; without it `make` raises
    ValueError for one.
    """

    def make(job: Job, request: FileRequest, path: Path) -> MadeFiles:
        from camgeo.output.job import unjudged

        with job.clock.stage(stage):
            names, rows = columns(job, request)
            write_table(path, names, rows, gaps=gaps)
        return unjudged(path, request, job.recipe.in_units_of(request).mm)

    return make
