"""Tables as CSV: a header, then a row a line, each number with at most 12 digits; `tables` has a file for each."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

import numpy as np

from camgeo.common.on_demand import OnDemand
from camgeo.recipe.machining import COARSEST, FINEST
from camgeo.formats.options import RECIPE_UNITS, TOLERANCE
from camgeo.registry.formats import Form, Format
from camgeo.schema.fields import Field, Kind, Table, length
from kin.numeric.records import replace

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from camgeo.output.job import Job, Made
    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.recipe import Recipe
    from camgeo.schema.reader import Reader, Values
    from camgeo.synthesis.design import Design
    from kin.judge.intent import PartIntent

DIGITS = 12
"""Of a number: of a metre the last is 1e-9 mm. What a double has beyond is its own rounding."""


def write_table(
    path: Path, columns: Sequence[str], rows: NDArray[np.float64], *, gaps: bool = False, head: Sequence[str] = ()
) -> None:
    """Write rows (n, k) under k column names; lines end in a line feed on every system.

    Lines of the `head` stand first, behind a #. With `gaps` a nan becomes an empty cell. Raises ValueError where the
    shapes disagree, a name would need quoting or a number is not finite; OSError as the file system does.
    """
    if rows.ndim != 2 or rows.shape[1] != len(columns):
        raise ValueError(f"table: rows of shape {rows.shape} under {len(columns)} columns")
    for name in columns:
        if not name.isidentifier():
            raise ValueError(f"table: {name!r} is not a plain column name")
    bad = np.isinf(rows) if gaps else ~np.isfinite(rows)
    if bool(bad.any()):
        row, column = np.argwhere(bad)[0].tolist()
        raise ValueError(f"table: {columns[column]} is not finite in row {row}")
    # one format for the whole table: a tenth of the time of a csv writer
    line = ",".join([f"%.{DIGITS}g"] * len(columns)) + "\n"
    numbers = (rows + 0.0).ravel().tolist()  # + 0.0 makes -0.0 a plain zero
    text = (line * len(rows)) % tuple(numbers)
    if gaps:
        text = text.replace("nan", "")
    text = "".join(f"# {line}\n" for line in head) + ",".join(columns) + "\n" + text
    path.write_bytes(text.encode("ascii", "replace"))


# --- its files --------------------------------------------------------------------------------------------------------

MODULES = {
    name: f"camgeo.formats.tables.{name}"
    for name in ("motion", "contacts", "polar", "inspection", "grinding", "lift", "trace", "forces")
}
"""Module of each table by its word."""
OF_GROUND = ("step", "tolerance", "roller")
"""Options of tables by which a lobe is ground alone."""


def _form(name: str) -> Form:
    record: Form = import_module(MODULES[name]).FORM
    return record


FORMS = OnDemand(MODULES, _form)


def _check(file: Values, _: Values, reader: Reader) -> None:
    """Note options of the tables by which a lobe is ground beside another one."""
    if FORMAT.form(file.get("as")).ground:
        return
    for key in OF_GROUND:
        if key in file:
            kind = "lift" if key == "roller" else "grinding"
            reader.fault_at(f"{file['path']}.csv.{key}", f"belongs to a table as {kind}", None, "leave it out")


def _make(job: Job, request: FileRequest, path: Path) -> Made:
    if request.form.make is None:
        raise ValueError(f"nothing makes {request.word}")
    return request.form.make(job, request, path)


def _intent(recipe: Recipe, design: Design) -> PartIntent:
    from camgeo.machining.grinding import grinding_intent
    from camgeo.synthesis.intent import intended

    return replace(intended(recipe, design), grinding=grinding_intent(recipe, design))


FORMAT = Format(
    name="csv",
    options=Table(
        (
            Field("as", Kind.CHOICE, "which table it is", default="motion", choices=tuple(MODULES)),
            Field(
                "step",
                Kind.ANGLE,
                "of grinding and lift, between rows; 360 degrees are a whole number of it",
                default="the largest that holds the tolerance",
                at_least=FINEST,
                at_most=COARSEST,
            ),
            length("roller", "of lift, diameter of the roller on a stem through the shaft whose lift it is"),
            RECIPE_UNITS,
            TOLERANCE,
        )
    ),
    forms=FORMS,
    check=_check,
    contour=False,
    part=False,
    turning=True,
    silence="a table has no contour",
    make=_make,
    intent=_intent,
)
